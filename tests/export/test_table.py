"""Tables have the numbers of the run, to the last digit, under names and units."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.solution.csv_tables import SERIES, save_events


def _rows(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    return head, rows


def test_states_are_those_of_the_samples(drift: ns.Solution, tmp_path: Path) -> None:
    head, rows = _rows(drift.export(tmp_path / "run.csv"))
    assert head[0] == "time [s]"
    numbers = np.array(rows, dtype=float)
    np.testing.assert_array_equal(numbers[:, 0], drift.t)
    states, n_q = drift.at(), drift.q.shape[1]
    np.testing.assert_array_equal(numbers[:, 1 : 1 + n_q], states["q"])
    np.testing.assert_array_equal(numbers[:, 1 + n_q : 1 + n_q + drift.u.shape[1]], states["u"])
    assert "q dumbbell x [m]" in head
    assert "u dumbbell wx [rad/s]" in head


def test_energies_have_their_names_and_units(drift: ns.Solution, tmp_path: Path) -> None:
    head, rows = _rows(drift.export(tmp_path / "run.csv", series="energies"))
    column = head.index("kinetic_energy [J]")
    np.testing.assert_array_equal(
        [float(row[column]) for row in rows], drift.history("kinetic_energy")["kinetic_energy"]
    )


def test_a_history_of_ones_own(drift: ns.Solution, tmp_path: Path) -> None:
    """One body at one time, and one contact at some."""
    poses = drift.history("position", times=0.1, of="dumbbell")
    head, (row,) = _rows(drift.export(tmp_path / "pose.csv", series=poses))
    assert [float(row[head.index(f"position dumbbell {axis} [m]")]) for axis in "xyz"] == poses["position"][0].tolist()
    times = np.linspace(0.0, 0.3, 31)
    contact = drift.history("normal_force", times=times, of=0)
    head, rows = _rows(drift.export(tmp_path / "contact.csv", series=contact))
    np.testing.assert_array_equal(
        [float(row[head.index(f"normal_force {contact.labels['contact'][0]} [N]")]) for row in rows],
        contact["normal_force"][:, 0],
    )


@pytest.mark.parametrize("series", SERIES)
def test_each_series_has_rows(arm: ns.Solution, tmp_path: Path, series: str) -> None:
    head, rows = _rows(arm.export(tmp_path / "run.csv", series=series))
    assert len(rows) == (len(arm.events) if series == "events" else len(arm.t))
    assert all(len(row) == len(head) for row in rows)
    assert len({*head}) == len(head)


def test_events_are_those_that_results_have(drift: ns.Solution, tmp_path: Path) -> None:
    save_events(drift, tmp_path / "events.csv")
    path = drift.export(tmp_path / "run.csv", series="events")
    assert path.read_bytes() == (tmp_path / "events.csv").read_bytes()
