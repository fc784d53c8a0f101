"""Work on engines of others: the bytes of one machine."""

from __future__ import annotations

import os
import signal
import tempfile
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
import willis
from conftest import EXAMPLES
from willis import _on

OVER = {"input.speed": "500..6000 rpm:40", "input.torque": "10..400 N m:50"}


def parts_of_one_machine(train: willis.Train, shards: int, form: str) -> list[bytes]:
    words = _on._words([f"{k}={v}" for k, v in OVER.items()], {"state": "3"})
    return [_on.shard(train._core.parts(), words, k, shards, form) for k in range(1, shards + 1)]


@pytest.mark.parametrize("form", ["parquet", "csv"])
def test_processes_make_the_bytes_of_one(automatic: willis.Train, tmp_path: Path, form: str) -> None:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        parts = willis.on(pool).sweep(automatic, over=OVER, state="3", shards=3, path=tmp_path / "out", form=form)
    assert parts.is_whole
    assert [Path(f).read_bytes() for f in parts.files] == parts_of_one_machine(automatic, 3, form)


@pytest.mark.parametrize("shards", [1, 3, 1000])
def test_an_uncertainty_in_shards_is_that_of_one_machine(examples: Path, shards: int) -> None:
    stage = willis.read(examples / "fva-planetary-stage.toml")
    request = {"vary": ["oil.temperature=60..80 degC", "P1.geometry.roughness=+-20%"], "laws": "mesh_friction", "samples": 128}
    with ThreadPoolExecutor(2) as pool:
        answer = willis.on(pool).uncertainty(stage, shards=shards, **request)
    alone = stage.uncertainty(**request)
    assert answer == alone and answer.tables == alone.tables and answer.request == alone.request


def test_processes_find_an_uncertainty_and_tell_what_is_wrong(automatic: willis.Train) -> None:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        on = willis.on(pool)
        assert on.uncertainty(automatic, state="3", samples=128) == automatic.uncertainty(state="3", samples=128)
        with pytest.raises(willis.TrainError, match="no state `33`"):
            on.uncertainty(automatic, state="33")
        with pytest.raises(willis.TrainError, match="unknown field `speed`"):
            on.uncertainty(automatic, speed=3)
        with pytest.raises(ValueError, match="0 shards"):
            on.uncertainty(automatic, shards=0)


def test_what_is_there_is_kept(automatic: willis.Train, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with ThreadPoolExecutor(2) as pool:
        first = willis.on(pool).sweep(automatic, over=OVER, state="3", shards=4, path=out)
        Path(first.files[2]).unlink()
        before = os.stat(first.files[0]).st_mtime_ns
        told: list[tuple[int, int]] = []
        again = willis.on(pool).sweep(
            automatic, over=OVER, state="3", shards=4, path=out, progress=lambda *now: told.append(now)
        )
    assert again.files == first.files and told == [(4, 4)]
    assert os.stat(first.files[0]).st_mtime_ns == before


def test_shards_of_another_sweep_are_not_taken(automatic: willis.Train, tmp_path: Path) -> None:
    out = tmp_path / "out"
    other = automatic.with_(**{"P1.sun.teeth": 46})
    with ThreadPoolExecutor(1) as pool:
        willis.on(pool).sweep(automatic, over=OVER, state="3", shards=2, path=out)
        for train, request in ((other, {"state": "3"}), (automatic, {"state": "4"})):
            with pytest.raises(FileExistsError, match="another sweep"):
                willis.on(pool).sweep(train, over=OVER, shards=2, path=out, **request)
        (out / "sweep.json").unlink()
        with pytest.raises(FileExistsError, match="of which sweep"):
            willis.on(pool).sweep(automatic, over=OVER, state="3", shards=2, path=out)


def test_a_wrong_request_is_told(automatic: willis.Train, tmp_path: Path) -> None:
    with ThreadPoolExecutor(1) as pool, pytest.raises(willis.TrainError, match="no state `33`"):
        willis.on(pool).sweep(automatic, over=OVER, state="33", shards=2, path=tmp_path / "out")
    with ThreadPoolExecutor(1) as pool, pytest.raises(TypeError, match="no `speed`"):
        willis.on(pool).sweep(automatic, over=OVER, speed=3, shards=2, path=tmp_path / "out")
    with pytest.raises(TypeError, match="no engine"):
        willis.on(3)


def test_a_lost_pool_leaves_names(automatic: willis.Train, tmp_path: Path) -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        pool.submit(os.getpid).result()
        pool.submit(os.kill, os.getpid(), 0).result()
        process = next(iter(pool._processes.values()))
        os.kill(process.pid, signal.SIGKILL)
        parts = willis.on(pool, tries=2).sweep(automatic, over=OVER, state="3", shards=2, path=tmp_path / "out")
    assert set(parts.unfinished) | {k + 1 for k in range(len(parts.files))} == {1, 2}
    assert not list((tmp_path / "out").glob("*.part"))


def test_dask_survives_a_killed_worker(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    train = willis.read(EXAMPLES / "zf-8hp70.toml")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:
        client.wait_for_workers(2)
        killed: list[int] = []

        def kill(done: int, of: int) -> None:
            if not killed:
                pids = client.run(os.getpid)
                killed.append(next(iter(pids.values())))
                os.kill(killed[0], signal.SIGKILL)

        parts = willis.on(client).sweep(train, over=OVER, state="3", shards=8, path=tmp_path / "out", progress=kill)
    assert killed and parts.is_whole
    assert [Path(f).read_bytes() for f in parts.files] == parts_of_one_machine(train, 8, "parquet")


def test_ray_makes_the_bytes_of_one(automatic: willis.Train, tmp_path: Path) -> None:
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        parts = willis.on(ray).sweep(automatic, over=OVER, state="3", shards=3, path=tmp_path / "out")
    finally:
        ray.shutdown()
    assert [Path(f).read_bytes() for f in parts.files] == parts_of_one_machine(automatic, 3, "parquet")


def test_a_worker_writes_nothing_outside_its_folder(
    automatic: willis.Train, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, text, _, *rest = automatic._core.parts()
    files = {"beside.csv": "x\n1\n", "../above.csv": "x\n1\n", "../../sub/far.csv": "x\n1\n"}
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    words = [w for k, v in OVER.items() for w in ("--over", f"{k}={v}")]
    assert _on.shard((name, text, files, *rest), [*words, "--state", "3"], 1, 2, "csv")
    assert list(tmp_path.iterdir()) == []


def test_many_trains(automatic: willis.Train) -> None:
    trains = [automatic.with_(**{"P1.sun.teeth": z}) for z in (44, 46, 48)]
    with ThreadPoolExecutor(2) as pool:
        found = list(willis.on(pool).ask("analyze", trains, state="3"))
    assert found == [t.analyze(state="3") for t in trains]
