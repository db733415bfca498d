"""The steady-state Kalman filter: a linear observer with the gain of the algebraic Riccati equation."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_are

from ..reference.steady_state import SteadyStateOracle
from .block import Block, Design, Scenario
from .derivation import dynamics_equations, plant_equations
from .discretisation import process_covariance, transition
from .errors import ModelError
from .estimators import is_linear
from .expressions import numpy_callable
from .plant import Plant, wrap
from .program import Assign, Attempt, Call, Element, Entry, Evaluate, IsSet, Place, Raise, Refuse, Statement, When
from .signals import Kind, Signal, Status, spread

Array = NDArray[Any]


def build(plant: Plant, around: Mapping[Any, Any], name: str, doc: str, gain: Any) -> Block:
    """Design the gain unless one is given, and assemble the block; see `steady_state_kalman_filter`."""
    if not plant.is_discrete or isinstance(plant.dt, tuple):
        raise ModelError(f"{plant.name}: a steady state needs a constant time step; discretise with dt=0.01, say")
    if not is_linear(plant):
        raise ModelError(
            f"{plant.name}: a steady-state filter needs a linear plant; linearise it, or use extended_kalman_filter"
        )
    if not plant.sensors:
        raise ModelError(f"{plant.name}: an estimator needs a sensor, and this plant has none; add sensor(...)")
    if any(sensor.variance_expression is not None for sensor in plant.sensors):
        raise ModelError(f"{plant.name}: a steady-state filter needs constant sensor noise; give variance= as numbers")
    A, C, Q, R = _matrices(plant)
    if gain is None:
        gain = _design(plant, A, C, Q, R)
    gain = np.asarray(gain, dtype=float)
    if gain.shape != (plant.error_size, len(C)):
        raise ModelError(f"{name}: the gain has shape {gain.shape}; give {plant.error_size} x {len(C)}")
    return _assemble(plant, around, name, doc, gain, (A, C, Q, R))


def _matrices(plant: Plant) -> tuple[Array, Array, Array, Array]:
    """Return A, C, Q, R as numbers, at the default parameters."""
    defaults = [item for symbol in plant.parameters for item in (symbol.signal.default or ())]

    def numbers(expression: ca.SX) -> Array:
        function = ca.Function("numbers", [plant.x, plant.u, plant.p], [ca.densify(expression)])
        if function.get_free():
            raise ModelError(f"{plant.name}: its matrices depend on {function.get_free()}; they must be constant")
        zeros = [np.zeros(plant.x.numel()), np.zeros(plant.u.numel()), np.array(defaults)]
        return np.asarray(function(*zeros), dtype=float)

    h = plant.without_noise(ca.vertcat(*[plant.folded(sensor.expression) for sensor in plant.sensors]))
    strength = ca.diagcat(*[ca.SX(ca.DM(noise.strength)) for noise in plant.process_noises])
    Q = process_covariance(plant, strength) if plant.process_noises else ca.SX(plant.error_size, plant.error_size)
    for state in plant.states:
        if state.signal.name in plant.step_variances:
            Q[state.error_at, state.error_at] += ca.diag(ca.DM(plant.step_variances[state.signal.name]))
    blocks = []
    for sensor in plant.sensors:
        size = sensor.signal.size
        R = ca.SX(ca.DM(sensor.strength)) if sensor.strength is not None else ca.SX(size, size)
        noises = plant.sensor_noises(sensor)
        if noises:
            N = plant.without_noise(
                ca.jacobian(plant.folded(sensor.expression), ca.vertcat(*[n.symbol for n in noises]))
            )
            R = R + N @ ca.diagcat(*[ca.SX(ca.DM(noise.strength)) for noise in noises]) @ N.T
        blocks.append(R)
    return numbers(transition(plant)[1]), numbers(ca.jacobian(h, plant.x)), numbers(Q), numbers(ca.diagcat(*blocks))


def _design(plant: Plant, A: Array, C: Array, Q: Array, R: Array) -> Array:
    """Return the gain, rounded to 9 digits."""
    try:
        P = solve_discrete_are(A.T, C.T, Q, R)
        K = np.linalg.solve(C @ P @ C.T + R, C @ P).T
    except (np.linalg.LinAlgError, ValueError):
        K = np.full((len(A), len(C)), np.nan)
    radius = np.max(np.abs(np.linalg.eigvals((np.eye(len(A)) - K @ C) @ A))) if np.all(np.isfinite(K)) else np.inf
    if not radius < 1:
        raise ModelError(
            f"{plant.name}: no stabilising gain exists; the sensors must see every unstable state (detectability), and noise must "
            "drive every state that is not stable"
        )
    return np.array([[float(f"{item:.8e}") for item in row] for row in K])


def _properties(matrices: tuple[Array, Array, Array, Array], K: Array) -> dict[str, tuple[float, float]]:
    """Return how well a gain solves its equations: spectral radius, and the residual of the gain equation."""
    A, C, Q, R = matrices
    radius = float(np.max(np.abs(np.linalg.eigvals((np.eye(len(A)) - K @ C) @ A))))
    P = solve_discrete_are(A.T, C.T, Q, R)
    residual = float(np.max(np.abs(K @ (C @ P @ C.T + R) - P @ C.T)) / np.max(np.abs(P @ C.T)))
    return {"spectral radius of (I - K C) A": (radius, 1.0), "residual of the gain equation": (residual, 1e-6)}


def _assemble(
    plant: Plant,
    around: Mapping[Any, Any],
    name: str,
    doc: str,
    gain: Array,
    matrices: tuple[Array, Array, Array, Array],
) -> Block:
    block = Block(name, doc=doc or f'Kalman filter in steady state of the plant "{plant.name}"')
    nominal = {key if isinstance(key, str) else key.signal.name: value for key, value in around.items()}
    block.param_signals += [symbol.signal for symbol in plant.parameters]
    for state in plant.states:
        signal = state.signal
        block.memory_signals.append(signal)
        value = np.clip(spread(nominal.get(signal.name, 0.0), signal.size), signal.low, signal.high)
        default = tuple(float(item) for item in value)
        block.param_signals.append(
            Signal(
                f"{signal.name}_0",
                signal.size,
                signal.unit,
                signal.low,
                signal.high,
                f"initial {signal.name}",
                default=default,
            )
        )
    states = [state.signal.name for state in plant.states]
    body: list[Statement] = [
        Assign(Place("next", signal.name), Place("param", f"{signal.name}_0"), signal.size)
        for signal in block.memory_signals
    ]
    init = Entry(
        "init", (), (), tuple(body), "Start (or start again) from the parameters; every parameter is checked here.",
        checks_params=True,
    )  # fmt: skip
    symbols = [ca.SX(state.symbol) for state in plant.states]
    places = [((Place("memory", state.signal.name), state.signal.size),) for state in plant.states]
    params = [(symbol.signal, ca.SX(symbol)) for symbol in plant.parameters]
    inputs = [(symbol.signal, ca.SX(symbol)) for symbol in plant.inputs]
    readings = [(sensor.signal, ca.SX(sensor.measurement)) for sensor in plant.sensors]
    targets = tuple((Place("next", state.signal.name), state.signal.size) for state in plant.states)
    names = tuple(f"next_{s}_{i}" for s, size in ((t[0].name, t[1]) for t in targets) for i in range(size))

    def evaluate(label: str, taken: list[tuple[Signal, ca.SX]], outputs: list[Any], comment: list[str]) -> Evaluate:
        function = ca.Function(
            f"{name}_{label}",
            [*symbols, *[s for _, s in taken], *[s for _, s in params]],
            [ca.densify(value) for value, _, _ in outputs],
        )
        reads = [
            *places,
            *[((Place("in", s.name), s.size),) for s, _ in taken],
            *[((Place("param", s.name), s.size),) for s, _ in params],
        ]
        return Evaluate(
            function, tuple(reads), tuple(t for _, t, _ in outputs), tuple(n for _, _, n in outputs), tuple(comment)
        )

    judge = Refuse(Status.OVERFLOW, block.judge_memory(states))
    following, _ = transition(plant)
    predict = Entry(
        "predict", tuple(s for s, _ in inputs), (),
        (evaluate("predict", inputs, [(following, targets, names)], dynamics_equations(plant)), judge),
        "Move the estimate one step ahead.",
    )  # fmt: skip
    residuals = []
    for sensor in plant.sensors:
        residual = ca.SX(sensor.measurement) - plant.without_noise(plant.folded(sensor.expression))
        residuals.append(wrap(residual) if sensor.signal.angle else residual)
    innovation = ca.vertcat(*residuals)
    used = [(s, e) for s, e in inputs if ca.depends_on(innovation, e)]
    corrected = plant.wrapped(plant.x + ca.SX(ca.sparsify(ca.DM(gain))) @ innovation)
    m = innovation.numel()
    report = (Signal("innovation", m, low=(-1e30,) * m, high=(1e30,) * m, doc="measured minus expected, all sensors"),)
    out = ((Place("out", "innovation"), m),)
    update = Entry(
        "update", tuple(s for s, _ in (*readings, *used)), report,
        (
            evaluate(
                "update", [*readings, *used],
                [(innovation, out, tuple(f"innovation_{i}" for i in range(m))), (corrected, targets, names)],
                ["x = x + K (z - h(x)), K constant"],
            ),
            judge,
        ),
        "Correct the estimate with one reading of every sensor.",
    )  # fmt: skip
    flag = Signal("has_readings", kind=Kind.FLAG, low=(0.0,), high=(1.0,), doc="whether there are readings")
    status = Signal("status_update", kind=Kind.STATUS, doc="status of the update itself")
    group = Signal("update", kind=Kind.GROUP, members=report, doc="what update reported, else zeros")
    zeros = (Assign(Place("out", "update.innovation"), 0.0, m),)
    given = tuple((signal.name, Place("in", signal.name)) for signal in update.inputs)
    attempt = Attempt(
        (Call("update", given, Place("out", "update")),),
        Place("out", "status_update"),
        (),
        (*zeros, Raise(Status.SKIPPED)),
    )
    call = Call("predict", tuple((s.name, Place("in", s.name)) for s, _ in inputs))
    when = When(
        IsSet(Element(Place("in", "has_readings"))),
        (attempt,),
        (*zeros, Assign(Place("out", "status_update"), 0.0, 1)),
        "readings",
    )
    step = Entry(
        "step", (*[s for s, _ in inputs], flag, *[s for s, _ in readings]), (status, group), (call, when),
        "Predict, then update if there are readings; refused readings are skipped.",
    )  # fmt: skip
    block.entries = {entry.name: entry for entry in (init, predict, update, step)}
    block.equations = plant_equations(plant)
    block.notes = ["Constant gain: the steady state of the Kalman filter."]
    block.source_hash = plant.fingerprint() + repr(gain.tolist())
    block.check()
    source = hashlib.sha256(repr([np.round(item, 9).tolist() for item in matrices]).encode()).hexdigest()[:16]
    block.design = Design(
        {"gain": gain},
        source,
        lambda values: _rebuilt(build(plant, around, name, doc, values["gain"]), block.source),
        lambda values: _properties(matrices, np.asarray(values["gain"])),
    )
    oracle = _oracle(plant, block, gain)
    block.oracle = oracle
    x0 = np.concatenate([np.asarray(signal.default) for signal in block.param_signals[len(params) :]])
    u0 = np.concatenate(
        [np.zeros(0), *[np.clip(spread(nominal.get(s.name, 0.0), s.size), s.low, s.high) for s, _ in inputs]]
    )

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        return oracle.exercise(rng, steps, x0, u0, np.sqrt(np.diag(matrices[2])), np.linalg.cholesky(matrices[3]))

    def memory(rng: Any) -> dict[str, Any]:
        return oracle.split(x0 + 0.1 * (1 + np.abs(x0)) * np.clip(rng.normal(size=len(x0)), -3, 3))

    block.scenario = Scenario(calls, memory)
    return block


def _rebuilt(block: Block, source: str) -> Block:
    """Return a block that belongs to the line where it was first made."""
    block.source = source
    return block


def _oracle(plant: Plant, block: Block, gain: Array) -> SteadyStateOracle:
    """Lower f and h to NumPy; the gain is a number that both sides share, as it is what was designed."""
    h = plant.without_noise(ca.vertcat(*[plant.folded(sensor.expression) for sensor in plant.sensors]))
    following = transition(plant)[0]
    return SteadyStateOracle(
        states=tuple(
            (s.signal.name, s.signal.size, s.signal.angle, np.array(s.signal.low), np.array(s.signal.high))
            for s in plant.states
        ),
        inputs=tuple(
            (s.signal.name, s.signal.size, np.array(s.signal.low), np.array(s.signal.high)) for s in plant.inputs
        ),
        sensors=tuple(
            (s.signal.name, s.signal.size, s.signal.angle, np.array(s.signal.low), np.array(s.signal.high))
            for s in plant.sensors
        ),
        params=tuple((s.name, np.array(s.low), np.array(s.high)) for s in block.param_signals),
        plant_params=tuple(symbol.signal.name for symbol in plant.parameters),
        used=tuple(signal.name for signal in block.entries["update"].inputs[len(plant.sensors) :]),
        f=numpy_callable(ca.Function("f", [plant.x, plant.u, plant.p], [ca.densify(following)])),
        h=numpy_callable(ca.Function("h", [plant.x, plant.u, plant.p], [ca.densify(h)])),
        gain=gain,
    )
