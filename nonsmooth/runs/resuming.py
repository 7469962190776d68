"""Resume a run that was cut off.

This module is not part of :mod:`nonsmooth.runs.simulate`, because its imports, which read folders of results and
systems, take a tenth of the time of a start.
"""

from __future__ import annotations

from pathlib import Path

from nonsmooth.interfaces import Engine
from nonsmooth.notices import warn
from nonsmooth.results.opening import stored_engine, stored_setup
from nonsmooth.results.output import OtherVersions, Output, versions
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.loop import Progress
from nonsmooth.runs.model import Model
from nonsmooth.runs.so_far import Until
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System


def resume(
    output: Output | Path | str,
    *,
    system: System | None = None,
    engine: Engine | None = None,
    until: Until | None = None,
    progress: Progress | None = None,
    trust: bool = False,
) -> Solution:
    """Resume a run that was cut off; the result equals that of an uninterrupted run to the last bit.

    Parameters
    ----------
    output : Output, Path or str
        The folder of the run's results, to which the remaining results are appended.
    system : System, optional
        The system that ran; by default it is built from the folder.
    engine : Engine, optional
        The engine that ran it; by default the one that the folder names.
    until : callable, optional
        The condition that ends the run, if the run had one; a folder cannot hold it.
    progress : callable, optional
        As for :func:`nonsmooth.simulate`.
    trust : bool, optional
        True if the folder may name code outside of installed plug-ins, as for :func:`nonsmooth.load_system`.

    Returns
    -------
    Solution
        The solution of the whole run.

    Warns
    -----
    OtherVersions
        If the run began with other versions of the programs that compute it.

    Raises
    ------
    InvalidInput
        If the folder holds no run that was cut off, the system is not the one that ran or cannot be built, or the
        condition is missing.
    PluginError
        If a class of the system cannot be loaded.
    RunFailed
        As :func:`nonsmooth.simulate`.
    """
    where = Output.to(output)
    folder = check_resumable(where)
    made = system or stored_setup(where, folder, trust).system
    return Model.of(made, engine or stored_engine(where, folder, trust)).resume(where, until=until, progress=progress)


def check_resumable(where: Output) -> SolutionFolder:
    """Folder of a run that can be resumed. A warning names programs of other versions; errors as :func:`resume`."""
    folder = SolutionFolder.opened(where)
    folder.check_cut_off()
    began, now = folder.said("versions"), versions()
    other = [f"{name} {began.get(name)}, now {now.get(name)}" for name in now if began.get(name) != now.get(name)]
    if other:
        text = f"{where.folder}: the run began with {'; '.join(other)}. Its last bits may differ from there on."
        # the warning names the line that called the caller of this function
        warn(text, OtherVersions)
    return folder
