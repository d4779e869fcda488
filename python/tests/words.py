"""The methods of builders by the table of statements: ``python tests/words.py`` writes them."""

import textwrap
from pathlib import Path

from pycognate import _core
from pycognate._builder import ModelBuilder

PLACE = Path(__file__).parents[1] / "pycognate" / "_words.py"

HEAD = '''"""Elements by their words, a method each: made from the table of statements by tests/words.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._builder import Body, Element, Marker

    Numbers = Sequence[float] | NDArray[Any]

__all__ = ["Words"]


class Words:
    """Adds elements by their words: statements, and types of JOINT, JPRIM and GRAPHICS."""

    def _add(self, word: str, name: str, *ends: Body | Marker, **given: Any) -> Any:
        raise NotImplementedError
'''

TYPES = {
    "flag": "bool",
    "integer": "Element | int",
    "integers": "Sequence[Element | int]",
    "real": "float",
    "angle": "float",
    "reals": "Numbers",
    "angles": "Numbers",
    "word": "str",
    "words": "str",
    "text": "str",
    "texts": "Sequence[str]",
    "expression": "str | float",
}
RETURNS = {"PART": "Body", "POINT_MASS": "Body", "MARKER": "Marker"}


def wrapped(text: str, indent: str) -> str:
    """Return a text in lines of at most 100 columns."""
    return textwrap.fill(text, 98, initial_indent=indent, subsequent_indent=indent)


def article(word: str) -> str:
    """Return a word with its article, as it is spoken."""
    return ("an " if word[0] in "AEIO" or word[:2] in ("LS", "SF", "NF", "MR") else "a ") + word


def entry(argument: tuple) -> str:
    """Return an argument as docstrings describe it."""
    keyword, kind, unit, default, needed, repeated, meaning = argument
    unit = f" [{unit}]" if unit else ""
    extra = "" if needed else ", optional"
    extra += ", several rows" if repeated else ""
    default = f" Default: {default}." if default else ""
    head = f"        {keyword} : {TYPES[kind]}{unit}{extra}"
    return f"{head}\n{wrapped(meaning + default, ' ' * 12)}"


def method(word: str, keyword: str, has_ends: bool, summary: str, arguments: list) -> str:
    """Return the method of a word."""
    returned = RETURNS.get(keyword, "Element")
    takes = ["self", "name: str"] + (["i: Body | Marker", "j: Body | Marker"] if has_ends else [])
    takes += ["*"] if arguments else []
    gives = [f'"{word}"', "name"] + (["i", "j"] if has_ends else [])
    for name, kind, *_, repeated, _ in arguments:
        of = f"{TYPES[kind]} | Sequence[{TYPES[kind]}]" if repeated else TYPES[kind]
        takes.append(f"{name}: {of} = False" if kind == "flag" else f"{name}: {of} | None = None")
        gives.append(f"{name}={name}")
    title = f"Add {article(keyword)}" if word == keyword else f"Add {article(keyword)}, {word}"
    lines = [
        f"    def {word.lower()}(",
        *(f"        {each}," for each in takes),
        f"    ) -> {returned}:",
        f'        """{title}.',
        "",
        wrapped(summary, " " * 8),
        "",
        "        Parameters",
        "        ----------",
        "        name : str",
        "            Its name; may be empty.",
    ]
    if has_ends:
        lines += [
            "        i, j : Body or Marker",
            "            Its ends; a body gets a marker where the other end is.",
        ]
    lines += [entry(argument) for argument in arguments]
    lines += ["", "        Returns", "        -------", f"        {returned}", "            The element."]
    lines += ['        """', f"        made: {returned} = self._add(", *(f"            {each}," for each in gives)]
    lines += ["        )", "        return made", ""]
    return "\n".join(lines)


def written() -> str:
    """Return the file: a method for each word that the builder has no method of its own for."""
    own = set(vars(ModelBuilder))
    return "\n".join([HEAD, *(method(*word) for word in _core.words() if word[0].lower() not in own)])


if __name__ == "__main__":
    PLACE.write_text(written(), encoding="utf-8")
