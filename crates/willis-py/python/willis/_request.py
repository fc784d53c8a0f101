"""From arguments to a request."""

from __future__ import annotations

import enum
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _quantity
from ._answer import Answer
from ._answer import ask as _ask

if TYPE_CHECKING:
    from ._train import Train

#: A time, a torque, …: text with its unit, a number in SI units, or a quantity of ``pint``.
Quantity: TypeAlias = "str | float | Any"

#: Fields that are quantities, with the unit of a number.
_QUANTITIES = {"from": "s", "to": "s", "fixed_step": "s", "speed": "rad/s"}

#: Fields that are lists of quantities, or of members with theirs.
_LISTED = {"speeds": "rad/s", "torques": "N m", "powers": "W", "temperature": "K"}


def ask(
    question: str,
    trains: Sequence[Train],
    given: Mapping[str, Any],
    *,
    threads: int | None,
    yes: bool,
    progress: Any,
) -> Answer:
    """Asks a question; what is ``None`` is left out."""
    return _ask(question, trains, fields(question, given), threads=threads, yes=yes, progress=progress)


def fields(question: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """A request from arguments; what is ``None`` is left out."""
    return {name: _field(question, name, value) for name, value in given.items() if value is not None}


def _field(question: str, name: str, value: Any) -> Any:
    if name == "over":
        return _quantity.axes(value)
    if name in _LISTED and not (question == "export" and isinstance(value, str)):
        return _quantity.listed(value, _LISTED[name])
    if question != "formula" and name in _QUANTITIES:
        return _quantity.one(value, _QUANTITIES[name])
    if name in ("state", "operation", "scenario") and isinstance(value, int):
        return str(value)
    if question == "design":
        value = _wish(name, value)
    if name in ("profile", "data", "layout", "file", "like"):
        return _attachment(name, value)
    if name == "resume":
        files = [value] if isinstance(value, (str, os.PathLike)) else value
        return [_attachment(name, file) for file in files]
    if isinstance(value, enum.Enum):
        return value.value
    if isinstance(value, str) and name in _LISTS:
        return [value]
    if isinstance(value, (tuple, set, range)):
        return list(value)
    listed = getattr(value, "tolist", None)
    if listed is not None:
        return listed()
    return value


#: Fields that are lists, of which one item may be given alone.
_LISTS = {
    "balance",
    "columns",
    "fixed",
    "from",
    "ignore_column",
    "k",
    "laws",
    "need",
    "offset",
    "only_column",
    "parts",
    "terminals",
    "to",
    "vary",
}


def _wish(name: str, value: Any) -> Any:
    """A wish for a design as its file has it: numbers as they are, lengths in metres, two ends as a range."""
    if name == "ring":
        return _quantity.one(value, "m")
    if name == "module":
        return _quantity.listed(value, "m")
    if name in ("ratio", "tolerance", "planets", "forward", "backward"):
        return "..".join(_quantity.one(end) for end in value) if isinstance(value, tuple) else _quantity.one(value)
    return [value] if name == "write" and isinstance(value, int) else value


def _attachment(name: str, value: Any) -> dict[str, str]:
    """A file by its path, a train, or a table that is in memory."""
    text = getattr(value, "text", None)
    if isinstance(text, str):
        return {"name": str(value.name), "text": text}
    if isinstance(value, (str, os.PathLike)):
        return {"name": os.fspath(value), "text": ""}
    return {"name": name, "text": _quantity.csv(value)}
