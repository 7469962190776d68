"""Compiled code on disk: what is damaged, foreign or open to others is not loaded, and what may be read is used."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.native.kernel import PLAIN

if PLAIN:
    pytest.skip("nothing is compiled", allow_module_level=True)

from llvmlite.binding import address_of_symbol

from nonsmooth.engine.native import folders as folders_module
from nonsmooth.engine.native.code_files import read
from nonsmooth.engine.native.folders import build_name, folders
from nonsmooth.notices import say

needs_users = pytest.mark.skipif(sys.platform == "win32", reason="a status does not say whose a file is")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of compiled code in a cache of the test's own."""
    say.cache_clear()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    return tmp_path / "cache" / "nonsmooth" / build_name()


@pytest.fixture
def filled(home: Path) -> Path:
    """Return the same, with the engine of this run in it."""
    kept = [folder for folder in _KEPT if (folder / "advance.code").exists()]
    assert kept, "the engine of this run is kept nowhere"
    home.parent.mkdir(parents=True)
    shutil.copytree(kept[0], home)
    return home


_KEPT = folders()[0]
"""Where this run takes the engine from."""


def _is_filled(name: str = "advance") -> bool:
    return read(name) is not None


def _flip(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 4
    file.write_bytes(content)


def _cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:1000])


def _empty(file: Path) -> None:
    file.write_bytes(b"")


def _say_something_else(file: Path) -> None:
    file.write_text("no code at all, but long enough to hold a checksum and more")


def _swap(file: Path) -> None:
    other = file.with_name("update_at_event.code")
    one, two = file.read_bytes(), other.read_bytes()
    file.write_bytes(two)
    other.write_bytes(one)


