"""Examples in docstrings run, and everything public has one."""

from __future__ import annotations

import doctest
import importlib
import inspect
import warnings
from pathlib import Path

import pytest
import willis

ROOT = Path(__file__).parents[3]
MODULES = ["", "._answer", "._compiled", "._exercise", "._on", "._quantity", "._questions", "._record", "._table", "._train"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    warnings.simplefilter("ignore", willis.TrainWarning)
    failed, _ = doctest.testmod(importlib.import_module("willis" + name), extraglobs={"willis": willis})
    assert failed == 0


def test_every_question_has_an_example() -> None:
    functions = [willis.new, willis.laws, willis.validate, willis.explain]
    methods = [v for k, v in vars(willis.Train.__mro__[1]).items() if callable(v) and not k.startswith("_")]
    for question in functions + methods:
        assert ">>>" in (question.__doc__ or ""), question.__name__


def test_everything_public_is_told() -> None:
    for name in willis.__all__:
        thing = getattr(willis, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"
