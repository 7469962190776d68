"""The package ``scenarios`` that comes with nonsmooth, found by its folder (:mod:`nonsmooth.two_names`)."""

from nonsmooth.two_names import load_from_folder

load_from_folder(__name__)
