"""Baseline: motion of a planetary set with a slipping ring brake, in scipy.

    python motion.py [--runs 5] [--json]

Sun 30, ring 70, mesh efficiencies 0.985 and 0.99; inertias of sun, ring and carrier
0.05, 0.2 and 0.4 kg m^2. The brake holds the ring with up to 400 N m; the carrier turns in
a bearing of 0.5 N m and 3 N m s/rad. The sun is driven by 60 + 200 sin(4 pi t) N m for 20 s
and starts at 100 rad/s, the carrier at rest. One thread, process CPU time, best run, in
simulated seconds per second.

The usual practice of a script: Coulomb friction smoothed by tanh over 0.5 rad/s, the tooth
force that of the sign of the frictionless one, LSODA with rtol 1e-6, atol 1e-8 and steps of
at most 0.05 s.

  scipy-lsoda         right-hand side in Python
  scipy-lsoda-numba   right-hand side compiled

The program fails unless the carrier ends within 1e-4 of this model's 13.179268 rad/s; at these tolerances
LSODA is 4e-5 away from it, more or less by its version. With friction that sticks it is 13.158790 rad/s, so that the smoothing costs 1.6e-3.
"""

import argparse
from math import pi, sin, tanh

from common import VERSIONS, best, check, line, show

import scipy
from numba import njit
from scipy.integrate import solve_ivp

VERSIONS["scipy"] = f"scipy {scipy.__version__}"

RHO, ETA = 70 / 30, 0.985 * 0.99
J_SUN, J_RING, J_CARRIER = 0.05, 0.2, 0.4
SMOOTH = 0.5
DURATION = 20.0
CARRIER = 13.179268


def rate(t, y):
    sun, carrier = y[0], y[1]
    ring = ((1 + RHO) * carrier - sun) / RHO
    t_sun = 60 + 200 * sin(4 * pi * t)
    t_ring = -400 * tanh(ring / SMOOTH)
    t_carrier = -3 * carrier - 0.5 * tanh(carrier / SMOOTH)
    force = t_sun / J_SUN + RHO * t_ring / J_RING - (1 + RHO) * t_carrier / J_CARRIER
    k = RHO * (ETA if force * (sun - carrier) > 0 else 1 / ETA)
    f = force / (1 / J_SUN + RHO * k / J_RING + (1 + RHO) * (1 + k) / J_CARRIER)
    return (t_sun - f) / J_SUN, (t_carrier + (1 + k) * f) / J_CARRIER


def run(function):
    solution = solve_ivp(
        function,
        (0, DURATION),
        (100.0, 0.0),
        method="LSODA",
        rtol=1e-6,
        atol=1e-8,
        max_step=0.05,
    )
    return solution.y[1, -1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    args = parser.parse_args()
    expected = {"checksum": {"carrier_smoothed": CARRIER}}
    for peer, function in [("scipy-lsoda", rate), ("scipy-lsoda-numba", njit(rate))]:
        seconds, carrier = best(lambda: run(function), args.runs)
        sums = {"carrier_smoothed": float(carrier)}
        entry = line("set-adaptive", peer, DURATION, seconds, sums)
        check([expected, entry], 1e-4)
        if args.json:
            show(entry, True)
        else:
            print(f"{entry['task']:18}{peer:22}{entry['points_per_s']:10.0f} s/s")


if __name__ == "__main__":
    main()