@pytest.mark.parametrize("damage", [_flip, _cut, _empty, _say_something_else, _swap], ids=lambda f: f.__name__[1:])
def test_what_is_damaged_is_not_loaded(
    damage: Callable[[Path], None], filled: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A checksum over name and contents tells, and a line says which file it is."""
    assert _is_filled()
    assert capsys.readouterr().err == ""
    damage(filled / "advance.code")
    assert not _is_filled()
    assert capsys.readouterr().err == f"{filled / 'advance.code'} is damaged and compiled again\n"
    assert _is_filled("find_touching")


_RUN = """
import sys
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
assert len(entry_addresses()) == len(ENTRY_POINTS)
print(*(name for name in ("numba", "nonsmooth.engine.events") if name in sys.modules))
"""


def _start(**environment: str) -> tuple[str, str]:
    """Load the engine in a process of its own: which compiler and kernels were imported, and what was printed."""
    kept = {name: value for name, value in os.environ.items() if name not in environment}
    command = [sys.executable, "-c", _RUN]
    done = subprocess.run(command, env=kept | environment, check=True, capture_output=True, text=True)
    return done.stdout.strip(), done.stderr


@pytest.mark.slow
def test_a_complete_cache_is_used_as_it_is(filled: Path) -> None:
    """Whatever numba is told about its own caches."""
    assert _start(NUMBA_CACHE_LOCATOR_CLASSES="InTreeCacheLocator") == ("", "")


@pytest.mark.slow
def test_a_damaged_file_is_compiled_again(filled: Path) -> None:
    """In another process, so that this one needs no compiler but to start it. The next start compiles nothing."""
    _flip(filled / "begin_sample.code")
    imported, said = _start()
    assert imported == "numba"
    assert "begin_sample.code is damaged and compiled again" in said
    assert "compiling the engine once" in said
    assert _start() == ("", "")


def test_no_entry_point_needs_the_compiler() -> None:
    """Kernels that may raise an error call functions of numba, which each start would then import."""
    for name in ENTRY_POINTS:
        code = read(name)
        assert code is not None
        assert all(address_of_symbol(external) for external in code.externals), (name, code.externals)


def test_an_edit_that_keeps_size_and_time_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The sources are read; two of them that exchange their names count, too."""
    one, two = tmp_path / "one.py", tmp_path / "two.py"
    monkeypatch.setattr(folders_module, "_ENGINE", tmp_path)
    one.write_text("STEPS = 100\n")
    two.write_text("STEPS = 200\n")
    name, times = build_name.__wrapped__(), (one.stat().st_atime_ns, one.stat().st_mtime_ns)
    one.write_text("STEPS = 900\n")
    os.utime(one, ns=times)
    edited = build_name.__wrapped__()
    one.write_text("STEPS = 200\n")
    two.write_text("STEPS = 100\n")
    os.utime(one, ns=times)
    assert len({name, edited, build_name.__wrapped__()}) == 3


_SCENARIO = """
import contextlib, io, sys
from nonsmooth.cli.main import main
with contextlib.redirect_stdout(io.StringIO()):
    assert main(["run", sys.argv[1], "--set", "t_end=0.001"]) == 0
print([name for name in sys.argv[2].split() if name in sys.modules])
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scenario", "unused"),
    [
        ("dumbbell", "numba scipy numpy.f2py trimesh fcl yaml zarr nonsmooth.engine.events"),
        # its impact law allocates arrays, for which numba is imported
        ("woodpecker", "scipy.linalg numpy.f2py trimesh fcl zarr nonsmooth.engine.events"),
    ],
)
def test_a_second_start_compiles_nothing_and_loads_no_library_of_use_to_none(scenario: str, unused: str) -> None:
    """A mechanism's equations are put together by the program; they, too, are found on disk."""
    for _ in range(2):
        command = [sys.executable, "-c", _SCENARIO, scenario, unused]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        if done.stdout == "[]\n":
            return
    pytest.fail(f"modules imported in a second start: {done.stdout}")


@pytest.mark.skipif(os.name != "posix", reason="no permissions")
def test_a_cache_that_cannot_be_written_to_is_read(
    filled: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is complete is loaded; what is new goes to the temporary folder."""
    monkeypatch.setattr(os, "access", lambda path, mode: "temporary" in str(path))
    readable, writable = folders()
    assert readable[0] == filled
    assert writable == readable[1]
    assert writable is not None
    assert Path(tempfile.gettempdir()) in writable.parents
    assert stat.S_IMODE(writable.stat().st_mode) == 0o700
    assert stat.S_IMODE(writable.parent.stat().st_mode) == 0o700
    assert _is_filled()
    shutil.copy(filled / "update_at_event.code", writable / "find_touching.code")
    (filled / "find_touching.code").unlink()
    assert not _is_filled("find_touching")
    assert "find_touching.code is damaged" in capsys.readouterr().err


@needs_users
@pytest.mark.parametrize("which", ["folder", "home"])
@pytest.mark.parametrize("mode", [0o775, 0o757])
def test_a_folder_that_others_can_write_to_is_closed_or_not_used(
    which: str, mode: int, filled: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is closed to them and named; where that cannot be, another one is used."""
    folder = filled if which == "folder" else filled.parent
    folder.chmod(mode)
    with monkeypatch.context() as patch:
        patch.setattr(Path, "chmod", _refuse)
        assert filled not in folders()[0]
        assert not _is_filled()
        assert f"{filled} is not used" in capsys.readouterr().err
    assert folders() == ([filled], filled)
    assert stat.S_IMODE(folder.stat().st_mode) == mode & 0o755
    assert f"{folder} could be written to by other users" in capsys.readouterr().err
    assert _is_filled()


def _refuse(path: Path, mode: int) -> None:
    raise PermissionError(path)


@needs_users
@pytest.mark.parametrize("mode", [0o664, 0o646])
def test_a_file_that_others_can_write_to_is_not_loaded(
    mode: int, filled: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither one that the user's group can write to."""
    (filled / "advance.code").chmod(mode)
    assert not _is_filled()
    assert "another user can have written it" in capsys.readouterr().err
    (filled / "advance.code").chmod(0o644)
    assert _is_filled()


@needs_users
def test_what_belongs_to_another_user_is_not_loaded(filled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Other than the administrator, who can do anything in any case."""
    owner = filled.stat().st_uid
    monkeypatch.setattr(os, "geteuid", lambda: owner + 1)
    assert (filled in folders()[0]) == (owner == 0)
    assert _is_filled() == (owner == 0)
    if owner == 0 and os.getuid() == 0:
        os.chown(filled / "advance.code", 65534, 65534)
        assert not _is_filled()
        assert _is_filled("find_touching")
        os.chown(filled, 65534, 65534)
        assert filled not in folders()[0]
        assert not _is_filled("find_touching")


@needs_users
def test_a_link_is_not_followed(filled: Path) -> None:
    """Who made it may change where it leads."""
    moved = filled.rename(filled.with_name("elsewhere"))
    filled.symlink_to(moved)
    moved.chmod(0o775)
    assert filled not in folders()[0]
    assert not _is_filled()
    assert stat.S_IMODE(moved.stat().st_mode) == 0o775


@needs_users
def test_the_temporary_folder_of_somebody_else_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its name can be computed; then nothing is kept, which is said."""
    say.cache_clear()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file" / "cache"))
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    user = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: user)
    (tmp_path / f"nonsmooth-{user}").mkdir()
    (tmp_path / f"nonsmooth-{user}").chmod(0o777)
    assert folders() == ([], None)
    assert "is not used" in capsys.readouterr().err
    assert not _is_filled()


def test_no_user_and_no_home(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A process of a number that no list of users knows keeps the engine in the temporary folder."""

    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", no_home)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    readable, writable = folders()
    assert writable is not None
    assert readable == [writable]
    assert tmp_path in writable.parents


def test_a_relative_cache_counts_as_none(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As the standard of these folders has it: nothing is made in the working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", "cache")
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    assert folders()[1] == tmp_path / "home" / ".cache" / "nonsmooth" / build_name()
    assert not (tmp_path / "cache").exists()


def test_windows_knows_no_user_numbers(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """There nobody asks for them."""
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.delattr(os, "geteuid", raising=False)
    monkeypatch.delattr(os, "getuid", raising=False)
    assert folders() == ([home], home)
    monkeypatch.setenv("XDG_CACHE_HOME", str(home.parents[1] / "file" / "cache"))
    (home.parents[1] / "file").write_text("")
    assert folders()[1] == Path(tempfile.gettempdir()) / "nonsmooth" / build_name()


def test_code_for_a_chosen_processor_is_code_of_its_own_on_every_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    """As by NUMBA_CPU_NAME=generic: what was compiled for this processor must not be taken for it, nor be another."""
    name = build_name.__wrapped__
    here = name()
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    generic = name()
    assert generic != here
    monkeypatch.setattr(folders_module, "get_host_cpu_name", lambda: "another")
    assert name() == generic
