"""Many runs of one model: on the threads of this machine, or on the workers of a Dask cluster."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._columns import Columns
from ._model import Kind, Model, Options, choices_of, simulation_of
from ._progress import Progress, reporter

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Unpack

__all__ = ["SweepTable", "sweep"]

#: Index of the point, parameters, measures, status, number of warnings, reason.
Row = tuple[int, list[float], list[float], str, int, str]

#: Most choices of the other parameters that have a curve each.
_MOST_CHOICES = 8


class SweepTable(Columns):
    """Runs of a sweep: a column for each parameter and measure, a row a run; `len` counts runs.

    Attributes
    ----------
    parameters, measures : tuple of str
        Names of the columns.
    units : dict of str to str
        Units of the measures.
    status : tuple of str
        How each run ended: ``"completed"``, ``"stopped"`` …
    warnings : ndarray of int
        Number of warnings of each run.
    reasons : tuple of str
        Why it ended early; empty: it did not.

    Examples
    --------
    >>> table["max(abs(FX(41,11)))"]  # doctest: +SKIP
    array([12.3, …])
    """

    def __init__(
        self,
        parameters: Sequence[str],
        measures: Sequence[tuple[str, str]],
        rows: Sequence[Row],
        text: str,
    ) -> None:
        self.parameters = tuple(parameters)
        self.measures = tuple(name for name, _ in measures)
        self.units = dict(measures)
        n, n_values, n_measures = len(rows), len(self.parameters), len(self.measures)
        values = np.array([row[1] for row in rows], dtype=np.float64).reshape(n, n_values)
        measured = np.array([row[2] for row in rows], dtype=np.float64).reshape(n, n_measures)
        self._columns = {name: values[:, k].copy() for k, name in enumerate(self.parameters)}
        self._columns.update({m: measured[:, k].copy() for k, m in enumerate(self.measures)})
        self.run = np.array([row[0] for row in rows], dtype=np.int64)
        self.status = tuple(row[3] for row in rows)
        self.warnings = np.array([row[4] for row in rows], dtype=np.int64)
        self.reasons = tuple(row[5] for row in rows)
        self._text = text

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self.run)

    @property
    def ok(self) -> NDArray[np.bool_]:
        """True for each run that was completed."""
        return np.array([status == "completed" for status in self.status], dtype=np.bool_)

    def to_pandas(self) -> pandas.DataFrame:
        """Make a table of pandas, a row a run.

        Returns
        -------
        pandas.DataFrame
            Parameters, measures, ``status``, ``warnings``, ``reason``; the index is the run.
        """
        import pandas

        columns: dict[str, Any] = dict(self._columns)
        columns.update(status=self.status, warnings=self.warnings, reason=self.reasons)
        frame = pandas.DataFrame(columns, index=pandas.Index(self.run, name="run"))
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table as ``cognate sweep`` does: names, units, then a line a run.

        Parameters
        ----------
        path : path-like
            The file.
        """
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self._text)

    def plot(self, x: str | None = None, y: str | None = None, *, ax: Any = None) -> Any:
        """Plot a measure over a parameter with matplotlib.

        Each choice of the other parameters has a curve; the runs are points where there are more
        than eight, or where one has a single run.

        Parameters
        ----------
        x : str, optional
            The parameter; the first where left out.
        y : str, optional
            The measure; the first where left out.
        ax : matplotlib.axes.Axes, optional
            Where to plot; a new figure where left out.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from matplotlib import pyplot

        x, y = x or self.parameters[0], y or self.measures[0]
        if ax is None:
            _, ax = pyplot.subplots()
        choices = self._choices(x)
        is_joined = len(choices) <= _MOST_CHOICES and min(map(len, choices.values()), default=0) > 1
        for label, rows in choices.items() if is_joined else [("", range(len(self.run)))]:
            order = sorted(rows, key=lambda row: float(self[x][row]))
            ax.plot(self[x][order], self[y][order], "o-" if is_joined else "o", label=label)
        if is_joined and len(choices) > 1:
            ax.legend()
        unit = self.units.get(y, "")
        ax.set_xlabel(x)
        ax.set_ylabel(f"{y} [{unit}]" if unit else y)
        return ax

    def _choices(self, x: str) -> dict[str, list[int]]:
        """Return the rows in which all parameters but `x` are the same, by these."""
        others = [name for name in self.parameters if name != x]
        choices: dict[str, list[int]] = {}
        for row in range(len(self.run)):
            named = ", ".join(f"{name} = {self[name][row]:.6g}" for name in others)
            choices.setdefault(named, []).append(row)
        return choices

    def __repr__(self) -> str:
        done = int(self.ok.sum())
        return f"<SweepTable: {len(self)} runs, {done} completed, {len(self._columns)} columns>"


@dataclass(frozen=True)
class Job:
    """Everything that a worker needs to run points: picklable, and made into a sweep once."""

    model: Model
    options: dict[str, Any]
    simulation: dict[str, Any]
    commands: str | None
    names: list[str]
    measures: list[str]
    key: str = field(default_factory=lambda: uuid.uuid4().hex)

    def sweep(self) -> _core.Sweep:
        """Make the sweep."""
        commands = None if self.commands is None else _core.Commands.from_text(self.commands)
        return _core.Sweep(
            self.model._core, self.options, self.simulation, commands, self.names, self.measures
        )


def sweep(
    model: Model,
    parameters: Mapping[str, Any],
    measures: str | Sequence[str],
    end: float | None = None,
    steps: int | None = None,
    *,
    kind: Kind = "transient",
    dtout: float | None = None,
    commands: str | None = None,
    design: Literal["grid", "latin"] | Any = "grid",
    runs: int | None = None,
    seed: int = 0,
    threads: int | None = None,
    out: str | os.PathLike[str] | None = None,
    client: Any = None,
    chunk: int | None = None,
    progress: bool | Progress | None = None,
    **options: Unpack[Options],
) -> SweepTable:
    """Run a model again and again with other numbers; make one table with a row a run.

    Parameters
    ----------
    model : Model
        The model.
    parameters : mapping of str to str or sequence of float
        Numbers of the model by their names, and their values: ``{"PART/2.MASS": [1, 2, 5]}``, or a
        range as a text, ``{"VARIABLE/3": "0.1:0.5:9"}``.
    measures : str or sequence of str
        ``"max(abs(FX(41,11)))"``: max, min, mean, rms, first, last, time_of_max or time_of_min of
        an expression.
    end, steps, kind, dtout
        The simulation that each run does, as for `Model.run`.
    commands : str, optional
        Commands that each run obeys in place of a simulation, one a line.
    design : {"grid", "latin"} or array_like
        All combinations; a latin hypercube of `runs` points; or the points themselves, a row a run.
    runs, seed : int
        Points of a latin hypercube. The same seed gives the same points.
    threads : int, optional
        Threads; all processors where left out. No bit of a row depends on it.
    out : path-like, optional
        File of the table, which grows as runs are done. A sweep that was ended goes on with it.
    client : dask.distributed.Client, optional
        The cluster whose workers do the runs, in place of threads here.
    chunk : int, optional
        Runs that a worker is given at a time.
    progress : bool or callable, optional
        Called with the number of runs that are done. None: a bar in notebooks.
    **options
        See `Options`.

    Returns
    -------
    SweepTable
        The rows, in the order of the points. A run that fails is a row without measures, with its
        reason.

    Raises
    ------
    ModelError
        Mistakes in names, measures and commands, all at once, before anything runs.
    KeyboardInterrupt
        Ctrl-C; its attribute ``table`` holds the rows so far.

    Examples
    --------
    >>> table = cg.sweep(  # doctest: +SKIP
    ...     model, {"PART/4.MASS": "0.5:2:7"}, "max(abs(slider.ACCX))", end=1.0, steps=200
    ... )
    """
    if isinstance(measures, str):
        measures = [measures]
    simulation = simulation_of(kind, end, None, steps, dtout)
    job = Job(
        model, choices_of(model, {"accuracy": False, **options}), simulation, commands, list(parameters), list(measures)
    )
    core = job.sweep()
    points = _points(design, parameters, runs, seed)
    table = None if out is None else _core.Table(os.fspath(out), core, points)
    rows: dict[int, Row] = {} if table is None else {row[0]: row for row in table.rows}
    wanted = [run for run in range(len(points)) if run not in rows]
    report, close = reporter(progress, 0.0, float(len(points)), "runs")

    def take(row: Row) -> None:
        if row[0] in rows:
            return
        rows[row[0]] = row
        if table is not None:
            table.push(row)
        if report is not None:
            report(float(len(rows)))

    def finished() -> SweepTable:
        all_rows = [rows[run] for run in sorted(rows)]
        return SweepTable(core.parameters, core.measures, all_rows, core.table(all_rows))

    try:
        if client is None:
            core.run(points, wanted, threads or os.cpu_count() or 1, take)
        else:
            from ._cluster import run_on_cluster

            run_on_cluster(client, job, points, wanted, chunk, take)
    except KeyboardInterrupt as stopped:
        stopped.table = finished()  # type: ignore[attr-defined]
        raise
    finally:
        close()
    if table is not None:
        table.complete()
    return finished()


def _points(
    design: Any, parameters: Mapping[str, Any], runs: int | None, seed: int
) -> list[list[float]]:
    """Return the points of a design, a list of values each."""
    if isinstance(design, str):
        values = [
            given if isinstance(given, str) else [float(x) for x in given]
            for given in parameters.values()
        ]
        return _core.design_points(design, values, runs, seed)
    points = np.asarray(design, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != len(parameters):
        raise ValueError(f"design has shape {points.shape}; it has a column for each parameter")
    return [list(point) for point in points.tolist()]
