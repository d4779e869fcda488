"""The freedoms of a model, explained."""

from __future__ import annotations

import json
from typing import Any

__all__ = ["Verification"]


class Verification:
    """The freedoms of a model: both counts, what is fixed twice, what is free.

    Parameters
    ----------
    text : str
        The findings as JSON.

    Attributes
    ----------
    data : dict
        Everything that was found, as ``cognate verify --json`` prints it.
    """

    def __init__(self, text: str) -> None:
        self.data: dict[str, Any] = json.loads(text)

    @property
    def gruebler(self) -> int:
        """6 per part and 3 per point mass, without the equations of all constraints."""
        return int(self.data["gruebler"])

    @property
    def freedom(self) -> int | None:
        """Freedoms from the rank of the constraints; None: no position satisfies them."""
        found = self.data["freedom"]
        return None if found is None else int(found)

    @property
    def consistent(self) -> bool:
        """True if all constraints can be satisfied."""
        return bool(self.data["consistent"])

    @property
    def redundant(self) -> list[str]:
        """Equations that follow from others, each in a sentence."""
        return [str(found["words"]) for found in self.data["dependent"]]

    @property
    def free(self) -> list[str]:
        """Free motions, each in a sentence."""
        return [str(found["words"]) for found in self.data["free"]]

    @property
    def advice(self) -> list[str]:
        """Changes that would remove redundancy."""
        return [str(advice) for advice in self.data["advice"]]

    @property
    def warnings(self) -> list[str]:
        """Further remarks."""
        return [str(warning) for warning in self.data["warnings"]]

    def __str__(self) -> str:
        lines = [f"Gruebler count: {self.gruebler}", f"freedom: {self.freedom}"]
        for found in self.data["inconsistent"]:
            lines.append(f"inconsistent: {found['row']}: {found['message']}")
        lines += [f"free: {words}" for words in self.free]
        lines += [f"redundant: {words}" for words in self.redundant]
        lines += [f"advice: {words}" for words in self.advice]
        lines += [f"warning: {words}" for words in self.warnings]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Verification: freedom {self.freedom}, {len(self.redundant)} redundant>"
