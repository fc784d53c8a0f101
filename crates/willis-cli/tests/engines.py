"""Exports in other engines: an actuator is loaded and moved, and what it does is compared with the exact motion.

`WILLIS` names the program that exports. A table of deviations is printed, with `--speed` one of steps per second; the exit
status is 1 where a deviation is not what it must be.

The motion is exact by hand. With k = 1 + 4 eta where the motor drives and 1 + 4/eta where it is driven back (ring held,
teeth 20 and 80, eta = 0.97^2), the motor's torque T, its inertia J and that of the arm L:

    (L + 5 J k) dw/dt = k T        piecewise constant

`WILLIS_REXS_SCHEMA` names the XML Schema of REXS files, `rexs-file.xsd` of the repository fva-net/rexs-api-java: every example
that can be exported as REXS is then validated by it.
"""

import csv
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
WILLIS = os.environ["WILLIS"]

MOTOR, ARM, RATIO, ETA = 0.0002, 0.5, 5.0, 0.97**2
STEP = 1e-3
STEPS = 1000
TIMES = (0.5, 1.0)


def torque(t: float) -> float:
    """The motor's, at the middle of a step."""
    return 2.0 if t < 0.5 else -1.0


def exact() -> tuple[float, float]:
    """Speed of the arm, rad/s, at both times."""
    speeds, w = [], 0.0
    for t, k in [(0.25, 1 + 4 * ETA), (0.75, 1 + 4 / ETA)]:
        w += 0.5 * k * torque(t) / (ARM + RATIO * MOTOR * k)
        speeds.append(w)
    return tuple(speeds)


def exported(folder: Path, kind: str) -> Path:
    """The only file of an export."""
    at = folder / kind
    if not at.exists():
        at.mkdir()
        subprocess.run([WILLIS, "export", kind, HERE / "engines.toml", "-o", at], check=True, capture_output=True)
    (file,) = at.iterdir()
    return file


def with_arm(folder: Path) -> Path:
    """The train with the arm's inertia, which other engines have as a body."""
    file = folder / "with-arm.toml"
    text = (HERE / "engines.toml").read_text()
    file.write_text(text.replace('motor = "0.0002 kg m^2"', f'motor = "0.0002 kg m^2", arm = "{ARM} kg m^2"'))
    return file


# Each engine returns the speed of the arm at both times, and how many steps it does in a second.


def willis(folder: Path):
    file, rows = with_arm(folder), folder / "rows.csv"
    began = time.perf_counter()
    subprocess.run([WILLIS, "simulate", file, "-o", rows], check=True, capture_output=True)
    took = time.perf_counter() - began
    lines = [line for line in rows.read_text().splitlines() if not line.startswith("#")]
    table = list(csv.DictReader(lines))
    time_of, speed_of = (next(n for n in table[0] if n.startswith(p)) for p in ["time", "arm.speed"])
    speeds = [float([r for r in table if abs(float(r[time_of]) - t) < 1e-9][0][speed_of]) for t in TIMES]
    return speeds, len(table) / took


def mujoco_model(folder: Path, friction: float = 0.0):
    import mujoco

    file = exported(folder, "mujoco")
    text = file.read_text()
    name = re.search(r'<motor name="([^"]+)" joint="([^"]+)"', text)
    world = f"""<mujoco><option timestep="{STEP}" gravity="0 0 0"/>
      <include file="gear.xml"/><worldbody><body>
      <inertial pos="0 0 0" mass="1" diaginertia="{ARM} {ARM} {ARM}"/>
      <joint name="{name[2]}" class="{name[1]}" type="hinge" axis="0 0 1" frictionloss="{friction}"/>
      </body></worldbody></mujoco>"""
    return mujoco.MjModel.from_xml_string(world, {"gear.xml": file.read_bytes()}), name[1]


def mujoco(folder: Path, losses: bool, friction: float = 0.0):
    import mujoco as engine

    model, name = mujoco_model(folder, friction)
    data = engine.MjData(model)
    assert abs(model.dof_armature[0] - RATIO**2 * MOTOR) < 1e-12, "reflected inertia"
    assert abs(abs(model.actuator_gear[0][0]) - RATIO) < 1e-12, "ratio"
    average, difference = (model.numeric(f"{name}/mu_{part}").data[0] for part in ["avg", "dif"])
    speeds = []
    began = time.perf_counter()
    for k in range(STEPS):
        force = torque((k + 0.5) * STEP)
        if losses:
            # As the file says: the friction of the teeth, taken off the motor's torque. The motor's speed has the sign of
            # its torque as long as nothing has moved yet.
            velocity = RATIO * data.qvel[0]
            z = math.copysign(1.0, velocity if velocity != 0.0 else force)
            force = force - average * abs(force) * z - difference * force
        data.ctrl[0] = force
        engine.mj_step(model, data)
        if abs((k + 1) * STEP - TIMES[len(speeds)]) < 1e-9:
            speeds.append(float(data.qvel[0]))
    return speeds, STEPS / (time.perf_counter() - began)


