"""The gate for names in files: which class or function a word of a file may mean.

A file of another person is data until the user says that it is trusted.  Of an untrusted one a word may name what an
installed package has registered by an entry point, and, where a component holds a function or a helper class, what
stands in the package of such an entry point.  All else would run code because a file names it: it is refused before
anything is imported.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files import named
from nonsmooth.plugins import file, registry

_CODE = (":", "/", "\\", ".py")
"""Characters that only words with a path or a module have."""
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
        Where paths of Python files start.
    trusted : bool
        Whether the file may name Python files and anything that can be imported.
    """

    folder: Path = Path()
    trusted: bool = False

    def component(self, thing: str, group: str, base: type, word: str) -> Any:
        """Class of a component.

        Parameters
        ----------
        thing : str
            Where the word stands, for messages.
        group : str
            Group of the installed names.
        base : type
            The interface that it must implement.
        word : str
            An installed name; of a trusted file also FILE.py:CLASS.

        Raises
        ------
        UnknownName
            If nothing is installed under that name, or the file has no such class.
        InvalidInput
            If the word leads to code of a file that is not trusted, or to none.
        PluginError
            If it cannot be loaded.
        """
        if not self.trusted and word not in registry.names(group) and any(sign in word for sign in _CODE):
            raise InvalidInput(thing, _RULE, word, _REMEDY)
        return file.find(thing, group, base, word, self.folder)

    def helper(self, thing: str, word: str) -> Any:
        """Class without an installed name, ``module:Class``; errors as :meth:`component`."""
        self._check(thing, word)
        return named.find(thing, word)

    def function(self, thing: str, word: str) -> Any:
        """Plain function ``module:function``; errors as :meth:`component`."""
        self._check(thing, word)
        found = named.function(thing, word)
        # a module may show a function that it has from elsewhere
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
"""For words that the user has typed."""
