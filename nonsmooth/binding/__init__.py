"""From functions of plug-ins to addresses that the engine calls."""
