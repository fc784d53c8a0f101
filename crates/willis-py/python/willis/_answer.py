"""Answers."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _willis
from ._errors import Diagnostic, TrainError
from ._record import Record
from ._table import Table, html

if TYPE_CHECKING:
    from ._train import Train


class Answer:
    """The answer to a question.

    It is data, with the names of the contract that the command prints as JSON: ``a.train``, ``a["train"]``. Beside them there
    are its :attr:`text`, its :attr:`tables`, and :meth:`save`.
    """

    __slots__ = ("_core", "_kept", "_record", "_tables", "_trains")

    def __init__(self, core: _willis.Answer | None, trains: Sequence[Train], kept: dict[str, Any] | None = None) -> None:
        self._core = core
        self._trains = tuple(trains)
        self._kept = kept
        self._record: Record | None = None
        self._tables: dict[str, Table] | None = None

    @property
    def question(self) -> str:
        """What was asked: ``analyze``."""
        return self._core.question if self._core is not None else str(self._kept["question"])  # type: ignore[index]

    @property
    def request(self) -> dict[str, Any]:
        """What was asked in particular."""
        text = self._core.request() if self._core is not None else self._kept["request"]  # type: ignore[index]
        return dict(json.loads(text))

    @property
    def trains(self) -> tuple[Train, ...]:
        """The trains that it was asked of."""
        return self._trains

    @property
    def data(self) -> Record:
        """The whole answer as data."""
        if self._record is None:
            self._record = Record(json.loads(self.json()))
        return self._record

    def json(self) -> str:
        """The answer as the command prints it with ``--format json``."""
        return self._core.json() if self._core is not None else str(self._kept["json"])  # type: ignore[index]

    @property
    def text(self) -> str:
        """The answer for eyes."""
        if self._core is None:
            return str(self._kept["text"])  # type: ignore[index]
        return self._core.text() + self._core.notes()[1]

    @property
    def tables(self) -> dict[str, Table]:
        """Its tables by their names."""
        if self._tables is None:
            cores = self._core.tables() if self._core is not None else self._kept["tables"]  # type: ignore[index]
            self._tables = {t.name: t if isinstance(t, Table) else Table(t) for t in cores}
        return self._tables

    @property
    def notes(self) -> list[Diagnostic]:
        """Warnings and notes about it."""
        text = self._core.notes()[0] if self._core is not None else self._kept["notes"]  # type: ignore[index]
        file = self._trains[0].name if self._trains else None
        return [Diagnostic._of(d, file) for d in json.loads(text)]

    @property
    def is_partial(self) -> bool:
        """Whether the work was stopped before its end, and the answer covers what was done until then."""
        return self._core.is_partial if self._core is not None else bool(self._kept["partial"])  # type: ignore[index]

    def files(self, form: str) -> dict[str, bytes]:
        """The answer in another form, ``svg`` for instance: what is in each file, by its name."""
        return dict(self._alive().write(form))

    def extra(self, name: str) -> dict[str, bytes]:
        """What can be had beside the answer, as the command's option of that name."""
        return dict(self._alive().extra(name))

    def save(self, path: str | Path, form: str | None = None, *, force: bool = False) -> Path:
        """Writes the answer into a file. Its ending says in which form, if ``form`` does not.

        Forms that every answer has are ``txt``, ``json`` and, with one table, ``csv``; others are those of the command:
        ``svg``, ``png``, ``html``, ``toml``. A file that is there is replaced with ``force`` only.
        """
        path = Path(path)
        if path.exists() and not force:
            raise FileExistsError(f"{path} is there already; save(..., force=True) replaces it")
        path.write_bytes(self._bytes(form or path.suffix.lstrip(".").lower()))
        return path

    def _bytes(self, form: str) -> bytes:
        if form in ("txt", "text"):
            return self.text.encode()
        if form == "json":
            return self.json().encode()
        entry = _entry(self.question)
        if form in entry["forms"]:
            files = self.files(form)
            if len(files) != 1:
                raise ValueError(f"this makes {len(files)} files: take them from files({form!r})")
            return next(iter(files.values()))
        if form == "csv" and self.tables:
            if len(self.tables) > 1:
                raise ValueError(f"an answer of several tables: {', '.join(self.tables)}; take one of .tables")
            return _csv(next(iter(self.tables.values()))).encode()
        forms = ["txt", "json", *(["csv"] if entry["tables"] else []), *entry["forms"]]
        raise ValueError(f"`{self.question}` has no form {form!r}; it has {', '.join(forms)}")

    def _alive(self) -> _willis.Answer:
        if self._core is None:
            again = ask(self.question, self._trains, self.request)
            self._core = again._core
            assert self._core is not None
        return self._core

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.data, name)

    def __getitem__(self, name: str) -> Any:
        return self.data[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.data)

    def __contains__(self, name: object) -> bool:
        return self.data._find(str(name)) is not None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(k for k in self.data if k.isidentifier())]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Answer) and self.question == other.question and self.json() == other.json()

    def __hash__(self) -> int:
        return hash((self.question, self.json()))

    def __copy__(self) -> Answer:
        return self

    def __deepcopy__(self, memo: object) -> Answer:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        notes = self._core.notes()[0] if self._core is not None else self._kept["notes"]  # type: ignore[index]
        kept = {
            "question": self.question,
            "request": json.dumps(self.request),
            "json": self.json(),
            "text": self.text,
            "tables": list(self.tables.values()),
            "notes": notes,
            "partial": self.is_partial,
        }
        return (_again, (type(self), self._trains, kept))

    def __repr__(self) -> str:
        return self.text.rstrip("\n")

    def _repr_html_(self) -> str:
        style = "line-height:1.25;font-family:monospace;white-space:pre;overflow-x:auto"
        return f"<pre style='{style}'>{escape(self.text)}</pre>"


