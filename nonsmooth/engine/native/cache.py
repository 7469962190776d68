"""Files of machine code: one per function, with a checksum over its name and contents.

Loading a damaged file, or that of another function, would end the process. A file whose checksum is wrong is compiled
again. A file that another user can have written is not loaded, because loading it is running it
(:mod:`nonsmooth.engine.native.folders`).

Numba's own cache is not used: it notices an edit of the function's file only, not one of a function called there. It
also keeps the intermediate code, and reading that takes most of a start.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import uuid
from typing import Any, final

from nonsmooth.engine.native.folders import folders, is_safe
from nonsmooth.engine.native.numba_names import CompileResult, dumps, parse_assembly, rtsys
from nonsmooth.notices import say

_ALLOCATING = b"NRT_"
"""Prefix of the names of numba's functions that allocate memory. Only laws call them."""
_CHECKSUM = hashlib.sha256().digest_size


def _to_call(compiled: Any) -> tuple[Any, ...]:
    """Compiled code as numba pickles it, but without the intermediate code, whose reading takes most of a start.

    Only callers that include the code would need the intermediate code.
    """
    # first the library: its name, the kind of its contents, and machine code with intermediate code. Then the types
    # and the like of the function, which stay
    (name, kind, (code, _)), *others = compiled._reduce()
    # an empty function takes its place: numba reads there which symbol the machine code defines
    symbol = compiled.fndesc.llvm_cfunc_wrapper_name
    return (name, kind, (code, parse_assembly(f'define void @"{symbol}"() {{ ret void }}').as_bitcode())), *others


@final
class Store:
    """The file of one function's machine code, with the methods of numba's cache, which it replaces.

    Parameters
    ----------
    name : str
        Name of the file. Equal names must mean equal functions.
    """

    def __init__(self, name: str) -> None:
        """Name the file. The file is read when its content is needed."""
        self._name = f"{name}.code"
        self._content: bytes | None = None

    def is_filled(self) -> bool:
        """True if the file has valid code. Its content is kept for :meth:`load_overload`."""
        if self._content is None:
            self._content = self._sound()
        return self._content is not None

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Compiled code as numba represents it. None if there is no valid file, or only one of another processor.

        Numba calls this before it compiles, with the ``signature`` of the function, which the name of the file covers.
        """
        content = self._content or self._sound()
        # it is loaded once: free the memory
        self._content = None
        if content is None:
            return None
        if _ALLOCATING in content:
            # code that allocates memory needs numba's functions for it in this process;
            # numba's `context.refresh` would do this too, but it imports all of numpy and scipy: a third of a start
            rtsys.initialize(context)
        processor, reduced = pickle.loads(content)
        # code for another processor is not run: numba then compiles
        return None if processor != context.codegen().magic_tuple() else CompileResult._rebuild(context, *reduced)

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Write the code to disk, unless it has addresses of this process or no folder can be written to.

        Numba calls this after it has compiled the function. A file that is already there is replaced.
        """
        # the second of the pair: the one folder that is written to
        folder = folders()[1]
        if folder is None:
            say("no folder of yours to keep the compiled engine in: name one in XDG_CACHE_HOME")
            return
        # the code has addresses of this process, which mean nothing in another one
        if compiled.library.has_dynamic_globals:
            return
        # the tuple describes the processor
        content = dumps((compiled.codegen.magic_tuple(), _to_call(compiled)))
        # written under a random name, then renamed: no other process reads a file that is not complete
        part = folder / f"{self._name}.{uuid.uuid4().hex[:16]}"
        try:
            # 0o644: others may read it, but not write to it, whatever the user's settings
            with open(part, "xb", opener=lambda path, flags: os.open(path, flags, 0o644)) as file:
                file.write(self._checksum(content) + content)
            part.replace(folder / self._name)
        except OSError:
            # a full disk, or on Windows another process that reads the file: each process then compiles
            with contextlib.suppress(OSError):
                part.unlink()

    def _sound(self) -> bytes | None:
        """Content of the first undamaged file that nobody else can have written, or None: the function is compiled.

        The folders are tried in their order. A notice gives the reason if a file that exists is not used.
        """
        # the first of the pair: all folders that may be read
        for folder in folders()[0]:
            path = folder / self._name
            try:
                with path.open("rb") as file:
                    # the status of the opened file: one of a path could be that of another file by now
                    if not is_safe(os.fstat(file.fileno())):
                        say(f"{path} is not loaded: another user can have written it")
                        continue
                    text = file.read()
            except OSError:
                # no such file: it may be in the next folder
                continue
            # a file is the checksum, 32 bytes, and the content
            checksum, content = text[:_CHECKSUM], text[_CHECKSUM:]
            if checksum == self._checksum(content):
                return content
            say(f"{path} is damaged and compiled again")
        return None

    def _checksum(self, content: bytes) -> bytes:
        """Checksum of the name and the content of a file, so that damage and an exchange of files are noticed."""
        return hashlib.sha256(self._name.encode() + content).digest()
