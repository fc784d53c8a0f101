"""Baseline: torques of a four-set, eight-speed automatic transmission, in numpy.

    python automatic.py [--points 1000000] [--runs 5] [--json]

Eight shafts, four simple planetary sets, two brakes and three clutches of which three
are closed, input and output. Given input speed and input torque, find the eight unknown
torques: on the four suns, in the three closed elements, at the output. One thread,
process CPU time, best run.

Each set has a constant basic efficiency, so the ratio of its ring torque to its sun
torque depends on the direction of power in its mesh; a set whose shafts turn together
loses nothing. Each shaft has Coulomb and viscous drag. Torques are positive as a set
receives them from the shaft, as a closed element pushes its first shaft (and pulls its
second), and as applied to the output from outside.

  numpy-batched-solve   8x8 solves of many points at once, repeated until the directions
                        of power no longer change
  numpy-precomputed     the solution for each of the 16 patterns of directions prepared
                        outside the timing, then picked per point
  numpy-grouped         the same, the points of a pattern together
  numba-fused           the same in a compiled loop
  numpy-one-point       as numpy-batched-solve, one point a call, from the description
                        of the gear to the torques

Once more with losses that depend on load and speed (tasks automatic-load-gear-N): a set
loses 0.02 ((|t| + 1)/(|w| + 1))^0.2 of its power, t its sun's torque in N m and w its sun's
speed relative to the carrier in rad/s; numpy-batched-solve then repeats five solves, each
with the losses of the one before.

Checksums are plain sums over all points: the output torque, all eight torques, and each
of the eight. The program fails if they differ.
"""

import argparse
from functools import partial

from common import best, check, inputs, line, show

import numpy as np
from numba import njit

SETS = [(0, 1, 2), (0, 4, 3), (4, 5, 6), (5, 2, 7)]  # shafts of sun, ring, carrier
TEETH = np.array([(48, 96), (48, 96), (69, 111), (23, 85)])  # sun, ring
INPUT, OUTPUT, SHAFTS = 3, 7, 8
ELEMENTS = {"A": (0, None), "B": (1, None), "C": (3, 5), "D": (6, 7), "E": (4, 5)}
GEARS = {1: "ABC", 3: "BCE", 5: "BCD"}

RHO = TEETH[:, 1] / TEETH[:, 0]
ETA = 0.985 * 0.99
COULOMB, VISCOUS = 0.2, 1e-3

RANGES = (80.0, 420.0), (-100.0, 450.0)
BITS = 1 << np.arange(4)
ONE_POINT_GEAR, ONE_POINTS = 3, 2000
LOSS, EXPONENT, SOLVES = 0.02, 0.2, 5


def closed(gear):
    """Row or column of each closed element, and the shafts it joins."""
    return [(4 + j, *ELEMENTS[name]) for j, name in enumerate(GEARS[gear])]


def speeds(gear):
    """Speeds of the shafts, and of suns relative to carriers, at input speed 1."""
    a = np.zeros((SHAFTS, SHAFTS))
    for i, ((sun, ring, carrier), (z_sun, z_ring)) in enumerate(zip(SETS, TEETH)):
        a[i, sun] += z_sun
        a[i, ring] += z_ring
        a[i, carrier] -= z_sun + z_ring
    for i, p, q in closed(gear):
        a[i, p] += 1
        if q is not None:
            a[i, q] -= 1
    a[7, INPUT] = 1
    w = np.linalg.solve(a, np.eye(SHAFTS)[7])
    relative = np.array([w[sun] - w[carrier] for sun, _, carrier in SETS])
    return [np.where(np.abs(x) < 1e-9, 0.0, x) for x in (w, relative)]


def balance(gear, k):
    """Torque balance of the shafts for ring-to-sun torque ratios k (..., 4)."""
    a = np.zeros((*k.shape[:-1], SHAFTS, SHAFTS))
    for i, (sun, ring, carrier) in enumerate(SETS):
        a[..., sun, i] += 1
        a[..., ring, i] += k[..., i]
        a[..., carrier, i] -= 1 + k[..., i]
    for i, p, q in closed(gear):
        a[..., p, i] -= 1
        if q is not None:
            a[..., q, i] += 1
    a[..., OUTPUT, 7] -= 1
    return a


def ratios(forward, relative):
    """Ring-to-sun torque ratios for the directions of power."""
    eta = np.where(forward, ETA, 1 / ETA)
    return RHO * np.where(relative == 0, 1.0, eta)


def solve(gear, w, relative, w_in, t_in, rounds=8):
    """Eight torques per point; w_in > 0."""
    rhs = -COULOMB * np.sign(w) - VISCOUS * w_in[:, None] * w
    rhs[:, INPUT] += t_in
    k = np.broadcast_to(RHO, (w_in.size, 4))
    for _ in range(rounds):
        x = np.linalg.solve(balance(gear, k), rhs[..., None])[..., 0]
        last, k = k, ratios(x[:, :4] * relative >= 0, relative)
        if np.array_equal(k, last):
            return x
    raise ArithmeticError("the directions of power do not settle")


