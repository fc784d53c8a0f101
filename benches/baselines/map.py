"""Baseline: map of one simple planetary set with losses, in numpy and numba.

    python map.py [--points 10000000] [--runs 7] [--json]

Given the speeds of sun and carrier and the torque on the sun, find the torques on ring
and carrier, the loss and the efficiency. One thread, process CPU time, best run.
A torque is positive as applied to the shaft from outside; positive power goes in.
Each shaft's drag (Coulomb + viscous) lies outside the mesh. Efficiency is output power
over input power of the three shafts, and 0 where no power goes in.

Checksums are plain sums over all points. The program fails if they differ.
"""

import argparse

from common import best, check, inputs, line, show

import numpy as np
from numba import njit

Z_SUN, Z_RING = 30, 70
ETA = 0.985 * 0.99
I0 = -Z_RING / Z_SUN
COULOMB_SUN, COULOMB_RING, COULOMB_CARRIER = 0.4, 0.8, 0.6
VISCOUS_SUN, VISCOUS_RING, VISCOUS_CARRIER = 1e-3, 2e-3, 1.5e-3

RANGES = (-400.0, 800.0), (-150.0, 300.0), (-200.0, 400.0)
OUTPUTS = "torque_ring", "torque_carrier", "loss", "efficiency"
BLOCK = 16384


def whole(w_sun, w_carrier, t_sun):
    """All four outputs; arrays in, arrays out."""
    w_ring = (w_sun - (1 - I0) * w_carrier) / I0
    mesh_sun = t_sun - COULOMB_SUN * np.sign(w_sun) - VISCOUS_SUN * w_sun
    forward = mesh_sun * (w_sun - w_carrier) >= 0
    mesh_ring = np.where(forward, -I0 * ETA, -I0 / ETA) * mesh_sun
    t_ring = mesh_ring + COULOMB_RING * np.sign(w_ring) + VISCOUS_RING * w_ring
    drag_carrier = COULOMB_CARRIER * np.sign(w_carrier) + VISCOUS_CARRIER * w_carrier
    t_carrier = drag_carrier - (mesh_sun + mesh_ring)
    p_sun, p_ring, p_carrier = t_sun * w_sun, t_ring * w_ring, t_carrier * w_carrier
    p_in = np.maximum(p_sun, 0) + np.maximum(p_ring, 0) + np.maximum(p_carrier, 0)
    loss = p_sun + p_ring + p_carrier
    with np.errstate(invalid="ignore"):
        efficiency = np.where(p_in > 0, (p_in - loss) / p_in, 0.0)
    return t_ring, t_carrier, loss, efficiency


def blocks(*given):
    """The same, one cache-sized block after another."""
    for i in range(0, given[0].size, BLOCK):
        part = slice(i, i + BLOCK)
        yield part, whole(*(x[part] for x in given))


def blocked_all(given, out):
    for part, results in blocks(*given):
        for target, result in zip(out, results):
            target[part] = result
    return out


def blocked_efficiency(given, out):
    for part, results in blocks(*given):
        out[part] = results[3]
    return out


fused = njit(fastmath=True, error_model="numpy")


@fused
def point(w_sun, w_carrier, t_sun):
    w_ring = (w_sun - (1 - I0) * w_carrier) / I0
    mesh_sun = t_sun - COULOMB_SUN * np.sign(w_sun) - VISCOUS_SUN * w_sun
    forward = mesh_sun * (w_sun - w_carrier) >= 0
    mesh_ring = (-I0 * ETA if forward else -I0 / ETA) * mesh_sun
    t_ring = mesh_ring + COULOMB_RING * np.sign(w_ring) + VISCOUS_RING * w_ring
    drag_carrier = COULOMB_CARRIER * np.sign(w_carrier) + VISCOUS_CARRIER * w_carrier
    t_carrier = drag_carrier - (mesh_sun + mesh_ring)
    p_sun, p_ring, p_carrier = t_sun * w_sun, t_ring * w_ring, t_carrier * w_carrier
    p_in = max(p_sun, 0.0) + max(p_ring, 0.0) + max(p_carrier, 0.0)
    loss = p_sun + p_ring + p_carrier
    efficiency = (p_in - loss) / p_in if p_in > 0 else 0.0
    return t_ring, t_carrier, loss, efficiency


@fused
def loop_all(w_sun, w_carrier, t_sun, t_ring, t_carrier, loss, efficiency):
    for i in range(w_sun.size):
        a, b, c, d = point(w_sun[i], w_carrier[i], t_sun[i])
        t_ring[i] = a
        t_carrier[i] = b
        loss[i] = c
        efficiency[i] = d


@fused
def loop_eta(w_sun, w_carrier, t_sun, efficiency):
    for i in range(w_sun.size):
        efficiency[i] = point(w_sun[i], w_carrier[i], t_sun[i])[3]


@fused
def loop_mean(w_sun, w_carrier, t_sun):
    total = 0.0
    for i in range(w_sun.size):
        total += point(w_sun[i], w_carrier[i], t_sun[i])[3]
    return total / w_sun.size


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    args = parser.parse_args()
    n = args.points
    x = inputs(n, *RANGES)
    out = [np.zeros(n) for _ in OUTPUTS]
    last = out[3]

    def sums(results):
        return {name: float(r.sum()) for name, r in zip(OUTPUTS, results)}

    def one(result):
        return {"efficiency": float(result.sum())}

    def mean(result):
        return {"efficiency": float(result) * n}

    def blocked_mean():
        return sum(results[3].sum() for _, results in blocks(*x)) / n

    cases = [
        ("map-all", "numpy-whole-array", lambda: whole(*x), sums),
        ("map-all", "numpy-blocked", lambda: blocked_all(x, out), sums),
        ("map-all", "numba-fused", lambda: loop_all(*x, *out) or out, sums),
        ("map-efficiency", "numpy-whole-array", lambda: whole(*x)[3], one),
        ("map-efficiency", "numpy-blocked", lambda: blocked_efficiency(x, last), one),
        ("map-efficiency", "numba-fused", lambda: loop_eta(*x, last) or last, one),
        ("map-reduced", "numpy-whole-array", lambda: whole(*x)[3].mean(), mean),
        ("map-reduced", "numpy-blocked", blocked_mean, mean),
        ("map-reduced", "numba-fused", lambda: loop_mean(*x), mean),
    ]
    entries = []
    for task, peer, run, total in cases:
        for r in out:
            r.fill(np.nan)
        seconds, result = best(run, args.runs)
        entries.append(line(task, peer, n, seconds, total(result)))
        show(entries[-1], args.json)
    check(entries)


if __name__ == "__main__":
    main()
