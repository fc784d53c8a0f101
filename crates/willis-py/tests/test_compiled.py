"""Compiled trains: the numbers of an analysis, over arrays of any kind."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
import willis
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp


def test_every_gear_is_that_of_the_analysis(automatic: willis.Train) -> None:
    rows = automatic.analyze().ratios
    for state in automatic.states:
        compiled = automatic.compile(state)
        assert compiled.is_certified
        w = np.array([100.0, 250.0])
        assert np.allclose(compiled.efficiency(speed=w, torque=80.0), rows[state].drive.efficiency, rtol=1e-12)
        # A load of the other sign drives from the output.
        assert np.allclose(compiled.efficiency(w, -80.0), rows[state].coast.efficiency, rtol=1e-12)


def test_results_balance(automatic: willis.Train) -> None:
    compiled = automatic.compile("3")
    w, tau = np.linspace(50, 600, 7)[:, None], np.linspace(-200, 200, 5)
    found = compiled.evaluate(w, tau, outputs=["loss", "output.torque", "output.speed", "input.torque"])
    assert found["loss"].shape == (7, 5)
    power = tau * w + found["output.torque"] * found["output.speed"]
    assert np.allclose(power, found["loss"], atol=1e-9)
    assert np.all(found["loss"] >= 0)


def test_threads_and_blocks_change_no_bit(automatic: willis.Train) -> None:
    n = 400_001
    w, tau = np.linspace(10, 700, n), np.linspace(-300, 300, n)
    one, many = automatic.compile("5", threads=1), automatic.compile("5", threads=7)
    a, b = one.evaluate(w, tau, outputs=["efficiency", "loss"]), many.evaluate(w, tau, outputs=["efficiency", "loss"])
    assert all(np.array_equal(a[k], b[k]) for k in a)
    constant = one.efficiency(w, 100.0)
    assert np.array_equal(constant, one.efficiency(w, np.full(n, 100.0)))
    assert np.array_equal(constant[:5], one.efficiency(w[:5], 100.0))
    assert one.mean(w, 100.0)["efficiency"] == pytest.approx(constant.mean(), rel=1e-12)


def test_single_precision_is_that_of_double(automatic: willis.Train) -> None:
    compiled = automatic.compile(state="3")
    torque = np.linspace(-300, 300, 5001)
    for threads in (1, 3):
        compiled.threads = threads
        for outputs in ("efficiency", ["loss", "efficiency", "output.torque", "input.torque"]):
            double = compiled.evaluate(speed=150.0, torque=torque, outputs=outputs)
            single = compiled.evaluate(speed=150.0, torque=torque, outputs=outputs, dtype=np.float32)
            for name, x in double.items():
                assert single[name].dtype == np.float32
                assert np.array_equal(x.astype(np.float32), single[name], equal_nan=True)
    with pytest.raises(TypeError, match="float64 or float32"):
        compiled.evaluate(150.0, torque, dtype="int32")


def test_two_freedoms_by_names(examples) -> None:  # type: ignore[no-untyped-def]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        split = willis.read(examples / "prius-p112.toml")
    compiled = split.compile(speeds=["engine", "ring"], torques=["engine"])
    assert compiled.speeds == ["engine", "ring"]
    by_name = compiled.evaluate(speed_engine=200.0, speed_ring=100.0, torque=80.0, outputs="ring.torque")
    assert by_name["ring.torque"].shape == ()
    with pytest.raises(TypeError, match="speed_ring"):
        compiled.efficiency(speed_engine=200.0, torque=80.0)
    with pytest.raises(TypeError, match="none of what is prescribed"):
        compiled.efficiency(speed_sun=200.0, speed_ring=1.0, torque=80.0)


def test_what_has_not_one_answer_is_told(examples) -> None:  # type: ignore[no-untyped-def]
    # Several equilibria, as the analysis says.
    several = willis.read(examples / "two-efficiencies.toml").compile()
    with pytest.warns(willis.TrainWarning, match="1 of 1 points do not have exactly one answer"):
        several.efficiency(100.0, 100.0)
    # Under a torque at its input a train that locks backwards may burn what both ends put in.
    locks = willis.read(examples / "wolfrom-498-self-locking.toml")
    with pytest.warns(willis.TrainWarning, match="2 of 2 points"):
        found = locks.compile().efficiency(100.0, [1.0, -1.0])
    assert np.isnan(found[1])
    # Under a torque at its output there is one answer: that of the shift table.
    loaded = locks.compile(torques=["ring"])
    found = loaded.efficiency(100.0, -50.0)
    assert loaded.odd == 0 and found == pytest.approx(locks.analyze().state().drive.efficiency, rel=1e-12)


def test_arrays_of_every_kind(automatic: willis.Train) -> None:
    compiled = automatic.compile("3")
    expected = compiled.efficiency([100.0, 200.0, 300.0], 50.0)
    base = np.array([100, 200, 300])
    for kind in (base, base.astype(np.int16), base.astype(np.float32), base.astype(object), base[::-1][::-1]):
        assert np.array_equal(compiled.efficiency(kind, 50), expected)
    frozen = base.astype(float)
    frozen.flags.writeable = False
    assert np.array_equal(compiled.efficiency(frozen, 50), expected)
    strided = np.repeat(base.astype(float), 2)[::2]
    assert np.array_equal(compiled.efficiency(strided, 50), expected)
    assert np.array_equal(compiled.efficiency(np.asfortranarray(base.reshape(3, 1)), 50), expected[:, None])
    assert compiled.efficiency(np.empty((0, 3)), 50.0).shape == (0, 3)
    assert np.isnan(compiled.efficiency(np.nan, 50.0))
    assert pickle.loads(pickle.dumps(compiled)).efficiency(100, 50) == expected[0]


@pytest.mark.parametrize("bad", ["fast", [1, "x"], [None], [{}], [10**400], np.array(["a"]), [1 + 2j]])
def test_what_is_no_number_is_refused(automatic: willis.Train, bad: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises((TypeError, ValueError)):
            automatic.compile("3").efficiency(bad, 50.0)


def test_shapes_that_do_not_fit_are_refused(automatic: willis.Train) -> None:
    with pytest.raises(ValueError):
        automatic.compile("3").efficiency(np.ones(3), np.ones(4))
    with pytest.raises(TypeError, match="missing"):
        automatic.compile("3").efficiency(np.ones(3))
    with pytest.raises(ValueError, match="is no result"):
        automatic.compile("3").evaluate(1.0, 1.0, outputs="heat")


@settings(max_examples=60, deadline=None)
@given(
    hnp.arrays(
        st.sampled_from([np.float64, np.float32, np.int64, np.int8, np.uint16]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
    ),
    st.floats(allow_nan=True, allow_infinity=True),
)
def test_any_numbers_give_an_answer(speeds: np.ndarray, torque: float) -> None:
    train = willis.simple("P", sun=30, ring=70, mesh_efficiency=0.99)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        found = train.compile().efficiency(speeds, torque)
    assert found.shape == speeds.shape
    finite = np.isfinite(np.asarray(speeds, dtype=float)) & np.isfinite(torque)
    known = found[finite]
    assert np.all(np.isnan(known) | ((known >= 0) & (known <= 1)))
