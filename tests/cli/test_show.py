"""``nonsmooth show``."""

from __future__ import annotations

from collections.abc import Callable

import pytest

Call = Callable[..., tuple[int, str, str]]


def _row(output: str, name: str) -> list[str]:
    (line,) = (line for line in output.splitlines() if line.split()[:1] == [name])
    return line.split()


def test_parameters_of_a_scenario(call: Call) -> None:
    status, output, errors = call("show", "tiny")
    assert status == 0
    assert errors == ""
    assert output.startswith("tiny: scenario of tiny 0.1\n  A ball on a vibrating plate.\n")
    assert _row(output, "t_end") == ["t_end", "0.1", "s", ">", "0", "end", "time"]
    assert _row(output, "radius") == ["radius", "0.005", "*", "m", ">", "0", "radius", "of", "the", "ball"]
    assert _row(output, "mode")[:5] == ["mode", "bounce", "one", "of", "bounce,"]
    assert "* assumed" in output


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


def test_what_has_no_parameters_says_so(call: Call) -> None:
    status, output, _ = call("show", "unilateral")
    assert status == 0
    assert "no parameters" in output
    assert "assumed" not in output
