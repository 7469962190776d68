"""Sources of the player, of which ``python -m nonsmooth.viewer.player.update`` makes the bundle beside this folder."""
