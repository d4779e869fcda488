"""Progress of a simulation, in notebooks and wherever a callable is given."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

__all__ = ["Progress", "reporter"]

#: Called with the time that the simulation has reached.
Progress = Callable[[float], object]

#: Runs shorter than this show no bar [s].
_QUIET_FOR = 0.5


class _Bar:
    """A bar in the output of a notebook cell, which goes when the simulation has ended."""

    def __init__(self, start: float, end: float | None, what: str) -> None:
        self._start, self._end, self._what = start, end, what
        self._begun = time.monotonic()
        self._handle: Any = None

    def __call__(self, now: float) -> None:
        if time.monotonic() - self._begun < _QUIET_FOR:
            return
        from IPython.display import HTML, display

        share = ""
        if self._end is not None and self._end > self._start:
            share = f' value="{(now - self._start) / (self._end - self._start):.4f}"'
        bar = HTML(f"<progress{share}></progress> {self._what} {now:.6g}")
        if self._handle is None:
            self._handle = display(bar, display_id=True)
        else:
            self._handle.update(bar)

    def close(self) -> None:
        """Take the bar away."""
        if self._handle is not None:
            from IPython.display import HTML

            self._handle.update(HTML(""))


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def reporter(
    progress: bool | Progress | None, start: float, end: float | None, what: str = "time"
) -> tuple[Progress | None, Callable[[], None]]:
    """Choose what is called while a simulation goes on, and what when it has ended.

    Parameters
    ----------
    progress : bool, callable or None
        None: a bar in notebooks, else nothing. True: a bar, which needs a notebook.
    start, end : float
        Numbers between which the work goes, as far as they are known.
    what : str
        The word for these numbers.

    Returns
    -------
    tuple
        Both callables.
    """
    if callable(progress):
        return progress, lambda: None
    if progress is True and not _in_notebook():
        raise ValueError("progress=True needs a notebook; elsewhere give a callable, progress=print")
    if progress is False or not _in_notebook():
        return None, lambda: None
    bar = _Bar(start, end, what)
    return bar, bar.close
