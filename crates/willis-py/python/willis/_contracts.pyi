"""The types of all answers, as the contracts of the library say them.

Written by ``generate.py``; changes belong to the library.
"""

from collections.abc import Iterator
from typing import Any, Generic, Literal, TypeVar

from . import _answer
from ._answer import Answer
from ._record import Record

_T = TypeVar("_T", covariant=True)

class Named(Generic[_T]):
    """Things by their names; a name that is an identifier is an attribute too."""

    def __getattr__(self, name: str) -> _T: ...
    def __getitem__(self, name: str) -> _T: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...
    def keys(self) -> list[str]: ...
    def values(self) -> list[_T]: ...
    def items(self) -> list[tuple[str, _T]]: ...
    def get(self, name: str, default: Any = None) -> _T | Any: ...
    def to_dict(self) -> dict[str, Any]: ...

class AnalyzeCertificateReport(Record):
    """Whether the answer is the only one, and how that is known."""
    @property
    def unique_for_every_load(self) -> bool:
        """Whether exactly one solution exists whatever the loads (with these directions of motion)."""
    @property
    def method(self) -> Literal["spectral-radius", "determinants", "enumeration", "undecided"]:
        """How that is known."""

class AnalyzeDirection(Record):
    """One direction of power through a state."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of it."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power; absent unless the verdict is ``unique``."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where the efficiencies of the meshes are given."""
    @property
    def efficiencies(self) -> list[float]:
        """The efficiency of every equilibrium."""
    @property
    def certificate(self) -> AnalyzeCertificateReport | None:
        """Certificate, where a problem could be set up."""
    @property
    def reason(self) -> str | None:
        """One sentence that explains a verdict other than ``unique``."""
    @property
    def why(self) -> Any | None:
        """What ``reason`` says, as data."""

class AnalyzeBandEnd(Record):
    """An end of a band, which ``--law`` reproduces."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def laws(self) -> Named[str]:
        """The law of each family in the band."""

class AnalyzeFamilyBand(Record):
    """The laws of one family."""
    @property
    def law(self) -> str:
        """The law in force."""
    @property
    def in_range(self) -> bool:
        """Whether that is inside its range here."""
    @property
    def efficiencies(self) -> Named[float]:
        """The efficiency with each law that counts."""
    @property
    def beyond_ranges(self) -> bool:
        """Whether these are counted although fewer than two laws are inside their ranges."""
    @property
    def left_out(self) -> list[str]:
        """Laws that do not count: outside their ranges, or without one answer."""

class AnalyzeLawBand(Record):
    """What an efficiency would be with other laws of loss: how far it is known.

    Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law
    of all kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce
    a published error, and those that leave a loss out, do not count. The oil temperature is held, and so are film,
    loss factor and load sharing, which belong to the law of friction."""
    @property
    def low(self) -> AnalyzeBandEnd:
        """The lowest efficiency."""
    @property
    def high(self) -> AnalyzeBandEnd:
        """The highest efficiency."""
    @property
    def families(self) -> Named[AnalyzeFamilyBand]:
        """By family, what its laws give while the other families keep theirs."""

class AnalyzeLosses(Record):
    """Losses by kind, W."""
    @property
    def mesh(self) -> float:
        """Tooth friction."""
    @property
    def bearing(self) -> float:
        """Bearings."""
    @property
    def windage(self) -> float:
        """Air and oil mist."""
    @property
    def churning(self) -> float:
        """Oil sump."""
    @property
    def seal(self) -> float:
        """Shaft seals."""
    @property
    def drag(self) -> float:
        """Drags that are given as torques."""
    @property
    def injection(self) -> float:
        """Oil that is sprayed into meshes."""
    @property
    def pump(self) -> float:
        """Oil pumps."""
    @property
    def variator(self) -> float:
        """Variators."""

class AnalyzeLossSource(Record):
    """One place where power is lost."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its name in the list of laws; ``given`` for a given efficiency."""
    @property
    def loss_w(self) -> float:
        """The power, W."""
    @property
    def loss(self) -> float: ...
    @property
    def share(self) -> float:
        """The part of all losses."""

class AnalyzeAtLoad(Record):
    """A gear at a stated load, and at the same speed without one."""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose speed and load these are; absent where they were asked for."""
    @property
    def speed_rad_s(self) -> float:
        """Speed of the input, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def torque_n_m(self) -> float:
        """Torque at the input, N m."""
    @property
    def torque(self) -> float: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature, K: prescribed, of the heat balance, or of the oil; absent without an oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def beyond_limit(self) -> bool:
        """Whether no temperature up to the limit balances losses and heat flow: then it is the limit."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the point."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def band(self) -> AnalyzeLawBand | None:
        """Between which values other laws put it, where that is asked for."""
    @property
    def loss_w(self) -> float | None:
        """All losses, W."""
    @property
    def loss(self) -> float | None: ...
    @property
    def losses_w(self) -> AnalyzeLosses | None:
        """Losses by kind, W."""
    @property
    def losses(self) -> AnalyzeLosses | None: ...
    @property
    def spin_loss_w(self) -> float | None:
        """What turns the input at this speed and temperature with nothing at the output, W: the spin loss."""
    @property
    def spin_loss(self) -> float | None: ...
    @property
    def spin_losses_w(self) -> AnalyzeLosses | None:
        """That by kind, W."""
    @property
    def spin_losses(self) -> AnalyzeLosses | None: ...
    @property
    def spin_sources(self) -> list[AnalyzeLossSource]:
        """That by source, the largest first."""
    @property
    def reason(self) -> str | None:
        """Why there is no efficiency."""
    @property
    def warnings(self) -> list[str]:
        """Warnings of the point under load: laws outside their ranges, the heat balance, limits."""

class AnalyzeStateReport(Record):
    """A row of the shift table."""
    @property
    def input(self) -> str:
        """Where power enters when driving."""
    @property
    def output(self) -> str:
        """Where power leaves when driving."""
    @property
    def exact(self) -> str | None:
        """``ω_input/ω_output``, exactly; absent when there is no such number."""
    @property
    def value(self) -> float | None:
        """The same as a decimal."""
    @property
    def no_ratio(self) -> str | None:
        """Why there is no ratio."""
    @property
    def step(self) -> float | None:
        """Ratio of this state over that of the next in the table, where both have the same sign."""
    @property
    def engaged(self) -> list[str]:
        """Shift elements that are closed."""
    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom in this state."""
    @property
    def drive(self) -> AnalyzeDirection:
        """Input drives output."""
    @property
    def coast(self) -> AnalyzeDirection:
        """Output drives input."""
    @property
    def at_load(self) -> AnalyzeAtLoad | None:
        """Driving at the load that the file has for this input, where losses depend on load and
        [``Analysis::with_loads``] asked."""

class AnalyzeOutsideAt(Record):
    """A place where a law was used outside its range."""
    @property
    def name(self) -> str:
        """The mesh, bearing, seal, gear or rotor."""
    @property
    def value(self) -> float | None:
        """The value there, in the unit of the quantity; absent where it is not finite."""

class AnalyzeOutsideLaw(Record):
    """A quantity outside the range of a law, wherever it was."""
    @property
    def family(self) -> str:
        """Family of the law."""
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""
    @property
    def low(self) -> float | None:
        """Lowest value of the range, in that unit; absent where there is none."""
    @property
    def high(self) -> float | None:
        """Highest value of the range, in that unit; absent where there is none."""
    @property
    def places(self) -> list[AnalyzeOutsideAt]:
        """Where the law was used so."""

class AnalyzeSpeedDeviation(Record):
    """Prescribed speeds that contradict the gears within the tolerance that was asked for
    ([``Train::with_speed_tolerance``])."""
    @property
    def members(self) -> list[str]:
        """The members that the gears tie together, in the order in which their speeds were given. The last one follows
        the others."""
    @property
    def relative(self) -> float:
        """By which part of the largest of their speeds, as the gears tie them, they contradict each other."""

class AnalyzeCertificate2(Record):
    """Why there are no other equilibria."""
    @property
    def method(self) -> Literal["elasticity", "branch-and-bound"]:
        """The argument."""
    @property
    def proved(self) -> bool:
        """Whether bounds prove it. Else the elasticity is taken to differ within an interval no more than it does from
        one interval to the next, or, where intervals were excluded, each heat to be monotone between the
        temperatures computed."""
    @property
    def largest_elasticity(self) -> float | None:
        """Largest elasticity of the losses between two temperatures; one equilibrium where it is below 1."""
    @property
    def temperatures(self) -> int:
        """Temperatures at which the losses were computed."""
    @property
    def widest_k(self) -> float:
        """Largest distance between two of them, K."""
    @property
    def widest(self) -> float: ...

class AnalyzeHeatEquilibrium(Record):
    """An oil temperature at which losses and heat flow agree."""
    @property
    def oil_k(self) -> float:
        """The temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def stable(self) -> bool:
        """Whether the oil returns to it after a small disturbance."""
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def step_w(self) -> list[float] | None:
        """On the step of a law: heat that reaches the oil just below and just above it, W."""
    @property
    def step(self) -> list[float] | None: ...

class AnalyzePlaceReport(Record):
    """A place of the network."""
    @property
    def temperature_k(self) -> float:
        """Its temperature, K."""
    @property
    def temperature(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def share_to_oil(self) -> float:
        """Part of that heat that reaches the oil."""
    @property
    def given(self) -> bool:
        """Whether its temperature is given."""

class AnalyzeHeatFlow(Record):
    """Heat on its way."""
    @property
    def between(self) -> list[str]:
        """From where to where."""
    @property
    def heat_w(self) -> float:
        """The heat, W; negative the other way round."""
    @property
    def heat(self) -> float: ...

class AnalyzeHeatPoint(Record):
    """Heat at an oil temperature."""
    @property
    def oil_k(self) -> float:
        """Oil temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def reaching_w(self) -> float:
        """Heat that reaches the oil, W: computed there, or on a straight line between two temperatures at which it
        was."""
    @property
    def reaching(self) -> float: ...
    @property
    def carried_w(self) -> float:
        """Heat that leaves it, W."""
    @property
    def carried(self) -> float: ...

class AnalyzeHeatReport(Record):
    """The temperatures of an operating point, and where its heat goes."""
    @property
    def oil_k(self) -> float:
        """Oil temperature in force, K."""
    @property
    def oil(self) -> float: ...
    @property
    def basis(self) -> Literal["balance", "given", "limit"]:
        """Where it comes from."""
    @property
    def verdict(self) -> Literal["unique", "several", "none-below-limit", "undecided"] | None:
        """What can be said of it; absent where it is given."""
    @property
    def certificate(self) -> AnalyzeCertificate2 | None:
        """Why there is no other."""
    @property
    def equilibria(self) -> list[AnalyzeHeatEquilibrium]:
        """Every oil temperature that holds, the coldest first."""
    @property
    def undecided_k(self) -> list[list[float]]:
        """Intervals in which it could not be decided, K."""
    @property
    def undecided(self) -> list[list[float]]: ...
    @property
    def ambient_k(self) -> float:
        """Temperature of the air, K."""
    @property
    def ambient(self) -> float: ...
    @property
    def limit_k(self) -> float:
        """Highest oil temperature allowed, K."""
    @property
    def limit(self) -> float: ...
    @property
    def margin_k(self) -> float:
        """Limit less oil temperature, K."""
    @property
    def margin(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Losses that become heat in the gearbox, W."""
    @property
    def heat(self) -> float: ...
    @property
    def extra_heat_w(self) -> float:
        """Heat into the oil beside the losses, W."""
    @property
    def extra_heat(self) -> float: ...
    @property
    def cooled_elsewhere_w(self) -> float:
        """Losses of variators, which have a cooling of their own, W."""
    @property
    def cooled_elsewhere(self) -> float: ...
    @property
    def residual_w(self) -> float:
        """Heat that reaches the oil less what leaves it, W: it warms where that is above zero."""
    @property
    def residual(self) -> float: ...
    @property
    def places(self) -> Named[AnalyzePlaceReport]:
        """Every place."""
    @property
    def paths(self) -> list[AnalyzeHeatFlow]:
        """Every way for heat."""
    @property
    def cooler_w(self) -> float | None:
        """Heat that the cooler takes, W; negative where it heats."""
    @property
    def cooler(self) -> float | None: ...
    @property
    def curve(self) -> list[AnalyzeHeatPoint]:
        """Heat that reaches the oil and what it gives off, over its temperature. What reaches it is computed at the
        temperatures that the balance looked at; between those it is a straight line. Points of studies have none."""
    @property
    def slope_w_k(self) -> float | None:
        """Change of what leaves the oil less what reaches it with its temperature, W/K; above zero where it is stable."""
    @property
    def slope_w(self) -> float | None: ...
    @property
    def time_constants_s(self) -> list[float]:
        """Time constants around this temperature, s, the slowest first; none without heat capacities."""
    @property
    def time_constants(self) -> list[float]: ...
    @property
    def drivers_change(self) -> bool:
        """Whether other gears drive when the oil is cold than when it is as hot as it may be."""

class AnalyzeMemberReport(Record):
    """A member in an operating point."""
    @property
    def speed_rad_s(self) -> float | None:
        """Absolute speed (for a bevel planet: carrier speed plus spin), rad/s; absent when not determined."""
    @property
    def speed(self) -> float | None: ...
    @property
    def carrier(self) -> str | None:
        """The carrier it rides on, for a planet."""
    @property
    def relative_speed_rad_s(self) -> float | None:
        """Speed relative to that carrier, rad/s."""
    @property
    def relative_speed(self) -> float | None: ...
    @property
    def torque_n_m(self) -> float | None:
        """External torque on it, N m; absent when statics cannot divide it."""
    @property
    def torque(self) -> float | None: ...
    @property
    def power_w(self) -> float | None:
        """External power into it, W."""
    @property
    def power(self) -> float | None: ...
    @property
    def role(self) -> Literal["input", "output", "fixed", "idle"]:
        """What it does."""

class AnalyzeMeshReport(Record):
    """A mesh in an operating point; totals over its ``count`` pairs in parallel."""
    @property
    def driver(self) -> str | None:
        """The member that drives, seen from the carrier; absent when idle or without relative motion."""
    @property
    def relative_speed_rad_s(self) -> float:
        """Speed of the driver (else of the first gear) relative to the carrier, rad/s."""
    @property
    def relative_speed(self) -> float: ...
    @property
    def potential_power_w(self) -> float:
        """Power of the driver seen from the carrier, W."""
    @property
    def potential_power(self) -> float: ...
    @property
    def efficiency(self) -> float:
        """Efficiency in force."""
    @property
    def loss_w(self) -> float:
        """Loss, W."""
    @property
    def loss(self) -> float: ...
    @property
    def first_torque_n_m(self) -> float:
        """Torque that the first gear puts into the mesh, N m."""
    @property
    def first_torque(self) -> float: ...
    @property
    def second_torque_n_m(self) -> float:
        """Torque that the second gear puts into the mesh, N m."""
    @property
    def second_torque(self) -> float: ...
    @property
    def carrier_torque_n_m(self) -> float:
        """Torque that the carrier puts into the mesh, N m."""
    @property
    def carrier_torque(self) -> float: ...
    @property
    def count(self) -> int:
        """Identical pairs in parallel."""

class AnalyzeShiftElementReport(Record):
    """An engaged shift element in an operating point."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way"]:
        """What it is."""
    @property
    def members(self) -> list[str]:
        """The members it joins."""
    @property
    def torque_n_m(self) -> float | None:
        """Torque it exerts on its first member, N m; absent when statics cannot divide it."""
    @property
    def torque(self) -> float | None: ...

class AnalyzeMachineReport(Record):
    """A side of a variator, or a machine."""
    @property
    def member(self) -> str:
        """The member that it turns with."""
    @property
    def torque_n_m(self) -> float:
        """Torque that it exerts on the member, N m."""
    @property
    def torque(self) -> float: ...
    @property
    def speed_rad_s(self) -> float:
        """Speed of the member, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def power_w(self) -> float:
        """Power that it delivers to the member, W: positive where it motors."""
    @property
    def power(self) -> float: ...
    @property
    def efficiency(self) -> float | None:
        """Efficiency in force, where it passes power."""

class AnalyzeVariatorReport(Record):
    """A variator in an operating point."""
    @property
    def kind(self) -> Literal["electric", "hydrostatic", "belt"]:
        """What it is made of."""
    @property
    def power_w(self) -> float:
        """Power that reaches the receiving side, W; with more than two machines, all that motor together."""
    @property
    def power(self) -> float: ...
    @property
    def share(self) -> float:
        """That power over the input power: positive from the first side to the second, negative the other way. With
        more than two machines the first that generates or motors counts as the first side."""
    @property
    def loss_w(self) -> float:
        """Power lost on the way, W; standby losses included."""
    @property
    def loss(self) -> float: ...
    @property
    def store_w(self) -> float | None:
        """Power out of the store into the bus, W; absent where there is no bus."""
    @property
    def store(self) -> float | None: ...
    @property
    def ratio(self) -> float | None:
        """Speed of the first side over that of the second; absent with more than two, and where the second stands
        still."""
    @property
    def machines(self) -> Named[AnalyzeMachineReport]:
        """Its sides by their members, or its machines."""

class AnalyzeBeyondLimit(Record):
    """A limit of a variator that an operating point exceeds."""
    @property
    def variator(self) -> str:
        """The variator."""
    @property
    def machine(self) -> str | None:
        """Its machine; absent where the limit is that of the ratio."""
    @property
    def quantity(self) -> Literal["torque", "power", "speed", "ratio"]:
        """What is limited."""
    @property
    def value(self) -> float:
        """What it is, SI."""
    @property
    def limit(self) -> float:
        """What it may be at most (or, of a ratio, at least), SI."""

class AnalyzeContactReport(Record):
    """A tooth contact in an operating point. Loads are the mean of the pairs in parallel, pressures and films those of
    the pair that is loaded most (``load_sharing_factor``)."""
    @property
    def friction(self) -> float | None:
        """Mean coefficient of friction; absent when the efficiency is given, or nothing is loaded."""
    @property
    def loss_factor(self) -> float:
        """Loss factor ``H_V``."""
    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio ``ε_α``."""
    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio ``ε_β`` of one helix."""
    @property
    def operating_pressure_angle_rad(self) -> float:
        """Operating pressure angle in the transverse section, rad."""
    @property
    def operating_pressure_angle(self) -> float: ...
    @property
    def backlash_m(self) -> float:
        """Transverse circumferential backlash at the operating circles, m; 0 where the centre distance follows from
        the shifts."""
    @property
    def backlash(self) -> float: ...
    @property
    def tangential_force_n(self) -> float:
        """Tangential force at the operating pitch circle, N."""
    @property
    def tangential_force(self) -> float: ...
    @property
    def line_load_n_per_m(self) -> float:
        """Load at the base circle over the face width, N/m."""
    @property
    def line_load(self) -> float: ...
    @property
    def pitch_line_speed_m_s(self) -> float:
        """Pitch line speed relative to the carrier, m/s."""
    @property
    def pitch_line_speed(self) -> float: ...
    @property
    def sum_speed_m_s(self) -> float:
        """Sum of the surface speeds at the pitch point, m/s."""
    @property
    def sum_speed(self) -> float: ...
    @property
    def sliding_speed_m_s(self) -> float:
        """Largest sliding speed, m/s."""
    @property
    def sliding_speed(self) -> float: ...
    @property
    def pitch_pressure_pa(self) -> float:
        """Hertzian pressure at the pitch point, Pa."""
    @property
    def pitch_pressure(self) -> float: ...
    @property
    def pressure_pa(self) -> float:
        """Largest Hertzian pressure on the path of contact, Pa."""
    @property
    def pressure(self) -> float: ...
    @property
    def pitch_film_m(self) -> float | None:
        """Film thickness at the pitch point, thermal reduction included, m; absent without an oil."""
    @property
    def pitch_film(self) -> float | None: ...
    @property
    def film_m(self) -> float | None:
        """Smallest film thickness on the path of contact, m."""
    @property
    def film(self) -> float | None: ...
    @property
    def film_ratio(self) -> float | None:
        """Smallest film thickness over the composite rms roughness, ``λ``."""
    @property
    def regime(self) -> Literal["boundary", "mixed", "full"] | None:
        """Lubrication by ``λ``."""
    @property
    def sliding_loss_w(self) -> float:
        """Loss by sliding, all pairs in parallel, W."""
    @property
    def sliding_loss(self) -> float: ...
    @property
    def lengthwise_loss_w(self) -> float | None:
        """The part of it by sliding along the teeth of hypoid gears, W."""
    @property
    def lengthwise_loss(self) -> float | None: ...
    @property
    def lengthwise_efficiency(self) -> float | None:
        """The efficiency of that sliding alone."""
    @property
    def rolling_loss_w(self) -> float:
        """Loss by rolling where it is computed apart, all pairs in parallel, W."""
    @property
    def rolling_loss(self) -> float: ...

class AnalyzeBearingReport(Record):
    """A place with bearings in an operating point."""
    @property
    def designation(self) -> str:
        """Designation."""
    @property
    def members(self) -> list[str]:
        """The members it joins."""
    @property
    def bearings(self) -> int:
        """Bearings in all: side by side, at every planet."""
    @property
    def speed_rad_s(self) -> float:
        """Speed of one ring relative to the other, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def radial_load_n(self) -> float:
        """Radial load of one bearing, the most loaded, N."""
    @property
    def radial_load(self) -> float: ...
    @property
    def axial_load_n(self) -> float:
        """Axial load of one bearing, N; mean of those that share it."""
    @property
    def axial_load(self) -> float: ...
    @property
    def torque_n_m(self) -> float:
        """Frictional torque of one bearing, mean of all, N m."""
    @property
    def torque(self) -> float: ...
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def loss_w(self) -> float:
        """Loss of all of them, W."""
    @property
    def loss(self) -> float: ...

class AnalyzeShaftLoad(Record):
    """What the teeth and planets do to a shaft on bearings, and what of it the bearings of the train do not carry."""
    @property
    def radial_n(self) -> float:
        """Radial force, N: sum of amounts where directions are not known relative to each other."""
    @property
    def radial(self) -> float: ...
    @property
    def thrust_n(self) -> float:
        """Thrust along the axis, N; positive towards growing positions."""
    @property
    def thrust(self) -> float: ...
    @property
    def tilting_n_m(self) -> float:
        """Tilting moment about the origin of the positions, N m."""
    @property
    def tilting(self) -> float: ...
    @property
    def uncarried_radial_n(self) -> float:
        """Radial force that no bearing of the train carries, N."""
    @property
    def uncarried_radial(self) -> float: ...
    @property
    def uncarried_thrust_n(self) -> float:
        """Thrust that no bearing of the train carries, N."""
    @property
    def uncarried_thrust(self) -> float: ...
    @property
    def uncarried_tilting_n_m(self) -> float:
        """Tilting moment that no bearing of the train carries, N m: gears or other shafts must."""
    @property
    def uncarried_tilting(self) -> float: ...

class AnalyzeDoubt(Record):
    """A number that cannot be right, or that something must be missing for."""
    @property
    def kind(self) -> Literal["contact-pressure", "bearing-load", "bearing-speed", "bearing-loss", "thrust-on-floating", "uncarried-thrust", "uncarried-force", "uncarried-moment"]:
        """What it is."""
    @property
    def at(self) -> str:
        """The mesh, bearing or member."""
    @property
    def value(self) -> float:
        """The number, in the unit of its kind."""
    @property
    def limit(self) -> float:
        """What it passes, in the same unit."""

