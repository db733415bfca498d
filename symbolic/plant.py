"""The Plant: a model by names. It holds expressions; it never simulates itself."""

from __future__ import annotations

import copy
import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Self

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from . import quaternions
from .errors import ModelError
from .expressions import constants_of, expand
from .names import check_name
from .origins import place_of_call, places_of_items
from .signals import WIDE, WRAPPED, Kind, Signal, check_default, make_range, same_unit, spread

HIGHEST_VARIANCE = 1.0e6
LOWEST_VARIANCE = 1.0e-12

Matrix = NDArray[np.float64]


class Symbol(ca.SX):
    """A named CasADi symbol of a plant; hashable, so that it may be a key of a dictionary."""

    signal: Signal

    def __init__(self, signal: Signal):
        super().__init__(ca.SX.sym(signal.name, signal.size))
        self.signal = signal

    def __hash__(self) -> int:
        return id(self)


class Attitude(Symbol):
    """A unit quaternion (w, x, y, z), body to world, whose error is a small rotation in the body frame."""

    @property
    def rotation(self) -> ca.SX:
        """Rotation matrix (3, 3), body to world."""
        return quaternions.matrix(self)

    def to_body(self, vector: Any) -> ca.SX:
        """Return a world vector (3,) as seen from the body."""
        return self.rotation.T @ ca.SX(vector)

    def to_world(self, vector: Any) -> ca.SX:
        """Return a body vector (3,) as seen from the world."""
        return self.rotation @ ca.SX(vector)


@dataclass
class State:
    """A state of a plant and where it lives in the state vector and in the error vector."""

    signal: Signal
    symbol: Symbol
    attitude: bool
    at: slice
    error_at: slice


@dataclass
class Noise:
    """A white input. `variance` is its strength: per Hz (a density), or per step or sample."""

    signal: Signal
    symbol: Symbol
    is_density: bool
    strength: Matrix  # (size, size)
    full: bool


@dataclass
class Sensor:
    """A measured vector z = h(x, u, v) + noise.

    `variance` is a function of the measurement symbol that gives the (m, m) noise matrix as an expression, or a
    number array; `full` says that off-diagonal noise was given.
    """

    signal: Signal
    expression: ca.SX
    measurement: Symbol
    strength: Matrix | None
    full: bool
    variance_expression: ca.SX | None
    doc: str = ""


@dataclass(frozen=True)
class Discretisation:
    """How a discrete plant was made from a continuous one."""

    method: str
    substeps: int
    continuous: Plant


@dataclass
class _Books:
    states: list[State] = field(default_factory=list)
    inputs: list[Symbol] = field(default_factory=list)
    parameters: list[Symbol] = field(default_factory=list)
    constants: list[Symbol] = field(default_factory=list)
    noises: list[Noise] = field(default_factory=list)
    sensors: list[Sensor] = field(default_factory=list)


