"""Kalman filters as Blocks, derived from a Plant."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from ..reference import estimators as textbook
from .affinity import kink_in
from .block import Block, DerivativeCheck, Scenario
from .derivation import Derivation, Reads, dynamics_equations, known_sources, plant_equations
from .discretisation import process_covariance, transition
from .errors import ModelError, expect
from .expressions import equation_text, tape
from .forms import Conventional, Rows, form_named
from .kernels import SMALLEST_VARIANCE, Decorrelate, Pattern, Pivots
from .names import check_unique, name_of
from .origins import Origin
from .plant import HIGHEST_VARIANCE, LOWEST_VARIANCE, Noise, Plant, Sensor, State, Symbol, wrap
from .program import (
    AllOf,
    AnyOf,
    Assign,
    Attempt,
    Call,
    Compare,
    CountUp,
    Element,
    Entry,
    Evaluate,
    IsSet,
    Kernel,
    Packing,
    Place,
    Raise,
    Refuse,
    Restore,
    Statement,
    When,
    Within,
    packed_index,
)
from .signals import Kind, Signal, Status, power_of_unit, spread

Array = NDArray[Any]
LARGEST_NIS = 1.0e30
"""A normalised innovation squared beyond it, or NaN, is refused (OVERFLOW): it is no answer, and must not be counted."""


def extended_kalman_filter(
    plant: Plant,
    *,
    initial_variance: Mapping[Any, Any],
    around: Mapping[Any, Any] | None = None,
    gate: Mapping[str, float] | None = None,
    reject_limit: int = 0,
    inflation: float = 100.0,
    variance_floor: Mapping[Any, float] | float | None = None,
    variance_ceiling: Mapping[Any, float] | float | None = None,
    form: str = "conventional",
    correlated: str = "structural",
    float_bound: float = 0.05,
    name: str | None = None,
    doc: str = "",
) -> Block:
    """Return the extended Kalman filter of a discrete plant.

    The covariance is kept as its packed upper triangle; a sensor's rows are taken one after another, which is the
    batch update (Bierman 1977). Attitudes are estimated by their error, a small rotation (Markley 2003).

    Parameters
    ----------
    plant : Plant
        Discrete: ``plant.discretise(...)``, or a plant with ``dt=``.
    initial_variance : dict
        State (or its name) -> variance of its initial error, for every state; one number, or one per component.
    around : dict, optional
        State or input -> nominal value: default of the initial estimate, and where the test traces stay. Default 0.
    gate : dict, optional
        Sensor name -> largest NIS accepted (a run-time parameter; 0, the default, accepts all).
    reject_limit : int
        Readings gated in a row after which `step` recovers (a run-time parameter; 0 never does).
    inflation : float
        Factor on the covariance at a recovery (a run-time parameter).
    variance_floor, variance_ceiling : float or dict, optional
        Bounds of the variances in memory. Default 1e-20 and 1e9; 10 rad^2 above for an attitude, beyond which it is
        unknown all around.
    form : {"conventional", "joseph", "ud"}
        How the covariance is kept and updated: as itself, by scalar updates; as itself, each row in Joseph's form; or as
        factors U D U' (Bierman 1977, Thornton 1976), which stay positive definite in single precision with a sharp
        sensor and a vague prior. With "ud" a floor bounds the elements of D.
    correlated : {"structural", "all"}
        What of the covariance is kept. By default only what can ever differ from zero: states that neither dynamics, noise
        nor sensors link, however indirectly, stay uncorrelated, and P is a block for each group of them. "all" keeps the
        whole triangle, as for a memory in which you want to correlate such states by hand.
    float_bound : float
        Largest accepted difference of the single-precision C from double precision in one call, in sigma.
    name : str, optional
        Name of the block; default ``<plant>_ekf``.
    doc : str
        Its meaning; travels to the C header.

    Returns
    -------
    Block
        Entries `init`, `predict`, one ``update_<sensor>`` each, `step`, `inflate`.

    Raises
    ------
    ModelError
        If the plant is continuous, has no sensor, or an initial variance is missing.
    """
    expect(plant, Plant, "extended_kalman_filter: the plant", "a discrete Plant")
    return filter_of(
        plant,
        None,
        initial_variance=initial_variance,
        around=around,
        gate=gate,
        reject_limit=reject_limit,
        inflation=inflation,
        variance_floor=variance_floor,
        variance_ceiling=variance_ceiling,
        form=form,
        correlated=correlated,
        float_bound=float_bound,
        name=name or f"{plant.name}_ekf",
        doc=doc or f'Extended Kalman filter of the plant "{plant.name}"',
    )


@dataclass(frozen=True)
class Carried:
    """An input of `predict` beside the plant's, which the memory keeps for the next one.

    Attributes
    ----------
    now, before : Symbol
        The input, and the field of the memory, of the same name.
    state : State
        Whose nominal value is the default of the parameter that starts it.
    """

    now: Symbol
    before: Symbol
    state: State


@dataclass(frozen=True)
class CovarianceStep:
    """What a filter propagates its covariance by in place of the derivatives of the dynamics: P = F P F' + G S G'.

    Attributes
    ----------
    F, G : casadi.SX (n, n), (n, noises)
        Expressions of the plant's states, inputs and parameters, and of `carried`; S is the strength of the process noises.
    carried : tuple of Carried
        Inputs of `predict` beside the plant's; a parameter ``<name>_0`` starts each.
    reference : (callable, tuple of reference.CarriedModel)
        The same for the oracle, independently; see `reference.Model.error_step` and `carried`.
    """

    F: ca.SX
    G: ca.SX
    carried: tuple[Carried, ...]
    reference: tuple[Any, tuple[Any, ...]]


def filter_of(
    plant: Plant,
    step: CovarianceStep | None,
    *,
    initial_variance: Mapping[Any, Any],
    around: Mapping[Any, Any] | None = None,
    gate: Mapping[str, float] | None = None,
    reject_limit: int = 0,
    inflation: float = 100.0,
    variance_floor: Mapping[Any, float] | float | None = None,
    variance_ceiling: Mapping[Any, float] | float | None = None,
    form: str = "conventional",
    correlated: str = "structural",
    float_bound: float = 0.05,
    name: str,
    doc: str,
) -> Block:
    """Return the extended Kalman filter of a discrete plant, or with `step` one that propagates its covariance otherwise."""
    options = _Options(
        name,
        doc,
        initial_variance,
        around or {},
        gate or {},
        reject_limit,
        inflation,
        variance_floor,
        variance_ceiling,
        float_bound,
        form,
        correlated,
    )
    return _Builder(plant, options, step).build()


def kalman_filter(
    plant: Plant,
    *,
    initial_variance: Mapping[Any, Any],
    at: Mapping[Any, Any] | None = None,
    name: str | None = None,
    doc: str = "",
    **options: Any,
) -> Block:
    """Return the (time-varying) Kalman filter of a linear plant, or of a plant linearised at an operating point.

    Parameters
    ----------
    plant : Plant
        Discrete and linear; or any discrete plant without attitudes, if `at` is given.
    initial_variance : dict
        As for `extended_kalman_filter`.
    at : dict or OperatingPoint, optional
        State or input -> value at which the plant is linearised. The filter takes and returns absolute values.
    name, doc, **options
        As for `extended_kalman_filter`; default name ``<plant>_kf``.

    Raises
    ------
    ModelError
        If the plant is not linear and `at` is not given.
    """
    from .analysis import linearised_plant

    expect(plant, Plant, "kalman_filter: the plant", "a discrete Plant")
    linear = plant
    if at is not None:
        linear = linearised_plant(plant, at)
        options.setdefault("around", at)
    elif not is_linear(plant):
        raise ModelError(
            f"{plant.name}: a Kalman filter needs linear dynamics and sensors; give at= (an operating point) to linearise, or "
            "use extended_kalman_filter"
        )
    text = doc or f'Kalman filter of the plant "{plant.name}"' + (" linearised at an operating point" if at else "")
    return extended_kalman_filter(
        linear, initial_variance=initial_variance, name=name or f"{plant.name}_kf", doc=text, **options
    )


def steady_state_kalman_filter(
    plant: Plant,
    *,
    around: Mapping[Any, Any] | None = None,
    name: str | None = None,
    doc: str = "",
    gain: Any = None,
) -> Block:
    """Return the Kalman filter with its steady-state gain: no covariance in memory.

    The gain solves the discrete algebraic Riccati equation (Anderson & Moore 1979, ch. 4) at the default parameters. It
    is a designed number: it lives in design.json, rounded to 9 digits, and is not a run-time parameter.

    Parameters
    ----------
    plant : Plant
        Discrete and linear, with a constant dt.
    around : dict, optional
        State or input -> nominal value: default of the initial estimate, and where the test traces stay.
    name, doc : str, optional
        Default name ``<plant>_sskf``.
    gain : array (n, m), optional
        The gain to use instead of designing one.

    Returns
    -------
    Block
        Entries `init`, `predict`, `update` (all readings at once), and `step` (predict, then update if has_readings).

    Raises
    ------
    ModelError
        If the plant is not linear, dt is an input, or no stabilising gain exists.
    """
    from .steady_state import build

    expect(plant, Plant, "steady_state_kalman_filter: the plant", "a discrete Plant")
    return build(plant, around or {}, name or f"{plant.name}_sskf", doc, gain)


def is_linear(plant: Plant) -> bool:
    """Whether dynamics and sensors are affine in states and inputs."""
    if plant.has_attitude:
        return False
    point = ca.vertcat(plant.x, plant.u)
    source = plant.discretisation.continuous if plant.discretisation else plant
    stacked = ca.vertcat(source.dynamics_expression(), *[sensor.expression for sensor in plant.sensors])
    jacobian = ca.jacobian(plant.without_noise(stacked), point)
    gains = ca.jacobian(stacked, plant.w) if plant.noises else ca.SX(0, 0)
    if ca.depends_on(ca.vertcat(ca.vec(jacobian), ca.vec(gains)), point):
        return False
    return not kink_in(stacked, ca.vertcat(point, plant.w) if plant.noises else point, but_turns=True)


@dataclass(frozen=True)
class _Options:
    name: str
    doc: str
    initial_variance: Mapping[Any, Any]
    around: Mapping[Any, Any]
    gate: Mapping[str, float]
    reject_limit: int
    inflation: float
    floor: Mapping[Any, float] | float | None
    ceiling: Mapping[Any, float] | float | None
    float_bound: float
    form: str
    correlated: str


def _upper(matrix: ca.SX) -> tuple[Pattern, ca.SX]:
    """Return pattern and values of the upper triangle of a symmetric expression, row by row, exact zeros left out."""
    sparse = ca.sparsify(matrix)
    pattern = tuple(
        (i, j) for i in range(sparse.shape[0]) for j in range(i, sparse.shape[1]) if sparse.sparsity().has_nz(i, j)
    )
    return pattern, ca.vertcat(ca.SX(0, 1), *[sparse[i, j] for i, j in pattern])


def _rowwise(matrix: ca.SX) -> tuple[Pattern, ca.SX]:
    """Return pattern and values of a sparse expression, row by row."""
    sparse = ca.sparsify(matrix)
    pattern = tuple(sorted(zip(sparse.sparsity().row(), sparse.sparsity().get_col(), strict=True)))
    return pattern, ca.vertcat(ca.SX(0, 1), *[sparse[i, j] for i, j in pattern])


@dataclass(frozen=True)
class _Measurement:
    """What a sensor's update evaluates."""

    sensor: Sensor
    inputs: tuple[Symbol, ...]
    h: ca.SX
    residual: ca.SX
    H: ca.SX
    R: ca.SX


