"""The folders that keep compiled code: their name changes with the engine, and nobody else can write to them.

To load machine code is to run it. So a folder is used only if it belongs to the user or the administrator, is no link,
and is closed to all others.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib.util
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import llvmlite
import numpy as np
from llvmlite.binding import get_host_cpu_features, get_host_cpu_name

from nonsmooth.notices import say
from nonsmooth.user_cache import user_cache

_ENGINE = Path(__file__).resolve().parents[1]
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_NUMBA_FILE = Path(".numba_config.yaml")
"""File in the working folder that may hold settings of numba."""


@functools.cache
def build_name() -> str:
    """Name of the folder of compiled code: a hash of all sources of the engine.

    The versions of numba, llvmlite, numpy and Python and the kind of processor are part of the hash. So code that was
    compiled for other versions or another processor is never loaded. The contents of all sources are read, which takes
    some milliseconds. Size and time of a file would not show every change.
    """
    versions = f"{_numba_version()} {llvmlite.__version__} {np.__version__} {sys.version}"
    digest = hashlib.sha256(f"{versions} {_processor()}".encode())
    for source in sorted(_ENGINE.rglob("*.py")):
        digest.update(source.relative_to(_ENGINE).as_posix().encode() + source.read_bytes())
    # 64 bits of the hash: two engines with the same name are next to impossible
    return f"engine-{digest.hexdigest()[:16]}"


def _numba_version() -> str:
    """Version of numba, as the text of its file ``_version.py``.

    Numba is not imported, because the import takes most of the time in which a program starts. The file is found as an
    import would find it. The metadata of installed packages may belong to another installation of numba.
    """
    place = getattr(importlib.util.find_spec("numba"), "origin", None)
    file = Path(place or "").with_name("_version.py")
    return file.read_text() if place and file.is_file() else str(importlib.import_module("numba").__version__)


def _processor() -> str:
    """Processor for which numba compiles: name and features from numba's settings, or else of this machine."""
    # with NUMBA_CPU_NAME a cluster of different processors uses the same code
    chosen = os.environ.get("NUMBA_CPU_NAME", "")
    name = chosen or get_host_cpu_name()
    features = os.environ.get("NUMBA_CPU_FEATURES")
    if features is None:
        features = "" if chosen.lower() == "generic" else get_host_cpu_features().flatten()
    settings = _NUMBA_FILE.read_text() if _NUMBA_FILE.is_file() else ""
    return f"{name} {features} {os.environ.get('NUMBA_ENABLE_AVX')} {settings}"


def folders() -> tuple[list[Path], Path | None]:
    """Folders from which compiled code is read, in this order, and the folder to which it is written.

    The first is in the user's cache. A temporary one follows if the first cannot be written to. Folders are created if
    necessary. One that another user could write to is left out, with a notice. If none can be written to, the second
    result is None, and compiled code is not kept.
    """
    readable: list[Path] = []
    for home, permissions in _homes():
        folder = home / build_name()
        # a place that cannot be written to may still have the folder, written by the administrator
        with contextlib.suppress(OSError):
            home.parent.mkdir(parents=True, exist_ok=True)
            for one in (home, folder):
                one.mkdir(permissions, exist_ok=True)
                _close(one)
        # it could not be created: try the next one
        if not folder.is_dir():
            continue
        if not all(_is_safe_folder(one) for one in (home, folder)):
            say(
                f"{folder} is not used for the compiled engine: it, or the folder it is in, is a link, belongs to "
                "another user or can be written to by one"
            )
            continue
        readable.append(folder)
        # the first folder that can be written to is the last one that is read
        if os.access(folder, os.W_OK):
            return readable, folder
    return readable, None


def _homes() -> Iterator[tuple[Path, int]]:
    """Folders that may hold compiled code of all versions, and the permissions that they are created with.

    Nobody else may write to either of them. The folder for temporary files is shared by all users, so that its name has
    the user's number, and nobody else may read it.
    """
    cache = user_cache()
    if cache is not None:
        yield cache / "nonsmooth", 0o755
    # there may be no folder for temporary files at all
    with contextlib.suppress(OSError):
        user = "" if sys.platform == "win32" else f"-{os.geteuid()}"
        yield Path(tempfile.gettempdir()) / f"nonsmooth{user}", 0o700


def _close(folder: Path) -> None:
    """Withdraw write permission from all other users, if the folder belongs to this user. Say so if any had it.

    Code in a folder that others can write to is not loaded, because to load machine code is to run it.
    """
    status = folder.lstat()
    # Windows has no such permissions. Others' folders and links stay as they are: _is_safe_folder then refuses them
    if sys.platform == "win32" or not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid():
        return
    if status.st_mode & _WRITABLE_BY_OTHERS:
        folder.chmod(stat.S_IMODE(status.st_mode) & ~_WRITABLE_BY_OTHERS)
        say(f"{folder} could be written to by other users, and no longer is: what is kept there runs as yours")


def is_safe(status: os.stat_result) -> bool:
    """True if only this user and the administrator can have written a file or folder, by its ``status``.

    Only its code is loaded then, because to load machine code is to run it.
    """
    if sys.platform == "win32":
        return True  # a user's folders are closed to others there, and a status does not name the owner
    # user 0 is the administrator
    return status.st_uid in (os.geteuid(), 0) and not status.st_mode & _WRITABLE_BY_OTHERS


def _is_safe_folder(folder: Path) -> bool:
    """True if a folder is no link, and only this user and the administrator can have written to it."""
    # lstat: the status of a link itself, not of the folder to which it leads
    status = folder.lstat()
    return stat.S_ISDIR(status.st_mode) and is_safe(status)
