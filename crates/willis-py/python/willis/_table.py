"""Tables of answers."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Any

import numpy as np

from . import _willis
from ._record import bare


class Table:
    """A table of an answer: columns with names and units, SI values.

    Columns of numbers are numpy arrays, not copied. Polars, pyarrow and DuckDB take the table as it is, through the Arrow C
    interface: ``polars.DataFrame(table)``, ``pyarrow.table(table)``, ``duckdb.sql("from table")``. For pandas there is
    :meth:`to_pandas`.

    >>> import willis
    >>> states = willis.read("examples/zf-8hp70.toml").analyze().tables["states"]
    >>> states["state"][:3]
    ['1', '2', '3']
    """

    __slots__ = ("_core",)

    def __init__(self, core: _willis.Table) -> None:
        self._core = core

    @property
    def name(self) -> str:
        """What it is called among the tables of its answer."""
        return self._core.name

    @property
    def columns(self) -> list[str]:
        """The names of the columns, each ending with its unit."""
        return self._core.columns

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column; empty where it has none."""
        return dict(zip(self._core.columns, self._core.units, strict=True))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return (len(self), len(self._core.columns))

    def __len__(self) -> int:
        return len(self._core)

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def _find(self, name: str) -> str:
        names = self._core.columns
        if name in names:
            return name
        wanted = _spelt(name)
        found = [c for c in names if bare(c) == name] or [c for c in names if wanted in _spellings(c)]
        if len(found) == 1:
            return found[0]
        from difflib import get_close_matches

        near = get_close_matches(name, names, n=3)
        hint = f"; did you mean {', '.join(near)}?" if near else f"; there are: {', '.join(names[:30])}"
        raise KeyError(f"{name}{hint}")

    def __getitem__(self, name: str) -> Any:
        """A column: an array of numbers, or a list of texts."""
        return self._core.column_of(self._find(name))

    def __contains__(self, name: object) -> bool:
        try:
            self._find(str(name))
        except KeyError:
            return False
        return True

    def rows(self) -> Iterator[dict[str, Any]]:
        """The rows, one after the other, as dictionaries."""
        columns = {name: self[name] for name in self.columns}
        for k in range(len(self)):
            yield {name: _plain(values[k]) for name, values in columns.items()}

    def to_dict(self) -> dict[str, Any]:
        """The columns by their names."""
        return {name: self[name] for name in self.columns}

    def to_polars(self) -> Any:
        """A data frame of polars, which must be installed."""
        import polars

        return polars.DataFrame(self)

    def to_pandas(self) -> Any:
        """A data frame of pandas, which must be installed."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self.columns})

    def to_arrow(self) -> Any:
        """A table of pyarrow, which must be installed."""
        import pyarrow

        return pyarrow.table(self)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The stream of the Arrow C interface; a schema that is asked for is not followed, as the interface allows."""
        return self._core.arrow_stream()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._core.packed() == other._core.packed()

    def __hash__(self) -> int:
        return hash((self.name, len(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self._core.packed(),))

    def __repr__(self) -> str:
        return f"<Table {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"

    def _repr_html_(self) -> str:
        return html(self)


def _again(packed: str) -> Table:
    return Table(_willis.Table.again(packed))


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and value != value else value


def _spelt(name: str) -> str:
    return name.replace(".", "_").replace(" ", "_")


def _spellings(column: str) -> set[str]:
    """A column with its unit and without, dots and underscores alike: ``input.speed`` finds ``input_speed_rpm``."""
    of = bare(column)
    return {_spelt(of), _spelt(column), _spelt(of.removesuffix("_rpm"))}


def html(table: Table, most: int = 40) -> str:
    """The first rows as HTML."""
    def cell(value: Any) -> str:
        value = _plain(value)
        if value is None:
            return "<td></td>"
        if isinstance(value, float):
            return f"<td style='text-align:right'>{value:.6g}</td>"
        return f"<td>{escape(str(value))}</td>"

    names = table.columns
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    columns = [table[name] for name in names]
    body = "".join("<tr>" + "".join(cell(c[k]) for c in columns) + "</tr>" for k in range(min(len(table), most)))
    more = f"<caption style='caption-side:bottom'>{len(table) - most} more rows</caption>" if len(table) > most else ""
    return f"<table>{more}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
