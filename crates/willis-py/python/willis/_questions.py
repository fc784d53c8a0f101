"""Every question of the library, as methods of a train and as functions.

Written by ``generate.py``; changes belong to the library.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, cast

from ._request import Quantity
from ._request import ask as _ask
from ._work import Progress

if TYPE_CHECKING:
    from . import _contracts as contracts
    from ._train import Train

__all__ = ["new", "design", "schemes", "import_", "laws", "validate", "explain"]


class Questions:
    """The questions that are asked of a train."""

    __slots__ = ()

    def analyze(
        self,
        *,
        state: str | None = None,
        operation: str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.AnalyzeAnswer":
        """Analyse a train: its shift table and its operating points.

        Gives for every state the exact ratio and the efficiency driving and coasting; for every operation speeds,
        torques, powers, losses, the verdict and its certificate. A train that locks is an answer, and no error.

        Parameters
        ----------
        state
            Only this state of the shift table.
        operation
            Only this operation.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> train = willis.read("examples/zf-8hp70.toml")
        >>> row = train.analyze(state="3").state()
        >>> row.exact, round(row.drive.efficiency, 4), row.drive.verdict
        ('162/77', 0.982, 'unique')
        """
        return cast(
            "contracts.AnalyzeAnswer",
            _ask(
                "analyze",
                [cast(Any, self)],
                {"state": state, "operation": operation},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def table(
        self,
        *,
        state: str | None = None,
        speed: Quantity | None = None,
        torque: str | None = None,
        temperature: str | None = None,
        lossless: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.TableAnswer":
        """Tabulate the speed of every shaft and planet, the slip of every open element and every torque, in all
        states.

        Speeds are those over the speed of the input, or in rpm at a given one. Torques are those over the torque of
        the input, which drives the output through the losses of the teeth. Where losses depend on load and speed,
        they are computed for every state at one load, and at the same speed with nothing at the output: the spin
        loss, with the drag of every open element.

        Parameters
        ----------
        state
            Only this state of the shift table.
        speed
            Show speeds in rpm at this speed of the input, and compute losses there: 2000rpm. Losses without it: at the
            speed of the file's first operation in which the input drives.
        torque
            Compute losses at this torque at the input: 150Nm. Without it: at the load of that operation.
        temperature
            Compute losses at this oil temperature: 80degC. Without it: at that of the operation, the heat balance, or
            the oil.
        lossless
            Torques without losses, and no losses at a load.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> table = willis.read("examples/zf-8hp70.toml").table(state="3", speed="1000 rpm")
        >>> table.tables["members"]["speed_rad_s"][:3].round(1)
        array([104.7, 104.7,   0. ])
        """
        return cast(
            "contracts.TableAnswer",
            _ask(
                "table",
                [cast(Any, self)],
                {"state": state, "speed": speed, "torque": torque, "temperature": temperature, "lossless": lossless},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def check(
        self,
        *,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.CheckAnswer":
        """Check a train file and say everything that is wrong with it.

        Parameters
        ----------
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> willis.read("examples/zf-8hp70.toml").check().data.states
        9
        """
        return cast(
            "contracts.CheckAnswer",
            _ask(
                "check",
                [cast(Any, self)],
                {},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def flow(
        self,
        *,
        operation: str | None = None,
        state: str | None = None,
        seen_from: str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.FlowAnswer":
        """Show where the power runs in an operating point: components, contacts, paths, losses.

        The graph has every component and every contact between components (teeth, bearings, seals, clutches), the
        power between them, the balance of each, the efficiency of each contact and of every path from input to
        output, and power that runs in circles.

        Parameters
        ----------
        operation
            Only this operation.
        state
            Only operations that run in this state of the shift table.
        seen_from
            Count speeds and powers as they are seen from this member, such as a carrier; else from the housing.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> flow = willis.read("examples/zf-8hp70.toml").flow(operation="motorway cruise")
        >>> flow.data.operations[0].name
        'motorway cruise'
        """
        return cast(
            "contracts.FlowAnswer",
            _ask(
                "flow",
                [cast(Any, self)],
                {"operation": operation, "state": state, "seen_from": seen_from},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def losses(
        self,
        *,
        operation: str | None = None,
        speeds: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        powers: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        torques: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        temperature: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        compare: str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.LossesAnswer":
        """List losses by source at a few speeds, loads and temperatures, or compare loss laws.

        Starts from the operations of the file. Loads stay as the file gives them (a torque stays that torque, a
        power that power) unless powers or torques vary them.

        Parameters
        ----------
        operation
            Only this operation.
        speeds
            Speeds of the operation's first prescribed speed: 500rpm,1000rpm,2000rpm.
        powers
            Powers at the operation's first load: 100kW,200kW.
        torques
            Torques at the operation's first load: '100 N m,200 N m'.
        temperature
            Oil temperatures: 40degC,60degC,90degC.
        compare
            Compare all laws of this family: mesh_friction, bearing, windage, ...
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> stage = willis.read("examples/fva-planetary-stage.toml")
        >>> points = stage.losses(speeds=["500 rpm", "1000 rpm"]).tables["points"]
        >>> bool(points["loss_w"][1] > points["loss_w"][0])
        True
        """
        return cast(
            "contracts.LossesAnswer",
            _ask(
                "losses",
                [cast(Any, self)],
                {"operation": operation, "speeds": speeds, "powers": powers, "torques": torques, "temperature": temperature, "compare": compare},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def heat(
        self,
        *,
        operation: str | None = None,
        state: str | None = None,
        duration: str | None = None,
        start: str | None = None,
        profile: str | os.PathLike[str] | object | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.HeatAnswer":
        """Compute how warm the gearbox gets: oil temperature, parts, warm-up, thermal rating, duty cycles.

        The oil temperature is the one at which the losses and what ``[heat]`` carries away agree, with the reason
        why there is no other, or all of them with their stability, or none below the limit. The thermal rating is
        the largest load at the limit. With heat capacities the warm-up from a cold start follows, and with a
        profile the steady state of a duty cycle that repeats itself.

        Parameters
        ----------
        operation
            Only this operation.
        state
            Only operations that run in this state of the shift table.
        duration
            How long the warm-up takes: '2 h'. Default: five time constants.
        start
            Oil temperature at the start of the warm-up: '-20 degC'. Default: that of the file, or of the air.
        profile
            A duty cycle (CSV, as for ``willis cycle``), or - for standard input: its steady state when it repeats
            itself.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> warm = willis.read("examples/industrial-planetary-heat.toml").heat(operation="rated")
        >>> warm.data.operations[0].verdict
        'unique'
        """
        return cast(
            "contracts.HeatAnswer",
            _ask(
                "heat",
                [cast(Any, self)],
                {"operation": operation, "state": state, "duration": duration, "start": start, "profile": profile},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def sensitivity(
        self,
        *,
        operation: str | None = None,
        state: str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.SensitivityAnswer":
        """Rank the inputs by their effect on efficiency and losses: what to change first.

        Derivatives by automatic differentiation of efficiency, of all losses and of each loss by every continuous
        quantity of the file and of the operation, for a step of one percent (1 K, 1 degree, 0.01 of a profile
        shift); and how far the point is from a change of the driving gear and from locking.

        Parameters
        ----------
        operation
            Only this operation.
        state
            Only operations that run in this state of the shift table.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> stage = willis.read("examples/fva-planetary-stage.toml")
        >>> stage.sensitivity().tables["quantities"]["quantity"][0]
        'P1.geometry.pressure_angle'
        """
        return cast(
            "contracts.SensitivityAnswer",
            _ask(
                "sensitivity",
                [cast(Any, self)],
                {"operation": operation, "state": state},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def uncertainty(
        self,
        *,
        operation: str | None = None,
        state: str | None = None,
        vary: Sequence[str] | str | None = None,
        laws: Sequence[str] | str | None = None,
        samples: int | None = None,
        seed: int | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.UncertaintyAnswer":
        """Compute the uncertainty of efficiency and losses: their distribution, and which input dominates it.

        Quantities are those of the train file and of the operation. Distributions: ``0.98..0.99`` (equally likely),
        ``+-5%`` about the file's value, ``normal(0.4 um, 0.05 um)`` and ``lognormal(0.4 um, 1.3)`` (both cut off at
        three standard deviations), ``triangular(0.2, 0.4, 0.8 um)``; sets of equally likely values: ``3,4``, laws:
        ``all``, ``inside`` (their range), or names.

        Without ``vary`` and ``laws``: given losses 1 - efficiency by 20 %, roughness by 20 %, the oil's temperature
        by 5 K each way, and the laws of tooth friction inside their range; each is listed as an assumption.

        Parameters
        ----------
        operation
            The operation. Default: the first one in the state, else the file's first.
        state
            In this state of the shift table.
        vary
            An uncertain quantity: 'P1.mesh_efficiency=0.985..0.995'. A list for several quantities.
        laws
            Families whose laws are each as likely as the others, with commas between; or all.
        samples
            How many samples; made a power of two.
        seed
            Other seeds give other samples; the same seed the same, bit for bit.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> stage = willis.read("examples/fva-planetary-stage.toml")
        >>> band = stage.uncertainty(samples=128).tables["results"]
        >>> bool(band["p05"][0] < band["nominal"][0] < band["p95"][0])
        True
        """
        return cast(
            "contracts.UncertaintyAnswer",
            _ask(
                "uncertainty",
                [cast(Any, self)],
                {"operation": operation, "state": state, "vary": vary, "laws": laws, "samples": samples, "seed": seed},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def calibrate(
        self,
        *,
        data: str | os.PathLike[str] | object | None = None,
        sigma: float | None = None,
        offset: Sequence[str] | str | None = None,
        parts: Sequence[str] | str | None = None,
        operation: str | None = None,
        trust_all: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.CalibrateAnswer":
        """Fit the laws of a train to tests: factors on tooth friction, bearings, churning, with what is learnt and
        what is not.

        Each row of the data, a CSV file, is one test: the measured ``loss [W]``, perhaps ``sigma [W]`` (its
        standard deviation), ``group`` (tests of one day or meter) and ``note``; the other columns say how it ran,
        with the unit in the header: ``input.speed [rpm]``, ``input.torque [N m]``, ``oil.temperature [degC]``,
        state. The priors are how far the laws of each kind of loss lie apart. The train file that results has the
        factors and what is left open of them, and every command uses it.

        Parameters
        ----------
        data
            The tests (CSV), or - for standard input.
        sigma
            Standard deviation of the measured loss where no column gives it, as a part of it. Default: 0.02.
        offset
            Look for the offset of a torque meter in each group, with its standard deviation before the tests:
            'input=0.5 N m'. Several times for several meters.
        parts
            Only these kinds of loss may move: teeth, bearing_load, bearing_no_load, seal, churning, windage, rotor.
        operation
            The operation that gives what no column sets. Default: the file's first.
        trust_all
            Take every reading as good: no outliers.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> stage = willis.read("examples/fva-planetary-stage.toml")
        >>> fitted = stage.calibrate(data="examples/tests-fva-planetary-stage.csv")
        >>> fitted.data.tests, fitted.data.learnt, fitted.data.converged
        (23, 3, True)
        """
        return cast(
            "contracts.CalibrateAnswer",
            _ask(
                "calibrate",
                [cast(Any, self)],
                {"data": data, "sigma": sigma, "offset": offset, "parts": parts, "operation": operation, "trust_all": trust_all},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def sweep(
        self,
        *,
        over: Mapping[str, object] | Sequence[str] | str | None = None,
        study: str | None = None,
        operation: str | None = None,
        state: str | None = None,
        hold: Literal["as-given", "torque", "power", "output"] | None = None,
        columns: Sequence[str] | str | None = None,
        fast: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.SweepAnswer":
        """Evaluate a train at many points: maps, trends, every gear at once.

        Any quantity of the train file or of the operating point can vary, along any number of axes:

        ::

              over=["input.speed=500 rpm..12000 rpm:100", "output.torque=10..400 N m:80"]

        ::

              over=["state=all", "P1.planet.count=3,4,6", "oil.temperature=20..100 degC:9"]

        ``500..12000 rpm:100`` is 100 evenly spaced values, both ends included; ``:31:log`` is 31 values with a
        constant ratio; ``:step 500 rpm`` is a value every 500 rpm. Torque and power of ``input`` and ``output`` are
        positive driving and negative coasting; of a member called by its name they are those on it, as in the train
        file. Every point is that of ``analyze``; a point that is locked or has several solutions is a row that says
        so.

        Parameters
        ----------
        over
            An axis, QUANTITY=VALUES; a list for several axes, the last runs fastest. A mapping from quantities to
            values, ``{"input.speed": "500..6000 rpm:12", "input.torque": [50.0, 100.0]}``, with numbers in SI units; or
            a list of texts.
        study
            A [[study]] of the train file, instead of axes and what belongs to them.
        operation
            The operation from which the sweep starts. Default: the first one in the state, else the file's first.
        state
            The state of the shift table.
        hold
            What stays the same while other quantities vary.
        columns
            More columns: members, meshes, elements, sources, all, or single ones such as carrier.torque_n_m.
        fast
            Compile the train, for maps of millions of points: given efficiencies; axes of speed, torque, state, and a
            few values of the file; no columns of powers and warnings. Numbers agree with ``analyze`` to a part in
            10^12.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> train = willis.read("examples/zf-8hp70.toml")
        >>> points = train.sweep(over={"input.speed": "500..6000 rpm:12", "input.torque": [100.0, 200.0]}, state="3")
        >>> len(points), points["loss_w"].shape
        (24, (24,))
        """
        return cast(
            "contracts.SweepAnswer",
            _ask(
                "sweep",
                [cast(Any, self)],
                {"over": over, "study": study, "operation": operation, "state": state, "hold": hold, "columns": columns, "fast": fast},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def cycle(
        self,
        *,
        profile: str | os.PathLike[str] | object | None = None,
        ignore_column: Sequence[str] | str | None = None,
        only_column: Sequence[str] | str | None = None,
        operation: str | None = None,
        state: str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.CycleAnswer":
        """Compute the energy lost over a duty cycle or load spectrum: by source, state and direction, the worst rows.

        Each row of the profile, a CSV file, is one operating condition. A column weighs the rows in time: ``time
        [s]`` of a trace (each row holds until the next), or ``duration [s]``, ``hours`` or ``share`` of a spectrum.
        The other columns set quantities, with the unit in the header: ``input.speed [rpm]``, ``output.torque [N
        m]``, ``oil.temperature [degC]``, state, or any quantity of the train file. Rows without an answer are
        listed with their reason, and *coverage* is the part of the time that the energies hold for.

        Parameters
        ----------
        profile
            The profile (CSV), or - for standard input.
        ignore_column
            Leave this column of the profile out; its name, with or without the unit. A list for several columns.
        only_column
            Read this column of the profile and no others than are named so. A list for several columns.
        operation
            The operation that gives what no column sets. Default: the first one in the state, else the file's first.
        state
            State of the shift table, where no column gives it.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> train = willis.read("examples/zf-8hp70.toml")
        >>> day = {"state": ["3", "8"], "duration_s": [10, 20], "input.speed_rpm": [2000, 1800], "output.torque_n_m": [300, 100]}
        >>> train.cycle(profile=day).data.format
        'willis-cycle-1'
        """
        return cast(
            "contracts.CycleAnswer",
            _ask(
                "cycle",
                [cast(Any, self)],
                {"profile": profile, "ignore_column": ignore_column, "only_column": only_column, "operation": operation, "state": state},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def compare(
        self,
        *others: Train,
        operation: str | None = None,
        state: str | None = None,
        over: Mapping[str, object] | Sequence[str] | str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.CompareAnswer":
        """Lay variants of a train side by side: what the files differ in, and what that changes.

        Keys that differ come first, then states and operations by the size of their differences, then in a line
        what is equal. Operations of one name that prescribe different things are compared and marked. With ``over``
        the same axes are applied to every variant: which is better where, and by how much.

        Parameters
        ----------
        operation
            Only this operation.
        state
            Only this state, and operations in it.
        over
            A quantity and its values: 'input.speed=500 rpm..6000 rpm:12'. A list for a grid. A mapping from quantities
            to values, ``{"input.speed": "500..6000 rpm:12", "input.torque": [50.0, 100.0]}``, with numbers in SI units;
            or a list of texts.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> train = willis.read("examples/zf-8hp70.toml")
        >>> "b_less_a" in train.compare(train.with_(**{"P1.sun.teeth": 46})).tables["states"]
        True
        """
        return cast(
            "contracts.CompareAnswer",
            _ask(
                "compare",
                [cast(Any, self), *others],
                {"operation": operation, "state": state, "over": over},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def regimes(
        self,
        *,
        state: str | None = None,
        terminals: Sequence[str] | str | None = None,
        balance: Sequence[str] | str | None = None,
        family: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.RegimesAnswer":
        """List every regime of a train: who drives whom, in which speeds, with which formula.

        For two and more degrees of freedom: the regions of speed, the signs of the torques, inputs and outputs, the
        driving gears, the closed formula of efficiency and loss, the boundaries and what changes across them, and
        which assignments of inputs and outputs cannot be reached. For one degree of freedom: driving and coasting
        of every state with its formula.

        Parameters
        ----------
        state
            Only this state of the shift table, or "as drawn".
        terminals
            Members on which torque may act, with commas between; else the train's terminals.
        balance
            Two terminals whose powers add to zero: the machines of a hybrid with an idle battery.
        family
            One set with three terminals: for every basic ratio it can have (Esmail's Table 1).
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> split = willis.read("examples/prius-p112.toml")
        >>> len(split.regimes(terminals=["engine", "ring", "mg1"]).tables["regimes"])
        28
        """
        return cast(
            "contracts.RegimesAnswer",
            _ask(
                "regimes",
                [cast(Any, self)],
                {"state": state, "terminals": terminals, "balance": balance, "family": family},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def formula(
        self,
        *,
        state: str | None = None,
        from_: Sequence[str] | str | None = None,
        to: Sequence[str] | str | None = None,
        terminals: Sequence[str] | str | None = None,
        balance: Sequence[str] | str | None = None,
        regime: str | None = None,
        lang: Literal["text", "latex", "python", "rust", "c", "modelica"] | None = None,
        ratios: Literal["basic", "teeth", "numbers"] | None = None,
        efficiencies: Literal["basic", "meshes", "numbers"] | None = None,
        derivatives: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.FormulaAnswer":
        """Give the closed formula of efficiency, speed ratio and torque ratio, also as code.

        Emitted code checks first whether its formula holds for its arguments and refuses to answer where it does
        not.

        Parameters
        ----------
        state
            Only this state of the shift table, or "as drawn".
        from_
            Where power enters; else the state's input. Several with commas between.
        to
            Where power leaves; else the state's output. Several with commas between.
        terminals
            Members on which torque may act, for two and more degrees of freedom.
        balance
            Two terminals whose powers add to zero.
        regime
            Only the regime of this name, as ``willis regimes`` lists it.
        lang
            How to write it.
        ratios
            How ratios are written.
        efficiencies
            How efficiencies are written.
        derivatives
            Also the derivatives with respect to every efficiency: which mesh matters most.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> willis.read("examples/zf-8hp70.toml").formula(state="3").data.formulas[0].speed_ratio.text
        '(1 - i_P1)*(1 - i_P4)/(1 - i_P1 - i_P4)'
        """
        return cast(
            "contracts.FormulaAnswer",
            _ask(
                "formula",
                [cast(Any, self)],
                {"state": state, "from": from_, "to": to, "terminals": terminals, "balance": balance, "regime": regime, "lang": lang, "ratios": ratios, "efficiencies": efficiencies, "derivatives": derivatives},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def locate(
        self,
        *,
        state: str | None = None,
        speeds: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        torques: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        powers: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        operation: str | None = None,
        terminals: Sequence[str] | str | None = None,
        balance: Sequence[str] | str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.LocateAnswer":
        """Find the regime of an operating point, how far each boundary is and what changes there.

        Works for trains of any size: it looks at this one point.

        Parameters
        ----------
        state
            State of the shift table; else the train as drawn.
        speeds
            Speeds of as many members as there are degrees of freedom: engine=2000rpm,ring=1000rpm.
        torques
            Torques of as many terminals as are independent: 'engine=100 N m'.
        powers
            Powers into the train, in place of torques: 'engine=40 kW'.
        operation
            Take speeds, torques and powers from this operation of the file.
        terminals
            Members on which torque may act, with commas between; else the train's terminals.
        balance
            Two terminals whose powers add to zero.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> split = willis.read("examples/prius-p112.toml")
        >>> split.locate(speeds={"engine": 200.0, "ring": 150.0}, torques={"engine": 80.0}).data.region
        2
        """
        return cast(
            "contracts.LocateAnswer",
            _ask(
                "locate",
                [cast(Any, self)],
                {"state": state, "speeds": speeds, "torques": torques, "powers": powers, "operation": operation, "terminals": terminals, "balance": balance},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def simulate(
        self,
        scenario: str | None = None,
        *,
        columns: Sequence[str] | str | None = None,
        samples: int | None = None,
        from_: Quantity | None = None,
        to: Quantity | None = None,
        tolerance: float | None = None,
        fixed_step: Quantity | None = None,
        lagged_forces: bool | None = None,
        continue_when_ambiguous: bool | None = None,
        most_events: int | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.SimulateAnswer":
        """Simulate a scenario: how the train accelerates, sticks, slips and shifts, and where the energy goes.

        A run that jams, has several solutions or ends otherwise before the scenario is an answer, and the outcome
        says so. Ctrl-C ends the run where it is. In both cases Willis writes and prints what was computed.

        Rows are in SI units; where a value is not determined the field is empty (CSV) or null. Modes are 1 forward,
        -1 backward, 0 stuck, 2 free. A CSV of a run that ended early has a last line that begins with ``# `` and
        says when and why, also where the disk was full; in Parquet the metadata ``willis.complete`` is false and
        ``willis.ended_s`` has the time.

        Parameters
        ----------
        scenario
            The scenario; required if the file has several.
        columns
            Only these columns in rows and figure, by kind (speed, torque, mode, ...) or by name.
        samples
            How many rows, evenly spaced in time; else as the scenario says.
        from_
            Rows and events from this time on: '2 s'. The run begins at its start, and energies are those of the whole
            run.
        to
            End the run here instead of at the end of the scenario: '3 s'.
        tolerance
            Relative tolerance of speeds and angles, from 1e-13 to 1e-2 [default: 1e-10].
        fixed_step
            Use fixed time steps of this length (real time): '1 ms'.
        lagged_forces
            Take the sign of each tooth force from the step before, as in Galvagno 2010, to show the error of that.
        continue_when_ambiguous
            Where several motions are possible, continue with the first.
        most_events
            Stop after so many stick-slip changes within a thousandth of the scenario [default: 1000].
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> run = willis.read("examples/launch.toml").simulate(samples=11)
        >>> run.data.outcome.verdict, bool(run["wheels.speed"][-1] > 20)
        ('finished', True)
        """
        return cast(
            "contracts.SimulateAnswer",
            _ask(
                "simulate",
                [cast(Any, self)],
                {"scenario": scenario, "columns": columns, "samples": samples, "from": from_, "to": to, "tolerance": tolerance, "fixed_step": fixed_step, "lagged_forces": lagged_forces, "continue_when_ambiguous": continue_when_ambiguous, "most_events": most_events},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def modes(
        self,
        *,
        state: str | None = None,
        fixed: Sequence[str] | str | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.ModesAnswer":
        """List torsional natural frequencies: shapes, damping, where the energy is.

        Small vibrations of the moments of inertia on the elastic shafts; the gears tie them together.

        Parameters
        ----------
        state
            State of the shift table; else the train as drawn.
        fixed
            Members held at rest, with commas between.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> modes = willis.read("examples/galvagno.toml").modes().tables["modes"]
        >>> "frequency_hz" in modes
        True
        """
        return cast(
            "contracts.ModesAnswer",
            _ask(
                "modes",
                [cast(Any, self)],
                {"state": state, "fixed": fixed},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def draw(
        self,
        kind: Literal["stick", "lever", "wolf", "sankey", "flow", "front", "regimes", "map", "split", "losses", "spin", "heat", "film", "path", "modes", "time", "shift", "table", "tornado", "band", "all"] | None = None,
        *,
        state: str | None = None,
        operation: str | None = None,
        part: str | None = None,
        over: Mapping[str, object] | Sequence[str] | str | None = None,
        terminals: Sequence[str] | str | None = None,
        balance: Sequence[str] | str | None = None,
        seen_from: str | None = None,
        nominal: bool | None = None,
        from_: Quantity | None = None,
        to: Quantity | None = None,
        coarse: bool | None = None,
        animated: bool | None = None,
        theme: Literal["light", "dark", "auto"] | None = None,
        scale: float | None = None,
        width: float | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.DrawAnswer":
        """Draw a train: its scheme, levers, power flow, teeth, regimes, maps, losses.

        A kind that does not apply to a train says why, and which do. ``all`` draws whatever applies. ``--format
        json`` gives the figure as data.

        Parameters
        ----------
        kind
            What to draw; ``all`` draws whatever applies into a folder.
        state
            A state of the shift table.
        operation
            An operation; else the file's first, or all where a figure shows several.
        part
            The set, mesh or scenario to draw.
        over
            A quantity along an axis, as ``sweep`` takes it: "sun.speed=500..3000 rpm:40". A mapping from quantities to
            values, ``{"input.speed": "500..6000 rpm:12", "input.torque": [50.0, 100.0]}``, with numbers in SI units; or
            a list of texts.
        terminals
            Members on which torque may act, with commas between (regimes); else the train's terminals.
        balance
            Two terminals whose powers add to zero (regimes).
        seen_from
            Show powers as they are seen from this member, such as a carrier (sankey, flow); else from the housing.
        nominal
            Draw teeth without geometry as nominal ones of module 1.
        from_
            From when a scenario is shown (time): "3 s".
        to
            Until when a scenario is shown (time): "3500 ms".
        coarse
            Fewer points and samples, for a first look at what takes long (map, band).
        animated
            Wheels turn (front, in SVG).
        theme
            Light or dark, or as the reader's screen is set.
        scale
            Pixels of a PNG to a unit of the figure, from 0.1 to 10.
        width
            Lay the figure out for paper so many mm wide, with no text below 7 pt; what cannot be so narrow is wider.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> willis.read("examples/zf-8hp70.toml").draw("lever", state="3").svg[:4]
        '<svg'
        """
        return cast(
            "contracts.DrawAnswer",
            _ask(
                "draw",
                [cast(Any, self)],
                {"kind": kind, "state": state, "operation": operation, "part": part, "over": over, "terminals": terminals, "balance": balance, "seen_from": seen_from, "nominal": nominal, "from": from_, "to": to, "coarse": coarse, "animated": animated, "theme": theme, "scale": scale, "width": width},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def report(
        self,
        *,
        operation: str | None = None,
        project: str | None = None,
        author: str | None = None,
        date: str | None = None,
        revision: str | None = None,
        appendix: bool | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.ReportAnswer":
        """Write the engineering report of a train: one file that explains itself, as web page or PDF.

        What was examined and what not, all gears with ratio, speeds and torques, warnings; train with schematic,
        data sheets of the wheels, results with verdict and certificate, power flow, forces on bearings, losses and
        what to change first, maps, regimes and closed formulas, assumptions, laws with their sources, and how to do
        it again. No text is smaller than 7 pt. The same input gives the same bytes.

        Parameters
        ----------
        operation
            Only this operation.
        project
            Project or customer, for the title block.
        author
            Who answers for the report, for the title block.
        date
            Date for the title block, in your own words; none is taken from a clock.
        revision
            Revision of the report, for the title block.
        appendix
            Add the train file as an appendix.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> willis.read("examples/zf-8hp70.toml").report().html[:15]
        '<!DOCTYPE html>'
        """
        return cast(
            "contracts.ReportAnswer",
            _ask(
                "report",
                [cast(Any, self)],
                {"operation": operation, "project": project, "author": author, "date": date, "revision": revision, "appendix": appendix},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )

    def export(
        self,
        kind: Literal["csv", "vecto", "modelica-loss-table", "modelica", "modelica-equations", "simscape", "mujoco", "drake", "openfast", "c", "simulink", "rexs", "fmu", "list"] | None = None,
        *,
        state: str | None = None,
        all_states: bool | None = None,
        operation: str | None = None,
        speeds: str | None = None,
        torques: str | None = None,
        temperature: Mapping[str, Quantity] | Sequence[Quantity] | Quantity | None = None,
        threads: int | None = None,
        yes: bool = False,
        progress: bool | Progress | None = None,
    ) -> "contracts.ExportAnswer":
        """Write loss maps, efficiency tables, models and actuator blocks for other programs.

        Without a kind it lists the kinds. Numbers are those of ``analyze``, at every point of the ranges. Without
        ranges Willis takes them from the operating points of the file and prints them. What a format cannot say (a
        lock, several solutions, a dependence on load) stands in the comments of the file and among the notes; a
        point without an answer gets no number.

        Parameters
        ----------
        kind
            The format: vecto, modelica-loss-table, ...; or list.
        state
            This state of the shift table.
        all_states
            Every state that can be exported.
        operation
            Take state and ranges from this operation of the file.
        speeds
            Speeds of the input: 200rpm..2200rpm:11 are 11 values; or 500rpm,1000rpm.
        torques
            Torques on the input, positive driving, negative coasting: '-500 N m..500 N m:21'.
        temperature
            Oil temperatures: 40degC,90degC. Most formats take one.
        threads, yes, progress
            Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
            called with a word, how much is done and how much there is.

        Examples
        --------
        >>> list(willis.read("examples/zf-8hp70.toml").export("csv", state="3").files("files"))
        ['zf-8hp70-3.csv']
        """
        return cast(
            "contracts.ExportAnswer",
            _ask(
                "export",
                [cast(Any, self)],
                {"kind": kind, "state": state, "all_states": all_states, "operation": operation, "speeds": speeds, "torques": torques, "temperature": temperature},
                threads=threads,
                yes=yes,
                progress=progress,
            ),
        )


def new(
    kind: Literal["set", "automatic", "split", "losses", "motion"] | None = None,
    *,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.NewAnswer":
    """Write a commented train file to start from.

    Without a kind it lists the kinds: ``willis new automatic -o mine.toml``.

    Parameters
    ----------
    kind
        The kind, as listed.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> text = willis.new("set").files("toml").popitem()[1].decode()
    >>> willis.Train(text).analyze().state().drive.verdict
    'unique'
    """
    return cast(
        "contracts.NewAnswer",
        _ask(
            "new",
            [],
            {"kind": kind},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def design(
    *,
    file: str | os.PathLike[str] | object | None = None,
    like: str | os.PathLike[str] | object | None = None,
    kind: str | None = None,
    ratio: float | str | tuple[float, float] | None = None,
    tolerance: float | str | tuple[float, float] | None = None,
    ring: Quantity | None = None,
    module: Sequence[Quantity] | Quantity | None = None,
    planets: str | None = None,
    forward: float | str | tuple[float, float] | None = None,
    backward: float | str | tuple[float, float] | None = None,
    top: int | None = None,
    sort: str | None = None,
    all: bool | None = None,
    recompute: int | None = None,
    write: Sequence[int] | None = None,
    teeth: Sequence[str] | str | None = None,
    shard: str | None = None,
    resume: Sequence[str | os.PathLike[str] | object] | None = None,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.DesignAnswer":
    """Find every train that does what is wanted: tooth numbers, numbers of planets, modules.

    The file is a train file in which teeth and planets are ranges ("18..60", "18.. odd", [23, 29]) with a table
    ``[design]``: ratios of the states with tolerances, rules, limits, demands, and what is to be small or large.
    The whole space is searched: the answer says how many trains satisfy the wish, that there are no others, and
    which of them no other one beats. For an empty answer it says which wish must give, and how far.

    Without a file, a kind of drive with its ratio will do: ``kind`` with ``ratio``, perhaps ``ring``. With ``like``
    a train of your own is marked among the rows; without a file it is also where the search begins. With ``write``
    rows are train files for every other command; with ``teeth`` so are tooth numbers, without a search.

    Parameters
    ----------
    file
        The design file (TOML), or - for standard input.
    like
        A train that exists: a row of its own. Without FILE, trains with its connections, ratios and rings are searched.
    kind
        Without a file: the kind of drive, simple, two-stage, 3k, stepped, two-rings or ravigneaux.
    ratio
        Of ``kind``: the ratio, a number or low..high.
    tolerance
        Of ``kind`` and ``like``: how far a ratio may be off, as a part. Default: 0.01.
    ring
        Of ``kind`` and ``like``: the largest reference diameter of a ring: 90mm.
    module
        Of ``kind``: modules that are allowed: 0.5mm,0.6mm. Default where the ring is limited: those of DIN 780 to 8 mm.
    planets
        Of ``kind``: numbers of planets. Default: 3..5.
    forward
        Of ``kind`` and ``like``: the least efficiency from input to output.
    backward
        Of ``kind`` and ``like``: the least efficiency from output to input: a drive that can be driven back.
    top
        Show so many rows. Default: 20.
    sort
        Sort by error, ring_diameter, forward, backward, lock_margin, planet_spin, member_speed or element_torque.
        Default: the first objective of the file.
    all
        Rows of all trains that satisfy the wish, not only of those that no other one beats.
    recompute
        Compute so many trains at most with the laws of friction of the file, in its operations, so that these laws rank
        them: all trains where there are no more, else those that no other one beats. With 0 mesh efficiencies rank.
        Default: 500.
    write
        Write the train files of these rows: 3, or 1,2,5 into a folder.
    teeth
        Give the train with these teeth as a train file, without a search: 12/47/105/40/99 as in a row, of several sets
        20/12/44,22/13/48.
    shard
        Only this part of the work: 3/16 is the third of sixteen.
    resume
        Go on from what ``progress`` kept; several times to put parts together.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> found = willis.design(kind="3k", ratio=100, ring=0.09, module=0.0008, sort="forward")
    >>> found.data.waterfall[0].trains, found.data.completeness.complete
    (1064, True)
    >>> willis.Train(found.files("train").popitem()[1].decode()).analyze().state().drive.verdict
    'unique'
    """
    return cast(
        "contracts.DesignAnswer",
        _ask(
            "design",
            [],
            {"file": file, "like": like, "kind": kind, "ratio": ratio, "tolerance": tolerance, "ring": ring, "module": module, "planets": planets, "forward": forward, "backward": backward, "top": top, "sort": sort, "all": all, "recompute": recompute, "write": write, "teeth": teeth, "shard": shard, "resume": resume},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def schemes(
    *,
    sets: int | None = None,
    k: Sequence[str] | str | None = None,
    layout: str | os.PathLike[str] | object | None = None,
    elements: int | None = None,
    closed: int | None = None,
    forward: int | None = None,
    reverse: int | None = None,
    forward_range: str | None = None,
    reverse_range: str | None = None,
    step: str | None = None,
    progressive: bool | None = None,
    not_minimal: bool | None = None,
    max_speed: str | None = None,
    max_torque: str | None = None,
    min_efficiency: str | None = None,
    mesh_efficiency: Sequence[str] | str | None = None,
    max_brakes: int | None = None,
    planar: bool | None = None,
    order: str | None = None,
    top: int | None = None,
    sample: int | None = None,
    rediscover: str | None = None,
    hybrid: bool | None = None,
    clutches: int | None = None,
    need: Sequence[str] | str | None = None,
    mobility: int | None = None,
    write: Sequence[int] | None = None,
    shard: str | None = None,
    resume: Sequence[str | os.PathLike[str] | object] | None = None,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.SchemesAnswer":
    """Find all shift schemes: who is joined to whom, which elements close in which gear.

    All layouts of so many simple planetary sets are searched with all choices of clutches and brakes; with
    ``layout`` only the elements of one layout. In every gear as many elements are closed, from gear to gear one
    opens and one closes. The answer is complete, and says so: how many choices there are, what each rule leaves of
    them, and that there are no others. Where nothing is left it says which wish must give way, and how far. With
    ``write`` a scheme becomes a train file that every other command takes; with ``format`` design-file too it
    becomes a design file, for which ``willis design`` finds the tooth numbers.

    With ``hybrid`` it finds trains of an engine, an output and two motors whose clutches make the modes that are
    needed.

    Parameters
    ----------
    sets
        How many simple planetary sets. Default: as many as there are tooth ratios.
    k
        Tooth ratio of each set, ring over sun: 109/67,91/49,97/39. Fractions are the teeth of ring and sun. Default:
        those of a known transmission with as many sets (2: GM 440-T4, 3: Allison 2000, 4: ZF 8HP70).
    layout
        Keep these permanent connections and search the elements: a train file, of which the tooth ratios are kept too,
        or the digits of a layout, as in 345360678751.
    elements
        How many clutches and brakes.
    closed
        How many of them are closed in every gear. Default, with a layout: as many as leave one freedom.
    forward
        How many forward gears.
    reverse
        How many reverse gears. Default: 1.
    forward_range
        The ratios of forward gears lie here: 0.5..6; an end may be left out.
    reverse_range
        The ratios of reverse gears, without their sign, lie here: 1.5..7.
    step
        The steps, each a ratio over that of the next gear, lie here: 1.1..2.2.
    progressive
        No step is larger than the one before it.
    not_minimal
        Schemes with an element that can be left out count too.
    max_speed
        No shaft turns faster, per speed of the input: 3.5.
    max_torque
        No element carries more, per torque of the input and without losses: 4.
    min_efficiency
        No gear has a lower efficiency when the input drives, by tooth friction alone: 0.95.
    mesh_efficiency
        Efficiencies of the meshes of sun and planet, and of planet and ring, in every set. Default: 0.98,0.99.
    max_brakes
        At most so many of the elements are brakes.
    planar
        Only schemes that can be drawn with nested shafts and without a crossing.
    order
        Which come first: found (the order of their names), spread (the largest), torque, speed, step (the smallest),
        efficiency (the largest of the worst gear). Default: found.
    top
        Show so many rows. Default: 10, or as many as ``write`` names.
    sample
        Examine one of so many layouts: a sample, in which nothing is complete.
    rediscover
        Say whether this known transmission is among the schemes: gm-440-t4, allison-2000, zf-8hp70.
    hybrid
        Search for hybrids.
    clutches
        How many clutches and brakes a hybrid has.
    need
        Modes that a hybrid must have, with commas between: input-split, output-split, compound-split, electric, fixed,
        ...
    mobility
        Freedoms of a hybrid with no clutch closed. Default: 3.
    write
        Write the train files of these rows: 3, or 1,2,5 into a folder.
    shard
        Only this part of the work: 3/16 is the third of sixteen.
    resume
        Go on from what ``progress`` kept; several times to put parts together.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> wish = {"elements": 4, "closed": 2, "forward": 3, "step": "1.15..2.2", "forward_range": "0.5..5", "reverse_range": "1.2..5"}
    >>> found = willis.schemes(sets=2, **wish)
    >>> found.data.found.schemes, found.data.completeness.complete
    (653, True)
    """
    return cast(
        "contracts.SchemesAnswer",
        _ask(
            "schemes",
            [],
            {"sets": sets, "k": k, "layout": layout, "elements": elements, "closed": closed, "forward": forward, "reverse": reverse, "forward_range": forward_range, "reverse_range": reverse_range, "step": step, "progressive": progressive, "not_minimal": not_minimal, "max_speed": max_speed, "max_torque": max_torque, "min_efficiency": min_efficiency, "mesh_efficiency": mesh_efficiency, "max_brakes": max_brakes, "planar": planar, "order": order, "top": top, "sample": sample, "rediscover": rediscover, "hybrid": hybrid, "clutches": clutches, "need": need, "mobility": mobility, "write": write, "shard": shard, "resume": resume},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def import_(
    file: str | os.PathLike[str] | object | None = None,
    *,
    convention: str | None = None,
    schedule: str | os.PathLike[str] | object | None = None,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.ImportAnswer":
    """Read a gearbox of another program: a REXS file, or gearsets JSON, becomes a train file.

    REXS 1.0 to 1.6, as XML (.rexs), JSON (.rexsj) or zip (.rexsz): cylindrical and planetary stages, gears with
    their geometry, bearings, lubricant, shift elements and load cases. The train file begins with what was assumed
    and what is missing; as text the answer is an account of every attribute: used, left out or unusable. A broken
    file is read as far as it goes. Worm and bevel stages are refused.

    Gearsets JSON describes an automatic transmission: sets with Ns and Nr, clutches, brakes, sprags; its shift
    schedule stands in a file of its own.

    Parameters
    ----------
    file
        The file of the other program, or - for standard input.
    convention
        Sign of the profile shifts of ring gears in the file: din (positive inward, as REXS says) or outward. Default:
        din.
    schedule
        The shift schedule that belongs to a transmission spec of gearsets JSON.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> found = willis.import_("examples/planetary-stage.rexs")
    >>> train = willis.Train(found.files("train").popitem()[1].decode())
    >>> len(train.analyze().data.operations)
    2
    """
    return cast(
        "contracts.ImportAnswer",
        _ask(
            "import",
            [],
            {"file": file, "convention": convention, "schedule": schedule},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def laws(
    family: Literal["mesh_friction", "rolling", "loss_factor", "load_sharing", "film", "film_reduction", "bearing", "windage", "churning", "seal", "rotor_drag", "clutch_drag", "pump", "injection", "plain_bearing"] | None = None,
    *,
    oils: bool | None = None,
    bearings: bool | None = None,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.LawsAnswer":
    """List every loss law with its range, source and how far it was checked.

    Parameters
    ----------
    family
        Only this family.
    oils
        List the catalogue of oils instead.
    bearings
        List the catalogue of bearings instead.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> willis.laws("film").tables["laws"]["family"][0]
    'film'
    """
    return cast(
        "contracts.LawsAnswer",
        _ask(
            "laws",
            [],
            {"family": family, "oils": oils, "bearings": bearings},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def validate(
    case: Literal["wang-2020", "losses", "galvagno", "design"] | None = None,
    *,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.ValidateAnswer":
    """Compare published numbers with ours: what agrees, what does not, and why.

    Without a case it lists the cases. A number that differs is an answer, and no error.

    Parameters
    ----------
    case
        The case, as listed.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> willis.validate().data.cases[0].name
    'wang-2020'
    """
    return cast(
        "contracts.ValidateAnswer",
        _ask(
            "validate",
            [],
            {"case": case},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )


def explain(
    code: Literal["E001", "E002", "E003", "E004", "E005", "E006", "E007", "E008", "E101", "E102", "E103", "E104", "E105", "E106", "E107", "E108", "E109", "E110", "E111", "E112", "E113", "E114", "E201", "E202", "E203", "E204", "E205", "E206", "E207", "E208", "E209", "E210", "E211", "E212", "W301", "W302", "W303", "W304", "W305", "W306", "W307", "W308", "W309", "W310", "W311", "W312", "W313", "W314", "W315", "W316", "W317", "W318", "W319", "W320", "W321", "W322", "W330", "W331", "N401", "N402", "N403", "N404", "N405", "assembly", "clearance", "interference", "hunting", "in-phase", "in-sequence", "shifts"] | None = None,
    *,
    threads: int | None = None,
    yes: bool = False,
    progress: bool | Progress | None = None,
) -> "contracts.ExplainAnswer":
    """Explain a diagnostic code or a rule for teeth, or list all of them.

    Parameters
    ----------
    code
        The code, such as E106, or a rule of ``design``, such as hunting.
    threads, yes, progress
        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is
        called with a word, how much is done and how much there is.

    Examples
    --------
    >>> willis.explain("E207").text.splitlines()[0]
    'E207: there is no such state or operation'
    """
    return cast(
        "contracts.ExplainAnswer",
        _ask(
            "explain",
            [],
            {"code": code},
            threads=threads,
            yes=yes,
            progress=progress,
        ),
    )
