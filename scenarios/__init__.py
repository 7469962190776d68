"""Ready-made systems with their figures and acceptance numbers."""

from nonsmooth.two_names import join_names

join_names(__name__)
