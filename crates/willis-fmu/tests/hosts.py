"""Units in the hands of simulators that others wrote: FMPy, libcosim and Ecos.

`WILLIS` names the program that exports them. Every number is compared with what `willis simulate` computes.
"""

import csv
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import fmpy
import numpy
import pytest
from fmpy.validation import validate_fmu

HERE = Path(__file__).parent
EXAMPLES = HERE.parents[2] / "examples"
WILLIS = os.environ["WILLIS"]

# Train file, scenario, results that are compared, and the size of each for a relative difference.
CASES = {
    "winch": (HERE / "winch.toml", "lift", ["drum.speed", "motor.speed", "r.speed", "drum.angle"]),
    "launch": (EXAMPLES / "launch.toml", "start and lift off", ["engine.speed", "wheels.speed", "side shafts.twist"]),
}


def export(folder: Path, train: Path, scenario: str, fmi: str, kind: str) -> Path:
    unit = folder / f"{train.stem}-{fmi}-{kind}.fmu"
    if not unit.exists():
        words = ["export", "fmu", train, "--scenario", scenario, "--fmi", fmi, "--kind", kind, "-o", unit]
        subprocess.run([WILLIS, *words], check=True)
    return unit


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("units")


def simulated(folder: Path, train: Path, scenario: str) -> tuple[numpy.ndarray, dict[str, numpy.ndarray]]:
    """Rows of `willis simulate`: those after a jump at the times of events."""
    rows = folder / f"{train.stem}.csv"
    if not rows.exists():
        subprocess.run(
            [WILLIS, "simulate", train, "--scenario", scenario, "-o", rows], check=True, capture_output=True
        )
    with rows.open() as file:
        lines = [line for line in file if not line.startswith("#")]
    table = list(csv.reader(lines))
    names, values = table[0], [row for row in table[1:] if len(row) == len(table[0])]
    units = ["_rad_s", "_rad", "_n_m", "_s", "_w"]
    found = {}
    for k, name in enumerate(names):
        short = next((name.removesuffix(u) for u in units if name.endswith(u)), name)
        try:
            found[short] = numpy.array([float(row[k] or "nan") for row in values])
        except ValueError:
            continue
    return found["time"], found


def difference(result, folder: Path, name: str) -> float:
    """The largest difference from `willis simulate` at its times, over the largest value."""
    train, scenario, names = CASES[name]
    times, columns = simulated(folder, train, scenario)
    # The grid of rows: an event between has two rows at its own time.
    worst = 0.0
    grid = result["time"]
    for quantity in names:
        wanted = columns[quantity]
        size = numpy.max(numpy.abs(wanted))
        found = 0
        for t, value in zip(times, wanted):
            k = int(numpy.argmin(numpy.abs(grid - t)))
            if abs(grid[k] - t) < 1e-10:
                worst = max(worst, abs(result[quantity][k] - value) / size)
                found += 1
        assert found > 20, f"{quantity}: {found} common times"
    return worst


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("kind", ["cs", "me"])
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_fmpy_validates_and_runs(folder, fmi, kind, name):
    train, scenario, names = CASES[name]
    unit = export(folder, train, scenario, fmi, kind)
    assert validate_fmu(str(unit)) == []
    times, _ = simulated(folder, train, scenario)
    interval = float(numpy.median(numpy.diff(times)))
    more = {"relative_tolerance": 1e-10} if kind == "me" else {}
    result = fmpy.simulate_fmu(str(unit), output_interval=interval, output=names, record_events=False, **more)
    worst = difference(result, folder, name)
    print(f"FMI {fmi} {kind} {name}: {worst:.1e}")
    assert worst < (1e-6 if kind == "me" else 1e-7)


def test_steps_end_early_at_events(folder):
    train, scenario, names = CASES["winch"]
    unit = export(folder, train, scenario, "3", "cs")
    times, _ = simulated(folder, train, scenario)
    interval = float(numpy.median(numpy.diff(times)))
    result = fmpy.simulate_fmu(
        str(unit), output_interval=interval, output=[*names, "event_count"], early_return_allowed=True, use_event_mode=True
    )
    assert len(result) > round(2.0 / interval) + 1, "events have rows of their own"
    assert difference(result, folder, "winch") < 1e-6


def test_parameters_are_those_of_the_file(folder):
    unit = export(folder, *CASES["winch"][:2], "2", "both")
    changed = folder / "heavier.toml"
    changed.write_text(CASES["winch"][0].read_text().replace('drum = "1.5 kg m^2"', 'drum = "2.25 kg m^2"'))
    other = export(folder, changed, "lift", "2", "both")
    runs = [
        fmpy.simulate_fmu(str(unit), fmi_type="CoSimulation", output=["drum.speed"], start_values=start)
        for start in [{"inertias.drum": 2.25}, {}]
    ]
    wanted = fmpy.simulate_fmu(str(other), fmi_type="CoSimulation", output=["drum.speed"])
    assert numpy.array_equal(runs[0]["drum.speed"], wanted["drum.speed"])
    assert not numpy.allclose(runs[1]["drum.speed"], wanted["drum.speed"])


