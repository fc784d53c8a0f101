"""What a type checker makes of a program that uses the package: checked, not run."""

import numpy as np
import willis
from numpy.typing import NDArray

train: willis.Train = willis.read("zf-8hp70.toml")
a = train.analyze(state="3")
efficiency: float | None = a.efficiency
torque: float | None = a.operations[0].solutions[0].members["output"].torque
verdict: str = a.ratios["3"].drive.verdict
compiled: willis.CompiledTrain = train.compile("3")
eta: NDArray[np.float64] = compiled.efficiency(speed=[1.0, 2.0], torque=np.ones(2))
points = train.sweep(over={"input.speed": "500..6000 rpm:100"}, hold="power")
frame = points.to_polars()
run = train.simulate("1 to 2", from_="1 s", to=2.0)
rows: int = len(run)
svg: str = train.draw("lever", state="3", theme="dark").svg
steps: int = train.simulate("1 to 2").steps
other: willis.Train = train.with_(**{"P1.sun.teeth": 23})
comparison = train.compare(other)
