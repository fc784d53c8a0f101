"""Whatever is asked: an answer or a clear error, and the interpreter lives on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import willis
from conftest import EXAMPLES
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

CLEAR = (willis.TrainError, TypeError, ValueError)

ASKS: list[Callable[[willis.Train], Any]] = [
    lambda t: t.draw("pie"),
    lambda t: t.analyze(operation="\n"),
    lambda t: t.analyze(state=3.5),
    lambda t: t.sweep(over={}),
    lambda t: t.sweep(over={"input.speed": []}),
    lambda t: t.sweep(over={"input.speed": [float("inf")]}),
    lambda t: t.sweep(over={"nobody.speed": [1.0]}),
    lambda t: t.sweep(over=3),
    lambda t: t.compile("zz"),
    lambda t: t.compile(speeds=["nobody"]),
    lambda t: t.compile("3", mesh_loss={"P1": {"coefficient": -1.0}}),
    lambda t: t.compile("3", drag={"input": ("a", 1)}),
    lambda t: t.export("nothing"),
    lambda t: t.export("fmu"),
    lambda t: t.simulate("x"),
    lambda t: t.cycle(profile={"a": [1, 2], "b": [1]}),
    lambda t: t.cycle(profile="/nowhere.csv"),
    lambda t: t.cycle(profile=3),
    lambda t: t.locate(speeds={"input": object()}),
    lambda t: t.formula(lang="cobol"),
    lambda t: t.with_(**{"": 1}),
    lambda t: t.with_laws(mesh_friction="nobody"),
    lambda t: t.uncertainty(samples=-1),
    lambda t: t.uncertainty(samples=10**30),
    lambda t: t.compare(),
]


@pytest.mark.parametrize("ask", ASKS, ids=range(len(ASKS)))
def test_a_wrong_question_is_told(automatic: willis.Train, ask: Callable[[willis.Train], Any]) -> None:
    with pytest.raises(CLEAR) as caught:
        ask(automatic)
    assert str(caught.value) and len(str(caught.value)) < 10_000


@pytest.mark.parametrize("path", ["/nowhere.toml", str(EXAMPLES), "/dev/zero", "", "\0"])
def test_what_is_no_file_is_told(path: str) -> None:
    with pytest.raises((*CLEAR, OSError)):
        willis.read(path)


@pytest.mark.parametrize("value", [float("nan"), float("-inf"), object(), [1, 2], None, 10**400, "x" * 100_000, {}, b"3"])
def test_what_is_no_value_is_told(automatic: willis.Train, value: object) -> None:
    with pytest.raises(CLEAR) as caught:
        automatic.with_(**{"P1.sun.teeth": value})
    assert len(str(caught.value)) < 10_000


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.text(max_size=200))
def test_any_text_is_a_train_or_an_error(text: str) -> None:
    try:
        willis.Train("format = 1\n" + text)
    except CLEAR as error:
        assert str(error)


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=20), st.text(max_size=20))
def test_any_path_and_value(path: str, value: str) -> None:
    train = willis.simple("P", sun=30, ring=70)
    try:
        train.with_({path: value})
    except CLEAR as error:
        assert str(error)