def opened(unit: Path, folder: Path):
    """A unit in co-simulation at its start, by the functions themselves; and the references of its variables."""
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave

    description = fmpy.read_model_description(str(unit))
    at = folder / unit.stem
    if not at.exists():
        fmpy.extract(str(unit), str(at))
    of = {"guid": description.guid} if description.fmiVersion == "2.0" else {"instantiationToken": description.instantiationToken}
    kind = FMU2Slave if description.fmiVersion == "2.0" else FMU3Slave
    slave = kind(unzipDirectory=str(at), modelIdentifier=description.coSimulation.modelIdentifier, instanceName="one", **{"guid": list(of.values())[0]})
    slave.instantiate()
    return slave, {v.name: v.valueReference for v in description.modelVariables}


def began(slave, stop: float):
    if hasattr(slave, "setupExperiment"):
        slave.setupExperiment(startTime=0.0, stopTime=stop)
        slave.enterInitializationMode()
    else:
        slave.enterInitializationMode(startTime=0.0, stopTime=stop)
    slave.exitInitializationMode()


def real(slave, reference: int) -> float:
    get = getattr(slave, "getReal", None) or slave.getFloat64
    return get([reference])[0]


# Goes on in a process of its own with a state that another one left.
GO_ON = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import hosts
unit, folder, state = (Path(a) for a in sys.argv[2:])
slave, names = hosts.opened(unit, folder)
bytes_of = state.read_bytes()
handle = slave.deSerializeFMUstate(bytes_of) if hasattr(slave, "deSerializeFMUstate") else slave.deserializeFMUState(bytes_of)
(getattr(slave, "setFMUstate", None) or slave.setFMUState)(handle)
for k in range(60, 150):
    slave.doStep(currentCommunicationPoint=0.01 * k, communicationStepSize=0.01)
print(hosts.real(slave, names["drum.speed"]).hex())
"""


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_a_state_outlives_its_process(folder, fmi):
    unit = export(folder, *CASES["winch"][:2], fmi, "cs")
    slave, names = opened(unit, folder)
    began(slave, 2.0)
    state = folder / f"state-{fmi}"
    for k in range(150):
        if k == 60:
            handle = slave.getFMUstate() if fmi == "2" else slave.getFMUState()
            taken = slave.serializeFMUstate(handle) if fmi == "2" else slave.serializeFMUState(handle)
            state.write_bytes(bytes(taken))
        slave.doStep(currentCommunicationPoint=0.01 * k, communicationStepSize=0.01)
    here = real(slave, names["drum.speed"]).hex()
    slave.terminate()
    slave.freeInstance()
    words = [sys.executable, "-c", GO_ON, str(HERE), str(unit), str(folder), str(state)]
    there = subprocess.run(words, check=True, capture_output=True, text=True).stdout.strip()
    assert there == here


def test_steps_of_a_millisecond(folder):
    """How long steps of 1 ms take is printed, not judged."""
    for name, (train, scenario, names) in CASES.items():
        unit = export(folder, train, scenario, "2", "cs")
        slave, references = opened(unit, folder)
        began(slave, 1.0)
        took = []
        for k in range(1000):
            start = time.perf_counter()
            slave.doStep(currentCommunicationPoint=0.001 * k, communicationStepSize=0.001)
            took.append(time.perf_counter() - start)
        slave.terminate()
        slave.freeInstance()
        took = 1e6 * numpy.array(took)
        print(f"{name}: a step of 1 ms takes {numpy.median(took):.0f} us (median), {took.max():.0f} us at most")


def libcosim():
    return pytest.importorskip("libcosimpy.CosimExecution"), pytest.importorskip("libcosimpy.CosimSlave")


def coupled(units: dict[str, Path], wires, wanted, step: float, stop: float) -> dict[str, float]:
    """Units side by side in libcosim, and what is wanted of them at the end."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    # Times are in nanoseconds.
    execution = CosimExecution.from_step_size(step_size=round(1e9 * step))
    index, references, slaves = {}, {}, []
    for name, unit in units.items():
        slaves.append(CosimLocalSlave(fmu_path=str(unit), instance_name=name))
        index[name] = execution.add_local_slave(slaves[-1])
        variables = fmpy.read_model_description(str(unit)).modelVariables
        references[name] = {v.name: v.valueReference for v in variables}
    for (a, out), (b, into) in wires:
        wired = execution.connect_real_variables(
            output_slave_index=index[a],
            output_variable_reference=references[a][out],
            input_slave_index=index[b],
            input_variable_reference=references[b][into],
        )
        assert wired == 0
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)
    assert execution.simulate_until(target_time=round(1e9 * stop))
    values = {}
    for name, variable in wanted:
        values[variable] = observer.last_real_values(
            slave_index=index[name], variable_references=[references[name][variable]]
        )[0]
    return values


def last(folder: Path, train: Path, scenario: str, quantity: str) -> float:
    return simulated(folder, train, scenario)[1][quantity][-1]


