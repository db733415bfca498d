"""James-Stein state estimators as Blocks, derived from a Plant."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.estimators import Exercise
from ..reference.james_stein import JamesSteinExercise, JamesSteinOracle, Reading
from ..reference.model import Model
from .block import Block, Scenario
from .derivation import Derivation, Reads, dynamics_equations, known_sources, plant_equations
from .discretisation import transition
from .errors import ModelError
from .expressions import equation_text, numpy_callable
from .names import check_unique
from .origins import Origin
from .plant import Plant, Sensor, Symbol, wrap
from .program import (
    AllOf,
    Assign,
    Attempt,
    Call,
    Compare,
    Element,
    Entry,
    Evaluate,
    IsSet,
    Place,
    Raise,
    Refuse,
    Statement,
    When,
    Within,
)
from .shrinkage import (
    LEAST_PIVOT,
    Weights,
    cholesky,
    constant_weights,
    exact,
    reduced,
    shape_of,
    weight_of,
    whitened,
)
from .signals import Kind, Signal, Status, power_of_unit

Array = NDArray[Any]

MOST_CHANGING_STATES = 8
"""States up to which weights that change are computed in C: their code grows with the cube of it."""

MOST_ITERATIONS = 20
HIGHEST = 1.0e6
"""Of a standard deviation, and of gamma."""

LARGEST = 1.0e30
"""Of D2; beyond it, or NaN, a reading is refused (OVERFLOW)."""


def james_stein_estimator(
    plant: Plant,
    *,
    sensors: Sequence[str] | None = None,
    std: Mapping[str, float] | float | None = None,
    shaping: Mapping[str, Any] | Any = None,
    gamma: Mapping[str, float] | float | None = None,
    around: Mapping[Any, Any] | None = None,
    iterations: int = 5,
    rank_deficient: str = "refuse",
    float_bound: float = 0.05,
    name: str | None = None,
    doc: str = "",
) -> Block:
    """Return the James-Stein state estimator of a discrete plant, or its modified form.

    It keeps no covariance: a reading y = h(x, u) + Pi v, v ~ N(0, r^2 I), of a sensor that sees every state gives the state
    x_ML of maximum likelihood, and the prediction x- is moved towards it,

        x+ = x- + s (x_ML - x-),   s = (1 - r^2 c / D2)^+,   D2 = ||Pi^-1 C (x_ML - x-)||^2,

    far where they disagree by more than the noise explains (Meda-Campana 2018, eqs. 20-24; Manton, Krishnamurthy & Poor
    1998). The modified form multiplies s by exp(-gamma / r^2) (eq. 25). Process noise is not used.

    Parameters
    ----------
    plant : Plant
        Discrete, without attitudes. Noise v in a sensor's expression gives Pi = N(x-) = dh/dv.
    sensors : sequence of str, optional
        The sensors to use, each by itself; default all.
    std : float or dict, optional
        Sensor -> r, a run-time parameter ``std_<sensor>``, 0 or more. Default: that of the plant's noise where it is the
        same in all rows (Pi = I), or of the noises that enter by N v (Pi = N); else 1, Pi a root of the noise matrix.
    shaping : (m, m) array, expression or dict, optional
        Sensor -> Pi, instead of the plant's. Then give `std`, unless the plant's noise is r^2 Pi Pi'.
    gamma : float or dict, optional
        Sensor -> gamma, a run-time parameter ``gamma_<sensor>``, 0 or more, in the unit of r^2; it makes the modified form.
    around : dict, optional
        State or input -> nominal value: default of the initial estimate, and where the test traces stay. Default 0.
    iterations : int
        Steps of Gauss-Newton from x- to x_ML where h is not linear in the state.
    rank_deficient : {"refuse", "reduce"}
        Whether a constant C of rank below n is refused, or corrects in the subspace that it sees (no method of the paper).
    float_bound, name, doc
        As for `extended_kalman_filter`; default name ``<plant>_jsse``, or ``<plant>_jssem`` with gamma.

    Returns
    -------
    Block
        Entries `init`, `predict`, one ``update_<sensor>`` each, `step`. An update reports the innovation y - h(x-), D2
        and the weight of the reading.

    Raises
    ------
    ModelError
        If the plant is continuous, has an attitude, or a sensor's rank is below n; if Pi is singular, or a number is out
        of its range; if weights that change are asked for more than 8 states.

    Warns
    -----
    UserWarning
        If the condition of a constant Pi^-1 C is above 1e12.
    """
    suffix = "jsse" if gamma is None else "jssem"
    what = "James-Stein estimator" if gamma is None else "Modified James-Stein estimator"
    options = _Options(sensors, std, shaping, gamma, iterations, rank_deficient)
    maker = _Builder(
        plant, name or f"{plant.name}_{suffix}", doc or f'{what} of the plant "{plant.name}"', around, options
    )
    maker.block.float_bound = float_bound
    return maker.build()


@dataclass(frozen=True)
class _Options:
    sensors: Sequence[str] | None
    std: Any
    shaping: Any
    gamma: Any
    iterations: int
    rank_deficient: str


@dataclass(frozen=True)
class _Measured:
    """A sensor as it is taken: h, C = dh/dx, the shape Pi Pi', and where they are constant the weights."""

    sensor: Sensor
    inputs: tuple[Symbol, ...]
    h: ca.SX
    C: ca.SX
    shape: ca.SX
    given_shaping: ca.SX | None
    weights: Weights | None
    nonlinear: bool
    std: Signal
    unit_std: float
    gamma: Signal | None


