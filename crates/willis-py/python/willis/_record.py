"""Parts of answers: data with names."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from difflib import get_close_matches
from functools import partial
from typing import Any

#: Ends of names that say the unit, the longest first. A name without its unit means the same, where it is the only one.
_UNITS = (
    "_rad_s2 _n_per_m _rad_s _kg_m3 _kg_m2 _m2_s _n_m _m_s _rad _pa _hz _w _j _k _n _m _s".split()
)


def bare(name: str) -> str:
    """A name without its unit.

    >>> bare("torque_n_m"), bare("efficiency")
    ('torque', 'efficiency')
    """
    for unit in _UNITS:
        if name.endswith(unit) and len(name) > len(unit):
            return name[: -len(unit)]
    return name


def wrap(value: Any) -> Any:
    """Data of JSON as records and lists of them."""
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return [wrap(v) for v in value]
    return value


class Record:
    """Data with names: ``r.efficiency`` and ``r["efficiency"]`` are the same.

    Values are in SI units and their names say so; a name without its unit means the same: ``r.torque`` is
    ``r.torque_n_m``. It goes round as a dictionary does, with ``keys()``, ``values()``, ``items()`` and ``get()``, unless the
    data have a name of their own that reads so.
    """

    __slots__ = ("_data",)

    def __init__(self, data: dict[str, Any]) -> None:
        object.__setattr__(self, "_data", data)

    def _find(self, name: str) -> str | None:
        data = self._data
        if name in data:
            return name
        found = [key for key in data if bare(key) == name]
        return found[0] if len(found) == 1 else None

    def __getitem__(self, name: str) -> Any:
        key = self._find(name)
        if key is None:
            raise KeyError(f"{name}{_near(name, self._data)}")
        return wrap(self._data[key])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        key = self._find(name)
        if key is not None:
            return wrap(self._data[key])
        if name in _WAYS:
            return partial(_WAYS[name], self)
        raise AttributeError(f"there is no `{name}` here{_near(name, self._data)}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("an answer does not change")

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __contains__(self, name: object) -> bool:
        return self._find(str(name)) is not None

    def __dir__(self) -> list[str]:
        names = [k for k in self._data if k.isidentifier()]
        return [*super().__dir__(), *names, *(bare(k) for k in names)]

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Record):
            return bool(self._data == other._data)
        return bool(self._data == other)

    def __hash__(self) -> int:
        return hash(tuple(self._data))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Record, (self._data,))

    def __repr__(self) -> str:
        parts = [f"{k}={_short(v)}" for k, v in self._data.items()]
        return f"Record({', '.join(parts)})"

    def to_dict(self) -> dict[str, Any]:
        """The data as they are: dictionaries, lists, numbers, text."""
        import copy

        return copy.deepcopy(self._data)


def _keys(record: Record) -> list[str]:
    return list(record)


def _values(record: Record) -> list[Any]:
    return [record[k] for k in record]


def _items(record: Record) -> list[tuple[str, Any]]:
    return [(k, record[k]) for k in record]


def _get(record: Record, name: str, default: Any = None) -> Any:
    return record[name] if name in record else default


#: How to go round the data.
_WAYS: dict[str, Callable[..., Any]] = {"keys": _keys, "values": _values, "items": _items, "get": _get}


def _near(name: str, data: dict[str, Any]) -> str:
    names = [str(k) for k in data]
    near = get_close_matches(name, [*names, *map(bare, names)], n=3)
    if near:
        return f"; did you mean {', '.join(near)}?"
    return f"; there are: {', '.join(names[:20])}" if names else ""


def _short(value: Any) -> str:
    if isinstance(value, dict):
        return "{…}" if value else "{}"
    if isinstance(value, list):
        return f"[{len(value)}]"
    text = repr(value)
    return text if len(text) <= 40 else text[:39] + "…"
