"""Willis: planetary gear trains.

A train is read from a file or made from text; every question of the command ``willis`` is a method of it, and the answers
are data:

>>> import willis
>>> train = willis.read("examples/wolfrom-236.toml")
>>> a = train.analyze(operation="3000 rpm, 50 N m")
>>> round(a.efficiency, 4), round(a.members["sun"].torque, 4)
(0.5532, 0.383)

Numbers are in SI units: rad/s, N m, W, K. Texts bring their unit: ``"1500 rpm"``.
"""

from __future__ import annotations

from . import _willis
from ._answer import Analysis, Answer, Cycle, Drawing, Formula, Report, Simulation, Sweep
from ._compiled import CompiledTrain
from ._errors import Diagnostic, TrainError, TrainWarning
from ._exercise import Exercise, exercise
from ._on import On, Parts, on
from ._questions import design, explain, import_, laws, new, schemes, validate
from ._record import Record
from ._table import Table
from ._train import Train, read, simple

__version__: str = _willis.__version__

__all__ = [
    "Analysis",
    "Answer",
    "CompiledTrain",
    "Cycle",
    "Diagnostic",
    "Drawing",
    "Exercise",
    "Formula",
    "On",
    "Parts",
    "Record",
    "Report",
    "Simulation",
    "Sweep",
    "Table",
    "Train",
    "TrainError",
    "TrainWarning",
    "design",
    "exercise",
    "explain",
    "import_",
    "laws",
    "new",
    "on",
    "read",
    "schemes",
    "simple",
    "validate",
]
