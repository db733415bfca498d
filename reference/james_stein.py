"""James-Stein state estimators as plain NumPy: singular values, one formula after another.

J. A. Meda-Campana, "On the Estimation and Control of Nonlinear Systems With Parametric Uncertainties and Noisy Outputs",
IEEE Access 2018, eqs. 20-25, in the order predict, then correct (its eqs. 20 and 21 name them the other way round); J. H.
Manton, V. Krishnamurthy, H. V. Poor, "James-Stein state filtering algorithms", IEEE Trans. Signal Processing 46(9), 1998.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .discretisation import (
    complex_step,
    evaluated,
    expected,
    measurement_noise,
    retract,
    transition,
    wrapped,
    wrapped_angle,
)
from .exercise import Calls, Exercise
from .kalman import Refused, Status
from .model import (
    Array,
    InputModel,
    Lowered,
    Model,
    Precision,
    SensorModel,
    split_state,
    stack,
    stack_inputs,
)

LEAST_PIVOT = 1.0e-12
SMALLEST_SQUARE = 1.0e-30
LARGEST = 1.0e30


class Estimate(NamedTuple):
    """A corrected state, and how it came about.

    Attributes
    ----------
    state : array (..., n)
        x+.
    weight : array (...)
        Of the reading: 1 takes the state of maximum likelihood, 0 the prediction.
    distance_squared : array (...)
        D2 = ||Pi^-1 C (x_ML - x-)||^2.
    most_likely : array (..., n)
        x_ML.
    effective_dimension : float
        n*.
    """

    state: Array
    weight: Array
    distance_squared: Array
    most_likely: Array
    effective_dimension: float


def effective_dimension(C: Array, Pi: Array) -> float:
    """Return n* = tr(I_y^-1) / lambda_max(I_y^-1), I_y = C' (Pi Pi')^-1 C: from singular values of Pi^-1 C."""
    inverse = np.linalg.svd(np.linalg.solve(Pi, C), compute_uv=False) ** -2.0
    return float(np.sum(inverse) / np.max(inverse))


def shrink_constant(dimension: int, effective: float) -> float:
    """Return c = (min(n - 2, 2 (n* - 2)))^+ (eq. 23)."""
    return max(0.0, min(dimension - 2.0, 2.0 * (effective - 2.0)))


def weight(distance_squared: Array, r: Any, c: float, gamma: Any = None, *, positive_part: bool = True) -> Array:
    """Return s = (1 - r^2 c / D2)^+ (eq. 22), times exp(-gamma / r^2) if gamma is given (eq. 25).

    D2 = 0 gives 0, or 1 where r^2 c = 0; r = 0 makes the second factor 0 unless gamma is 0.
    """
    D2 = np.asarray(distance_squared)
    lost = np.asarray(np.square(r) * c, dtype=D2.dtype)
    with np.errstate(all="ignore"):
        s = np.where(lost > 0, 1 - lost / D2, np.where(D2 == 0, 1, 1 + 0 * D2))
        if positive_part:
            s = np.where(lost >= D2, np.where(lost > 0, 0, 1), s)
        if c > 0:
            s = np.where(np.isnan(lost) & (D2 > 0), np.nan, s)  # an r that is no number weighs nothing
        if gamma is not None:
            square = np.square(r)
            if square < SMALLEST_SQUARE:
                return np.asarray(s * 0 if gamma > 0 else s)
            s = s * np.exp(np.asarray(-gamma / square, dtype=D2.dtype))
    return np.asarray(s)


def james_stein(
    prediction: Array, reading: Array, C: Array, Pi: Array, r: float, gamma: float | None = None, *,
    positive_part: bool = True,
) -> Estimate:  # fmt: skip
    """Correct predictions by readings y = C x + Pi v, v ~ N(0, r^2 I).

    Parameters
    ----------
    prediction : array (..., n)
        x-; leading axes are independent cases.
    reading : array (..., m)
        y.
    C : array (m, n)
        Of rank n.
    Pi : array (m, m)
        Shape of the noise.
    r : float
        Its standard deviation.
    gamma : float, optional
        Of the modified estimator.
    positive_part : bool
        False gives the original estimator, whose weight may be negative.

    Raises
    ------
    ValueError
        If the rank of C is lower than n.
    """
    n = C.shape[1]
    whitened = np.linalg.solve(Pi, C)
    if np.linalg.matrix_rank(whitened) < n:
        raise ValueError(f"C has rank {np.linalg.matrix_rank(whitened)} and n is {n}; measure every state")
    n_star = effective_dimension(C, Pi)
    L = np.linalg.pinv(whitened) @ np.linalg.inv(Pi)
    e = (reading - prediction @ C.T) @ L.T
    D2 = np.sum((e @ whitened.T) ** 2, axis=-1)
    s = weight(D2, r, shrink_constant(n, n_star), gamma, positive_part=positive_part)
    return Estimate(prediction + s[..., None] * e, s, D2, prediction + e, n_star)


# ---------------------------------------------------------------------------------------------------------------------
# The oracle of a Block


@dataclass(frozen=True, eq=False)
class Reading:
    """How a sensor is taken.

    Attributes
    ----------
    std : float
        What the plant's own noise is divided by to give Pi Pi'.
    shape : callable or None
        (x, z, u, p) -> (Pi,), where the user gave one.
    iterations : int
        Steps of Gauss-Newton; 1 for a reading that is linear in the state.
    modified : bool
        Whether there is a parameter ``gamma_<sensor>``.
    reduced : bool
        A lower rank corrects in the subspace that is seen.
    constant : bool
        The weights are computed once, so that nothing is judged of them in a call.
    """

    std: float
    shape: Lowered | None
    iterations: int
    modified: bool
    reduced: bool
    constant: bool


class JamesSteinOracle:
    """A James-Stein estimator, entry by entry: the independent view of a Block.

    Parameters
    ----------
    model : Model
        f and h, names, sizes and ranges.
    readings : dict
        Sensor name -> Reading.
    noises : dict
        Name of a noise parameter, as `Model` names it -> its numbers: the plant's own.
    """

    def __init__(self, model: Model, readings: Mapping[str, Reading], noises: Mapping[str, Array]):
        self.model, self.readings, self.noises = model, readings, noises

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type = np.float64,
    ) -> tuple[int, dict[str, Any], dict[str, Any]]:
        """Run an entry: compute, judge; whoever calls commits. See `KalmanOracle.call`."""
        one = _Call(self, params, precision)
        with np.errstate(all="ignore"):
            try:
                if entry == "init":
                    status, x, outputs = one.init()
                else:
                    x = stack([state.name for state in self.model.states], memory, precision)
                    if entry == "predict":
                        status, x, outputs = one.predict(x, inputs)
                    elif entry == "step":
                        status, x, outputs = one.step(x, inputs)
                    else:
                        status, x, outputs = one.update(self.model.sensor(entry.removeprefix("update_")), x, inputs)
            except Refused as refusal:
                return int(refusal.status), {}, {}
        return int(status), split_state(self.model, x), outputs


Answer = tuple[Status, Array, dict[str, Array]]


class _Call:
    """One call: parameters and precision."""

    def __init__(self, oracle: JamesSteinOracle, params: Mapping[str, Any], precision: Precision):
        self.oracle, self.model, self.precision = oracle, oracle.model, precision
        self.params = {name: np.asarray(value, dtype=precision).ravel() for name, value in params.items()}
        self.noises = {name: np.asarray(value, dtype=precision).ravel() for name, value in oracle.noises.items()}
        self.p = stack(self.model.plant_params, self.params, precision)

    def init(self) -> Answer:
        for item in self.model.params:
            if not self.within(self.params[item.name], item.low, item.high):
                raise Refused(Status.BAD_PARAM)
        return Status.OK, stack([f"{state.name}_0" for state in self.model.states], self.params, self.precision), {}

    def predict(self, x: Array, inputs: Mapping[str, Any]) -> Answer:
        """x- = f(x+, u)."""
        model = self.model
        limits = list(model.inputs)
        if isinstance(model.dt, tuple):
            low, high = model.dt
            limits.append(InputModel("dt", 1, np.array([low]), np.array([high])))
        self.judge_inputs(limits, inputs)
        dt = self.precision(np.ravel(inputs["dt"])[0] if isinstance(model.dt, tuple) else model.dt)
        after, _ = transition(model, x, stack_inputs(model, inputs, self.precision), self.p, dt)
        return Status.OK, self.judged(after), {}

    def update(self, sensor: SensorModel, x: Array, inputs: Mapping[str, Any]) -> Answer:
        """x+ = x- + s (x_ML - x-)."""
        needed = [item for item in self.model.inputs if item.name in sensor.inputs]
        self.judge_inputs([InputModel(sensor.name, sensor.size, sensor.low, sensor.high), *needed], inputs)
        reading = self.oracle.readings[sensor.name]
        z = np.asarray(inputs[sensor.name], dtype=self.precision).ravel()
        u = stack_inputs(self.model, inputs, self.precision)
        root = self.noise_root(sensor, reading, x, z, u)
        total, innovation = np.zeros(len(x)), None
        for _ in range(reading.iterations):
            residual = self.residual(sensor, retract(self.model, x, total.astype(self.precision)), z, u)
            innovation = residual if innovation is None else innovation
            whitened = self.whitened(sensor, reading, root, x + total.astype(self.precision), u)
            step = np.linalg.solve(root, residual.astype(float))
            total = total + np.linalg.pinv(whitened, rcond=1e-13) @ step
        if reading.iterations > 1:  # weights where the state of maximum likelihood lies
            whitened = self.whitened(sensor, reading, root, x + total.astype(self.precision), u)
        assert innovation is not None
        singular = np.linalg.svd(whitened, compute_uv=False)
        singular = singular[singular > 1e-13 * singular[0]]
        c = shrink_constant(len(singular), float(np.sum(singular**-2.0) / np.max(singular**-2.0)))
        D2 = np.sum((whitened @ total) ** 2)
        if not D2 <= LARGEST:
            raise Refused(Status.OVERFLOW)
        gamma = self.params[f"gamma_{sensor.name}"][0] if reading.modified else None
        s = weight(
            np.asarray(D2), float(self.params[f"std_{sensor.name}"][0]), c, None if gamma is None else float(gamma)
        )
        after = self.judged(wrapped(self.model, retract(self.model, x, (s * total).astype(self.precision))))
        outputs = {"innovation": innovation, "distance_squared": np.array([D2]), "weight": np.array([s])}
        return Status.OK, after, {name: value.astype(self.precision) for name, value in outputs.items()}

    def step(self, x: Array, inputs: Mapping[str, Any]) -> Answer:
        """Predict, then every sensor whose flag is up, in their order; a refused one is skipped."""
        status, x, _ = self.predict(x, inputs)
        outputs: dict[str, Array] = {}
        for sensor in self.model.sensors:
            own = Status.OK
            sizes = {"innovation": sensor.size, "distance_squared": 1, "weight": 1}
            report = {name: np.zeros(size, dtype=self.precision) for name, size in sizes.items()}
            if bool(np.ravel(inputs[f"has_{sensor.name}"])[0]):
                try:
                    own, x, report = self.update(sensor, x, inputs)
                except Refused as refusal:
                    own, status = refusal.status, Status.SKIPPED
            outputs[f"status_{sensor.name}"] = np.array([own], dtype=np.int32)
            outputs |= {f"{sensor.name}.{name}": value for name, value in report.items()}
        return status, x, outputs

    # -- parts --------------------------------------------------------------------------------------------------------

    def residual(self, sensor: SensorModel, x: Array, z: Array, u: Array) -> Array:
        """Return z - h(x), wrapped for an angle."""
        difference = z - expected(sensor, x, u, self.p)
        return wrapped_angle(difference) if sensor.angle else difference

    def derivative(self, sensor: SensorModel, x: Array, u: Array) -> Array:
        """Return dh/dx by complex step."""
        return complex_step(lambda error: expected(sensor, x[:, None] + error, u, self.p), np.zeros_like(x)).astype(
            float
        )

    def noise_root(self, sensor: SensorModel, reading: Reading, x: Array, z: Array, u: Array) -> Array:
        """Return a root of Pi Pi'; refuse one that is singular."""
        if reading.shape is not None:
            Pi = evaluated(reading.shape, x, z, u, self.p).reshape(sensor.size, sensor.size)
            shape = Pi @ Pi.T
        else:
            shape = measurement_noise(sensor, x, z, u, self.p, self.noises)[0] / self.precision(reading.std**2)
        shape = shape.astype(float)
        if not np.all(np.isfinite(shape)):
            raise Refused(Status.OVERFLOW if np.any(np.isnan(shape)) else Status.NOT_POSITIVE)
        try:
            root = np.linalg.cholesky(shape)
        except np.linalg.LinAlgError:
            raise Refused(Status.NOT_POSITIVE) from None
        if not (reading.constant or np.min(np.diag(root)) ** 2 >= LEAST_PIVOT):
            raise Refused(Status.NOT_POSITIVE)
        return root

    def whitened(self, sensor: SensorModel, reading: Reading, root: Array, x: Array, u: Array) -> Array:
        """Return Pi^-1 C; refuse one whose columns depend on each other, unless it is constant."""
        answer = np.linalg.solve(root, self.derivative(sensor, x, u))
        if not np.all(np.isfinite(answer)):
            raise Refused(Status.OVERFLOW)
        if not (reading.constant or _least_pivot(answer) >= LEAST_PIVOT):
            raise Refused(Status.NOT_POSITIVE)
        return answer

    def judged(self, x: Array) -> Array:
        """Refuse a state outside its range."""
        for state, at, _ in self.model.places:
            if not self.within(x[at], state.low, state.high):
                raise Refused(Status.OVERFLOW)
        return x

    def within(self, value: Array, low: Array, high: Array) -> bool:
        """Whether every element lies in its range, whose ends are rounded to the working precision; false for NaN."""
        return bool(np.all((value >= low.astype(self.precision)) & (value <= high.astype(self.precision))))

    def judge_inputs(self, signals: list[InputModel], inputs: Mapping[str, Any]) -> None:
        """Refuse inputs outside their ranges."""
        for item in signals:
            value = np.asarray(inputs[item.name], dtype=self.precision).ravel()
            if not self.within(value, item.low, item.high):
                raise Refused(Status.BAD_INPUT)


def _least_pivot(matrix: Array) -> float:
    """Return the least squared part of a column that is its own, relative to the column (of length 1e-15 at least)."""
    if len(matrix) < matrix.shape[1]:
        return 0.0
    own = np.diag(np.linalg.qr(matrix, mode="r")) ** 2
    return float(np.min(own / np.maximum(np.sum(matrix**2, axis=0), SMALLEST_SQUARE)))


class JamesSteinExercise:
    """Plausible calls: those of a Kalman filter of the same plant, without what only such a filter has."""

    def __init__(self, exercise: Exercise):
        self.exercise = exercise

    def calls(self, rng: np.random.Generator, steps: int) -> Calls:
        """Yield calls, (entry, inputs); the first is "init". What is sent goes to the exercise."""
        stream, told = self.exercise.calls(rng, steps), None
        with contextlib.suppress(StopIteration):
            while True:
                entry, inputs = stream.send(told)
                if entry != "inflate":
                    told = yield entry, inputs

    def memory(self, rng: np.random.Generator) -> dict[str, Array]:
        """Return a state near the nominal one."""
        return split_state(self.exercise.model, self.exercise.near(rng))