def drake(folder: Path, losses: bool):
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.systems.analysis import Simulator

    text = exported(folder, "drake").read_text()
    of = {key: float(re.search(rf"efficiency_{key} ([0-9.eE+-]+)", text)[1]) for key in ["forward", "backward"]}
    joint = re.search(r'<joint name="([^"]+)">', text)[1]
    body = f"""<link name="base"/><link name="arm"><inertial><mass value="1"/>
      <inertia ixx="{ARM}" iyy="{ARM}" izz="{ARM}" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="{joint}" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
      <transmission>"""
    plant = MultibodyPlant(STEP)
    Parser(plant).AddModelsFromString(text.replace("<transmission>", body, 1), "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"))
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    plant.Finalize()
    context = plant.CreateDefaultContext()
    mass = plant.CalcMassMatrix(context)[0][0]
    assert abs(mass - (ARM + RATIO**2 * MOTOR)) < 1e-12, "reflected inertia"
    (index,) = plant.GetJointActuatorIndices()
    ratio = plant.get_joint_actuator(index).default_gear_ratio()
    simulator = Simulator(plant, context)
    simulator.Initialize()
    speeds, began = [], time.perf_counter()
    for k in range(STEPS):
        force = torque((k + 0.5) * STEP)
        speed = plant.GetVelocities(context)[0] * ratio
        drives = force * (speed if speed != 0.0 else force) > 0.0
        factor = 1.0 if not losses else of["forward"] if drives else 1.0 / of["backward"]
        plant.get_actuation_input_port().FixValue(context, [force * ratio * factor])
        simulator.AdvanceTo((k + 1) * STEP)
        if abs((k + 1) * STEP - TIMES[len(speeds)]) < 1e-9:
            speeds.append(float(plant.GetVelocities(context)[0]))
    return speeds, STEPS / (time.perf_counter() - began)


def unit(folder: Path) -> Path:
    file = folder / "arm.fmu"
    if not file.exists():
        words = [WILLIS, "export", "fmu", with_arm(folder), "--fmi", "2", "-o", file]
        subprocess.run(words, check=True, capture_output=True)
    return file


def fmpy_cs(folder: Path):
    import fmpy
    from fmpy.fmi2 import FMU2Slave

    file = unit(folder)
    description = fmpy.read_model_description(str(file))
    at = fmpy.extract(str(file), str(folder / "unpacked"))
    own = FMU2Slave(
        guid=description.guid,
        unzipDirectory=at,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="arm",
    )
    own.instantiate()
    own.setupExperiment(startTime=0.0)
    own.enterInitializationMode()
    own.exitInitializationMode()
    speed = next(v.valueReference for v in description.modelVariables if v.name == "arm.speed")
    speeds, began = [], time.perf_counter()
    for k in range(STEPS):
        own.doStep(currentCommunicationPoint=k * STEP, communicationStepSize=STEP)
        if abs((k + 1) * STEP - TIMES[len(speeds)]) < 1e-9:
            speeds.append(own.getReal([speed])[0])
    took = time.perf_counter() - began
    own.terminate()
    own.freeInstance()
    return speeds, STEPS / took


def fmpy_me(folder: Path):
    import fmpy

    began = time.perf_counter()
    result = fmpy.simulate_fmu(
        str(unit(folder)),
        fmi_type="ModelExchange",
        stop_time=1.0,
        output_interval=STEP,
        relative_tolerance=1e-10,
        record_events=False,
        output=["arm.speed"],
    )
    took = time.perf_counter() - began
    at = [int(min(range(len(result)), key=lambda k: abs(result["time"][k] - t))) for t in TIMES]
    return [float(result["arm.speed"][k]) for k in at], STEPS / took


def rumoca(folder: Path):
    """The equations by hand: its compiler has no LossyGear of the Modelica Standard Library."""
    import rumoca as engine

    source = f"""model Arm
      parameter Real eta = {ETA!r};
      Real w(start=0, fixed=true);
      Real T;
      Real k;
    equation
      T = if time < 0.5 then 2.0 else -1.0;
      k = if T > 0 then 1 + 4*eta else 1 + 4/eta;
      ({ARM} + {RATIO * MOTOR!r}*k)*der(w) = k*T;
    end Arm;"""
    model = engine.Session().loads(source, model="Arm")
    model.simulate((0.0, 0.01), dt=STEP)
    began = time.perf_counter()
    result = model.simulate((0.0, 1.0), dt=STEP, config=engine.SimConfig(rtol=1e-9, atol=1e-12))
    took = time.perf_counter() - began
    times, speeds = list(result.time), list(result["w"])
    at = [min(range(len(times)), key=lambda k: abs(times[k] - t)) for t in TIMES]
    return [float(speeds[k]) for k in at], STEPS / took


