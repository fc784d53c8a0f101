"""Compiled trains: arrays in, arrays out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _willis
from ._errors import TrainWarning

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike, NDArray

    from ._train import Train


class CompiledTrain:
    """A train ready to be evaluated at many points; made by :meth:`Train.compile`.

    Inputs are what the duty prescribes, in rad/s and N m, by position (speeds, then torques) or by name: ``speed`` and
    ``torque`` where there is one of each, else ``speed_sun`` or a mapping. They broadcast as numpy arrays do. Losses are those
    of given efficiencies. A point that locks is NaN, and one that does not have exactly one answer is told as a
    :class:`TrainWarning`.

    >>> import numpy as np, willis
    >>> t = willis.read("examples/zf-8hp70.toml").compile(state="3")
    >>> float(t.efficiency(speed=200.0, torque=[50.0, 300.0])[1].round(4))
    0.982
    """

    __slots__ = ("_cores", "_duty", "_train", "odd", "threads")

    def __init__(self, train: Train, duty: dict[str, Any], threads: int | None) -> None:
        self._train = train
        self._duty = duty
        self._cores: dict[tuple[tuple[str, str], ...], _willis.Compiled] = {}
        self.threads = threads
        #: At how many points of the last evaluation there was not one answer.
        self.odd = 0
        self._core((("efficiency", ""),))

    @property
    def speeds(self) -> list[str]:
        """Members whose speeds are prescribed."""
        return list(self._duty["speeds"])

    @property
    def torques(self) -> list[str]:
        """Members whose torques are prescribed."""
        return list(self._duty["torques"])

    @property
    def is_certified(self) -> bool:
        """Whether every load has exactly one answer."""
        return self._core((("efficiency", ""),)).is_certified

    def _core(self, outputs: tuple[tuple[str, str], ...]) -> _willis.Compiled:
        core = self._cores.get(outputs)
        if core is None:
            core = self._train._core.compile({**self._duty, "outputs": list(outputs)})
            self._cores[outputs] = core
        return core

    def _inputs(self, args: Sequence[ArrayLike], named: Mapping[str, ArrayLike]) -> list[NDArray[np.float64]]:
        names = [("speed", m) for m in self._duty["speeds"]] + [("torque", m) for m in self._duty["torques"]]
        given: dict[int, Any] = dict(enumerate(args))
        if len(args) > len(names):
            raise TypeError(f"{len(args)} inputs, and the duty prescribes {len(names)}")
        for name, value in named.items():
            fitting = [
                k for k, (what, member) in enumerate(names)
                if name in (f"{what}_{member}", f"{member}.{what}", f"{what}.{member}")
            ] or [k for k, (what, _) in enumerate(names) if what == name]
            if len(fitting) != 1 or fitting[0] in given:
                known = ", ".join(f"{what}_{member}" for what, member in names)
                raise TypeError(f"`{name}` is none of what is prescribed, or is given twice: {known}")
            given[fitting[0]] = value
        missing = [f"{what}_{member}" for k, (what, member) in enumerate(names) if k not in given]
        if missing:
            raise TypeError(f"what is prescribed is missing: {', '.join(missing)}")
        return [_floats(given[k], "_".join(names[k])) for k in range(len(names))]

    def _flat(
        self, args: Sequence[ArrayLike], named: Mapping[str, ArrayLike]
    ) -> tuple[list[NDArray[np.float64]], tuple[int, ...], int]:
        """Inputs one after the other, one of length one where it is the same everywhere; shape and number of points."""
        inputs = self._inputs(args, named)
        shape = np.broadcast_shapes(*(a.shape for a in inputs))
        flat = [
            a.reshape(1) if a.size == 1 else np.ascontiguousarray(np.broadcast_to(a, shape)).reshape(-1) for a in inputs
        ]
        return flat, shape, int(np.prod(shape))

    def _tell(self, odd: int, points: int) -> None:
        """Says that numbers stand for something else than the only answer."""
        self.odd = odd
        if odd:
            warnings.warn(
                f"{odd} of {points} points do not have exactly one answer: where the train locks the result is NaN, of several "
                "equilibria it is one of them. `analyze` and `sweep` tell them apart; under a torque at the output there "
                "is often one answer where a torque at the input leaves several: compile(torques=[...])",
                TrainWarning,
                stacklevel=4,
            )

    def evaluate(
        self,
        *args: ArrayLike,
        outputs: Sequence[str] | str = ("efficiency",),
        dtype: DTypeLike = np.float64,
        **named: ArrayLike,
    ) -> dict[str, NDArray[Any]]:
        """Several results at once: ``efficiency``, ``loss``, ``ring.torque``, ``sun.speed``; of meshes and shift elements
        ``P1.sun-planet.torque``, ``clutch.torque``.

        The result has an array for each, of the shape to which the inputs broadcast. Points that do not have exactly one
        answer are counted in :attr:`odd` and told as :class:`TrainWarning`. With ``dtype=numpy.float32`` results are rounded
        to single precision and take half the memory; they are computed as ever.

        >>> import willis
        >>> t = willis.read("examples/zf-8hp70.toml").compile(state="3")
        >>> t.evaluate(200.0, [50.0, 300.0], dtype="float32")["efficiency"].dtype
        dtype('float32')
        """
        wanted = [outputs] if isinstance(outputs, str) else list(outputs)
        flat, shape, points = self._flat(args, named)
        core = self._core(tuple(map(_output, wanted)))
        threads = _threads(self.threads, points)
        arrays: list[NDArray[Any]]
        if np.dtype(dtype) == np.float64:
            double, odd = core.evaluate(flat, points, threads)
            arrays = list(double)
        elif np.dtype(dtype) == np.float32:
            single, odd = core.evaluate_f32(flat, points, threads)
            arrays = list(single)
        else:
            raise TypeError(f"results are float64 or float32, not {np.dtype(dtype)}")
        self._tell(odd, points)
        return {name: array.reshape(shape) for name, array in zip(wanted, arrays, strict=True)}

    def efficiency(self, *args: ArrayLike, dtype: DTypeLike = np.float64, **named: ArrayLike) -> NDArray[Any]:
        """Output power over input power; 0 where no power enters."""
        return self.evaluate(*args, outputs="efficiency", dtype=dtype, **named)["efficiency"]

    def loss(self, *args: ArrayLike, dtype: DTypeLike = np.float64, **named: ArrayLike) -> NDArray[Any]:
        """All that is lost, W."""
        return self.evaluate(*args, outputs="loss", dtype=dtype, **named)["loss"]

    def torque_of(
        self, member: str, *args: ArrayLike, dtype: DTypeLike = np.float64, **named: ArrayLike
    ) -> NDArray[Any]:
        """External torque on a terminal, N m."""
        return self.evaluate(*args, outputs=f"{member}.torque", dtype=dtype, **named)[f"{member}.torque"]

    def speed_of(
        self, member: str, *args: ArrayLike, dtype: DTypeLike = np.float64, **named: ArrayLike
    ) -> NDArray[Any]:
        """Speed of a member, rad/s."""
        return self.evaluate(*args, outputs=f"{member}.speed", dtype=dtype, **named)[f"{member}.speed"]

    def mean(self, *args: ArrayLike, outputs: Sequence[str] | str = "efficiency", **named: ArrayLike) -> dict[str, float]:
        """The mean of results over all points, of which none is stored."""
        wanted = [outputs] if isinstance(outputs, str) else list(outputs)
        flat, _, points = self._flat(args, named)
        sums, odd = self._core(tuple(map(_output, wanted))).sum(flat, points)
        self._tell(odd, points)
        return {name: s / points if points else float("nan") for name, s in zip(wanted, sums, strict=True)}

    def __reduce__(self) -> tuple[Any, ...]:
        return (CompiledTrain, (self._train, self._duty, self.threads))

    def __repr__(self) -> str:
        names = [f"speed_{m}" for m in self._duty["speeds"]] + [f"torque_{m}" for m in self._duty["torques"]]
        state = f" in {self._duty['state']!r}" if self._duty["state"] else ""
        return f"<CompiledTrain {self._train.title!r}{state}: of {', '.join(names)}>"


def _output(name: str) -> tuple[str, str]:
    of, _, kind = name.rpartition(".")
    if name in ("efficiency", "loss"):
        return (name, "")
    if kind in ("torque", "speed") and of:
        return (kind, of)
    raise ValueError(
        f"`{name}` is no result: efficiency, loss, MEMBER.torque, MEMBER.speed, MESH.torque or ELEMENT.torque"
    )


def _floats(value: Any, name: str) -> NDArray[np.float64]:
    array = np.asarray(value)
    if array.dtype.kind in "cmM":
        raise TypeError(f"{name}: numbers are needed, in rad/s and N m; this is an array of {array.dtype}")
    if array.dtype.kind not in "fiub":
        try:
            array = np.asarray([float(v) for v in array.ravel()]).reshape(array.shape)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"{name}: numbers are needed, in rad/s and N m; this is an array of {array.dtype}") from None
    return array.astype(np.float64, copy=False)


def _threads(threads: int | None, points: int) -> int:
    if threads is not None:
        return max(1, int(threads))
    # A thread is worth its start from some hundred thousand points on.
    return max(1, min(os.cpu_count() or 1, points // 200_000))
