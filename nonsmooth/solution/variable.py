from nonsmooth.histories.history import LabelledArray as Variable  # noqa
