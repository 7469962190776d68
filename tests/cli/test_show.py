"""``nonsmooth show``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

Call = Callable[..., tuple[int, str, str]]


def _row(output: str, name: str) -> list[str]:
    (line,) = (line for line in output.splitlines() if line.split()[:1] == [name])
    return line.split()


def test_parameters_of_a_scenario(call: Call) -> None:
    status, output, errors = call("show", "tiny")
    assert status == 0
    assert errors == ""
    assert output.startswith(
        "tiny: scenario of tiny 0.1\n  A ball on a vibrating plate.\n  from tiny_scenario import Tiny\n\n"
    )
    assert _row(output, "t_end") == ["t_end", "0.1", "s", ">", "0", "end", "time"]
    assert _row(output, "radius") == ["radius", "0.005", "*", "m", ">", "0", "radius", "of", "the", "ball"]
    assert _row(output, "mode")[:5] == ["mode", "bounce", "one", "of", "bounce,"]
    assert "* assumed" in output


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("name", "parameter", "row"),
    [
        ("ball", "radius", "radius required m > 0 radius"),
        ("coulomb", "static_friction", "static_friction - 1 >= 0 static friction coefficient mu_s, by default mu"),
        (
            "plate",
            "motion",
            "motion Rest(slope=0.0, position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0)) "
            "a Motion from Python or a scenario file",
        ),
        ("newton", "duration", None),
    ],
)
def test_parameters_of_bodies_and_laws(call: Call, name: str, parameter: str, row: str | None) -> None:
    status, output, _ = call("show", name)
    assert status == 0
    found = _row(output, parameter)
    assert row is None or found == row.split()


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("word", "name", "line"),
    [
        ("BoxBody", "box: body of", "from nonsmooth.bodies import BoxBody"),
        ("box_body", "box: body of", "from nonsmooth.bodies import BoxBody"),
        ("Hinge", "hinge: joint of", "from nonsmooth.bodies import Hinge"),
        ("EnergeticImpact", "energetic: law of", "from nonsmooth.laws import EnergeticImpact"),
    ],
)
def test_a_class_is_shown_by_its_own_name(call: Call, word: str, name: str, line: str) -> None:
    status, output, _ = call("show", word)
    assert status == 0
    assert output.startswith(name)
    assert output.splitlines()[2] == f"  {line}"
    assert "\n\n\n" not in output  # one of them


def test_what_is_neither_a_name_nor_a_class_is_told(call: Call) -> None:
    status, _, errors = call("show", "Hingge")
    assert status == 2
    assert "Unknown component 'Hingge'. Did you mean 'hinge'?" in errors


def test_what_has_no_parameters_says_so(call: Call) -> None:
    status, output, _ = call("show", "unilateral")
    assert status == 0
    assert "no parameters" in output
    assert "assumed" not in output


def test_proximity_of_a_file(call: Call, tmp_path: Path) -> None:
    """Gap, state, bodies by the names of the file, how it was found, what is said; a scenario by its name, too."""
    file = tmp_path / "three.toml"
    file.write_text(
        """
        [bodies.floor]
        type = "plate"
        [bodies.low]
        type = "ball"
        radius = 0.01
        start = {position = [0.0, 0.0, 0.01]}
        [bodies.high]
        type = "ball"
        radius = 0.01
        start = {position = [0.0, 0.0, 0.029]}
        [[contacts]]
        between = ["floor", "low"]
        normal = "unilateral"
        friction = "frictionless"
        impact = {type = "newton", restitution = 0.5}
        """
    )
    status, output, errors = call("show", str(file), "--proximity")
    assert status == 0, errors
    assert errors == ""
    rows = [line.split() for line in output.splitlines()[3:]]
    assert rows[0] == ["-0.001", "overlapping", "low", "and", "high", "pair", "none"]
    assert rows[1] == ["0", "touching", "floor", "and", "low", "pair", "declared"]
    assert "generalised and plate 1" in call("show", "woodpecker", "--proximity")[1]
    assert (
        call("show", "dice_throw", "--proximity")[1] == "dice_throw: no two bodies are near each other at the start.\n"
    )
    status, _, errors = call("show", "none.toml", "--proximity")
    assert status == 2
    assert "none.toml" in errors
