"""Baseline: a grid of ten million operating points reduced to a few numbers, in numpy and numba.

    python study.py [--runs 7] [--json]

Speeds of sun and carrier and the torque on the sun of one simple planetary set run through a grid; wanted are
mean, least and greatest efficiency and loss. The grid belongs to the work: values are made, not read. One
thread, process CPU time, best run.
"""

import argparse

from common import best, check, line, show

import numpy as np
from numba import njit

I0 = -70 / 30
ETA = 0.985 * 0.99
AXES = (-400.0, 800.0, 200), (-150.5, 300.0, 100), (1.0, 200.0, 500)
POINTS = 200 * 100 * 500


def numpy_whole():
    """Whole arrays over the grid, as one would write it."""
    w_s, w_c, t_s = np.meshgrid(*[np.linspace(*a) for a in AXES], indexing="ij", sparse=True)
    w_r = w_c + (w_s - w_c) / I0
    relative = w_s - w_c
    drives = t_s * relative > 0.0
    # Ring torque: the force of the mesh, less what friction takes at the driven side.
    t_r = -I0 * np.where(drives, ETA, 1.0 / ETA) * t_s
    t_c = -(t_s + t_r)
    powers = [t_s * w_s, t_r * w_r, t_c * w_c]
    power_in = sum(np.maximum(p, 0.0) for p in powers)
    loss = sum(powers)
    efficiency = (power_in - loss) / power_in
    return [f(x) for x in (efficiency, loss) for f in (np.mean, np.min, np.max)]


def numpy_blocked():
    """Plane by plane: what fits in the cache."""
    s, c, t = [np.linspace(*a) for a in AXES]
    w_c, t_s = c[:, None], t[None, :]
    total = [0.0, np.inf, -np.inf, 0.0, np.inf, -np.inf]
    for w_s in s:
        w_r = w_c + (w_s - w_c) / I0
        drives = t_s * (w_s - w_c) > 0.0
        t_r = -I0 * np.where(drives, ETA, 1.0 / ETA) * t_s
        t_c = -(t_s + t_r)
        p_s, p_r, p_c = t_s * w_s, t_r * w_r, t_c * w_c
        power_in = np.maximum(p_s, 0.0) + np.maximum(p_r, 0.0) + np.maximum(p_c, 0.0)
        loss = p_s + p_r + p_c
        efficiency = (power_in - loss) / power_in
        for k, x in ((0, efficiency), (3, loss)):
            total[k] += x.sum()
            total[k + 1] = min(total[k + 1], x.min())
            total[k + 2] = max(total[k + 2], x.max())
    total[0] /= POINTS
    total[3] /= POINTS
    return total


@njit(fastmath={"reassoc", "contract", "arcp", "nsz"}, error_model="numpy")
def loop(s, c, t):
    e_sum, e_min, e_max = 0.0, np.inf, -np.inf
    l_sum, l_min, l_max = 0.0, np.inf, -np.inf
    for w_s in s:
        for w_c in c:
            w_r = w_c + (w_s - w_c) / I0
            relative = w_s - w_c
            for t_s in t:
                factor = ETA if t_s * relative > 0.0 else 1.0 / ETA
                t_r = -I0 * factor * t_s
                t_c = -(t_s + t_r)
                p_s, p_r, p_c = t_s * w_s, t_r * w_r, t_c * w_c
                power_in = max(p_s, 0.0) + max(p_r, 0.0) + max(p_c, 0.0)
                loss = p_s + p_r + p_c
                efficiency = (power_in - loss) / power_in
                e_sum += efficiency
                e_min = min(e_min, efficiency)
                e_max = max(e_max, efficiency)
                l_sum += loss
                l_min = min(l_min, loss)
                l_max = max(l_max, loss)
    n = s.size * c.size * t.size
    return [e_sum / n, e_min, e_max, l_sum / n, l_min, l_max]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    args = parser.parse_args()
    axes = [np.linspace(*a) for a in AXES]
    names = [f"{q}_{what}" for q in ("efficiency", "loss_w") for what in ("mean", "least", "most")]
    entries = []
    for peer, run in (
        ("numpy-whole-array", numpy_whole),
        ("numpy-blocked", numpy_blocked),
        ("numba-fused", lambda: loop(*axes)),
    ):
        seconds, result = best(run, args.runs)
        entries.append(line("study-map", peer, POINTS, seconds, {n: float(x) for n, x in zip(names, result)}))
        show(entries[-1], args.json)
    check(entries, 1e-9)


if __name__ == "__main__":
    main()