class _Builder(Derivation):
    """Derives the weights, then assembles the Block."""

    def __init__(self, plant: Plant, name: str, doc: str, around: Mapping[Any, Any] | None, options: _Options):
        if around is not None and not isinstance(around, Mapping):
            raise ModelError(f"{name}: around is {around!r}; give a dictionary, name -> number")
        super().__init__(plant, name, doc, around or {})
        self.options, self.n = options, plant.error_size
        if plant.has_attitude:
            raise ModelError(
                f"{plant.name}: a James-Stein estimator keeps vectors, and this plant has an attitude; use "
                "extended_kalman_filter"
            )
        if options.rank_deficient not in ("refuse", "reduce"):
            raise ModelError(f"{name}: rank_deficient is {options.rank_deficient!r}; give 'refuse' or 'reduce'")
        if not isinstance(options.iterations, int) or not 1 <= options.iterations <= MOST_ITERATIONS:
            raise ModelError(
                f"{name}: iterations is {options.iterations!r}; give a whole number from 1 to {MOST_ITERATIONS}"
            )
        self.nominal_point = self.nominal()
        self.measured = [self._measured(sensor) for sensor in self._chosen()]

    # -- what the user said -------------------------------------------------------------------------------------------

    def _chosen(self) -> list[Sensor]:
        known = {sensor.signal.name: sensor for sensor in self.plant.sensors}
        if self.options.sensors is None:
            chosen = list(known)
        else:
            chosen = [self.options.sensors] if isinstance(self.options.sensors, str) else list(self.options.sensors)
        unknown = [item for item in chosen if item not in known]
        if unknown or not chosen:
            raise ModelError(f"{self.name}: sensors= names {unknown}; give some of {', '.join(known)}")
        for what in ("std", "shaping", "gamma"):
            given = getattr(self.options, what)
            if isinstance(given, Mapping) and set(given) - set(chosen):
                raise ModelError(
                    f"{self.name}: {what}= names {sorted(set(given) - set(chosen))}, which are no sensors of it"
                )
        return [sensor for item, sensor in known.items() if item in chosen]

    def _given(self, what: str, sensor: str) -> Any:
        given = getattr(self.options, what)
        return given.get(sensor) if isinstance(given, Mapping) else given

    def _number(self, what: str, sensor: str, value: Any) -> float:
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not 0 <= number <= HIGHEST:
            raise ModelError(f"{self.name}: {what} of {sensor!r} is {value!r}; give a number from 0 to {HIGHEST:g}")
        return number

    def _noise(self, sensor: Sensor) -> ca.SX:
        """Return the plant's noise matrix of a sensor, its strengths as numbers."""
        plant, size = self.plant, sensor.signal.size
        R = ca.SX(size, size)
        if sensor.strength is not None:
            R += ca.SX(ca.sparsify(ca.DM(sensor.strength)))
        if sensor.variance_expression is not None:
            R += plant.without_noise(plant.folded(sensor.variance_expression))
        noises = plant.sensor_noises(sensor)
        if noises:
            N = self._noise_gain(sensor)
            R += N @ ca.SX(ca.sparsify(ca.diagcat(*[ca.DM(noise.strength) for noise in noises]))) @ N.T
        return ca.sparsify(R)

    def _shape(self, sensor: Sensor) -> tuple[ca.SX, ca.SX | None, float, float, str]:
        """Return Pi Pi', Pi where it was given, what the plant's noise is divided by, r, and the unit of r."""
        name, size, unit = sensor.signal.name, sensor.signal.size, sensor.signal.unit
        noise = self._noise(sensor)
        given, std = self._given("shaping", name), self._given("std", name)
        if given is None:
            shape, unit_std, unit = self._own_shape(sensor, noise)
            return shape, None, unit_std, unit_std if std is None else self._number("std", name, std), unit
        Pi = self.plant.folded(ca.SX(given if isinstance(given, ca.SX) else ca.DM(np.atleast_2d(given).astype(float))))
        if Pi.shape != (size, size):
            raise ModelError(f"{self.name}: shaping of {name!r} has shape {Pi.shape}; give a {size} x {size} matrix")
        Pi = ca.sparsify(Pi)
        shape = Pi @ Pi.T
        if std is None:
            std = _std_beside(noise, shape)
            if std is None:
                raise ModelError(
                    f"{self.name}: the noise of the sensor {name!r} is no multiple of its shaping Pi Pi'; give std="
                )
        return shape, Pi, 1.0, self._number("std", name, std), unit

    def _own_shape(self, sensor: Sensor, noise: ca.SX) -> tuple[ca.SX, float, str]:
        """Return Pi Pi' of the plant's own noise, the std that was taken out of it, and the unit of that.

        Noise that is the same in every row has Pi = I; noises of one std that enter by N v have Pi = N; of any other the
        whole matrix is Pi Pi'.
        """
        uniform = _uniform_variance(noise)
        if uniform is not None:
            return ca.SX.eye(sensor.signal.size), math.sqrt(uniform), sensor.signal.unit
        entering = self.plant.sensor_noises(sensor)
        if entering and sensor.strength is None and sensor.variance_expression is None:
            common = _uniform_variance(ca.diagcat(*[ca.SX(ca.DM(item.strength)) for item in entering]))
            if common is not None:
                N = self._noise_gain(sensor)
                units = {item.signal.unit for item in entering}
                return ca.sparsify(N @ N.T), math.sqrt(common), units.pop() if len(units) == 1 else ""
        return noise, 1.0, ""

    def _noise_gain(self, sensor: Sensor) -> ca.SX:
        """Return N = dh/dv."""
        stacked = ca.vertcat(*[noise.symbol for noise in self.plant.sensor_noises(sensor)])
        return self.plant.without_noise(ca.jacobian(self.plant.folded(sensor.expression), stacked))

    def _measured(self, sensor: Sensor) -> _Measured:
        plant, signal = self.plant, sensor.signal
        h = plant.without_noise(plant.folded(sensor.expression))
        C = ca.sparsify(ca.jacobian(h, plant.x))
        shape, Pi, unit_std, std, unit = self._shape(sensor)
        everything = ca.vertcat(ca.vec(ca.densify(C)), ca.vec(ca.densify(shape)))
        changes = bool(ca.symvar(everything))
        nonlinear = bool(ca.depends_on(ca.vec(C), plant.x))
        weights = None
        if changes:
            self._check_changing(sensor, C)
        else:
            numbers = np.array(ca.DM(ca.densify(C)))
            rows = (
                exact(np.array(ca.DM(ca.densify(shape)))) if Pi is None else shape_of(np.array(ca.DM(ca.densify(Pi))))
            )
            weights = constant_weights(
                self.name, signal.name, numbers, rows, reduce=self.options.rank_deficient == "reduce"
            )
        std_signal = Signal(
            f"std_{signal.name}", 1, unit, (0.0,), (HIGHEST,), f"standard deviation r of the noise of {signal.name}",
            default=(std,), source=signal.source,
        )  # fmt: skip
        given = self._given("gamma", signal.name)
        gamma = None
        if given is not None:
            gamma = Signal(
                f"gamma_{signal.name}", 1, power_of_unit(unit, 2), (0.0,), (HIGHEST,),
                f"{signal.name} weighs exp(-gamma / r^2) times less", default=(self._number("gamma", signal.name, given),),
                source=signal.source,
            )  # fmt: skip
        used = ca.vertcat(h, everything)
        inputs = tuple(symbol for symbol in plant.inputs if ca.depends_on(used, symbol))
        return _Measured(sensor, inputs, h, C, shape, Pi, weights, nonlinear, std_signal, unit_std, gamma)

    def _check_changing(self, sensor: Sensor, C: ca.SX) -> None:
        """Refuse what cannot be computed in C: too many states, a rank that is low wherever one looks, `reduce`."""
        name = sensor.signal.name
        if self.n > MOST_CHANGING_STATES:
            raise ModelError(
                f"{self.name}: the weights of the sensor {name!r} change from step to step, which is computed in C for at most "
                f"{MOST_CHANGING_STATES} states, and there are {self.n}; make its derivative and its noise constant"
            )
        rank = self._rank_anywhere(C)
        if rank < self.n:
            raise ModelError(
                f"{self.name}: the sensor {name!r} has rank {rank} and the state n = {self.n} elements, so that no state of "
                "maximum likelihood exists; let one sensor measure them all"
            )
        if self.options.rank_deficient == "reduce":
            raise ModelError(
                f"{self.name}: rank_deficient='reduce' needs constant weights, and those of the sensor {name!r} change; leave it "
                "out"
            )

    def _rank_anywhere(self, C: ca.SX) -> int:
        """Return the highest rank of C at the nominal and at some other points."""
        plant = self.plant
        x0, u0 = self.nominal_point
        p0 = np.array([item for symbol in plant.parameters for item in (symbol.signal.default or ())])
        function = ca.Function("C", [plant.x, plant.u, plant.p], [ca.densify(C)], {"allow_free": True})
        if function.get_free():
            raise ModelError(f"{plant.name}: a sensor's derivative uses {function.get_free()}, which it does not take")
        rng = np.random.RandomState(0)
        highest = 0
        for k in range(6):
            spread_out = [
                value + k * (0.1 + 0.1 * np.abs(value)) * rng.normal(size=value.size) for value in (x0, u0, p0)
            ]
            matrix = np.array(function(*spread_out))
            if np.all(np.isfinite(matrix)):
                highest = max(highest, int(np.linalg.matrix_rank(matrix)))
        return highest

    # -- assembly -----------------------------------------------------------------------------------------------------

    def _declare(self) -> None:
        block, plant = self.block, self.plant
        block.param_signals += [symbol.signal for symbol in plant.parameters]
        for made in self.measured:
            block.param_signals += [made.std] if made.gamma is None else [made.std, made.gamma]
        self.declare_states()

    def _init(self) -> Entry:
        body: list[Statement] = [
            Assign(Place("next", state.signal.name), Place("param", f"{state.signal.name}_0"), state.signal.size)
            for state in self.plant.states
        ]
        doc = "Start (or start again) from the initial estimate in the parameters; every parameter is checked here."
        return Entry("init", (), (), tuple(body), doc, checks_params=True)

    def _predict(self) -> Entry:
        targets, names = self.next_states()
        equations = dynamics_equations(self.plant)
        origins = [
            Origin("dynamics", text, known_sources(self.plant.dynamics_sources.get(state.signal.name, "")))
            for state in self.plant.states
            for text in equations[state.error_at]
        ]
        outputs = [(transition(self.plant)[0], targets, names)]
        evaluate = self.evaluate("predict", self.step_reads(), outputs, ["x = f(x, u)", *equations], [origins])
        return Entry(
            "predict", tuple(self.step_inputs()), (), (evaluate, self.judge()), "Move the estimate one step ahead."
        )

    def _correction(self, made: _Measured) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX | float, ca.SX | None]:
        """Return innovation, x_ML - x-, D2, c, and the least pivot where the weights are computed in C."""
        plant = self.plant

        def residual(h: ca.SX) -> ca.SX:
            difference = ca.SX(made.sensor.measurement) - h
            return wrap(difference) if made.sensor.signal.angle else difference

        innovation = residual(made.h)
        if made.weights is not None:
            b = _sparse(made.weights.whiten) @ innovation
            return innovation, _sparse(made.weights.solve) @ b, ca.sumsqr(b), made.weights.shrink, None
        root, pivot = cholesky(made.shape)
        change, last = ca.SX.zeros(self.n), None
        for k in range(self.options.iterations if made.nonlinear else 1):
            h, C = ca.substitute([made.h, made.C], [plant.x], [plant.x + change]) if k else (made.h, made.C)
            last = reduced(whitened(root, C), whitened(root, residual(h)))
            pivot = ca.fmin(pivot, last.pivot)
            change = change + last.solution()
        assert last is not None
        if made.nonlinear:  # weights where the state of maximum likelihood lies
            C = ca.substitute(made.C, plant.x, plant.x + change)
            last = reduced(whitened(root, C), ca.SX.zeros(C.shape[0]))
            pivot = ca.fmin(pivot, last.pivot)
            distance = ca.sumsqr(last.image(change))
        else:
            distance = ca.sumsqr(last.seen)
        shrink: ca.SX | float = 0.0
        if self.n > 2:
            effective = last.effective_dimension()
            shrink = ca.fmax(0, ca.fmin(self.n - 2, 2 * (effective - 2)))
        return innovation, change, distance, shrink, pivot

    def _update(self, made: _Measured) -> Entry:
        plant, sensor = self.plant, made.sensor
        name, m = sensor.signal.name, sensor.signal.size
        innovation, change, distance, shrink, pivot = self._correction(made)
        r = ca.SX.sym(made.std.name)
        gamma = None if made.gamma is None else ca.SX.sym(made.gamma.name)
        # the squared distance is named, so that it is computed once
        d2 = ca.SX.sym("distance_squared")
        weight = ca.substitute(weight_of(d2, r, shrink, gamma), d2, distance)
        moved = plant.wrapped(plant.x + weight * change)
        targets, names = self.next_states()
        parameters: Reads = (
            [ca.SX(symbol) for symbol in plant.parameters] + [r] + ([] if gamma is None else [gamma]),
            [((Place("param", s.signal.name), s.signal.size),) for s in plant.parameters]
            + [((Place("param", made.std.name), 1),)]
            + ([] if made.gamma is None else [((Place("param", made.gamma.name), 1),)]),
        )
        reads: list[Reads] = [
            self.state_reads(),
            ([ca.SX(sensor.measurement)], [((Place("in", name), m),)]),
            self.input_reads(made.inputs),
            parameters,
        ]
        out = Place("out", "distance_squared")
        outputs = [
            (innovation, ((Place("out", "innovation"), m),), tuple(f"innovation_{i}" for i in range(m))),
            (distance, ((out, 1),), ("distance_squared",)),
            (weight, ((Place("out", "weight"), 1),), ("weight",)),
            (moved, targets, names),
        ]
        body: list[Statement] = []
        if pivot is not None:
            local = Place("local", "least_pivot")
            outputs.append((pivot, ((local, 1),), ("least_pivot",)))
            body.append(Refuse(Status.NOT_POSITIVE, AllOf((Compare(Element(local), ">=", LEAST_PIVOT),))))
        comment, origins = self._said(made, len(outputs))
        evaluate: Evaluate = self.evaluate(f"update_{name}", reads, outputs, comment, origins)
        # ends that a weight never comes near: only what is no number is outside
        is_number = Within(Place("out", "weight"), (-1.0,), (2.0,))
        finite = Refuse(Status.OVERFLOW, AllOf((Within(out, (0.0,), (LARGEST,)), is_number)))
        body = [evaluate, *body, finite, self.judge()]
        reading = Signal(**{**sensor.signal.__dict__, "doc": sensor.doc or "reading"})
        return Entry(
            f"update_{name}",
            (reading, *[symbol.signal for symbol in made.inputs]),
            self._report(made),
            tuple(body),
            f"Move the estimate towards what one reading of {name} says.",
            sources=known_sources(sensor.signal.source),
        )

    def _report(self, made: _Measured) -> tuple[Signal, ...]:
        signal = made.sensor.signal
        wrapped_text = ", wrapped" if signal.angle else ""
        m = signal.size
        return (
            Signal(
                "innovation", m, signal.unit, (-LARGEST,) * m, (LARGEST,) * m, "measured minus expected" + wrapped_text,
                angle=signal.angle,
            ),
            Signal(
                "distance_squared", 1, power_of_unit(made.std.unit, 2), (0.0,), (LARGEST,),
                "D2, of the reading from the prediction",
            ),
            Signal("weight", 1, "", (0.0,), (1.0,), "of the reading: 1 takes what it says, 0 leaves the prediction"),
        )  # fmt: skip

    def _said(self, made: _Measured, outputs: int) -> tuple[list[str], list[list[Origin]]]:
        """Return the comment of an update, and what each of its outputs comes from."""
        sensor = made.sensor
        name, m = sensor.signal.name, sensor.signal.size
        said = known_sources(sensor.signal.source, *[item.signal.source for item in self.plant.sensor_noises(sensor)])
        texts = equation_text(sensor.expression, self.plant.symbol_names(), 200)
        tail = ", wrapped" if sensor.signal.angle else ""
        rows = [f"innovation{f'[{i}]' if m > 1 else ''} = {name}{f'[{i}]' if m > 1 else ''} - ({text}){tail}"
                for i, text in enumerate(texts)]  # fmt: skip
        if made.weights is not None:
            how = f"e = L innovation, constant weights: n* = {made.weights.effective_dimension:.9g}, c = {made.weights.shrink:.9g}"
        else:
            how = "e = x_ML - x, by least squares of the whitened reading"
            how += f" and {self.options.iterations} steps of Gauss-Newton" if made.nonlinear else ""
        factor = "" if made.gamma is None else " exp(-gamma / r^2)"
        formula = f"x = x + s e, s = max(0, 1 - r^2 c / D2){factor}, D2 = |Pi^-1 C e|^2"
        following = [Origin("estimator", formula, said)] * self.plant.x.numel()
        single = [[Origin("estimator", text, said)] for text in ("D2 = |Pi^-1 C e|^2", f"weight = s of {formula}")]
        origins = [[Origin("sensor", text, said) for text in rows], *single, following]
        if outputs > len(origins):
            origins.append([Origin("estimator", "least pivot of the whitened C and of the noise's shape", said)])
        return [*rows, how, formula], origins

    def _step(self, predict: Entry, updates: list[Entry]) -> Entry:
        inputs, outputs = list(predict.inputs), list[Signal]()
        body: list[Statement] = [Call("predict", tuple((s.name, Place("in", s.name)) for s in predict.inputs))]
        for made, entry in zip(self.measured, updates, strict=True):
            name = made.sensor.signal.name
            flag = Signal(
                f"has_{name}", kind=Kind.FLAG, low=(0.0,), high=(1.0,), doc=f"whether there is a reading of {name}"
            )
            inputs += [flag, entry.inputs[0]]
            group = Signal(name, kind=Kind.GROUP, members=entry.outputs, doc=f"what update_{name} reported, else zeros")
            outputs += [Signal(f"status_{name}", kind=Kind.STATUS, doc=f"status of {name} itself"), group]
            zeros: tuple[Statement, ...] = tuple(
                Assign(Place("out", f"{name}.{signal.name}"), 0.0, signal.size) for signal in entry.outputs
            )
            given = tuple((signal.name, Place("in", signal.name)) for signal in entry.inputs)
            report = Place("out", f"status_{name}")
            attempt = Attempt(
                (Call(entry.name, given, Place("out", name)),), report, (), (*zeros, Raise(Status.SKIPPED))
            )
            flagged = IsSet(Element(Place("in", flag.name)))
            body.append(When(flagged, (attempt,), (*zeros, Assign(report, 0.0, 1)), name))
        doc = "Predict, then every sensor that has a reading, in this order; a refused sensor is skipped."
        return Entry("step", tuple(inputs), tuple(outputs), tuple(body), doc)

    def build(self) -> Block:
        """Derive and assemble."""
        plant, block = self.plant, self.block
        self._declare()
        predict = self._predict()
        updates = [self._update(made) for made in self.measured]
        entries = [self._init(), predict, *updates, self._step(predict, updates)]
        block.entries = {entry.name: entry for entry in entries}
        block.equations = plant_equations(plant)
        block.notes = [*self.notes(), "No covariance is kept, and process noise is not used."]
        for made in self.measured:
            name = made.sensor.signal.name
            block.notes.append(
                f"Weights of {name}: n* = {made.weights.effective_dimension:.9g}, c = {made.weights.shrink:.9g}."
                if made.weights is not None
                else f"Weights of {name} are computed in each call; NOT_POSITIVE says that its rank is too low there."
            )
        block.source_hash = plant.fingerprint()
        block.check()
        check_unique(
            [(s.name, f"the field {s.name!r}") for s in (*block.memory_signals, *block.param_signals)]
            + [(symbol.signal.name, f"the input {symbol.signal.name!r}") for symbol in plant.inputs]
            + [(made.sensor.signal.name, f"the sensor {made.sensor.signal.name!r}") for made in self.measured],
            block.name,
        )
        model = self.textbook_model(
            [(made.sensor, made.inputs) for made in self.measured], (0.0,) * self.n, (math.inf,) * self.n
        )
        noises = self._numbers_of_noises()
        block.oracle = JamesSteinOracle(model, {m.sensor.signal.name: self._reading(m) for m in self.measured}, noises)
        block.scenario = self._scenario(model, noises)
        return block

    # -- independence -------------------------------------------------------------------------------------------------

    def _numbers_of_noises(self) -> dict[str, Array]:
        """Return the plant's own strengths, under the names of the textbook model's parameters."""
        plant, numbers = self.plant, {}
        for noise in plant.noises:
            kind = "density" if noise.is_density else "variance"
            numbers[f"{kind}_{noise.signal.name}"] = _packed(noise.strength, noise.full)
        for sensor in plant.sensors:
            if sensor.strength is not None:
                numbers[f"variance_{sensor.signal.name}"] = _packed(sensor.strength, sensor.full)
        for name, values in plant.step_variances.items():
            numbers[f"variance_step_{name}"] = np.array(values)
        return numbers

    def _reading(self, made: _Measured) -> Reading:
        plant, shape = self.plant, None
        if made.given_shaping is not None:
            z = ca.SX(made.sensor.measurement)
            Pi = ca.densify(plant.without_noise(made.given_shaping))
            shape = numpy_callable(ca.Function("shaping", [plant.x, z, plant.u, plant.p], [Pi]))
        return Reading(
            std=made.unit_std,
            shape=shape,
            iterations=self.options.iterations if made.nonlinear else 1,
            modified=made.gamma is not None,
            reduced=self.options.rank_deficient == "reduce",
            constant=made.weights is not None,
        )

    def _spread(self) -> Array:
        """Return the variance of the state of maximum likelihood at the nominal point: the natural size of an error."""
        plant = self.plant
        x0, u0 = self.nominal_point
        p0 = np.array([item for symbol in plant.parameters for item in (symbol.signal.default or ())])
        best = np.full(self.n, np.inf)
        for made in self.measured:
            noise = self._noise(made.sensor)
            z = ca.SX(made.sensor.measurement)
            function = ca.Function("noise", [plant.x, plant.u, plant.p, z], [ca.densify(made.C), ca.densify(noise)])
            C, R = (np.array(item) for item in function(x0, u0, p0, np.zeros(z.numel())))
            if not (np.all(np.isfinite(C)) and np.all(np.isfinite(R))):
                continue
            L = np.linalg.pinv(C)
            own = np.diag(L @ R @ L.T)
            best = np.minimum(best, np.where(own > 0, own, np.inf))
        fallback = (0.01 * (1 + np.abs(x0))) ** 2
        return np.clip(np.where(np.isfinite(best), best, fallback), 1e-12, 1e6)

    def _scenario(self, model: Model, noises: Mapping[str, Array]) -> Scenario:
        plant, variances = self.plant, self._spread()
        x0, u0 = self.nominal_point
        params = {signal.name: np.array(signal.default) for signal in self.block.param_signals}
        params |= {**noises} | {f"gate_{made.sensor.signal.name}": np.zeros(1) for made in self.measured}
        low = np.array([item for symbol in plant.inputs for item in symbol.signal.low])
        high = np.array([item for symbol in plant.inputs for item in symbol.signal.high])
        u_spread = np.minimum(0.01 * (high - low), 1.0 + np.abs(u0))
        exercise = JamesSteinExercise(Exercise(model, x0, u0, u_spread, variances, params))
        sigma = np.sqrt(variances)

        def scales(memory: Mapping[str, Any]) -> dict[str, Any]:
            return {state.signal.name: sigma[state.at] for state in plant.states}

        return Scenario(exercise.calls, exercise.memory, scales, "dt" if isinstance(plant.dt, tuple) else "")


def _sparse(matrix: Array) -> ca.SX:
    return ca.SX(ca.sparsify(ca.DM(matrix)))


def _packed(matrix: Array, full: bool) -> Array:
    return np.asarray(matrix[np.triu_indices(len(matrix))] if full else np.diag(matrix))


def _uniform_variance(noise: ca.SX) -> float | None:
    """Return the variance of a noise matrix that is a multiple of the identity, else None."""
    if ca.symvar(noise):
        return None
    numbers = np.array(ca.DM(ca.densify(noise)))
    first = float(numbers[0, 0])
    return first if first > 0 and np.array_equal(numbers, first * np.eye(len(numbers))) else None


def _std_beside(noise: ca.SX, shape: ca.SX) -> float | None:
    """Return r of a noise matrix that is r^2 Pi Pi', else None."""
    if ca.symvar(ca.vertcat(ca.vec(ca.densify(noise)), ca.vec(ca.densify(shape)))):
        return None
    R, P = (np.array(ca.DM(ca.densify(item))) for item in (noise, shape))
    square = float(np.sum(R * P) / np.sum(P * P)) if np.any(P) else 0.0
    return math.sqrt(square) if square > 0 and np.allclose(R, square * P, rtol=1e-9, atol=1e-9 * square) else None