class Plant:
    """A model: named states, inputs, noises, parameters, constants, dynamics and sensors.

    Parameters
    ----------
    name : str
        Its C identifier.
    dt : float, optional
        Seconds per step. If given, the plant is discrete and `dynamics` gives the next state; else it is continuous
        and `dynamics` gives the rate of each state.
    doc : str
        Its meaning; travels to the C header.

    Examples
    --------
    >>> from plantc.symbolic import Plant
    >>> cart = Plant("cart")
    >>> position = cart.state("position", unit="m")
    >>> speed = cart.state("speed", unit="m/s")
    >>> push = cart.input("push", unit="m/s^2")
    >>> cart.dynamics({position: speed, speed: push})
    >>> cart.error_size
    2
    """

    def __init__(self, name: str, *, dt: float | None = None, doc: str = ""):
        self.name = check_name("plant", name, "Plant")
        self.doc = doc
        if dt is not None and not (isinstance(dt, (int, float)) and math.isfinite(dt) and dt > 0):
            raise ModelError(f"{name}: dt is {dt!r}; give the seconds per step as a positive number")
        self.dt: float | tuple[float, float] | None = dt
        self.dt_symbol: ca.SX | None = ca.SX(float(dt)) if dt is not None else None
        self.discretisation: Discretisation | None = None
        self.step_variances: dict[str, tuple[float, ...]] = {}
        self.independent: Any = None  # reference.JumpMap: the dynamics by another road, for the oracle
        self._books = _Books()
        self._dynamics: dict[str, ca.SX] = {}
        self.dynamics_sources: dict[str, str] = {}
        self._owners: dict[int, str] = {}

    # -- declaring ----------------------------------------------------------------------------------------------------

    def state(
        self,
        name: str,
        *,
        size: int = 1,
        unit: str = "",
        range: tuple[Any, Any] | None = None,
        angle: bool = False,
        doc: str = "",
    ) -> Symbol:
        """Declare a state.

        Parameters
        ----------
        name : str
            Its C identifier.
        size : int
            Number of elements.
        unit : str
            Its unit.
        range : (low, high), optional
            Where it may be; a result outside is refused (OVERFLOW). Default -1e6 .. 1e6.
        angle : bool
            Wrapped to [-pi, pi], also in memory.
        doc : str
            Its meaning.

        Returns
        -------
        Symbol
            A column vector (size, 1) for use in expressions.
        """
        if angle and range is not None:
            raise ModelError(f"{self.name}: the state {name!r} is an angle, wrapped to -pi .. pi; leave its range out")
        default = (-WRAPPED, WRAPPED) if angle else (-WIDE, WIDE)
        signal = self._signal("state", name, size, unit, range, default, doc, angle)
        return self._add_state(Symbol(signal), attitude=False)

    def attitude(self, name: str, *, doc: str = "") -> Attitude:
        """Declare an attitude: a unit quaternion, body to world, with a three-component error in the body frame.

        In `dynamics` its entry is the angular velocity of the body, in body axes, in rad/s, shape (3,).
        """
        signal = self._signal("attitude", name, 4, "", (-1.01, 1.01), (-1, 1), doc, False)
        symbol = Attitude(signal)
        self._add_state(symbol, attitude=True)
        return symbol

    def input(
        self, name: str, *, size: int = 1, unit: str = "", range: tuple[Any, Any] | None = None, doc: str = ""
    ) -> Symbol:
        """Declare a known input. Outside `range`, or NaN, a call is refused (BAD_INPUT). Default -1e6 .. 1e6."""
        symbol = Symbol(self._signal("input", name, size, unit, range, (-WIDE, WIDE), doc, False))
        self._books.inputs.append(self._own(symbol))
        return symbol

    def parameter(
        self,
        name: str,
        default: Any,
        *,
        size: int | None = None,
        unit: str = "",
        range: tuple[Any, Any] | None = None,
        doc: str = "",
    ) -> Symbol:
        """Declare a parameter: a field that may be tuned at run time, checked by `init` (BAD_PARAM outside `range`)."""
        count = _count(self.name, f"parameter {name!r}", default) if size is None else size
        signal = self._signal("parameter", name, count, unit, range, (-WIDE, WIDE), doc, False)
        values = check_default(self.name, f"parameter {name!r}", default, signal.low, signal.high)
        symbol = Symbol(Signal(**{**signal.__dict__, "default": values}))
        self._books.parameters.append(self._own(symbol))
        return symbol

    def constant(self, name: str, value: Any, *, unit: str = "", doc: str = "") -> Symbol:
        """Declare a constant: folded into the generated C, named in its comments."""
        _count(self.name, f"constant {name!r}", value)
        flat = np.asarray(value, dtype=float).ravel()
        if not np.all(np.isfinite(flat)):
            raise ModelError(f"{self.name}: the constant {name!r} is {value!r}; give finite numbers")
        signal = self._signal("constant", name, flat.size, unit, None, (-1e30, 1e30), doc, False)
        symbol = Symbol(Signal(**{**signal.__dict__, "default": tuple(float(item) for item in flat)}))
        self._books.constants.append(self._own(symbol))
        return symbol

    def noise(
        self,
        name: str,
        *,
        size: int = 1,
        density: Any = None,
        variance: Any = None,
        std: Any = None,
        unit: str = "",
        doc: str = "",
    ) -> Symbol:
        """Declare a white noise input, usable anywhere in dynamics (or in one sensor).

        Exactly one of the keywords says what the number is.

        Parameters
        ----------
        density : float, sequence or (size, size) array
            Continuous noise, in unit^2/Hz.
        variance, std : float, sequence or (size, size) array
            Noise per step of a discrete plant, or per sample of a sensor.

        Raises
        ------
        ModelError
            If it is negative, indefinite, not finite, not square, or given twice or not at all.
        """
        given = {
            key: item for key, item in (("density", density), ("variance", variance), ("std", std)) if item is not None
        }
        if len(given) != 1:
            raise ModelError(
                f"{self.name}: the noise {name!r} has {len(given)} strengths; give exactly one of density= (continuous, "
                "unit^2/Hz), variance= or std= (per step or sample)"
            )
        keyword, value = next(iter(given.items()))
        strength, full = noise_matrix(self.name, f"noise {name!r}", keyword, value, size)
        signal = self._signal("noise", name, size, unit, None, (-WIDE, WIDE), doc, False)
        symbol = self._own(Symbol(signal))
        self._books.noises.append(Noise(signal, symbol, keyword == "density", strength, full))
        return symbol

    def dynamics(self, rates: Mapping[Any, Any]) -> None:
        """Give the rate of each state (continuous plant) or its next value (discrete plant).

        Parameters
        ----------
        rates : dict
            State (or its name) -> expression of the same size; for an attitude the body's angular velocity (3,).

        Raises
        ------
        ModelError
            If a state is missing, an expression has the wrong size, or uses a symbol that is not this plant's.
        """
        if self.discretisation is not None:
            raise ModelError(
                f"{self.name}: this plant was made by discretise() and has its dynamics; call dynamics() on the continuous plant"
            )
        if self._dynamics:
            raise ModelError(
                f"{self.name}: its dynamics are given already; give the rates of all states in one dictionary"
            )
        known = {state.signal.name: state for state in self.states}
        if not isinstance(rates, Mapping):
            raise ModelError(
                f"{self.name}: dynamics are given as {type(rates).__name__}; give a dictionary, state -> expression"
            )
        given: dict[str, ca.SX] = {}
        places: dict[str, str] = {}
        for (key, value), place in zip(rates.items(), places_of_items(len(rates)), strict=True):
            name = self._key("dynamics are given", key)
            places[name] = place
            expression = self._checked(f"the dynamics of {name!r}", value)
            state = known[name]
            size = state.error_at.stop - state.error_at.start
            if expression.numel() != size:
                raise ModelError(
                    f"{self.name}: the dynamics of {name!r} have {expression.numel()} elements, {size} are needed"
                )
            given[name] = ca.reshape(expression, size, 1)
        missing = [name for name in known if name not in given]
        if missing:
            raise ModelError(
                f"{self.name}: no dynamics for the state(s) {', '.join(map(repr, missing))}; add them to dynamics({{...}})"
            )
        self._dynamics, self.dynamics_sources, self.independent = given, places, None
        self._check_noise_kinds()

    def sensor(
        self,
        name: str,
        expression: Any,
        *,
        variance: Any = None,
        std: Any = None,
        unit: str = "",
        range: tuple[Any, Any] | None = None,
        angle: bool = False,
        doc: str = "",
    ) -> None:
        """Declare a sensor.

        Parameters
        ----------
        name : str
            Its C identifier.
        expression : casadi.SX
            What it would read without noise, shape (m,); it may use noises declared with ``variance=`` or ``std=``.
        variance, std : number, sequence, (m, m) array, casadi.SX, or a function of the measurement
            Its noise. Numbers become run-time parameters; a full matrix is factorised in C. An expression of the state
            is evaluated at the prediction; a function gets the measurement (m,) and returns one.
        range : (low, high), optional
            Of the reading; outside it a call is refused (BAD_INPUT). Default -1e6 .. 1e6, angles -1000 .. 1000.
        angle : bool
            The reading is an angle: the innovation is wrapped.
        """
        what = f"the sensor {name!r}"
        h = self._checked(what, expression)
        h = ca.reshape(h, h.numel(), 1)
        size = h.numel()
        if size == 0:
            raise ModelError(f"{self.name}: {what} measures nothing; give it an expression")
        default = (-1000.0, 1000.0) if angle else (-WIDE, WIDE)
        signal = self._signal("sensor", name, size, unit, range, default, doc, angle)
        measurement = Symbol(signal)
        own_noises = [noise for noise in self.noises if ca.depends_on(h, noise.symbol)]
        if variance is not None and std is not None:
            raise ModelError(f"{self.name}: {what} has variance= and std=; give one of them")
        if variance is None and std is None and not own_noises:
            raise ModelError(
                f"{self.name}: {what} has no noise; give variance= or std=, or use a noise in its expression"
            )
        for symbol in (*[state.symbol for state in self.states], *self.inputs):
            exact = size == symbol.signal.size and ca.is_equal(h, ca.SX(symbol), 0)
            if exact and not same_unit(symbol.signal.unit, unit):
                raise ModelError(
                    f"{self.name}: {what} is in [{unit}], but reads {symbol.signal.name!r}, which is in [{symbol.signal.unit}]; "
                    "convert the expression, or mend the unit"
                )
        strength, full, symbolic = None, False, None
        value, keyword = (variance, "variance") if std is None else (std, "std")
        self._own(measurement)
        try:
            if callable(value) and not isinstance(value, ca.SX):
                value = value(measurement)
            if isinstance(value, ca.SX):
                symbolic = self._noise_expression(what, keyword, value, size)
            elif value is not None:
                strength, full = noise_matrix(self.name, what, keyword, value, size, at_least=LOWEST_VARIANCE)
            self._books.sensors.append(Sensor(signal, h, measurement, strength, full, symbolic, doc))
            self._check_noise_kinds()
        except Exception:  # a sensor that was refused leaves no trace: its name may be used again
            self._books.sensors[:] = [item for item in self.sensors if item.measurement is not measurement]
            self._disown(measurement)
            raise

    def _noise_expression(self, what: str, keyword: str, value: ca.SX, size: int) -> ca.SX:
        value = self._checked(f"the noise of {what}", value)
        if keyword == "std":
            if value.numel() not in (1, size):
                raise ModelError(f"{self.name}: the std of {what} has {value.numel()} elements; give 1 or {size}")
            value = value**2
        if value.numel() == 1:
            return ca.diag(ca.repmat(value, size, 1))
        if value.shape in ((size, 1), (1, size)):
            return ca.diag(ca.reshape(value, size, 1))
        if value.shape != (size, size):
            raise ModelError(
                f"{self.name}: the variance of {what} has shape {value.shape}; give 1, {size} or {size} x {size} elements"
            )
        return value

    # -- making discrete ----------------------------------------------------------------------------------------------

    def discretise(self, method: str, *, dt: float | tuple[float, float], substeps: int = 1) -> Plant:
        """Return the discrete plant with the same signals.

        Parameters
        ----------
        method : {"euler", "rk4", "tustin", "exact"}
            Explicit Euler; Runge-Kutta of fourth order; the trapezoidal rule and the exact solution (linear plants, the
            input held over the step).
        dt : float or (lowest, highest)
            Seconds per step: a constant, or bounds of an input of `predict`.
        substeps : int
            Steps of Euler or RK4 within dt.

        Returns
        -------
        Plant
            Discrete; a density of process noise is integrated over the step by whoever builds an estimator on it.
        """
        from .discretisation import discretise

        return discretise(self, method, dt, substeps)

    def step_noise(self, variances: Mapping[Any, Any]) -> Self:
        """Add white noise per step to states of a discrete plant; each variance becomes a run-time parameter.

        Parameters
        ----------
        variances : dict
            State (or its name) -> variance per step, one number or one for each element of its error.
        """
        if not self.is_discrete:
            raise ModelError(
                f"{self.name}: step_noise is noise per step, and this plant is continuous; discretise it first, or use "
                "noise(..., density=)"
            )
        known = {state.signal.name: state for state in self.states}
        for key, value in variances.items():
            name = self._key("step_noise is given", key)
            size = known[name].error_at.stop - known[name].error_at.start
            matrix, full = noise_matrix(self.name, f"step noise of {name!r}", "variance", value, size)
            if full:
                raise ModelError(f"{self.name}: the step noise of {name!r} is a matrix; give one number per element")
            self.step_variances[name] = tuple(float(item) for item in np.diag(matrix))
        return self

    # -- reading ------------------------------------------------------------------------------------------------------

    @property
    def states(self) -> list[State]:
        """The states, in the order they were declared."""
        return self._books.states

    @property
    def inputs(self) -> list[Symbol]:
        """The inputs, in the order they were declared."""
        return self._books.inputs

    @property
    def parameters(self) -> list[Symbol]:
        """The run-time parameters."""
        return self._books.parameters

    @property
    def constants(self) -> list[Symbol]:
        """The constants, folded into the generated C."""
        return self._books.constants

    @property
    def noises(self) -> list[Noise]:
        """All noises, of dynamics and sensors."""
        return self._books.noises

    @property
    def process_noises(self) -> list[Noise]:
        """Noises that the dynamics use."""
        dynamics = self.dynamics_expression(fold=False)
        return [noise for noise in self.noises if ca.depends_on(dynamics, noise.symbol)]

    def sensor_noises(self, sensor: Sensor) -> list[Noise]:
        """Return the noises that a sensor's expression uses."""
        return [noise for noise in self.noises if ca.depends_on(sensor.expression, noise.symbol)]

    @property
    def sensors(self) -> list[Sensor]:
        """The sensors, in the order they were declared: the order in which `step` uses them."""
        return self._books.sensors

    @property
    def is_discrete(self) -> bool:
        """Whether `dynamics` gives the next state."""
        return self.dt is not None

    @property
    def x(self) -> ca.SX:
        """The state vector (n, 1)."""
        return ca.vertcat(*[state.symbol for state in self.states])

    @property
    def u(self) -> ca.SX:
        """The input vector."""
        return ca.vertcat(ca.SX(0, 1), *self.inputs)

    @property
    def p(self) -> ca.SX:
        """The parameter vector."""
        return ca.vertcat(ca.SX(0, 1), *self.parameters)

    @property
    def w(self) -> ca.SX:
        """All noises stacked."""
        return ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in self.noises])

    @property
    def error_size(self) -> int:
        """Number of components of the estimation error: the state's, with three for an attitude."""
        return self.states[-1].error_at.stop if self.states else 0

    @property
    def has_attitude(self) -> bool:
        """Whether a state is a quaternion."""
        return any(state.attitude for state in self.states)

    def dynamics_expression(self, *, fold: bool = True) -> ca.SX:
        """Return the stacked dynamics (error_size, 1), constants replaced by their numbers unless `fold` is false."""
        if not self._dynamics and self.states:
            raise ModelError(f"{self.name}: it has no dynamics yet; call {self.name}.dynamics({{state: expression}})")
        expression = ca.vertcat(ca.SX(0, 1), *[self._dynamics[state.signal.name] for state in self.states])
        return self.folded(expression) if fold else expression

    def folded(self, expression: ca.SX) -> ca.SX:
        """Return an expression with the constants replaced by their numbers."""
        if not self.constants:
            return ca.SX(expression)
        symbols = ca.vertcat(*self.constants)
        values = [item for constant in self.constants for item in (constant.signal.default or ())]
        return ca.substitute(ca.SX(expression), symbols, ca.DM(values))

    def without_noise(self, expression: ca.SX) -> ca.SX:
        """Return an expression with every noise at zero."""
        return ca.substitute(expression, self.w, ca.DM.zeros(self.w.numel())) if self.noises else expression

    def driven_by_noise(self) -> Plant:
        """Return the plant whose inputs are its inputs, then its noises: what a simulation runs."""
        driven = copy.copy(self)
        noises = [noise.symbol for noise in self.noises]
        driven._books = replace(self._books, inputs=[*self.inputs, *noises], noises=[])
        if self.independent is not None:
            ends = np.cumsum([0, *[noise.numel() for noise in noises]])
            used = {noise.signal.name for noise in self.process_noises}
            named = [(noise.signal.name, range(ends[k], ends[k + 1])) for k, noise in enumerate(noises)]
            driven.independent = self.independent.driven([i for name, at in named if name in used for i in at])
        if self.discretisation is not None:
            continuous = self.discretisation.continuous.driven_by_noise()
            driven.discretisation = replace(self.discretisation, continuous=continuous)
        return driven

    def retract(self, x: ca.SX, error: ca.SX, *, first_order: bool = False) -> ca.SX:
        """Return x "plus" an error (error_size, 1): a sum, or for an attitude the quaternion turned by the error."""
        pieces = []
        for state in self.states:
            value, change = x[state.at], error[state.error_at]
            if state.attitude:
                turn = quaternions.first_order(change) if first_order else quaternions.exponential(change)
                pieces.append(quaternions.product(value, turn))
            else:
                pieces.append(value + change)
        return ca.vertcat(*pieces)

    def retraction_jacobian(self) -> ca.SX:
        """Return d retract(x, e)/de at e = 0, (n, error_size), sparse."""
        pieces = []
        for state in self.states:
            if state.attitude:
                error = ca.SX.sym("e", 3)
                turned = quaternions.product(state.symbol, quaternions.first_order(error))
                pieces.append(ca.jacobian(turned, error))
            else:
                pieces.append(ca.SX.eye(state.signal.size))
        return ca.diagcat(*pieces)

    def wrapped(self, x: ca.SX) -> ca.SX:
        """Return a state vector with angles in [-pi, pi] and quaternions of unit length."""
        pieces = []
        for state in self.states:
            value = x[state.at]
            if state.attitude:
                value = quaternions.renormalised(value)
            elif state.signal.angle:
                value = wrap(value)
            pieces.append(value)
        return ca.vertcat(*pieces)

    def symbol_names(self) -> list[tuple[ca.SX, str]]:
        """Return every symbol with its name, for the text of equations."""
        symbols: list[Symbol] = [
            *[state.symbol for state in self.states],
            *self.inputs,
            *self.parameters,
            *self.constants,
            *[noise.symbol for noise in self.noises],
            *[sensor.measurement for sensor in self.sensors],
        ]
        names = [(ca.SX(symbol), symbol.signal.name) for symbol in symbols]
        if self.dt_symbol is not None and not self.dt_symbol.is_constant():
            names.append((self.dt_symbol, "dt"))
        return names

    def fingerprint(self) -> str:
        """Return a hash of everything the plant says, the same in any process."""
        from .expressions import equation_text

        lines = [self.name, self.doc, repr(self.dt), repr(sorted(self.step_variances.items()))]
        names = self.symbol_names()
        lines += equation_text(self.dynamics_expression(fold=False), names, longest=10**7)
        for state in self.states:
            lines.append(f"{state.signal} {state.attitude}")
        lines += [str(symbol.signal) for symbol in (*self.inputs, *self.parameters, *self.constants)]
        for noise in self.noises:
            lines.append(f"{noise.signal} {noise.is_density} {noise.strength.tolist()}")
        for sensor in self.sensors:
            lines.append(
                f"{sensor.signal} {None if sensor.strength is None else sensor.strength.tolist()} {sensor.doc}"
            )
            lines += equation_text(sensor.expression, names, longest=10**7)
            if sensor.variance_expression is not None:
                lines += equation_text(ca.vec(sensor.variance_expression), names, longest=10**7)
        if self.discretisation:
            lines.append(f"{self.discretisation.method} {self.discretisation.substeps}")
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()

    # -- from elsewhere -----------------------------------------------------------------------------------------------

    @classmethod
    def from_casadi(
        cls,
        name: str,
        dynamics: ca.Function,
        *,
        sensors: Mapping[str, tuple[ca.Function, Any]] | None = None,
        states: Sequence[str] | None = None,
        inputs: Sequence[str] | None = None,
        parameters: Mapping[str, float] | None = None,
        dt: float | None = None,
    ) -> Plant:
        """Build a plant from CasADi Functions.

        Parameters
        ----------
        name : str
            Name of the plant.
        dynamics : casadi.Function
            (x), (x, u) or (x, u, p) -> rate of x (or next x if `dt` is given).
        sensors : dict
            Name -> (Function of the same arguments, variance).
        states, inputs : sequence of str, optional
            Names of the elements; default ``x0, x1, ...`` and ``u0, u1, ...``.
        parameters : dict, optional
            Name -> default, for the elements of p.

        Raises
        ------
        ModelError
            If a function cannot be expanded into scalar operations (it is named), or sizes do not match.
        """
        plant = cls(name, dt=dt)
        f = expand(dynamics, name)
        sizes = [f.numel_in(index) for index in range(f.n_in())] + [0, 0]
        if not 1 <= f.n_in() <= 3:
            raise ModelError(
                f"{name}: the function {f.name()!r} has {f.n_in()} arguments; it takes (x), (x, u) or (x, u, p)"
            )
        state_names = list(states) if states is not None else [f"x{index}" for index in range(sizes[0])]
        input_names = list(inputs) if inputs is not None else [f"u{index}" for index in range(sizes[1])]
        defaults = dict(parameters or {})
        for what, names, size in (("states", state_names, sizes[0]), ("inputs", input_names, sizes[1])):
            if len(names) != size:
                raise ModelError(f"{name}: {len(names)} {what} are named, the function {f.name()!r} has {size}")
        if len(defaults) != sizes[2]:
            raise ModelError(f"{name}: {len(defaults)} parameters are named, the function {f.name()!r} has {sizes[2]}")
        symbols = [plant.state(item) for item in state_names]
        arguments = [ca.vertcat(*symbols)]
        arguments.append(ca.vertcat(ca.SX(0, 1), *[plant.input(item) for item in input_names]))
        arguments.append(ca.vertcat(ca.SX(0, 1), *[plant.parameter(key, value) for key, value in defaults.items()]))
        rates = f.call(arguments[: f.n_in()])[0]
        if rates.numel() != len(symbols):
            raise ModelError(
                f"{name}: the function {f.name()!r} gives {rates.numel()} values for {len(symbols)} states"
            )
        plant.dynamics({symbol: rates[index] for index, symbol in enumerate(symbols)})
        for key, (function, variance) in (sensors or {}).items():
            h = expand(function, name)
            wanted = [h.numel_in(index) for index in range(h.n_in())]
            if not 1 <= h.n_in() <= 3 or wanted != [item.numel() for item in arguments[: h.n_in()]]:
                has = ", ".join(str(item.numel()) for item in arguments)
                raise ModelError(
                    f"{name}: the function {h.name()!r} of the sensor {key!r} takes arguments of {wanted} elements; it takes "
                    f"(x), (x, u) or (x, u, p), of {has} elements"
                )
            plant.sensor(key, h.call(arguments[: h.n_in()])[0], variance=variance)
        return plant

    @classmethod
    def from_state_space(cls, name: str, system: Any, *, variance: Any = None) -> Plant:
        """Build a linear plant from a `control.StateSpace`; its signal names are kept.

        Parameters
        ----------
        name : str
            Name of the plant.
        system : control.StateSpace
            Continuous, or discrete with a numeric time step.
        variance : number, sequence or dict of output name -> number, optional
            Noise of the outputs, one sensor for each; without it no sensor is made.
        """
        if not all(hasattr(system, item) for item in ("A", "B", "C", "D", "dt", "state_labels")):
            raise ModelError(
                f"{name}: {type(system).__name__} is not a control.StateSpace; convert it with control.ss(...)"
            )
        outputs_of = list(system.output_labels)
        if isinstance(variance, Mapping):
            absent = [label for label in outputs_of if label not in variance]
            unknown = [label for label in variance if label not in outputs_of]
            if absent or unknown:
                raise ModelError(
                    f"{name}: the variances name {list(variance)}, the outputs are {outputs_of}; give one for each output"
                )
        elif variance is not None and np.size(variance) not in (1, len(outputs_of)):
            raise ModelError(
                f"{name}: {np.size(variance)} variances are given for {len(outputs_of)} outputs; give 1 or as many"
            )
        dt = system.dt
        if dt is True:
            raise ModelError(f"{name}: the discrete system has no numeric time step; give it one (dt=0.01)")
        plant = cls(name, dt=None if dt in (0, None) else float(dt))
        labels = [identifier(item) for item in system.state_labels]
        states = [plant.state(item) for item in labels]
        inputs = [plant.input(identifier(item)) for item in system.input_labels]
        x, u = ca.vertcat(*states), ca.vertcat(ca.SX(0, 1), *inputs)
        rates = _sparse(system.A) @ x + _sparse(system.B) @ u
        plant.dynamics({state: rates[index] for index, state in enumerate(states)})
        if variance is not None:
            outputs = _sparse(system.C) @ x + _sparse(system.D) @ u
            for index, label in enumerate(system.output_labels):
                output = identifier(label)
                if isinstance(variance, Mapping):
                    given = variance[label]
                else:
                    given = spread(variance, len(system.output_labels))[index]
                plant.sensor(f"{output}_sensor" if output in labels else output, outputs[index], variance=given)
        return plant

    # -- inside -------------------------------------------------------------------------------------------------------

    def _signal(
        self,
        kind: str,
        name: str,
        size: int,
        unit: str,
        given: Any,
        default: tuple[float, float],
        doc: str,
        angle: bool,
    ) -> Signal:
        check_name(kind, name, self.name)
        if name in self._names():
            raise ModelError(f"{self.name}: the name {name!r} is used twice; give this {kind} another")
        if not isinstance(size, int) or size < 1:
            raise ModelError(f"{self.name}: the {kind} {name!r} has size {size!r}; give a positive integer")
        if not isinstance(unit, str):
            raise ModelError(f"{self.name}: the unit of the {kind} {name!r} is {unit!r}; give it as text")
        if name == "dt":
            raise ModelError(f"{self.name}: the name 'dt' is the time step's; call this {kind} something else")
        low, high = make_range(self.name, f"{kind} {name!r}", given, default, size)
        return Signal(name, size, unit, low, high, doc, Kind.REAL, angle, source=place_of_call())

    def _names(self) -> set[str]:
        return set(self._owners.values())

    def _own(self, symbol: Symbol) -> Symbol:
        for index in range(symbol.numel()):
            self._owners[symbol[index].element_hash()] = symbol.signal.name
        return symbol

    def _disown(self, symbol: Symbol) -> None:
        for index in range(symbol.numel()):
            self._owners.pop(symbol[index].element_hash(), None)

    def _add_state(self, symbol: Symbol, *, attitude: bool) -> Symbol:
        if self._dynamics:
            raise ModelError(f"{self.name}: the state {symbol.signal.name!r} comes after dynamics(); declare it before")
        self._own(symbol)
        start = sum(state.signal.size for state in self.states)
        error_start = self.error_size
        size = symbol.signal.size
        error = 3 if attitude else size
        self._books.states.append(
            State(symbol.signal, symbol, attitude, slice(start, start + size), slice(error_start, error_start + error))
        )
        return symbol

    def _checked(self, what: str, value: Any) -> ca.SX:
        """Return an expression as SX; refuse symbols that are not this plant's."""
        try:
            expression = ca.SX(value if not isinstance(value, (list, tuple)) else ca.vertcat(*value))
        except (NotImplementedError, TypeError):
            raise ModelError(f"{self.name}: {what} is {value!r}; give a CasADi SX expression") from None
        for symbol in ca.symvar(expression):
            if symbol.element_hash() not in self._owners:
                raise ModelError(
                    f"{self.name}: {what} uses {symbol.name()!r}, a symbol of another plant; declare it on {self.name} "
                    "(state, input, parameter, constant or noise)"
                )
        for number in constants_of(expression):
            if not math.isfinite(number):
                raise ModelError(
                    f"{self.name}: {what} holds the number {number}; every number must be finite "
                    "(math.sin of a symbol gives nan: use sin of plantc.symbolic)"
                )
        return expression

    def _key(self, what: str, key: Any) -> str:
        """Return the name of the state that is a key of a dictionary; refuse a symbol that is not this plant's."""
        known = {state.signal.name: state for state in self.states}
        if not isinstance(key, (str, Symbol)):
            raise ModelError(
                f"{self.name}: {what} for {key!r}, which is not a state; give states or their names as keys"
            )
        name = key if isinstance(key, str) else key.signal.name
        if name not in known or (isinstance(key, Symbol) and key is not known[name].symbol):
            raise ModelError(
                f"{self.name}: {what} for {name!r}, which is not a state of this plant; declare it with state()"
            )
        return name

    def _check_noise_kinds(self) -> None:
        """A density belongs to continuous dynamics, a variance to a step or a sample."""
        used_in_dynamics = self.process_noises if self._dynamics else []
        for noise in used_in_dynamics:
            name = noise.signal.name
            if noise.is_density == self.is_discrete and self.discretisation is None:
                if self.is_discrete:
                    raise ModelError(
                        f"{self.name}: the noise {name!r} has a density, but the dynamics are per step; give variance= or std="
                    )
                raise ModelError(
                    f"{self.name}: the noise {name!r} has a variance per step, but the dynamics are continuous; give "
                    "density= (unit^2/Hz), or add step_noise to the discrete plant"
                )
        taken: dict[str, str] = {}
        for sensor in self.sensors:
            for noise in self.sensor_noises(sensor):
                other = taken.setdefault(noise.signal.name, sensor.signal.name)
                if other != sensor.signal.name:
                    raise ModelError(
                        f"{self.name}: the noise {noise.signal.name!r} enters the sensors {other!r} and {sensor.signal.name!r}; "
                        "correlated sensors must be one vector sensor, or use two noises"
                    )
                if noise in used_in_dynamics:
                    raise ModelError(
                        f"{self.name}: the noise {noise.signal.name!r} enters the dynamics and the sensor "
                        f"{sensor.signal.name!r}; correlated noise is not supported, use two noises"
                    )
                if noise.is_density:
                    raise ModelError(
                        f"{self.name}: the noise {noise.signal.name!r} of the sensor {sensor.signal.name!r} has a density; a "
                        "reading is a sample, give variance= or std="
                    )


