"""What goes wrong, as exceptions and warnings."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """One thing that is wrong, or worth knowing, with its place.

    ``code`` is explained by :func:`willis.explain`. ``line`` and ``column`` count from 1 in ``file``; they are ``None`` where
    the place is not in a text. ``fix`` is the text that would be right at that place, where there is only one.
    """

    code: str
    severity: str
    message: str
    place: str = ""
    hints: tuple[str, ...] = ()
    file: str | None = None
    line: int | None = None
    column: int | None = None
    fix: str | None = None

    @classmethod
    def _of(cls, data: dict[str, Any], file: str | None = None) -> Diagnostic:
        span = data.get("span") or {}
        replacement = data.get("replacement")
        if isinstance(replacement, dict):
            replacement = replacement.get("text")
        return cls(
            code=data["code"],
            severity=data["severity"],
            message=data["message"],
            place=data.get("place", ""),
            hints=tuple(data.get("hints", ())),
            file=data.get("file") or file,
            line=span.get("line"),
            column=span.get("column"),
            fix=replacement,
        )

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}:{self.column}: " if self.line is not None else ""
        return f"{where}{self.severity}[{self.code}]: {self.message}"


class TrainError(ValueError):
    """A train, or a question about it, that cannot be answered.

    ``diagnostics`` lists all that is wrong; the text of the exception shows each at its place, underlined.
    """

    diagnostics: list[Diagnostic]

    def __init__(self, text: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(text)
        self.diagnostics = diagnostics or []

    @classmethod
    def _of(cls, text: str, report: str) -> TrainError:
        data = json.loads(report)
        return cls(text.rstrip("\n"), [Diagnostic._of(d) for d in data["diagnostics"]])

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.diagnostics))


class TrainWarning(UserWarning):
    """Something about a train or an answer that its user should know."""
