"""The package ``bodies`` of nonsmooth, even if another module has that name (:mod:`nonsmooth.two_names`)."""

from typing import TYPE_CHECKING

from nonsmooth.two_names import load_from_folder

if TYPE_CHECKING:
    from bodies import *
else:
    load_from_folder(__name__)