class AnalyzeDragReport(Record):
    """A torque that two members exert on each other against their relative motion.

    Of a bearing that the teeth load there are several: the part that is there without load, and one for each mesh
    whose load it carries. The latter is contained in that mesh's efficiency, so the mesh's torques include it."""
    @property
    def name(self) -> str:
        """What exerts it: name of the bearing, seal, gear or rotor; of rolling, of the mesh."""
    @property
    def source(self) -> Literal["rolling", "bearing", "seal", "gear", "rotor", "drag", "shift-element", "injection", "pump"]:
        """What that is."""
    @property
    def members(self) -> list[str]:
        """The two members."""
    @property
    def torque_n_m(self) -> float:
        """Torque on the first member, N m; the second feels the opposite."""
    @property
    def torque(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """Loss, W: torque times speed of the second relative to the first."""
    @property
    def loss(self) -> float: ...
    @property
    def contained_in(self) -> str | None:
        """The mesh whose torques contain it."""

class AnalyzeConvergence(Record):
    """How the agreement of losses and torques was reached."""
    @property
    def converged(self) -> bool:
        """Whether it was reached."""
    @property
    def rounds(self) -> int:
        """Rounds of statics and laws."""
    @property
    def error(self) -> float:
        """Bound on the error that is left, over the loss; the last change where nothing bounds it."""
    @property
    def contraction(self) -> float:
        """The factor by which the last rounds reduced it."""

class AnalyzeCirculationReport(Record):
    """Power that goes round in circles."""
    @property
    def power_w(self) -> float:
        """The power, W."""
    @property
    def power(self) -> float: ...
    @property
    def share_of_input(self) -> float:
        """The power over the input power."""
    @property
    def path(self) -> list[str]:
        """The shafts and sets it passes, in order."""

class AnalyzeBoundary(Record):
    """A boundary of the region in which the present loss formula holds."""
    @property
    def member(self) -> str:
        """The member whose prescribed value moves."""
    @property
    def value(self) -> float:
        """Its value now, SI."""
    @property
    def boundary(self) -> float:
        """Its value on the boundary, SI."""
    @property
    def mesh(self) -> str:
        """The mesh that is unloaded, or stops moving, there."""

class AnalyzeLockMargin(Record):
    """The nearest self-locking threshold of one efficiency."""
    @property
    def meshes(self) -> list[str]:
        """The mesh, or the meshes in a row that share one efficiency."""
    @property
    def efficiency(self) -> float:
        """Their efficiency now."""
    @property
    def threshold(self) -> float:
        """The efficiency at which the train locks."""

class AnalyzeMargin(Record):
    """How far a solution is from a change."""
    @property
    def torque(self) -> AnalyzeBoundary | None:
        """The smallest change of a prescribed torque that unloads a mesh (and beyond which another loss formula
        holds)."""
    @property
    def speed(self) -> AnalyzeBoundary | None:
        """The smallest change of a prescribed speed that stops the relative motion in a mesh."""
    @property
    def lock(self) -> AnalyzeLockMargin | None:
        """The mesh (or set) whose efficiency is nearest to the value at which the train locks."""
    @property
    def lock_loss_factor(self) -> float | None:
        """The factor on all losses ``1 − η`` of basic efficiencies, those of whole sets, at which the train locks."""

class AnalyzeTorque(Record):
    @property
    def member(self) -> str:
        """The member."""

class AnalyzeStictionquantity(Record):
    """The torque on a member, N m."""
    @property
    def torque(self) -> AnalyzeTorque: ...

class AnalyzeStictionRange(Record):
    """A torque range that friction in a mesh at rest leaves open."""
    @property
    def what(self) -> str:
        """What varies, in words."""
    @property
    def quantity(self) -> Literal["efficiency"] | AnalyzeStictionquantity:
        """What ``what`` says, as data."""
    @property
    def low(self) -> float | None:
        """Smallest value; absent when too many meshes rest to bound it."""
    @property
    def high(self) -> float | None:
        """Largest value."""

class AnalyzeSolutionReport(Record):
    """One equilibrium."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power; 0 when everything is dissipated, absent when nothing is loaded."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where efficiencies, speeds and loads are known so: given efficiencies, speeds in one
        unit and torques or powers in one unit. Points of studies have it only where a sign hung on it."""
    @property
    def all_dissipated(self) -> bool:
        """Whether every loaded member is an input."""
    @property
    def input_power_w(self) -> float:
        """Power in, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def output_power_w(self) -> float:
        """Power out, W."""
    @property
    def output_power(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def power_residual_w(self) -> float:
        """Input less output less losses, W."""
    @property
    def power_residual(self) -> float: ...
    @property
    def members(self) -> Named[AnalyzeMemberReport]:
        """Every member but the frame."""
    @property
    def meshes(self) -> Named[AnalyzeMeshReport]:
        """Every mesh."""
    @property
    def shift_elements(self) -> Named[AnalyzeShiftElementReport]:
        """Every engaged shift element."""
    @property
    def variators(self) -> Named[AnalyzeVariatorReport]:
        """Every variator."""
    @property
    def beyond_limits(self) -> list[AnalyzeBeyondLimit]:
        """Limits of variators that are exceeded."""
    @property
    def losses_w(self) -> AnalyzeLosses:
        """Losses by kind."""
    @property
    def losses(self) -> AnalyzeLosses: ...
    @property
    def sources(self) -> list[AnalyzeLossSource]:
        """Losses by source, largest first, where they are computed."""
    @property
    def contacts(self) -> Named[AnalyzeContactReport]:
        """Tooth contacts of the meshes whose teeth are given."""
    @property
    def bearings(self) -> Named[AnalyzeBearingReport]:
        """Rolling bearings."""
    @property
    def shaft_loads(self) -> Named[AnalyzeShaftLoad]:
        """Loads of the shafts that rest on these bearings."""
    @property
    def doubts(self) -> list[AnalyzeDoubt]:
        """Numbers that cannot be right, or for which something is missing."""
    @property
    def drags(self) -> list[AnalyzeDragReport]:
        """Drag torques between members, where losses are computed."""
    @property
    def convergence(self) -> AnalyzeConvergence | None:
        """How losses and torques were brought into agreement, where losses are computed."""
    @property
    def recirculation(self) -> list[AnalyzeCirculationReport]:
        """Recirculating powers."""
    @property
    def margin(self) -> AnalyzeMargin:
        """Distance to the next change."""
    @property
    def stiction(self) -> list[AnalyzeStictionRange]:
        """What friction in meshes at rest leaves open."""

class AnalyzeOperationReport(Record):
    """An operating point."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def state(self) -> str | None:
        """The state of the shift table."""
    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom with its elements engaged and members held."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of it."""
    @property
    def certificate(self) -> AnalyzeCertificateReport | None:
        """Certificate, where a problem could be set up."""
    @property
    def reason(self) -> str | None:
        """One sentence that explains the verdict."""
    @property
    def why(self) -> Any | None:
        """What ``reason`` says, as data."""
    @property
    def outside_laws(self) -> list[AnalyzeOutsideLaw]:
        """Laws that were used outside their ranges."""
    @property
    def speed_deviation(self) -> AnalyzeSpeedDeviation | None:
        """Where prescribed speeds contradict the gears the most, within the tolerance that was asked for."""
    @property
    def speeds_rad_s(self) -> Named[float | None]:
        """Speeds, also when the torques have no answer; rad/s."""
    @property
    def speeds(self) -> Named[float | None]: ...
    @property
    def heat(self) -> AnalyzeHeatReport | None:
        """Temperatures and heat, where the train says what carries heat away."""
    @property
    def band(self) -> AnalyzeLawBand | None:
        """Between which values other laws put the efficiency, where [``Analysis::with_bands``] asked."""
    @property
    def solutions(self) -> list[AnalyzeSolutionReport]:
        """Every equilibrium that drives a load (or, with two or more freedoms, any equilibrium)."""
    @property
    def dissipative_solutions(self) -> list[AnalyzeSolutionReport]:
        """Of a locked train: equilibria in which every loaded member must push."""

class AnalyzeSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class AnalyzeDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> AnalyzeSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class AnalyzeAnswer(_answer.Analysis):
    """Everything that is known about a train."""
    @property
    def format(self) -> Literal["willis-analysis-1"]:
        """``willis-analysis-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def source(self) -> str | None:
        """Source of its data."""
    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom as drawn, no shift element engaged."""
    @property
    def ratios(self) -> Named[AnalyzeStateReport]:
        """The shift table, or one row ``as drawn``."""
    @property
    def operations(self) -> list[AnalyzeOperationReport]:
        """The operating points."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given, and what the model leaves out."""
    @property
    def diagnostics(self) -> list[AnalyzeDiagnostic]:
        """Warnings and notes."""

class TableShaftMember(Record):
    """A member in a state."""
    @property
    def speed(self) -> str | None:
        """Speed over that of the input; absent where the input does not settle it."""
    @property
    def carrier(self) -> str | None:
        """The carrier on which it turns, for a planet."""
    @property
    def relative_speed(self) -> str | None:
        """Speed relative to that carrier, over the speed of the input."""
    @property
    def torque(self) -> float | None:
        """External torque over that of the input, reactions of brakes included; absent where it is not determined."""

class TableShaftElement(Record):
    """A shift element in a state."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way"]:
        """What it is."""
    @property
    def members(self) -> list[str]:
        """The members it joins."""
    @property
    def engaged(self) -> bool:
        """Whether it is closed."""
    @property
    def slip(self) -> str | None:
        """Speed of the first member less that of the second, over the speed of the input: 0 while it is closed."""
    @property
    def torque(self) -> float | None:
        """Torque that it exerts on the first member, over the input torque; 0 while it is open, absent where it is not
        determined."""

class TableBandEnd(Record):
    """An end of a band, which ``--law`` reproduces."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def laws(self) -> Named[str]:
        """The law of each family in the band."""

class TableFamilyBand(Record):
    """The laws of one family."""
    @property
    def law(self) -> str:
        """The law in force."""
    @property
    def in_range(self) -> bool:
        """Whether that is inside its range here."""
    @property
    def efficiencies(self) -> Named[float]:
        """The efficiency with each law that counts."""
    @property
    def beyond_ranges(self) -> bool:
        """Whether these are counted although fewer than two laws are inside their ranges."""
    @property
    def left_out(self) -> list[str]:
        """Laws that do not count: outside their ranges, or without one answer."""

class TableLawBand(Record):
    """What an efficiency would be with other laws of loss: how far it is known.

    Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law
    of all kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce
    a published error, and those that leave a loss out, do not count. The oil temperature is held, and so are film,
    loss factor and load sharing, which belong to the law of friction."""
    @property
    def low(self) -> TableBandEnd:
        """The lowest efficiency."""
    @property
    def high(self) -> TableBandEnd:
        """The highest efficiency."""
    @property
    def families(self) -> Named[TableFamilyBand]:
        """By family, what its laws give while the other families keep theirs."""

class TableLosses(Record):
    """Losses by kind, W."""
    @property
    def mesh(self) -> float:
        """Tooth friction."""
    @property
    def bearing(self) -> float:
        """Bearings."""
    @property
    def windage(self) -> float:
        """Air and oil mist."""
    @property
    def churning(self) -> float:
        """Oil sump."""
    @property
    def seal(self) -> float:
        """Shaft seals."""
    @property
    def drag(self) -> float:
        """Drags that are given as torques."""
    @property
    def injection(self) -> float:
        """Oil that is sprayed into meshes."""
    @property
    def pump(self) -> float:
        """Oil pumps."""
    @property
    def variator(self) -> float:
        """Variators."""

class TableLossSource(Record):
    """One place where power is lost."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its name in the list of laws; ``given`` for a given efficiency."""
    @property
    def loss_w(self) -> float:
        """The power, W."""
    @property
    def loss(self) -> float: ...
    @property
    def share(self) -> float:
        """The part of all losses."""

class TableAtLoad(Record):
    """A gear at a stated load, and at the same speed without one."""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose speed and load these are; absent where they were asked for."""
    @property
    def speed_rad_s(self) -> float:
        """Speed of the input, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def torque_n_m(self) -> float:
        """Torque at the input, N m."""
    @property
    def torque(self) -> float: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature, K: prescribed, of the heat balance, or of the oil; absent without an oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def beyond_limit(self) -> bool:
        """Whether no temperature up to the limit balances losses and heat flow: then it is the limit."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the point."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def band(self) -> TableLawBand | None:
        """Between which values other laws put it, where that is asked for."""
    @property
    def loss_w(self) -> float | None:
        """All losses, W."""
    @property
    def loss(self) -> float | None: ...
    @property
    def losses_w(self) -> TableLosses | None:
        """Losses by kind, W."""
    @property
    def losses(self) -> TableLosses | None: ...
    @property
    def spin_loss_w(self) -> float | None:
        """What turns the input at this speed and temperature with nothing at the output, W: the spin loss."""
    @property
    def spin_loss(self) -> float | None: ...
    @property
    def spin_losses_w(self) -> TableLosses | None:
        """That by kind, W."""
    @property
    def spin_losses(self) -> TableLosses | None: ...
    @property
    def spin_sources(self) -> list[TableLossSource]:
        """That by source, the largest first."""
    @property
    def reason(self) -> str | None:
        """Why there is no efficiency."""
    @property
    def warnings(self) -> list[str]:
        """Warnings of the point under load: laws outside their ranges, the heat balance, limits."""

class TableShaftState(Record):
    """One state."""
    @property
    def input(self) -> str:
        """Where power enters."""
    @property
    def output(self) -> str:
        """Where it leaves."""
    @property
    def engaged(self) -> list[str]:
        """Shift elements that are closed."""
    @property
    def ratio(self) -> str | None:
        """``ω_input/ω_output``, exactly."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power, the input driving."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where the efficiencies of the meshes are given."""
    @property
    def reason(self) -> str | None:
        """Why speeds or torques are missing."""
    @property
    def why(self) -> Any | None:
        """What ``reason`` says, as data."""
    @property
    def members(self) -> Named[TableShaftMember]:
        """Every member, planets included."""
    @property
    def shift_elements(self) -> Named[TableShaftElement]:
        """Every shift element."""
    @property
    def sets(self) -> Named[Named[float]]:
        """Torque that each member puts into each set, or mesh of no set, over the input torque."""
    @property
    def at_load(self) -> TableAtLoad | None:
        """What it costs at a load and without one, where losses depend on that."""

class TableSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class TableDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> TableSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class TableAnswer(Answer):
    """Speeds and torques of a whole shift table: the results contract ``willis-table-1``."""
    @property
    def format(self) -> Literal["willis-table-1"]:
        """``willis-table-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def source(self) -> str | None:
        """Where its numbers come from."""
    @property
    def lossless(self) -> bool:
        """Whether torques are those without losses."""
    @property
    def states(self) -> Named[TableShaftState]:
        """Every state; the train as drawn where it has none."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""
    @property
    def diagnostics(self) -> list[TableDiagnostic]:
        """What to know beside it."""

class NewStart(Record):
    """A train file to start from."""
    @property
    def kind(self) -> str:
        """How it is asked for."""
    @property
    def about(self) -> str:
        """One line about it."""
    @property
    def toml(self) -> str:
        """The train file."""

class NewAnswer(Answer):
    """A train file to start from, or the kinds there are."""
    @property
    def format(self) -> Literal["willis-new-1"]:
        """``willis-new-1``."""
    @property
    def starts(self) -> list[NewStart]:
        """The kind that was asked for, or all."""

class CheckSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class CheckDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> CheckSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class CheckAnswer(Answer):
    """A train file without errors."""
    @property
    def format(self) -> Literal["willis-check-1"]:
        """``willis-check-1``."""
    @property
    def file(self) -> str:
        """The file."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def members(self) -> int:
        """How many members it has, planets included, without the frame."""
    @property
    def meshes(self) -> int:
        """How many meshes."""
    @property
    def shift_elements(self) -> int:
        """How many clutches, brakes and one-way clutches."""
    @property
    def states(self) -> int:
        """How many rows of the shift table."""
    @property
    def operations(self) -> int:
        """How many operating points."""
    @property
    def scenarios(self) -> int:
        """How many motions to simulate."""
    @property
    def studies(self) -> int:
        """How many sweeps."""
    @property
    def diagnostics(self) -> list[CheckDiagnostic]:
        """Warnings and notes, each with its place in the file."""

class FlowBandEnd(Record):
    """An end of a band, which ``--law`` reproduces."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def laws(self) -> Named[str]:
        """The law of each family in the band."""

class FlowFamilyBand(Record):
    """The laws of one family."""
    @property
    def law(self) -> str:
        """The law in force."""
    @property
    def in_range(self) -> bool:
        """Whether that is inside its range here."""
    @property
    def efficiencies(self) -> Named[float]:
        """The efficiency with each law that counts."""
    @property
    def beyond_ranges(self) -> bool:
        """Whether these are counted although fewer than two laws are inside their ranges."""
    @property
    def left_out(self) -> list[str]:
        """Laws that do not count: outside their ranges, or without one answer."""

class FlowLawBand(Record):
    """What an efficiency would be with other laws of loss: how far it is known.

    Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law
    of all kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce
    a published error, and those that leave a loss out, do not count. The oil temperature is held, and so are film,
    loss factor and load sharing, which belong to the law of friction."""
    @property
    def low(self) -> FlowBandEnd:
        """The lowest efficiency."""
    @property
    def high(self) -> FlowBandEnd:
        """The highest efficiency."""
    @property
    def families(self) -> Named[FlowFamilyBand]:
        """By family, what its laws give while the other families keep theirs."""

class FlowOutsideAt(Record):
    """A place where a law was used outside its range."""
    @property
    def name(self) -> str:
        """The mesh, bearing, seal, gear or rotor."""
    @property
    def value(self) -> float | None:
        """The value there, in the unit of the quantity; absent where it is not finite."""

class FlowOutsideLaw(Record):
    """A quantity outside the range of a law, wherever it was."""
    @property
    def family(self) -> str:
        """Family of the law."""
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""
    @property
    def low(self) -> float | None:
        """Lowest value of the range, in that unit; absent where there is none."""
    @property
    def high(self) -> float | None:
        """Highest value of the range, in that unit; absent where there is none."""
    @property
    def places(self) -> list[FlowOutsideAt]:
        """Where the law was used so."""

class FlowNode(Record):
    """A component, a contact, or an end of the graph."""
    @property
    def id(self) -> str:
        """Unique: kind and name, as in ``member:sun``, ``teeth:P1.sun-planet``, ``input:sun``; or ``frame``."""
    @property
    def kind(self) -> Literal["frame", "member", "teeth", "bearing", "seal", "gear", "rotor", "drag", "open-element", "pump", "shift-element", "coupling", "variator", "input", "output"]:
        """What it is."""
    @property
    def name(self) -> str:
        """Its name in the train."""
    @property
    def speed_rad_s(self) -> float | None:
        """Speed of a component, rad/s; absent when not determined."""
    @property
    def speed(self) -> float | None: ...
    @property
    def count(self) -> int:
        """Identical ones in parallel: tooth pairs, bearings."""
    @property
    def power_in_w(self) -> float:
        """Power that enters, W."""
    @property
    def power_in(self) -> float: ...
    @property
    def power_out_w(self) -> float:
        """Power that leaves, W."""
    @property
    def power_out(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """Loss in it, W."""
    @property
    def loss(self) -> float: ...
    @property
    def efficiency(self) -> float | None:
        """Outgoing over incoming absolute power; absent where none passes."""
    @property
    def carrier_frame_efficiency(self) -> float | None:
        """Of a tooth contact: efficiency of sliding seen from the carrier."""
    @property
    def residual_w(self) -> float:
        """Power in less power out less loss, W: round-off."""
    @property
    def residual(self) -> float: ...

class FlowEdge(Record):
    """Power, or only torque, between two nodes."""
    @property
    def to(self) -> str:
        """The node that it enters."""
    @property
    def member(self) -> str:
        """The component at one end, whose speed times the torque is the power."""
    @property
    def torque_n_m(self) -> float | None:
        """Torque that the component puts into the contact (at an input or output: external torque on the component), N
        m; absent where statics cannot divide it."""
    @property
    def torque(self) -> float | None: ...
    @property
    def power_w(self) -> float:
        """Power, W; 0 where the component stands still."""
    @property
    def power(self) -> float: ...
    @property
    def circulating_w(self) -> float:
        """The part of it that runs in loops, W."""
    @property
    def circulating(self) -> float: ...

class FlowLoop(Record):
    """Power that runs in a circle."""
    @property
    def power_w(self) -> float:
        """The power, W."""
    @property
    def power(self) -> float: ...
    @property
    def share_of_input(self) -> float:
        """Over the input power."""
    @property
    def nodes(self) -> list[str]:
        """Identifiers of the nodes it passes, in order; from the last it returns to the first."""
    @property
    def passes(self) -> list[str]:
        """The same seen from afar: names of shafts, sets and clutches."""
    @property
    def within(self) -> str | None:
        """The set, or ordinary pair, that it never leaves; or the sets it passes although none of them takes part in a
        circle as a whole ([``SolutionReport::recirculation``], which counts set by set). Such a loop depends on the
        frame in which powers are counted, not on how the train is coupled."""

class FlowStation(Record):
    """A node on a path."""
    @property
    def node(self) -> str:
        """Identifier of the node."""
    @property
    def efficiency(self) -> float:
        """Its efficiency for the power on paths: out over in, loops taken out; 1 for a component."""

class FlowPath(Record):
    """A way from an input to an output."""
    @property
    def share_of_input(self) -> float:
        """Part of the input power that takes it."""
    @property
    def efficiency(self) -> float:
        """Product of the efficiencies along it."""
    @property
    def delivered_w(self) -> float:
        """What arrives, W."""
    @property
    def delivered(self) -> float: ...
    @property
    def stations(self) -> list[FlowStation]:
        """The nodes along it, input and output included."""

class FlowHypergraph(Record):
    """The power flow of one equilibrium."""
    @property
    def seen_from(self) -> str | None:
        """The member from which speeds and powers are seen; absent where that is the housing."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power; 0 when everything is dissipated, absent when nothing is loaded."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where [``SolutionReport::efficiency_exact``] is known."""
    @property
    def input_power_w(self) -> float:
        """Power in, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def output_power_w(self) -> float:
        """Power out, W."""
    @property
    def output_power(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def power_residual_w(self) -> float:
        """Input less output less losses, W."""
    @property
    def power_residual(self) -> float: ...
    @property
    def largest_residual_w(self) -> float:
        """The largest residual of a node, W."""
    @property
    def largest_residual(self) -> float: ...
    @property
    def nodes(self) -> list[FlowNode]:
        """Frame, components, contacts, inputs and outputs."""
    @property
    def edges(self) -> list[FlowEdge]:
        """Powers between them."""
    @property
    def loops(self) -> list[FlowLoop]:
        """Power that runs in circles, largest first."""
    @property
    def paths(self) -> list[FlowPath]:
        """Ways from inputs to outputs, those that deliver most first, at most [``MOST_PATHS``]."""
    @property
    def path_count(self) -> int:
        """How many there are."""
    @property
    def share_on_paths(self) -> float:
        """Part of the input power that takes any of them; the rest is lost on its way where nothing is passed on."""

class FlowOperationFlow(Record):
    """The power flow of an operating point."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def state(self) -> str | None:
        """The state of the shift table."""
    @property
    def unit(self) -> str | None:
        """Where no operation describes the state: the member whose speed and torque are the units, 1 rad/s and 1 N m."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of it."""
    @property
    def reason(self) -> str | None:
        """One sentence that explains the verdict."""
    @property
    def band(self) -> FlowLawBand | None:
        """Between which values other laws put the efficiency, where [``FlowReport::with_bands``] asked."""
    @property
    def outside_laws(self) -> list[FlowOutsideLaw]:
        """Laws that were used outside their ranges."""
    @property
    def solutions(self) -> list[FlowHypergraph]:
        """Every equilibrium."""
    @property
    def dissipative_solutions(self) -> list[FlowHypergraph]:
        """Of a locked train: equilibria in which every loaded member must push."""

class FlowSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class FlowDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> FlowSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class FlowAnswer(Answer):
    """Power flows of a train: the results contract ``willis-flow-1``."""
    @property
    def format(self) -> Literal["willis-flow-1"]:
        """``willis-flow-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def source(self) -> str | None:
        """Source of its data."""
    @property
    def operations(self) -> list[FlowOperationFlow]:
        """The operating points."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given, and what the model leaves out."""
    @property
    def diagnostics(self) -> list[FlowDiagnostic]:
        """Warnings and notes."""

class LossesBandEnd(Record):
    """An end of a band, which ``--law`` reproduces."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def laws(self) -> Named[str]:
        """The law of each family in the band."""

class LossesFamilyBand(Record):
    """The laws of one family."""
    @property
    def law(self) -> str:
        """The law in force."""
    @property
    def in_range(self) -> bool:
        """Whether that is inside its range here."""
    @property
    def efficiencies(self) -> Named[float]:
        """The efficiency with each law that counts."""
    @property
    def beyond_ranges(self) -> bool:
        """Whether these are counted although fewer than two laws are inside their ranges."""
    @property
    def left_out(self) -> list[str]:
        """Laws that do not count: outside their ranges, or without one answer."""

class LossesLawBand(Record):
    """What an efficiency would be with other laws of loss: how far it is known.

    Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law
    of all kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce
    a published error, and those that leave a loss out, do not count. The oil temperature is held, and so are film,
    loss factor and load sharing, which belong to the law of friction."""
    @property
    def low(self) -> LossesBandEnd:
        """The lowest efficiency."""
    @property
    def high(self) -> LossesBandEnd:
        """The highest efficiency."""
    @property
    def families(self) -> Named[LossesFamilyBand]:
        """By family, what its laws give while the other families keep theirs."""

class LossesLosses(Record):
    """Losses by kind, W."""
    @property
    def mesh(self) -> float:
        """Tooth friction."""
    @property
    def bearing(self) -> float:
        """Bearings."""
    @property
    def windage(self) -> float:
        """Air and oil mist."""
    @property
    def churning(self) -> float:
        """Oil sump."""
    @property
    def seal(self) -> float:
        """Shaft seals."""
    @property
    def drag(self) -> float:
        """Drags that are given as torques."""
    @property
    def injection(self) -> float:
        """Oil that is sprayed into meshes."""
    @property
    def pump(self) -> float:
        """Oil pumps."""
    @property
    def variator(self) -> float:
        """Variators."""

class LossesLossSource(Record):
    """One place where power is lost."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its name in the list of laws; ``given`` for a given efficiency."""
    @property
    def loss_w(self) -> float:
        """The power, W."""
    @property
    def loss(self) -> float: ...
    @property
    def share(self) -> float:
        """The part of all losses."""

class LossesConvergence(Record):
    """How the agreement of losses and torques was reached."""
    @property
    def converged(self) -> bool:
        """Whether it was reached."""
    @property
    def rounds(self) -> int:
        """Rounds of statics and laws."""
    @property
    def error(self) -> float:
        """Bound on the error that is left, over the loss; the last change where nothing bounds it."""
    @property
    def contraction(self) -> float:
        """The factor by which the last rounds reduced it."""

class LossesOutsideAt(Record):
    """A place where a law was used outside its range."""
    @property
    def name(self) -> str:
        """The mesh, bearing, seal, gear or rotor."""
    @property
    def value(self) -> float | None:
        """The value there, in the unit of the quantity; absent where it is not finite."""

class LossesOutsideLaw(Record):
    """A quantity outside the range of a law, wherever it was."""
    @property
    def family(self) -> str:
        """Family of the law."""
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""
    @property
    def low(self) -> float | None:
        """Lowest value of the range, in that unit; absent where there is none."""
    @property
    def high(self) -> float | None:
        """Highest value of the range, in that unit; absent where there is none."""
    @property
    def places(self) -> list[LossesOutsideAt]:
        """Where the law was used so."""

class LossesLossPoint(Record):
    """One point."""
    @property
    def operation(self) -> str:
        """The operation it comes from."""
    @property
    def speed_of(self) -> str | None:
        """The member of the first prescribed speed."""
    @property
    def speed_rad_s(self) -> float:
        """Its speed, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def torque_of(self) -> str | None:
        """The member of the first load."""
    @property
    def torque_n_m(self) -> float | None:
        """Its torque, N m."""
    @property
    def torque(self) -> float | None: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature, K; absent without an oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def law(self) -> str | None:
        """The law in force, where laws are compared."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the point."""
    @property
    def reason(self) -> str | None:
        """One sentence that explains the verdict."""
    @property
    def why(self) -> Any | None:
        """What ``reason`` says, as data."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def band(self) -> LossesLawBand | None:
        """Between which values other laws put it, where [``LossRequest::bands``] asks."""
    @property
    def input_power_w(self) -> float:
        """Power in, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def losses_w(self) -> LossesLosses:
        """Losses by kind."""
    @property
    def losses(self) -> LossesLosses: ...
    @property
    def sources(self) -> list[LossesLossSource]:
        """Losses by source, largest first."""
    @property
    def friction(self) -> Named[float | None]:
        """Mean coefficient of friction of each mesh."""
    @property
    def convergence(self) -> LossesConvergence | None:
        """How losses and torques were brought into agreement."""
    @property
    def warnings(self) -> list[str]:
        """Warnings of this point."""
    @property
    def outside_laws(self) -> list[LossesOutsideLaw]:
        """Those of them that say that a law was used outside its range, as data."""

class LossesSpread(Record):
    """How far the laws of a family disagree at a point: the honest uncertainty of a prediction. Laws outside their
    range count only where fewer than two are inside; laws that reproduce a published error never count."""
    @property
    def least_w(self) -> list[Any]:
        """Smallest loss, W, and the law that gives it."""
    @property
    def least(self) -> list[Any]: ...
    @property
    def most_w(self) -> list[Any]:
        """Largest loss, W, and the law that gives it."""
    @property
    def most(self) -> list[Any]: ...
    @property
    def inside(self) -> int:
        """Laws that were used inside their ranges."""
    @property
    def laws(self) -> int:
        """Laws in all."""

class LossesAnswer(Answer):
    """Losses at the points asked for."""
    @property
    def format(self) -> Literal["willis-losses-1"]:
        """``willis-losses-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def family(self) -> str | None:
        """The family whose laws are compared."""
    @property
    def points(self) -> list[LossesLossPoint]:
        """The points, operation by operation, speed, load, temperature, law."""
    @property
    def spreads(self) -> list[LossesSpread]:
        """Where laws are compared: the spread over each group of points that differ in the law alone."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""

class HeatLossSource(Record):
    """One place where power is lost."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its name in the list of laws; ``given`` for a given efficiency."""
    @property
    def loss_w(self) -> float:
        """The power, W."""
    @property
    def loss(self) -> float: ...
    @property
    def share(self) -> float:
        """The part of all losses."""

class HeatCertificate(Record):
    """Why there are no other equilibria."""
    @property
    def method(self) -> Literal["elasticity", "branch-and-bound"]:
        """The argument."""
    @property
    def proved(self) -> bool:
        """Whether bounds prove it. Else the elasticity is taken to differ within an interval no more than it does from
        one interval to the next, or, where intervals were excluded, each heat to be monotone between the
        temperatures computed."""
    @property
    def largest_elasticity(self) -> float | None:
        """Largest elasticity of the losses between two temperatures; one equilibrium where it is below 1."""
    @property
    def temperatures(self) -> int:
        """Temperatures at which the losses were computed."""
    @property
    def widest_k(self) -> float:
        """Largest distance between two of them, K."""
    @property
    def widest(self) -> float: ...

class HeatHeatEquilibrium(Record):
    """An oil temperature at which losses and heat flow agree."""
    @property
    def oil_k(self) -> float:
        """The temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def stable(self) -> bool:
        """Whether the oil returns to it after a small disturbance."""
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def step_w(self) -> list[float] | None:
        """On the step of a law: heat that reaches the oil just below and just above it, W."""
    @property
    def step(self) -> list[float] | None: ...

class HeatPlaceReport(Record):
    """A place of the network."""
    @property
    def temperature_k(self) -> float:
        """Its temperature, K."""
    @property
    def temperature(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def share_to_oil(self) -> float:
        """Part of that heat that reaches the oil."""
    @property
    def given(self) -> bool:
        """Whether its temperature is given."""

class HeatHeatFlow(Record):
    """Heat on its way."""
    @property
    def between(self) -> list[str]:
        """From where to where."""
    @property
    def heat_w(self) -> float:
        """The heat, W; negative the other way round."""
    @property
    def heat(self) -> float: ...

class HeatHeatPoint(Record):
    """Heat at an oil temperature."""
    @property
    def oil_k(self) -> float:
        """Oil temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def reaching_w(self) -> float:
        """Heat that reaches the oil, W: computed there, or on a straight line between two temperatures at which it
        was."""
    @property
    def reaching(self) -> float: ...
    @property
    def carried_w(self) -> float:
        """Heat that leaves it, W."""
    @property
    def carried(self) -> float: ...

class HeatHeatReport(Record):
    """The temperatures of an operating point, and where its heat goes."""
    @property
    def oil_k(self) -> float:
        """Oil temperature in force, K."""
    @property
    def oil(self) -> float: ...
    @property
    def basis(self) -> Literal["balance", "given", "limit"]:
        """Where it comes from."""
    @property
    def verdict(self) -> Literal["unique", "several", "none-below-limit", "undecided"] | None:
        """What can be said of it; absent where it is given."""
    @property
    def certificate(self) -> HeatCertificate | None:
        """Why there is no other."""
    @property
    def equilibria(self) -> list[HeatHeatEquilibrium]:
        """Every oil temperature that holds, the coldest first."""
    @property
    def undecided_k(self) -> list[list[float]]:
        """Intervals in which it could not be decided, K."""
    @property
    def undecided(self) -> list[list[float]]: ...
    @property
    def ambient_k(self) -> float:
        """Temperature of the air, K."""
    @property
    def ambient(self) -> float: ...
    @property
    def limit_k(self) -> float:
        """Highest oil temperature allowed, K."""
    @property
    def limit(self) -> float: ...
    @property
    def margin_k(self) -> float:
        """Limit less oil temperature, K."""
    @property
    def margin(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Losses that become heat in the gearbox, W."""
    @property
    def heat(self) -> float: ...
    @property
    def extra_heat_w(self) -> float:
        """Heat into the oil beside the losses, W."""
    @property
    def extra_heat(self) -> float: ...
    @property
    def cooled_elsewhere_w(self) -> float:
        """Losses of variators, which have a cooling of their own, W."""
    @property
    def cooled_elsewhere(self) -> float: ...
    @property
    def residual_w(self) -> float:
        """Heat that reaches the oil less what leaves it, W: it warms where that is above zero."""
    @property
    def residual(self) -> float: ...
    @property
    def places(self) -> Named[HeatPlaceReport]:
        """Every place."""
    @property
    def paths(self) -> list[HeatHeatFlow]:
        """Every way for heat."""
    @property
    def cooler_w(self) -> float | None:
        """Heat that the cooler takes, W; negative where it heats."""
    @property
    def cooler(self) -> float | None: ...
    @property
    def curve(self) -> list[HeatHeatPoint]:
        """Heat that reaches the oil and what it gives off, over its temperature. What reaches it is computed at the
        temperatures that the balance looked at; between those it is a straight line. Points of studies have none."""
    @property
    def slope_w_k(self) -> float | None:
        """Change of what leaves the oil less what reaches it with its temperature, W/K; above zero where it is stable."""
    @property
    def slope_w(self) -> float | None: ...
    @property
    def time_constants_s(self) -> list[float]:
        """Time constants around this temperature, s, the slowest first; none without heat capacities."""
    @property
    def time_constants(self) -> list[float]: ...
    @property
    def drivers_change(self) -> bool:
        """Whether other gears drive when the oil is cold than when it is as hot as it may be."""

class HeatThermalRating(Record):
    """The largest load that the limit of the oil temperature allows, all torques and powers scaled together."""
    @property
    def status(self) -> Literal["found", "too-hot-without-load", "no-limit", "no-answer"]:
        """What can be said."""
    @property
    def load_factor(self) -> float | None:
        """Factor on the load of the operating point at which the oil has its limit."""
    @property
    def input_power_w(self) -> float | None:
        """Power in there, W: the thermal rating."""
    @property
    def input_power(self) -> float | None: ...
    @property
    def heat_w(self) -> float | None:
        """Heat in the gearbox there, W."""
    @property
    def heat(self) -> float | None: ...
    @property
    def carried_w(self) -> float:
        """Heat that is carried away at the limit, W."""
    @property
    def carried(self) -> float: ...

class HeatHeatRow(Record):
    """Temperatures at a time."""
    @property
    def time_s(self) -> float:
        """Time, s."""
    @property
    def time(self) -> float: ...
    @property
    def temperatures_k(self) -> list[float]:
        """Temperature of each place, K."""
    @property
    def temperatures(self) -> list[float]: ...
    @property
    def heat_w(self) -> float:
        """Heat made, W."""
    @property
    def heat(self) -> float: ...

class HeatWarmUp(Record):
    """Temperatures from a start on."""
    @property
    def start_k(self) -> float:
        """Oil temperature at the start, K."""
    @property
    def start(self) -> float: ...
    @property
    def places(self) -> list[str]:
        """Places, in the order of the temperatures of a row."""
    @property
    def rows(self) -> list[HeatHeatRow]:
        """Rows, evenly spaced in time."""
    @property
    def settled_s(self) -> float | None:
        """When the oil is within 1 K of where it tends to, s; absent where it is not in the time shown."""
    @property
    def settled(self) -> float | None: ...
    @property
    def limit_after_s(self) -> float | None:
        """When the oil passes its limit, s; rows end there."""
    @property
    def limit_after(self) -> float | None: ...
    @property
    def made_j(self) -> float:
        """Heat made, J."""
    @property
    def made(self) -> float: ...
    @property
    def carried_j(self) -> float:
        """Heat carried away, J."""
    @property
    def carried(self) -> float: ...
    @property
    def stored_j(self) -> float:
        """Heat stored, J."""
    @property
    def stored(self) -> float: ...
    @property
    def audit(self) -> float:
        """Heat made less carried less stored, over the largest of them: round-off."""
    @property
    def interpolation(self) -> float:
        """Largest difference of the losses from those between which they were interpolated, over them."""
    @property
    def steps(self) -> int:
        """Steps of the integration."""

class HeatOperationHeat(Record):
    """Heat of one operating point."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def state(self) -> str | None:
        """The state of the shift table."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the operating point at the oil temperature in force."""
    @property
    def reason(self) -> str | None:
        """Why there is no answer."""
    @property
    def input_power_w(self) -> float | None:
        """Power in, W."""
    @property
    def input_power(self) -> float | None: ...
    @property
    def efficiency(self) -> float | None:
        """Output over input power at that temperature."""
    @property
    def loss_w(self) -> float | None:
        """All losses there, W."""
    @property
    def loss(self) -> float | None: ...
    @property
    def sources(self) -> list[HeatLossSource]:
        """Losses by source there, largest first."""
    @property
    def heat(self) -> HeatHeatReport | None:
        """Temperatures, and where the heat goes."""
    @property
    def rating(self) -> HeatThermalRating | None:
        """Largest load at which the oil stays at its limit."""
    @property
    def warm_up(self) -> HeatWarmUp | None:
        """From a cold start on; none without heat capacities."""
    @property
    def no_warm_up(self) -> Literal["no-capacity", "no-answer", "too-fast"] | None:
        """Why there is no warm-up, where there is heat to tell of."""

class HeatDutyHeat(Record):
    """A duty cycle that repeats itself, in its steady state."""
    @property
    def basis(self) -> Literal["trace", "durations", "shares"]:
        """How rows weigh. The order of shares is not known: they are taken together, as one mean heat."""
    @property
    def rows_of_profile(self) -> int:
        """Rows of the profile."""
    @property
    def period_s(self) -> float:
        """One period, s."""
    @property
    def period(self) -> float: ...
    @property
    def without_answer_s(self) -> float:
        """Time of rows without an answer, s; they make no heat here."""
    @property
    def without_answer(self) -> float: ...
    @property
    def highest_k(self) -> float:
        """Highest oil temperature, K."""
    @property
    def highest(self) -> float: ...
    @property
    def lowest_k(self) -> float:
        """Lowest oil temperature, K."""
    @property
    def lowest(self) -> float: ...
    @property
    def mean_k(self) -> float:
        """Mean oil temperature over time, K."""
    @property
    def mean(self) -> float: ...
    @property
    def margin_k(self) -> float:
        """Limit less highest oil temperature, K."""
    @property
    def margin(self) -> float: ...
    @property
    def mean_heat_w(self) -> float:
        """Mean heat, W."""
    @property
    def mean_heat(self) -> float: ...
    @property
    def passes(self) -> int:
        """Passes until the end was the start; 0 where rows have no order."""
    @property
    def left_k(self) -> float:
        """Difference of start and end that is left, K."""
    @property
    def left(self) -> float: ...
    @property
    def audit(self) -> float:
        """Heat made less carried less stored, over the largest of them: the worst of all rows."""
    @property
    def places(self) -> list[str]:
        """Places, in the order of the temperatures of a row."""
    @property
    def rows(self) -> list[HeatHeatRow]:
        """Temperatures at the end of each row of the profile, the start before them."""

class HeatSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class HeatDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> HeatSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class HeatAnswer(Answer):
    """How warm a gearbox gets: the results contract ``willis-heat-1``."""
    @property
    def format(self) -> Literal["willis-heat-1"]:
        """``willis-heat-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def operations(self) -> list[HeatOperationHeat]:
        """Every operation asked for."""
    @property
    def duty(self) -> HeatDutyHeat | None:
        """What a duty cycle makes of it."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given, and what the model leaves out."""
    @property
    def diagnostics(self) -> list[HeatDiagnostic]:
        """Warnings and notes."""

class SensitivitySourceChange(Record):
    """What a quantity does to one loss."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its law."""
    @property
    def change_w(self) -> float:
        """Change for the step, W."""
    @property
    def change(self) -> float: ...

class SensitivityQuantitySensitivity(Record):
    """What one quantity does. Changes for a step are the derivative times the step: exact for small ones."""
    @property
    def name(self) -> str:
        """Its path, as the file has it: ``P1.geometry.module``, ``B1.radial_load``; of the operation what an
        [axis](crate::study::Axis) calls it: ``oil.temperature``, ``sun.speed``, ``sun.torque``."""
    @property
    def value(self) -> float:
        """Its value, SI."""
    @property
    def unit(self) -> str:
        """SI unit of the value."""
    @property
    def assumed(self) -> bool:
        """Whether it is not given but taken."""
    @property
    def together(self) -> list[str]:
        """Quantities of the same teeth that move with it, because alone it would contradict them: in proportion,
        profile shifts by as much."""
    @property
    def opposite(self) -> list[str]:
        """Profile shifts that move by as much the other way, because the centre distance is given."""
    @property
    def step(self) -> Literal["percent", "percent_less", "kelvin", "degree", "hundredth", "rpm", "tenth_millimetre", "unit"]:
        """The step for which changes are told."""
    @property
    def step_size(self) -> float:
        """That step, SI; negative where it is one to less."""
    @property
    def efficiency_derivative(self) -> float | None:
        """``dη/dq``, over the SI unit of the value."""
    @property
    def loss_derivative_w(self) -> float:
        """``dP_loss/dq``, W over the SI unit of the value."""
    @property
    def loss_derivative(self) -> float: ...
    @property
    def efficiency_change(self) -> float | None:
        """Change of the efficiency for the step."""
    @property
    def loss_change_w(self) -> float:
        """Change of all losses for the step, W."""
    @property
    def loss_change(self) -> float: ...
    @property
    def oil_derivative(self) -> float | None:
        """``dT_oil/dq``, K over the SI unit of the value, where the oil temperature follows."""
    @property
    def oil_change_k(self) -> float | None:
        """Change of the oil temperature for the step, K."""
    @property
    def oil_change(self) -> float | None: ...
    @property
    def loss_elasticity(self) -> float | None:
        """``(dP_loss/P_loss)/(dq/q)``: percent of loss for one percent of the quantity; absent for temperatures,
        angles and shifts."""
    @property
    def sources(self) -> list[SensitivitySourceChange]:
        """The losses that it moves, the one that changes most first."""

class SensitivityBoundary(Record):
    """A boundary of the region in which the present loss formula holds."""
    @property
    def member(self) -> str:
        """The member whose prescribed value moves."""
    @property
    def value(self) -> float:
        """Its value now, SI."""
    @property
    def boundary(self) -> float:
        """Its value on the boundary, SI."""
    @property
    def mesh(self) -> str:
        """The mesh that is unloaded, or stops moving, there."""

class SensitivityLockMargin(Record):
    """The nearest self-locking threshold of one efficiency."""
    @property
    def meshes(self) -> list[str]:
        """The mesh, or the meshes in a row that share one efficiency."""
    @property
    def efficiency(self) -> float:
        """Their efficiency now."""
    @property
    def threshold(self) -> float:
        """The efficiency at which the train locks."""

class SensitivityMargin(Record):
    """How far a solution is from a change."""
    @property
    def torque(self) -> SensitivityBoundary | None:
        """The smallest change of a prescribed torque that unloads a mesh (and beyond which another loss formula
        holds)."""
    @property
    def speed(self) -> SensitivityBoundary | None:
        """The smallest change of a prescribed speed that stops the relative motion in a mesh."""
    @property
    def lock(self) -> SensitivityLockMargin | None:
        """The mesh (or set) whose efficiency is nearest to the value at which the train locks."""
    @property
    def lock_loss_factor(self) -> float | None:
        """The factor on all losses ``1 − η`` of basic efficiencies, those of whole sets, at which the train locks."""

class SensitivityChecks(Record):
    """How far derivatives are settled."""
    @property
    def balance_residual(self) -> float:
        """Largest derivative of input less output less losses, over the largest of the three: round-off."""
    @property
    def rounds(self) -> int:
        """Most rounds of laws and statics that one quantity took."""
    @property
    def error(self) -> float:
        """Bound on the error that was left, over the largest derivative of a loss: the worst of all quantities."""

class SensitivityOperationSensitivity(Record):
    """What every input does at one operating point."""
    @property
    def name(self) -> str:
        """Name of the operation."""
    @property
    def state(self) -> str | None:
        """The state of the shift table, if not as drawn."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the operation. There are derivatives only where it is ``unique``."""
    @property
    def reason(self) -> str | None:
        """Why there are no derivatives."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power; absent where nothing comes in."""
    @property
    def efficiency_exact(self) -> str | None:
        """The same exactly, where it is known."""
    @property
    def input_power_w(self) -> float:
        """Power in at all inputs, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def oil_k(self) -> float | None:
        """Oil temperature, K, where the train says what carries heat away."""
    @property
    def oil(self) -> float | None: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def quantities(self) -> list[SensitivityQuantitySensitivity]:
        """Every quantity that moves a loss, the one with the largest effect first."""
    @property
    def without_effect(self) -> list[str]:
        """Quantities on which no loss depends here."""
    @property
    def without_derivative(self) -> list[list[Any]]:
        """Quantities without a derivative here, each with the reason."""
    @property
    def margin(self) -> SensitivityMargin | None:
        """How far the point is from another driving end, and from locking."""
    @property
    def checks(self) -> SensitivityChecks | None:
        """How far the derivatives are settled."""
    @property
    def notes(self) -> list[str]:
        """What must be known to read the numbers."""

class SensitivitySpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class SensitivityDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> SensitivitySpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class SensitivityAnswer(Answer):
    """What every input does to efficiency and losses: the results contract ``willis-sensitivity-1``."""
    @property
    def format(self) -> Literal["willis-sensitivity-1"]:
        """``willis-sensitivity-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def operations(self) -> list[SensitivityOperationSensitivity]:
        """Every operation asked for."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""
    @property
    def diagnostics(self) -> list[SensitivityDiagnostic]:
        """Warnings and notes of the operations."""

class UncertaintyAnswer(Answer):
    """How sure a number is, and the samples that say so."""

class CalibrateCalibratedPart(Record):
    """The factor on a kind of loss."""
    @property
    def key(self) -> str:
        """Its key in ``[losses.factor]``."""
    @property
    def name(self) -> str:
        """For people."""
    @property
    def factor(self) -> float:
        """The factor on the law."""
    @property
    def spread(self) -> float:
        """Standard deviation of its logarithm."""
    @property
    def band(self) -> list[float]:
        """Its 90 % band."""
    @property
    def prior(self) -> float:
        """Standard deviation of the logarithm before the tests."""
    @property
    def learnt(self) -> float:
        """Part of the variance of the prior that the tests took away."""
    @property
    def at_bound(self) -> bool:
        """Whether it is at the largest factor that is allowed."""

class CalibrateMeterOffset(Record):
    """The offset of a torque meter."""
    @property
    def member(self) -> str:
        """Where it measures."""
    @property
    def group(self) -> str:
        """The group of tests."""
    @property
    def offset_n_m(self) -> float:
        """What it shows too much, N m, in the direction in which power goes in."""
    @property
    def offset(self) -> float: ...
    @property
    def spread_n_m(self) -> float:
        """Standard deviation, N m."""
    @property
    def spread(self) -> float: ...
    @property
    def prior_n_m(self) -> float:
        """Standard deviation before the tests, N m."""
    @property
    def prior(self) -> float: ...

class CalibrateBlindChange(Record):
    """The change of one parameter."""
    @property
    def name(self) -> str:
        """The kind of loss, or the meter."""
    @property
    def change(self) -> float:
        """Of a kind of loss, as a part of it; of a meter its offset, N m."""
    @property
    def meter(self) -> bool:
        """Whether it is the offset of a meter."""

class CalibrateBlindDirection(Record):
    """A combination of parameters that the tests do not see."""
    @property
    def information(self) -> float:
        """What the tests tell of it over what the prior does: below 1."""
    @property
    def changes(self) -> list[CalibrateBlindChange]:
        """Changes that leave every test as it is, the largest first."""

class CalibrateTestResidual(Record):
    """A test beside its prediction."""
    @property
    def line(self) -> int:
        """Its line in the data."""
    @property
    def group(self) -> str:
        """Its group."""
    @property
    def condition(self) -> str:
        """How it ran."""
    @property
    def measured_w(self) -> float:
        """Measured loss, W."""
    @property
    def measured(self) -> float: ...
    @property
    def sigma_w(self) -> float:
        """Its standard deviation, W."""
    @property
    def sigma(self) -> float: ...
    @property
    def before_w(self) -> float:
        """Loss of the laws as they are, W."""
    @property
    def before(self) -> float: ...
    @property
    def predicted_w(self) -> float:
        """Predicted loss with the factors and offsets, W."""
    @property
    def predicted(self) -> float: ...
    @property
    def residual(self) -> float:
        """Measured less predicted, over the standard deviation."""
    @property
    def left_out(self) -> float:
        """The same from a fit without this test."""
    @property
    def weight(self) -> float:
        """Its weight: 1 and more for a reading that fits, towards 0 for an outlier."""
    @property
    def outlier(self) -> bool:
        """Whether it is an outlier: a weight below 0.2."""

class CalibratePredictedLoss(Record):
    """The loss of an operation of the file."""
    @property
    def operation(self) -> str:
        """The operation."""
    @property
    def before_w(self) -> float:
        """Loss of the laws as they are, W."""
    @property
    def before(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """Loss with the factors, W."""
    @property
    def loss(self) -> float: ...
    @property
    def spread_w(self) -> float:
        """Standard deviation from what the tests leave open of the factors, W."""
    @property
    def spread(self) -> float: ...
    @property
    def band_w(self) -> list[float]:
        """90 % band, with what the laws miss between groups, W."""
    @property
    def band(self) -> list[float]: ...
    @property
    def outside(self) -> list[list[Any]]:
        """Quantities that lie outside what was tested, each with its value and the tested range, SI."""

class CalibrateNextTest(Record):
    """A test that would teach something."""
    @property
    def condition(self) -> str:
        """How it runs."""
    @property
    def gain(self) -> float:
        """By how much it would lower the logarithm of what is possible for all parameters."""
    @property
    def lowers_variance(self) -> float:
        """By what part it would lower the variance of the losses of the file's operations."""

class CalibrateAnswer(Answer):
    """What tests say of the laws: the results contract ``willis-calibrate-1``."""
    @property
    def format(self) -> Literal["willis-calibrate-1"]:
        """``willis-calibrate-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def tests(self) -> int:
        """Tests."""
    @property
    def groups(self) -> int:
        """Groups of tests."""
    @property
    def parts(self) -> list[CalibrateCalibratedPart]:
        """The factors."""
    @property
    def covariance(self) -> list[list[float]]:
        """Covariance of their logarithms, in the order of ``parts``."""
    @property
    def offsets(self) -> list[CalibrateMeterOffset]:
        """Offsets of torque meters."""
    @property
    def learnt(self) -> int:
        """Combinations of parameters of which the tests tell more than the prior, of all."""
    @property
    def combinations(self) -> int:
        """How many combinations there are: as many as parameters."""
    @property
    def blind(self) -> list[CalibrateBlindDirection]:
        """Combinations that the tests do not tell from each other."""
    @property
    def without_effect(self) -> list[str]:
        """Kinds of loss that no test has; they keep their factor."""
    @property
    def misfit(self) -> float:
        """Square of how much larger the residuals are than the stated noise, from the tests that parameters do not use
        up: 1 where the laws fit. Outliers have little say."""
    @property
    def inflation(self) -> float:
        """Factor on the variance of the noise because the laws do not fit within what was stated; 1 where they do."""
    @property
    def group_misfit(self) -> float:
        """Root mean square of what the laws miss in a group that was left out, over the loss; at least 3 %."""
    @property
    def inside_band(self) -> int:
        """Tests that are inside the 90 % band of the others, of all."""
    @property
    def residuals(self) -> list[CalibrateTestResidual]:
        """Every test."""
    @property
    def predictions(self) -> list[CalibratePredictedLoss]:
        """Loss of each operation of the file, before and after."""
    @property
    def next(self) -> list[CalibrateNextTest]:
        """Tests that would teach most, the best first."""
    @property
    def converged(self) -> bool:
        """Whether the estimate was found; without one there is no answer."""
    @property
    def train_file(self) -> str:
        """The train file with the factors."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""

class SweepAnswer(_answer.Sweep):
    """A sweep: what its points say together, and the points themselves."""

class CycleAnswer(_answer.Cycle):
    """A duty cycle: its energies, and its rows."""

class CompareVariant(Record):
    """A variant."""
    @property
    def label(self) -> str:
        """``A``, ``B``, …"""
    @property
    def file(self) -> str:
        """What it is called, a file."""
    @property
    def train(self) -> str:
        """Name of its train."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""

class CompareTextDifference(Record):
    """A key in which files differ, or a prescription in which operations do."""
    @property
    def path(self) -> str:
        """The path of the key, or what is prescribed."""
    @property
    def values(self) -> list[str | None]:
        """The values as written, one for each variant; absent where it has none."""

class CompareDifference(Record):
    """A result in which variants differ."""
    @property
    def quantity(self) -> str:
        """What it is."""
    @property
    def unit(self) -> Literal["", "efficiency", "W", "N m", "rad/s", "Pa"]:
        """Its unit."""
    @property
    def values(self) -> list[None | float | str]:
        """One value for each variant."""
    @property
    def differences(self) -> list[float | None]:
        """Value less that of the first variant."""
    @property
    def relative(self) -> list[float | None]:
        """The difference over the first variant's value; of an efficiency over what it lacks to 1."""
    @property
    def size(self) -> float:
        """How large the difference is, 0 to 1: largest over the larger value, efficiencies measured by what they lack
        to 1; 2 where words differ or a value is missing."""

class CompareCompared(Record):
    """A state or an operation in all variants that have it."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def missing_in(self) -> list[str]:
        """Labels of the variants that do not have it."""
    @property
    def prescribed(self) -> list[CompareTextDifference]:
        """What the variants prescribe differently: results are then those of different points."""
    @property
    def differences(self) -> list[CompareDifference]:
        """Results that differ, largest first."""
    @property
    def equal(self) -> int:
        """How many results are equal."""
    @property
    def reasons(self) -> list[list[Any]]:
        """Why a variant has no answer: label and reason."""

class CompareMapPlace(Record):
    """A place on a map."""
    @property
    def difference(self) -> float:
        """Value less that of the first variant."""
    @property
    def first(self) -> float:
        """Value of the first variant."""
    @property
    def other(self) -> float:
        """Value of the other."""
    @property
    def place(self) -> str:
        """The point in words."""

class CompareMapDifference(Record):
    """A difference over many points."""
    @property
    def better(self) -> int:
        """Points at which the other variant is better."""
    @property
    def worse(self) -> int:
        """Points at which it is worse."""
    @property
    def equal(self) -> int:
        """Points at which both are equal."""
    @property
    def mean(self) -> float | None:
        """Mean of its value less that of the first."""
    @property
    def most_better(self) -> CompareMapPlace | None:
        """Where it is better by most."""
    @property
    def most_worse(self) -> CompareMapPlace | None:
        """Where it is worse by most."""

class CompareBand(Record):
    """Efficiency along a part of an axis."""
    @property
    def axis(self) -> str:
        """The axis."""
    @property
    def to(self) -> str:
        """Last value."""
    @property
    def better(self) -> int:
        """Points at which the other variant is the more efficient."""
    @property
    def worse(self) -> int:
        """Points at which it is the less efficient."""
    @property
    def equal(self) -> int:
        """Points at which both are equal."""
    @property
    def mean(self) -> float | None:
        """Mean of its efficiency less that of the first."""

class CompareMapPair(Record):
    """The first variant and another over the same axes."""
    @property
    def first(self) -> str:
        """Label of the first."""
    @property
    def other(self) -> str:
        """Label of the other."""
    @property
    def compared(self) -> int:
        """Points at which both have one answer."""
    @property
    def only_first(self) -> int:
        """Points at which only the first has one."""
    @property
    def only_other(self) -> int:
        """Points at which only the other has one."""
    @property
    def neither(self) -> int:
        """Points at which neither has one."""
    @property
    def efficiency(self) -> CompareMapDifference:
        """Of the efficiency."""
    @property
    def loss_w(self) -> CompareMapDifference:
        """Of the loss, W."""
    @property
    def loss(self) -> CompareMapDifference: ...
    @property
    def bands(self) -> list[CompareBand]:
        """Efficiency along each axis."""

class CompareMapComparison(Record):
    """Variants over the same axes."""
    @property
    def over(self) -> list[str]:
        """The axes as they were written."""
    @property
    def points(self) -> int:
        """How many points."""
    @property
    def operations(self) -> list[str]:
        """The operation from which each variant starts."""
    @property
    def prescribed(self) -> list[CompareTextDifference]:
        """What these prescribe differently, where no axis sets it."""
    @property
    def pairs(self) -> list[CompareMapPair]:
        """The first variant with each other."""

class CompareAnswer(Answer):
    """Variants side by side. Serialised it is the contract ``willis-compare-1``."""
    @property
    def format(self) -> Literal["willis-compare-1"]:
        """``willis-compare-1``."""
    @property
    def variants(self) -> list[CompareVariant]:
        """The variants."""
    @property
    def identical(self) -> bool:
        """Whether all files say the same."""
    @property
    def states(self) -> list[CompareCompared]:
        """The shift tables, state by state, largest difference first."""
    @property
    def operations(self) -> list[CompareCompared]:
        """The operations by their names, largest difference first."""
    @property
    def map(self) -> CompareMapComparison | None:
        """Over axes, where asked for."""

class RegimesSymbolReport(Record):
    """A symbol of the formulas."""
    @property
    def value(self) -> float | None:
        """Value in this train, for ratios and efficiencies."""
    @property
    def exact(self) -> str | None:
        """The same, exactly."""
    @property
    def meaning(self) -> str:
        """What it stands for, in words."""
    @property
    def latex(self) -> str:
        """In LaTeX."""

class RegimesPlaneReport(Record):
    """A plane through the origin of the speed space."""
    @property
    def label(self) -> str:
        """What is the case on it: ``sun1 at rest``."""
    @property
    def at_rest(self) -> list[str]:
        """Terminals at rest on it."""
    @property
    def without_relative_motion(self) -> list[str]:
        """Elements without relative motion on it."""
    @property
    def form(self) -> list[float]:
        """Coefficients of the base speeds."""

class RegimesRatioRange(Record):
    """An interval of a speed ratio."""
    @property
    def of(self) -> str:
        """The quotient, such as ``w_ring/w_engine``."""
    @property
    def denominator_sign(self) -> int:
        """Sign of the denominator."""
    @property
    def low(self) -> float | None:
        """Lower bound."""
    @property
    def high(self) -> float | None:
        """Upper bound."""

class RegimesPrescribed(Record):
    """What a torque prescribed on one terminal leads to."""
    @property
    def terminal(self) -> str:
        """The terminal."""
    @property
    def positive(self) -> list[str]:
        """Regimes with a positive torque on it."""
    @property
    def negative(self) -> list[str]:
        """Regimes with a negative torque on it."""

class RegimesRegionReport(Record):
    """A region of speeds."""
    @property
    def number(self) -> int:
        """Its number, from 1."""
    @property
    def order(self) -> list[str]:
        """The order of the speeds, one chain for each element: ``w_4 > w_1 > 0 > w_2``."""
    @property
    def signs(self) -> list[int]:
        """The side of each plane it lies on."""
    @property
    def example(self) -> Named[float]:
        """Speeds inside it, by terminal."""
    @property
    def to(self) -> list[float] | None:
        """See ``from``."""
    @property
    def ratio(self) -> RegimesRatioRange | None:
        """Two freedoms, and no sign change of the first base speed inside: bounds of second over first base speed;
        absent means infinite."""
    @property
    def bounded_by(self) -> list[str]:
        """Planes that bound it."""
    @property
    def opposite(self) -> int:
        """The region of all opposite speeds."""
    @property
    def prescribed(self) -> list[RegimesPrescribed]:
        """One independent torque: which regimes answer a torque prescribed on each terminal."""

class RegimesExamplePoint(Record):
    """An operating point."""
    @property
    def speeds(self) -> Named[float]:
        """Speeds by terminal, in any unit."""
    @property
    def torques(self) -> Named[float]:
        """Torques by terminal, in any unit."""
    @property
    def efficiency(self) -> float:
        """Efficiency there; zero when all is dissipated."""
    @property
    def efficiency_exact(self) -> str:
        """The same, exactly."""

class RegimesNeighbour(Record):
    """A regime across a plane."""
    @property
    def plane(self) -> str:
        """The plane between."""
    @property
    def regime(self) -> str:
        """The regime there."""

class RegimesRegimeReport(Record):
    """One regime."""
    @property
    def id(self) -> str:
        """Its name: number of the region, and the torque cell (``+`` or ``-`` for the sign of the first torque that is
        not zero, else a number)."""
    @property
    def region(self) -> int:
        """Number of the region of speeds."""
    @property
    def torque_signs(self) -> Named[int]:
        """Sign of each terminal's torque."""
    @property
    def roles(self) -> Named[Literal["input", "output", "fixed", "idle"]]:
        """What each terminal does."""
    @property
    def inputs(self) -> list[str]:
        """Terminals where power enters."""
    @property
    def outputs(self) -> list[str]:
        """Terminals where power leaves."""
    @property
    def drivers(self) -> Named[str | None]:
        """Which end drives each element, seen from its carrier; absent when it carries no load or has no relative
        motion or loss."""
    @property
    def formula(self) -> str:
        """Name of its formula."""
    @property
    def efficiency_range(self) -> list[float] | None:
        """Efficiencies between which it lies: the limits on the two bounding directions (two freedoms), or twice the
        same number (one freedom)."""
    @property
    def example(self) -> RegimesExamplePoint:
        """An operating point inside."""
    @property
    def mirror(self) -> str:
        """The regime with all speeds and torques reversed."""
    @property
    def by_friction_only(self) -> bool:
        """Without friction no torques of these signs exist here: friction has turned one round."""
    @property
    def all_dissipated(self) -> bool:
        """Every loaded terminal is an input."""
    @property
    def neighbours(self) -> list[RegimesNeighbour]:
        """Regimes across each bounding plane whose torques have the same signs."""

class RegimesConditionReport(Record):
    """A condition of a formula."""
    @property
    def positive(self) -> str:
        """An expression that must be positive."""
    @property
    def meaning(self) -> str:
        """What it ensures."""

class RegimesThreshold(Record):
    """The open interval of one ratio or efficiency in which the torque signs of a formula hold, all others as they
    are."""
    @property
    def symbol(self) -> str:
        """The symbol."""
    @property
    def value(self) -> float:
        """Its value."""
    @property
    def low(self) -> float | None:
        """Lower bound; absent when there is none."""
    @property
    def high(self) -> float | None:
        """Upper bound; absent when there is none."""

class RegimesFormulaReport(Record):
    """A closed formula."""
    @property
    def id(self) -> str:
        """Its name, ``F1``."""
    @property
    def roles(self) -> str:
        """Inputs and outputs it belongs to."""
    @property
    def drivers(self) -> str:
        """Drivers it belongs to."""
    @property
    def efficiency(self) -> str:
        """Output over input power."""
    @property
    def efficiency_by_loss(self) -> str | None:
        """The same by the losses over the power of the only input or output, where there is one."""
    @property
    def efficiency_latex(self) -> str:
        """The first in LaTeX."""
    @property
    def loss(self) -> str:
        """Power lost, as a sum over the elements that drive."""
    @property
    def torques(self) -> Named[str]:
        """Torques of the terminals."""
    @property
    def conditions(self) -> list[RegimesConditionReport]:
        """Positive throughout the regimes, and nowhere else."""
    @property
    def holds_for(self) -> list[RegimesThreshold]:
        """Where basic ratios and efficiencies must lie for the torques to have these signs."""
    @property
    def regimes(self) -> list[str]:
        """Regimes in which it holds."""

class RegimesCrossing(Record):
    """A regime's passage over a boundary."""
    @property
    def to(self) -> str:
        """Regime after."""
    @property
    def efficiency_before(self) -> float | None:
        """Limit of the efficiency, coming from before."""
    @property
    def efficiency_before_exact(self) -> str | None:
        """The same, exactly."""
    @property
    def efficiency_after(self) -> float | None:
        """Limit of the efficiency, coming from after."""
    @property
    def efficiency_after_exact(self) -> str | None:
        """The same, exactly."""
    @property
    def changes(self) -> list[str]:
        """What changes, in words."""

class RegimesBoundaryReport(Record):
    """The boundary between two neighbouring regions of a train with two freedoms."""
    @property
    def label(self) -> str:
        """What is the case on it."""
    @property
    def direction(self) -> list[float]:
        """Direction, in base speeds."""
    @property
    def speeds(self) -> Named[float]:
        """Speeds on it, by terminal."""
    @property
    def between(self) -> list[int]:
        """Regions on its two sides, counterclockwise."""
    @property
    def crossings(self) -> list[RegimesCrossing]:
        """What happens to each torque cell."""

class RegimesAssignmentReport(Record):
    """An assignment of inputs and outputs."""
    @property
    def inputs(self) -> list[str]:
        """Terminals where power enters."""
    @property
    def outputs(self) -> list[str]:
        """Terminals where power leaves."""
    @property
    def regimes(self) -> list[str]:
        """Regimes that realise it; none when it cannot be reached."""
    @property
    def reach(self) -> Literal["reached", "reached where friction turns a torque round, and nowhere else", "only because friction turns a torque round", "reached: friction takes everything", "cannot be reached: friction never takes everything", "cannot be reached: friction prevents it (without losses it exists)", "cannot be reached: speeds and torques never have these signs together"]:
        """How it is reached, or why not."""

class RegimesNobasis(Record):
    """No operation that says so has exactly one equilibrium; these were tried."""

class RegimesEfficiencyBasis(Record):
    """Where the efficiencies of meshes come from whose losses laws compute.

    # Example `````` use willis::regimes::{RegimeSelection, regimes}; use willis::train::Train;

    let train = Train::from_toml(r#"     format = 1     name = "one set"     members = ["s", "c"]     terminals =
    ["s", "c"]     [oil]     name = "ISO VG 220"     temperature = "70 degC"     [[set]]     name = "P1"     sun = {
    member = "s", teeth = 30 }     planet = { teeth = 20, count = 4 }     ring = { member = "frame", teeth = 70 }
    carrier = "c"     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }     [[operation]]
    name = "full load"     speeds = { s = "1000 rpm" }     torques = { s = "200 N m" } "#)?; let all =
    regimes(&train, &RegimeSelection::default())?; let basis = all.states[0].efficiency_basis.as_ref().unwrap();
    assert!(basis.is_at_load()); assert!(basis.efficiencies.iter().all(|(_, eta)| *eta < 1.0)); # Ok::<(),
    willis::Diagnostics>(()) ``````"""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose load it is; absent where the request gives the point, and of nominal
        efficiencies."""
    @property
    def speeds_rad_s(self) -> Named[float]:
        """Speed of each member that is loaded from outside there, rad/s. Nothing of nominal efficiencies."""
    @property
    def speeds(self) -> Named[float]: ...
    @property
    def torques_n_m(self) -> Named[float]:
        """Torque on each of them, N m."""
    @property
    def torques(self) -> Named[float]: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature there, K: prescribed, of the heat balance, or of the oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def efficiencies(self) -> Named[float]:
        """Efficiency of each mesh whose losses are computed, with what bearings lose by its load; to six decimals, the
        same whichever gear drives."""
    @property
    def nominal(self) -> list[str]:
        """Meshes that carry nothing or do not move there: theirs are nominal."""
    @property
    def reason(self) -> Literal["no-operation"] | RegimesNobasis | None:
        """Why all are nominal."""
    @property
    def nominal_friction(self) -> float:
        """The coefficient of friction that nominal efficiencies are made with."""

class RegimesLinkReport(Record):
    """A way for power beside the gears."""
    @property
    def variator(self) -> str | None:
        """The variator; absent where two terminals were asked to balance."""
    @property
    def ends(self) -> list[str]:
        """Its two ends, among the terminals; they are no inputs or outputs."""
    @property
    def efficiency(self) -> list[float]:
        """From the first end to the second, and back."""

class RegimesAtlas(Record):
    """The regimes of one state."""
    @property
    def state(self) -> str:
        """Name of the state, or ``as drawn``."""
    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom."""
    @property
    def terminals(self) -> list[str]:
        """Members on which a torque acts."""
    @property
    def held(self) -> list[str]:
        """Terminals that are held: they take torque, but no power."""
    @property
    def independent_torques(self) -> int:
        """Independent terminal torques."""
    @property
    def base_speeds(self) -> list[str]:
        """Terminals whose speeds settle all others."""
    @property
    def reason(self) -> str | None:
        """Why there is nothing to list."""
    @property
    def symbols(self) -> Named[RegimesSymbolReport]:
        """What the formulas' symbols stand for."""
    @property
    def planes(self) -> list[RegimesPlaneReport]:
        """The planes that cut the speed space."""
    @property
    def regions(self) -> list[RegimesRegionReport]:
        """The regions of speed, in order around the circle for two freedoms."""
    @property
    def regimes(self) -> list[RegimesRegimeReport]:
        """The regimes."""
    @property
    def formulas(self) -> list[RegimesFormulaReport]:
        """Their formulas, each once."""
    @property
    def boundaries(self) -> list[RegimesBoundaryReport]:
        """The boundaries between neighbouring regions (two freedoms)."""
    @property
    def assignments(self) -> list[RegimesAssignmentReport]:
        """Every assignment of inputs and outputs, and whether it can be reached."""
    @property
    def efficiency_basis(self) -> RegimesEfficiencyBasis | None:
        """Where mesh efficiencies come from whose losses laws compute; absent where all are given."""
    @property
    def lossless(self) -> list[str]:
        """Elements without loss: it does not matter who drives them."""
    @property
    def link(self) -> RegimesLinkReport | None:
        """Terminals through which power runs beside the gears: the sides of a variator, or two that were asked to
        balance."""
    @property
    def notes(self) -> list[str]:
        """What else a reader must know."""

class RegimesCase(Record):
    """A range of basic ratios."""
    @property
    def label(self) -> str:
        """``R > 1/eta``."""
    @property
    def latex(self) -> str:
        """In LaTeX."""
    @property
    def low(self) -> float | None:
        """Lower bound of R."""
    @property
    def high(self) -> float | None:
        """Upper bound of R."""
    @property
    def band(self) -> bool:
        """Between a self-locking limit and 1: not in the paper."""
    @property
    def here(self) -> bool:
        """Whether this train lies in it."""
    @property
    def example(self) -> float:
        """A ratio in it."""

class RegimesFamilyRange(Record):
    """Signs of torques and order of speeds."""
    @property
    def torque_signs(self) -> Named[int]:
        """Sign of each terminal's torque."""
    @property
    def order(self) -> list[str]:
        """Terminals and ``0``, from the fastest down."""
    @property
    def efficiency(self) -> float:
        """Efficiency at the example ratio, at speeds in the middle of the range."""

class RegimesGroup(Record):
    """Regimes with one driver and so one formula."""
    @property
    def driver(self) -> str:
        """The end that drives, seen from the carrier."""
    @property
    def loss(self) -> str:
        """The loss over the input power, ``l = η − 1``, in the paper's notation."""
    @property
    def loss_latex(self) -> str:
        """The same in LaTeX."""
    @property
    def ranges(self) -> list[RegimesFamilyRange]:
        """Torque signs and order of speeds, in pairs of mirror images."""

class RegimesRow(Record):
    """An assignment of inputs and outputs."""
    @property
    def inputs(self) -> list[str]:
        """Terminals where power enters."""
    @property
    def outputs(self) -> list[str]:
        """Terminals where power leaves."""
    @property
    def cells(self) -> list[list[RegimesGroup]]:
        """For each range of R, the regimes in groups that share a formula."""

class RegimesAnswer(Answer):
    """Regimes of a train, or of one set over all its basic ratios."""
    @property
    def format(self) -> Literal["willis-family-1"]:
        """``willis-family-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def states(self) -> list[RegimesAtlas]:
        """One for each state asked for."""
    @property
    def ends(self) -> list[str]:
        """The ends of the set, p and q, and its carrier."""
    @property
    def carrier(self) -> str:
        """See ``ends``."""
    @property
    def ratio(self) -> str:
        """What R is."""
    @property
    def value(self) -> float:
        """R of this train."""
    @property
    def exact(self) -> str:
        """The same, exactly."""
    @property
    def efficiencies(self) -> list[float]:
        """Efficiency seen from the carrier, p driving and q driving."""
    @property
    def cases(self) -> list[RegimesCase]:
        """The ranges of R."""
    @property
    def rows(self) -> list[RegimesRow]:
        """The assignments of inputs and outputs, in the paper's order, with their regimes in each range."""
    @property
    def regimes(self) -> int:
        """Number of regimes in all ranges."""
    @property
    def efficiency_basis(self) -> RegimesEfficiencyBasis | None:
        """Where mesh efficiencies come from whose losses laws compute; absent where all are given."""

class FormulaWritten(Record):
    """An expression, written twice."""
    @property
    def text(self) -> str:
        """In plain text, as most languages read it."""
    @property
    def latex(self) -> str:
        """In LaTeX."""

class FormulaValued(Record):
    """A number and the fraction that it is."""
    @property
    def exact(self) -> str:
        """``493/500``."""
    @property
    def value(self) -> float:
        """``0.986``."""

class FormulaOneArgument(Record):
    """What a formula takes."""
    @property
    def name(self) -> str:
        """Its identifier."""
    @property
    def latex(self) -> str:
        """In LaTeX."""
    @property
    def meaning(self) -> str:
        """What it stands for, in words."""
    @property
    def value(self) -> float:
        """Its value in this train; of a speed (rad/s) or a torque (N m) one inside the regime."""
    @property
    def exact(self) -> str:
        """The same as a fraction."""
    @property
    def efficiency(self) -> bool:
        """Whether it is an efficiency, above 0 and at most 1."""
    @property
    def fixed(self) -> bool:
        """Whether the train fixes it: a ratio, a tooth number, an efficiency."""

class FormulaOneCondition(Record):
    """A condition of a formula."""
    @property
    def expression(self) -> FormulaWritten:
        """Positive where the formula holds."""
    @property
    def ensures(self) -> str:
        """What it ensures, in words."""

class FormulaNobasis(Record):
    """No operation that says so has exactly one equilibrium; these were tried."""

class FormulaEfficiencyBasis(Record):
    """Where the efficiencies of meshes come from whose losses laws compute.

    # Example `````` use willis::regimes::{RegimeSelection, regimes}; use willis::train::Train;

    let train = Train::from_toml(r#"     format = 1     name = "one set"     members = ["s", "c"]     terminals =
    ["s", "c"]     [oil]     name = "ISO VG 220"     temperature = "70 degC"     [[set]]     name = "P1"     sun = {
    member = "s", teeth = 30 }     planet = { teeth = 20, count = 4 }     ring = { member = "frame", teeth = 70 }
    carrier = "c"     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }     [[operation]]
    name = "full load"     speeds = { s = "1000 rpm" }     torques = { s = "200 N m" } "#)?; let all =
    regimes(&train, &RegimeSelection::default())?; let basis = all.states[0].efficiency_basis.as_ref().unwrap();
    assert!(basis.is_at_load()); assert!(basis.efficiencies.iter().all(|(_, eta)| *eta < 1.0)); # Ok::<(),
    willis::Diagnostics>(()) ``````"""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose load it is; absent where the request gives the point, and of nominal
        efficiencies."""
    @property
    def speeds_rad_s(self) -> Named[float]:
        """Speed of each member that is loaded from outside there, rad/s. Nothing of nominal efficiencies."""
    @property
    def speeds(self) -> Named[float]: ...
    @property
    def torques_n_m(self) -> Named[float]:
        """Torque on each of them, N m."""
    @property
    def torques(self) -> Named[float]: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature there, K: prescribed, of the heat balance, or of the oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def efficiencies(self) -> Named[float]:
        """Efficiency of each mesh whose losses are computed, with what bearings lose by its load; to six decimals, the
        same whichever gear drives."""
    @property
    def nominal(self) -> list[str]:
        """Meshes that carry nothing or do not move there: theirs are nominal."""
    @property
    def reason(self) -> Literal["no-operation"] | FormulaNobasis | None:
        """Why all are nominal."""
    @property
    def nominal_friction(self) -> float:
        """The coefficient of friction that nominal efficiencies are made with."""

class FormulaOneDerivative(Record):
    """A derivative of the efficiency."""
    @property
    def of(self) -> str:
        """The efficiency by which it is taken."""
    @property
    def formula(self) -> FormulaWritten:
        """The derivative."""
    @property
    def value(self) -> float | None:
        """Its value in this train; absent at a pole."""
    @property
    def share(self) -> float | None:
        """How much of the whole loss this element or mesh causes, to first order; absent at a pole."""

class FormulaOneFormula(Record):
    """The closed formula of a regime, or of several that share it."""
    @property
    def name(self) -> str:
        """An identifier: train, state, direction."""
    @property
    def title(self) -> str:
        """What it is, in words."""
    @property
    def state(self) -> str:
        """The state of the shift table, or ``as drawn``."""
    @property
    def regimes(self) -> list[str]:
        """Regimes in which it holds (two or more degrees of freedom)."""
    @property
    def inputs(self) -> list[str]:
        """Terminals where power enters."""
    @property
    def outputs(self) -> list[str]:
        """Terminals where power leaves."""
    @property
    def drivers(self) -> Named[str | None]:
        """The member that drives each element; null where none does."""
    @property
    def efficiency(self) -> FormulaWritten:
        """The efficiency."""
    @property
    def value(self) -> FormulaValued | None:
        """Its value with the arguments' own values, as a fraction and as a number; absent at a pole."""
    @property
    def speed_ratio(self) -> FormulaWritten | None:
        """Speed of the input over that of the output (one degree of freedom)."""
    @property
    def torque_ratio(self) -> FormulaWritten | None:
        """Torque on the output over that on the input (one degree of freedom)."""
    @property
    def arguments(self) -> list[FormulaOneArgument]:
        """What it takes."""
    @property
    def conditions(self) -> list[FormulaOneCondition]:
        """Expressions that are positive where the formula holds, and nowhere else."""
    @property
    def efficiency_basis(self) -> FormulaEfficiencyBasis | None:
        """Where mesh efficiencies come from whose losses laws compute; absent where all are given."""
    @property
    def derivatives(self) -> list[FormulaOneDerivative]:
        """Derivatives of the efficiency, where they were asked for; the one that costs most first."""

class FormulaNoFormula(Record):
    """A state or a direction without a formula."""
    @property
    def state(self) -> str:
        """The state."""
    @property
    def why(self) -> str:
        """Why."""

class FormulaAnswer(_answer.Formula):
    """Closed formulas of a train."""
    @property
    def format(self) -> Literal["willis-formula-1"]:
        """``willis-formula-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def formulas(self) -> list[FormulaOneFormula]:
        """The formulas, state by state."""
    @property
    def without(self) -> list[FormulaNoFormula]:
        """States, or directions of one, that have no formula."""
    @property
    def code(self) -> str:
        """All formulas written in the language that was asked for."""

class LocateEdge(Record):
    """A boundary that a changing value meets."""
    @property
    def at(self) -> float:
        """The value there, rad/s or N m."""
    @property
    def label(self) -> str:
        """What is the case there."""
    @property
    def changes(self) -> list[str]:
        """What changes behind it; empty when nothing does."""
    @property
    def efficiency_before(self) -> float:
        """Efficiency just before it."""
    @property
    def efficiency_before_exact(self) -> str | None:
        """The same, exactly."""
    @property
    def efficiency_after(self) -> list[float]:
        """Efficiencies just behind it; none when no equilibrium exists there."""

class LocateRange(Record):
    """How far one prescribed value can change before the regime ends."""
    @property
    def quantity(self) -> Literal["speed", "torque"]:
        """What it is."""
    @property
    def member(self) -> str:
        """The member."""
    @property
    def value(self) -> float:
        """Its value, rad/s or N m."""
    @property
    def below(self) -> LocateEdge | None:
        """The boundary below, if there is one."""
    @property
    def above(self) -> LocateEdge | None:
        """The boundary above, if there is one."""

class LocateTorque(Record):
    @property
    def member(self) -> str:
        """The member."""

class LocateStictionquantity(Record):
    """The torque on a member, N m."""
    @property
    def torque(self) -> LocateTorque: ...

class LocateStictionRange(Record):
    """A torque range that friction in a mesh at rest leaves open."""
    @property
    def what(self) -> str:
        """What varies, in words."""
    @property
    def quantity(self) -> Literal["efficiency"] | LocateStictionquantity:
        """What ``what`` says, as data."""
    @property
    def low(self) -> float | None:
        """Smallest value; absent when too many meshes rest to bound it."""
    @property
    def high(self) -> float | None:
        """Largest value."""

class LocateLocated(Record):
    """An equilibrium and its surroundings."""
    @property
    def regime(self) -> str | None:
        """Name of the regime as ``willis regimes`` lists it, where that list was made."""
    @property
    def torques_n_m(self) -> Named[float]:
        """Torques by terminal, N m."""
    @property
    def torques(self) -> Named[float]: ...
    @property
    def powers_w(self) -> Named[float]:
        """Powers into the train by terminal, W."""
    @property
    def powers(self) -> Named[float]: ...
    @property
    def roles(self) -> Named[Literal["input", "output", "fixed", "idle"]]:
        """What each terminal does."""
    @property
    def drivers(self) -> Named[str | None]:
        """Which end drives each element."""
    @property
    def efficiency(self) -> float:
        """Output over input power; zero when all is dissipated."""
    @property
    def efficiency_exact(self) -> str:
        """The same, exactly."""
    @property
    def formula(self) -> str | None:
        """The closed formula, where the train is small enough."""
    @property
    def ranges(self) -> list[LocateRange]:
        """For each prescribed value the range within which the regime lasts, all others fixed."""
    @property
    def at_rest(self) -> list[str]:
        """Loaded meshes, or sets, without relative motion: their friction may be anything up to its limit."""
    @property
    def stiction(self) -> list[LocateStictionRange]:
        """What that leaves open, where [``analyze``](crate::analyze) tells it. The torques above are those in which
        these meshes lose nothing."""

class LocateNobasis(Record):
    """No operation that says so has exactly one equilibrium; these were tried."""

class LocateEfficiencyBasis(Record):
    """Where the efficiencies of meshes come from whose losses laws compute.

    # Example `````` use willis::regimes::{RegimeSelection, regimes}; use willis::train::Train;

    let train = Train::from_toml(r#"     format = 1     name = "one set"     members = ["s", "c"]     terminals =
    ["s", "c"]     [oil]     name = "ISO VG 220"     temperature = "70 degC"     [[set]]     name = "P1"     sun = {
    member = "s", teeth = 30 }     planet = { teeth = 20, count = 4 }     ring = { member = "frame", teeth = 70 }
    carrier = "c"     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }     [[operation]]
    name = "full load"     speeds = { s = "1000 rpm" }     torques = { s = "200 N m" } "#)?; let all =
    regimes(&train, &RegimeSelection::default())?; let basis = all.states[0].efficiency_basis.as_ref().unwrap();
    assert!(basis.is_at_load()); assert!(basis.efficiencies.iter().all(|(_, eta)| *eta < 1.0)); # Ok::<(),
    willis::Diagnostics>(()) ``````"""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose load it is; absent where the request gives the point, and of nominal
        efficiencies."""
    @property
    def speeds_rad_s(self) -> Named[float]:
        """Speed of each member that is loaded from outside there, rad/s. Nothing of nominal efficiencies."""
    @property
    def speeds(self) -> Named[float]: ...
    @property
    def torques_n_m(self) -> Named[float]:
        """Torque on each of them, N m."""
    @property
    def torques(self) -> Named[float]: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature there, K: prescribed, of the heat balance, or of the oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def efficiencies(self) -> Named[float]:
        """Efficiency of each mesh whose losses are computed, with what bearings lose by its load; to six decimals, the
        same whichever gear drives."""
    @property
    def nominal(self) -> list[str]:
        """Meshes that carry nothing or do not move there: theirs are nominal."""
    @property
    def reason(self) -> Literal["no-operation"] | LocateNobasis | None:
        """Why all are nominal."""
    @property
    def nominal_friction(self) -> float:
        """The coefficient of friction that nominal efficiencies are made with."""

class LocateAnswer(Answer):
    """Where an operating point lies."""
    @property
    def format(self) -> Literal["willis-location-1"]:
        """``willis-location-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def state(self) -> str:
        """The state."""
    @property
    def speeds_rad_s(self) -> Named[float]:
        """Speeds by terminal, rad/s."""
    @property
    def speeds(self) -> Named[float]: ...
    @property
    def order(self) -> list[str]:
        """The order of the speeds."""
    @property
    def on(self) -> list[str]:
        """Planes on which the point lies exactly: on the boundary between regions."""
    @property
    def region(self) -> int | None:
        """Number of the region, where the regions were enumerated and the point is inside one."""
    @property
    def complete(self) -> bool:
        """Whether every equilibrium was found."""
    @property
    def reason(self) -> str | None:
        """Why there is none, or what else must be known."""
    @property
    def regimes(self) -> list[LocateLocated]:
        """The equilibria; more than one where friction leaves a choice."""
    @property
    def efficiency_basis(self) -> LocateEfficiencyBasis | None:
        """Where mesh efficiencies come from whose losses laws compute: this point, where it has exactly one
        equilibrium."""

class SimulateHappening(Record):
    """What happened to some elements at once."""
    @property
    def kind(self) -> Literal["start", "comes-to-rest", "breaks-away", "turns-round", "rests-for-an-instant", "engages", "opens", "locks", "overruns", "drive-reverses", "touches", "contact-lost", "no-contact", "full-damping", "damping-limited", "contact-without-force", "reaches-limit", "leaves-limit"]:
        """What happens to the elements."""
    @property
    def of(self) -> list[str]:
        """The elements."""

class SimulateEvent(Record):
    """A change of mode."""
    @property
    def time_s(self) -> float:
        """When, s."""
    @property
    def time(self) -> float: ...
    @property
    def cause(self) -> str:
        """What happened, in words, some names left out where they are many: ``start``; ``B comes to rest``, ``B and
        P1.sun-planet break away``, ``bearing reverses``, ``C engages, B opens``, ``side shafts: contact``, ``drive
        reverses in P1.sun-planet``."""
    @property
    def happenings(self) -> list[SimulateHappening]:
        """What ``cause`` says, as data."""
    @property
    def modes(self) -> Named[Literal["forward", "backward", "stuck", "free"]]:
        """The modes after it that differ from those before, by element."""

class SimulateSourceEnergy(Record):
    """Energy that came in at one place (negative: that went out)."""
    @property
    def name(self) -> str:
        """The source; ``store of`` a variator."""
    @property
    def member(self) -> str:
        """The member, or the variator."""
    @property
    def energy_j(self) -> float:
        """Net, J."""
    @property
    def energy(self) -> float: ...
    @property
    def in_j(self) -> float:
        """What came in, J."""
    @property
    def out_j(self) -> float:
        """What went out, J."""
    @property
    def out(self) -> float: ...

class SimulateEnergyLoss(Record):
    """Energy that went into one cause of loss."""
    @property
    def name(self) -> str:
        """Mesh, drag, shift element, shaft; place of a loss that follows a law."""
    @property
    def kind(self) -> Literal["mesh", "drag", "shift-element", "shaft", "rolling", "bearing", "windage", "churning", "seal", "variator"]:
        """What loses it."""
    @property
    def energy_j(self) -> float:
        """The energy, J."""
    @property
    def energy(self) -> float: ...

class SimulateEnergyReport(Record):
    """Where the energy of a run went: in = stored + losses + residual."""
    @property
    def sources(self) -> list[SimulateSourceEnergy]:
        """By source from outside, stores of variators among them."""
    @property
    def machines(self) -> list[SimulateSourceEnergy]:
        """What sources that are machines of variators gave to their members; it came from the buses."""
    @property
    def stored_j(self) -> float:
        """Kinetic energy and that of twisted shafts, end less start, J."""
    @property
    def stored(self) -> float: ...
    @property
    def losses(self) -> list[SimulateEnergyLoss]:
        """By cause, largest first."""
    @property
    def turned_over_j(self) -> float:
        """All that came in or went out, J."""
    @property
    def turned_over(self) -> float: ...
    @property
    def residual_j(self) -> float:
        """What does not close, J."""
    @property
    def residual(self) -> float: ...
    @property
    def efficiency(self) -> float | None:
        """Out over in, where anything came in and nothing is stored beside it; else ``None``."""

class SimulateMotionHeat(Record):
    """Temperatures of a run, and where the heat went: ``made = carried away + stored``."""
    @property
    def start_k(self) -> Named[float]:
        """Temperature of each place at the start, K."""
    @property
    def start(self) -> Named[float]: ...
    @property
    def end_k(self) -> Named[float]:
        """Temperature of each place at the end, K."""
    @property
    def end(self) -> Named[float]: ...
    @property
    def highest_oil_k(self) -> float:
        """Highest oil temperature, K."""
    @property
    def highest_oil(self) -> float: ...
    @property
    def limit_k(self) -> float:
        """Highest oil temperature that the train allows, K."""
    @property
    def limit(self) -> float: ...
    @property
    def beyond_limit_s(self) -> float | None:
        """When the oil first went beyond it, s."""
    @property
    def beyond_limit(self) -> float | None: ...
    @property
    def made_j(self) -> float:
        """Heat made by losses and by what the network has beside them, J."""
    @property
    def made(self) -> float: ...
    @property
    def carried_j(self) -> float:
        """Heat carried away, J."""
    @property
    def carried(self) -> float: ...
    @property
    def stored_j(self) -> float:
        """Heat stored in oil and parts, J."""
    @property
    def stored(self) -> float: ...
    @property
    def elsewhere_j(self) -> float:
        """Lost outside the gearbox, in parts that are cooled elsewhere or belong to no mesh, shift element or
        terminal, J."""
    @property
    def elsewhere(self) -> float: ...
    @property
    def residual(self) -> float:
        """Heat made less what was carried away and stored, over the heat made."""

class SimulateLimitExceeded(Record):
    """A limit of a variator that a run exceeds, where it does so by most among the ends of its steps."""
    @property
    def variator(self) -> str:
        """The variator."""
    @property
    def machine(self) -> str | None:
        """Its machine; absent where the limit is that of the ratio."""
    @property
    def quantity(self) -> Literal["torque", "power", "speed", "ratio"]:
        """What is limited."""
    @property
    def value(self) -> float:
        """What it is, SI."""
    @property
    def limit(self) -> float:
        """What it may be at most (or, of a ratio, at least), SI."""
    @property
    def time_s(self) -> float:
        """When, s."""
    @property
    def time(self) -> float: ...
    @property
    def excess(self) -> float:
        """By what part of the limit."""

class SimulateAnswer(_answer.Simulation):
    """A run: the results contract ``willis-simulation-1``. Fields are added, never renamed; units are SI and stand in
    the names.

    [``simulate``](super::simulate) hands rows and events to its recorder, which may keep them in
    [``RunReport::events``], [``RunReport::columns``] and [``RunReport::rows``]."""
    @property
    def format(self) -> Literal["willis-simulation-1"]:
        """``willis-simulation-1``"""
    @property
    def train(self) -> str:
        """The train."""
    @property
    def scenario(self) -> str:
        """The scenario."""
    @property
    def outcome(self) -> Any:
        """How it ended."""
    @property
    def start_s(self) -> float:
        """Where it began, s."""
    @property
    def start(self) -> float: ...
    @property
    def from_s(self) -> float | None:
        """From when on there are rows and events, s."""
    @property
    def end_s(self) -> float:
        """Where it ended, s."""
    @property
    def end(self) -> float: ...
    @property
    def coordinates(self) -> list[str]:
        """Members whose speeds are the coordinates."""
    @property
    def unique_for_every_load(self) -> bool:
        """Whether the tooth forces have exactly one solution in every rolling state."""
    @property
    def steps(self) -> int:
        """Steps taken."""
    @property
    def events(self) -> list[SimulateEvent]:
        """Changes of mode, where they were kept."""
    @property
    def final_speeds_rad_s(self) -> Named[float]:
        """Speeds of all members at the end, rad/s; without those that are no longer finite."""
    @property
    def final_speeds(self) -> Named[float]: ...
    @property
    def energy(self) -> SimulateEnergyReport | None:
        """Where the energy went; nothing where it was not counted, or is no longer finite."""
    @property
    def heat(self) -> SimulateMotionHeat | None:
        """Temperatures, where the train says what carries its heat away and steps are adapted."""
    @property
    def beyond_limits(self) -> list[SimulateLimitExceeded]:
        """Limits of variators that the run exceeds."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given."""
    @property
    def scenario_end_s(self) -> float:
        """Where the scenario ends, or was [told to](Options::to_s), s."""
    @property
    def scenario_end(self) -> float: ...
    @property
    def event_count(self) -> int:
        """Number of changes of mode, the start among them."""
    @property
    def rows(self) -> list[list[float | None]] | None:
        """Values in the order of the columns, SI; nothing where a value is not determined."""

class ModesPart(Record):
    """A number that belongs to a member, a shaft or a mesh."""
    @property
    def name(self) -> str:
        """The member, shaft or mesh."""
    @property
    def value(self) -> float:
        """Its number."""

class ModesRigidMode(Record):
    """A motion without strain, at 0 Hz."""
    @property
    def shape(self) -> list[ModesPart]:
        """Angle of each member whose motion is settled; the largest is 1."""
    @property
    def kinetic_energy(self) -> list[ModesPart]:
        """Share of the kinetic energy by member; 1 in all."""

class ModesMode(Record):
    """A vibration."""
    @property
    def frequency_hz(self) -> float:
        """Undamped natural frequency f, Hz."""
    @property
    def frequency(self) -> float: ...
    @property
    def angular_frequency_rad_s(self) -> float:
        """ω = 2π f, rad/s."""
    @property
    def angular_frequency(self) -> float: ...
    @property
    def damping_ratio(self) -> float | None:
        """ζ = −Re λ/|λ| of its eigenvalue λ with damping; above 1 (then ``c/(2ω)`` of its shape) where it no longer
        vibrates; ``None`` where nothing damps it."""
    @property
    def damped_frequency_hz(self) -> float | None:
        """Frequency with damping, Im λ/(2π), Hz; ``None`` where it no longer vibrates."""
    @property
    def damped_frequency(self) -> float | None: ...
    @property
    def shape(self) -> list[ModesPart]:
        """Angle amplitude of each member whose motion is settled, relative to the largest, which is 1. Opposite signs
        swing in opposite directions."""
    @property
    def kinetic_energy(self) -> list[ModesPart]:
        """Share of the kinetic energy by member; 1 in all."""
    @property
    def strain_energy(self) -> list[ModesPart]:
        """Share of the strain energy by shaft and elastic mesh; 1 in all."""

class ModesPlanetMode(Record):
    """Vibrations in which the planets of a set swing against each other, and nothing else moves."""
    @property
    def set(self) -> str:
        """The set."""
    @property
    def multiplicity(self) -> int:
        """How many such vibrations there are: one less than planets."""
    @property
    def mode(self) -> ModesMode:
        """One of them; its shape is that of one planet."""

class ModesAnswer(Answer):
    """Natural frequencies of a train."""
    @property
    def format(self) -> Literal["willis-modes-1"]:
        """``willis-modes-1``"""
    @property
    def train(self) -> str:
        """The train."""
    @property
    def state(self) -> str:
        """The state of the shift table, or ``as drawn``."""
    @property
    def fixed(self) -> list[str]:
        """Members held at rest beside it."""
    @property
    def coordinates(self) -> list[str]:
        """Members whose angles are the coordinates."""
    @property
    def rigid_body_modes(self) -> list[ModesRigidMode]:
        """Motions without strain; how many there are is certain, because they are found exactly."""
    @property
    def modes(self) -> list[ModesMode]:
        """Vibrations, by rising frequency."""
    @property
    def planet_modes(self) -> list[ModesPlanetMode]:
        """Planets against each other, of sets with elastic meshes."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given."""

class DesignAnswer(Answer):
    """What was found, and how far the search is."""

class SchemesHybridWish(Record):
    """What a hybrid must do.

    # Example `````` use willis::work::Serial; use willis_synthesis::schemes::{HybridWish, ModeKind, hybrids};

    let wish = HybridWish::new(&["17/10", "23/10"], 3, &["input-split", "compound-split", "electric", "fixed"])?;
    let answer = hybrids(&wish, &Serial)?; assert_eq!((answer.layouts, answer.kinematic, answer.designs_found),
    (900, 2088, 3240)); assert_eq!(answer.modes[&ModeKind::CompoundSplit], 864); # Ok::<(), Box<dyn
    std::error::Error>>(()) ``````"""
    @property
    def sets(self) -> list[str]:
        """The tooth ratio of each set."""
    @property
    def clutches(self) -> int:
        """Clutches and brakes."""
    @property
    def mobility(self) -> int:
        """Freedoms with no clutch closed."""
    @property
    def need(self) -> list[Literal["input-split", "output-split", "compound-split", "input-and-output-geared", "engine-geared-to-output", "motors-geared-together", "one-at-rest", "fixed", "fixed-with-motor", "electric", "charging", "nothing"]]:
        """Modes that there must be. ``fixed`` is met by a fixed gear in which a motor turns, too."""
    @property
    def top(self) -> int:
        """How many designs are shown."""

class SchemesSchemeSpace(Record):
    """The space that was searched."""
    @property
    def sets(self) -> int:
        """Sets of the train."""
    @property
    def shafts(self) -> int:
        """Shafts besides the housing."""
    @property
    def layouts(self) -> int:
        """Layouts of the space, whether or not they were reached."""
    @property
    def examined(self) -> int:
        """Layouts that were examined."""
    @property
    def choices(self) -> int:
        """Choices of elements in these layouts, no two elements kinematically the same: each was examined, or excluded
        by the number of its states that can be gears."""

class SchemesSchemeCompleteness(Record):
    """How much of the space the answer covers."""
    @property
    def complete(self) -> bool:
        """Whether it is all of it."""
    @property
    def parts(self) -> int:
        """Parts of the work."""
    @property
    def asked(self) -> int:
        """Parts that were asked for: all, or those of a share."""
    @property
    def done(self) -> int:
        """Parts that are done."""
    @property
    def share(self) -> float:
        """The share of the parts that is done."""
    @property
    def sample(self) -> int:
        """One of so many layouts was examined."""
    @property
    def statement(self) -> str:
        """All of this in words."""

class SchemesSchemeStage(Record):
    """How many choices of elements are left after a rule."""
    @property
    def rule(self) -> str:
        """The rule: ``choices``, ``states``, ``chain``, ``reverse``, ``attached``, ``minimal``, ``limits``,
        ``planar``."""
    @property
    def about(self) -> str:
        """What it asks, in words."""
    @property
    def left(self) -> int:
        """What is left."""

class SchemesFoundSchemes(Record):
    """How many schemes there are."""
    @property
    def layouts(self) -> int:
        """Layouts that have a scheme."""
    @property
    def schemes(self) -> int:
        """Schemes."""
    @property
    def classes(self) -> int:
        """Schemes that differ in more than the place of an element that does the same to all speeds."""
    @property
    def by_brakes(self) -> Any:
        """Schemes by their number of brakes."""

class SchemesSchemeShaft(Record):
    """A shaft of a scheme."""
    @property
    def name(self) -> str:
        """``input``, ``output``, ``housing``, or what it carries: ``r2s3`` is ring 2 and sun 3."""
    @property
    def digit(self) -> str:
        """Its digit in the name of the layout."""
    @property
    def members(self) -> list[str]:
        """The members of sets that belong to it."""

class SchemesSchemeElement(Record):
    """A clutch or a brake of a scheme."""
    @property
    def name(self) -> str:
        """``A``, ``B``, …: brakes first."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way"]:
        """Clutch or brake."""
    @property
    def joins(self) -> list[str]:
        """The shafts that it joins; for a brake the housing and one shaft."""
    @property
    def same(self) -> list[list[str]]:
        """Other places at which an element does the same to all speeds: each joins two shafts."""
    @property
    def max_torque(self) -> float:
        """The largest modulus of its torque in the gears shown, per torque of the input, without losses."""
    @property
    def max_slip(self) -> float:
        """The largest modulus of its slip in the gears shown, per speed of the input."""

class SchemesSchemeGear(Record):
    """A gear of a scheme. Speeds are per speed of the input, torques per torque of the input and without losses."""
    @property
    def name(self) -> str:
        """``1``, ``2``, …, ``R``; other states that have a ratio are named after what they close."""
    @property
    def closed(self) -> list[str]:
        """The closed elements."""
    @property
    def ratio(self) -> str:
        """Speed of the input over speed of the output."""
    @property
    def value(self) -> float:
        """The same as a number."""
    @property
    def step(self) -> float | None:
        """The ratio over that of the next gear."""
    @property
    def speeds(self) -> Named[float]:
        """Speed of every shaft."""
    @property
    def planets(self) -> Named[float]:
        """Speed of the planets of every set relative to their carrier."""
    @property
    def torques(self) -> Named[float]:
        """Torque of every closed element on the first of its shafts. Zero: it carries nothing."""
    @property
    def slips(self) -> Named[float]:
        """Slip of every open element, the speed of the first of its shafts less that of the second."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power when the input drives, of the scheme's train file with the mesh efficiencies that it
        has ([``Schemes::rate``](super::Schemes::rate))."""
    @property
    def no_efficiency(self) -> str | None:
        """Why there is no efficiency."""

class SchemesScheme(Record):
    """A shift scheme: a layout with elements, and what it does.

    # Example `````` use willis_synthesis::schemes::{Scheme, Wish};

    let wish = Wish { layout: None, ..Wish::new(&["96/48", "96/48", "111/69", "85/23"], 5, 3, 8)? }; let elements =
    [[2, 3], [2, 4], [0, 7], [1, 8], [6, 7]]; let zf = Scheme::new(&wish, "345360678751".parse()?,
    &elements).unwrap(); assert_eq!(zf.gears[0].ratio.to_string(), "108/23"); assert_eq!(zf.gears[0].closed.join("
    "), "A B C"); // The train file has the same ratios, exactly. let train =
    willis::Train::from_toml(&zf.to_toml())?; let analysis = willis::analyze(&train,
    &willis::Selection::default())?; assert_eq!(analysis.ratios.get("1").unwrap().exact.as_ref(),
    Some(&zf.gears[0].ratio)); # Ok::<(), Box<dyn std::error::Error>>(()) ``````"""
    @property
    def id(self) -> str:
        """Its name: layout, and the digits of the shafts that each element joins: ``345360678751 07 18 23 24 67``."""
    @property
    def known(self) -> str | None:
        """The known transmission that it is."""
    @property
    def layout(self) -> str:
        """The layout."""
    @property
    def sets(self) -> list[str]:
        """The tooth ratio of every set."""
    @property
    def mesh_efficiencies(self) -> list[str]:
        """Efficiencies of the meshes of sun and planet, and of planet and ring, in every set."""
    @property
    def shafts(self) -> list[SchemesSchemeShaft]:
        """The shafts, in the order of the layout's digits."""
    @property
    def elements(self) -> list[SchemesSchemeElement]:
        """Brakes and clutches."""
    @property
    def brakes(self) -> int:
        """How many of the elements are brakes."""
    @property
    def gears(self) -> list[SchemesSchemeGear]:
        """The longest chain of forward gears."""
    @property
    def reverse(self) -> list[SchemesSchemeGear]:
        """Reverse gears."""
    @property
    def others(self) -> list[SchemesSchemeGear]:
        """Other states with a ratio."""
    @property
    def spread(self) -> float:
        """Ratio of the first over that of the last gear."""
    @property
    def max_speed(self) -> float:
        """The largest modulus of a shaft's speed in the gears and in reverse, per speed of the input."""
    @property
    def max_torque(self) -> float:
        """The largest modulus of an element's torque there, per torque of the input."""
    @property
    def planar(self) -> bool:
        """Whether it can be drawn with nested shafts and without a crossing: the graph of sets, shafts and elements,
        with housing, input and output on its outer face, is planar."""

class SchemesSchemeRelaxation(Record):
    """What there would be if one rule gave way."""
    @property
    def change(self) -> str:
        """What gives way, in words."""
    @property
    def schemes(self) -> int | None:
        """How many schemes there are then; absent where that was not searched."""
    @property
    def until(self) -> float | None:
        """How far it must give way for the first of them: the smallest largest step, speed or torque, or the largest
        smallest efficiency that there is."""
    @property
    def reason(self) -> str | None:
        """Why it was not searched."""

class SchemesRediscovered(Record):
    """Whether a known transmission is among the schemes that are wanted."""
    @property
    def name(self) -> str:
        """What it is called."""
    @property
    def source(self) -> str:
        """Where its connections come from."""
    @property
    def found(self) -> bool:
        """Whether it does what is wanted, with the tooth ratios of the wish."""
    @property
    def row(self) -> int | None:
        """Where it stands among the schemes that are shown, from 1, if it is one of them."""
    @property
    def scheme(self) -> SchemesScheme | None:
        """As a scheme of the space that was searched, if it does."""

class SchemesHybridMode(Record):
    """A mode of a hybrid."""
    @property
    def kind(self) -> Literal["input-split", "output-split", "compound-split", "input-and-output-geared", "engine-geared-to-output", "motors-geared-together", "one-at-rest", "fixed", "fixed-with-motor", "electric", "charging", "nothing"]:
        """What it is."""
    @property
    def closed(self) -> list[str]:
        """The clutches that are closed."""
    @property
    def turning(self) -> list[str]:
        """Which of ``engine``, ``output``, ``A`` and ``B`` can turn."""
    @property
    def mechanical_points(self) -> list[str]:
        """Two freedoms: ratios of engine to output speed at which a motor is at rest and all power passes through
        gears (mechanical points), motor A first."""
    @property
    def ratio(self) -> str | None:
        """One freedom: the ratio of engine to output speed, if both turn."""

class SchemesHybridDesign(Record):
    """A hybrid: a layout with clutches, and its modes."""
    @property
    def id(self) -> str:
        """Its name: layout, and the digits of the shafts that each clutch joins."""
    @property
    def layout(self) -> str:
        """The layout; 0 is the engine, 1 the output, 2 the housing, 3 and 4 are the motors."""
    @property
    def sets(self) -> list[str]:
        """The tooth ratio of every set."""
    @property
    def shafts(self) -> list[str]:
        """What the shafts are called, by digit: ``engine``, ``output``, ``housing``, ``A``, ``B``, and what others
        carry."""
    @property
    def clutches(self) -> list[list[str]]:
        """The shafts that each clutch joins: ``C1``, ``C2``, …"""
    @property
    def same(self) -> int:
        """Other choices of clutches that have the same modes with the same speeds."""
    @property
    def modes(self) -> list[SchemesHybridMode]:
        """The modes that are of use."""

class SchemesAnswer(Answer):
    """Shift schemes, or hybrids, with what a search can go on from."""
    @property
    def format(self) -> Literal["willis-hybrids-1"]:
        """``willis-hybrids-1``."""
    @property
    def wish(self) -> SchemesHybridWish:
        """What was wanted."""
    @property
    def space(self) -> SchemesSchemeSpace:
        """What was searched."""
    @property
    def completeness(self) -> SchemesSchemeCompleteness:
        """How much of the space the answer covers."""
    @property
    def waterfall(self) -> list[SchemesSchemeStage]:
        """What each rule left, in the order in which they are applied."""
    @property
    def found(self) -> SchemesFoundSchemes:
        """What was found."""
    @property
    def schemes(self) -> list[SchemesScheme]:
        """The first schemes in the order of the wish, confirmed by rational arithmetic."""
    @property
    def relaxations(self) -> list[SchemesSchemeRelaxation]:
        """If nothing was found: what there is where one rule gives way."""
    @property
    def rediscovered(self) -> SchemesRediscovered | None:
        """The known transmission that was asked for."""
    @property
    def assumptions(self) -> list[str]:
        """What was taken where nothing was said."""
    @property
    def layouts(self) -> int:
        """Layouts, with the motors exchanged counted once."""
    @property
    def modes(self) -> Named[int]:
        """Modes of all layouts by their kind, with clutches that do the same counted once."""
    @property
    def choices(self) -> int:
        """Choices of clutches that differ in what they do."""
    @property
    def kinematic(self) -> int:
        """Of these, those that have the modes that are needed."""
    @property
    def designs_found(self) -> int:
        """The same with every place for the clutches."""
    @property
    def designs(self) -> list[SchemesHybridDesign]:
        """The first designs in the order of layouts, one for all places of its clutches that do the same."""

class DrawStickBlock(Record):
    """Planets on one carrier with their gears, or one ordinary pair."""
    @property
    def name(self) -> str:
        """Name of the set, or of the first mesh."""
    @property
    def span(self) -> list[float]:
        """Least and greatest x."""
    @property
    def top(self) -> float:
        """The highest y of its gears."""

class DrawStickPiece(Record):
    """A line of a member, between two of its branches or ends."""
    @property
    def points(self) -> list[list[float]]:
        """Corners, the ends included."""
    @property
    def loaded(self) -> bool:
        """The power of the state passes it."""
    @property
    def power(self) -> float | None:
        """Power from its first corner to its last, over that of the input, lossless; negative where it runs the other
        way, absent where statics does not settle it or no state is shown."""
    @property
    def circulates(self) -> bool:
        """That power is part of a circle from set to set."""

class DrawStickMember(Record):
    """A member and its lines."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def colour(self) -> int:
        """Number of its colour: its place among the members of the train."""
    @property
    def planet(self) -> bool:
        """A planet: its gears stand on a pin of a carrier."""
    @property
    def carries(self) -> list[int]:
        """The blocks whose planets it carries, positions in [``Stick::blocks``]."""
    @property
    def pieces(self) -> list[DrawStickPiece]:
        """Its lines; of a stepped planet what joins its steps, along the pin."""
    @property
    def dots(self) -> list[list[float]]:
        """Where three or more of its lines meet."""
    @property
    def loaded(self) -> bool | None:
        """It carries power in the state: unit torque at the input, no losses, driving. Absent where statics cannot
        say, or where no state is shown."""
    @property
    def speed_ratio(self) -> float | None:
        """Its speed over that of the input in the state, where defined."""
    @property
    def exact_speed_ratio(self) -> str | None:
        """The same as an exact fraction."""

class DrawStickGear(Record):
    """A gear: its body and the lines of its teeth."""
    @property
    def member(self) -> int | None:
        """Position in [``Stick::members``]; absent for the frame."""
    @property
    def block(self) -> int:
        """Position in [``Stick::blocks``]."""
    @property
    def teeth(self) -> str:
        """Number of teeth; empty where the file does not give it and no whole number follows from the others."""
    @property
    def role(self) -> Literal["sun", "planet", "ring", "side", "wheel"]:
        """What it is."""
    @property
    def stems(self) -> list[list[list[float]]]:
        """Lines from its hub (or pin) to its teeth."""
    @property
    def faces(self) -> list[list[list[float]]]:
        """Lines of teeth."""
    @property
    def loaded(self) -> bool:
        """It carries power in the state."""

class DrawStickMesh(Record):
    """A tooth contact."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def gears(self) -> list[int]:
        """The two gears, positions in [``Stick::gears``]."""
    @property
    def at(self) -> list[float]:
        """Where they touch."""
    @property
    def bevel(self) -> bool:
        """A bevel pair."""

class DrawStickJoint(Record):
    """A shift element, or an elastic shaft."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way", "shaft"]:
        """What it is."""
    @property
    def members(self) -> list[int | None]:
        """The two members; absent for the frame."""
    @property
    def ends(self) -> list[list[float]]:
        """The ends of its symbol: the first on the first member, the second on the second one."""
    @property
    def engaged(self) -> bool:
        """Closed in the state."""
    @property
    def loaded(self) -> bool:
        """It carries power in the state."""

class DrawStickGround(Record):
    """A mark of the frame."""
    @property
    def at(self) -> list[float]:
        """Where the frame begins."""
    @property
    def into(self) -> list[int]:
        """The direction into the frame."""

class DrawStickTerminal(Record):
    """The end of a member at the border."""
    @property
    def member(self) -> int:
        """The member."""
    @property
    def at(self) -> list[float]:
        """Where it leaves."""
    @property
    def left(self) -> bool:
        """At the left border; else the right one."""
    @property
    def way(self) -> Literal["in", "out"] | None:
        """The direction of power, where the state or the train says it."""
    @property
    def open(self) -> bool:
        """An external torque may act here; else the line only names a member that has no gear."""

class DrawStick(Record):
    """The schematic of a train, perhaps in a state of its shift table."""
    @property
    def title(self) -> str:
        """Name of the train."""
    @property
    def state(self) -> str | None:
        """The state whose closed elements and power path are shown."""
    @property
    def states(self) -> list[str]:
        """Names of all states, in the order of the shift table."""
    @property
    def width(self) -> float:
        """Width of the grid: every x is from 0 to this."""
    @property
    def height(self) -> float:
        """Height of the grid: every y is from 0 to this."""
    @property
    def axes(self) -> list[float]:
        """Heights of the centre lines, the lowest first; ordinary gear pairs stand between two of them."""
    @property
    def blocks(self) -> list[DrawStickBlock]:
        """The blocks: planets on one carrier with their gears, or one ordinary pair."""
    @property
    def members(self) -> list[DrawStickMember]:
        """Every member but the frame, planets included."""
    @property
    def gears(self) -> list[DrawStickGear]:
        """Every gear."""
    @property
    def meshes(self) -> list[DrawStickMesh]:
        """Every tooth contact."""
    @property
    def joints(self) -> list[DrawStickJoint]:
        """Clutches, brakes, one-way clutches and elastic shafts."""
    @property
    def grounds(self) -> list[DrawStickGround]:
        """Where something is fixed to the frame."""
    @property
    def terminals(self) -> list[DrawStickTerminal]:
        """Where members leave the picture."""
    @property
    def frame(self) -> list[list[list[float]]]:
        """Pins and webs of carriers that belong to the frame."""
    @property
    def crossings(self) -> list[list[float]]:
        """Where lines of two members cross without touching."""

class DrawLeverCase(Record):
    """One motion."""
    @property
    def letter(self) -> str:
        """What it is called in the picture: its own name where all names are short, else a small letter."""
    @property
    def name(self) -> str:
        """The operation, or the state."""
    @property
    def ratio(self) -> float | None:
        """``ω_in/ω_out`` of a state."""
    @property
    def engaged(self) -> list[str]:
        """Closed shift elements."""
    @property
    def held(self) -> list[str]:
        """Members at rest because something holds them, the frame among them."""
    @property
    def note(self) -> str | None:
        """Why speeds or torques are missing, or which of several equilibria this is."""

class DrawLeverPull(Record):
    """A torque on a lever."""
    @property
    def node(self) -> int:
        """Number of the node."""
    @property
    def mesh(self) -> str | None:
        """The mesh through which it acts; absent at carriers and planets."""
    @property
    def torque(self) -> float:
        """Torque that the member puts into the set, N m or in units of the input's."""
    @property
    def displacement(self) -> float:
        """``λ``: by how much friction moves the force away from the carrier (``λ > 1``: it is driven) or towards it
        (``λ < 1``: it drives)."""
    @property
    def point(self) -> float:
        """Height at which it acts."""

class DrawLeverSet(Record):
    """The forces of one set on its lever."""
    @property
    def name(self) -> str:
        """Name of the set, or of its meshes."""
    @property
    def pulls(self) -> list[DrawLeverPull]:
        """What acts where; empty where torques are not shown."""

class DrawLeverNode(Record):
    """A point of a lever."""
    @property
    def member(self) -> str:
        """The member."""
    @property
    def colour(self) -> int | None:
        """Number of its colour: its place among the members of the train; absent for the frame."""
    @property
    def roles(self) -> list[Literal["carrier", "sun", "ring", "gear", "planet"]]:
        """What it is; several where sets share it."""
    @property
    def position(self) -> float:
        """Height along the lever: 0 lowest, 1 highest of the picture (planets may stand beyond). Of three points of a
        set the ratio of distances is that of [``LeverNode::number``]."""
    @property
    def number(self) -> float:
        """``N = (ω − ω_c)/(ω_p − ω_c)`` in its (first) set: 0 the carrier, 1 the first planet."""
    @property
    def speeds(self) -> list[float | None]:
        """Speed in each case, rad/s or in units of the input's; absent where not determined."""

class DrawLeverBar(Record):
    """A lever: one set, or several that share two members and so lie on one line."""
    @property
    def sets(self) -> list[DrawLeverSet]:
        """The sets on it."""
    @property
    def nodes(self) -> list[DrawLeverNode]:
        """Its points, highest first."""

class DrawLeverLink(Record):
    """A member that stands on several levers: their points move alike."""
    @property
    def member(self) -> str:
        """The member."""
    @property
    def points(self) -> list[list[int]]:
        """Numbers of the levers and of the nodes on them."""

class DrawLever(Record):
    """The nomograph of a train."""
    @property
    def title(self) -> str:
        """The train, and what is shown of it."""
    @property
    def unit(self) -> str | None:
        """The member whose speed and torque are the units, ``ω/ω_in`` and ``T/T_in``; absent where speeds are in rad/s
        and torques in N m."""
    @property
    def torques(self) -> bool:
        """Whether torques are shown."""
    @property
    def cases(self) -> list[DrawLeverCase]:
        """The motions shown: one, or every state."""
    @property
    def bars(self) -> list[DrawLeverBar]:
        """The levers, from left to right."""
    @property
    def links(self) -> list[DrawLeverLink]:
        """Members that stand on several levers."""
    @property
    def level(self) -> bool:
        """Whether a member stands equally high on all of its levers."""

class DrawWolfMember(Record):
    """A member."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def colour(self) -> int:
        """Number of its colour: its place in the train."""
    @property
    def terminal(self) -> bool:
        """Power from outside may enter or leave here."""

class DrawWolfShaft(Record):
    """A shaft of a set."""
    @property
    def member(self) -> int | None:
        """Position in [``Wolf::members``]; absent for the frame."""
    @property
    def role(self) -> Literal["carrier", "sun", "ring", "gear", "planet"]:
        """What it is in the set."""
    @property
    def sum(self) -> bool:
        """Its torque is the sum of the other two, with the other sign, when losses are left out."""

class DrawWolfSet(Record):
    """Planets on one carrier with their central gears, or a pair of gears."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def shafts(self) -> list[DrawWolfShaft]:
        """Its shafts, the carrier last."""
    @property
    def basic_ratio(self) -> str | None:
        """Speed of the first over that of the second shaft, relative to the carrier, as a fraction; of sets with three
        shafts."""

class DrawWolfTie(Record):
    """A shift element between two members, or a member and the frame."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def members(self) -> list[int | None]:
        """Positions in [``Wolf::members``]; absent for the frame."""
    @property
    def one_way(self) -> bool:
        """It locks in one direction only."""
    @property
    def engaged(self) -> bool:
        """It is closed in the state."""

class DrawWolfVariator(Record):
    """A variator between members, directly or by machines on a bus."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def members(self) -> list[int]:
        """Positions in [``Wolf::members``]."""

class DrawWolf(Record):
    """A train as Wolf's symbols."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def state(self) -> str | None:
        """The state whose shift elements are closed."""
    @property
    def members(self) -> list[DrawWolfMember]:
        """Members with a shaft in a set, a shift element or a variator, in the order of the train; without the frame."""
    @property
    def sets(self) -> list[DrawWolfSet]:
        """The boxes."""
    @property
    def ties(self) -> list[DrawWolfTie]:
        """Shift elements."""
    @property
    def variators(self) -> list[DrawWolfVariator]:
        """Variators: the second paths of a power split."""

class DrawSankeyLoss(Record):
    """Power that turns into heat."""
    @property
    def kind(self) -> Literal["frame", "member", "teeth", "bearing", "seal", "gear", "rotor", "drag", "open-element", "pump", "shift-element", "coupling", "variator", "input", "output"]:
        """What loses it: teeth, bearings, seals, gears or rotors in their fluid."""
    @property
    def names(self) -> list[str]:
        """The contacts that lose it; several where small ones are gathered."""
    @property
    def power_w(self) -> float:
        """The loss, W."""
    @property
    def power(self) -> float: ...
    @property
    def offset_w(self) -> float:
        """From the top of the node's right side to the top of the loss, W."""
    @property
    def offset(self) -> float: ...

class DrawSankeyNode(Record):
    """A component, a tooth contact, a shift element, or an end."""
    @property
    def id(self) -> str:
        """Its identifier in the hypergraph."""
    @property
    def kind(self) -> Literal["frame", "member", "teeth", "bearing", "seal", "gear", "rotor", "drag", "open-element", "pump", "shift-element", "coupling", "variator", "input", "output"]:
        """What it is."""
    @property
    def name(self) -> str:
        """Its name in the train."""
    @property
    def speed_rad_s(self) -> float | None:
        """Speed of a component, rad/s."""
    @property
    def speed(self) -> float | None: ...
    @property
    def count(self) -> int:
        """Identical ones in parallel: tooth pairs."""
    @property
    def power_w(self) -> float:
        """Power through it, W: what enters, and what leaves with the losses."""
    @property
    def power(self) -> float: ...
    @property
    def input_w(self) -> float:
        """External power that enters here, W; it takes the whole left side."""
    @property
    def input(self) -> float: ...
    @property
    def output_w(self) -> float:
        """External power that leaves here, W; it takes the right side above the losses."""
    @property
    def output(self) -> float: ...
    @property
    def losses(self) -> list[DrawSankeyLoss]:
        """What is lost here, largest first, stacked below everything that leaves."""
    @property
    def layer(self) -> int:
        """Its layer, from the left; every link that is not led back runs to a later layer."""
    @property
    def row(self) -> int:
        """Its place in the layer, from the top, among nodes and passing links."""

class DrawSankeyLink(Record):
    """Power from one node to another."""
    @property
    def to(self) -> int:
        """Index of the node that it enters, at its left side."""
    @property
    def via(self) -> list[str]:
        """What it passes on the way, unchanged: planets, clutches, bearings."""
    @property
    def power_w(self) -> float:
        """The power, W."""
    @property
    def power(self) -> float: ...
    @property
    def circulating_w(self) -> float:
        """The part of it that runs in circles, W; the upper part of the ribbon."""
    @property
    def circulating(self) -> float: ...
    @property
    def framed(self) -> bool:
        """That part goes round only as powers are counted in the frame of the housing: it never leaves its set."""
    @property
    def back(self) -> bool:
        """Whether it is led back to an earlier layer, above all nodes."""
    @property
    def from_offset_w(self) -> float:
        """From the top of the right side of ``from`` to its upper edge, W."""
    @property
    def from_offset(self) -> float: ...
    @property
    def to_offset_w(self) -> float:
        """From the top of the left side of ``to`` to its upper edge, W."""
    @property
    def to_offset(self) -> float: ...
    @property
    def rows(self) -> list[int]:
        """Its rows in the layers that it passes on its way, from the left; empty when led back."""

class DrawSankeyFlow(Record):
    """The flow of one equilibrium in layers.

    At every node ``Σ links in + input = Σ links out + output + Σ losses`` up to round-off."""
    @property
    def seen_from(self) -> str | None:
        """The member from which speeds and powers are seen; absent where that is the housing."""
    @property
    def input_w(self) -> float:
        """Power in, W."""
    @property
    def input(self) -> float: ...
    @property
    def output_w(self) -> float:
        """Power out, W."""
    @property
    def output(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def circles(self) -> list[str]:
        """Power that runs in circles, in words ([``Hypergraph::recirculation``])."""
    @property
    def nodes(self) -> list[DrawSankeyNode]:
        """Ends, components and contacts."""
    @property
    def links(self) -> list[DrawSankeyLink]:
        """The power between them."""
    @property
    def layers(self) -> int:
        """Number of layers."""

class DrawSankeyPanel(Record):
    """One equilibrium, or why there is none."""
    @property
    def title(self) -> str:
        """The operation, its state, and which of several solutions."""
    @property
    def remark(self) -> str | None:
        """What has to be said before the numbers: why the train is locked or not determined, or that nothing is
        loaded."""
    @property
    def flow(self) -> DrawSankeyFlow | None:
        """The flow; absent where no power runs."""

class DrawSankey(Record):
    """The power flows of a train, one panel for each equilibrium."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def panels(self) -> list[DrawSankeyPanel]:
        """One for each equilibrium, and one for each operation without any."""

class DrawBandEnd(Record):
    """An end of a band, which ``--law`` reproduces."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def laws(self) -> Named[str]:
        """The law of each family in the band."""

class DrawFamilyBand(Record):
    """The laws of one family."""
    @property
    def law(self) -> str:
        """The law in force."""
    @property
    def in_range(self) -> bool:
        """Whether that is inside its range here."""
    @property
    def efficiencies(self) -> Named[float]:
        """The efficiency with each law that counts."""
    @property
    def beyond_ranges(self) -> bool:
        """Whether these are counted although fewer than two laws are inside their ranges."""
    @property
    def left_out(self) -> list[str]:
        """Laws that do not count: outside their ranges, or without one answer."""

class DrawLawBand(Record):
    """What an efficiency would be with other laws of loss: how far it is known.

    Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law
    of all kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce
    a published error, and those that leave a loss out, do not count. The oil temperature is held, and so are film,
    loss factor and load sharing, which belong to the law of friction."""
    @property
    def low(self) -> DrawBandEnd:
        """The lowest efficiency."""
    @property
    def high(self) -> DrawBandEnd:
        """The highest efficiency."""
    @property
    def families(self) -> Named[DrawFamilyBand]:
        """By family, what its laws give while the other families keep theirs."""

class DrawOutsideAt(Record):
    """A place where a law was used outside its range."""
    @property
    def name(self) -> str:
        """The mesh, bearing, seal, gear or rotor."""
    @property
    def value(self) -> float | None:
        """The value there, in the unit of the quantity; absent where it is not finite."""

class DrawOutsideLaw(Record):
    """A quantity outside the range of a law, wherever it was."""
    @property
    def family(self) -> str:
        """Family of the law."""
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""
    @property
    def low(self) -> float | None:
        """Lowest value of the range, in that unit; absent where there is none."""
    @property
    def high(self) -> float | None:
        """Highest value of the range, in that unit; absent where there is none."""
    @property
    def places(self) -> list[DrawOutsideAt]:
        """Where the law was used so."""

class DrawNode(Record):
    """A component, a contact, or an end of the graph."""
    @property
    def id(self) -> str:
        """Unique: kind and name, as in ``member:sun``, ``teeth:P1.sun-planet``, ``input:sun``; or ``frame``."""
    @property
    def kind(self) -> Literal["frame", "member", "teeth", "bearing", "seal", "gear", "rotor", "drag", "open-element", "pump", "shift-element", "coupling", "variator", "input", "output"]:
        """What it is."""
    @property
    def name(self) -> str:
        """Its name in the train."""
    @property
    def speed_rad_s(self) -> float | None:
        """Speed of a component, rad/s; absent when not determined."""
    @property
    def speed(self) -> float | None: ...
    @property
    def count(self) -> int:
        """Identical ones in parallel: tooth pairs, bearings."""
    @property
    def power_in_w(self) -> float:
        """Power that enters, W."""
    @property
    def power_in(self) -> float: ...
    @property
    def power_out_w(self) -> float:
        """Power that leaves, W."""
    @property
    def power_out(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """Loss in it, W."""
    @property
    def loss(self) -> float: ...
    @property
    def efficiency(self) -> float | None:
        """Outgoing over incoming absolute power; absent where none passes."""
    @property
    def carrier_frame_efficiency(self) -> float | None:
        """Of a tooth contact: efficiency of sliding seen from the carrier."""
    @property
    def residual_w(self) -> float:
        """Power in less power out less loss, W: round-off."""
    @property
    def residual(self) -> float: ...

class DrawEdge(Record):
    """Power, or only torque, between two nodes."""
    @property
    def to(self) -> str:
        """The node that it enters."""
    @property
    def member(self) -> str:
        """The component at one end, whose speed times the torque is the power."""
    @property
    def torque_n_m(self) -> float | None:
        """Torque that the component puts into the contact (at an input or output: external torque on the component), N
        m; absent where statics cannot divide it."""
    @property
    def torque(self) -> float | None: ...
    @property
    def power_w(self) -> float:
        """Power, W; 0 where the component stands still."""
    @property
    def power(self) -> float: ...
    @property
    def circulating_w(self) -> float:
        """The part of it that runs in loops, W."""
    @property
    def circulating(self) -> float: ...

class DrawLoop(Record):
    """Power that runs in a circle."""
    @property
    def power_w(self) -> float:
        """The power, W."""
    @property
    def power(self) -> float: ...
    @property
    def share_of_input(self) -> float:
        """Over the input power."""
    @property
    def nodes(self) -> list[str]:
        """Identifiers of the nodes it passes, in order; from the last it returns to the first."""
    @property
    def passes(self) -> list[str]:
        """The same seen from afar: names of shafts, sets and clutches."""
    @property
    def within(self) -> str | None:
        """The set, or ordinary pair, that it never leaves; or the sets it passes although none of them takes part in a
        circle as a whole ([``SolutionReport::recirculation``], which counts set by set). Such a loop depends on the
        frame in which powers are counted, not on how the train is coupled."""

class DrawStation(Record):
    """A node on a path."""
    @property
    def node(self) -> str:
        """Identifier of the node."""
    @property
    def efficiency(self) -> float:
        """Its efficiency for the power on paths: out over in, loops taken out; 1 for a component."""

class DrawPath(Record):
    """A way from an input to an output."""
    @property
    def share_of_input(self) -> float:
        """Part of the input power that takes it."""
    @property
    def efficiency(self) -> float:
        """Product of the efficiencies along it."""
    @property
    def delivered_w(self) -> float:
        """What arrives, W."""
    @property
    def delivered(self) -> float: ...
    @property
    def stations(self) -> list[DrawStation]:
        """The nodes along it, input and output included."""

class DrawHypergraph(Record):
    """The power flow of one equilibrium."""
    @property
    def seen_from(self) -> str | None:
        """The member from which speeds and powers are seen; absent where that is the housing."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power; 0 when everything is dissipated, absent when nothing is loaded."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where [``SolutionReport::efficiency_exact``] is known."""
    @property
    def input_power_w(self) -> float:
        """Power in, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def output_power_w(self) -> float:
        """Power out, W."""
    @property
    def output_power(self) -> float: ...
    @property
    def loss_w(self) -> float:
        """All losses, W."""
    @property
    def loss(self) -> float: ...
    @property
    def power_residual_w(self) -> float:
        """Input less output less losses, W."""
    @property
    def power_residual(self) -> float: ...
    @property
    def largest_residual_w(self) -> float:
        """The largest residual of a node, W."""
    @property
    def largest_residual(self) -> float: ...
    @property
    def nodes(self) -> list[DrawNode]:
        """Frame, components, contacts, inputs and outputs."""
    @property
    def edges(self) -> list[DrawEdge]:
        """Powers between them."""
    @property
    def loops(self) -> list[DrawLoop]:
        """Power that runs in circles, largest first."""
    @property
    def paths(self) -> list[DrawPath]:
        """Ways from inputs to outputs, those that deliver most first, at most [``MOST_PATHS``]."""
    @property
    def path_count(self) -> int:
        """How many there are."""
    @property
    def share_on_paths(self) -> float:
        """Part of the input power that takes any of them; the rest is lost on its way where nothing is passed on."""

class DrawOperationFlow(Record):
    """The power flow of an operating point."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def state(self) -> str | None:
        """The state of the shift table."""
    @property
    def unit(self) -> str | None:
        """Where no operation describes the state: the member whose speed and torque are the units, 1 rad/s and 1 N m."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of it."""
    @property
    def reason(self) -> str | None:
        """One sentence that explains the verdict."""
    @property
    def band(self) -> DrawLawBand | None:
        """Between which values other laws put the efficiency, where [``FlowReport::with_bands``] asked."""
    @property
    def outside_laws(self) -> list[DrawOutsideLaw]:
        """Laws that were used outside their ranges."""
    @property
    def solutions(self) -> list[DrawHypergraph]:
        """Every equilibrium."""
    @property
    def dissipative_solutions(self) -> list[DrawHypergraph]:
        """Of a locked train: equilibria in which every loaded member must push."""

class DrawSpan(Record):
    """A part of a text."""
    @property
    def start(self) -> int:
        """The first byte, counted from 0."""
    @property
    def end(self) -> int:
        """The byte after the last."""
    @property
    def line(self) -> int:
        """The line of the first character."""
    @property
    def column(self) -> int:
        """The column of the first character."""
    @property
    def end_line(self) -> int:
        """The line of the character after the last."""
    @property
    def end_column(self) -> int:
        """The column of the character after the last."""

class DrawDiagnostic(Record):
    """One thing to tell the user."""
    @property
    def code(self) -> str:
        """Stable code; ``willis explain CODE`` tells more."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def place(self) -> str:
        """The place in the train, such as ``set[1].ring.teeth``; empty for the train as a whole."""
    @property
    def message(self) -> str:
        """What is the case, with the numbers and names in it."""
    @property
    def hints(self) -> list[str]:
        """What to do; may name a value that works."""
    @property
    def file(self) -> str | None:
        """The file whose text it stands on, as the caller names it."""
    @property
    def span(self) -> DrawSpan | None:
        """The part of the source text it stands on, when there is one."""
    @property
    def replacement(self) -> str | None:
        """What to put in place of the spanned text, when that is known."""

class DrawFlowReport(Record):
    """Power flows of a train: the results contract ``willis-flow-1``."""
    @property
    def format(self) -> Literal["willis-flow-1"]:
        """``willis-flow-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def source(self) -> str | None:
        """Source of its data."""
    @property
    def operations(self) -> list[DrawOperationFlow]:
        """The operating points."""
    @property
    def assumptions(self) -> list[str]:
        """What stands in for data that were not given, and what the model leaves out."""
    @property
    def diagnostics(self) -> list[DrawDiagnostic]:
        """Warnings and notes."""

class DrawFrontBody(Record):
    """A wheel in its place."""
    @property
    def centre_mm(self) -> list[float]:
        """Its axis, mm."""
    @property
    def phase(self) -> float:
        """Angle of the middle of a tooth, rad."""

class DrawFrontWheel(Record):
    """A wheel: one central gear, or one planet of which there are several alike.

    # Formula ``````text half thickness at radius r, as an angle   ψ(r) = η − inv α(r),   cos α(r) = r_b/r η = (π/2
    + 2 x tan α_n)/z + inv α_t `````` On a ring that is the half width of the space.

    # Source ``[iso21771]``, tooth thickness half angle."""
    @property
    def name(self) -> str:
        """The member it sits on."""
    @property
    def colour(self) -> int | None:
        """Number of its colour: the place of that member in the train; absent for the frame."""
    @property
    def teeth(self) -> int:
        """Tooth count ``z``."""
    @property
    def internal(self) -> bool:
        """Whether it is a ring gear."""
    @property
    def planet(self) -> bool:
        """Whether it is a planet."""
    @property
    def module_mm(self) -> float:
        """Normal module ``m_n``, mm."""
    @property
    def shift(self) -> float:
        """Profile shift coefficient ``x``, positive outward."""
    @property
    def reference_radius_mm(self) -> float:
        """Reference radius ``r``, mm."""
    @property
    def base_radius_mm(self) -> float:
        """Base radius ``r_b``, mm."""
    @property
    def tip_radius_mm(self) -> float:
        """Tip radius ``r_a``, mm."""
    @property
    def root_radius_mm(self) -> float:
        """Root radius ``r_f``, mm."""
    @property
    def base_half_angle(self) -> float:
        """Half angle ``η`` of the tooth (of the space, on a ring) at the base circle, rad."""
    @property
    def outline_mm(self) -> list[list[float]]:
        """One tooth and half a space at each side, mm, around the wheel's axis, counterclockwise; the tooth's middle
        lies on the positive x axis."""
    @property
    def turns(self) -> float:
        """Turns for one turn of the first central gear, relative to the carrier; zero where nothing can turn."""
    @property
    def ratio(self) -> str:
        """The same exactly, ``-17/22``."""
    @property
    def bodies(self) -> list[DrawFrontBody]:
        """Where its copies stand, the one of the first planet first."""

class DrawFrontMesh(Record):
    """A pair of wheels, at the first planet. The first wheel drives."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def wheels(self) -> list[int]:
        """Driving and driven wheel."""
    @property
    def centre_distance_mm(self) -> float:
        """Centre distance ``a``, mm."""
    @property
    def pressure_angle(self) -> float:
        """Operating pressure angle in the transverse section ``α_wt``, rad."""
    @property
    def backlash_mm(self) -> float:
        """Circumferential backlash ``j_t`` at the operating circles, mm."""
    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio ``ε_α``."""
    @property
    def pitch_radii_mm(self) -> list[float]:
        """Operating pitch radii ``r_w``, mm."""
    @property
    def pitch_point_mm(self) -> list[float]:
        """Pitch point C, mm."""
    @property
    def direction(self) -> list[float]:
        """Unit vector along the line of action, in the sense in which contacts run."""
    @property
    def path_mm(self) -> list[float]:
        """The points A, B, C, D, E of the path of contact: distances from C along the line of action, mm, contacts
        running from A to E."""
    @property
    def base_points_mm(self) -> list[float]:
        """Where the line of action touches the base circles, driving wheel first: distances from C, mm."""
    @property
    def base_pitch_mm(self) -> float:
        """Transverse base pitch ``p_bt``, mm: the distance of two contacts."""
    @property
    def contact_mm(self) -> float:
        """The first contact after A as the wheels stand, mm from C."""

class DrawFrontPlane(Record):
    """Wheels that lie in one plane."""
    @property
    def wheels(self) -> list[int]:
        """The wheels."""
    @property
    def meshes(self) -> list[int]:
        """Their meshes."""

class DrawFrontSpacing(Record):
    """How the planets stand around the axis."""
    @property
    def planets(self) -> int:
        """How many there are drawn."""
    @property
    def given(self) -> bool:
        """Whether the train says how many."""
    @property
    def angles(self) -> list[float]:
        """Angles from the first one, rad."""
    @property
    def equal(self) -> bool:
        """Whether all angles between neighbours are the same."""
    @property
    def least_angle(self) -> float | None:
        """Every angle at which a planet fits is a multiple of it, rad; absent when all do."""
    @property
    def clearance_mm(self) -> float | None:
        """Smallest distance of the tips of planets that do not mesh, mm; absent with one planet."""

class DrawFront(Record):
    """The transverse section of a set, or of a pair of gears.

    Lengths are in mm, angles in rad, counterclockwise. The axis of the carrier is the origin, the axis of the first
    planet stands above it, on the positive y axis. The carrier is at rest: speeds are relative to it."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def set(self) -> str:
        """The set; of a single pair, the mesh."""
    @property
    def kind(self) -> str:
        """The type of the set, as in the file; ``pair`` for a single mesh."""
    @property
    def carrier(self) -> str:
        """The member that carries the axes."""
    @property
    def assumed(self) -> bool:
        """Whether the teeth are standard ones, because the train has none."""
    @property
    def notes(self) -> list[str]:
        """What has to be said beside the picture, in sentences."""
    @property
    def wheels(self) -> list[DrawFrontWheel]:
        """Every wheel."""
    @property
    def meshes(self) -> list[DrawFrontMesh]:
        """Every pair of wheels in mesh."""
    @property
    def planes(self) -> list[DrawFrontPlane]:
        """The planes that lie one behind the other: in one plane no wheel covers another."""
    @property
    def spacing(self) -> DrawFrontSpacing:
        """The planets around the axis."""

class DrawMapPattern(Record):
    """An assignment of inputs and outputs."""
    @property
    def letter(self) -> str:
        """A capital letter."""
    @property
    def label(self) -> str:
        """``engine, mg1 -> ring``."""
    @property
    def efficiency(self) -> list[float] | None:
        """Smallest and largest efficiency in the map; absent where no regime of it is drawn."""
    @property
    def dissipated(self) -> bool:
        """No output: all power turns into heat."""

class DrawMapCell(Record):
    """A regime."""
    @property
    def regime(self) -> str:
        """Its name."""
    @property
    def ring(self) -> int:
        """0 outer ring (positive torque), 1 inner ring."""
    @property
    def slot(self) -> list[int]:
        """Its place among several of one ring, and their number."""
    @property
    def pattern(self) -> int:
        """Number of its pattern."""
    @property
    def efficiency(self) -> list[float]:
        """Efficiency at equal steps of angle, from one bound to the other."""

class DrawMapSector(Record):
    """A region of speed."""
    @property
    def region(self) -> int:
        """Number of the region."""
    @property
    def order(self) -> list[str]:
        """The order of the speeds in it."""
    @property
    def to(self) -> float:
        """Angle of its second bound."""
    @property
    def cells(self) -> list[DrawMapCell]:
        """Its regimes, the outer ring's first."""

class DrawMapBoundary(Record):
    """A line between sectors, on both sides of the centre."""
    @property
    def letter(self) -> str:
        """A small letter."""
    @property
    def label(self) -> str:
        """What is the case on it."""
    @property
    def angles(self) -> list[float]:
        """Its two angles."""
    @property
    def ratio(self) -> float | None:
        """Second over first base speed; absent when that is infinite."""
    @property
    def at_rest(self) -> bool:
        """A terminal stands still: its power passes zero. In a power split whose machines balance each other, a
        machine at rest is a mechanical point, and the label says so."""
    @property
    def locked_up(self) -> bool:
        """A set turns as one: no loss there."""

class DrawCurve(Record):
    """Efficiency of one ring over one sector."""
    @property
    def regime(self) -> str:
        """The regime."""
    @property
    def ring(self) -> int:
        """0 positive torque, 1 negative."""
    @property
    def slot(self) -> list[int]:
        """Its place among several of one ring, and their number."""
    @property
    def pattern(self) -> int:
        """Number of its pattern."""
    @property
    def points(self) -> list[list[float]]:
        """Angle (within ``half``) and efficiency."""

class DrawRegimeMap(Record):
    """The speed plane of a train with two freedoms.

    Angles are in degrees, counterclockwise from the direction of the first base speed, *as drawn*: a narrow sector
    is widened, so that it can be read, and the others shrink. Opposite directions stay opposite."""
    @property
    def title(self) -> str:
        """The train, and its state."""
    @property
    def base_speeds(self) -> list[str]:
        """The two speeds that span the plane."""
    @property
    def torque(self) -> str:
        """The torque whose sign tells the rings apart: outer ring positive, inner ring negative."""
    @property
    def balance(self) -> list[str] | None:
        """Two terminals whose powers balance, where that was asked for."""
    @property
    def patterns(self) -> list[DrawMapPattern]:
        """Every assignment of inputs and outputs that occurs."""
    @property
    def sectors(self) -> list[DrawMapSector]:
        """The sectors, counterclockwise."""
    @property
    def boundaries(self) -> list[DrawMapBoundary]:
        """The lines between them."""
    @property
    def curves(self) -> list[DrawCurve]:
        """Efficiency over the half of the wheel on which the first base speed is positive."""
    @property
    def half(self) -> list[float]:
        """The angles between which the first base speed is positive."""
    @property
    def least_efficiency(self) -> float:
        """Smallest efficiency of a regime with an output."""
    @property
    def widened(self) -> bool:
        """Whether sectors were widened."""

class DrawChartAxis(Record):
    """A quantity along an axis of a chart."""
    @property
    def name(self) -> str:
        """Its name, as ``sweep ``over```` takes it: ``sun.speed``."""
    @property
    def unit(self) -> str:
        """The unit of its values; empty for plain numbers."""
    @property
    def values(self) -> list[float]:
        """Its values, ascending."""

class DrawMapPoint(Record):
    """A point of a map."""
    @property
    def verdict(self) -> Literal["beyond"] | Literal["locked", "multiple", "refused", "undetermined", "unique", "unloaded"]:
        """One of [``PointVerdict``](willis::study::PointVerdict); ``beyond`` where no state stays within the limits of
        the input."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def input_power_w(self) -> float | None:
        """Power in, W."""
    @property
    def input_power(self) -> float | None: ...
    @property
    def loss_w(self) -> float | None:
        """All losses, W."""
    @property
    def loss(self) -> float | None: ...
    @property
    def best(self) -> int | None:
        """The best state, as position among [``EfficiencyMap::states``]."""
    @property
    def zone(self) -> int:
        """Points of a zone have the same verdict and best state, power through each mesh in the same direction, and
        the same inputs and outputs: within it the efficiency has neither jump nor kink."""

class DrawMapBorder(Record):
    """The border of two zones between two neighbouring points of the map."""
    @property
    def between(self) -> list[int]:
        """The points, as positions among [``EfficiencyMap::points``]."""
    @property
    def at(self) -> float:
        """Where it is: 0 at the first point, 1 at the second."""
    @property
    def sides(self) -> list[DrawMapPoint]:
        """What holds right before and right behind it."""

class DrawMapJoint(Record):
    """Where several zones meet."""
    @property
    def cell(self) -> int:
        """The lower left point of its cell, as position among [``EfficiencyMap::points``]."""
    @property
    def at(self) -> list[float]:
        """Where it is in the cell: 0 at that point, 1 at the next along each axis."""

class DrawMapMark(Record):
    """An operation of the file in a map."""
    @property
    def operation(self) -> str:
        """Its name."""
    @property
    def at(self) -> list[float]:
        """Where it is, in the units of the axes."""

class DrawEfficiencyMap(Record):
    """An efficiency map."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def basis(self) -> str:
        """The operating point, and what was chosen for it."""
    @property
    def x(self) -> DrawChartAxis:
        """The quantity to the right."""
    @property
    def y(self) -> DrawChartAxis:
        """The quantity upwards."""
    @property
    def points(self) -> list[DrawMapPoint]:
        """The points, row by row from the lowest ``y`` on, each row along ``x``."""
    @property
    def borders(self) -> list[DrawMapBorder]:
        """Where one zone ends and the next begins: between all neighbours of different zones."""
    @property
    def joints(self) -> list[DrawMapJoint]:
        """Where three zones or more meet within a cell of the grid."""
    @property
    def states(self) -> list[str]:
        """The states among which the best is chosen at every point; empty for a map of one state."""
    @property
    def marks(self) -> list[DrawMapMark]:
        """The operations of the file that lie in the map."""

class DrawSplitPoint(Record):
    """A mode at one ratio."""
    @property
    def efficiencies(self) -> list[float]:
        """The efficiency of every equilibrium, the best first; 0 where everything is dissipated."""
    @property
    def share(self) -> float | None:
        """Power through all variators over the input power, signed, in the best of them."""
    @property
    def powers_w(self) -> list[list[Any]]:
        """Power that each machine, or side, delivers to its member, W, in the best of them."""
    @property
    def powers(self) -> list[list[Any]]: ...
    @property
    def beyond_limits(self) -> bool:
        """Whether a limit of a variator is exceeded."""

class DrawMechanicalPoint(Record):
    """A ratio at which a side of a variator stands still, so that no power passes it."""
    @property
    def side(self) -> str:
        """The machine, or the member."""
    @property
    def ratio(self) -> float:
        """Speed of the input over that of the output."""
    @property
    def exact(self) -> str:
        """The same exactly."""

class DrawSplitMode(Record):
    """A state over the ratio."""
    @property
    def state(self) -> str | None:
        """The state of the shift table; absent for the train as drawn."""
    @property
    def points(self) -> list[DrawSplitPoint]:
        """One for each value of the axis."""
    @property
    def mechanical(self) -> list[DrawMechanicalPoint]:
        """Ratios at which a side of a variator stands still."""

class DrawSplitGear(Record):
    """A state in which the gears fix the ratio."""
    @property
    def state(self) -> str:
        """The state."""
    @property
    def ratio(self) -> float:
        """Speed of the input over that of the output."""
    @property
    def efficiency(self) -> float:
        """Output over input power."""

class DrawSplit(Record):
    """A power split over its ratio."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def basis(self) -> str:
        """The operating point, and what it prescribes."""
    @property
    def x(self) -> DrawChartAxis:
        """Speed of the input over that of the output."""
    @property
    def modes(self) -> list[DrawSplitMode]:
        """The states in which a variator has its ratio free."""
    @property
    def gears(self) -> list[DrawSplitGear]:
        """States in which the gears fix the ratio."""
    @property
    def best(self) -> list[int | None]:
        """The mode with the best efficiency at each ratio, by its place in ``modes``; absent where none has an answer."""

class DrawLossSeries(Record):
    """The losses of a source."""
    @property
    def name(self) -> str:
        """The source, as the losses name it; ``others`` for all that are too small to be told."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"] | None:
        """What kind of loss it is; of the others, none."""
    @property
    def law(self) -> str | None:
        """Its law; ``given`` for an efficiency that the file gives."""
    @property
    def sources(self) -> int:
        """How many sources it stands for."""
    @property
    def loss_w(self) -> list[float | None]:
        """W at each value of the axis, absent where there is no single answer."""
    @property
    def loss(self) -> list[float | None]: ...
    @property
    def at_operation_w(self) -> float | None:
        """W at the operating point."""
    @property
    def at_operation(self) -> float | None: ...

class DrawLossChart(Record):
    """Where the power goes, over a quantity and at the operating point."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def basis(self) -> str:
        """The operating point, and what was chosen for it."""
    @property
    def x(self) -> DrawChartAxis:
        """The quantity that varies."""
    @property
    def series(self) -> list[DrawLossSeries]:
        """The sources, the largest at the operating point first; the last may be all others together."""
    @property
    def verdicts(self) -> list[Literal["locked", "multiple", "refused", "undetermined", "unique", "unloaded"]]:
        """What can be said at each value: one of [``PointVerdict``](willis::study::PointVerdict)."""
    @property
    def efficiency(self) -> list[float | None]:
        """Output over input power at each value."""
    @property
    def at(self) -> float | None:
        """The operating point itself, in the unit of the axis, where it prescribes the quantity that varies."""
    @property
    def verdict(self) -> Literal["locked", "multiple", "refused", "undetermined", "unique", "unloaded"]:
        """What can be said of the operating point: one of [``PointVerdict``](willis::study::PointVerdict)."""
    @property
    def input_power_w(self) -> float | None:
        """Input power of the operating point, W; absent where it has no single answer."""
    @property
    def input_power(self) -> float | None: ...
    @property
    def loss_w(self) -> float | None:
        """All losses of the operating point, W."""
    @property
    def loss(self) -> float | None: ...

class DrawSpinSource(Record):
    """A loss of a gear without load."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def loss_w(self) -> float:
        """W."""
    @property
    def loss(self) -> float: ...

class DrawSpinGear(Record):
    """A gear without load."""
    @property
    def state(self) -> str:
        """The state."""
    @property
    def input(self) -> str:
        """The member that is driven."""
    @property
    def oil_k(self) -> float | None:
        """Oil temperature, K: that under the load of the operating point; absent without such a load, or without an
        oil."""
    @property
    def oil(self) -> float | None: ...
    @property
    def verdict(self) -> Literal["locked", "multiple", "refused", "undetermined", "unique", "unloaded"]:
        """What can be said of it: ``unloaded`` where nothing is lost."""
    @property
    def torque_n_m(self) -> float | None:
        """Torque that turns the input, N m; absent where there is no single answer."""
    @property
    def torque(self) -> float | None: ...
    @property
    def loss_w(self) -> float | None:
        """All losses, W; absent where there is no single answer."""
    @property
    def loss(self) -> float | None: ...
    @property
    def sources(self) -> list[DrawSpinSource]:
        """The losses by source, the largest first."""

class DrawSpinLosses(Record):
    """What each gear loses while its output is free of torque."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def speed_rpm(self) -> float:
        """Speed of the input in all gears, rpm."""
    @property
    def of_operation(self) -> str | None:
        """The operating point of the file that has this speed; absent where it was chosen here."""
    @property
    def gears(self) -> list[DrawSpinGear]:
        """The gears, in the order of the file; one named ``as drawn`` of a train without states."""

class DrawCertificate(Record):
    """Why there are no other equilibria."""
    @property
    def method(self) -> Literal["elasticity", "branch-and-bound"]:
        """The argument."""
    @property
    def proved(self) -> bool:
        """Whether bounds prove it. Else the elasticity is taken to differ within an interval no more than it does from
        one interval to the next, or, where intervals were excluded, each heat to be monotone between the
        temperatures computed."""
    @property
    def largest_elasticity(self) -> float | None:
        """Largest elasticity of the losses between two temperatures; one equilibrium where it is below 1."""
    @property
    def temperatures(self) -> int:
        """Temperatures at which the losses were computed."""
    @property
    def widest_k(self) -> float:
        """Largest distance between two of them, K."""
    @property
    def widest(self) -> float: ...

class DrawHeatEquilibrium(Record):
    """An oil temperature at which losses and heat flow agree."""
    @property
    def oil_k(self) -> float:
        """The temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def stable(self) -> bool:
        """Whether the oil returns to it after a small disturbance."""
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def step_w(self) -> list[float] | None:
        """On the step of a law: heat that reaches the oil just below and just above it, W."""
    @property
    def step(self) -> list[float] | None: ...

class DrawPlaceReport(Record):
    """A place of the network."""
    @property
    def temperature_k(self) -> float:
        """Its temperature, K."""
    @property
    def temperature(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Heat made there, W."""
    @property
    def heat(self) -> float: ...
    @property
    def share_to_oil(self) -> float:
        """Part of that heat that reaches the oil."""
    @property
    def given(self) -> bool:
        """Whether its temperature is given."""

class DrawHeatFlow(Record):
    """Heat on its way."""
    @property
    def between(self) -> list[str]:
        """From where to where."""
    @property
    def heat_w(self) -> float:
        """The heat, W; negative the other way round."""
    @property
    def heat(self) -> float: ...

class DrawHeatPoint(Record):
    """Heat at an oil temperature."""
    @property
    def oil_k(self) -> float:
        """Oil temperature, K."""
    @property
    def oil(self) -> float: ...
    @property
    def reaching_w(self) -> float:
        """Heat that reaches the oil, W: computed there, or on a straight line between two temperatures at which it
        was."""
    @property
    def reaching(self) -> float: ...
    @property
    def carried_w(self) -> float:
        """Heat that leaves it, W."""
    @property
    def carried(self) -> float: ...

class DrawHeatReport(Record):
    """The temperatures of an operating point, and where its heat goes."""
    @property
    def oil_k(self) -> float:
        """Oil temperature in force, K."""
    @property
    def oil(self) -> float: ...
    @property
    def basis(self) -> Literal["balance", "given", "limit"]:
        """Where it comes from."""
    @property
    def verdict(self) -> Literal["unique", "several", "none-below-limit", "undecided"] | None:
        """What can be said of it; absent where it is given."""
    @property
    def certificate(self) -> DrawCertificate | None:
        """Why there is no other."""
    @property
    def equilibria(self) -> list[DrawHeatEquilibrium]:
        """Every oil temperature that holds, the coldest first."""
    @property
    def undecided_k(self) -> list[list[float]]:
        """Intervals in which it could not be decided, K."""
    @property
    def undecided(self) -> list[list[float]]: ...
    @property
    def ambient_k(self) -> float:
        """Temperature of the air, K."""
    @property
    def ambient(self) -> float: ...
    @property
    def limit_k(self) -> float:
        """Highest oil temperature allowed, K."""
    @property
    def limit(self) -> float: ...
    @property
    def margin_k(self) -> float:
        """Limit less oil temperature, K."""
    @property
    def margin(self) -> float: ...
    @property
    def heat_w(self) -> float:
        """Losses that become heat in the gearbox, W."""
    @property
    def heat(self) -> float: ...
    @property
    def extra_heat_w(self) -> float:
        """Heat into the oil beside the losses, W."""
    @property
    def extra_heat(self) -> float: ...
    @property
    def cooled_elsewhere_w(self) -> float:
        """Losses of variators, which have a cooling of their own, W."""
    @property
    def cooled_elsewhere(self) -> float: ...
    @property
    def residual_w(self) -> float:
        """Heat that reaches the oil less what leaves it, W: it warms where that is above zero."""
    @property
    def residual(self) -> float: ...
    @property
    def places(self) -> Named[DrawPlaceReport]:
        """Every place."""
    @property
    def paths(self) -> list[DrawHeatFlow]:
        """Every way for heat."""
    @property
    def cooler_w(self) -> float | None:
        """Heat that the cooler takes, W; negative where it heats."""
    @property
    def cooler(self) -> float | None: ...
    @property
    def curve(self) -> list[DrawHeatPoint]:
        """Heat that reaches the oil and what it gives off, over its temperature. What reaches it is computed at the
        temperatures that the balance looked at; between those it is a straight line. Points of studies have none."""
    @property
    def slope_w_k(self) -> float | None:
        """Change of what leaves the oil less what reaches it with its temperature, W/K; above zero where it is stable."""
    @property
    def slope_w(self) -> float | None: ...
    @property
    def time_constants_s(self) -> list[float]:
        """Time constants around this temperature, s, the slowest first; none without heat capacities."""
    @property
    def time_constants(self) -> list[float]: ...
    @property
    def drivers_change(self) -> bool:
        """Whether other gears drive when the oil is cold than when it is as hot as it may be."""

class DrawHeatRow(Record):
    """Temperatures at a time."""
    @property
    def time_s(self) -> float:
        """Time, s."""
    @property
    def time(self) -> float: ...
    @property
    def temperatures_k(self) -> list[float]:
        """Temperature of each place, K."""
    @property
    def temperatures(self) -> list[float]: ...
    @property
    def heat_w(self) -> float:
        """Heat made, W."""
    @property
    def heat(self) -> float: ...

class DrawWarmUp(Record):
    """Temperatures from a start on."""
    @property
    def start_k(self) -> float:
        """Oil temperature at the start, K."""
    @property
    def start(self) -> float: ...
    @property
    def places(self) -> list[str]:
        """Places, in the order of the temperatures of a row."""
    @property
    def rows(self) -> list[DrawHeatRow]:
        """Rows, evenly spaced in time."""
    @property
    def settled_s(self) -> float | None:
        """When the oil is within 1 K of where it tends to, s; absent where it is not in the time shown."""
    @property
    def settled(self) -> float | None: ...
    @property
    def limit_after_s(self) -> float | None:
        """When the oil passes its limit, s; rows end there."""
    @property
    def limit_after(self) -> float | None: ...
    @property
    def made_j(self) -> float:
        """Heat made, J."""
    @property
    def made(self) -> float: ...
    @property
    def carried_j(self) -> float:
        """Heat carried away, J."""
    @property
    def carried(self) -> float: ...
    @property
    def stored_j(self) -> float:
        """Heat stored, J."""
    @property
    def stored(self) -> float: ...
    @property
    def audit(self) -> float:
        """Heat made less carried less stored, over the largest of them: round-off."""
    @property
    def interpolation(self) -> float:
        """Largest difference of the losses from those between which they were interpolated, over them."""
    @property
    def steps(self) -> int:
        """Steps of the integration."""

class DrawHeatPicture(Record):
    """The heat of an operating point."""
    @property
    def title(self) -> str:
        """The train, the operation and its state."""
    @property
    def heat(self) -> DrawHeatReport:
        """Temperatures, and where the heat goes."""
    @property
    def rating_w(self) -> float | None:
        """Largest power in at the limit of the oil temperature, W."""
    @property
    def rating(self) -> float | None: ...
    @property
    def warm_up(self) -> DrawWarmUp | None:
        """From a cold start on."""

class DrawPathPoint(Record):
    """A tooth pair at one place."""
    @property
    def s_mm(self) -> float:
        """Distance ``s`` from C along the line of action, mm."""
    @property
    def line_load_n_per_m(self) -> float:
        """Normal load per length of contact line, N/m."""
    @property
    def line_load(self) -> float: ...
    @property
    def sliding_m_s(self) -> float:
        """Sliding speed ``|v_g|``, m/s."""
    @property
    def sliding(self) -> float: ...
    @property
    def sum_speed_m_s(self) -> float:
        """Sum of the surface speeds ``u_1 + u_2``, m/s: twice the rolling speed."""
    @property
    def sum_speed(self) -> float: ...
    @property
    def pressure_pa(self) -> float:
        """Hertzian pressure, Pa."""
    @property
    def pressure(self) -> float: ...
    @property
    def film_m(self) -> float | None:
        """Film thickness, thermal reduction included, m; absent where nothing presses."""
    @property
    def film(self) -> float | None: ...
    @property
    def film_ratio(self) -> float | None:
        """Film thickness over the composite rms roughness, ``λ``."""
    @property
    def friction(self) -> float | None:
        """Coefficient of friction; of a mean law that of the mesh."""
    @property
    def loss_w(self) -> float | None:
        """Power ``μ F_n v_g`` that this tooth pair turns into heat here, W."""
    @property
    def loss(self) -> float | None: ...

class DrawMeshPath(Record):
    """One of the pairs in parallel of a mesh."""
    @property
    def name(self) -> str:
        """The mesh."""
    @property
    def gears(self) -> list[str]:
        """Its two members."""
    @property
    def driver(self) -> int:
        """Which of them drives, seen from the carrier."""
    @property
    def count(self) -> int:
        """Identical pairs in parallel."""
    @property
    def breakpoints_mm(self) -> list[float]:
        """The points A, B, C, D, E, mm from C along the line of action, positive towards the addendum of the first
        gear; the first gear driving, contacts run from A to E."""
    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio ``ε_α``."""
    @property
    def points(self) -> list[DrawPathPoint]:
        """From A to E, on both sides of every jump of the load."""
    @property
    def friction(self) -> float | None:
        """Mean coefficient of friction of the mesh; absent when its efficiency is given."""
    @property
    def sliding_loss_w(self) -> float:
        """Sliding loss of the mesh, all pairs in parallel, as the operating point has it, W."""
    @property
    def sliding_loss(self) -> float: ...
    @property
    def integrated_loss_w(self) -> float | None:
        """The local loss integrated over the path, over the base pitch, all pairs in parallel, W; absent when the
        efficiency is given.

        ``P = (1/p_bt) ∫ μ F_n v_g ds``: on the average over a base pitch so much is lost at once."""
    @property
    def integrated_loss(self) -> float | None: ...

class DrawContactPath(Record):
    """Load, speeds, film, friction and loss along the paths of contact of an operating point."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def operation(self) -> str:
        """The operating point."""
    @property
    def oil(self) -> str:
        """The oil."""
    @property
    def temperature_celsius(self) -> float:
        """Its temperature, °C."""
    @property
    def friction_law(self) -> str:
        """Law of tooth friction in force."""
    @property
    def local(self) -> bool:
        """Whether it gives a coefficient for each place; else one mean value for the mesh."""
    @property
    def film_law(self) -> str:
        """Law of the film thickness in force."""
    @property
    def limits(self) -> list[float]:
        """Film thickness ratios λ at which mixed and full lubrication begin."""
    @property
    def meshes(self) -> list[DrawMeshPath]:
        """Every loaded mesh that was asked for."""
    @property
    def left_out(self) -> list[str]:
        """Meshes that were asked for and are not shown, with the reason."""

class DrawPart(Record):
    """A number that belongs to a member, a shaft or a mesh."""
    @property
    def name(self) -> str:
        """The member, shaft or mesh."""
    @property
    def value(self) -> float:
        """Its number."""

class DrawVibrationMode(Record):
    """One mode, as the question ``modes`` has it."""
    @property
    def number(self) -> int | None:
        """Its number among the vibrations, from 1 on; absent for a motion without strain."""
    @property
    def frequency_hz(self) -> float:
        """Undamped natural frequency, Hz; 0 for a motion without strain."""
    @property
    def frequency(self) -> float: ...
    @property
    def damping_ratio(self) -> float | None:
        """Damping ratio; absent where nothing damps it."""
    @property
    def shape(self) -> list[DrawPart]:
        """Angle amplitude of each member whose motion is settled, relative to the largest, which is 1. Opposite signs
        swing in opposite directions."""
    @property
    def strain_energy(self) -> list[DrawPart]:
        """Share of the strain energy by shaft and elastic mesh; 1 in all, empty for a motion without strain."""

class DrawVibration(Record):
    """The stick diagram of a train, and the modes that are drawn on it."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def state(self) -> str:
        """The state of the shift table, or ``as drawn``."""
    @property
    def stick(self) -> DrawStick:
        """The schematic, the same under all modes."""
    @property
    def modes(self) -> list[DrawVibrationMode]:
        """Motions without strain first, then vibrations by rising frequency."""
    @property
    def left_out(self) -> int:
        """How many more vibrations there are."""

class DrawTimeLine(Record):
    """A curve."""
    @property
    def names(self) -> list[str]:
        """Whose it is; several names where they agree throughout."""
    @property
    def colour(self) -> int | None:
        """Number of the colour of the first, of a speed: the place of the member in the train."""
    @property
    def pieces(self) -> list[list[list[float]]]:
        """Its pieces between gaps: time, s, and value. First, least, greatest and last value of every short interval
        are kept, so that no spike is lost."""

class DrawTimePanel(Record):
    """Curves that share an axis."""
    @property
    def quantity(self) -> str:
        """Its heading: ``Speed``."""
    @property
    def unit(self) -> Literal["", "s", "rad/s", "rad", "rad/s^2", "N m", "W", "J", "K", "degC"]:
        """SI; of temperatures °C."""
    @property
    def lines(self) -> list[DrawTimeLine]:
        """The curves, in the order of the columns."""
    @property
    def left_out(self) -> int:
        """Curves that found no place: those with the smallest values."""

class DrawModeSegment(Record):
    """A time in one mode."""
    @property
    def to(self) -> float:
        """s"""
    @property
    def mode(self) -> Literal["forward", "backward", "stuck", "free"] | None:
        """Absent where the modes change too fast to be drawn."""

class DrawModeRow(Record):
    """The modes of one element."""
    @property
    def element(self) -> str:
        """The element."""
    @property
    def segments(self) -> list[DrawModeSegment]:
        """In rising time."""

class DrawTimeMark(Record):
    """A change of mode."""
    @property
    def time(self) -> float:
        """s"""
    @property
    def cause(self) -> str:
        """Why."""

class DrawTimeShift(Record):
    """A short time in which modes change, seen closely."""
    @property
    def window(self) -> list[float]:
        """From when to when, s; equally long for all shifts of a run."""
    @property
    def events(self) -> list[float]:
        """The first and the last change of mode in it, s."""
    @property
    def panels(self) -> list[DrawTimePanel]:
        """The curves of the first panels, in the same order."""

class DrawTimePlot(Record):
    """A run over time."""
    @property
    def train(self) -> str:
        """The train."""
    @property
    def scenario(self) -> str:
        """The scenario."""
    @property
    def outcome(self) -> Any:
        """How the run ended."""
    @property
    def run(self) -> list[float]:
        """Where it began and ended, s."""
    @property
    def cut(self) -> bool:
        """The run was ended where the picture ends, before the end of the scenario."""
    @property
    def axis(self) -> list[float]:
        """What the time axis shows, s: the whole scenario, unless the run ended in its first fifth."""
    @property
    def panels(self) -> list[DrawTimePanel]:
        """One a quantity."""
    @property
    def modes(self) -> list[DrawModeRow]:
        """What sticks, slips or is free."""
    @property
    def modes_left_out(self) -> int:
        """Elements that found no place among the modes."""
    @property
    def marks(self) -> list[DrawTimeMark]:
        """The first changes of mode after the start, with their causes."""
    @property
    def event_times(self) -> list[float]:
        """When modes changed, s; of several within a thousandth of the run, the first."""
    @property
    def event_count(self) -> int:
        """All changes of mode after the start, of those that are shown."""
    @property
    def shifts(self) -> list[DrawTimeShift]:
        """Where changes of mode lie together in several short times, such as the shifts of an automatic: each of them
        closely."""

class DrawShiftColumn(Record):
    """A shift element."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way"]:
        """What it is."""

class DrawShiftEfficiency(Record):
    """Efficiency of a state in one direction."""
    @property
    def value(self) -> float | None:
        """Output over input power, where that is one number."""
    @property
    def words(self) -> str:
        """``locks``, ``several``, or why there is none; empty where there is a number."""

class DrawShiftRow(Record):
    """A state."""
    @property
    def state(self) -> str:
        """Its name."""
    @property
    def closed(self) -> list[bool]:
        """Which elements are closed, by column."""
    @property
    def path(self) -> list[str] | None:
        """Where power enters and leaves when driving."""
    @property
    def ratio(self) -> float | None:
        """``ω_input/ω_output``."""
    @property
    def exact(self) -> str | None:
        """The same as a fraction."""
    @property
    def note(self) -> str | None:
        """Why there is no ratio."""
    @property
    def drive(self) -> DrawShiftEfficiency:
        """Input drives output."""
    @property
    def coast(self) -> DrawShiftEfficiency:
        """Output drives input."""

class DrawShiftChange(Record):
    """From one state to the next."""
    @property
    def opens(self) -> list[str]:
        """Elements that open."""
    @property
    def closes(self) -> list[str]:
        """Elements that close."""
    @property
    def several(self) -> bool:
        """Whether more than one element opens, or more than one closes: two shifts at once."""
    @property
    def step(self) -> float | None:
        """Ratio of the first over that of the second, where both have one sign, input and output."""

class DrawShiftSpread(Record):
    """Largest over smallest ratio."""
    @property
    def value(self) -> float:
        """The quotient."""
    @property
    def largest(self) -> str:
        """The state with the largest ratio."""
    @property
    def smallest(self) -> str:
        """The state with the smallest."""

class DrawShiftTable(Record):
    """A shift table."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def elements(self) -> list[DrawShiftColumn]:
        """The columns."""
    @property
    def rows(self) -> list[DrawShiftRow]:
        """The states, in the order of the train."""
    @property
    def changes(self) -> list[DrawShiftChange]:
        """What happens between each row and the next."""
    @property
    def spread(self) -> DrawShiftSpread | None:
        """Over all ratios of the sign of the first one."""
    @property
    def one_path(self) -> bool:
        """Whether all states have the same input and output."""

class DrawShaftMember(Record):
    """A member in a state."""
    @property
    def speed(self) -> str | None:
        """Speed over that of the input; absent where the input does not settle it."""
    @property
    def carrier(self) -> str | None:
        """The carrier on which it turns, for a planet."""
    @property
    def relative_speed(self) -> str | None:
        """Speed relative to that carrier, over the speed of the input."""
    @property
    def torque(self) -> float | None:
        """External torque over that of the input, reactions of brakes included; absent where it is not determined."""

class DrawShaftElement(Record):
    """A shift element in a state."""
    @property
    def kind(self) -> Literal["clutch", "brake", "one-way"]:
        """What it is."""
    @property
    def members(self) -> list[str]:
        """The members it joins."""
    @property
    def engaged(self) -> bool:
        """Whether it is closed."""
    @property
    def slip(self) -> str | None:
        """Speed of the first member less that of the second, over the speed of the input: 0 while it is closed."""
    @property
    def torque(self) -> float | None:
        """Torque that it exerts on the first member, over the input torque; 0 while it is open, absent where it is not
        determined."""

class DrawLosses(Record):
    """Losses by kind, W."""
    @property
    def mesh(self) -> float:
        """Tooth friction."""
    @property
    def bearing(self) -> float:
        """Bearings."""
    @property
    def windage(self) -> float:
        """Air and oil mist."""
    @property
    def churning(self) -> float:
        """Oil sump."""
    @property
    def seal(self) -> float:
        """Shaft seals."""
    @property
    def drag(self) -> float:
        """Drags that are given as torques."""
    @property
    def injection(self) -> float:
        """Oil that is sprayed into meshes."""
    @property
    def pump(self) -> float:
        """Oil pumps."""
    @property
    def variator(self) -> float:
        """Variators."""

class DrawLossSource(Record):
    """One place where power is lost."""
    @property
    def name(self) -> str:
        """What loses it."""
    @property
    def kind(self) -> Literal["sliding", "rolling", "bearing", "windage", "churning", "seal", "drag", "shift-element", "injection", "pump", "variator"]:
        """What kind of loss it is."""
    @property
    def law(self) -> str:
        """Its name in the list of laws; ``given`` for a given efficiency."""
    @property
    def loss_w(self) -> float:
        """The power, W."""
    @property
    def loss(self) -> float: ...
    @property
    def share(self) -> float:
        """The part of all losses."""

class DrawAtLoad(Record):
    """A gear at a stated load, and at the same speed without one."""
    @property
    def operation(self) -> str | None:
        """The operation of the file whose speed and load these are; absent where they were asked for."""
    @property
    def speed_rad_s(self) -> float:
        """Speed of the input, rad/s."""
    @property
    def speed(self) -> float: ...
    @property
    def torque_n_m(self) -> float:
        """Torque at the input, N m."""
    @property
    def torque(self) -> float: ...
    @property
    def temperature_k(self) -> float | None:
        """Oil temperature, K: prescribed, of the heat balance, or of the oil; absent without an oil."""
    @property
    def temperature(self) -> float | None: ...
    @property
    def beyond_limit(self) -> bool:
        """Whether no temperature up to the limit balances losses and heat flow: then it is the limit."""
    @property
    def verdict(self) -> Literal["unique", "multiple", "locked", "unloaded", "undetermined"]:
        """What can be said of the point."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power."""
    @property
    def band(self) -> DrawLawBand | None:
        """Between which values other laws put it, where that is asked for."""
    @property
    def loss_w(self) -> float | None:
        """All losses, W."""
    @property
    def loss(self) -> float | None: ...
    @property
    def losses_w(self) -> DrawLosses | None:
        """Losses by kind, W."""
    @property
    def losses(self) -> DrawLosses | None: ...
    @property
    def spin_loss_w(self) -> float | None:
        """What turns the input at this speed and temperature with nothing at the output, W: the spin loss."""
    @property
    def spin_loss(self) -> float | None: ...
    @property
    def spin_losses_w(self) -> DrawLosses | None:
        """That by kind, W."""
    @property
    def spin_losses(self) -> DrawLosses | None: ...
    @property
    def spin_sources(self) -> list[DrawLossSource]:
        """That by source, the largest first."""
    @property
    def reason(self) -> str | None:
        """Why there is no efficiency."""
    @property
    def warnings(self) -> list[str]:
        """Warnings of the point under load: laws outside their ranges, the heat balance, limits."""

class DrawShaftState(Record):
    """One state."""
    @property
    def input(self) -> str:
        """Where power enters."""
    @property
    def output(self) -> str:
        """Where it leaves."""
    @property
    def engaged(self) -> list[str]:
        """Shift elements that are closed."""
    @property
    def ratio(self) -> str | None:
        """``ω_input/ω_output``, exactly."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power, the input driving."""
    @property
    def efficiency_exact(self) -> str | None:
        """The efficiency exactly, where the efficiencies of the meshes are given."""
    @property
    def reason(self) -> str | None:
        """Why speeds or torques are missing."""
    @property
    def why(self) -> Any | None:
        """What ``reason`` says, as data."""
    @property
    def members(self) -> Named[DrawShaftMember]:
        """Every member, planets included."""
    @property
    def shift_elements(self) -> Named[DrawShaftElement]:
        """Every shift element."""
    @property
    def sets(self) -> Named[Named[float]]:
        """Torque that each member puts into each set, or mesh of no set, over the input torque."""
    @property
    def at_load(self) -> DrawAtLoad | None:
        """What it costs at a load and without one, where losses depend on that."""

class DrawShaftTable(Record):
    """Speeds and torques of a whole shift table: the results contract ``willis-table-1``."""
    @property
    def format(self) -> Literal["willis-table-1"]:
        """``willis-table-1``."""
    @property
    def train(self) -> str:
        """Name of the train."""
    @property
    def source(self) -> str | None:
        """Where its numbers come from."""
    @property
    def lossless(self) -> bool:
        """Whether torques are those without losses."""
    @property
    def states(self) -> Named[DrawShaftState]:
        """Every state; the train as drawn where it has none."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""
    @property
    def diagnostics(self) -> list[DrawDiagnostic]:
        """What to know beside it."""

class DrawTornadoBar(Record):
    """What one quantity does. Small steps down do the opposite of steps up."""
    @property
    def name(self) -> str:
        """Its path, as the file has it."""
    @property
    def value(self) -> float:
        """Its value, SI."""
    @property
    def unit(self) -> str:
        """SI unit of the value."""
    @property
    def assumed(self) -> bool:
        """Whether it is not given but taken."""
    @property
    def step(self) -> Literal["percent", "percent_less", "kelvin", "degree", "hundredth", "rpm", "tenth_millimetre", "unit"]:
        """The step up."""
    @property
    def loss_change_w(self) -> float:
        """Change of all losses for it, W."""
    @property
    def loss_change(self) -> float: ...
    @property
    def efficiency_change(self) -> float | None:
        """Change of the efficiency for it."""
    @property
    def moves(self) -> str | None:
        """The loss that it changes most."""

class DrawTornado(Record):
    """Quantities of an operating point, ranked by what a small step of each does."""
    @property
    def title(self) -> str:
        """The train, the operation and its state."""
    @property
    def efficiency(self) -> float | None:
        """Output over input power at the point; absent where nothing comes in."""
    @property
    def loss_w(self) -> float:
        """All losses at the point, W."""
    @property
    def loss(self) -> float: ...
    @property
    def input_power_w(self) -> float:
        """Power in at all inputs, W."""
    @property
    def input_power(self) -> float: ...
    @property
    def bars(self) -> list[DrawTornadoBar]:
        """The quantities, the largest change of the loss first."""
    @property
    def left_out(self) -> int:
        """How many more quantities move the loss, less than those shown."""

class DrawBandPoint(Record):
    """The bands at one value."""
    @property
    def efficiency(self) -> list[float] | None:
        """[``QUANTILES``] of the efficiency; absent where fewer than half of the samples have an answer."""
    @property
    def loss_w(self) -> list[float] | None:
        """[``QUANTILES``] of the loss, W."""
    @property
    def loss(self) -> list[float] | None: ...
    @property
    def nominal_efficiency(self) -> float | None:
        """The efficiency of the file as written."""
    @property
    def nominal_loss_w(self) -> float | None:
        """The loss of the file as written, W."""
    @property
    def nominal_loss(self) -> float | None: ...
    @property
    def answered(self) -> int:
        """Samples that have a single answer."""

class DrawBands(Record):
    """Bands in which efficiency and loss lie."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def basis(self) -> str:
        """The operating point, and what was chosen for it."""
    @property
    def x(self) -> DrawChartAxis:
        """The quantity that varies."""
    @property
    def quantities(self) -> list[str]:
        """What is uncertain, each with its distribution."""
    @property
    def samples(self) -> int:
        """Samples at each value."""
    @property
    def points(self) -> list[DrawBandPoint]:
        """The bands, one for each value of the axis."""

class DrawMissing(Record):
    """A kind of figure that does not apply to a train."""
    @property
    def kind(self) -> Literal["stick", "lever", "wolf", "sankey", "flow", "front", "regimes", "map", "split", "losses", "spin", "heat", "film", "path", "modes", "time", "shift", "table", "tornado", "band"]:
        """The kind."""
    @property
    def why(self) -> str:
        """Why."""

class DrawAnswer(_answer.Drawing):
    """A figure, or all that apply."""
    @property
    def format(self) -> Literal["willis-figures-1"]:
        """``willis-figures-1``."""
    @property
    def figures(self) -> list[DrawStick | DrawLever | DrawWolf | DrawSankey | DrawFlowReport | DrawFront | DrawRegimeMap | DrawEfficiencyMap | DrawSplit | DrawLossChart | DrawSpinLosses | DrawHeatPicture | DrawContactPath | DrawVibration | DrawTimePlot | DrawShiftTable | DrawShaftTable | DrawTornado | DrawBands]:
        """The figures, as data."""
    @property
    def missing(self) -> list[DrawMissing]:
        """Kinds that do not apply, and why."""

class ReportTitleBlock(Record):
    """What a title block says; empty where nothing was given. Nothing of it comes from a clock."""
    @property
    def project(self) -> str:
        """The project or customer."""
    @property
    def author(self) -> str:
        """Who answers for the report."""
    @property
    def date(self) -> str:
        """The date, in the words of the author."""
    @property
    def revision(self) -> str:
        """Which revision of the report it is."""

class ReportSection(Record):
    """A part of a report with a heading."""
    @property
    def title(self) -> str:
        """Its heading."""
    @property
    def blocks(self) -> list[Any]:
        """What stands in it."""

class ReportAnswer(_answer.Report):
    """A report, ready to be typeset. Written as JSON it is the contract ``willis-report-1``."""
    @property
    def format(self) -> Literal["willis-report-1"]:
        """``willis-report-1``."""
    @property
    def title(self) -> str:
        """The train."""
    @property
    def subtitle(self) -> str:
        """What kind of document it is, in a few words."""
    @property
    def title_block(self) -> ReportTitleBlock:
        """Who made it for what, as they said."""
    @property
    def facts(self) -> list[list[str]]:
        """What a reader looks for on the first page: a word and what it is."""
    @property
    def sections(self) -> list[ReportSection]:
        """The sections in their order."""

class ExportNotCarried(Record):
    """A key of the train file that is not in the export."""
    @property
    def key(self) -> str:
        """The key, without the positions of lists: ``drag.coulomb``, ``shift_element.capacity``."""
    @property
    def of(self) -> list[str]:
        """The entries that have it, by their names, where they have some."""
    @property
    def values(self) -> list[str]:
        """What is missing, with its unit: a text for each of ``of``, or one where nothing has a name."""
    @property
    def in_part(self) -> bool:
        """Whether other values of the same entries are carried, as the first row of a table."""

class ExportOneKind(Record):
    """A format to export to."""
    @property
    def name(self) -> str:
        """How it is asked for."""
    @property
    def about(self) -> str:
        """What it is, in one line."""
    @property
    def program_only(self) -> bool:
        """Whether only the program ``willis`` writes it, because the file holds more than text."""

class ExportAnswer(Answer):
    """Files for another program, or the kinds there are."""
    @property
    def format(self) -> Literal["willis-export-1"]:
        """``willis-export-1``."""
    @property
    def kind(self) -> str | None:
        """The format of the files; none where the kinds are listed."""
    @property
    def not_carried(self) -> list[ExportNotCarried]:
        """What the train file says and the files do not."""
    @property
    def assumptions(self) -> list[str]:
        """What the model leaves out, and what stands in for data that were not given."""
    @property
    def kinds(self) -> list[ExportOneKind]:
        """The kinds there are, where no kind was named."""

class ImportCounts(Record):
    """Sums of what a file has and what became of it."""
    @property
    def components(self) -> int:
        """Components of the model."""
    @property
    def attributes(self) -> int:
        """Attributes, those of load cases too."""
    @property
    def used(self) -> int:
        """Attributes that are in the train file, or from which something in it follows."""
    @property
    def left_out(self) -> int:
        """Attributes that the train file has no place for."""
    @property
    def unusable(self) -> int:
        """Attributes that would have been used, with values that cannot be."""
    @property
    def ideal_supports(self) -> int:
        """Supports without dimensions, which have no friction."""

class ImportGuess(Record):
    """Something that the file does not say and the train file does."""
    @property
    def of(self) -> str:
        """What it is about."""
    @property
    def taken(self) -> str:
        """What was taken."""
    @property
    def because(self) -> str:
        """Why."""

class ImportMissing(Record):
    """What Willis could use and the file does not have."""
    @property
    def what(self) -> str:
        """What."""
    @property
    def so(self) -> str:
        """What follows from that."""

class ImportProblem(Record):
    """Something that is wrong or odd about the file and did not stop its reading."""
    @property
    def place(self) -> str:
        """Where: a component, a relation, a line."""
    @property
    def message(self) -> str:
        """What, and what was done."""

class ImportBearingReport(Record):
    """A rolling bearing of the file."""
    @property
    def name(self) -> str:
        """What it is called in the train file."""
    @property
    def designation(self) -> str | None:
        """Its designation, where the file gives one."""
    @property
    def count(self) -> int:
        """How many of them are alike, at each planet on planets."""
    @property
    def carried(self) -> bool:
        """Whether it is in the train file; if not, its dimensions are missing there and it stands in a comment."""

class ImportColumn(Record):
    """A column of a load spectrum."""
    @property
    def name(self) -> str:
        """What it is: ``sun.speed [rpm]``."""
    @property
    def value(self) -> float:
        """Its value."""

class ImportLoadCaseReport(Record):
    """A load case of the file and the operation that it became."""
    @property
    def load_case(self) -> int | None:
        """Its number in the file; none for a file without load cases."""
    @property
    def operation(self) -> str | None:
        """The name of the operation; none if the case is left out, as the problems tell."""
    @property
    def share(self) -> float | None:
        """Its part of the operating time, where the file gives it."""
    @property
    def columns(self) -> list[ImportColumn]:
        """Speed of the first driven shaft, rpm, and torque on it, N m, or power, kW: the row of a load spectrum."""

class ImportAttributeReport(Record):
    """An attribute of the file and what became of it."""
    @property
    def load_case(self) -> int | None:
        """The load case that it stands in, by its number; none in the model itself."""
    @property
    def component(self) -> int:
        """Number of the component."""
    @property
    def type(self) -> str:
        """Its type: ``cylindrical_gear``."""
    @property
    def attribute(self) -> str:
        """Name of the attribute: ``normal_module``."""
    @property
    def value(self) -> str:
        """Its value, shortened."""
    @property
    def unit(self) -> str:
        """Its unit, as it is written."""
    @property
    def fate(self) -> Literal["used", "left-out", "unusable"]:
        """What became of it."""
    @property
    def why(self) -> str:
        """What it was used for; or why it cannot be used. Empty if it is left out."""

class ImportReport(Record):
    """What was read and what was not."""
    @property
    def kind(self) -> str:
        """The format: ``REXS`` or ``gearsets``."""
    @property
    def version(self) -> str:
        """The version that the file says it has."""
    @property
    def application(self) -> str:
        """The program that wrote it."""
    @property
    def counts(self) -> ImportCounts:
        """Sums."""
    @property
    def guessed(self) -> list[ImportGuess]:
        """What is not in the file and had to be assumed."""
    @property
    def missing(self) -> list[ImportMissing]:
        """What Willis could use and the file does not have."""
    @property
    def problems(self) -> list[ImportProblem]:
        """What is wrong or odd about the file, and what was done."""
    @property
    def more_problems(self) -> int:
        """Problems beyond those that are listed."""
    @property
    def bearings(self) -> list[ImportBearingReport]:
        """Bearings with dimensions or a designation."""
    @property
    def load_cases(self) -> list[ImportLoadCaseReport]:
        """Load cases and the operations that they became."""
    @property
    def attributes(self) -> list[ImportAttributeReport]:
        """Every attribute and what became of it."""

class ImportAnswer(Answer):
    """A train file, and what became of the file that it was made from."""
    @property
    def format(self) -> Literal["willis-import-1"]:
        """``willis-import-1``."""
    @property
    def file(self) -> str:
        """The name of the file that was read."""
    @property
    def toml(self) -> str:
        """The train file."""
    @property
    def report(self) -> ImportReport:
        """What was read, what was assumed, what is missing."""

class LawsSymbol(Record):
    """A symbol and its SI unit."""
    @property
    def symbol(self) -> str:
        """The symbol."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""

class LawsBounds(Record):
    """The range of a quantity within which a law holds."""
    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
    @property
    def unit(self) -> str:
        """Its SI unit; ``-`` for a pure number."""
    @property
    def min(self) -> float | None:
        """Lowest value, in that unit; absent where there is none."""
    @property
    def max(self) -> float | None:
        """Highest value, in that unit; absent where there is none."""

class LawsLawReport(Record):
    """A law: what it gives, where it comes from, where it holds."""
    @property
    def family(self) -> str:
        """Name of the family, ``mesh_friction``."""
    @property
    def law(self) -> str:
        """Name of the law."""
    @property
    def default(self) -> bool:
        """Whether it is the one used when nothing is chosen."""
    @property
    def title(self) -> str:
        """Title for people."""
    @property
    def gives(self) -> LawsSymbol:
        """What the family gives."""
    @property
    def source(self) -> str:
        """Key in the list of references."""
    @property
    def place(self) -> str:
        """The place in that work."""
    @property
    def trust(self) -> str:
        """How far the formula was checked."""
    @property
    def valid(self) -> list[LawsBounds]:
        """Where the source claims validity."""

class LawsOneOil(Record):
    """An oil of the catalogue."""
    @property
    def name(self) -> str:
        """Its designation."""
    @property
    def base(self) -> str:
        """Its base."""
    @property
    def viscosity_40_m2_s(self) -> float | None:
        """Kinematic viscosity at 40 °C, m²/s; absent where it is not known there."""
    @property
    def viscosity_40(self) -> float | None: ...
    @property
    def viscosity_100_m2_s(self) -> float | None:
        """Kinematic viscosity at 100 °C, m²/s; absent where it is not known there."""
    @property
    def viscosity_100(self) -> float | None: ...
    @property
    def density_15_kg_m3(self) -> float:
        """Density at 15 °C, kg/m³."""
    @property
    def density_15(self) -> float: ...
    @property
    def trust(self) -> str:
        """How far its data were checked."""

class LawsOneBearing(Record):
    """A bearing of the catalogue."""
    @property
    def designation(self) -> str:
        """Its designation."""
    @property
    def kind(self) -> str:
        """Its kind."""
    @property
    def bore_m(self) -> float:
        """Bore, m."""
    @property
    def bore(self) -> float: ...
    @property
    def outside_diameter_m(self) -> float:
        """Outside diameter, m."""
    @property
    def outside_diameter(self) -> float: ...
    @property
    def width_m(self) -> float:
        """Width, m."""
    @property
    def width(self) -> float: ...
    @property
    def static_rating_n(self) -> float | None:
        """Static load rating, N, where it is known."""
    @property
    def static_rating(self) -> float | None: ...
    @property
    def skf(self) -> bool:
        """Whether the constants of the SKF friction model are known."""
    @property
    def trust(self) -> str:
        """How far its data were checked."""

class LawsAnswer(Answer):
    """Laws, or a catalogue."""
    @property
    def format(self) -> Literal["willis-laws-1"]:
        """``willis-laws-1``."""
    @property
    def laws(self) -> list[LawsLawReport]:
        """The laws, family by family; the first of each is the default."""
    @property
    def oils(self) -> list[LawsOneOil]:
        """The catalogue of oils, where it was asked for."""
    @property
    def bearings(self) -> list[LawsOneBearing]:
        """The catalogue of bearings, where it was asked for."""

class ValidateSection(Record):
    """A part of a report."""
    @property
    def title(self) -> str:
        """Title."""
    @property
    def text(self) -> list[str]:
        """Sentences before the table."""
    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
    @property
    def rows(self) -> list[list[str | float | None]]:
        """Rows of the table."""
    @property
    def points(self) -> list[str]:
        """Points after the table."""

class ValidateGate(Record):
    """A comparison with a bound."""
    @property
    def what(self) -> str:
        """What is compared."""
    @property
    def printed(self) -> str:
        """As printed or measured."""
    @property
    def ours(self) -> float | None:
        """Ours; ``null`` where there is no number to compare, which no bound lets pass."""
    @property
    def low(self) -> float:
        """Lowest value that passes."""
    @property
    def high(self) -> float:
        """Highest value that passes."""
    @property
    def holds(self) -> bool:
        """Whether it passes."""
    @property
    def cause(self) -> str | None:
        """Why it does not, where that is known."""

class ValidateOneCase(Record):
    """A case."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def about(self) -> str:
        """What it compares."""

class ValidateAnswer(Answer):
    """A case, or the list of them."""
    @property
    def format(self) -> Literal["willis-cases-1"]:
        """``willis-cases-1``."""
    @property
    def case(self) -> str:
        """Name of the case."""
    @property
    def title(self) -> str:
        """Title."""
    @property
    def source(self) -> str:
        """Where the printed numbers come from."""
    @property
    def sections(self) -> list[ValidateSection]:
        """In the order to be read."""
    @property
    def gates(self) -> list[ValidateGate]:
        """What must hold."""
    @property
    def cases(self) -> list[ValidateOneCase]:
        """All of them."""

class ExplainExplained(Record):
    """A diagnostic code."""
    @property
    def code(self) -> str:
        """The code, ``E106``."""
    @property
    def severity(self) -> Literal["error", "warning", "note"]:
        """How much it matters."""
    @property
    def title(self) -> str:
        """One line that names the matter."""
    @property
    def explanation(self) -> str:
        """What it means, why it matters and what to do."""

class ExplainExplainedRule(Record):
    """A rule that tooth numbers may have to follow."""
    @property
    def name(self) -> str:
        """Its name in a design file."""
    @property
    def explanation(self) -> str:
        """What it demands, by which formula, and why."""

class ExplainAnswer(Answer):
    """Diagnostic codes."""
    @property
    def format(self) -> Literal["willis-codes-1"]:
        """``willis-codes-1``."""
    @property
    def codes(self) -> list[ExplainExplained]:
        """The code that was asked for, or all."""
    @property
    def rules(self) -> list[ExplainExplainedRule]:
        """The rule for teeth that was asked for, or all."""
