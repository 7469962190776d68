"""What is on disk when a run has ended: samples, events, labels, units, system, and a solution again."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.plugins import registry
from nonsmooth.solution.csv_tables import save_events
from tests.results.runs import balls
from tests.runs.continued import differences

_UNIT = r"(1|m|s|kg|rad|N|J)(\^\d)?"
CF_UNIT = re.compile(rf"{_UNIT}( {_UNIT})*(/{_UNIT})?")
"""Units of the udunits library, as far as arrays have them here."""


@pytest.mark.parametrize("name", registry.names("scenarios"))
def test_units_of_coordinates_can_be_read(name: str) -> None:
    """The conformance kit looks whether all have one."""
    units = registry.load("scenarios", name).coordinate_units
    assert all(CF_UNIT.fullmatch(unit) for unit in units.values())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where the results of a run go."""
    return tmp_path_factory.mktemp("results")


@pytest.fixture(scope="module")
def solution(folder: Path) -> ns.Solution:
    """Return the solution of that run."""
    return ns.simulate(balls(), 0.2, output=ns.Output(folder, "two balls"))


@pytest.mark.slow
def test_the_dataset_has_samples_events_labels_and_units(solution: ns.Solution, folder: Path) -> None:
    import xarray

    events = solution.events
    with xarray.open_zarr(folder / "solution.zarr") as saved:
        saved.load()
    for name, wanted in (("time", solution.t), ("q", solution.q), ("u", solution.u), ("event_time", events.time)):
        np.testing.assert_array_equal(saved[name], wanted)
    words = saved["event_cause"].attrs["flag_meanings"].split()
    assert [words[code] for code in saved["event_cause"].values] == [c.replace(" ", "_") for c in events.causes()]
    # contiguous ragged: the entries of an event stand behind those of the events before
    place = np.repeat(np.arange(len(events)), saved["event_size"]), saved["listed_contact"].values
    impulse, after = np.zeros_like(events.impulse), np.zeros_like(events.after)
    impulse[place], after[place] = saved["impulse"], saved["mode_after"]
    np.testing.assert_array_equal(impulse, events.impulse)
    np.testing.assert_array_equal(after, events.after)
    assert saved["body"].values.tolist() == ["ball 1", "ball 2", "plate"]
    assert saved["contact"].values.tolist() == ["plate - ball 1", "plate - ball 2", "ball 1 - ball 2"]
    assert saved["coordinate"].values[7:10].tolist() == ["ball 2 x", "ball 2 y", "ball 2 z"]
    assert saved["velocity_units"].values[:6].tolist() == 3 * ["m/s"] + 3 * ["rad/s"]
    for one in saved.variables.values():
        assert one.attrs["long_name"]
        # columns that have units of their own have these beside them; those of inner states only their law knows
        along = f"{one.dims[-1]}_units" if one.dims else ""
        known = one.dtype.kind == "T" or CF_UNIT.fullmatch(one.attrs.get("units", "")) or along in saved.variables
        assert known or one.dims[-1] == "of_law_state", one
    for along in ("coordinate_units", "velocity_units", "of_memory_units"):
        assert all(CF_UNIT.fullmatch(unit) for unit in saved[along].values)
    for name in ("status", "message", "t_end"):
        assert saved.attrs[name] == getattr(solution, name)
    assert saved.attrs["restitution_loss"] == solution.energy.restitution_loss


@pytest.mark.slow
def test_it_is_the_dataset_of_the_solution(solution: ns.Solution, folder: Path) -> None:
    import xarray

    with xarray.open_zarr(folder / "solution.zarr") as saved:
        rest = saved.drop_dims(["of_account", "of_law_state", "of_booked", "of_memory"])
        xarray.testing.assert_equal(solution.to_xarray(), rest.drop_vars("system").load())


def test_the_file_holds_the_system_and_is_a_solution_again(solution: ns.Solution, folder: Path, tmp_path: Path) -> None:
    import xarray

    opened = ns.open_solution(folder)
    assert differences(solution, opened) == []
    assert (opened.status, opened.message, opened.counters) == (solution.status, solution.message, solution.counters)
    times = np.linspace(0.0, 0.2, 23)
    names = ("q", "u", "mode", "normal_force", "friction_force", "contact_point", "kinetic_energy", "friction_loss")
    told, again = (run.history(*names, times=times) for run in (solution, opened))
    for name in names:
        np.testing.assert_allclose(again[name], told[name], rtol=1e-12, atol=1e-15, err_msg=name)
    # the state goes on, behind the end of the run
    one, other = (ns.assemble(balls()).run(0.3, start=run.state) for run in (solution, opened))
    assert differences(one, other) == []
    with xarray.open_zarr(folder / "solution.zarr") as saved:
        (tmp_path / "system.toml").write_text(saved["system"].item())
    setup = ns.load_system(tmp_path / "system.toml")
    assert (setup.t_end, setup.title) == (0.2, "two balls")


def test_the_table_has_every_event_exactly(solution: ns.Solution, tmp_path: Path) -> None:
    save_events(solution, tmp_path / "events.csv")
    with (tmp_path / "events.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    events, names = solution.events, ["plate - ball 1", "plate - ball 2", "ball 1 - ball 2"]
    assert [float(row["time [s]"]) for row in rows] == events.time.tolist()
    assert [row["cause"] for row in rows] == events.causes()
    assert [float(row["friction_loss [J]"]) for row in rows] == events.friction_loss.tolist()
    modes = np.zeros(3, np.int64)
    for row, before, during, after in zip(rows, events.before, events.during, events.after, strict=True):
        np.testing.assert_array_equal(modes, before)
        for words in filter(None, row["modes"].split("; ")):
            name, *bits = words.rsplit(" ", 3)
            told = [int(word[::-1], 2) for word in bits]
            c = names.index(name)
            assert told == [before[c], during[c], after[c]]
            modes[c] = told[2]
        np.testing.assert_array_equal(modes, after)


_OF_CONTACTS = ("event_size", "event_contact", "impulse", "mode_before", "mode_during", "mode_after")


@pytest.mark.slow
def test_what_events_keep_of_contacts_takes_a_fiftieth_of_what_dense_rows_would(tmp_path: Path) -> None:
    from scenarios.dice_throw import DiceThrow

    dice = DiceThrow()
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval, output=tmp_path)
    save_events(solution, tmp_path / "events.csv")
    events = solution.events
    dense = events.impulse.nbytes + sum(len("".join(events.words(which))) for which in ("before", "during", "after"))
    folders = [tmp_path / "solution.zarr" / name for name in _OF_CONTACTS]
    sparse = sum(path.stat().st_size for folder in folders for path in folder.rglob("*") if path.is_file())
    assert 0 < 50 * sparse < dense
    assert 10 * (tmp_path / "events.csv").stat().st_size < dense
