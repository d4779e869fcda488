"""Results: columns as arrays, units, tables, pictures, files."""

from __future__ import annotations

import html
import json
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._columns import Columns
from ._errors import ColumnError, Diagnostic, ResultsError

if TYPE_CHECKING:
    import pandas
    import xarray

    from ._model import Model

__all__ = ["Animation", "Run", "get_results", "read_res", "read_results"]


class Animation:
    """A page that shows a run in motion; notebooks show it in place.

    Attributes
    ----------
    html : str
        The page: it needs no server, no network and nothing beside it.
    title : str
        Its title.
    """

    #: Height in a notebook, in pixels.
    height = 560

    def __init__(self, page: str, title: str) -> None:
        self.html = page
        self.title = title

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page.

        Parameters
        ----------
        path : path-like
            The file, whose name ends in ``.html``.
        """
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        # a frame keeps the scripts and styles of the page and of the notebook apart
        page = html.escape(self.html, quote=True)
        style = f"width: 100%; height: {self.height}px; border: 0"
        return f'<iframe srcdoc="{page}" style="{style}"></iframe>'

    def __repr__(self) -> str:
        return f"<Animation {self.title!r}: {len(self.html) // 1024} kB>"


class Run(Columns):
    """Results of a run: columns by their names, a row for each output; `len` counts rows.

    Arrays are views of the memory of the run, without a copy; they cannot be written, and keep
    that memory alive. Names are found without regard to blanks and case; ``"crank_bearing.FX"`` and
    ``"JOINT/1.FX"`` are components of elements. Runs can be pickled.

    Examples
    --------
    >>> run["slider.X"]  # doctest: +SKIP
    array([200., ...])
    >>> run.units["slider.X"]  # doctest: +SKIP
    'mm'
    """

    def __init__(self, core: _core.Results, model: _core.Model | None = None) -> None:
        self._core = core
        self._model = model
        self._columns = core.columns
        self._table = core.table
        self._arrays: dict[int, NDArray[np.float64]] = {}
        self._record: dict[str, Any] | None = None

    # --- columns -----------------------------------------------------------------------------

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self._array(self._core.resolve(name))

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self._core.find(name) is not None

    def __iter__(self) -> Iterator[str]:
        return (self._columns[index][0] for index in self._table)

    def __len__(self) -> int:
        return len(self.time)

    def _array(self, index: int) -> NDArray[np.float64]:
        if index not in self._arrays:
            self._arrays[index] = self._core.column(index)
        return self._arrays[index]

    @staticmethod
    def _no_column(message: str, advice: list[str]) -> ColumnError:
        said = Diagnostic("unknown_column", "error", message, advice=tuple(advice))
        text = "\n  help: ".join([f"error[{said.code}]: {said.message}", *advice])
        return ColumnError([Diagnostic(**{**vars(said), "text": text})])

    @property
    def time(self) -> NDArray[np.float64]:
        """Time of every row."""
        return self._array(0)

    @property
    def units(self) -> dict[str, str]:
        """Units of all columns, by name, as result files spell them; empty: a pure number."""
        return {name: unit for name, unit, _ in self._columns}

    @property
    def names(self) -> list[str]:
        """Names of all columns, also of those that tables do not show."""
        return [name for name, _, _ in self._columns]

    @property
    def entities(self) -> dict[str, dict[str, str]]:
        """Result sets of elements: the column of every component, by their names."""
        return {
            name: {component: self._columns[index][0] for component, index in components}
            for name, _, _, _, components in self._core.entities
        }

    @property
    def sequences(self) -> list[tuple[str, str, slice]]:
        """Simulations: name, kind, and their rows."""
        first = self._first_row
        return [
            (name, kind, slice(max(start - first, 0), end - first))
            for name, kind, start, end in self._core.sequences
            if kind != "modelInput"
        ]

    @property
    def _first_row(self) -> int:
        inputs = [end for _, kind, _, end in self._core.sequences if kind == "modelInput"]
        return max(inputs, default=0)

    def bars(self, name: str) -> NDArray[np.float64]:
        """Return the bars of error of a column, of a run with ``accuracy=True``.

        Parameters
        ----------
        name : str
            The column.

        Returns
        -------
        ndarray
            How far its values may be off.
        """
        of = self._core.resolve(name)
        for index, (_, _, bar_of) in enumerate(self._columns):
            if bar_of == of:
                return self._array(index)
        what = f"the column `{name}` has no bars of error"
        raise self._no_column(what, ["they are asked for before a run: model.run(…, accuracy=True)"])

    def measure(self, expression: str, model: Model | None = None) -> NDArray[np.float64]:
        """Find a displacement, velocity or acceleration of markers from what has been recorded.

        Parameters
        ----------
        expression : str
            One measure of markers: ``"DX(41,22)"``, ``"WZ(20)"``.
        model : Model, optional
            The model of the run; results that were read from a file do not know it.

        Returns
        -------
        ndarray
            Its values at every row; nothing is solved again.

        Raises
        ------
        ModelError
            The motion of a part is not recorded: run with ``full=True``.
        """
        return self._core.measure(self._of(model), expression)

    # --- the record --------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Base name of files."""
        return self._core.name

    @property
    def title(self) -> str:
        """Title of the dataset."""
        return self._core.title

    @property
    def accuracy(self) -> str | None:
        """How far off the run is, as it has measured it, in a sentence: how many digits to believe.

        The figures are in `record`. None where nothing was integrated, or nothing was measured.
        """
        accuracy = self.record["accuracy"]
        return accuracy["sentence"] if accuracy else None

    @property
    def record(self) -> dict[str, Any]:
        """Status, counts, timings, energy, accuracy and warnings, as ``cognate run --json``."""
        if self._record is None:
            self._record = json.loads(self._core.record)
        return self._record

    @property
    def status(self) -> str:
        """How it ended: ``"completed"``, ``"stopped"``, ``"no_equilibrium"``, ``"limit"`` …"""
        return str(self.record["status"])

    @property
    def ok(self) -> bool:
        """True if everything was done that was asked for."""
        return self.status == "completed"

    @property
    def stop_reason(self) -> str:
        """Why it ended early, in a sentence; empty: it did not."""
        return str(self.record["stop_reason"])

    @property
    def warnings(self) -> list[str]:
        """What the user should know although the run went on."""
        return [str(warning) for warning in self.record["warnings"]]

    @property
    def log(self) -> str:
        """What happened, in order, as the ``.msg`` file tells it."""
        return self._core.log

    # --- other forms -------------------------------------------------------------------------

    def to_pandas(self, columns: Sequence[str] | None = None) -> pandas.DataFrame:
        """Make a table of pandas, whose index is time.

        Parameters
        ----------
        columns : sequence of str, optional
            The columns; those that tables show where left out.

        Returns
        -------
        pandas.DataFrame
            The table; units are in ``attrs["units"]``.
        """
        import pandas

        chosen = self._chosen(columns)
        data = {self._columns[index][0]: self._array(index) for index in chosen}
        frame = pandas.DataFrame(data, index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = {"time": self._columns[0][1], **self._units(chosen)}
        return frame

    def to_xarray(self, columns: Sequence[str] | None = None) -> xarray.Dataset:
        """Make a dataset of xarray over time.

        Parameters
        ----------
        columns : sequence of str, optional
            The columns; those that tables show where left out.

        Returns
        -------
        xarray.Dataset
            A variable for each column, with its unit in ``attrs["units"]``.
        """
        import xarray

        variables = {
            self._columns[index][0]: ("time", self._array(index), {"units": self._columns[index][1]})
            for index in self._chosen(columns)
        }
        time = ("time", self.time, {"units": self._columns[0][1]})
        return xarray.Dataset(variables, coords={"time": time}, attrs={"title": self.title})

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write a Parquet file, units in its metadata.

        Parameters
        ----------
        path : path-like
            The file, whose name ends in ``.parquet``.
        """
        self._write_as("parquet", path)

    def to_csv(
        self, path: str | os.PathLike[str], *, units: bool = True, decimal_comma: bool = False
    ) -> None:
        """Write comma-separated values.

        Parameters
        ----------
        path : path-like
            The file, whose name ends in ``.csv``.
        units : bool
            A row of units below the names.
        decimal_comma : bool
            A comma in numbers, and ``;`` between them.
        """
        self._write_as("csv", path, units=units, decimal_comma=decimal_comma)

    def to_res(self, path: str | os.PathLike[str]) -> None:
        """Write a results file that pre- and postprocessors read.

        Parameters
        ----------
        path : path-like
            The file, whose name ends in ``.res``.
        """
        self._write_as("res", path)

    def _write_as(self, ending: str, path: str | os.PathLike[str], **style: bool) -> None:
        if not os.fspath(path).lower().endswith("." + ending):
            raise ValueError(f"the name of the file ends in .{ending}")
        self._core.write(path, **style)

    def _chosen(self, columns: Sequence[str] | None) -> list[int]:
        if columns is None:
            return [index for index in self._table if index != 0]
        if isinstance(columns, str):
            raise TypeError("columns is a list of names, not one text")
        chosen = [index for name in columns for index in self._core.resolve_all(name)]
        return list(dict.fromkeys(chosen))

    def _units(self, chosen: Sequence[int]) -> dict[str, str]:
        return {self._columns[index][0]: self._columns[index][1] for index in chosen}

    # --- pictures ----------------------------------------------------------------------------

    def plot(self, columns: Sequence[str] | str | None = None, *, ax: Any = None) -> Any:
        """Plot columns over time with matplotlib; bars of error as bands.

        Parameters
        ----------
        columns : sequence of str, or str, optional
            The columns, or patterns such as ``"slider.*"``; those that tables show where left out.
        ax : matplotlib.axes.Axes, optional
            Where to plot; a figure with one panel for each unit where left out.

        Returns
        -------
        matplotlib.axes.Axes or ndarray of them
            The axes.
        """
        wanted = [columns] if isinstance(columns, str) else columns
        chosen = [i for i in self._chosen(wanted) if self._columns[i][2] is None]
        units = list(dict.fromkeys(self._columns[index][1] for index in chosen))
        if ax is None:
            from matplotlib import pyplot

            height = 2.4 * max(len(units), 1)
            _, panels = pyplot.subplots(
                max(len(units), 1), 1, sharex=True, squeeze=False, figsize=(7, height)
            )
            axes = list(panels[:, 0])
        else:
            axes = [ax] * max(len(units), 1)
        for index in chosen:
            name, unit, _ = self._columns[index]
            panel = axes[units.index(unit)]
            (line,) = panel.plot(self.time, self._array(index), label=name)
            for bar, (_, _, bar_of) in enumerate(self._columns):
                if bar_of == index:
                    low, high = self[name] - self._array(bar), self[name] + self._array(bar)
                    panel.fill_between(self.time, low, high, color=line.get_color(), alpha=0.25)
        for unit, panel in zip(units, axes):
            panel.set_ylabel(unit if ax is None else ", ".join(u for u in units if u))
            panel.legend()
        axes[-1].set_xlabel(f"time [{self._columns[0][1]}]")
        return axes[0] if ax is not None or len(axes) == 1 else np.array(axes)

    def animate(self, model: Model | None = None) -> Animation:
        """Make a page that shows the mechanism in motion, with its columns beside it.

        Parameters
        ----------
        model : Model, optional
            The model of the run; results that were read from a file do not know it.

        Returns
        -------
        Animation
            Shown by notebooks; `Animation.save` writes it as a file that needs nothing else.

        Raises
        ------
        ResultsError
            The run does not say where its parts are: run with ``frames=True``.
        """
        of = self._of(model)
        try:
            page, unread = self._core.page(of)
        except ResultsError as wrong:
            advice = "a run says where its parts are with frames=True: model.run(…, frames=True)"
            said = [
                replace(d, advice=(advice,), text=f"{d.text.splitlines()[0]}\n  help: {advice}")
                for d in wrong.errors
            ]
            raise ResultsError(said) from None
        for shell in unread:
            warnings.warn(shell, stacklevel=2)
        return Animation(page, self.title or self.name)

    def _of(self, model: Model | None) -> _core.Model:
        of = self._model if model is None else model._core
        if of is None:
            raise TypeError("results of a file do not know their model: give it")
        return of

    def _repr_html_(self) -> str:
        record = self.record
        facts = [
            ("status", self.status + (f": {self.stop_reason}" if self.stop_reason else "")),
            ("rows", f"{len(self)}"),
            ("columns", f"{len(self._table)} shown of {len(self._columns)}"),
            ("method", str(record.get("method", ""))),
            ("steps", str(record.get("steps", ""))),
        ]
        facts += [("warning", warning) for warning in self.warnings]
        rows = "".join(
            f"<tr><th>{html.escape(key)}</th><td>{html.escape(value)}</td></tr>"
            for key, value in facts
            if value
        )
        return f"<table><caption>{html.escape(self.title or self.name)}</caption>{rows}</table>"

    def __repr__(self) -> str:
        return f"<Run {self.name!r}: {self.status}, {len(self)} rows, {len(self._table)} columns>"

    def __reduce__(self) -> tuple[Any, ...]:
        model = None if self._model is None else (self._model.text, self._model.file)
        return _restored, (self._core, model)


def _restored(core: _core.Results, model: tuple[str, str | None] | None) -> Run:
    """Return the run that was pickled."""
    return Run(core, None if model is None else _core.Model.from_text(*model))


def read_results(path: str | os.PathLike[str]) -> Run:
    """Read a file of results: ``.res``, ``.csv``, ``.parquet``, ``.json``, ``.gra``.

    Parameters
    ----------
    path : path-like
        The file; the ending of its name tells the format.

    Returns
    -------
    Run
        Its columns. The record of a file says nothing of how the run went.

    Raises
    ------
    ResultsError
        A file that cannot be read, with the line.
    FileNotFoundError
        The file is not there; it is a ResultsError, too.
    """
    return Run(_core.Results.read(path))


def read_res(path: str | os.PathLike[str]) -> Run:
    """Read a results file (``.res``), as Adams or this package writes it.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    Run
        Its columns: ``run["REQ_1.X"]``; `Run.entities` names result sets and components.

    Raises
    ------
    ResultsError
        A file that cannot be read, with the line.
    """
    return read_results(path)


def get_results(
    path: str | os.PathLike[str],
    reqs_to_get: Mapping[str, Sequence[str]] | None = None,
    t_min: float | None = None,
    t_max: float | None = None,
) -> tuple[pandas.DataFrame, dict[str, dict[str, str]]]:
    """Read components of result sets from a results file.

    Parameters
    ----------
    path : path-like
        The file.
    reqs_to_get : mapping of str to sequence of str, optional
        Components by result set, ``{"REQ_1": ["X"]}``; all where left out.
    t_min, t_max : float, optional
        First and last time.

    Returns
    -------
    data : pandas.DataFrame
        A column ``(result set, component)`` for each; the index is time.
    units : dict of dict
        ``units[result set][component]``.

    Raises
    ------
    ResultsError
        A file that cannot be read.
    ColumnError
        A result set or component that it does not have.
    """
    import pandas

    run = read_results(path)
    sets = {name: components for name, components in run.entities.items()}
    wanted = {name: list(sets[name]) for name in sets} if reqs_to_get is None else reqs_to_get
    data: dict[tuple[str, str], NDArray[np.float64]] = {}
    units: dict[str, dict[str, str]] = {}
    unit_of = run.units
    for name, components in wanted.items():
        for component in components:
            column = sets.get(name, {}).get(component, f"{name}.{component}")
            data[name, component] = run[column]
            units.setdefault(name, {})[component] = unit_of.get(column, "")
    frame = pandas.DataFrame(data, index=pandas.Index(run.time, name="time"))
    low = -np.inf if t_min is None else t_min
    high = np.inf if t_max is None else t_max
    return frame[(frame.index >= low) & (frame.index <= high)], units