def test_libcosim_runs_a_unit(folder):
    libcosim()
    train, scenario, _ = CASES["winch"]
    unit = export(folder, train, scenario, "2", "cs")
    found = coupled({"winch": unit}, [], [("winch", "drum.speed")], 0.01, 2.0)
    wanted = last(folder, train, scenario, "drum.speed")
    assert found["drum.speed"] == pytest.approx(wanted, rel=1e-7, abs=1e-9)


def test_two_units_share_a_shaft(folder):
    """The speed of the gearbox goes to the engine's flange, and the torque of the coupling comes back: as one train, to
    first order in the step."""
    libcosim()
    units = {name: export(folder, HERE / f"{name}.toml", "pull", "2", "cs") for name in ["engine", "gearbox"]}
    wires = [(("gearbox", "input.speed"), ("engine", "flange")), (("engine", "coupling.torque"), ("gearbox", "shaft"))]
    wanted = last(folder, HERE / "together.toml", "pull", "output.speed")
    errors = []
    for step in [1e-3, 2e-4]:
        found = coupled(units, wires, [("gearbox", "output.speed")], step, 1.0)["output.speed"]
        errors.append(abs(found - wanted) / abs(wanted))
        print(f"coupled with steps of {step} s: {found:.6f} rad/s, as one train {wanted:.6f} rad/s")
    assert errors[1] < 2e-3
    assert errors[1] < 0.5 * errors[0] or errors[0] < 1e-4


def ecos():
    """Ecos, whose library wants another one that its package does not bring: it is loaded before."""
    import ctypes

    tbb = sorted(Path(sys.prefix).glob("lib/libtbb.so.12*"))
    if tbb:
        ctypes.CDLL(str(tbb[0]), mode=ctypes.RTLD_GLOBAL)
    try:
        import ecospy
    except OSError as why:
        # Its library is built for newer systems than some on which this runs; FMPy and libcosim run the unit there too.
        pytest.skip(f"Ecos does not load here: {why}")
    return ecospy


def stepped(units: dict[str, Path], wires: list[tuple[str, str]], step: float, stop: float, wanted: str) -> float:
    """Units in Ecos, outputs wired to inputs; the last value of a variable."""
    own = ecos()
    structure = own.EcosSimulationStructure()
    for name, unit in units.items():
        structure.add_model(name, unit)
    for out, into in wires:
        structure.make_real_connection(out, into)
    with own.EcosSimulation(structure=structure, step_size=step) as simulation:
        simulation.init()
        simulation.step(round(stop / step))
        return simulation.get_real(wanted)


@pytest.mark.parametrize("fmi", ["2", "3"])
@pytest.mark.parametrize("name", CASES)
def test_ecos_runs_a_unit(folder, name, fmi):
    train, scenario, names = CASES[name]
    times, columns = simulated(folder, train, scenario)
    stop = 0.75 * float(times[-1])
    stop = float(times[int(numpy.argmin(numpy.abs(times - stop)))])
    unit = export(folder, train, scenario, fmi, "cs")
    step = stop / 500
    found = stepped({"unit": unit}, [], step, stop, f"unit::{names[0]}")
    wanted = columns[names[0]][int(numpy.argmin(numpy.abs(times - stop)))]
    size = numpy.max(numpy.abs(columns[names[0]]))
    print(f"Ecos, FMI {fmi} {name}: {abs(found - wanted) / size:.1e}")
    assert abs(found - wanted) / size < 1e-7


def test_ecos_couples_two_units(folder):
    """As `test_two_units_share_a_shaft`, in another importer."""
    units = {name: export(folder, HERE / f"{name}.toml", "pull", "2", "cs") for name in ["engine", "gearbox"]}
    wires = [("gearbox::input.speed", "engine::flange"), ("engine::coupling.torque", "gearbox::shaft")]
    wanted = last(folder, HERE / "together.toml", "pull", "output.speed")
    found = stepped(units, wires, 2e-4, 1.0, "gearbox::output.speed")
    print(f"Ecos, coupled with steps of 0.0002 s: {found:.6f} rad/s, as one train {wanted:.6f} rad/s")
    assert abs(found - wanted) / abs(wanted) < 2e-3


def test_what_is_wrong_is_told(folder):
    """A unit that was tampered with does not start, and says why."""
    unit = export(folder, *CASES["winch"][:2], "3", "cs")
    at = folder / "tampered"
    fmpy.extract(str(unit), str(at))
    train = at / "resources" / "train.toml"
    train.write_text(train.read_text().replace("0.98", "0.97"))
    told = []
    with pytest.raises(Exception):
        fmpy.simulate_fmu(str(at), logger=lambda *of: told.append(str(of[-1])), debug_logging=True)
    assert any("exported" in t for t in told), told
    shutil.rmtree(at)
    wrong = subprocess.run(
        [WILLIS, "export", "fmu", HERE / "winch.toml", "-o", folder / "x.fmu", "--library", folder / "none"],
        capture_output=True,
        text=True,
    )
    assert wrong.returncode == 1 and "none" in wrong.stderr
