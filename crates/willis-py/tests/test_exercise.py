"""Exercises: the solution on paper is the program's."""

from __future__ import annotations

import math
import warnings

import pytest
import willis


@pytest.mark.parametrize("seed", range(25))
def test_ratios(seed: int) -> None:
    e = willis.exercise("ratio", seed)
    assert e.answer["ratio"] == pytest.approx(e.train.analyze().ratio, rel=1e-12)
    assert "<svg" in e.picture and e == willis.exercise("ratio", seed)


@pytest.mark.parametrize("seed", range(25))
def test_efficiencies(seed: int) -> None:
    e = willis.exercise("efficiency", seed)
    assert e.answer["efficiency"] == pytest.approx(e.train.analyze().efficiency, rel=1e-9)


@pytest.mark.parametrize("seed", range(25))
def test_speeds(seed: int) -> None:
    import re

    e = willis.exercise("speeds", seed)
    sun, carrier = (int(x) for x in re.findall(r"at (-?\d+) rpm", e.problem))
    compiled = e.train.compile(speeds=["sun", "carrier"], torques=["sun"])
    rpm = math.tau / 60
    found = compiled.speed_of("ring", sun * rpm, carrier * rpm, 1.0) / rpm
    assert e.answer["ring_rpm"] == pytest.approx(float(found), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("seed", range(25))
def test_torques(seed: int) -> None:
    import re

    e = willis.exercise("torques", seed)
    torque = float(re.findall(r"(\d+) N m act", e.problem)[0])
    compiled = e.train.compile(speeds=["sun", "carrier"], torques=["sun"])
    found = compiled.evaluate(100.0, 30.0, torque, outputs=["ring.torque", "carrier.torque"])
    assert e.answer["ring_n_m"] == pytest.approx(float(found["ring.torque"]), rel=1e-9)
    assert e.answer["carrier_n_m"] == pytest.approx(float(found["carrier.torque"]), rel=1e-9)


@pytest.mark.parametrize("seed", range(25))
def test_sets_in_parallel(seed: int) -> None:
    e = willis.exercise("parallel", seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        assert e.answer["ratio"] == pytest.approx(e.train.analyze().ratio, rel=1e-12)
        flow = e.train.flow().data.operations[0].solutions[0]
    (link,) = (n for n in flow.nodes if n.name == "link")
    assert e.answer["share"] == pytest.approx(link.power_in_w / flow.output_power_w, rel=1e-12)


def test_an_unknown_kind_is_told() -> None:
    with pytest.raises(ValueError, match="parallel"):
        willis.exercise("heat")  # type: ignore[arg-type]
