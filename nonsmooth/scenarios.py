"""The package ``scenarios`` of nonsmooth, even if another module has that name (:mod:`nonsmooth.two_names`)."""

from nonsmooth.two_names import load_from_folder

load_from_folder(__name__)
