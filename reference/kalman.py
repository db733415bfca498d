"""The extended Kalman filter of a textbook: batch measurement update, Joseph's form.

Y. Bar-Shalom, X. R. Li, T. Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, sec. 5.2 and
10.3; error state and reset for attitudes: F. L. Markley, "Attitude error representations for Kalman filtering", 2003,
and R. M. Reynolds, "Asymptotically optimal attitude filtering with guaranteed convergence", JGCD 31(1), 2008.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy.linalg import cho_solve, solve_triangular

from . import quaternions
from .discretisation import (
    central_differences,
    complex_step,
    error_map,
    expected,
    measurement,
    process_covariance,
    retract,
    transition,
    with_step_noise,
    wrapped,
    wrapped_angle,
)
from .model import (
    Array,
    InputModel,
    Model,
    Precision,
    SensorModel,
    packed,
    split_state,
    stack,
    stack_inputs,
    strength,
    unpacked,
)

SMALLEST_VARIANCE = 1.0e-20
"""Least innovation variance, and least pivot of a noise matrix."""

LARGEST_COUNT = 2**32 - 1

Memory = dict[str, Array]
Answer = tuple[int, Memory, dict[str, Array]]


class Status(enum.IntEnum):
    """What a call returns: negative refused, zero good, positive degraded."""

    OK = 0
    GATED = 1
    CLAMPED = 2
    SKIPPED = 3
    RECOVERED = 4
    BAD_INPUT = -1
    BAD_PARAM = -2
    NOT_POSITIVE = -3
    OVERFLOW = -4


class Refused(Exception):  # noqa: N818 - it is an outcome, not an error
    """An entry refuses a call, with this status."""

    def __init__(self, status: Status):
        super().__init__(status.name)
        self.status = status


def ldl(matrix: Array) -> tuple[Array, Array]:
    """Return (L, d) of a symmetric matrix = L diag(d) L', L unit lower triangular, without pivoting.

    Golub & Van Loan, "Matrix Computations", 4th ed., alg. 4.1.2. The pivots d are all positive just where the matrix is
    positive definite; after one that is zero, those that follow are not numbers.
    """
    n = len(matrix)
    L, d = np.eye(n, dtype=matrix.dtype), np.zeros(n, dtype=matrix.dtype)
    for j in range(n):
        d[j] = matrix[j, j] - np.sum(L[j, :j] ** 2 * d[:j])
        L[j + 1 :, j] = (matrix[j + 1 :, j] - L[j + 1 :, :j] @ (d[:j] * L[j, :j])) / d[j]
    return L, d


class KalmanOracle:
    """A Kalman filter, entry by entry: the independent view of a Block.

    Parameters
    ----------
    model : Model
        f and h, names, sizes and ranges.
    """

    def __init__(self, model: Model):
        self.model = model
        self.filter_type: type[Filter] = Filter

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type = np.float64,
    ) -> Answer:
        """Run an entry: compute, judge; whoever calls commits.

        Parameters
        ----------
        entry : str
            "init", "predict", ``update_<sensor>``, "step" or "inflate".
        memory, inputs, params : dict
            Name -> array.
        precision : {numpy.float64, numpy.float32}
            In which everything is computed.

        Returns
        -------
        status : int
            See `Status`.
        memory, outputs : dict
            Name -> array; empty if the status is negative.
        """
        filter_ = self.filter_type(self.model, params, precision)
        before = filter_.memory(memory) if entry != "init" else {}
        with np.errstate(all="ignore"):
            try:
                if entry == "init":
                    status, after, outputs = filter_.init()
                elif entry == "predict":
                    status, after, outputs = filter_.predict(before, inputs)
                elif entry == "inflate":
                    status, after, outputs = filter_.inflate(before, inputs["factor"])
                elif entry == "step":
                    status, after, outputs = filter_.step(before, inputs)
                else:
                    sensor = self.model.sensor(entry.removeprefix("update_"))
                    gate = filter_.params[f"gate_{sensor.name}"][0]
                    status, after, outputs = filter_.update(sensor, before, inputs, gate)
            except Refused as refusal:
                return int(refusal.status), {}, {}
        return int(status), after, outputs


class Filter:
    """One call: model, parameters and precision. Methods return (status, memory, outputs) or raise Refused."""

    def __init__(self, model: Model, params: Mapping[str, Any], precision: Precision):
        self.model, self.precision = model, precision
        self.params = {name: np.asarray(value, dtype=precision).ravel() for name, value in params.items()}
        # a count does not fit into single precision
        self.reject_limit = int(np.ravel(params["reject_limit"])[0])
        self.p = stack(model.plant_params, self.params, precision)
        self.ceiling = np.asarray(model.ceiling, dtype=precision)
        self.floor = np.asarray(model.floor, dtype=precision)
        self.beside = np.sqrt(np.outer(model.ceiling, model.ceiling)).astype(precision)

    # -- entries ------------------------------------------------------------------------------------------------------

    def init(self) -> tuple[Status, Memory, dict[str, Array]]:
        """Start from the parameters."""
        for item in self.model.params:
            if not self.within(self.params[item.name], item.low, item.high):
                raise Refused(Status.BAD_PARAM)
        for name in self.full_matrices():
            self.require_definite(unpacked(self.params[name]), Status.BAD_PARAM)
        x = stack([f"{state.name}_0" for state in self.model.states], self.params, self.precision)
        for state, at, _ in self.model.places:
            if state.kind == "attitude":
                square = np.sum(x[at] * x[at])
                if not self.precision(0.98) <= square <= self.precision(1.02):
                    raise Refused(Status.BAD_PARAM)
                x[at] = x[at] / np.sqrt(square)
        variances = stack([f"variance_{state.name}_0" for state in self.model.states], self.params, self.precision)
        status, P = self.held(np.diag(variances))
        counters = {f"rejected_{sensor.name}": np.zeros(1, dtype=np.uint32) for sensor in self.model.sensors}
        kept = {item.name: self.params[f"{item.name}_0"].copy() for item in self.model.carried}
        after = {**split_state(self.model, x), **kept, "covariance": packed(P, self.model.blocks), **counters}
        return status, after, {}

    def predict(self, memory: Memory, inputs: Mapping[str, Any]) -> tuple[Status, Memory, dict[str, Array]]:
        """x+ = f(x, u), P+ = F P F' + Q (Bar-Shalom et al., eq. 10.3.2-4)."""
        model = self.model
        self.judge_inputs([*model.inputs, *model.carried], inputs)
        if isinstance(model.dt, tuple):
            low, high = model.dt
            self.judge_inputs([InputModel("dt", 1, np.array([low]), np.array([high]))], inputs)
            dt = self.precision(np.ravel(inputs["dt"])[0])
        else:
            dt = self.precision(model.dt)
        x, P = self.estimate(memory)
        u = stack_inputs(model, inputs, self.precision)
        Q = process_covariance(model, x, u, self.p, dt, self.params)
        x_after, F = transition(model, x, u, self.p, dt)
        if model.error_step is not None:
            F, G = model.error_step(x, u, self.p, memory, inputs)
            Q = with_step_noise(model, G @ strength(model.noises, self.params, self.precision) @ G.T, self.params)
        status, P = self.held(F @ P @ F.T + self.accepted_noise(Q))
        self.judge(P, x_after)
        kept = {item.name: np.array(inputs[item.name], dtype=self.precision).ravel() for item in model.carried}
        return status, {**self.with_estimate(memory, x_after, P), **kept}, {}

    def update(
        self, sensor: SensorModel, memory: Memory, inputs: Mapping[str, Any], gate: Any
    ) -> tuple[Status, Memory, dict[str, Array]]:
        """Take one reading: gate, x + K nu, (I - K H) P (I - K H)' + K R K' (Bar-Shalom et al., eq. 5.2.3-18)."""
        model = self.model
        needed = [item for item in model.inputs if item.name in sensor.inputs]
        self.judge_inputs([InputModel(sensor.name, sensor.size, sensor.low, sensor.high), *needed], inputs)
        x, P = self.estimate(memory)
        z = np.asarray(inputs[sensor.name], dtype=self.precision).ravel()
        u = stack_inputs(model, inputs, self.precision)
        innovation, H, R, correlated = measurement(model, sensor, x, z, u, self.p, self.params)
        if correlated:
            self.require_definite(R, Status.NOT_POSITIVE)
        S = H @ P @ H.T + R
        root = self.require_definite(S, Status.NOT_POSITIVE)  # S = root root'
        whitened = solve_triangular(root, innovation, lower=True, check_finite=False)
        nis = np.sum(whitened * whitened)
        self.judge_variance(np.diag(S))
        if not nis <= 1e30:  # or NaN: no answer, and not to be counted as gated
            raise Refused(Status.OVERFLOW)
        outputs = {"innovation": innovation, "variance": np.diag(S).copy(), "nis": np.array([nis])}
        counter = f"rejected_{sensor.name}"
        if not (gate <= 0 or nis <= gate):
            count = min(int(memory[counter][0]) + 1, LARGEST_COUNT)
            return Status.GATED, {**memory, counter: np.array([count], dtype=np.uint32)}, outputs
        K = cho_solve((root, True), H @ P, check_finite=False).T
        keep = np.eye(model.error_size, dtype=self.precision) - K @ H
        correction = K @ innovation
        P = keep @ P @ keep.T + K @ R @ K.T
        reset = self.reset(correction)
        status, P = self.held(reset @ P @ reset.T)
        x = wrapped(model, retract(model, x, correction))
        self.judge(P, x)
        return status, {**self.with_estimate(memory, x, P), counter: np.zeros(1, dtype=np.uint32)}, outputs

    def inflate(self, memory: Memory, factor: Any) -> tuple[Status, Memory, dict[str, Array]]:
        """P+ = factor P, the estimate as it was."""
        limits = InputModel("factor", 1, np.array([1.0]), np.array([1.0e6]))
        self.judge_inputs([limits], {"factor": factor})
        status, P = self.held(self.precision(np.ravel(factor)[0]) * unpacked(memory["covariance"], self.model.blocks))
        self.judge(P)
        return status, {**memory, "covariance": packed(P, self.model.blocks)}, {}

    def step(self, memory: Memory, inputs: Mapping[str, Any]) -> tuple[Status, Memory, dict[str, Array]]:
        """Predict, then every sensor whose flag is up, in their order."""
        status, memory, _ = self.predict(memory, inputs)
        outputs: dict[str, Array] = {}
        for sensor in self.model.sensors:
            own, report = Status.OK, self.no_report(sensor)
            if bool(np.ravel(inputs[f"has_{sensor.name}"])[0]):
                recovers = 0 < self.reject_limit <= int(memory[f"rejected_{sensor.name}"][0])
                before, highest = memory, status
                try:
                    gate = self.params[f"gate_{sensor.name}"][0]
                    if recovers:
                        gate = self.precision(0)
                        inflated, memory, _ = self.inflate(memory, self.params["inflation"])
                        status = max(status, inflated, Status.RECOVERED)
                    own, memory, report = self.update(sensor, memory, inputs, gate)
                    status = max(status, own)
                except Refused as refusal:
                    own, memory, status = refusal.status, before, max(highest, Status.SKIPPED)
            outputs[f"status_{sensor.name}"] = np.array([own], dtype=np.int32)
            outputs |= {f"{sensor.name}.{name}": value for name, value in report.items()}
        return status, memory, outputs

    # -- parts --------------------------------------------------------------------------------------------------------

    def memory(self, given: Mapping[str, Any]) -> Memory:
        """Return memory fields in the working precision."""
        carried = [item.name for item in self.model.carried]
        fields = [*(state.name for state in self.model.states), *carried, "covariance"]
        answer = {name: np.array(given[name], dtype=self.precision).ravel() for name in fields}
        for sensor in self.model.sensors:
            name = f"rejected_{sensor.name}"
            answer[name] = np.array(given[name], dtype=np.uint32).ravel()
        return answer

    def judge_variance(self, variance: Array) -> None:
        """Refuse a variance of the innovation: none is, of a covariance within its ranges."""

    def accepted_noise(self, Q: Array) -> Array:
        """Return the process noise that is used: as it is."""
        return Q

    def estimate(self, memory: Memory) -> tuple[Array, Array]:
        """Return x and P."""
        x = stack([state.name for state in self.model.states], memory, self.precision)
        return x, unpacked(memory["covariance"], self.model.blocks)

    def with_estimate(self, memory: Memory, x: Array, P: Array) -> Memory:
        """Return the memory with another x and P."""
        return {**memory, **split_state(self.model, x), "covariance": packed(P, self.model.blocks)}

    def no_report(self, sensor: SensorModel) -> dict[str, Array]:
        """Return the outputs of a sensor that was not used."""
        sizes = {"innovation": sensor.size, "variance": sensor.size, "nis": 1}
        return {name: np.zeros(size, dtype=self.precision) for name, size in sizes.items()}

    def reset(self, correction: Array) -> Array:
        """Return G = I - [d]x / 2 on attitudes: errors are counted from the corrected attitude (Reynolds 2008)."""
        G = np.eye(self.model.error_size, dtype=self.precision)
        for state, _, at in self.model.places:
            if state.kind == "attitude":
                G[at, at] -= quaternions.cross_matrix(correction[at]) / 2
        return G

    def full_matrices(self) -> list[str]:
        """Return the parameters that are packed noise matrices."""
        names = [sensor.variance for sensor in self.model.sensors if sensor.full]
        noises = [*self.model.noises, *(noise for sensor in self.model.sensors for noise in sensor.noises)]
        return names + [noise.parameter for noise in noises if noise.full]

    # -- judgement ----------------------------------------------------------------------------------------------------

    def within(self, value: Array, low: Array, high: Array) -> bool:
        """Whether every element lies in its range, whose ends are rounded to the working precision; false for NaN."""
        return bool(np.all((value >= low.astype(self.precision)) & (value <= high.astype(self.precision))))

    def judge_inputs(self, signals: list[InputModel], inputs: Mapping[str, Any]) -> None:
        """Refuse inputs outside their ranges."""
        for item in signals:
            value = np.asarray(inputs[item.name], dtype=self.precision).ravel()
            if not self.within(value, item.low, item.high):
                raise Refused(Status.BAD_INPUT)

    def require_definite(self, matrix: Array, otherwise: Status) -> Array:
        """Return the Cholesky factor of a matrix; refuse one with a pivot below the smallest variance."""
        L, d = ldl(matrix)
        if not np.all(d >= self.precision(SMALLEST_VARIANCE)):
            raise Refused(otherwise)
        return np.asarray(L * np.sqrt(d))

    def held(self, P: Array) -> tuple[Status, Array]:
        """Return P, symmetric, with its variances between floor and ceiling.

        A variance above its ceiling c has row and column scaled by sqrt(c / P_ii): a congruence, so that P stays
        definite.
        """
        P = (P + P.T) / 2
        variances = np.diag(P)
        if not np.all(variances >= 0):
            raise Refused(Status.NOT_POSITIVE)
        above, below = variances > self.ceiling, variances < self.floor
        scale = np.where(above, np.sqrt(self.ceiling / variances), self.precision(1))
        P = P * np.outer(scale, scale)
        P[np.diag_indices_from(P)] = np.where(above, self.ceiling, np.where(below, self.floor, variances))
        return (Status.CLAMPED if np.any(above | below) else Status.OK), P

    def judge(self, P: Array, x: Array | None = None) -> None:
        """Refuse a result outside its ranges."""
        ok = bool(np.all(np.abs(P) <= self.beside))
        for state, at, _ in self.model.places:
            ok = ok and (x is None or self.within(x[at], state.low, state.high))
        if not ok:
            raise Refused(Status.OVERFLOW)


