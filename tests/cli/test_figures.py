"""``nonsmooth figures``."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from nonsmooth.cli.execute import perform

Call = Callable[..., tuple[int, str, str]]


def test_every_figure_of_the_gallery(call: Call, tmp_path: Path) -> None:
    status, output, _ = call("figures", "tiny", "--out", str(tmp_path / "new"))
    assert status == 0
    paths = [tmp_path / "new" / name for name in ("height_0.05.png", "height_0.1.png")]
    assert output.splitlines()[-2:] == [str(path) for path in paths]
    assert all(path.stat().st_size > 1000 for path in paths)


def test_parameters_of_the_figures(call: Call, tmp_path: Path) -> None:
    plain, other = (tmp_path / name for name in ("plain", "other"))
    assert call("figures", "tiny", "--out", str(plain))[0] == 0
    assert call("figures", "tiny", "--out", str(other), "--set", "radius=0.02")[0] == 0
    drawn = [(folder / "height_0.1.png").read_bytes() for folder in (plain, other)]
    assert drawn[0] != drawn[1]


@pytest.mark.parametrize(
    ("word", "said"), [("radios=1", "Did you mean 'radius'?"), ("radius=-1", "Tiny.radius must be > 0 [m]")]
)
def test_a_wrong_parameter_of_the_figures(call: Call, tmp_path: Path, word: str, said: str) -> None:
    status, _, errors = call("figures", "tiny", "--out", str(tmp_path / "new"), "--set", word)
    assert status == 2
    assert said in errors
    assert not (tmp_path / "new").exists()


def test_after_ctrl_c_no_figure_of_half_a_run(call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def impatient(t: float, t_end: float) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(perform, "TimeReached", lambda _: impatient)
    status, _, errors = call("figures", "tiny", "--out", str(tmp_path))
    assert status == 1
    assert "error: interrupted: no figure was saved\n" in errors
    assert list(tmp_path.iterdir()) == []


def test_a_wrong_folder_is_found_first(call: Call, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    status, output, errors = call("figures", "tiny", "--out", str(tmp_path / "file"))
    assert (status, output) == (2, "")
    assert errors.startswith(f"error: {tmp_path / 'file'} must be a folder that can be written to")
