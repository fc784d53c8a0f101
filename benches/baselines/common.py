"""What the baselines share: reproducible inputs, timing, report lines, agreement check.

Import it before numpy: it limits the libraries below numpy to one thread.
"""

import json
import math
import os
import time

for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[_name] = "1"

import numba
import numpy as np

SEED = 88172645463325252
SHORTEST = 0.02
VERSIONS = {"numpy": f"numpy {np.__version__}", "numba": f"numba {numba.__version__}"}


@numba.njit
def _xorshift64(out, state):
    for i in range(out.size):
        state ^= state << np.uint64(13)
        state ^= state >> np.uint64(7)
        state ^= state << np.uint64(17)
        out[i] = (state >> np.uint64(11)) * 2.0**-53


def inputs(points, *ranges):
    """An array of offset + u*span per (offset, span); u drawn point by point.

    The scaling is left to numpy, which rounds after the product and again after the
    sum; a compiled loop might fuse the two and lose the last bit.
    """
    u = np.empty((points, len(ranges)))
    _xorshift64(u.reshape(-1), np.uint64(SEED))
    return [u[:, i] * span + offset for i, (offset, span) in enumerate(ranges)]


def best(run, runs):
    """Least process CPU seconds of a call of `run`, and its result.

    Each of the `runs` measurements repeats calls shorter than SHORTEST that long.
    """
    run()
    start = time.process_time()
    run()
    repeats = math.ceil(SHORTEST / max(time.process_time() - start, 1e-7))
    least = math.inf
    for _ in range(runs):
        result = None  # freed before the clock starts
        start = time.process_time()
        for _ in range(repeats):
            result = run()
        least = min(least, (time.process_time() - start) / repeats)
    return least, result


def line(task, peer, points, seconds, checksum):
    """One measurement, as printed."""
    return {
        "task": task,
        "peer": peer,
        "points": points,
        "points_per_s": points / seconds,
        "checksum": checksum,
        "version": VERSIONS[peer.split("-")[0]],
    }


def show(entry, as_json):
    """Prints a measurement, as JSON or to be read."""
    if as_json:
        print(json.dumps(entry), flush=True)
    else:
        rate = f"{entry['points_per_s'] / 1e6:10.4f} Mpt/s"
        print(f"{entry['task']:18}{entry['peer']:22}{rate}", flush=True)


def check(entries, tolerance=1e-12):
    """Ends the program if measurements of one problem disagree in their checksums."""
    seen = {}
    for entry in entries:
        for key, value in entry["checksum"].items():
            first = seen.setdefault(key, value)
            if not np.allclose(value, first, rtol=tolerance, atol=0.0):
                where = f"{entry['task']}, {entry['peer']}"
                raise SystemExit(f"{where}: {key} is {value!r}, not {first!r}")
