"""Naive searches for tooth numbers, beside `cargo bench -p willis-synthesis --bench teeth`: every candidate is computed.

python design.py [--json]

3K drive: sun, both steps of the planets from 12 to 120, 3 to 6 planets, ratio of either sign within 0.995 % of 100, planets that
assemble and clear. 8HP: four sets with suns 20 to 72, planets of at least 15, rings to 120, nine ratios within 1 %; quadruples of
distinct basic ratios, of which one of the second set is tried: the whole would take an hour.
"""

import json
import math
import sys
import time

import numpy as np

LOW, HIGH = 12, 120
RATIO, WITHIN = 100.0, 0.00995
NINE = [4.6957, 3.1304, 2.1039, 1.6667, 1.2845, 1.0, 0.8392, 0.6667, -3.2968]


def wolfrom():
    """Designs, train and number of planets, among all candidates."""
    teeth = np.arange(LOW, HIGH + 1)
    p1, p2 = teeth[:, None], teeth[None, :]
    common = np.gcd(p1, p2)
    found = 0
    for s in teeth:
        r1, r2 = s + 2 * p1, s + p1 + p2
        across = p1 * r2 - r1 * p2
        with np.errstate(divide="ignore"):
            ratio = (1 + r1 / s) * (p1 * r2) / across
        near = np.abs(np.abs(ratio) - RATIO) <= WITHIN * RATIO
        for planets in range(3, 7):
            assembles = ((s + r1) % planets == 0) & (across % (planets * common) == 0)
            clears = (s + p1) * math.sin(math.pi / planets) > np.maximum(p1, p2) + 2
            found += int(np.count_nonzero(near & assembles & clears))
    return found, 4 * len(teeth) ** 3


def basic_ratios():
    """Basic ratios of the sets that can be built, ascending."""
    found = set()
    for sun in range(20, 73):
        for planet in range(15, 121):
            ring = sun + 2 * planet
            if ring > 120:
                break
            for planets in (3, 4, 5):
                if (sun + ring) % planets == 0 and (sun + planet) * math.sin(math.pi / planets) > planet + 2.5:
                    found.add(ring / sun)
    return np.array(sorted(found))


def eight_speeds():
    """Quadruples with the nine ratios whose second set has the basic ratio of the transmission that is built, 2."""
    k = basic_ratios()
    k3, k4 = k[:, None], k[None, :]
    chosen = k[np.abs(k - 2) < 1e-9]
    found = 0
    for k2 in chosen:
        eight = k2 / (1 + k2)
        for k1 in k:
            ratios = [
                1 + k4,
                (1 + k4) * eight,
                (1 + k4) * (1 + k1) / (1 + k1 + k4),
                (1 + k1 + k2) / (1 + k2),
                ((1 + k1) * (1 + k4) / k4 + k2 * (1 + k3)) / (1 + k2 + k2 * k3 + (1 + k1) / k4),
                1.0,
                (1 + k3) / (k3 + 1 / eight),
                eight,
                eight * (1 - k3 * k4),
            ]
            near = np.ones((len(k), len(k)), dtype=bool)
            for ratio, wanted in zip(ratios, NINE):
                near &= np.abs(ratio / wanted - 1) <= 0.01
            found += int(np.count_nonzero(near))
    return found, len(chosen) * len(k) ** 3, len(k)


def timed(job):
    start = time.perf_counter()
    result = job()
    return time.perf_counter() - start, result


def main():
    seconds, (found, candidates) = timed(wolfrom)
    rows = [{"task": "wolfrom-count", "peer": "numpy-whole-array", "seconds": seconds, "found": found, "candidates": candidates}]
    seconds, (found, candidates, ratios) = timed(eight_speeds)
    whole = seconds * ratios**4 / candidates
    rows.append({"task": "8hp-quadruples-part", "peer": "numpy-whole-array", "seconds": seconds, "found": found,
                 "candidates": candidates, "seconds_for_all": whole})
    for row in rows:
        if "--json" in sys.argv:
            print(json.dumps(row))
        else:
            print(", ".join(f"{k}: {v:.4g}" if isinstance(v, float) else f"{k}: {v}" for k, v in row.items()))


if __name__ == "__main__":
    main()
