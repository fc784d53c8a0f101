"""What a sweep in shards costs, and what more workers bring: ``python crates/willis-py/shards.py [--points 1e8]``.

Three measurements of ``willis.on``: the time of a shard of one point, which is what a shard costs whatever is in it; the same
sweep with one worker and with two; and, where ``--points`` asks for more, a sweep of that size. From them follows what many
cores would take, as far as shards are independent: they are, but for the files that one process writes.
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import willis

#: Points of the comparison of one worker with two.
POINTS = 4_000_000


def over(points: int) -> dict[str, str]:
    """Axes of about so many points: speeds and torques at the output of the 8HP70 in third gear."""
    side = max(1, round(points**0.5))
    return {"input.speed": f"500..6000 rpm:{side}", "output.torque": f"10..400 N m:{max(1, points // side)}"}


def run(train: willis.Train, points: int, shards: int, workers: int, keep: Path | None = None) -> tuple[float, int]:
    """Seconds of a sweep on so many processes, which are there before the clock starts, and bytes of its files."""
    folder = keep or Path(tempfile.mkdtemp())
    try:
        with ProcessPoolExecutor(workers) as pool:
            list(pool.map(pow, range(64 * workers), [1] * 64 * workers))
            # Each worker imports the package once.
            list(willis.on(pool).ask("analyze", [train] * 4 * workers))
            start = time.perf_counter()
            parts = willis.on(pool).sweep(
                train, over=over(points), path=folder, shards=shards, fast=True, state="3", hold="torque"
            )
            seconds = time.perf_counter() - start
        assert parts.is_whole, parts.unfinished
        return seconds, sum(Path(f).stat().st_size for f in parts.files)
    finally:
        if keep is None:
            shutil.rmtree(folder)


def main() -> None:
    """Prints the measurements and what follows from them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--points", type=float, default=0, help="one more sweep, of so many points")
    parser.add_argument("--shards", type=int, default=100, help="shards of that sweep")
    args = parser.parse_args()
    train = willis.read("examples/zf-8hp70.toml")
    cores = os.cpu_count() or 1

    tiny = min(run(train, 400, 400, 1)[0] / 400 for _ in range(3))
    print(f"a shard of one point            {1e3 * tiny:8.2f} ms, one worker")
    one, size = min(run(train, POINTS, 16, 1) for _ in range(3))
    two, _ = min(run(train, POINTS, 16, 2) for _ in range(3))
    point = (one - 16 * tiny) / POINTS
    print(f"{POINTS:,} points, one worker  {one:8.2f} s, {1e9 * point:.0f} ns a point, {size / POINTS:.1f} bytes a point")
    print(f"{POINTS:,} points, two workers {two:8.2f} s, {one / two:.2f} times as fast ({cores} cores)")
    if args.points:
        seconds, size = run(train, int(args.points), args.shards, cores)
        print(f"{args.points:,.0f} points in {args.shards} shards, {cores} workers: {seconds:.1f} s, {size / 1e9:.2f} GB")
    # One process takes every shard from the workers and writes it: measured with shards of one point on two workers.
    serial = min(run(train, 400, 400, 2)[0] / 400 for _ in range(3)) / 2
    for many in (1e9, 1e11):
        shards = 10_000
        spread = (many * point + shards * tiny) / 1000
        print(f"{many:.0e} points on 1,000 cores: {spread:.0f} s in the workers, at most {shards * serial:.0f} s beside them to collect")


if __name__ == "__main__":
    main()
