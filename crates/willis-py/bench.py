"""Speed of the package, and of numpy beside it, in one run: ``python crates/willis-py/bench.py``.

Each time is the best of several runs of one thread; what counts is the ratio. A sum is printed beside each map, so that it
shows that both did the same work.
"""

from __future__ import annotations

import subprocess
import sys
import time
import warnings
from collections.abc import Callable

import numpy as np
import willis
from willis import _willis

warnings.simplefilter("ignore", willis.TrainWarning)

POINTS = 1_000_000


def best(work: Callable[[], object], runs: int) -> float:
    """The shortest time of a call, s."""
    least = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        work()
        least = min(least, time.perf_counter() - start)
    return least


def row(what: str, peer: str, theirs: float, ours: float) -> None:
    """One line: what, the peer, both times, their ratio."""
    print(f"{what:42} {peer:24} {1e3 * theirs:10.3f} ms {1e3 * ours:10.3f} ms {theirs / ours:8.2f} x")


def numpy_map(w1: np.ndarray, wc: np.ndarray, t1: np.ndarray, i0: float, eta: float) -> tuple[np.ndarray, ...]:
    """A set with three terminals as one writes it with numpy: ring torque, carrier torque, loss, efficiency."""
    w2 = wc + (w1 - wc) / i0
    drives = t1 * (w1 - wc) > 0
    t2 = -i0 * t1 * np.where(drives, eta, 1 / eta)
    tc = -(t1 + t2)
    powers = np.stack([t1 * w1, t2 * w2, tc * wc])
    power_in = np.where(powers > 0, powers, 0).sum(axis=0)
    loss = powers.sum(axis=0)
    return t2, tc, loss, np.where(power_in > 0, (power_in - loss) / np.where(power_in > 0, power_in, 1), 0)


def main() -> None:
    """Prints the table."""
    print(f"{'what':42} {'peer':24} {'peer':>13} {'willis':>13} {'ratio':>10}")
    train = willis.read("examples/zf-8hp70.toml")
    core = best(lambda: _willis.ask("analyze", "{}", [train._core]), 300)
    row("analyze, 8HP70, all gears", "the library inside", core, best(lambda: train.analyze(), 300))

    set_ = willis.simple("P", sun=30, ring=70, held="none", mesh_efficiency=0.99)
    compiled = set_.compile(speeds=["sun", "carrier"], torques=["sun"], threads=1)
    rng = np.random.default_rng(1)
    w1, wc, t1 = rng.uniform(-300, 300, POINTS), rng.uniform(-300, 300, POINTS), rng.uniform(-100, 100, POINTS)
    outputs = ["ring.torque", "carrier.torque", "loss", "efficiency"]
    ours = compiled.evaluate(w1, wc, t1, outputs=outputs)
    theirs = numpy_map(w1, wc, t1, -70 / 30, 0.99 * 0.99)
    for name, mine, other in zip(outputs, ours.values(), theirs, strict=True):
        assert np.allclose(mine, other, rtol=1e-9, atol=1e-9), name
    print(f"  sums of both: {ours['loss'].sum():.6f} {theirs[2].sum():.6f}")
    row(
        f"map of three terminals, {POINTS:.0e} points",
        "numpy, whole arrays",
        best(lambda: numpy_map(w1, wc, t1, -70 / 30, 0.99 * 0.99), 7),
        best(lambda: compiled.evaluate(w1, wc, t1, outputs=outputs), 15),
    )
    row(
        "its mean efficiency, nothing stored",
        "numpy, whole arrays",
        best(lambda: numpy_map(w1, wc, t1, -70 / 30, 0.99 * 0.99)[3].mean(), 7),
        best(lambda: compiled.mean(w1, wc, t1), 15),
    )

    imports = "import time; t = time.perf_counter(); import numpy; a = time.perf_counter(); import {0}; print(a - t, time.perf_counter() - a)"
    times = [subprocess.check_output([sys.executable, "-c", imports.format("willis")], text=True).split() for _ in range(7)]
    row("import, numpy apart", "numpy itself", min(float(t[0]) for t in times), min(float(t[1]) for t in times))


if __name__ == "__main__":
    main()
