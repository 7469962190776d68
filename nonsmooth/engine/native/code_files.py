"""Files of machine code: one per function, with a checksum over its name and contents.

Loading a damaged file, or that of another function, would end the process. A file whose checksum is wrong is compiled
again. A file that another user can have written is not loaded, because loading it is running it
(:mod:`nonsmooth.engine.native.folders`).

A file holds the object code that LLVM made, and what is needed to load it without numba: its symbol, its types and the
symbols that it needs. Numba's own cache is not used. It notices an edit of the function's file only, not one of a
function called there, and importing numba takes most of a start.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import uuid
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from nonsmooth.engine.native.folders import folders, is_safe
from nonsmooth.notices import say

_CHECKSUM = hashlib.sha256().digest_size


class MachineCode(NamedTuple):
    """The machine code of a C function.

    Attributes
    ----------
    symbol : str
        Name of the C function.
    signature : str
        Its types, as a kernel declares them: "f8(ws, i8)".
    externals : sequence of str
        Functions and variables that it needs from the process, such as those of the C library.
    code : bytes
        An object file of this system: ELF, Mach-O or COFF.
    """

    symbol: str
    signature: str
    externals: tuple[str, ...]
    code: bytes


def read(name: str) -> MachineCode | None:
    """Read machine code from the first file of this name that is undamaged and that no other user could write.

    Equal names must mean equal functions. Without a valid file the result is None, and the caller compiles the
    function. A notice gives the reason if a file that exists is not used.
    """
    # the first entry of folders(): the folders to read from, in the order in which they are tried
    for folder in folders()[0]:
        path = folder / _file_name(name)
        try:
            with path.open("rb") as file:
                # the status of the opened file, because by now the path could lead to another file
                if not is_safe(os.fstat(file.fileno())):
                    say(f"{path} is not loaded: another user can have written it")
                    continue
                text = file.read()
        except OSError:
            # this folder lacks the file, but the next one may have it
            continue
        # a file is the checksum, 32 bytes, and the content: a line of JSON, and the object code
        checksum, content = text[:_CHECKSUM], text[_CHECKSUM:]
        if checksum == _checksum(name, content):
            head, _, code = content.partition(b"\n")
            symbol, signature, externals = json.loads(head)
            return MachineCode(symbol, signature, tuple(externals), code)
        say(f"{path} is damaged and compiled again")
    return None


def write(name: str, machine_code: MachineCode) -> None:
    """Write machine code to the file of a name, unless no folder can be written to. An older file is replaced."""
    # the second entry of folders(): the only folder to write to
    folder = folders()[1]
    if folder is None:
        say("no folder of yours to keep the compiled engine in: name one in XDG_CACHE_HOME")
        return
    *head, code = machine_code
    content = json.dumps(head).encode() + b"\n" + code
    path = folder / _file_name(name)
    # written under a random name, then renamed: no other process reads a file that is not complete
    part = Path(f"{path}.{uuid.uuid4().hex[:16]}")
    try:
        # 0o644: others may read it, but not write to it, whatever the user's settings
        with open(part, "xb", opener=lambda path, flags: os.open(path, flags, 0o644)) as file:
            file.write(_checksum(name, content) + content)
        part.replace(path)
    except OSError:
        # raised if the disk is full, or on Windows if another process reads the file: each process then compiles
        with contextlib.suppress(OSError):
            part.unlink()


def written(names: Iterable[str]) -> int:
    """Number of names whose file is in the folder that is written to. The files are not read."""
    folder = folders()[1]
    return 0 if folder is None else sum((folder / _file_name(name)).exists() for name in names)


def _file_name(name: str) -> str:
    """Name of the file of a function."""
    return f"{name}.code"


def _checksum(name: str, content: bytes) -> bytes:
    """Checksum of the name and the content of a file, so that damage and an exchange of files are noticed."""
    return hashlib.sha256(_file_name(name).encode() + content).digest()
