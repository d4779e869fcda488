"""Mistakes as exceptions, all at once, each with its place and advice."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

__all__ = [
    "ColumnError",
    "Diagnostic",
    "Error",
    "ExprError",
    "IncompleteRun",
    "ModelError",
    "ModelFileNotFound",
    "ResultsError",
    "ResultsFileNotFound",
]


@dataclass(frozen=True)
class Diagnostic:
    """A mistake, a doubt or a note, with its place and advice.

    Attributes
    ----------
    code : str
        Stable short name, which ``cognate explain CODE`` explains.
    severity : {"error", "warning", "note"}
        How much it matters.
    message : str
        One sentence without a full stop.
    file : str or None
        File of the text.
    line, column : int or None
        Place in that text, from 1, columns in characters.
    element : str or None
        The element concerned, for example ``"SFORCE/3"``.
    name : str or None
        The name that the dataset gives that element.
    argument : str or None
        Keyword of the argument concerned, for example ``"IP"``.
    advice : tuple of str
        What to do, one sentence each.
    text : str
        All of it as the command line prints it.
    """

    code: str
    severity: str
    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    element: str | None = None
    name: str | None = None
    argument: str | None = None
    advice: tuple[str, ...] = ()
    text: str = ""

    def __str__(self) -> str:
        return self.text or self.message


class Error(Exception):
    """Mistakes of a user, all at once.

    The attributes `code`, `message`, `file`, `line`, `column`, `element`, `name` and `advice` are
    those of the first.

    Parameters
    ----------
    errors : sequence of Diagnostic
        The mistakes, at least one.
    source : str, optional
        The expression that they are in.

    Attributes
    ----------
    errors : tuple of Diagnostic
        Every mistake.
    source : str or None
        The expression that they are in.
    """

    def __init__(self, errors: Sequence[Diagnostic], source: str | None = None) -> None:
        super().__init__(tuple(errors), source)
        self.errors: tuple[Diagnostic, ...] = tuple(errors)
        self.source = source

    @property
    def code(self) -> str:
        """Short name of the first mistake."""
        return self.errors[0].code

    @property
    def message(self) -> str:
        """Sentence of the first mistake."""
        return self.errors[0].message

    @property
    def file(self) -> str | None:
        """File of the first mistake."""
        return self.errors[0].file

    @property
    def line(self) -> int | None:
        """Line of the first mistake, from 1."""
        return self.errors[0].line

    @property
    def column(self) -> int | None:
        """Column of the first mistake, from 1."""
        return self.errors[0].column

    @property
    def element(self) -> str | None:
        """Element of the first mistake."""
        return self.errors[0].element

    @property
    def name(self) -> str | None:
        """Name that the dataset gives the element of the first mistake."""
        return self.errors[0].name

    @property
    def advice(self) -> tuple[str, ...]:
        """Advice on the first mistake."""
        return self.errors[0].advice

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.errors, self.source)

    def __str__(self) -> str:
        text = "\n".join(str(error) for error in self.errors)
        if self.source is None or self.column is None or "\n" in self.source:
            return text
        return f"{text}\n  {self.source}\n  {' ' * (self.column - 1)}^"


class ExprError(Error, ValueError):
    """A mistake in an expression, or a point where it has no value."""


class ModelError(Error, ValueError):
    """Mistakes in a dataset, in commands, or in a model."""


class ResultsError(Error, ValueError):
    """A file of results that cannot be read or written."""


class _FileNotFound(Error, FileNotFoundError):
    """A file that is not there, with what the system says of it."""

    def __init__(self, errors: Sequence[Diagnostic], source: str | None = None) -> None:
        super().__init__(errors, source)
        self.errno, self.strerror, self.filename = errno.ENOENT, self.message, self.file


class ModelFileNotFound(_FileNotFound, ModelError):
    """A dataset or command file that is not there."""


class ResultsFileNotFound(_FileNotFound, ResultsError):
    """A file of results that is not there."""


class ColumnError(Error, KeyError):
    """A column that a run does not have."""

    def __str__(self) -> str:
        return Error.__str__(self)


class IncompleteRun(UserWarning):
    """A run that ended before everything was done; its results so far are kept."""
