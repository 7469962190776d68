"""Built-in contact laws: one law, one file."""

from nonsmooth.lazy_names import lazy_names
from nonsmooth.two_names import join_names

join_names(__name__)
__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