def rumoca_model(file: Path, name: str, starts: dict[str, float], torques: dict[str, str]):
    """The exported equations, moved by these torques."""
    import rumoca as engine

    words = [WILLIS, "export", "modelica-equations", file]
    text = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    start = ", ".join(f"speed_{member}(start={value})" for member, value in starts.items())
    moved = "".join(f"  own.torque_{member} = {value};\n" for member, value in torques.items())
    text += f"model Moved\n  {name} own({start});\nequation\n{moved}end Moved;\n"
    return engine.Session().loads(text, model="Moved"), engine.SimConfig(rtol=1e-9, atol=1e-12)


def rumoca_exported(folder: Path):
    torques = {"motor": "if time < 0.5 then 2 else -1", "arm": "0"}
    model, config = rumoca_model(with_arm(folder), "ArmDrive", {}, torques)
    began = time.perf_counter()
    result = model.simulate((0.0, 1.0), dt=STEP, config=config)
    took = time.perf_counter() - began
    times, speeds = list(result.time), list(result["own.speed_arm"])
    at = [min(range(len(times)), key=lambda k: abs(times[k] - t)) for t in TIMES]
    return [float(speeds[k]) for k in at], STEPS / took


# What the armature does: its torque passes no teeth. So much may be left where losses are applied.
ARMATURE = 6e-4
ENGINES = [
    ("willis simulate (whole program)", willis, 1e-8),
    ("FMPy, FMI 2.0, co-simulation", fmpy_cs, 1e-8),
    ("FMPy, FMI 2.0, model exchange (CVode)", fmpy_me, 1e-6),
    ("rumoca, equations by hand", rumoca, 1e-4),
    ("rumoca, as exported: modelica-equations", rumoca_exported, 1e-8),
    ("MuJoCo, as exported, no loss", lambda f: mujoco(f, False), None),
    ("MuJoCo, friction of the joint instead", lambda f: mujoco(f, False, (1 - (1 + 4 * ETA) / RATIO) * RATIO * 2.0), None),
    ("MuJoCo, with its user data", lambda f: mujoco(f, True), ARMATURE),
    ("Drake, as exported, no loss", lambda f: drake(f, False), None),
    ("Drake, with both efficiencies", lambda f: drake(f, True), ARMATURE),
]


def lossless() -> tuple[float, float]:
    inertia = ARM + RATIO**2 * MOTOR
    first = 0.5 * RATIO * torque(0.25) / inertia
    return first, first + 0.5 * RATIO * torque(0.75) / inertia


# Other checks: each returns what it found in a sentence, and what is wrong with it.


def pair(folder: Path):
    """Two sets, two independent speeds, a shaft that gives and a drag: exported equations in rumoca, beside `simulate`."""
    file, rows = HERE / "engines-pair.toml", folder / "pair.csv"
    subprocess.run([WILLIS, "simulate", file, "--samples", "1001", "-o", rows], check=True, capture_output=True)
    table = list(csv.DictReader(line for line in rows.read_text().splitlines() if not line.startswith("#")))
    starts = {"motor": 60, "side": 5, "load": 5}
    torques = {"motor": "if time < 0.5 then 4 else -3", "side": "if time < 0.7 then 6 else -3", "load": "-10"}
    model, config = rumoca_model(file, "Pair", starts, torques)
    result = model.simulate((0.0, 1.0), dt=STEP, config=config)
    worst = 0.0
    for member in ["motor", "middle", "side", "out", "load"]:
        own = {round(float(row["time_s"]), 9): float(row[f"{member}.speed_rad_s"]) for row in table}
        other = {round(t, 9): w for t, w in zip(result.time, result[f"own.speed_{member}"])}
        common = own.keys() & other.keys()
        assert len(common) > 900, f"{member}: {len(common)} times in common"
        worst = max(worst, max(abs(own[t] - other[t]) for t in common) / max(map(abs, own.values())))
    told = f"rumoca beside simulate, two sets with shaft and drag: at most {worst:.1e} of the largest speed"
    return told, "" if worst < 1e-6 else "more than 1e-6"