def _again(kind: type[Answer], trains: Sequence[Train], kept: dict[str, Any]) -> Answer:
    return kind(None, trains, kept)


def _csv(table: Table) -> str:
    import csv
    import io

    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(table.columns)
    for row in table.rows():
        writer.writerow(["" if v is None else repr(v) if isinstance(v, float) else v for v in row.values()])
    return out.getvalue()


class Analysis(Answer):
    """The answer of :meth:`Train.analyze`: the shift table in ``ratios``, the operating points in ``operations``.

    Of an analysis with one operating point :attr:`efficiency`, :attr:`members` and the rest of what its solution holds are
    there at once. Of several one is had by :meth:`operation`.
    """

    __slots__ = ()

    def operation(self, name: str | None = None) -> Record:
        """An operating point by its name; the only one without it."""
        all_ = self.data["operations"]
        if name is None:
            if len(all_) == 1:
                return all_[0]  # type: ignore[no-any-return]
            names = ", ".join(repr(o["name"]) for o in all_) or "none: the file has no [[operation]]"
            raise TrainError(f"this analysis has several operating points or none; name one: {names}")
        for one in all_:
            if one["name"] == name:
                return one  # type: ignore[no-any-return]
        raise KeyError(f"{name}; there are: {', '.join(o['name'] for o in all_)}")

    def solution(self, name: str | None = None) -> Record:
        """The solution of an operating point, where there is exactly one."""
        one = self.operation(name)
        if len(one["solutions"]) != 1:
            reason = f": {one['reason']}" if isinstance(one["reason"], str) else ""
            raise TrainError(
                f"{one['name']}: {one['verdict']}{reason}; {len(one['solutions'])} solutions in .operation().solutions"
            )
        return one["solutions"][0]  # type: ignore[no-any-return]

    def state(self, name: str | None = None) -> Record:
        """A row of the shift table; the only one without a name."""
        rows = self.data["ratios"]
        if name is None:
            if len(rows) != 1:
                raise TrainError(f"this analysis has several states; name one: {', '.join(rows)}")
            return rows[next(iter(rows))]  # type: ignore[no-any-return]
        return rows[name]  # type: ignore[no-any-return]

    @property
    def efficiency(self) -> float | None:
        """Of the only operating point; where there is none, of the only state, driving."""
        if not self.data["operations"]:
            return self.state()["drive"]["efficiency"]  # type: ignore[no-any-return]
        return self.solution()["efficiency"]  # type: ignore[no-any-return]

    @property
    def ratio(self) -> float | None:
        """Speed of the input over that of the output, of the only state."""
        return self.state()["value"]  # type: ignore[no-any-return]

    @property
    def verdict(self) -> str:
        """``unique``, ``locked``, …: of the only operating point."""
        return str(self.operation()["verdict"])

    @property
    def members(self) -> Record:
        """Speed, torque and power of every member, at the only operating point."""
        return self.solution()["members"]  # type: ignore[no-any-return]

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and name not in self.data and len(self.data["operations"]) == 1:
            one = self.data["operations"][0]
            for record in (one, *(one["solutions"] if len(one["solutions"]) == 1 else [])):
                if name in record:
                    return record[name]
        return super().__getattr__(name)

    def _repr_html_(self) -> str:
        parts = []
        if "states" in self.tables:
            parts.append(html(self.tables["states"]))
        parts.append(super()._repr_html_())
        svg = _stick(self._trains[0], self.request.get("state"))
        if svg:
            parts.append(svg)
        return "".join(parts)


