"""Where compiled code is kept on disk: read only what nobody else can have written, and only what is as it was written.

A file holds the code of one function behind a checksum over its name and contents.  What is damaged, or was another
file, is compiled again; loaded as it is, it would end the process.  Reading executes what a file says, so that files of
other users are not read, wherever they lie.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import pickle
import stat
import sys
import tempfile
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any, final

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_name, parse_assembly
from numba.core.compiler import CompileResult
from numba.core.runtime import rtsys
from numba.core.serialize import dumps

from nonsmooth.notices import say
from nonsmooth.user_cache import user_cache

_ENGINE = Path(__file__).resolve().parents[1]
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_COUNTING = b"NRT_"
"""Begins the names of the functions by which compiled code, of plug-ins, allocates memory."""
_CHECKSUM = hashlib.sha256().digest_size


@functools.cache
def build_name() -> str:
    """Return the name of what is compiled from these sources, a hash over all of them.

    An edit of any source file, another numba, another Python or another kind of processor that it is compiled for gives
    another name: a stale file cannot be met.
    """
    # unlike processors that compile for the same one (NUMBA_CPU_NAME) are alike
    processor = f"{numba.config.CPU_NAME or get_host_cpu_name()}{numba.config.CPU_FEATURES or ''}"
    digest = hashlib.sha256(f"{numba.__version__}{np.__version__}{sys.version}{processor}".encode())
    for source in sorted(_ENGINE.rglob("*.py")):
        digest.update(source.relative_to(_ENGINE).as_posix().encode() + source.read_bytes())
    return f"engine-{digest.hexdigest()[:16]}"


def folders() -> tuple[list[Path], Path | None]:
    """Return the folders to read compiled code from, in turn, and the one to write it to, if there is any.

    They are those of the user's cache and, where that cannot be written to, of a temporary one.
    """
    readable: list[Path] = []
    for home, permissions in _homes():
        folder = home / build_name()
        with contextlib.suppress(OSError):
            home.parent.mkdir(parents=True, exist_ok=True)
            for one in (home, folder):
                one.mkdir(permissions, exist_ok=True)
                _close(one)
        if not folder.is_dir():
            continue
        if not all(_is_own_folder(one) for one in (home, folder)):
            say(
                f"{folder} is not used for the compiled engine: it, or the folder it is in, is a link, belongs to "
                "another user or can be written to by one"
            )
            continue
        readable.append(folder)
        if os.access(folder, os.W_OK):
            return readable, folder
    return readable, None


def _homes() -> Iterator[tuple[Path, int]]:
    """Yield the folders that may hold compiled code, and the permissions that they are made with."""
    cache = user_cache()
    if cache is not None:
        yield cache / "nonsmooth", 0o755
    with contextlib.suppress(OSError):
        user = "" if sys.platform == "win32" else f"-{os.geteuid()}"
        yield Path(tempfile.gettempdir()) / f"nonsmooth{user}", 0o700


def _close(folder: Path) -> None:
    """Take the right to write to a folder of the user's from all others, whose code would run as the user's."""
    status = folder.lstat()
    if sys.platform == "win32" or not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid():
        return
    if status.st_mode & _WRITABLE_BY_OTHERS:
        folder.chmod(stat.S_IMODE(status.st_mode) & ~_WRITABLE_BY_OTHERS)
        say(f"{folder} could be written to by other users, and no longer is: what is kept there runs as yours")


def _is_own(status: os.stat_result) -> bool:
    """Tell whether nobody but this user and the administrator can have written what has this status."""
    if sys.platform == "win32":
        return True  # the folders of a user are closed to others there, and a status does not say whose they are
    return status.st_uid in (os.geteuid(), 0) and not status.st_mode & _WRITABLE_BY_OTHERS


def _is_own_folder(folder: Path) -> bool:
    status = folder.lstat()
    return stat.S_ISDIR(status.st_mode) and _is_own(status)


def _to_call(compiled: Any) -> tuple[Any, ...]:
    """Return what makes compiled code again, without the intermediate code by which other functions could take it in.

    Reading that would be the better part of a start.  In its place is a module that says which symbol can be called.
    """
    (name, kind, (code, _)), *others = compiled._reduce()
    symbol = compiled.fndesc.llvm_cfunc_wrapper_name
    return (name, kind, (code, parse_assembly(f'define void @"{symbol}"() {{ ret void }}').as_bitcode())), *others


@final
class Store:
    """The place on disk of one function's compiled code; numba asks it as it asks its own caches.

    Parameters
    ----------
    name : str
        Name of the file; equal names must mean equal functions.
    """

    def __init__(self, name: str) -> None:
        self._name = f"{name}.code"
        self._read: bytes | None = None

    def is_filled(self) -> bool:
        """Tell whether there is code that may be loaded."""
        self._read = self._sound()
        return self._read is not None

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the code as numba wants it, or None."""
        content = self._read or self._sound()
        self._read = None
        if content is None:
            return None
        if _COUNTING in content:
            # all else that machine code may call has been there since the context was made: no need of its `refresh`,
            # which imports what numba knows of numpy and scipy, a third of a start
            rtsys.initialize(context)
        processor, reduced = pickle.loads(content)
        return None if processor != context.codegen().magic_tuple() else CompileResult._rebuild(context, *reduced)

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Write the code, where there is a folder for it."""
        folder = folders()[1]
        if folder is None:
            say("no folder of yours to keep the compiled engine in: name one in XDG_CACHE_HOME")
            return
        if compiled.library.has_dynamic_globals:
            return  # addresses of this process
        content = dumps((compiled.codegen.magic_tuple(), _to_call(compiled)))
        part = folder / f"{self._name}.{uuid.uuid4().hex[:16]}"
        try:
            with open(part, "xb", opener=lambda path, flags: os.open(path, flags, 0o644)) as file:
                file.write(self._checksum(content) + content)
            part.replace(folder / self._name)
        except OSError:  # a full disk, or on Windows another process that reads it
            with contextlib.suppress(OSError):
                part.unlink()

    def _sound(self) -> bytes | None:
        """Return the contents of the first file that may be read and is as it was written."""
        for folder in folders()[0]:
            path = folder / self._name
            try:
                with path.open("rb") as file:
                    if not _is_own(os.fstat(file.fileno())):
                        say(f"{path} is not loaded: another user can have written it")
                        continue
                    text = file.read()
            except OSError:
                continue
            checksum, content = text[:_CHECKSUM], text[_CHECKSUM:]
            if checksum == self._checksum(content):
                return content
            say(f"{path} is damaged and compiled again")
        return None

    def _checksum(self, content: bytes) -> bytes:
        return hashlib.sha256(self._name.encode() + content).digest()