def openfast(folder: Path):
    """The two lines in a file of ElastoDyn, in the hands of the readers and writers that OpenFAST publishes."""
    from openfast_io.FAST_reader import InputReader_OpenFAST
    from openfast_io.FAST_writer import InputWriter_OpenFAST

    class Blank(dict):
        def __missing__(self, key):
            return "none" if key.endswith(("File", "File1", "File2", "File3", "OutFmt")) else 0

    writer = InputWriter_OpenFAST()
    writer.FAST_namingOut, writer.FAST_runDirectory = "turbine", str(folder)
    around = {"DTTorSpr": 8.5e8, "DTTorDmp": 6.2e6}
    own = Blank(GBoxEff=100.0, GBRatio=97.0, NumBl=3, OutFile=1, **around)
    writer.fst_vt = {"Fst": {}, "ElastoDyn": own, "outlist": {"ElastoDyn": {}}}
    writer.write_ElastoDyn()
    file = folder / "turbine_ElastoDyn.dat"
    lines = file.read_text().splitlines()
    text = exported(folder, "openfast").read_text()
    wanted = {}
    for line in (line for line in text.splitlines() if not line.startswith("!")):
        value, name = line.split()[:2]
        (at,) = [k for k, old in enumerate(lines) if old.split()[1:2] == [name]]
        lines[at], wanted[name] = line, float(value)
    file.write_text("\n".join(lines) + "\n")
    reader = InputReader_OpenFAST()
    reader.FAST_directory = str(folder)
    reader.read_ElastoDyn(str(file))
    read = {name: reader.fst_vt["ElastoDyn"][name] for name in [*wanted, *around]}
    told = f"openfast-io reads GBoxEff {read['GBoxEff']} and GBRatio {read['GBRatio']} from ElastoDyn's file"
    # By hand: 1 + 80/20 = 5, and from the slow to the fast end 5/(1 + 4/eta).
    right = read == wanted | around and read["GBRatio"] == RATIO
    right = right and abs(read["GBoxEff"] - 100 * RATIO / (1 + 4 / ETA)) < 1e-9
    return told, "" if right else f"not {wanted}"


def rexs(folder: Path):
    """Examples as REXS, validated by the schema of others, if it is named."""
    import xmlschema

    place = os.environ.get("WILLIS_REXS_SCHEMA")
    if place is None:
        return "REXS: not validated, WILLIS_REXS_SCHEMA names no rexs-file.xsd", ""
    schema, valid, refused, wrong = xmlschema.XMLSchema(place), 0, 0, []
    for file in sorted((HERE.parents[2] / "examples").glob("*.toml")):
        out = folder / f"{file.stem}.rexs"
        done = subprocess.run([WILLIS, "export", "rexs", file, "-o", out], capture_output=True)
        if done.returncode != 0:
            refused += 1
            continue
        errors = [f"{file.name}: {e.reason}" for e in schema.iter_errors(str(out))]
        wrong += errors[:3]
        valid += not errors
    return f"REXS: {valid} exported examples are valid by {Path(place).name}, {refused} have no place in REXS", "; ".join(wrong)


CHECKS = [("rumoca", pair), ("OpenFAST", openfast), ("REXS", rexs)]


def main() -> int:
    timed = "--speed" in sys.argv
    wanted, wrong = exact(), []
    print(f"speed of the arm, exact: {wanted[0]:.6f} rad/s driven, {wanted[1]:.6f} rad/s driven back after it\n")
    print(f"{'':<40}{'driven':>12}{'driven back':>14}" + (f"{'steps/s':>14}" if timed else ""))
    with tempfile.TemporaryDirectory() as name:
        for title, run, most in ENGINES:
            try:
                speeds, rate = run(Path(name))
            except ImportError as why:
                print(f"{title:<40}not here: {why}")
                continue
            # The second change of speed alone shows how it is driven back.
            changes = [(speeds[0], wanted[0]), (speeds[1] - speeds[0], wanted[1] - wanted[0])]
            errors = [(found - own) / own for found, own in changes]
            told = "".join(f"{100 * e:>+{w}.5f} %" for e, w in zip(errors, [10, 12]))
            print(f"{title:<40}{told}" + (f"{rate:>14,.0f}" if timed else ""))
            if most is not None and max(map(abs, errors)) > most:
                wrong.append(f"{title}: {max(map(abs, errors)):.1e} is more than {most:.0e}")
            if title.endswith("no loss"):
                free = lossless()
                off = [abs(a / b - 1) for a, b in zip(speeds, free)]
                if max(off) > 1e-6:
                    wrong.append(f"{title}: {max(off):.1e} from the motion without loss")
        print()
        for title, check in CHECKS:
            try:
                told, fault = check(Path(name))
            except ImportError as why:
                print(f"{title}: not here: {why}")
                continue
            print(told)
            if fault:
                wrong.append(f"{told}: {fault}")
    print("\n".join(["", *wrong]) if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
