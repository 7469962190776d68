"""``nonsmooth list``."""

from __future__ import annotations

from collections.abc import Callable

import pytest

GROUPS = ("scenarios", "bodies", "shapes", "motions", "joints", "loads", "guards", "laws", "engines")
Call = Callable[..., tuple[int, str, str]]


def test_all_groups_with_source_and_first_line(call: Call) -> None:
    status, output, _ = call("list")
    assert status == 0
    assert [line for line in output.splitlines() if line and line[0] != " "] == [f"{group}:" for group in GROUPS]
    for row in (
        ("tiny", "tiny 0.1", "Tiny: A ball on a vibrating plate."),
        ("ball", "nonsmooth 0.2.0", "Ball: A free solid sphere."),
        ("hinge", "nonsmooth 0.2.0", "Hinge: Two points and two axes through them coincide."),
        (
            "spring",
            "nonsmooth 0.2.0",
            "Spring: F = -k (d - d0) - c d' along the line between two points at distance d, which must not vanish.",
        ),
        ("coulomb", "friction", "nonsmooth 0.2.0", "Coulomb: Coulomb's law, Eq. (17)."),
    ):
        assert " ".join(" ".join(row).split()) in " ".join(output.split())
    assert max(map(len, output.splitlines())) <= 80
    assert "``" not in output
    assert ":class:" not in output


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("group", GROUPS)
def test_one_group(call: Call, group: str) -> None:
    status, output, _ = call("list", group)
    assert status == 0
    assert [line for line in output.splitlines() if not line.startswith("  ")] == [f"{group}:"]


def test_a_broken_plug_in_is_a_warning_and_not_listed(call: Call) -> None:
    status, output, errors = call("list", "laws")
    assert status == 0
    assert "tiny" not in output
    warned = errors.splitlines()
    assert len(warned) == 3
    assert all(line.startswith("warning: law 'tiny_") for line in warned)
