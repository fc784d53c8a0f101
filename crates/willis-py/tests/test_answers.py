"""Answers are those of the command, as data."""

from __future__ import annotations

import copy
import importlib.util
import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import willis
from conftest import EXAMPLES

ALL = sorted(EXAMPLES.glob("*.toml"))


def command(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "willis", *map(str, words)], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("path", ALL, ids=lambda p: p.stem)
def test_every_example_has_the_bytes_of_the_command(path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        train = willis.read(path)
        answer = train.analyze()
    told = command("analyze", path, "--format", "json")
    assert told.returncode == 0, told.stderr
    assert answer.json() == told.stdout
    assert pickle.loads(pickle.dumps(train)) == train


def test_answers_are_objects(wolfrom: willis.Train) -> None:
    a = wolfrom.analyze(operation="3000 rpm, 50 N m")
    assert a.efficiency == a["operations"][0]["solutions"][0]["efficiency"]
    assert a.members["sun"].torque == a.members.sun["torque_n_m"]
    assert a.verdict == "unique"
    assert sum(a.members[m].power for m in a.members) == pytest.approx(a.solution().loss, rel=1e-9)
    assert dict(a.members).keys() == set(a.members)
    with pytest.raises(AttributeError, match="did you mean torque"):
        _ = a.members.sun.torqe
    with pytest.raises(AttributeError):
        a.members.sun.torque = 3.0
    assert "members" in dir(a) and "torque" in dir(a.members.sun)


def test_an_analysis_of_several_operations_says_which(wolfrom: willis.Train) -> None:
    a = wolfrom.analyze()
    with pytest.raises(willis.TrainError, match="back-driven"):
        _ = a.members
    assert a.operation("back-driven by 50 N m").verdict == "unique"


def test_a_locked_train_is_an_answer(examples: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        a = willis.read(examples / "wolfrom-498-self-locking.toml").analyze()
    assert "locked" in {a.ratios[s].coast.verdict for s in a.ratios}


def test_answers_pickle_copy_and_compare(automatic: willis.Train) -> None:
    for answer in (automatic.analyze(), automatic.sweep(over={"state": "all"}), automatic.draw("stick", state="3")):
        again = pickle.loads(pickle.dumps(answer))
        assert again == answer and type(again) is type(answer)
        assert again.text == answer.text
        assert again.tables == answer.tables
        assert copy.deepcopy(answer) == answer
    drawing = pickle.loads(pickle.dumps(automatic.draw("stick", state="3")))
    assert drawing.svg == automatic.draw("stick", state="3").svg


def test_errors_have_their_place() -> None:
    with pytest.raises(willis.TrainError) as caught:
        willis.Train("format = 1\nname = 3\nmembers = []\n", "mine.toml")
    first = next(d for d in caught.value.diagnostics if d.line == 2)
    assert (first.file, first.line, first.column, first.severity) == ("mine.toml", 2, 8, "error")
    assert "2 | name = 3" in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.diagnostics == caught.value.diagnostics


def test_an_unknown_state_is_told_with_those_there_are(automatic: willis.Train) -> None:
    with pytest.raises(willis.TrainError, match="the train has no state `33`") as caught:
        automatic.analyze(state="33")
    assert caught.value.diagnostics[0].fix == "3"


def test_warnings_go_through_warnings(examples: Path) -> None:
    text = (examples / "zf-8hp70.toml").read_text()
    train = willis.Train(text)
    assert all(w.severity in ("warning", "note") for w in train.warnings)


def test_values_change_in_another_train(automatic: willis.Train) -> None:
    other = automatic.with_(**{"P1.sun.teeth": 46})
    assert (other["P1.sun.teeth"], automatic["P1.sun.teeth"]) == (46, 48)
    assert other != automatic and other.analyze(state="3").ratio != automatic.analyze(state="3").ratio
    assert hash(automatic) == hash(pickle.loads(pickle.dumps(automatic)))
    with pytest.raises(willis.TrainError, match="tooth"):
        automatic.with_(**{"P1.sun.tooth": 3})


def test_questions_take_numbers_texts_and_mappings(automatic: willis.Train, examples: Path) -> None:
    torque = np.array([100.0, 200.0])
    sweep = automatic.sweep(over={"input.speed": "500..6000 rpm:5", "input.torque": torque}, state=3)
    assert len(sweep) == 10
    assert np.allclose(np.unique(sweep["input.torque"]), torque)
    table = automatic.table(speed=100.0)
    assert table == automatic.table(speed="100 rad/s")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        split = willis.read(examples / "prius-p112.toml")
    located = split.locate(speeds={"engine": 200.0, "ring": 100.0}, torques={"engine": 80.0})
    assert located == split.locate(speeds=["engine=200 rad/s", "ring=100 rad/s"], torques=["engine=80 N m"])


def test_a_simulation_gives_arrays_and_events(examples: Path) -> None:
    run = willis.read(examples / "launch.toml").simulate(samples=11)
    assert np.all(np.diff(run["time_s"]) >= 0)
    assert np.array_equal(run["wheels.speed"], run["wheels.speed_rad_s"])
    assert run.events[0].cause == "start"
    assert run.energy is not None


def test_pictures_and_reports(automatic: willis.Train, tmp_path: Path) -> None:
    lever = automatic.draw("lever", state="3")
    assert lever.svg.startswith("<svg") and "<svg" in lever._repr_html_()
    path = lever.save(tmp_path / "lever.png")
    assert path.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(FileExistsError):
        lever.save(path)
    report = automatic.report()
    assert report.save(tmp_path / "r.html").read_text().startswith("<!DOCTYPE html>")
    with pytest.raises(ValueError, match="no form 'docx'"):
        report.save(tmp_path / "r.docx")
    assert "<table" in automatic.analyze()._repr_html_() and "<svg" in automatic.analyze()._repr_html_()


def test_formulas_are_expressions(automatic: willis.Train) -> None:
    sympy = pytest.importorskip("sympy")
    expression = automatic.formula(state="3").sympy()
    assert isinstance(expression, sympy.Expr)
    # Without loss everything comes through, whatever the ratios.
    lossless = {s: 1 for s in expression.free_symbols if s.name.startswith("eta_")}
    assert sympy.simplify(expression.subs(lossless)) == 1


def test_questions_of_no_train() -> None:
    assert "mesh_friction" in willis.laws().text
    assert willis.explain("E207").data.format == "willis-codes-1"
    train = willis.Train(next(iter(willis.new("set").files("toml").values())).decode())
    assert train.analyze().ratio


def test_the_simple_set() -> None:
    train = willis.simple("P1", sun=30, ring=70, mesh_efficiency=0.99)
    assert train.analyze().ratio == pytest.approx(10 / 3)
    assert willis.simple("P", sun=30, ring=70, held="carrier").analyze().ratio == pytest.approx(-7 / 3)
    with pytest.raises(ValueError, match="held is one of"):
        willis.simple("P", sun=30, ring=70, held="planet")


def test_the_command_is_there(examples: Path, tmp_path: Path) -> None:
    told = command("--version")
    assert told.returncode == 0 and willis.__version__ in told.stdout
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("format = 1\n")
    told = command("check", wrong)
    assert told.returncode == 1 and "E005" in told.stderr
    assert command("anlyze", examples / "zf-8hp70.toml").returncode == 2


def test_a_profile_is_a_path_or_a_table(examples: Path) -> None:
    train = willis.read(examples / "zf-8hp70.toml")
    path = examples / "cycle-8hp70.csv"
    by_path = train.cycle(profile=path)
    assert by_path.data.format == "willis-cycle-1"
    polars = pytest.importorskip("polars")
    by_table = train.cycle(profile=polars.read_csv(path, infer_schema_length=0, comment_prefix="#"))
    # Comments have no place in a table: the lines of the file are other ones.
    assert by_path.tables["cycle"] == by_table.tables["cycle"]


def test_text_in_a_notebook_keeps_its_columns(automatic: willis.Train) -> None:
    shown = automatic.check()._repr_html_()
    assert "font-family:monospace" in shown and "white-space:pre" in shown


def test_a_bar_needs_no_widgets_and_says_nothing_of_them(
    automatic: willis.Train, monkeypatch: pytest.MonkeyPatch, recwarn: pytest.WarningsRecorder
) -> None:
    pytest.importorskip("tqdm")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    automatic.sweep(over={"input.speed": "500..6000 rpm:20"}, state="3", progress=True)
    assert not [w for w in recwarn if "IProgress" in str(w.message)]
