"""nonsmooth: event-driven multibody dynamics with friction and energetic multiple impacts.

The public names are listed in ``__init__.pyi``.
"""

from typing import Any

from nonsmooth.lazy_names import lazy_names

_get, __dir__, __all__ = lazy_names(__name__, __file__)


def __getattr__(name: str) -> Any:
    """Return a public name, imported at its first use; for ``__version__``, return the installed version."""
    if name != "__version__":
        return _get(name)
    from importlib.metadata import version

    return version("nonsmooth")
