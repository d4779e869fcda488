"""Progress of a simulation, in notebooks and wherever a callable is given."""

from __future__ import annotations

import html
import sys
import time
from collections.abc import Callable
from typing import Any

__all__ = ["Progress", "reporter"]

#: Called with the time that the simulation has reached.
Progress = Callable[[float], object]

#: Work that is done sooner shows no bar [s].
_QUIET_FOR = 0.5
#: Share of the work from which on the rest of its time is estimated.
_ENOUGH_DONE = 0.01


def _duration(seconds: float) -> str:
    """Return a time in the unit in which people say it."""
    for size, unit in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


class _Bar:
    """A bar in the output of a notebook cell, which goes when the work has ended."""

    def __init__(self, start: float, end: float | None, what: str) -> None:
        self._start, self._end, self._what = start, end, what
        self._begun = time.monotonic()
        self._handle: Any = None

    def __call__(self, now: float) -> None:
        elapsed = time.monotonic() - self._begun
        if elapsed < _QUIET_FOR:
            return
        from IPython.display import display

        bar = self._shown(now, elapsed)
        if self._handle is None:
            self._handle = display(bar, raw=True, display_id=True)
        else:
            self._handle.update(bar, raw=True)

    def _shown(self, now: float, elapsed: float) -> dict[str, str]:
        """Return the bar as notebooks take it, and as text for those that show no HTML."""
        share, bar = "", "<progress></progress>"
        words = f"{self._what} {now:.4g}"
        if self._end is not None and self._end > self._start:
            done = min(max((now - self._start) / (self._end - self._start), 0.0), 1.0)
            bar = f'<progress value="{done:.4f}"></progress>'
            share = f"{done:4.0%} "
            words += f" of {self._end:.4g}"
            if done >= _ENOUGH_DONE:
                words += f", {_duration(elapsed * (1.0 - done) / done)} to go"
        return {"text/html": f"{bar} {share}{html.escape(words)}", "text/plain": share + words}

    def close(self) -> None:
        """Take the bar away."""
        if self._handle is not None:
            self._handle.update({"text/html": "", "text/plain": ""}, raw=True)


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
