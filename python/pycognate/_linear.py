"""Linear systems about a state of a model."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["LinearSystem", "Mode"]


@dataclass(frozen=True)
class Mode:
    """An eigenvalue of a linear system; of a conjugate pair, the one with positive imaginary part.

    Attributes
    ----------
    eigenvalue : complex
        In 1/time and rad/time of the model.
    shape : dict of str to complex
        Motion of every part, ``"PART/2.X"`` to ``"PART/2.Z"`` along the axes of ground and
        ``"PART/2.AX"`` to ``"PART/2.AZ"`` about them in radians, and of every state of VARIABLEs,
        DIFFs and systems, by its name. The largest
        displacement is 1; where nothing is displaced, the largest rotation.
    """

    eigenvalue: complex
    shape: dict[str, complex]

    @property
    def frequency(self) -> float:
        """Cycles per time, |λ|/2π."""
        return abs(self.eigenvalue) / (2 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """−Re λ/|λ|."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size else 0.0


class LinearSystem(NamedTuple):
    """ż = A z + B u, y = C z + D u about a state of a model.

    Attributes
    ----------
    A, B, C, D : ndarray
        The matrices, (n, n), (n, m), (p, n), (p, m).
    names : dict
        ``states``, ``inputs`` and ``outputs``: lists of names as `control.ss` takes them.

    Examples
    --------
    >>> import pycognate as cg
    >>> A, B, C, D, names = cg.Model.read("plant.adm").linear()  # doctest: +SKIP
    >>> plant = control.ss(A, B, C, D, **names)  # doctest: +SKIP
    """

    A: NDArray[np.float64]
    B: NDArray[np.float64]
    C: NDArray[np.float64]
    D: NDArray[np.float64]
    names: dict[str, list[str]]


def _matrix(rows: list[list[float]], shape: tuple[int, int]) -> NDArray[np.float64]:
    return np.array(rows, dtype=np.float64).reshape(shape)


def system_of(text: str) -> LinearSystem:
    """Return the system that the compiled half has written as JSON."""
    found: dict[str, Any] = json.loads(text)
    names = {key: [_plain(name) for name in found[key]] for key in ("states", "inputs", "outputs")}
    n, m, p = (len(names[key]) for key in ("states", "inputs", "outputs"))
    return LinearSystem(
        _matrix(found["A"], (n, n)),
        _matrix(found["B"], (n, m)),
        _matrix(found["C"], (p, n)),
        _matrix(found["D"], (p, m)),
        names,
    )


def modes_of(text: str) -> list[Mode]:
    """Return the modes that the compiled half has written as JSON."""
    found: dict[str, Any] = json.loads(text)
    return [
        Mode(complex(mode["real"], mode["imaginary"]), _shape_of(mode)) for mode in found["modes"]
    ]


def _shape_of(mode: dict[str, Any]) -> dict[str, complex]:
    """Return the motions of a mode by their names."""
    shape: dict[str, complex] = {}
    for part in mode["parts"]:
        for key, names in (("translation", "X Y Z"), ("rotation", "AX AY AZ")):
            for name, value in zip(names.split(), part[key]):
                shape[f"{part['part']}.{name}"] = complex(*value)
    shape.update({state["state"]: complex(*state["value"]) for state in mode["states"]})
    return shape


def _plain(name: str) -> str:
    """Return a name without the dots that python-control keeps for itself."""
    return name.replace(".", "_")
