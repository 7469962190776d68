"""Systems as plain data, and the adapter that builds and runs them with the names of this commit.

A description is made of numbers, words, lists and dictionaries, so that it can be stored as JSON; floats come back to
the last bit.  Its vocabulary is fixed: a description that was stored once is read by every later commit.  When a class,
a parameter or a function of the package gets another name, the modules of this folder follow it and the descriptions
stay as they are.

A description has these keys:

bodies
    A list of components.  A component is a dictionary: ``kind`` is a word of
    :data:`~tests.benchmarks.described.vocabulary.KINDS`, the other keys are its parameters.  A parameter that has its
    default value is left out, so that an older commit reads what a newer one wrote.
starts
    For every body ``null`` or a dictionary: ``how`` it is placed ("place", "touching", "resting", "at_height"), and
    the arguments.
laws
    A list of dictionaries with the components ``normal``, ``friction`` and, of rigid contacts, ``impact``.
contacts
    A list of [body, body, laws], each by its number.
contact_all
    In place of ``contacts``, the number of the laws with which all bodies touch each other.
joints
    A list of [body, body, component].
gravity, t_end, sample_interval
    Gravity downwards [m/s^2], end time and time between samples [s].
"""
