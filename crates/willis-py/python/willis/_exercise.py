"""Exercises for lectures: a problem, the way to its solution, a picture."""

from __future__ import annotations

import random
from dataclasses import dataclass
from fractions import Fraction
from html import escape
from typing import TYPE_CHECKING, Literal, get_args

if TYPE_CHECKING:
    from ._train import Train

Kind = Literal["ratio", "speeds", "torques", "efficiency", "parallel"]


@dataclass(frozen=True)
class Exercise:
    """A problem with its solution. ``train`` is the same as a train, so that everything about it can be asked."""

    kind: str
    seed: int
    problem: str
    solution: str
    answer: dict[str, float]
    train: Train

    @property
    def picture(self) -> str:
        """The stick diagram, as SVG."""
        return self.train.draw("stick").svg

    def __str__(self) -> str:
        return f"{self.problem}\n\nSolution\n{self.solution}"

    def _repr_html_(self) -> str:
        lines = "".join(f"<p>{escape(p)}</p>" for p in self.problem.split("\n"))
        path = "".join(f"<p>{escape(p)}</p>" for p in self.solution.split("\n"))
        return f"{lines}{self.picture}<details><summary>Solution</summary>{path}</details>"


def exercise(kind: Kind = "ratio", seed: int = 1) -> Exercise:
    """An exercise of a kind; each seed gives other numbers, the same one always the same.

    ``ratio``: of a simple set with one shaft held. ``speeds``: two shafts given. ``torques``: without loss.
    ``efficiency``: from the efficiency of the meshes. ``parallel``: two sets in parallel, and which part of the power runs
    through the first.

    >>> import willis
    >>> e = willis.exercise("ratio", seed=3)
    >>> round(e.answer["ratio"], 9) == round(e.train.analyze().ratio, 9)
    True
    """
    makers = {
        "ratio": _ratio,
        "speeds": _speeds,
        "torques": _torques,
        "efficiency": _efficiency,
        "parallel": _parallel,
    }
    if kind not in makers:
        raise ValueError(f"there is no exercise {kind!r}; there are: {', '.join(get_args(Kind))}")
    return makers[kind](random.Random(f"{kind} {seed}"), seed)


def _set(of: random.Random) -> tuple[int, int, int, int]:
    """Sun, planet, ring and number of planets of a set that can be put together."""
    while True:
        sun, planet, count = of.randrange(18, 41), of.randrange(17, 36), of.choice((3, 4))
        ring = sun + 2 * planet
        # Equal spacing, and room between the planets.
        if (sun + ring) % count == 0 and (sun + planet) * (0.866 if count == 3 else 0.707) > planet + 2:
            return sun, planet, ring, count


def _given(sun: int, planet: int, ring: int, count: int) -> str:
    return f"A planetary set has a sun with {sun} teeth, {count} planets with {planet} and a ring with {ring}."


def _train(sun: int, ring: int, count: int, held: str, ends: tuple[str, str], eta: float = 1.0) -> Train:
    from ._train import simple

    return simple("P1", sun=sun, ring=ring, held=held, input=ends[0], output=ends[1], mesh_efficiency=eta, planets=count)


def _ratio_of(i0: Fraction, held: str, ends: tuple[str, str]) -> tuple[Fraction, str]:
    """The ratio of a set with a shaft held, and how it follows from Willis' equation."""
    # Speeds with the held shaft at rest, the carrier turning once: (w_s - w_c) = i0 (w_r - w_c).
    if held == "carrier":
        speeds = {"sun": i0, "ring": Fraction(1), "carrier": Fraction(0)}
        way = f"With the carrier at rest ω_sun = i0 ω_ring, i0 = {i0}."
    elif held == "ring":
        speeds = {"sun": 1 - i0, "ring": Fraction(0), "carrier": Fraction(1)}
        way = f"With ω_ring = 0: ω_sun − ω_carrier = −i0 ω_carrier, so ω_sun = (1 − i0) ω_carrier = {1 - i0} ω_carrier."
    else:
        speeds = {"sun": Fraction(0), "ring": 1 - 1 / i0, "carrier": Fraction(1)}
        way = f"With ω_sun = 0: −ω_carrier = i0 (ω_ring − ω_carrier), so ω_ring = (1 − 1/i0) ω_carrier = {1 - 1 / i0} ω_carrier."
    return speeds[ends[0]] / speeds[ends[1]], way


def _willis(sun: int, ring: int) -> tuple[Fraction, str]:
    i0 = Fraction(-ring, sun)
    return i0, f"Willis: (ω_sun − ω_carrier)/(ω_ring − ω_carrier) = i0 = −{ring}/{sun} = {i0}."


def _ratio(of: random.Random, seed: int) -> Exercise:
    sun, planet, ring, count = _set(of)
    held = of.choice(("sun", "ring", "carrier"))
    free = [s for s in ("sun", "ring", "carrier") if s != held]
    of.shuffle(free)
    ends = (free[0], free[1])
    i0, first = _willis(sun, ring)
    ratio, way = _ratio_of(i0, held, ends)
    return Exercise(
        "ratio",
        seed,
        f"{_given(sun, planet, ring, count)} The {held} is held. What is the ratio from the {ends[0]} to the {ends[1]}?",
        f"{first}\n{way}\ni = ω_{ends[0]}/ω_{ends[1]} = {ratio} = {float(ratio):.4f}.",
        {"ratio": float(ratio)},
        _train(sun, ring, count, held, ends),
    )