def _stick(train: Train, state: str | None) -> str | None:
    try:
        return train.draw("stick", state=state, theme="auto").svg
    except (TrainError, TypeError):
        return None


class Rows(Answer):
    """An answer whose columns are had at once: of a sweep its points, of a simulation its rows.

    ``run["output.speed"]`` is an array.
    """

    __slots__ = ()

    _main = "points"

    @property
    def table(self) -> Table:
        """The table of all rows."""
        return self.tables[self._main]

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self.table.columns

    def __len__(self) -> int:
        return len(self.table)

    def __getitem__(self, name: str) -> Any:
        return self.table[name] if name in self.table else super().__getitem__(name)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)

    def to_polars(self) -> Any:
        """The rows as a data frame of polars."""
        return self.table.to_polars()

    def to_pandas(self) -> Any:
        """The rows as a data frame of pandas."""
        return self.table.to_pandas()

    def to_arrow(self) -> Any:
        """The rows as a table of pyarrow."""
        return self.table.to_arrow()


class Sweep(Rows):
    """The answer of :meth:`Train.sweep`."""

    __slots__ = ()


class Cycle(Rows):
    """The answer of :meth:`Train.cycle`."""

    __slots__ = ()


class Simulation(Rows):
    """The answer of :meth:`Train.simulate`: rows over time, ``events``, energies and what ended the run."""

    __slots__ = ()

    _main = "rows"


class Drawing(Answer):
    """A picture."""

    __slots__ = ()

    @property
    def svg(self) -> str:
        """The picture as SVG."""
        return next(iter(self.files("svg").values())).decode()

    def _repr_html_(self) -> str:
        return "".join(file.decode() for file in self.files("svg").values())


class Report(Answer):
    """A report."""

    __slots__ = ()

    @property
    def html(self) -> str:
        """The report as a page of its own."""
        return next(iter(self.files("html").values())).decode()

    def _repr_html_(self) -> str:
        page = escape(self.html, quote=True)
        return f"<iframe srcdoc='{page}' style='width:100%;height:640px;border:0'></iframe>"


class Formula(Answer):
    """Closed formulas."""

    __slots__ = ()

    def sympy(self, what: str = "efficiency", which: int = 0) -> Any:
        """A formula as an expression of sympy, which must be installed.

        ``what`` is ``efficiency``, ``speed_ratio`` or ``torque_ratio``.
        """
        import sympy

        formulas = self.data["formulas"]
        if not formulas:
            raise TrainError("there is no formula in this answer")
        text = formulas[which][what]["text"]
        import re

        names = sorted(set(re.findall(r"[A-Za-z_]\w*", text)))
        symbols = {name: sympy.Symbol(name, real=True) for name in names}
        parse: Any = sympy.sympify
        return parse(text.replace("^", "**"), locals=symbols)


KINDS: dict[str, type[Answer]] = {
    "analyze": Analysis,
    "sweep": Sweep,
    "cycle": Cycle,
    "simulate": Simulation,
    "draw": Drawing,
    "report": Report,
    "formula": Formula,
}


@cache
def _entries() -> dict[str, dict[str, Any]]:
    return {entry["name"]: entry for entry in json.loads(_willis.questions())}


def _entry(question: str) -> dict[str, Any]:
    return _entries()[question]


def ask(
    question: str,
    trains: Sequence[Train],
    request: dict[str, Any],
    *,
    threads: int | None = None,
    yes: bool = False,
    progress: Any = None,
) -> Answer:
    """Asks a question by its name, with its request as data."""
    import warnings

    from ._errors import TrainWarning
    from ._work import watcher

    told, finish = watcher(progress)
    try:
        core = _willis.ask(
            question,
            json.dumps(request),
            [train._core for train in trains],
            threads or 0,
            float("inf") if yes else 60.0,
            told,
        )
    finally:
        finish()
    answer = KINDS.get(question, Answer)(core, trains)
    known = {w.message for train in trains for w in train.warnings}
    for note in answer.notes:
        if note.severity == "warning" and note.message not in known:
            warnings.warn(str(note), TrainWarning, stacklevel=3)
    return answer
