"""Long work: progress, Ctrl-C, and what takes too long."""

from __future__ import annotations

import signal
import subprocess
import sys
import textwrap
import threading

import pytest
import willis

OVER = {"input.speed": "500..6000 rpm:200", "input.torque": "10..400 N m:200"}


def test_progress_is_told(automatic: willis.Train) -> None:
    told: list[tuple[str, int, int]] = []
    automatic.sweep(over=OVER, state="3", progress=lambda *now: told.append(now))
    assert told[-1][0] == "points" and told[-1][1] == told[-1][2] == 40_000


def test_what_progress_raises_stops_the_work(automatic: willis.Train) -> None:
    def stop(*_: object) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        automatic.sweep(over=OVER, state="3", progress=stop)


def test_threads_change_nothing(automatic: willis.Train) -> None:
    over = {"input.speed": "500..6000 rpm:20", "state": "all"}
    assert automatic.sweep(over=over, threads=1) == automatic.sweep(over=over, threads=5)


def test_ctrl_c_stops_it() -> None:
    program = textwrap.dedent(
        """
        import sys, willis
        train = willis.read("examples/fva-planetary-stage.toml")
        told = lambda what, done, of: (print("going", flush=True) if done else None)
        try:
            train.uncertainty(samples=65536, yes=True, progress=told)
        except KeyboardInterrupt:
            print("stopped", flush=True)
        """
    )
    from conftest import EXAMPLES

    running = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, cwd=EXAMPLES.parent
    )
    assert running.stdout is not None
    assert running.stdout.readline() == "going\n"
    running.send_signal(signal.SIGINT)
    out, _ = running.communicate(timeout=120)
    assert out.endswith("stopped\n")


def test_what_is_too_much_is_refused(automatic: willis.Train) -> None:
    with pytest.raises(willis.TrainError, match="too many"):
        automatic.sweep(over={"input.speed": "500..6000 rpm:100000", "input.torque": "10..400 N m:100000"}, state="3")


def test_threads_of_python_ask_at_once(automatic: willis.Train) -> None:
    expected = automatic.analyze().json()
    found: list[str] = []
    threads = [threading.Thread(target=lambda: found.append(automatic.analyze().json())) for _ in range(8)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert found == [expected] * 8