def _speeds(of: random.Random, seed: int) -> Exercise:
    sun, planet, ring, count = _set(of)
    i0, first = _willis(sun, ring)
    w_sun, w_carrier = of.randrange(500, 3001, 50), of.randrange(-1000, 1001, 50)
    w_ring = w_carrier + (w_sun - w_carrier) / i0
    # The planet on its carrier: (w_p - w_c) / (w_s - w_c) = - z_s / z_p.
    spin = -Fraction(sun, planet) * (w_sun - w_carrier)
    return Exercise(
        "speeds",
        seed,
        f"{_given(sun, planet, ring, count)} The sun turns at {w_sun} rpm, the carrier at {w_carrier} rpm. How fast do the "
        "ring and, on their carrier, the planets turn?",
        f"{first}\nω_ring = ω_carrier + (ω_sun − ω_carrier)/i0 = {float(w_ring):.2f} rpm.\n"
        f"Sun and planet roll on each other: ω_planet − ω_carrier = −{sun}/{planet} (ω_sun − ω_carrier) = "
        f"{float(spin):.2f} rpm.",
        {"ring_rpm": float(w_ring), "planet_spin_rpm": float(spin)},
        _train(sun, ring, count, "none", ("sun", "ring")),
    )


def _torques(of: random.Random, seed: int) -> Exercise:
    sun, planet, ring, count = _set(of)
    i0, first = _willis(sun, ring)
    torque = of.randrange(20, 301, 5)
    t_ring = -i0 * torque
    t_carrier = -(torque + t_ring)
    return Exercise(
        "torques",
        seed,
        f"{_given(sun, planet, ring, count)} {torque} N m act on the sun. Which torques hold ring and carrier in balance, "
        "without loss?",
        f"{first}\nNo power is lost: T_sun (ω_sun − ω_carrier) + T_ring (ω_ring − ω_carrier) = 0, so "
        f"T_ring = −i0 T_sun = {float(t_ring):.2f} N m.\nThe torques of all shafts add to zero: "
        f"T_carrier = −T_sun − T_ring = {float(t_carrier):.2f} N m.",
        {"ring_n_m": float(t_ring), "carrier_n_m": float(t_carrier)},
        _train(sun, ring, count, "none", ("sun", "carrier")),
    )


def _efficiency(of: random.Random, seed: int) -> Exercise:
    sun, planet, ring, count = _set(of)
    i0, first = _willis(sun, ring)
    mesh = of.randrange(970, 996) / 1000
    basic = mesh * mesh
    # Driven at the sun, the ring held: the sun drives on the carrier too.
    efficiency = float((1 - float(i0) * basic) / (1 - i0))
    return Exercise(
        "efficiency",
        seed,
        f"{_given(sun, planet, ring, count)} Each mesh has an efficiency of {mesh:.3f}. The ring is held, the sun drives the "
        "carrier. What is the efficiency?",
        f"{first}\nBasic efficiency: both meshes in a row with the carrier at rest, η0 = {mesh:.3f}² = {basic:.6f}.\n"
        "Seen from the carrier the sun drives: T_sun (ω_sun − ω_carrier) > 0, since ω_sun > ω_carrier. So "
        "T_ring = −i0 η0 T_sun and T_carrier = −(1 − i0 η0) T_sun.\n"
        f"η = (1 − i0 η0)/(1 − i0) = {efficiency:.6f}.",
        {"efficiency": efficiency},
        _train(sun, ring, count, "ring", ("sun", "carrier"), mesh),
    )


def _parallel(of: random.Random, seed: int) -> Exercise:
    from ._train import Train

    while True:
        (s1, p1, r1, n1), (s2, p2, r2, n2) = _set(of), _set(of)
        if (s1, r1) != (s2, r2) and Fraction(r1, s1) != Fraction(r2, s2):
            break
    # Sun 1 and sun 2 on the input; ring 1 held; ring 2 on carrier 1; output at carrier 2.
    w_c1 = Fraction(s1, s1 + r1)
    w_c2 = (s2 + r2 * w_c1) / (s2 + r2)
    ratio = 1 / w_c2
    # Torques for an output of -1: ring 2 takes r2/(s2 + r2) of it.
    t_r2 = Fraction(r2, s2 + r2)
    share = t_r2 * w_c1 / w_c2
    text = f"""format = 1
name = "two sets in parallel"
members = ["input", "link", "output"]
terminals = ["input", "output"]

[[set]]
name = "P1"
sun = {{ member = "input", teeth = {s1} }}
planet = {{ count = {n1} }}
ring = {{ member = "frame", teeth = {r1} }}
carrier = "link"

[[set]]
name = "P2"
sun = {{ member = "input", teeth = {s2} }}
planet = {{ count = {n2} }}
ring = {{ member = "link", teeth = {r2} }}
carrier = "output"
"""
    return Exercise(
        "parallel",
        seed,
        f"Two planetary sets share the input at their suns. The first has {s1} teeth at the sun, {p1} at the planets and {r1} at "
        f"the ring, which is held; its carrier drives the ring of the second, with {s2}, {p2} and {r2} teeth. The carrier of the "
        "second is the output. What is the ratio, and which part of the power runs through the first set?",
        f"First set: ω_carrier1 = z_s/(z_s + z_r) ω_input = {w_c1} ω_input.\n"
        f"Second set: (z_s + z_r) ω_carrier = z_s ω_sun + z_r ω_ring, so ω_output = {w_c2} ω_input and i = {ratio} = "
        f"{float(ratio):.4f}.\n"
        f"Torques in the second set are as the teeth: T_ring2/T_output = {t_r2} without loss. Its power over that of the output: "
        f"{t_r2} · {w_c1}/{w_c2} = {share} = {float(share):.4f}.",
        {"ratio": float(ratio), "share": float(share)},
        Train(text, "two sets in parallel"),
    )
