"""Quantities as the library reads them: text with a unit."""

from __future__ import annotations

from typing import Any

import numpy as np

#: Units of SI by a word of the path of a quantity.
UNITS = {
    "speed": "rad/s",
    "speeds": "rad/s",
    "initial_speeds": "rad/s",
    "torque": "N m",
    "torques": "N m",
    "power": "W",
    "powers": "W",
    "temperature": "K",
    "inertia": "kg m^2",
    "inertias": "kg m^2",
    "stiffness": "N m/rad",
    "module": "m",
    "width": "m",
    "roughness": "m",
    "capacity": "N m",
    "duration": "s",
    "pressure": "Pa",
}


def unit(path: str) -> str:
    """The unit of a number for a quantity, as its path says it; empty where the path does not say.

    >>> unit("input.speed"), unit("rated.torques.sun"), unit("P1.sun.teeth")
    ('rad/s', 'N m', '')
    """
    return next((UNITS[part] for part in reversed(path.split(".")) if part in UNITS), "")


def one(value: Any, own: str = "") -> str:
    """A value as text: text as it is, a number in SI, a quantity of ``pint`` with its unit.

    >>> one(3), one("1500 rpm"), one(10.0, "N m")
    ('3', '1500 rpm', '10.0 N m')
    """
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return f"{int(value)} {own}".rstrip()
    if isinstance(value, (float, np.floating)):
        number = float(value)
        if number != number or number in (float("inf"), float("-inf")):
            raise ValueError(f"{number} is no value")
        return f"{number!r} {own}".rstrip()
    if hasattr(value, "to_base_units") and hasattr(value, "magnitude"):
        return _of_pint(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(one(v, own) if not isinstance(v, str) else repr(v) for v in value) + "]"
    raise TypeError(f"{value!r} is no quantity: a number in SI units, text with a unit or a quantity of pint")


def _of_pint(value: Any) -> str:
    """A quantity of ``pint``: in SI units whose names the library knows."""
    for name in dict.fromkeys(UNITS.values()):
        try:
            return f"{value.to(name.replace('N m', 'N*m').replace('kg m', 'kg*m')).magnitude!r} {name}"
        except Exception:  # noqa: BLE001 - pint has its own family of errors
            continue
    if value.dimensionless:
        return repr(float(value.to("").magnitude))
    raise ValueError(f"{value} has a unit that no quantity of a train has")


def listed(values: Any, own: str) -> list[str]:
    """Quantities as texts, of members as ``member=quantity``.

    >>> listed({"sun": 100.0}, "rad/s"), listed([1.0, "3 N m"], "N m"), listed("5 W", "W")
    (['sun=100.0 rad/s'], ['1.0 N m', '3 N m'], ['5 W'])
    """
    if hasattr(values, "items"):
        return [f"{name}={one(value, own)}" for name, value in values.items()]
    if isinstance(values, str) or not hasattr(values, "__iter__") or hasattr(values, "magnitude"):
        return [one(values, own)]
    return [one(value, own) for value in values]


def axis(name: str, values: Any) -> str:
    """An axis of a sweep: ``input.speed=500 rpm..6000 rpm:100``.

    >>> axis("state", ["1", "2"])
    'state=1,2'
    >>> axis("output.torque", np.array([10.0, 20.0]))
    'output.torque=10.0 N m,20.0 N m'
    """
    if isinstance(values, str):
        return f"{name}={values}"
    items = values if isinstance(values, (list, tuple, range)) else np.asarray(values).ravel().tolist()
    texts = [one(v, unit(name)) for v in items]
    if not texts:
        raise ValueError(f"the axis {name} has no values")
    return f"{name}=" + ",".join(texts)


def axes(over: Any) -> list[str]:
    """Axes as a list of texts, from a mapping, a text or a list of texts."""
    if over is None:
        return []
    if isinstance(over, str):
        return [over]
    if hasattr(over, "items"):
        return [axis(name, values) for name, values in over.items()]
    return [str(text) for text in over]


def csv(table: Any) -> str:
    """A table as CSV: a mapping of columns, a data frame or anything that Arrow reads."""
    if hasattr(table, "items") and not hasattr(table, "columns"):
        columns = {str(name): np.asarray(values) for name, values in table.items()}
    elif hasattr(table, "write_csv"):
        return str(table.write_csv())
    elif hasattr(table, "to_csv"):
        return str(table.to_csv(index=False))
    elif hasattr(table, "to_pydict"):
        columns = {str(name): np.asarray(values) for name, values in table.to_pydict().items()}
    else:
        raise TypeError(f"{type(table).__name__} is no table: a path, a mapping of columns or a data frame")
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise ValueError("columns of one length")
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    lines = [",".join(columns)]
    lines += [",".join("" if v is None else str(v) for v in row) for row in rows]
    return "\n".join(lines) + "\n"
