"""Tables: for every program that reads Arrow."""

from __future__ import annotations

import csv
import gc
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import willis


@pytest.fixture
def table(automatic: willis.Train) -> willis.Table:
    return automatic.analyze().tables["states"]


def test_columns_are_arrays_of_the_table(table: willis.Table) -> None:
    ratio = table["ratio"]
    assert isinstance(ratio, np.ndarray) and not ratio.flags.writeable
    assert table["state"] == list("12345678") + ["R"]
    with pytest.raises(KeyError, match="did you mean ratio"):
        _ = table["ratoi"]
    with pytest.raises(ValueError):
        ratio[0] = 1.0


def test_an_array_outlives_its_table(automatic: willis.Train) -> None:
    ratio = automatic.analyze().tables["states"]["ratio"]
    expected = ratio.copy()
    gc.collect()
    assert np.array_equal(ratio, expected)


def test_others_take_it(table: willis.Table) -> None:
    rows = list(table.rows())
    pyarrow = pytest.importorskip("pyarrow")
    arrow = pyarrow.table(table)
    arrow.validate(full=True)
    assert arrow.to_pylist() == rows
    polars = pytest.importorskip("polars")
    assert polars.DataFrame(table).to_dicts() == rows
    for _ in range(50):
        pyarrow.table(table)
    # A stream that nobody takes is freed too.
    table.__arrow_c_stream__()


def test_pandas_and_duckdb_take_it(table: willis.Table) -> None:
    pandas = pytest.importorskip("pandas")
    frame = table.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == table.columns
    assert list(frame["state"]) == table["state"] and np.array_equal(frame["ratio"], table["ratio"])
    duckdb = pytest.importorskip("duckdb")
    states = table
    found = duckdb.sql("select state, ratio from states").fetchall()
    assert found == list(zip(table["state"], table["ratio"].tolist(), strict=True)), states


def test_units_go_along(automatic: willis.Train) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    members = automatic.analyze().tables["members"]
    field = pyarrow.table(members).schema.field("torque_n_m")
    assert field.metadata == {b"unit": b"N m"} and members.units["torque_n_m"] == "N m"


def test_an_empty_table_is_one(automatic: willis.Train) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    for table in automatic.analyze().tables.values():
        again = pickle.loads(pickle.dumps(table))
        assert again == table
        assert pyarrow.table(again).num_rows == len(table)


@pytest.mark.parametrize(
    ("file", "words", "asked"),
    [
        (
            "fva-planetary-stage.toml",
            ["sweep", "--over", "sun.speed=500..1500 rpm:3", "--over", "oil.temperature=40, 80 degC", "--columns", "all"],
            lambda t: t.sweep(over={"sun.speed": "500..1500 rpm:3", "oil.temperature": "40, 80 degC"}, columns="all"),
        ),
        (
            "prius-hybrid.toml",
            ["sweep", "--over", "ratio=0.5..2:4", "--columns", "all,variators"],
            lambda t: t.sweep(over={"ratio": "0.5..2:4"}, columns=["all", "variators"]),
        ),
        ("launch.toml", ["simulate", "--samples", "5"], lambda t: t.simulate(samples=5)),
        ("ivt-drive-away.toml", ["simulate", "--samples", "5"], lambda t: t.simulate(samples=5)),
    ],
)
def test_columns_have_one_name_in_csv_parquet_and_python(
    examples: Path, tmp_path: Path, file: str, words: list[str], asked: Callable[[willis.Train], willis.Answer]
) -> None:
    pyarrow = pytest.importorskip("pyarrow.parquet")
    answer = asked(willis.read(examples / file))
    table = next(t for t in answer.tables.values() if t.name in ("points", "rows"))
    question, *options = words
    names = {}
    for ending in ("csv", "parquet"):
        out = tmp_path / f"out.{ending}"
        run = [sys.executable, "-m", "willis", question, str(examples / file), *options, "-o", str(out)]
        subprocess.run(run, check=True, capture_output=True)
        names[ending] = (
            next(csv.reader(out.read_text().splitlines())) if ending == "csv" else pyarrow.read_schema(out).names
        )
    assert names["csv"] == names["parquet"] == table.columns
    # And each is found without its unit.
    for name in table.columns:
        bare = name.removesuffix("_rad_s").removesuffix("_n_m").removesuffix("_w")
        assert bare in table, bare