def _count(owner: str, what: str, value: Any) -> int:
    """Return how many numbers a user gave, or raise a ModelError if they are none."""
    try:
        return int(np.asarray(value, dtype=float).size)
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: the value of {what} is {value!r}; give numbers") from None


def wrap(angle: ca.SX) -> ca.SX:
    """Return an angle in [-pi, pi]."""
    return angle - (2 * math.pi) * ca.floor(angle * (0.5 / math.pi) + 0.5)


def noise_matrix(
    owner: str, what: str, keyword: str, value: Any, size: int, *, at_least: float = 0.0
) -> tuple[Matrix, bool]:
    """Return the (size, size) noise matrix that a user gave, and whether it has off-diagonal elements.

    Raises
    ------
    ModelError
        If it is negative, indefinite, not finite, not symmetric or not square.
    """
    try:
        given = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ModelError(f"{owner}: the {keyword} of {what} is {value!r}; give numbers") from None
    if not np.all(np.isfinite(given)):
        raise ModelError(f"{owner}: the {keyword} of {what} holds {given.ravel().tolist()}; give finite numbers")
    if given.ndim < 2:
        if given.size not in (1, size):
            raise ModelError(f"{owner}: the {keyword} of {what} has {given.size} elements; give 1 or {size}")
        if np.any(given < 0):
            raise ModelError(f"{owner}: the {keyword} of {what} is negative ({given.min():g}); give it as zero or more")
        diagonal = np.broadcast_to(given.ravel() ** (2 if keyword == "std" else 1), (size,))
        matrix = np.diag(diagonal)
    else:
        if keyword == "std":
            raise ModelError(f"{owner}: the std of {what} is a matrix; give variance= instead")
        if given.shape != (size, size):
            raise ModelError(f"{owner}: the {keyword} of {what} has shape {given.shape}; give a {size} x {size} matrix")
        if not np.allclose(given, given.T, rtol=1e-12, atol=0):
            raise ModelError(f"{owner}: the {keyword} of {what} is not symmetric; give a symmetric matrix")
        matrix = 0.5 * (given + given.T)
        lowest = float(np.linalg.eigvalsh(matrix)[0])
        if lowest <= 0:
            raise ModelError(
                f"{owner}: the {keyword} of {what} is not positive definite (smallest eigenvalue {lowest:g}); mend the matrix"
            )
    matrix = np.array([[float(f"{item:.15g}") for item in row] for row in matrix])  # 0.1**2 is 0.01
    peak = float(np.max(np.diag(matrix)))
    if peak > HIGHEST_VARIANCE or float(np.min(np.diag(matrix))) < at_least:
        raise ModelError(
            f"{owner}: the {keyword} of {what} gives a variance outside {at_least:g} .. {HIGHEST_VARIANCE:g}; rescale the signal"
        )
    full = bool(np.any(matrix - np.diag(np.diag(matrix))))
    return matrix, full


def _sparse(matrix: Any) -> ca.SX:
    """Return a numeric matrix as sparse SX."""
    return ca.SX(ca.sparsify(ca.DM(np.asarray(matrix, dtype=float))))


def identifier(label: str) -> str:
    """Return a signal label of python-control as a C identifier."""
    cleaned = "".join(letter if letter.isalnum() else "_" for letter in label).strip("_")
    while "__" in cleaned:
        cleaned = cleaned.replace("__", "_")
    return cleaned or "x"
