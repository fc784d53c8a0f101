"""Trains."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from . import _willis
from ._compiled import CompiledTrain
from ._errors import Diagnostic
from ._quantity import one, unit
from ._questions import Questions


class Train(Questions):
    """A gear train, from the text of a train file. It never changes; :meth:`with_` gives another one.

    >>> import willis
    >>> train = willis.Train('''
    ...     format = 1
    ...     name = "reducer"
    ...     members = ["sun", "carrier"]
    ...     terminals = ["sun", "carrier"]
    ...     [[set]]
    ...     name = "P1"
    ...     sun = { member = "sun", teeth = 30 }
    ...     ring = { member = "frame", teeth = 70 }
    ...     carrier = "carrier"
    ...     mesh_efficiency = 0.99
    ... ''')
    >>> train.analyze().ratio
    3.3333333333333335
    """

    __slots__ = ("_core", "_warnings")

    def __init__(self, text: str, name: str = "train", *, files: Mapping[str, str] | None = None) -> None:
        self._core = _willis.Train.of(name, text, dict(files or {}))
        self._warnings: list[Diagnostic] | None = None

    @classmethod
    def _of(cls, core: _willis.Train) -> Train:
        train = cls.__new__(cls)
        train._core = core
        train._warnings = None
        return train

    @property
    def name(self) -> str:
        """The name of its file, or that by which it was given."""
        return self._core.name

    @property
    def title(self) -> str:
        """What the file calls it."""
        return self._core.title

    @property
    def text(self) -> str:
        """The train file."""
        return self._core.text

    @property
    def members(self) -> list[str]:
        """Its members, the frame first."""
        return self._core.members

    @property
    def terminals(self) -> list[str]:
        """Members on which torque acts from outside."""
        return self._core.terminals

    @property
    def states(self) -> list[str]:
        """The states of its shift table."""
        return self._core.states

    @property
    def operations(self) -> list[str]:
        """Its operating points."""
        return self._core.operations

    @property
    def scenarios(self) -> list[str]:
        """Its scenarios."""
        return self._core.scenarios

    @property
    def warnings(self) -> list[Diagnostic]:
        """What is odd about it."""
        if self._warnings is None:
            import json

            self._warnings = [Diagnostic._of(d, self.name) for d in json.loads(self._core.warnings())]
        return self._warnings

    def __getitem__(self, path: str) -> Any:
        """A quantity of the file by its path: ``train["P1.sun.teeth"]``. ``None`` where the file does not give it."""
        found = self._core.get(path)
        if found is None:
            return None
        try:
            return int(found)
        except ValueError:
            pass
        try:
            return float(found)
        except ValueError:
            return found.strip('"')

    def with_(self, values: Mapping[str, Any] | None = None, /, **named: Any) -> Train:
        """The same train with other values, by their paths: ``train.with_(**{"P1.sun.teeth": 23})``.

        A number is in SI units where the path says what it is (``rated.speeds.sun``, ``P1.geometry.module``); anything else
        that has a unit comes as text that brings it, and without it is refused.
        """
        all_ = {**(values or {}), **named}
        texts = [(path, one(value, unit(path))) for path, value in all_.items()]
        return Train._of(self._core.with_values(texts))

    def with_laws(self, laws: Mapping[str, str] | None = None, /, **named: str) -> Train:
        """The same train with other laws of loss: ``train.with_laws(mesh_friction="niemann")``."""
        return Train._of(self._core.with_laws(list({**(laws or {}), **named}.items())))

    def compile(
        self,
        state: str | None = None,
        *,
        speeds: Sequence[str] | None = None,
        torques: Sequence[str] | None = None,
        fixed: Sequence[str] = (),
        drag: Mapping[str, tuple[float, float]] | None = None,
        mesh_loss: Mapping[str, Mapping[str, float]] | None = None,
        threads: int | None = None,
    ) -> CompiledTrain:
        """Compiles the train for many points.

        ``speeds`` and ``torques`` are the members at which they are prescribed: without them the input of the state. ``fixed``
        are members held from outside, ``drag`` gives shafts a drag of two parts (N m, N m s), ``mesh_loss`` meshes or sets a
        loss that depends on load and speed (``coefficient``, ``exponent``, ``torque``, ``speed``, ``most``).

        A train that locks when driven from its output has several equilibria under a torque at its input, and one under a
        torque at its output: give ``torques`` there. Points without exactly one answer are told as a warning.
        """
        if state is not None:
            state = str(state)
        ends = self._core.ends(state)
        if (speeds is None or torques is None) and ends[0] is None:
            raise ValueError("the train does not say what its input is: give speeds and torques")
        law = {"coefficient": 0.0, "exponent": 0.0, "torque": 0.0, "speed": 0.0, "most": 0.1}
        duty = {
            "state": state,
            "fixed": list(fixed),
            "speeds": [ends[0]] if speeds is None else _names(speeds),
            "torques": [ends[0]] if torques is None else _names(torques),
            "drag": [(m, float(c), float(v)) for m, (c, v) in (drag or {}).items()],
            "losses": [(name, *(float({**law, **own}[k]) for k in law)) for name, own in (mesh_loss or {}).items()],
        }
        return CompiledTrain(self, duty, threads)

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes the train file. One that is there is replaced with ``force`` only."""
        path = Path(path)
        if path.exists() and not force:
            raise FileExistsError(f"{path} is there already; save(..., force=True) replaces it")
        path.write_text(self.text, encoding="utf-8")
        return path

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Train) and bool(self._core == other._core)

    def __hash__(self) -> int:
        return hash(self._core)

    def __copy__(self) -> Train:
        return self

    def __deepcopy__(self, memo: object) -> Train:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, self._core.parts())

    def __repr__(self) -> str:
        states = f", states {', '.join(self.states)}" if self.states else ""
        return f"<Train {self.title!r}: {', '.join(self.members[1:])}{states}>"

    def _repr_html_(self) -> str:
        from ._answer import _stick

        return f"<p>{escape(repr(self)[1:-1])}</p>{_stick(self, None) or ''}"