def solve_load(gear, w, relative, w_in, t_in):
    """The same with losses that depend on load and speed."""
    rhs = -COULOMB * np.sign(w) - VISCOUS * w_in[:, None] * w
    rhs[:, INPUT] += t_in
    v = relative * w_in[:, None]
    k = np.broadcast_to(RHO, (w_in.size, 4))
    for _ in range(SOLVES):
        x = np.linalg.solve(balance(gear, k), rhs[..., None])[..., 0]
        t = x[:, :4]
        eta = 1 - LOSS * ((np.abs(t) + 1) / (np.abs(v) + 1)) ** EXPONENT
        k = RHO * np.where(relative == 0, 1.0, np.where(t * v >= 0, eta, 1 / eta))
    return x


def patterns(gear, w, relative):
    """What the 16 patterns make of (t_in, w_in, 1), the relative speeds' signs, and the
    patterns to try first at negative and at positive input torque."""
    forward = (np.arange(16)[:, None] & BITS) != 0
    inverse = np.linalg.inv(balance(gear, ratios(forward, relative)))
    drag = inverse @ (-VISCOUS * w), inverse @ (-COULOMB * np.sign(w))
    maps = np.stack([inverse[:, :, INPUT], *drag], axis=1)
    signs = np.sign(relative)
    heavy = solve(gear, w, relative, np.ones(2), np.array([-1e6, 1e6]))
    return maps, signs, pattern(heavy, signs)


def pattern(x, signs):
    """Number of the pattern of directions in which torques x transmit power."""
    return (x[:, :4] * signs >= 0) @ BITS


def picked(maps, signs, first, w_in, t_in):
    """Eight torques per point, from the map of each point's pattern."""
    p = first[(t_in >= 0).astype(int)]
    while True:
        x = t_in[:, None] * maps[p, 0] + w_in[:, None] * maps[p, 1] + maps[p, 2]
        last, p = p, pattern(x, signs)
        if np.array_equal(p, last):
            return x


def grouped(maps, signs, first, w_in, t_in):
    """The same, one matrix product for the points of each pattern."""
    given = np.stack([t_in, w_in, np.ones_like(t_in)], axis=1)
    x = np.empty((w_in.size, SHAFTS))
    todo = [(first[i], np.flatnonzero((t_in >= 0) == i)) for i in (0, 1)]
    while todo:
        p, points = todo.pop()
        part = given[points] @ maps[p]
        x[points] = part
        found = pattern(part, signs)
        wrong = found != p
        if wrong.any():
            points, found = points[wrong], found[wrong]
            todo += [(q, points[found == q]) for q in np.unique(found)]
    return x


@njit(fastmath=True)
def fused(maps, signs, first, w_in, t_in, out):
    for i in range(w_in.size):
        found = first[1] if t_in[i] >= 0 else first[0]
        p = -1
        while p != found:
            p = found
            for j in range(8):
                x = t_in[i] * maps[p, 0, j] + w_in[i] * maps[p, 1, j]
                out[i, j] = x + maps[p, 2, j]
            found = 0
            for j in range(4):
                found |= (out[i, j] * signs[j] >= 0) << j


def blocked(block, function, w_in, t_in, out):
    """Torques of all points, one cache-sized block after another."""
    for i in range(0, w_in.size, block):
        part = slice(i, i + block)
        out[part] = function(w_in[part], t_in[part])


def one_by_one(gear, w_in, t_in, out):
    for i in range(w_in.size):
        part = slice(i, i + 1)
        out[part] = solve(gear, *speeds(gear), w_in[part], t_in[part])


def sums(x):
    each = x.sum(axis=0).tolist()
    return {"torque_out": each[-1], "torque_all": sum(each), "torque_each": each}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    args = parser.parse_args()
    x = inputs(args.points, *RANGES)
    out = np.empty((args.points, SHAFTS))

    def measure(gear, peer, run, given, out, task="automatic-gear"):
        out.fill(np.nan)
        seconds, _ = best(lambda: run(*given, out), args.runs)
        entry = line(f"{task}-{gear}", peer, len(out), seconds, sums(out))
        show(entry, args.json)
        return entry

    for gear in GEARS:
        turning = speeds(gear)
        maps = patterns(gear, *turning)
        batched = partial(solve, gear, *turning)
        cases = {
            "numpy-batched-solve": partial(blocked, 2048, batched),
            "numpy-precomputed": partial(blocked, 4096, partial(picked, *maps)),
            "numpy-grouped": partial(blocked, 16384, partial(grouped, *maps)),
            "numba-fused": partial(fused, *maps),
        }
        check([measure(gear, peer, run, x, out) for peer, run in cases.items()])
        if gear == ONE_POINT_GEAR:
            few = out[:ONE_POINTS].copy()

    for gear in GEARS:
        run = partial(blocked, 2048, partial(solve_load, gear, *speeds(gear)))
        measure(gear, "numpy-batched-solve", run, x, out, "automatic-load-gear")

    given = [column[:ONE_POINTS] for column in x]
    run = partial(one_by_one, ONE_POINT_GEAR)
    entry = measure(ONE_POINT_GEAR, "numpy-one-point", run, given, out[:ONE_POINTS])
    check([entry, entry | {"checksum": sums(few)}])


if __name__ == "__main__":
    main()
