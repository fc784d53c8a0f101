"""Tables: for every program that reads Arrow."""

from __future__ import annotations

import gc
import pickle

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