def _again(*parts: Any) -> Train:
    return Train._of(_willis.Train.of(*parts))


def _names(given: Sequence[str] | str) -> list[str]:
    return [given] if isinstance(given, str) else list(given)


def read(path: str | os.PathLike[str], *, allow: Sequence[str | os.PathLike[str]] = ()) -> Train:
    """Reads a train file. Tables that it names are read from its folder and from the folders in ``allow``.

    What is odd about the train is told as :class:`TrainWarning`.
    """
    import warnings

    from ._errors import TrainWarning

    train = Train._of(_willis.Train.read(os.fspath(path), [os.fspath(a) for a in allow]))
    for warning in train.warnings:
        if warning.severity == "warning":
            warnings.warn(str(warning), TrainWarning, stacklevel=2)
    return train


def simple(
    name: str = "P1",
    *,
    sun: int,
    ring: int,
    held: str = "ring",
    input: str | None = None,
    output: str | None = None,
    mesh_efficiency: float | tuple[float, float] = 1.0,
    planets: int = 3,
) -> Train:
    """A simple planetary set: a sun, planets on a carrier, a ring.

    ``held`` is what stands still: ``"ring"``, ``"carrier"``, ``"sun"``, or ``"none"`` for two freedoms. Input is the first of
    sun, ring, carrier that is free, output the last, unless they are named. ``mesh_efficiency`` is that of each mesh, or of
    sun and ring.

    >>> import willis
    >>> willis.simple("P1", sun=30, ring=70).analyze().ratio
    3.3333333333333335
    """
    shafts = ["sun", "ring", "carrier"]
    if held not in (*shafts, "none"):
        raise ValueError(f"held is one of sun, ring, carrier, none, and not {held!r}")
    free = [s for s in shafts if s != held]
    input, output = input or free[0], output or free[-1]
    for end in (input, output):
        if end not in free:
            raise ValueError(f"{end!r} does not turn: {', '.join(free)} do")
    of = {s: "frame" if s == held else s for s in shafts}
    both = mesh_efficiency if isinstance(mesh_efficiency, tuple) else (mesh_efficiency, mesh_efficiency)
    text = f"""format = 1
name = {_text(name)}
members = [{", ".join(_text(s) for s in free)}]
terminals = [{", ".join(_text(s) for s in free)}]
input = {_text(input)}
output = {_text(output)}

[[set]]
name = {_text(name)}
sun = {{ member = {_text(of["sun"])}, teeth = {int(sun)} }}
planet = {{ count = {int(planets)} }}
ring = {{ member = {_text(of["ring"])}, teeth = {int(ring)} }}
carrier = {_text(of["carrier"])}
mesh_efficiency = {{ external = {float(both[0])!r}, internal = {float(both[1])!r} }}
"""
    return Train(text, name)


def _text(value: str) -> str:
    import json

    return json.dumps(str(value))
