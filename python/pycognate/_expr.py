"""Expressions of the function language."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal

from ._core import Expr

__all__ = ["expr"]

#: A formula; a callable over numbers; one with another that returns its partial derivatives.
Function = str | Callable[..., float] | tuple[Callable[..., float], Callable[..., Sequence[float]]]


def expr(
    text: str,
    *,
    dialect: Literal["function", "expression"] = "function",
    variables: Iterable[str] = (),
    constants: Mapping[str, float] | None = None,
    functions: Mapping[str, Function] | None = None,
) -> Expr:
    """Read, check and compile an expression of the ADAMS function language.

    Parameters
    ----------
    text : str
        The expression, as it stands after ``FUNCTION=``.
    dialect : {"function", "expression"}
        ``"function"``: angles in radians, time is ``TIME``. ``"expression"``: angles in degrees,
        time is ``t``.
    variables : iterable of str, optional
        Names of further inputs, given by name in a call.
    constants : mapping of str to float, optional
        Named numbers.
    functions : mapping of str, optional
        Functions by their heads, such as ``"f(x, y)"``: a formula of the language, which is as fast
        as if it were written out and has all derivatives; a callable over numbers, of which the
        values are known only; or a tuple of a callable and another that returns the partial
        derivatives. Formulas may use the constants and the functions before them.

    Returns
    -------
    Expr
        To be called with times, and with the values of its other inputs by name.

    Raises
    ------
    ExprError
        The first mistake, with its column and advice; or all mistakes in the names.

    Examples
    --------
    >>> import pycognate as cg
    >>> f = cg.expr("STEP5(TIME, 0, 0, 1, 10)")
    >>> f(0.5)
    5.0
    >>> f([0.0, 0.5, 1.0])
    array([ 0.,  5., 10.])
    >>> spring = cg.expr("-25*(DM(10,20) - 10)")
    >>> spring({"DM(10,20)": 12.0})
    -50.0
    >>> hertz = {"hertz(x, k)": "k*MAX(x, 0)**1.5"}
    >>> force = cg.expr("hertz(x, 100) + g", variables=["x"], constants={"g": 9.81}, functions=hertz)
    >>> force(x=4.0)
    809.81
    >>> force.gradient(x=4.0)
    {'x': 300.0}
    """
    names = {
        "variables": list(variables),
        "constants": list((constants or {}).items()),
        "functions": list((functions or {}).items()),
    }
    return Expr(text, dialect=dialect, names=names)


def _restored(
    text: str, dialect: Literal["function", "expression"], names: dict[str, Any] | None = None
) -> Expr:
    """Return the expression that was pickled."""
    return Expr(text, dialect=dialect, names=names)
