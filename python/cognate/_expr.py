"""Expressions of the function language."""

from __future__ import annotations

from typing import Literal

from ._core import Expr

__all__ = ["expr"]


def expr(text: str, *, dialect: Literal["function", "expression"] = "function") -> Expr:
    """Read, check and compile an expression of the ADAMS function language.

    Parameters
    ----------
    text : str
        The expression, as it stands after ``FUNCTION=``.
    dialect : {"function", "expression"}
        ``"function"``: angles in radians, time is ``TIME``. ``"expression"``: angles in degrees,
        time is ``t``.

    Returns
    -------
    Expr
        To be called with times, and with the values of its other inputs by name.

    Raises
    ------
    ExprError
        The first mistake, with its column and advice.

    Examples
    --------
    >>> import cognate as cg
    >>> f = cg.expr("STEP5(TIME, 0, 0, 1, 10)")
    >>> f(0.5)
    5.0
    >>> f([0.0, 0.5, 1.0])
    array([ 0.,  5., 10.])
    >>> spring = cg.expr("-25*(DM(10,20) - 10)")
    >>> spring({"DM(10,20)": 12.0})
    -50.0
    """
    return Expr(text, dialect=dialect)


def _restored(text: str, dialect: Literal["function", "expression"]) -> Expr:
    """Return the expression that was pickled."""
    return Expr(text, dialect=dialect)
