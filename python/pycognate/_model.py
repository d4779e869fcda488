"""Models: read, change, verify, run, linearize."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, SupportsFloat, SupportsIndex, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import Diagnostic, IncompleteRun
from ._linear import LinearSystem, Mode, modes_of, system_of
from ._progress import Progress, reporter
from ._run import Run
from ._verify import Verification

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._builder import ModelBuilder
    from ._sweep import SweepTable

__all__ = ["Model", "Options", "RunOptions", "Session", "run"]

#: Kinds of simulations.
Kind = Literal["transient", "dynamic", "kinematic", "static", "initial_conditions"]

#: A routine for USER: called with time, the numbers of USER and the values of its inputs.
Law = Callable[[float, NDArray[np.float64], NDArray[np.float64]], "float | Iterable[float]"]


class Options(TypedDict, total=False):
    """Keywords of every run; what is left out is as the dataset says.

    Attributes
    ----------
    columns : sequence of str
        Further columns: any expressions of the function language, in which elements may have their
        names (``"DX(slider.cm, ground)"``), and components of sets of results
        (``"crank_bearing.FX"``).
    error : float
        Permitted local error of the integration.
    method : str
        Method of integration (``"AUTO"`` chooses by itself).
    accuracy : bool
        True: give every column bars of error, from a further run at a smaller request. False: say
        nothing. Where left out a run by itself says how many digits to believe (`Run.accuracy`),
        from a further integration at a larger request, which costs about six tenths of the run,
        unless a routine for USER would be called again; sessions and the runs of a sweep do not.
    full : bool
        Sets of results of all elements. Where left out: if the dataset asks for RESULTS, and if
        nothing else is asked for, no column and no REQUEST (of a model of more than 400 elements
        then the places of the bodies alone). False: what is asked for alone.
    frames : bool
        Positions and angles of all parts, whatever else is recorded.
    max_steps : int
        Steps that an integration may try before the run ends with status ``"limit"``.
    limit : float
        Processor time after which the run ends with status ``"limit"`` [s].
    skip : sequence of str
        Keywords of statements that are left out where they are not solved.
    zero_user : bool
        Take what USER would compute as zero.
    piecewise : bool
        Run motions whose displacement or velocity jumps, piece by piece.
    name : str
        Base name of files of results.
    """

    columns: Sequence[str]
    error: float
    method: str
    accuracy: bool
    full: bool
    frames: bool
    max_steps: int
    limit: float
    skip: Sequence[str]
    zero_user: bool
    piecewise: bool
    name: str


class RunOptions(Options, total=False):
    """Keywords of a run by itself: those of every run, and one that a sweep has for all its runs.

    Attributes
    ----------
    threads : int
        Threads that integrate mechanisms which nothing couples; one where left out. No bit of the
        results depends on it. The runs of `sweep` have one thread each.
    """

    threads: int


def choices_of(model: Model, options: Options) -> dict[str, Any]:
    """Return all keywords, those that were not given with their defaults."""
    defaults: dict[str, Any] = {
        "columns": [],
        "error": None,
        "method": None,
        "accuracy": None,
        "full": None,
        "frames": False,
        "max_steps": None,
        "limit": None,
        "skip": [],
        "zero_user": False,
        "piecewise": False,
        "name": Path(model.file).stem if model.file else "run",
        "threads": None,
    }
    unknown = sorted(set(options) - set(defaults))
    if unknown:
        known = ", ".join(defaults)
        raise TypeError(f"no option {', '.join(unknown)}; there are {known}")
    choices = {**defaults, **options}
    if isinstance(choices["columns"], str):
        raise TypeError("columns is a list of expressions, not one text")
    threads = choices["threads"]
    if threads is not None and not (isinstance(threads, SupportsIndex) and int(threads) > 0):
        raise ValueError(f"threads is a whole number from 1 on, not {threads!r}")
    choices["columns"], choices["skip"] = list(choices["columns"]), list(choices["skip"])
    choices["user"] = [
        {"name": name, "inputs": list(inputs), "law": law}
        for name, (inputs, law) in model._user.items()
    ]
    return choices


def simulation_of(
    kind: Kind, end: float | None, duration: float | None, steps: int | None, dtout: float | None
) -> dict[str, Any]:
    """Return a simulation as the compiled half takes it."""
    numbers = {"end": end, "duration": duration, "dtout": dtout}
    for name, number in numbers.items():
        if number is not None and not isinstance(number, SupportsFloat):
            raise TypeError(f"{name} is a number, not {number!r}")
    if steps is not None and not (isinstance(steps, SupportsIndex) and int(steps) >= 0):
        raise ValueError(f"steps is a whole number from 0 on, not {steps!r}")
    return {"kind": kind, "steps": steps, **numbers}


class Model:
    """A multibody model as its dataset (``.adm``) says.

    Made by `Model.read`, `Model.from_text` or `Model.builder`. Models can be pickled.

    Examples
    --------
    >>> import pycognate as cg
    >>> model = cg.Model.read("examples/slider_crank.adm")  # doctest: +SKIP
    >>> run = model.run(end=1.0, steps=200)  # doctest: +SKIP
    >>> run["slider.X"]  # doctest: +SKIP
    """

    def __init__(self, core: _core.Model) -> None:
        self._core = core
        self._user: dict[str, tuple[tuple[str, ...], Law]] = {}

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, setup: bool = True) -> Model:
        """Read a dataset from a file, and the set-up beside it.

        Parameters
        ----------
        path : path-like
            The file.
        setup : bool
            Obey the file of the same name with the ending ``.toml``, as the command line does:
            chosen loads, functions that give them, and the set-up of runs. False: the dataset
            alone.

        Returns
        -------
        Model
            The model; what is legal but hardly meant is in its `warnings`.

        Raises
        ------
        ModelError
            Every mistake, with place and advice, in its `errors`.
        FileNotFoundError
            The file is not there; it is a ModelError, too.
        """
        return cls(_core.Model.read(path, setup))

    @classmethod
    def from_text(cls, text: str, file: str | None = None) -> Model:
        """Read a dataset from a text.

        Parameters
        ----------
        text : str
            The dataset; its first line is a title.
        file : str, optional
            The file it stands for: in messages, and for the folder of files that it names.

        Returns
        -------
        Model
            The model.

        Raises
        ------
        ModelError
            Every mistake.
        """
        return cls(_core.Model.from_text(text, file))

    @staticmethod
    def builder(title: str) -> ModelBuilder:
        """Begin a model that the program makes.

        Parameters
        ----------
        title : str
            Its title.

        Returns
        -------
        ModelBuilder
            The builder, whose `build` makes the model.
        """
        from ._builder import ModelBuilder

        return ModelBuilder(title)

    @property
    def title(self) -> str:
        """First line of the dataset."""
        return self._core.title

    @property
    def file(self) -> str | None:
        """File that it was read from."""
        return self._core.file

    @property
    def text(self) -> str:
        """The dataset: as written, or as `changed` has left it."""
        return self._core.text

    @property
    def loads(self) -> tuple[list[str], list[str]] | None:
        """Loads that act and loads that are left out, where the set-up chooses; else None."""
        return self._core.loads

    @property
    def elements(self) -> list[str]:
        """Elements that are solved: ``"PART/2"`` and so on."""
        return [f"{keyword}/{number}" for keyword, number, _ in self._core.elements]

    @property
    def names(self) -> dict[str, str]:
        """Names that the dataset gives to elements, by element."""
        return {f"{k}/{n}": name for k, n, name in self._core.elements if name is not None}

    @property
    def warnings(self) -> list[Diagnostic]:
        """Doubts about what is legal but hardly meant, and notes."""
        return self._core.warnings

    def changed(self, commands: str) -> Model:
        """Return a model that statements have changed, as they do in command files.

        Parameters
        ----------
        commands : str
            Statements, one a line: ``"VARIABLE/3, FUNCTION=0.5"``, ``"PART/2, MASS=3"``,
            ``"DEACTIVATE/MOTION, ID=1"``.

        Returns
        -------
        Model
            The changed model; this one stays.

        Raises
        ------
        ModelError
            A mistake in a statement, or an element that does not exist.
        """
        changed = Model(self._core.changed(commands))
        changed._user = dict(self._user)
        return changed

    def user(self, name: str, inputs: Sequence[str] = (), law: Law | None = None) -> Any:
        """Compute what USER stands for by a callable.

        Parameters
        ----------
        name : str
            An element (``"SFORCE/3"``), the text of its ROUTINE, or the first number of USER.
        inputs : sequence of str
            Expressions whose values the callable is given.
        law : callable, optional
            Called as ``law(time, constants, values)`` with the numbers of USER and the values of
            `inputs`. It returns one number for SFORCE, VARIABLE, DIFF and SENSOR; three for VFORCE
            and VTORQUE; six for GFORCE; value and two derivatives in time for MOTION; eight
            components for REQUEST.

        Returns
        -------
        callable
            `law`; without it a decorator.

        Notes
        -----
        It is differentiated by differences, so it must be a function of its arguments alone. What
        it raises ends the run, and is raised by it.

        Examples
        --------
        >>> @model.user("SFORCE/3", inputs=["DX(1, 2)"])  # doctest: +SKIP
        ... def spring(time, constants, values):
        ...     return -constants[0] * values[0]
        """
        if isinstance(inputs, str):
            raise TypeError("inputs is a list of expressions, not one text")

        def keep(given: Law) -> Law:
            self._user[name] = (tuple(inputs), given)
            return given

        return keep if law is None else keep(law)

    def run(
        self,
        end: float | None = None,
        steps: int | None = None,
        *,
        kind: Kind | None = None,
        dtout: float | None = None,
        state: str | None = None,
        progress: bool | Progress | None = None,
        **options: Unpack[RunOptions],
    ) -> Run:
        """Simulate once from the initial conditions.

        Parameters
        ----------
        end : float
            Time at which it ends, in units of the model; not needed for ``"static"`` and
            ``"initial_conditions"``, or where the set-up of the model says it.
        steps : int, optional
            Output steps; those of the set-up, else 50, where neither they nor `dtout` are given.
        kind : {"transient", "dynamic", "kinematic", "static", "initial_conditions"}, optional
            ``"transient"``: kinematic without freedom, else dynamic. That of the set-up, else
            transient, where it is left out.
        dtout : float, optional
            Time between outputs.
        state : str, optional
            State to begin with, see `Session.state`.
        progress : bool or callable, optional
            Called with the time that has been reached, ten times a second. None: a bar in
            notebooks.
        **options
            See `RunOptions`.

        Returns
        -------
        Run
            The results. A run that has ended early has them as far as it came; its `status` and
            `stop_reason` say why, and IncompleteRun is warned.

        Raises
        ------
        ModelError
            Mistakes in the model, all at once.
        KeyboardInterrupt
            Ctrl-C; its attribute ``run`` holds the results so far.
        """
        session = Session(self, **options)
        own_kind, own_end, own_steps = self._core.solve
        kind = kind or own_kind or "transient"
        end = own_end if end is None else end
        steps = own_steps if steps is None and dtout is None else steps
        if state is not None:
            session.state = state
        session._core_simulate(kind, end, None, steps, dtout, progress)
        return session._finish()

    def run_script(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        commands: str | None = None,
        progress: bool | Progress | None = None,
        **options: Unpack[RunOptions],
    ) -> Run:
        """Obey a command file (``.acf``) for this model.

        Parameters
        ----------
        path : path-like
            The command file; the dataset that it names is not read.
        commands : str
            Commands as a text, in place of a file.
        progress : bool or callable, optional
            As for `run`.
        **options
            See `RunOptions`.

        Returns
        -------
        Run
            The results of all its simulations.

        Raises
        ------
        ModelError
            Mistakes in the commands or in the model.
        """
        if (path is None) == (commands is None):
            raise TypeError("run_script takes a path, or commands=")
        if path is not None:
            script = _core.Commands.read(path)
        else:
            script = _core.Commands.from_text(commands or "")
        if script.output is not None:
            options.setdefault("name", script.output)
        session = Session(self, **options)
        session._obey(script, progress)
        return session._finish()

    def session(self, **options: Unpack[RunOptions]) -> Session:
        """Begin a session: simulations one after another, each from where the last one ended.

        Parameters
        ----------
        **options
            See `RunOptions`.

        Returns
        -------
        Session
            The session, at time 0.
        """
        options.setdefault("accuracy", False)
        return Session(self, **options)

    def sweep(
        self, parameters: Mapping[str, Any], measures: str | Sequence[str], *args: Any, **options: Any
    ) -> SweepTable:
        """Run the model again and again with other numbers; see `pycognate.sweep`.

        Parameters
        ----------
        parameters : mapping of str to str or sequence of float
            Numbers of the model by their names, and their values.
        measures : str or sequence of str
            Numbers of each run: ``"max(abs(FX(41,11)))"``.
        *args, **options
            As for `pycognate.sweep`.

        Returns
        -------
        SweepTable
            A row a run.
        """
        from ._sweep import sweep

        return sweep(self, parameters, measures, *args, **options)

    def verify(self) -> Verification:
        """Count the freedoms, and tell what is fixed twice and what is free.

        Returns
        -------
        Verification
            The findings.

        Raises
        ------
        ModelError
            Mistakes in the model.
        """
        return Verification(self._core.verify())

    def linear(
        self,
        *,
        static: bool = False,
        inputs: int | None = None,
        outputs: int | None = None,
        damping: bool = True,
        **options: Unpack[RunOptions],
    ) -> LinearSystem:
        """Linearize about the initial conditions, between plant inputs and outputs.

        Parameters
        ----------
        static : bool
            About the equilibrium next to the initial conditions.
        inputs, outputs : int, optional
            PINPUT and POUTPUT; all there are where they are left out.
        damping : bool
            Keep what depends on velocities.
        **options
            See `RunOptions`.

        Returns
        -------
        LinearSystem
            ``A, B, C, D, names``, which python-control takes:
            ``control.ss(A, B, C, D, **names)``.

        Raises
        ------
        ModelError
            Mistakes in the model, or no equilibrium.
        """
        session = Session(self, **options)
        if static:
            session.simulate(kind="static")
        return session.linear(inputs=inputs, outputs=outputs, damping=damping)

    def modes(self, *, static: bool = False, **options: Unpack[RunOptions]) -> list[Mode]:
        """Find eigenvalues and mode shapes about the initial conditions.

        Parameters
        ----------
        static : bool
            About the equilibrium next to the initial conditions.
        **options
            See `RunOptions`.

        Returns
        -------
        list of Mode
            By the size of the eigenvalue.
        """
        session = Session(self, **options)
        if static:
            session.simulate(kind="static")
        return session.modes()

    def __repr__(self) -> str:
        return f"<Model {self.title!r}: {len(self.elements)} elements>"

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._core
        return _restored, (core.written, self.file, self._user, core.setup or None, core.changes)


def _restored(
    text: str,
    file: str | None,
    user: dict[str, Any],
    setup: str | None = None,
    changes: Sequence[str] = (),
) -> Model:
    """Return the model that was pickled."""
    core = _core.Model.from_text(text, file, setup)
    for commands in changes:
        core = core.changed(commands)
    model = Model(core)
    model._user = dict(user)
    return model


class Session:
    """A model and its clock: simulations one after another, each from where the last one ended.

    Parameters
    ----------
    model : Model
        The model as it is now.
    **options
        See `RunOptions`.

    Examples
    --------
    >>> session = model.session(columns=["DX(41,22)"])  # doctest: +SKIP
    >>> session.simulate(end=1.0, steps=100)  # doctest: +SKIP
    >>> session.command("DEACTIVATE/MOTION, ID=1")  # doctest: +SKIP
    >>> session.simulate(end=2.0, steps=100)  # doctest: +SKIP
    >>> session.run["DX(41,22)"]  # doctest: +SKIP
    """

    def __init__(self, model: Model, **options: Unpack[RunOptions]) -> None:
        self._core = _core.Session(model._core, choices_of(model, options))
        self._model = model._core

    @property
    def time(self) -> float:
        """The clock, in units of the model."""
        return self._core.time

    @property
    def state(self) -> str:
        """The state as a text: the model as it is now, and where it stands.

        Setting it goes on from there, also in another session, process or machine.
        """
        return self._core.state

    @state.setter
    def state(self, state: str) -> None:
        self._core.reload(state)

    @property
    def run(self) -> Run:
        """The results so far, copied."""
        return Run(self._core.results(), self._model)

    def simulate(
        self,
        end: float | None = None,
        steps: int | None = None,
        *,
        kind: Kind = "transient",
        duration: float | None = None,
        dtout: float | None = None,
        progress: bool | Progress | None = None,
    ) -> str:
        """Simulate on from the present state.

        A first simulation over time begins at a static equilibrium where the set-up of the model
        asks for that.

        Parameters
        ----------
        end : float, optional
            Time of the clock at which it ends.
        steps : int, optional
            Output steps; 50 where neither they nor `dtout` are given.
        kind : {"transient", "dynamic", "kinematic", "static", "initial_conditions"}
            As for `Model.run`.
        duration : float, optional
            Time from here, in place of `end`.
        dtout : float, optional
            Time between outputs.
        progress : bool or callable, optional
            As for `Model.run`.

        Returns
        -------
        str
            How it ended: ``"completed"``, ``"stopped"``, ``"no_equilibrium"``, ``"limit"``.

        Raises
        ------
        ModelError
            Mistakes in the model.
        """
        status = self._core_simulate(kind, end, duration, steps, dtout, progress)
        if status != "completed":
            _warn(self.run, 3)
        return status

    def command(self, commands: str) -> str:
        """Obey commands, as a command file holds them.

        Parameters
        ----------
        commands : str
            One a line.

        Returns
        -------
        str
            How the last simulation among them ended; ``"completed"`` without any.

        Raises
        ------
        ModelError
            Mistakes in the commands or in the model.
        """
        return self._obey(_core.Commands.from_text(commands), False)

    def linear(
        self, *, inputs: int | None = None, outputs: int | None = None, damping: bool = True
    ) -> LinearSystem:
        """Linearize about the present state; see `Model.linear`.

        Parameters
        ----------
        inputs, outputs : int, optional
            PINPUT and POUTPUT; all there are where they are left out.
        damping : bool
            Keep what depends on velocities.

        Returns
        -------
        LinearSystem
            ``A, B, C, D, names``.
        """
        return system_of(self._core.linearize(inputs, outputs, not damping))

    def modes(self) -> list[Mode]:
        """Find eigenvalues and mode shapes about the present state.

        Returns
        -------
        list of Mode
            By the size of the eigenvalue.
        """
        return modes_of(self._core.linearize(None, None, False))

    def _core_simulate(
        self,
        kind: Kind,
        end: float | None,
        duration: float | None,
        steps: int | None,
        dtout: float | None,
        progress: bool | Progress | None,
    ) -> str:
        until = end if duration is None else self.time + duration
        simulation = simulation_of(kind, end, duration, steps, dtout)
        return self._attended(progress, until, lambda report: self._core.simulate(simulation, report))

    def _obey(self, script: _core.Commands, progress: bool | Progress | None) -> str:
        return self._attended(
            progress, script.end, lambda report: self._core.obey(script, report)
        )

    def _attended(
        self,
        progress: bool | Progress | None,
        until: float | None,
        work: Callable[[Progress | None], str],
    ) -> str:
        """Do something long with progress; Ctrl-C keeps the results so far."""
        report, close = reporter(progress, self.time, until)
        try:
            return work(report)
        except KeyboardInterrupt as stopped:
            stopped.run = self.run  # type: ignore[attr-defined]
            raise
        finally:
            close()

    def _finish(self) -> Run:
        run = Run(self._core.finish(), self._model)
        if not run.ok:
            _warn(run, 4)
        return run


def _warn(run: Run, depth: int) -> None:
    """Warn that a run has ended early, where it was asked for."""
    warnings.warn(f"{run.status}: {run.stop_reason}", IncompleteRun, stacklevel=depth)


def run(path: str | os.PathLike[str], **options: Unpack[RunOptions]) -> Run:
    """Run a command file (``.acf``) with the dataset that it names.

    Parameters
    ----------
    path : path-like
        The command file.
    **options
        See `RunOptions`.

    Returns
    -------
    Run
        The results of all its simulations.

    Raises
    ------
    ModelError
        Mistakes in either file.
    FileNotFoundError
        One of them is not there; it is a ModelError, too.

    Examples
    --------
    >>> import pycognate as cg
    >>> cg.run("examples/slider_crank.acf")["slider.X"]  # doctest: +SKIP
    """
    dataset = _core.Commands.read(path).model_file
    if dataset is None:
        raise ValueError(f"{os.fspath(path)} names no dataset: begin it with FILE/MODEL=name")
    return Model.read(dataset).run_script(path, **options)