def derivative(model: Model, name: str, how: str) -> Callable[[Mapping[str, Any]], Array]:
    """Return a callable that differentiates f or h at named values, in double precision.

    Parameters
    ----------
    model : Model
        The plant.
    name : str
        "F", the derivative of the error after `predict` by the error before, or ``H_<sensor>``.
    how : {"complex step", "central differences"}
        The method.

    Returns
    -------
    callable
        (mapping of name -> array: states, inputs, parameters, "dt" if it is an input) -> matrix.
    """
    if how not in ("complex step", "central differences"):
        raise ValueError(f"how is {how!r}; give 'complex step' or 'central differences'")
    sensor = None if name == "F" else model.sensor(name.removeprefix("H_"))

    def at(values: Mapping[str, Any]) -> Array:
        x = stack([state.name for state in model.states], values, np.float64)
        p = stack(model.plant_params, values, np.float64)
        u = stack_inputs(model, values, np.float64)
        if sensor is None:
            dt = np.float64(np.ravel(values["dt"])[0]) if isinstance(model.dt, tuple) else np.float64(model.dt)
            function = error_map(model, x, u, p, dt)
        else:
            origin = expected(sensor, x, u, p)

            def function(error: Array) -> Array:
                change = expected(sensor, retract(model, x, error), u, p) - origin[:, None]
                return wrapped_angle(change) if sensor.angle else change

        with np.errstate(all="ignore"):
            zero = np.zeros(model.error_size)
            if how == "complex step":
                return complex_step(function, zero)
            natural = [np.maximum(np.abs(x[at]), 1) if state.kind != "attitude" else np.ones(3)
                       for state, at, _ in model.places]  # fmt: skip
            return central_differences(function, zero, np.cbrt(np.finfo(float).eps) * np.concatenate(natural))

    return at
