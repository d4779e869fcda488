"""Columns of one length by their names."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

__all__ = ["Columns"]


class Columns:
    """Columns of one length by their names, as tables of pandas are.

    An index is a name, iteration gives names, and `len` counts rows.
    """

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        raise NotImplementedError

    def __iter__(self) -> Iterator[str]:
        raise NotImplementedError

    def __len__(self) -> int:
        raise NotImplementedError

    def __contains__(self, name: object) -> bool:
        return any(name == column for column in self)

    def __bool__(self) -> bool:
        return True

    def keys(self) -> list[str]:
        """Return the names.

        Returns
        -------
        list of str
            Names, in the order of the columns.
        """
        return list(self)

    def values(self) -> list[NDArray[np.float64]]:
        """Return the columns.

        Returns
        -------
        list of ndarray
            Arrays, in the order of the names.
        """
        return [self[name] for name in self]

    def items(self) -> list[tuple[str, NDArray[np.float64]]]:
        """Return names with their columns.

        Returns
        -------
        list of tuple
            Name and array of each column.
        """
        return [(name, self[name]) for name in self]

    def get(
        self, name: str, default: NDArray[np.float64] | None = None
    ) -> NDArray[np.float64] | None:
        """Return a column, or something else where there is none of that name.

        Parameters
        ----------
        name : str
            The column.
        default : ndarray, optional
            The value in its place.

        Returns
        -------
        ndarray or None
            The column, or `default`.
        """
        return self[name] if name in self else default