class _Builder(Derivation):
    """Derives everything, then assembles the Block."""

    def __init__(self, plant: Plant, options: _Options, step: CovarianceStep | None = None):
        name = options.name
        self.step = step
        self.carried = step.carried if step is not None else ()
        for what in ("initial_variance", "around", "gate"):
            given = getattr(options, what)
            if not isinstance(given, Mapping):
                raise ModelError(f"{name}: {what} is {given!r}; give a dictionary, name -> number")
        super().__init__(plant, name, options.doc, options.around)
        self.options = options
        self.n = plant.error_size
        self.floor = self._per_error(options.floor, "variance_floor", 0.0 if options.form != "ud" else 1e-30, 1e30)
        self.ceiling = self._per_error(options.ceiling, "variance_ceiling", 1e-30, 1e15)
        if any(low >= high for low, high in zip(self.floor, self.ceiling, strict=True)):
            raise ModelError(f"{name}: a variance floor is not below its ceiling; lower variance_floor")
        kind = form_named(options.form, name)
        if options.correlated not in ("structural", "all"):
            raise ModelError(f"{name}: correlated is {options.correlated!r}; take 'structural' or 'all'")
        self._declare_noises()
        self.following, self.F = transition(plant)
        if step is not None:
            self.F = step.F
        self.Q = self.process_noise()
        self.measurements = [self.measurement(sensor) for sensor in plant.sensors]
        blocks = self._blocks() if options.correlated == "structural" else ()
        self.form = kind(Packing(self.n, blocks), self.floor, self.ceiling)
        self._declare_memory()

    # -- what the user said -------------------------------------------------------------------------------------------

    def _per_error(self, given: Any, what: str, low: float, high: float) -> tuple[float, ...]:
        """Return one number for each component of the error."""
        table = {name_of(key): value for key, value in given.items()} if isinstance(given, Mapping) else None
        unknown = set(table or {}) - {state.signal.name for state in self.plant.states}
        if unknown:
            raise ModelError(f"{self.options.name}: {what} names {sorted(unknown)}, which are no states")
        answer: list[float] = []
        for state in self.plant.states:
            size = state.error_at.stop - state.error_at.start
            if table is None and given is not None:
                value: Any = given
            elif table is not None and state.signal.name in table:
                value = table[state.signal.name]
            elif what == "initial_variance":
                raise ModelError(
                    f"{self.options.name}: no initial variance for the state {state.signal.name!r}; add it to initial_variance"
                )
            else:
                value = 1e-20 if what == "variance_floor" else 10.0 if state.attitude else 1e9
            try:
                items = spread(value, size)
            except (TypeError, ValueError):
                items = ()
            if len(items) != size or not all(low <= item <= high for item in items):
                raise ModelError(
                    f"{self.options.name}: {what} of {state.signal.name!r} is {value!r}; give {size} number(s) within "
                    f"{low:g} .. {high:g}"
                )
            answer += items
        return tuple(answer)

    def _initial_variances(self) -> tuple[float, ...]:
        """Return the variances of the initial error; zero is one only where the floor is."""
        least = min(self.lowest, default=LOWEST_VARIANCE)
        answer = self._per_error(self.options.initial_variance, "initial_variance", least, HIGHEST_VARIANCE)
        for value, lowest in zip(answer, self.lowest, strict=True):
            if value < lowest:
                raise ModelError(
                    f"{self.options.name}: an initial variance is {value:g}; give at least {lowest:g}, or variance_floor=0"
                )
        return answer

    @property
    def lowest(self) -> tuple[float, ...]:
        """Least initial variance of each component of the error."""
        return tuple(0.0 if floor == 0 else LOWEST_VARIANCE for floor in self.floor)

    # -- declarations -------------------------------------------------------------------------------------------------

    def _declare_noises(self) -> None:
        plant, block, options = self.plant, self.block, self.options
        block.param_signals += [symbol.signal for symbol in plant.parameters]
        for noise in plant.process_noises:
            self._declare_noise(noise)
        for state in plant.states:
            if state.signal.name in plant.step_variances:
                values = plant.step_variances[state.signal.name]
                self._noise_parameter(
                    f"variance_step_{state.signal.name}",
                    values,
                    power_of_unit("rad" if state.attitude else state.signal.unit, 2),
                    f"noise per step of {state.signal.name}",
                    0.0,
                )
        for sensor in plant.sensors:
            self._declare_sensor(sensor)
        unknown = set(options.gate) - {sensor.signal.name for sensor in plant.sensors}
        if unknown:
            raise ModelError(f"{options.name}: gate= names {sorted(unknown)}, which are no sensors")
        if not isinstance(options.reject_limit, int) or not 0 <= options.reject_limit < 2**32:
            raise ModelError(
                f"{options.name}: reject_limit is {options.reject_limit!r}; give a whole number, 0 for never"
            )
        if not 1.0 <= options.inflation <= 1e6:
            raise ModelError(f"{options.name}: inflation is {options.inflation!r}; give a factor from 1 to 1e6")
        block.param_signals += [
            Signal(
                "reject_limit",
                low=(0.0,),
                high=(2.0**32 - 1,),
                kind=Kind.COUNT,
                default=(float(options.reject_limit),),
                doc="readings gated in a row after which step recovers; 0: never",
            ),
            Signal(
                "inflation",
                low=(1.0,),
                high=(1e6,),
                default=(float(options.inflation),),
                doc="factor on P at a recovery",
            ),
        ]

    def _declare_noise(self, noise: Noise) -> None:
        kind = "density" if noise.is_density else "variance"
        unit = power_of_unit(noise.signal.unit, 2)
        if unit and noise.is_density:
            unit += "/Hz"
        values = _pack(noise.strength) if noise.full else np.diag(noise.strength)
        doc = noise.signal.doc or f"noise {noise.signal.name}"
        if noise.full:
            doc += " (upper triangle by rows)"
        name, said = f"{kind}_{noise.signal.name}", noise.signal.source
        self._noise_parameter(name, tuple(values), unit, doc, 0.0, full=noise.full, source=said)

    def _declare_sensor(self, sensor: Sensor) -> None:
        name = sensor.signal.name
        for noise in self.plant.sensor_noises(sensor):
            if all(signal.name != f"variance_{noise.signal.name}" for signal, _ in self.noise_symbols):
                self._declare_noise(noise)
        if sensor.strength is not None:
            values = _pack(sensor.strength) if sensor.full else np.diag(sensor.strength)
            doc = f"noise of {name}" + (" (upper triangle by rows)" if sensor.full else "")
            unit = power_of_unit(sensor.signal.unit, 2)
            self._noise_parameter(
                f"variance_{name}",
                tuple(values),
                unit,
                doc,
                LOWEST_VARIANCE,
                full=sensor.full,
                source=sensor.signal.source,
            )
        gate = float(self.options.gate.get(name, 0.0))
        if not 0.0 <= gate <= 1e6:
            raise ModelError(
                f"{self.options.name}: the gate of {name!r} is {gate:g}; give a NIS from 0 (no gate) to 1e6"
            )
        doc = f"largest accepted NIS of {name}; 0: no gate"
        self.block.param_signals.append(
            Signal(f"gate_{name}", low=(0.0,), high=(1e6,), default=(gate,), doc=doc, source=sensor.signal.source)
        )

    def _noise_parameter(
        self,
        name: str,
        values: tuple[float, ...],
        unit: str,
        doc: str,
        low: float,
        *,
        full: bool = False,
        source: str = "",
    ) -> None:
        size = len(values)
        lows = (low,) * size
        if full:
            count = int((math.isqrt(8 * size + 1) - 1) // 2)
            lows = tuple(low if i == j else -HIGHEST_VARIANCE for i in range(count) for j in range(i, count))
        signal = Signal(
            name,
            size,
            unit,
            lows,
            (HIGHEST_VARIANCE,) * size,
            doc,
            default=tuple(float(item) for item in values),
            source=source,
        )
        self.block.param_signals.append(signal)
        self.noise_symbols.append((signal, ca.SX.sym(name, size)))

    def _declare_memory(self) -> None:
        plant, block = self.plant, self.block
        variances = self._initial_variances()
        self.declare_states()
        x0, _ = self.nominal()
        for item in self.carried:
            kept = item.before.signal
            block.memory_signals.append(kept)
            start = replace(kept, name=f"{kept.name}_0", doc=f"initial {kept.doc}")
            block.param_signals.append(replace(start, default=tuple(float(value) for value in x0[item.state.at])))
        for state in plant.states:
            size = state.error_at.stop - state.error_at.start
            unit = power_of_unit("rad" if state.attitude else state.signal.unit, 2)
            doc = f"variance of the error of {state.signal.name}_0"
            low, high = self.lowest[state.error_at], (HIGHEST_VARIANCE,) * size
            default = variances[state.error_at]
            block.param_signals.append(
                Signal(f"variance_{state.signal.name}_0", size, unit, low, high, doc, default=default)
            )
        block.memory_signals.append(self.form.signal())
        for sensor in plant.sensors:
            name = f"rejected_{sensor.signal.name}"
            doc = f"readings of {sensor.signal.name} gated in a row; stays at its largest value"
            block.memory_signals.append(Signal(name, kind=Kind.COUNT, low=(0.0,), high=(2.0**32 - 1,), doc=doc))

    def _blocks(self) -> tuple[tuple[int, ...], ...]:
        """Return the components of the error in blocks that nothing ever correlates: P is zero between them.

        Two components are linked where one drives the other (F), where noise drives both (Q), where a row of a sensor reads
        both (H) or two rows with common noise read one each (R), and where they belong to one attitude, whose correction
        turns its error. P starts diagonal; what is not connected by such links stays uncorrelated for ever.
        """
        links = np.eye(self.n, dtype=bool)
        for matrix in (self.F, self.Q):
            for i, j in _rowwise(matrix)[0]:
                links[i, j] = True
        for made in self.measurements:
            rows = [{j for i, j in _rowwise(made.H)[0] if i == row} for row in range(made.H.shape[0])]
            for i, j in _upper(made.R)[0]:
                read = sorted(rows[i] | rows[j])
                links[np.ix_(read, read)] = True
        for state in self.plant.states:
            if state.attitude:
                links[state.error_at, state.error_at] = True
        count, label = connected_components(csr_matrix(links), directed=False)
        return tuple(tuple(map(int, np.flatnonzero(label == k))) for k in range(count))

    # -- derivation ---------------------------------------------------------------------------------------------------

    def _strength(self, noises: list[Noise]) -> ca.SX:
        """Return the matrix of noise parameters, as symbols."""
        table = {signal.name: symbol for signal, symbol in self.noise_symbols}
        blocks = []
        for noise in noises:
            symbol = table[f"{'density' if noise.is_density else 'variance'}_{noise.signal.name}"]
            blocks.append(_unpack(symbol, noise.signal.size) if noise.full else ca.diag(symbol))
        return ca.diagcat(*blocks) if blocks else ca.SX(0, 0)

    def process_noise(self) -> ca.SX:
        """Return Q (n, n) as an expression of state, parameters and noise parameters."""
        plant = self.plant
        total = ca.SX(self.n, self.n)
        if plant.process_noises:
            S = self._strength(plant.process_noises)
            total = process_covariance(plant, S) if self.step is None else self.step.G @ S @ self.step.G.T
        table = {signal.name: symbol for signal, symbol in self.noise_symbols}
        for state in plant.states:
            if state.signal.name in plant.step_variances:
                place = state.error_at
                total[place, place] += ca.diag(table[f"variance_step_{state.signal.name}"])
        return total

    def measurement(self, sensor: Sensor) -> _Measurement:
        """Return residual, H and R of a sensor."""
        plant = self.plant
        noisy = plant.folded(sensor.expression)
        h = plant.without_noise(noisy)
        residual = ca.SX(sensor.measurement) - h
        if sensor.signal.angle:
            residual = wrap(residual)
        H = ca.jacobian(h, plant.x) @ plant.retraction_jacobian()
        size = sensor.signal.size
        table = {signal.name: symbol for signal, symbol in self.noise_symbols}
        R = ca.SX(size, size)
        if sensor.strength is not None:
            symbol = table[f"variance_{sensor.signal.name}"]
            R += _unpack(symbol, size) if sensor.full else ca.diag(symbol)
        if sensor.variance_expression is not None:
            R += plant.without_noise(plant.folded(sensor.variance_expression))
        noises = plant.sensor_noises(sensor)
        if noises:
            stacked = ca.vertcat(*[noise.symbol for noise in noises])
            N = plant.without_noise(ca.jacobian(noisy, stacked))
            R += N @ self._strength(noises) @ N.T
        if any(not R.sparsity().has_nz(i, i) for i in range(size)):
            raise ModelError(
                f"{plant.name}: a row of the sensor {sensor.signal.name!r} has no noise at all; give variance=, or let a noise "
                "enter each row"
            )
        for i in range(size):
            if H[i, :].nnz() == 0:
                raise ModelError(
                    f"{plant.name}: row {i} of the sensor {sensor.signal.name!r} does not depend on the state; leave it out"
                )
        everything = ca.vertcat(h, ca.vec(ca.densify(R)))
        inputs = tuple(symbol for symbol in plant.inputs if ca.depends_on(everything, symbol))
        return _Measurement(sensor, inputs, h, residual, H, R)

    # -- assembly -----------------------------------------------------------------------------------------------------

    def _init(self) -> Entry:
        plant = self.plant
        body: list[Statement] = []
        for noise, what in self._full_matrices():
            size = int((math.isqrt(8 * noise.size + 1) - 1) // 2)
            body += _definite_or_refuse(Place("param", noise.name), size, what)
        body += self.start_states()
        body += self.form.start(
            [
                Element(Place("param", f"variance_{state.signal.name}_0"), i)
                for state in plant.states
                for i in range(state.error_at.stop - state.error_at.start)
            ]
        )
        for item in self.carried:
            name, size = item.now.signal.name, item.now.signal.size
            body.append(Assign(Place("next", name), Place("param", f"{name}_0"), size))
        for sensor in plant.sensors:
            body.append(Assign(Place("next", f"rejected_{sensor.signal.name}"), 0.0, 1))
        body += self.form.hold()
        if plant.has_attitude:
            body.append(
                self.judge()
            )  # scaling to unit length keeps an attitude in range; what is stored is judged all the same
        doc = "Start (or start again) from the initial estimate in the parameters; every parameter is checked here."
        return Entry("init", (), (), tuple(body), doc, checks_params=True)

    def _full_matrices(self) -> list[tuple[Signal, str]]:
        full = {f"variance_{sensor.signal.name}" for sensor in self.plant.sensors if sensor.full}
        full |= {
            f"{'density' if noise.is_density else 'variance'}_{noise.signal.name}"
            for noise in self.plant.noises
            if noise.full
        }
        return [(signal, signal.name) for signal, _ in self.noise_symbols if signal.name in full]

    def _predict(self) -> Entry:
        plant = self.plant
        following, F, Q = self.following, self.F, self.Q
        f_pattern, f_values = _rowwise(F)
        q_pattern, q_values = _upper(Q)
        f_names = tuple(f"f_{i}_{j}" for i, j in f_pattern)
        q_names = tuple(f"q_{i}_{j}" for i, j in q_pattern)
        targets, names = self.next_states()
        reads = [*self.step_reads(), *self._carried_reads()]
        f_place, q_place = Place("local", "f"), Place("local", "q")
        outputs = [
            (following, targets, names),
            (f_values, ((f_place, len(f_pattern)),), f_names),
            (q_values, ((q_place, len(q_pattern)),), q_names),
        ]
        made = plant.discretisation
        how = "x = f(x, u)" if made is None else f"x, F = dx/dx and Q over one step, by {made.method}"
        if made is not None and made.substeps > 1:
            how += f" in {made.substeps} substeps"
        if self.step is not None:
            how += "; F and Q are given"
        body: list[Statement] = [
            self.evaluate(
                "predict",
                reads,
                outputs,
                [how, *dynamics_equations(plant)],
                self._predict_origins(f_pattern, q_pattern),
            ),
            *self.form.propagate(f_place, f_pattern, q_place, q_pattern, f_names, q_names),
            *[Assign(Place("next", s.name), Place("in", s.name), s.size) for s in (c.now.signal for c in self.carried)],
            *self.form.hold(),
            self.judge(),
        ]
        doc = "Move the estimate one step ahead."
        inputs = [*self.step_inputs(), *[item.now.signal for item in self.carried]]
        return Entry("predict", tuple(inputs), (), tuple(body), doc)

    def _carried_reads(self) -> list[Reads]:
        """Return what the covariance's own step takes beside the plant's: inputs, and what memory kept of the last ones."""
        now = [item.now for item in self.carried]
        before = [item.before for item in self.carried]
        answer: list[Reads] = []
        for space, symbols in (("in", now), ("memory", before)):
            places = [((Place(space, s.signal.name), s.signal.size),) for s in symbols]  # type: ignore[arg-type]
            answer.append(([ca.SX(symbol) for symbol in symbols], places))
        return answer

    def _update(self, made: _Measurement) -> Entry:
        sensor, n = made.sensor, self.n
        name, m = sensor.signal.name, sensor.signal.size
        h_pattern, h_values = _rowwise(made.H)
        r_pattern, r_values = _upper(made.R)
        diagonal = all(i == j for i, j in r_pattern)
        h_names = tuple(f"h_{i}_{j}" for i, j in h_pattern)
        r_names = tuple(f"r_{i}" if diagonal else f"r_{i}_{j}" for i, j in r_pattern)
        e_names = tuple(f"residual_{i}" for i in range(m)) if m > 1 else ("residual",)
        residual, h, r = Place("local", "residual"), Place("local", "h"), Place("local", "r")
        reads: list[tuple[Sequence[ca.SX], Sequence[Any]]] = [
            self.state_reads(),
            ([ca.SX(sensor.measurement)], [((Place("in", name), m),)]),
            self.input_reads(made.inputs),
            self.param_reads(),
        ]
        outputs = [
            (made.residual, ((residual, m),), e_names),
            (h_values, ((h, len(h_pattern)),), h_names),
            (r_values, ((r, len(r_pattern)),), r_names),
        ]
        pairs = self.plant.symbol_names()
        expected = equation_text(sensor.expression, pairs, 200)
        wrapped = ", wrapped" if sensor.signal.angle else ""

        def tail(i: int) -> str:
            return f"[{i}]" if m > 1 else ""

        def subtracted(text: str) -> str:
            return text if text.replace("_", "").isalnum() else f"({text})"

        comment = [
            f"residual{tail(i)} = {name}{tail(i)} - {subtracted(text)}{wrapped}" for i, text in enumerate(expected)
        ]
        rows = Rows(m, residual, h, h_pattern, r, (False,) * m, h_names, r_names, e_names)
        moved = self._moved({j for _, j in h_pattern})
        body: list[Statement] = [
            self.evaluate(
                f"measure_{name}", reads, outputs, comment, self._measure_origins(sensor, comment, h_pattern, r_pattern)
            ),
            self.form.innovation_variance(rows, r_pattern, r_names),
            Assign(Place("out", "innovation"), residual, m),
        ]
        if not diagonal:
            new = Decorrelate(
                m, n, residual, h, h_pattern, r, r_pattern, Place("local", "white_residual"), Place("local", "white_h"),
                Place("local", "white_r"), h_names, r_names, e_names,
            )  # fmt: skip
            body.append(new)
            body.append(Refuse(Status.NOT_POSITIVE, _all_above(new.new_r, m, SMALLEST_VARIANCE)))
            residual, h, r, h_pattern = new.new_residual, new.new_h, new.new_r, new.new_pattern
            h_names = tuple(f"wh_{i}_{j}" for i, j in h_pattern)
            r_names = tuple(f"d_{i}" for i in range(m))
            e_names = tuple(f"we_{i}" for i in range(m))
        at = [[k for k, (i, _) in enumerate(h_pattern) if i == row] for row in range(m)]
        single = tuple(diagonal and len(item) == 1 and _is_one(h_values[item[0]]) for item in at)
        rows = Rows(m, residual, h, h_pattern, r, single, h_names, r_names, e_names)
        if self.form.takes_all_states(rows):
            rows = replace(rows, residual=Place("out", "innovation"))
        body += self.form.update(rows)
        # what rounding leaves of a variance that is zero is to be seen beside that of the prior
        row_variance, prior = Place("local", "row_variance"), Place("out", "variance")
        positive = tuple(
            Compare(Element(row_variance, i), ">=", SMALLEST_VARIANCE, Element(prior, i)) for i in range(m)
        )
        body.append(Refuse(Status.NOT_POSITIVE, AllOf(positive)))
        body += self.form.judge_report(m)
        finite = Within(Place("local", "nis"), (0.0,), (LARGEST_NIS,))
        body.append(Refuse(Status.OVERFLOW, finite))
        body.append(Assign(Place("out", "nis"), Place("local", "nis"), 1))
        gate = Element(Place("in", "gate"))
        accepted = AnyOf((Compare(gate, "<=", 0.0), Compare(Element(Place("local", "nis")), "<=", gate)))
        body.append(
            When(
                accepted,
                (
                    *self._correct(name, moved),
                    Assign(Place("next", f"rejected_{name}"), 0.0, 1),
                    *self.form.hold(),
                    self.judge(self._touched(moved)),
                ),
                (Restore(), CountUp(Place("next", f"rejected_{name}")), Raise(Status.GATED)),
                "accepted?",
            )
        )
        gate_signal = Signal("gate", low=(0.0,), high=(1e6,), doc="largest accepted NIS; 0: no gate")
        unit = sensor.signal.unit
        outputs_of = (
            Signal(
                "innovation",
                m,
                unit,
                (-1e30,) * m,
                (1e30,) * m,
                "measured minus expected" + wrapped,
                angle=sensor.signal.angle,
            ),
            Signal("variance", m, power_of_unit(unit, 2), doc="of the innovation", low=(0.0,) * m, high=(1e30,) * m),
            Signal("nis", doc="normalised innovation squared, of the whole reading", low=(0.0,), high=(1e30,)),
        )
        reading = Signal(**{**sensor.signal.__dict__, "doc": sensor.doc or "reading"})
        return Entry(
            f"update_{name}",
            (reading, *[symbol.signal for symbol in made.inputs]),
            outputs_of,
            tuple(body),
            f"Correct the estimate with one reading of {name}.",
            hidden=((gate_signal, Place("param", f"gate_{name}")),),
            sources=known_sources(sensor.signal.source),
        )

    def _predict_origins(self, f_pattern: Pattern, q_pattern: Pattern) -> list[list[Origin]]:
        """Return what the outputs of predict come from: an equation for each state, its derivative, its noise."""
        plant = self.plant
        equations = dynamics_equations(plant)
        following: list[Origin] = []
        rows: list[Origin] = []
        for state in plant.states:
            said = known_sources(plant.dynamics_sources.get(state.signal.name, ""))
            own = [Origin("dynamics", text, said) for text in equations[state.error_at]]
            row = "row of F = dx/dx" if self.step is None else "row of F as it is given"
            rows += [Origin("derivative", f"{row}: {text}", said) for text in equations[state.error_at]]
            # a quaternion has four elements and three equations
            following += [Origin("dynamics", "; ".join(equations[state.error_at]), said)] * 4 if state.attitude else own
        names = [noise.signal.name for noise in plant.process_noises]
        names += [f"step noise of {name}" for name in plant.step_variances]
        said = known_sources(*[noise.signal.source for noise in plant.process_noises])
        spread_of = Origin("noise", f"Q over one step: {', '.join(names) or 'none'}", said)
        return [following, [rows[i] for i, _ in f_pattern], [spread_of] * len(q_pattern)]

    def _measure_origins(
        self, sensor: Sensor, equations: list[str], h_pattern: Pattern, r_pattern: Pattern
    ) -> list[list[Origin]]:
        """Return what residual, H and R of a sensor come from."""
        said = known_sources(sensor.signal.source)
        noises = known_sources(
            sensor.signal.source, *[noise.signal.source for noise in self.plant.sensor_noises(sensor)]
        )
        return [
            [Origin("sensor", text, said) for text in equations],
            [Origin("derivative", f"row of H = dh/dx: {equations[i]}", said) for i, _ in h_pattern],
            [Origin("noise", f"R of {sensor.signal.name}", noises)] * len(r_pattern),
        ]

    def _moved(self, read: set[int]) -> set[int]:
        """Return the components of the error that a reading may change: those correlated with the ones it reads."""
        return {j for block in self.form.packing.parts if read & set(block) for j in block}

    def _touched(self, moved: set[int]) -> list[State]:
        """Return the states of which a component may change."""
        return [state for state in self.plant.states if moved & set(range(state.error_at.start, state.error_at.stop))]

    def _correct(self, sensor: str, moved: set[int]) -> list[Statement]:
        """Apply the correction d to the states it touches, and turn P into the corrected body frame of an attitude."""
        plant = self.plant
        touched = self._touched(moved)
        given = ca.SX.sym("d", self.n)
        # a kernel writes the corrections of its block only: the rest of a state that is touched stays
        d = ca.vertcat(*[given[j] if j in moved else 0 for j in range(self.n)])
        targets, names = self.next_states(touched)
        symbols, places = self.state_reads()
        whole = plant.wrapped(plant.retract(plant.x, d))
        corrected = ca.vertcat(*[whole[state.at] for state in touched])
        body: list[Statement] = []
        gains = []
        for state in plant.states:
            size = state.error_at.stop - state.error_at.start
            gains.append(ca.SX.eye(size) - 0.5 * ca.skew(d[state.error_at]) if state.attitude else ca.SX.eye(size))
        pattern, values = _rowwise(ca.diagcat(*gains))
        reset = Place("local", "g")
        g_names = tuple(f"g_{i}_{j}" for i, j in pattern)
        outputs = [(corrected, targets, names)]
        if plant.has_attitude:
            outputs.append((values, ((reset, len(pattern)),), g_names))
        comment = ["x = x + d"]
        if plant.has_attitude:
            comment = ["x = x + d, attitudes turned by exp(d); the error is now counted from there: P = G P G'"]
        reads: list[tuple[Sequence[ca.SX], Sequence[Any]]] = [
            (symbols, places),
            ([given], [((Place("local", "delta"), self.n),)]),
        ]
        body.append(self.evaluate(f"correct_{sensor}", reads, outputs, comment))
        if plant.has_attitude:
            body.append(self.form.reset(reset, pattern, g_names))
        return body

    def _inflate(self) -> Entry:
        factor = Signal("factor", low=(1.0,), high=(1e6,), doc="factor on the covariance")
        body = (self.form.inflate(Place("in", "factor")), *self.form.hold())
        doc = "Multiply the covariance by a factor and leave the estimate: after a disturbance the model does not know."
        return Entry("inflate", (factor,), (), body, doc)

    def build(self) -> Block:
        """Derive and assemble."""
        plant, block = self.plant, self.block
        measurements = self.measurements
        predict = self._predict()
        updates = [(made.sensor, self._update(made)) for made in measurements]
        entries = [
            self._init(),
            predict,
            *[entry for _, entry in updates],
            step_entry(predict, [(sensor.signal.name, entry) for sensor, entry in updates]),
            self._inflate(),
        ]
        block.entries = {entry.name: entry for entry in entries}
        block.equations = plant_equations(plant)
        block.notes = self.notes()
        if any(noise.is_density for noise in plant.process_noises):
            block.notes.append("Noise densities are integrated over the step.")
        block.notes.append(self.form.note)
        if self.form.packing.blocks:
            sizes = ", ".join(str(len(part)) for part in self.form.packing.blocks)
            block.notes.append(
                f"P is zero by structure outside blocks of {sizes}: only the blocks are kept and computed."
            )
        block.source_hash = plant.fingerprint()
        block.float_bound = self.options.float_bound
        block.check()
        check_unique(
            [(s.name, f"the field {s.name!r}") for s in (*block.memory_signals, *block.param_signals)]
            + [(symbol.signal.name, f"the input {symbol.signal.name!r}") for symbol in plant.inputs]
            + [(sensor.signal.name, f"the sensor {sensor.signal.name!r}") for sensor in plant.sensors],
            block.name,
        )
        model = self.textbook_model(
            [(item.sensor, item.inputs) for item in measurements], self.floor, self.ceiling, self.form.packing.blocks
        )
        if self.step is not None:
            model = replace(model, error_step=self.step.reference[0], carried=self.step.reference[1])
        block.oracle = self.form.oracle(model)
        block.scenario = self._scenario(model)
        block.derivative_checks = self._derivative_checks(model, block)
        return block

    # -- independence -------------------------------------------------------------------------------------------------

    def _scenario(self, model: textbook.Model) -> Scenario:
        x0, u0 = self.nominal()
        variances = np.array(self._initial_variances())
        params = {signal.name: np.array(signal.default) for signal in self.block.param_signals}
        plant = self.plant
        low = np.array([item for symbol in plant.inputs for item in symbol.signal.low])
        high = np.array([item for symbol in plant.inputs for item in symbol.signal.high])
        exercise = textbook.Exercise(
            model, x0, u0, np.minimum(0.01 * (high - low), 1.0 + np.abs(u0)), variances, params
        )

        def scales(memory: Mapping[str, Any]) -> dict[str, Any]:
            return sigma_of(plant.states, self.form, memory)

        def memory(rng: np.random.Generator) -> dict[str, Any]:
            return self.form.memory(exercise.memory(rng))

        return Scenario(exercise.calls, memory, scales, "dt" if isinstance(plant.dt, tuple) else "", self.form.scaled)

    def _derivative_checks(self, model: textbook.Model, block: Block) -> list[DerivativeCheck]:
        """F and each H as the block evaluates them, beside complex step and central differences of f and h."""
        checks = []
        # an F that is given is no derivative of the dynamics
        functions = [("F", block.entries["predict"], "f")] if self.step is None else []
        functions += [(f"H_{sensor.name}", block.entries[f"update_{sensor.name}"], "h") for sensor in model.sensors]
        for name, entry, local in functions:
            evaluate = next(item for item in entry.body if isinstance(item, Evaluate))
            kernel: Any = next(item for item in entry.body if isinstance(item, Kernel))
            pattern = kernel.f_pattern if name == "F" else kernel.h_pattern
            rows = self.n if name == "F" else entry.inputs[0].size
            checks.append(
                DerivativeCheck(
                    name,
                    _ours(evaluate, local, pattern, (rows, self.n)),
                    textbook.derivative(model, name, "complex step"),
                    textbook.derivative(model, name, "central differences"),
                    tuple(tape(evaluate.function).kinks),
                )
            )
        return checks


def step_entry(predict: Entry, updates: Sequence[tuple[str, Entry]]) -> Entry:
    """Return `step`: `predict`, then the update of each (sensor, its entry) that has a reading, a refused one skipped."""
    inputs = list(predict.inputs)
    outputs: list[Signal] = []
    arguments = tuple((signal.name, Place("in", signal.name)) for signal in predict.inputs)
    body: list[Statement] = [Call("predict", arguments)]
    for name, entry in updates:
        reading = entry.inputs[0]
        flag = Signal(
            f"has_{name}", kind=Kind.FLAG, low=(0.0,), high=(1.0,), doc=f"whether there is a reading of {name}"
        )
        inputs += [flag, reading]
        group = Signal(name, kind=Kind.GROUP, members=entry.outputs, doc=f"what update_{name} reported, else zeros")
        status = Signal(f"status_{name}", kind=Kind.STATUS, doc=f"status of {name} itself")
        outputs += [status, group]
        given = tuple((signal.name, Place("in", signal.name)) for signal in entry.inputs)
        zeros: tuple[Statement, ...] = tuple(
            Assign(Place("out", f"{name}.{signal.name}"), 0.0, signal.size) for signal in entry.outputs
        )
        report = Place("out", f"status_{name}")
        skipped: tuple[Statement, ...] = (*zeros, Raise(Status.SKIPPED))
        limit = Element(Place("param", "reject_limit"))
        count = Element(Place("next", f"rejected_{name}"))
        normal = Attempt((Call(entry.name, given, Place("out", name)),), report, (), skipped)
        recovery = Attempt(
            (
                Call("inflate", (("factor", Place("param", "inflation")),)),
                Call(entry.name, (*given, ("gate", 0.0)), Place("out", name)),
            ),
            report,
            (Raise(Status.RECOVERED),),
            skipped,
        )
        due = AllOf((Compare(limit, ">", 0.0), Compare(count, ">=", limit)))
        body.append(
            When(
                IsSet(Element(Place("in", f"has_{name}"))),
                (When(due, (recovery,), (normal,), f"{name} gated too often in a row: trust it once"),),
                (*zeros, Assign(report, 0.0, 1)),
                name,
            )
        )
    doc = "Predict, then every sensor that has a reading, in this order; a refused sensor is skipped."
    return Entry("step", tuple(inputs), tuple(outputs), tuple(body), doc)


def _ours(evaluate: Evaluate, local: str, pattern: Pattern, shape: tuple[int, int]) -> Any:
    """Return a callable that evaluates a Jacobian of the block at named values."""

    def at(values: Mapping[str, Any]) -> Array:
        arguments = []
        for places in evaluate.reads:
            arguments.append(ca.DM(np.concatenate([np.ravel(values[place.name]) for place, _ in places])))
        outputs = evaluate.function.call(arguments)
        index = next(k for k, places in enumerate(evaluate.writes) if places[0][0].name == local)
        matrix = np.zeros(shape)
        for (i, j), value in zip(pattern, outputs[index].nonzeros(), strict=True):
            matrix[i, j] = value
        return matrix

    return at


def sigma_of(states: list[State], form: Conventional, memory: Mapping[str, Any]) -> dict[str, Any]:
    """Return the natural size of an error in each field of a filter's memory, from its covariance."""
    sigma = np.sqrt(np.maximum(np.diag(form.covariance(memory)), 1e-300))
    answer: dict[str, Any] = {}
    for state in states:
        own = sigma[state.error_at]
        answer[state.signal.name] = np.full(4, 0.5 * float(np.max(own))) if state.attitude else own
    answer[form.field] = form.sizes(memory, sigma)
    return answer


def _definite_or_refuse(place: Place, size: int, name: str) -> list[Statement]:
    """Factorise a packed matrix parameter and refuse it unless it is positive definite."""
    pattern = tuple((i, j) for i in range(size) for j in range(i, size))
    names = tuple(f"{name}_{i}_{j}" for i, j in pattern)
    local = f"pivot_{name}"
    kernel = Pivots(size, place, pattern, Place("local", local), names)
    return [
        kernel,
        Refuse(Status.BAD_PARAM, _all_above(Place("local", local), size, SMALLEST_VARIANCE)),
    ]


def _all_above(place: Place, size: int, limit: float) -> AllOf:
    return AllOf(tuple(Compare(Element(place, i), ">=", limit) for i in range(size)))


def _is_one(expression: ca.SX) -> bool:
    return bool(expression.is_constant()) and float(expression) == 1.0


def _pack(matrix: Array) -> Array:
    return np.asarray(matrix)[np.triu_indices(len(matrix))]


def _unpack(symbol: ca.SX, size: int) -> ca.SX:
    matrix = ca.SX(size, size)
    for i in range(size):
        for j in range(size):
            matrix[i, j] = symbol[packed_index(size, i, j)]
    return matrix
