"""The gate for names in files: which class or function a word of a file may mean.

A file of another person is data until the user trusts it.  A word of an untrusted file may name a component that an
installed package has registered by an entry point.  A word for a function or a helper class may name a module of the
packages with such entry points.  Any other word would run code because a file names it.  It is refused before anything
is imported.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files import named
from nonsmooth.plugins import file, registry

_CODE = (":", "/", "\\", ".py")
"""Texts that occur in a word with a path or a module, and in no installed name."""
_RULE = "must name what an installed package has registered, as the file is not trusted"
_REMEDY = (
    "It would run code that the file names. If you trust who wrote it, say trust=True in Python or --trust on the "
    "command line."
)


@final
@dataclass(frozen=True)
class Gate:
    """Classes and functions that the names of one file may denote.

    Attributes
    ----------
    folder : Path
        Folder that paths of Python files are relative to.
    trusted : bool
        True if the file may name Python files and anything that can be imported.
    """

    folder: Path = Path()
    trusted: bool = False

    def component(self, thing: str, group: str, base: type, word: str) -> Any:
        """Class of a component.

        Parameters
        ----------
        thing : str
            Place of the word in the file, for messages.
        group : str
            Group of the installed names.
        base : type
            Interface that the class must implement.
        word : str
            An installed name; in a trusted file also FILE.py:CLASS.

        Raises
        ------
        UnknownName
            No class is installed under that name, or the Python file has no such class.
        InvalidInput
            The word names code and the file is not trusted, or the Python file does not exist.
        PluginError
            The class cannot be loaded.
        """
        if not self.trusted and word not in registry.names(group) and any(sign in word for sign in _CODE):
            raise InvalidInput(thing, _RULE, word, _REMEDY)
        return file.find(thing, group, base, word, self.folder)

    def helper(self, thing: str, word: str) -> Any:
        """Class without an installed name, by ``word``, "module:Class".

        ``thing`` is the place of the word in the file, for messages. The errors are those of :meth:`component`.
        """
        self._check(thing, word)
        return named.find(thing, word)

    def function(self, thing: str, word: str) -> Any:
        """Plain Python function by ``word``, "module:function".

        ``thing`` is the place of the word in the file, for messages. The errors are those of :meth:`component`.
        """
        self._check(thing, word)
        found = named.function(thing, word)
        # the module may have imported the function from another module
        self._check(thing, f"{found.__module__}:{found.__qualname__}")
        return found

    def _check(self, thing: str, word: str) -> None:
        if self.trusted or not named.is_name(word):
            return
        module = word.partition(":")[0]
        is_known = any(module == known or module.startswith(f"{known}.") for known in registry.packages())
        # to import the main module of a package is to start its program
        if not is_known or "__main__" in module.split("."):
            raise InvalidInput(thing, _RULE, word, _REMEDY)


TRUSTED = Gate(trusted=True)
"""Gate for names that the user has typed: they may denote any class or function that can be imported."""
