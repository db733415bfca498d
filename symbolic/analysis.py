"""Where a plant rests, what it looks like there, and which of its modes the inputs move and the sensors see.

Controllability and observability are decided by the Hautus (Popov-Belevitch-Hautus) test, one eigenvalue at a time, on
a scaled system. The rank of the Kalman matrix (B, AB, ..., A^(n-1) B) is never formed: its columns grow or shrink as
powers of A, so that its rank is lost in rounding long before the plant loses a mode (Paige, "Properties of numerical
algorithms related to computing controllability", IEEE TAC 26, 1981).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from .discretisation import noise_gain, transition
from .errors import ModelError, expect
from .names import name_of
from .origins import said_at
from .plant import Plant, Sensor, Symbol, wrap
from .signals import WIDE, Signal

Array = NDArray[Any]
Values = Mapping[Any, Any]
"""State, input or parameter (a Symbol or its name) -> value."""

TRIM_TOLERANCE = 1.0e-9
"""Largest residual of an equilibrium, relative to the size of the terms of its equation."""

HAUTUS_TOLERANCE = 1.0e-10
"""Relative distance from a plant without the mode, below which a mode counts as not controllable."""

DIGITS = 12
"""Significant digits of the numbers in a linearised plant."""

DUST = 1.0e-15
"""Entries of a linearised plant below this fraction of the largest are rounding, and dropped."""


class TrimError(ModelError):
    """There is no equilibrium where `trim` looked; the message names the equations that could not be met."""


# -- operating points -------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class OperatingPoint(Mapping[str, Any]):
    """States, inputs and parameters at which a plant is looked at.

    It is a mapping of the names of states and inputs to their values (a float, or an array for a vector), and may be
    given wherever a dictionary of those is expected; the parameters are in `parameters`.

    Attributes
    ----------
    plant : Plant
        The plant.
    x, u, p : ndarray
        State vector (n,), input vector, parameter vector, in the units of the signals. Not writeable.
    residual : ndarray, shape (error_size,)
        What is left of the equations: the rates (continuous plant, or one made discrete from it), or the change over
        one step, less what was asked of `trim` with ``rates=``.
    """

    plant: Plant
    x: Array
    u: Array
    p: Array
    residual: Array

    @classmethod
    def at(cls, plant: Plant, values: Values | None = None) -> OperatingPoint:
        """Return the point with the given values; the rest are defaults.

        Parameters
        ----------
        plant : Plant
            The plant.
        values : dict, optional
            State, input or parameter (or its name) -> value. Default: zero, or the end of the range that is nearest to
            it; an attitude (1, 0, 0, 0); a parameter its own default. Angles are wrapped, quaternions normalised.

        Raises
        ------
        ModelError
            If a name is not known, or a value is outside its range or of another size.
        """
        expect(plant, Plant, "an operating point: its plant", "a Plant")
        expect(
            {} if values is None else values,
            (Mapping, OperatingPoint),
            f"{plant.name}: the operating point",
            "{state or input: value}",
        )
        given = _everything(values) if isinstance(values, OperatingPoint) else _by_name(values or {})
        x, u, p = _vectors(plant, given, "the operating point")
        return cls(plant, _frozen(x), _frozen(u), _frozen(p), _frozen(_Equations(plant).residual(x, u, p)))

    @property
    def states(self) -> dict[str, Any]:
        """State name -> value."""
        return _named([state.signal for state in self.plant.states], self.x)

    @property
    def inputs(self) -> dict[str, Any]:
        """Input name -> value."""
        return _named([symbol.signal for symbol in self.plant.inputs], self.u)

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameter name -> value."""
        return _named([symbol.signal for symbol in self.plant.parameters], self.p)

    def __getitem__(self, key: Any) -> Any:
        return {**self.states, **self.inputs}[name_of(key)]

    def __iter__(self) -> Iterator[str]:
        return iter({**self.states, **self.inputs})

    def __len__(self) -> int:
        return len(self.plant.states) + len(self.plant.inputs)

    def __contains__(self, key: object) -> bool:
        return isinstance(key, (str, Symbol)) and name_of(key) in {**self.states, **self.inputs}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, OperatingPoint):
            return NotImplemented
        pairs = ((self.x, other.x), (self.u, other.u), (self.p, other.p))
        return self.plant is other.plant and all(np.array_equal(a, b) for a, b in pairs)

    def __hash__(self) -> int:
        return hash((id(self.plant), self.x.tobytes(), self.u.tobytes(), self.p.tobytes()))

    def __str__(self) -> str:
        table = {**self.states, **self.inputs, **self.parameters}
        items = [f"{name} = {np.array2string(np.asarray(value), precision=6)}" for name, value in table.items()]
        return f"{self.plant.name} at " + ", ".join(items)


def trim(
    plant: Plant,
    *,
    hold: Values | None = None,
    free: Sequence[Symbol | str] | None = None,
    rates: Values | None = None,
    bounds: Mapping[Any, tuple[Any, Any]] | None = None,
    guess: Values | None = None,
) -> OperatingPoint:
    """Return an equilibrium: rates are zero (continuous plant), or the next state is the state (discrete plant).

    An equilibrium of a plant made by `discretise` is that of its continuous plant. Attitudes are solved for by their
    error, a small rotation from the guess. What the equations leave undetermined stays near the guess.

    Parameters
    ----------
    plant : Plant
        Continuous or discrete.
    hold : dict, optional
        State, input or parameter -> value that is kept.
    free : sequence, optional
        What is solved for: states, inputs, parameters (or names). Default: all states and inputs that are not held;
        what is neither held nor free stays at its guess.
    rates : dict, optional
        State -> rate (per second; per step for a plant that was discrete from the start) asked for instead of zero, as
        in a steady turn; ``None`` leaves the rate of that state open.
    bounds : dict, optional
        State, input or parameter -> (low, high). Default: the range of the signal.
    guess : dict, optional
        Where to begin. Default as in `OperatingPoint.at`.

    Returns
    -------
    OperatingPoint
        Its `residual` is below 1e-9 of the terms of each equation, in practice a few last bits.

    Raises
    ------
    TrimError
        If no equilibrium is found; it names the equations that are not met, and by how much.
    ModelError
        If a name is not known, is held and free, or a value is outside its range.

    Notes
    -----
    Bounded least squares with CasADi's Jacobian (Branch, Coleman, Li, SIAM J. Sci. Comput. 21, 1999), from the guess
    and then from a fixed list of other beginnings, and Newton steps of least norm at the end.

    Examples
    --------
    >>> from plantc.symbolic.plant import Plant
    >>> from plantc.symbolic.analysis import trim
    >>> tank = Plant("tank")
    >>> level = tank.state("level", unit="m", range=(0, 10))
    >>> flow = tank.input("flow", unit="m/s")
    >>> tank.dynamics({level: flow - 0.5 * level})
    >>> round(trim(tank, hold={level: 2})["flow"], 9)
    1.0
    """
    return _Trim(plant, hold or {}, free, rates or {}, bounds or {}, guess or {}).solve()


class _Equations:
    """The equations of an equilibrium in error coordinates, and their Jacobian with respect to (error, u, p)."""

    def __init__(self, plant: Plant):
        source = plant.discretisation.continuous if plant.discretisation else plant
        rates = plant.without_noise(source.dynamics_expression())
        if source.is_discrete:
            if plant.has_attitude:
                raise ModelError(
                    f"{plant.name}: an attitude needs a continuous plant, and this one is discrete; give it"
                    " an angular velocity and use discretise"
                )
            pieces = []
            for state in plant.states:
                change = rates[state.error_at] - state.symbol
                pieces.append(wrap(change) if state.signal.angle else change)
            rates = ca.vertcat(*pieces)
        start = ca.SX.sym("start", plant.x.numel())
        error = ca.SX.sym("error", plant.error_size)
        moved = plant.retract(start, error)
        values = ca.substitute(rates, plant.x, moved)
        jacobian = ca.jacobian(values, ca.vertcat(error, plant.u, plant.p))
        arguments = [start, error, plant.u, plant.p]
        self.plant = plant
        self._evaluate = ca.Function("equations", arguments, [ca.densify(values), ca.densify(jacobian)])
        self._move = ca.Function("move", [start, error], [moved])

    def evaluate(self, x: Array, error: Array, u: Array, p: Array) -> tuple[Array, Array]:
        """Return values (error_size,) and Jacobian (error_size, error_size + inputs + parameters)."""
        values, jacobian = self._evaluate.call([x, error, u, p])
        return np.asarray(values, dtype=float).ravel(), np.asarray(jacobian, dtype=float)

    def residual(self, x: Array, u: Array, p: Array) -> Array:
        """Return the values at a point."""
        return self.evaluate(x, np.zeros(self.plant.error_size), u, p)[0]

    def moved(self, x: Array, error: Array) -> Array:
        """Return the state turned by an error, quaternions of unit length."""
        return _tidied(self.plant, np.asarray(self._move(x, error), dtype=float).ravel(), wrap_angles=False)

    def magnitudes(self, jacobian: Array, x: Array, u: Array, p: Array, least: float) -> Array:
        """Return the size of the terms of each equation: the sum of |derivative| times |value|, value >= `least`."""
        parts = []
        for state in self.plant.states:
            parts.append(np.ones(3) if state.attitude else np.abs(x[state.at]))
        sizes = np.maximum(np.concatenate([*parts, np.abs(u), np.abs(p)]), least)
        return np.asarray(np.abs(jacobian) @ sizes)


class _Trim:
    """One call of `trim`: z is (error from the guess, u, p), of which the free elements are solved for."""

    def __init__(
        self,
        plant: Plant,
        hold: Values,
        free: Sequence[Symbol | str] | None,
        rates: Values,
        bounds: Values,
        guess: Values,
    ):
        self.plant, self.equations = plant, _Equations(plant)
        held = _by_name(hold)
        guesses = _everything(guess) if isinstance(guess, OperatingPoint) else _by_name(guess)
        ends = _by_name(bounds)
        states = {state.signal.name for state in plant.states}
        inputs = {symbol.signal.name for symbol in plant.inputs}
        known = states | inputs | {symbol.signal.name for symbol in plant.parameters}
        chosen = {name_of(item) for item in free} if free is not None else (states | inputs) - set(held)
        for what, names in (("hold=", held), ("free=", chosen), ("bounds=", ends), ("guess=", guesses)):
            unknown = sorted(set(names) - known)
            if unknown:
                raise ModelError(
                    f"{plant.name}: {what} names {_listed(unknown)}, neither state, input nor parameter of this plant; "
                    f"it has {_listed(sorted(known))}"
                )
        twice = sorted(chosen & set(held))
        if twice:
            raise ModelError(f"{plant.name}: {_listed(twice)} is in hold= and in free=; leave it out of one of them")
        x, u, p = _vectors(plant, {**guesses, **held}, "hold= or guess=", clip=chosen, ends=ends)
        self.x0, self.z0 = x, np.concatenate([np.zeros(plant.error_size), u, p])
        self.names: list[str] = []
        low, high, mask, seeded = [], [], [], []
        for signal, at in self._layout():
            size = 3 if at is None else signal.size
            bottom, top = (np.full(3, -np.inf), np.full(3, np.inf)) if at is None else _ends(plant, signal, ends)
            offset = x[at] if at is not None and signal.name in states else np.zeros(size)
            low += list(bottom - offset)
            high += list(top - offset)
            mask += [signal.name in chosen] * size
            seeded += [signal.name not in guesses and signal.name not in states] * size
            self.names += [signal.name if size == 1 else f"{signal.name}[{index}]" for index in range(size)]
        self.low, self.high = np.array(low), np.array(high)
        self.free, self.seeded = np.array(mask, dtype=bool), np.array(seeded, dtype=bool)
        self.target, self.asked = self._targets(rates)

    def _layout(self) -> list[tuple[Signal, slice | None]]:
        """Return the signals in the order of z; for an attitude without its place in x."""
        rows: list[tuple[Signal, slice | None]] = []
        rows += [(state.signal, None if state.attitude else state.at) for state in self.plant.states]
        return rows + [(symbol.signal, slice(0, 0)) for symbol in (*self.plant.inputs, *self.plant.parameters)]

    def _targets(self, rates: Values) -> tuple[Array, Array]:
        """Return the rates asked for, and which equations count."""
        plant = self.plant
        target, asked = np.zeros(plant.error_size), np.ones(plant.error_size, dtype=bool)
        known = {state.signal.name: state for state in plant.states}
        for name, value in _by_name(rates).items():
            if name not in known:
                raise ModelError(
                    f"{plant.name}: rates= names {name!r}, which is not a state; it has {_listed(sorted(known))}"
                )
            at = known[name].error_at
            if value is None:
                asked[at] = False
                continue
            numbers = _numbers(plant, f"the rate of {name!r}", value, at.stop - at.start)
            target[at] = numbers
        return target, asked

    def _point(self, z: Array) -> tuple[Array, Array, Array]:
        """Return (x, u, p) of z."""
        n, m = self.plant.error_size, self.plant.u.numel()
        return self.equations.moved(self.x0, z[:n]), z[n : n + m], z[n + m :]

    def _evaluate(self, z: Array) -> tuple[Array, Array]:
        n, m = self.plant.error_size, self.plant.u.numel()
        values, jacobian = self.equations.evaluate(self.x0, z[:n], z[n : n + m], z[n + m :])
        return (values - self.target)[self.asked], jacobian[self.asked]

    def _quality(self, z: Array) -> tuple[Array, Array]:
        """Return the residual, and it relative to the size of the terms of each equation."""
        values, jacobian = self._evaluate(z)
        scale = self.equations.magnitudes(jacobian, *self._point(z), 1.0) + np.abs(self.target[self.asked])
        sound = np.isfinite(scale) & np.isfinite(values) & (scale > 0)
        return values, np.divide(np.abs(values), scale, out=np.where(values == 0, 0.0, np.inf), where=sound)

    def _starts(self) -> Iterator[Array]:
        """Yield where to begin: the guess; then inputs away from zero, where u^2 has no slope; then about the guess."""
        yield self.z0
        choice = self.free & self.seeded
        low, high = np.maximum(self.low, -WIDE), np.minimum(self.high, WIDE)
        if np.any(choice):
            for offset in (1.0, 100.0, -1.0, 1e-2, 1e4, -100.0):
                yield np.where(choice, np.clip(self.z0 + offset, low, high), self.z0)
            for part in (0.5, 0.1, 0.9):
                yield np.where(choice, low + part * (high - low), self.z0)
        generator = np.random.default_rng(0)
        for spread in (0.1, 0.1, 1.0, 1.0, 1.0):
            step = spread * generator.standard_normal(self.z0.size) * np.maximum(1.0, np.abs(self.z0))
            yield np.where(self.free, np.clip(self.z0 + step, low, high), self.z0)

    def solve(self) -> OperatingPoint:
        """Try each beginning; return the first equilibrium."""
        best, lowest = self.z0, math.inf
        rows = self.equations.magnitudes(self._evaluate(self.z0)[1], *self._point(self.z0), 1.0)
        rows = np.where(np.isfinite(rows) & (rows > 0), rows, 1.0)
        for start in self._starts():
            z = self._polished(self._least_squares(start)) if np.any(self.free) else start
            relative = self._quality(z)[1]
            worst = float(np.max(relative, initial=0.0))
            if worst <= TRIM_TOLERANCE and np.all(z >= self.low) and np.all(z <= self.high):
                return self._answer(z)
            left = float(np.linalg.norm(self._evaluate(z)[0] / rows))
            if left < lowest:
                best, lowest = z, left
            if not np.any(self.free):
                break
        raise TrimError(self._complaint(best))

    def _least_squares(self, start: Array) -> Array:
        free = self.free
        values, jacobian = self._evaluate(start)
        if not np.all(np.isfinite(values)) or not np.all(np.isfinite(jacobian)):
            return start
        scale = self.equations.magnitudes(jacobian, *self._point(start), 1.0)
        scale = np.where(scale > 0, scale, 1.0)

        def full(part: Array) -> Array:
            z = start.copy()
            z[free] = part
            return z

        def residual(part: Array) -> Array:
            return np.asarray(
                np.nan_to_num(self._evaluate(full(part))[0] / scale, nan=1e100, posinf=1e100, neginf=-1e100)
            )

        def slope(part: Array) -> Array:
            return np.asarray(
                np.nan_to_num((self._evaluate(full(part))[1] / scale[:, None])[:, free], posinf=0, neginf=0)
            )

        low = np.where(self.low <= -0.999 * WIDE, -np.inf, self.low)[free]
        high = np.where(self.high >= 0.999 * WIDE, np.inf, self.high)[free]
        begin = np.clip(start[free], low, high)
        try:
            found = least_squares(
                residual,
                begin,
                jac=slope,
                bounds=(low, high),
                x_scale="jac",
                xtol=1e-15,
                ftol=1e-15,
                gtol=1e-15,
                max_nfev=200,
            )
        except (ValueError, np.linalg.LinAlgError):
            return start
        return full(np.asarray(found.x))

    def _polished(self, z: Array) -> Array:
        """Return z after Newton steps of least norm, as long as they help."""
        values, jacobian = self._evaluate(z)
        rows = self.equations.magnitudes(jacobian, *self._point(z), 1.0)
        rows = np.where(np.isfinite(rows) & (rows > 0), rows, 1.0)
        for _ in range(20):
            if not np.all(np.isfinite(jacobian)) or not np.all(np.isfinite(values)):
                break
            columns = np.maximum(1.0, np.abs(z[self.free]))
            part = (jacobian[:, self.free] / rows[:, None]) * columns
            step = columns * np.linalg.lstsq(part, values / rows, rcond=1e-12)[0]
            following = z.copy()
            following[self.free] = np.clip(z[self.free] - step, self.low[self.free], self.high[self.free])
            new_values, new_jacobian = self._evaluate(following)
            if not np.linalg.norm(new_values / rows) < np.linalg.norm(values / rows):
                break
            z, values, jacobian = following, new_values, new_jacobian
        return z

    def _answer(self, z: Array) -> OperatingPoint:
        x, u, p = self._point(z)
        x = _tidied(self.plant, x)
        residual = self.equations.residual(x, u, p) - self.target
        residual[~self.asked] = 0.0
        return OperatingPoint(self.plant, _frozen(x), _frozen(u), _frozen(p), _frozen(residual))

    def _complaint(self, z: Array) -> str:
        values, relative = self._quality(z)
        source = self.plant.discretisation.continuous if self.plant.discretisation else self.plant
        what = "change per step" if source.is_discrete else "rate"
        labels = [label for label, counts in zip(_error_labels(self.plant, text=True), self.asked) if counts]
        order = [int(index) for index in np.argsort(-relative) if relative[index] > TRIM_TOLERANCE]
        left = [f"the {what} of {labels[index]} is off by {values[index]:.3g}" for index in order[:4]]
        more = f" and {len(order) - 4} more" if len(order) > 4 else ""
        left = left or ["only values outside the bounds"]
        near = 1e-6 * np.maximum(1.0, np.abs(z))
        at_bound = self.free & ((z - self.low <= near) | (self.high - z <= near))
        absolute = self._absolute(z)
        stuck = [f"{self.names[index]} at its bound {absolute[index]:.6g}" for index in np.flatnonzero(at_bound)]
        where = f" (with {', '.join(stuck[:4])})" if stuck else ""
        advice = "free more states or inputs, widen bounds= or give another guess="
        return f"{self.plant.name}: no equilibrium was found: {_joined(left)}{more}{where}; {advice}"

    def _absolute(self, z: Array) -> Array:
        """Return z with the guess added to the error of each state that is no attitude."""
        answer = z.copy()
        for state in self.plant.states:
            if not state.attitude:
                answer[state.error_at] += self.x0[state.at]
        return answer


# -- linearisation ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SymbolicLinearisation:
    """The matrices of a `Linearisation` as sparse CasADi expressions of state, input and parameter symbols.

    Attributes
    ----------
    A, B, C, D, G, N : casadi.SX
        As in `Linearisation`; constants are folded, noises zero.
    f, h : casadi.SX
        Rates (continuous) or next state (discrete); sensors.
    x, u, p : casadi.SX
        The symbols.
    dt : casadi.SX or None
        Time step of a discrete plant: a number, or a symbol if it is an input.
    """

    A: ca.SX
    B: ca.SX
    C: ca.SX
    D: ca.SX
    G: ca.SX
    N: ca.SX
    f: ca.SX
    h: ca.SX
    x: ca.SX
    u: ca.SX
    p: ca.SX
    dt: ca.SX | None


@dataclass(frozen=True, eq=False)
class Linearisation:
    """A plant near an operating point: dx' = A dx + B du + G w, dz = C dx + D du + N v.

    Deviations dx are errors of the state, with three components for an attitude (a small rotation in the body frame).
    For a discrete plant dx' is the deviation after a step.

    Attributes
    ----------
    A : ndarray, shape (n, n)
        n is `plant.error_size`.
    B : ndarray, shape (n, inputs)
    C : ndarray, shape (outputs, n)
    D : ndarray, shape (outputs, inputs)
    G : ndarray, shape (n, elements of process noise)
        For a plant made by `discretise`, that of the continuous plant, since a density is integrated over the step.
    N : ndarray, shape (outputs, elements of sensor noise)
        For noises declared with `Plant.noise` that sensors use; a sensor's own ``variance=`` is not in it.
    states, inputs, outputs, noises, sensor_noises : tuple of str
        A label for each element: ``name``, ``name_0`` .. for a vector, ``name_e0`` .. ``name_e2`` for an attitude.
    dt : float or None
        Seconds per step; None for a continuous plant.
    point : OperatingPoint
        Where.
    symbolic : SymbolicLinearisation
        The same as sparse expressions.
    """

    plant: Plant
    point: OperatingPoint
    A: Array
    B: Array
    C: Array
    D: Array
    G: Array
    N: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    noises: tuple[str, ...]
    sensor_noises: tuple[str, ...]
    dt: float | None
    symbolic: SymbolicLinearisation

    def to_state_space(self) -> Any:
        """Return a `control.StateSpace` of the deviations, with the labels and dt (0 if continuous)."""
        import control

        return control.StateSpace(
            self.A,
            self.B,
            self.C,
            self.D,
            0 if self.dt is None else self.dt,
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
            name=self.plant.name,
            remove_useless_states=False,
        )

    def eigenvalues(self) -> Array:
        """Return the eigenvalues of A, complex (n,), by real and then imaginary part.

        A is first split into its strongly connected parts, so that chains of integrators, which rounding would
        scatter, keep their eigenvalues exactly.
        """
        values = eigenvalues_of(self.A)
        return np.asarray(values[np.lexsort((values.imag, values.real))])

    def controllability(self, *, tolerance: float = HAUTUS_TOLERANCE) -> Controllability:
        """Return which modes the inputs move; see `Controllability`."""
        return Controllability(*hautus(self.A, self.B, tolerance))

    def observability(self, *, tolerance: float = HAUTUS_TOLERANCE) -> Observability:
        """Return which modes the sensors see; see `Observability`."""
        return Observability(*hautus(self.A.T, self.C.T, tolerance))


@dataclass(frozen=True, eq=False)
class Controllability:
    """The answer of the Hautus test of (A, B).

    Attributes
    ----------
    rank : int
        Dimension of the controllable subspace.
    needed : int
        Number of components of the error of the state.
    eigenvalues : ndarray, shape (needed,)
        Of A.
    singular_values : ndarray, shape (needed,)
        For each eigenvalue the smallest singular value of [s I - A, B], scaled, s moved to where it is least: the
        relative distance from a plant in which a mode is not controllable. Zero to rounding if it is not.
    uncontrollable_eigenvalues : ndarray, shape (needed - rank,)
        Of the part of the plant that the inputs do not reach.

    Notes
    -----
    States and inputs are first scaled by powers of two that bring the nonzero entries of A and B near one another
    (least squares of their logarithms under a similarity; Curtis and Reid 1972). Then, as long as a mode is found with
    a left vector w and w* [s I - A, B] = 0, w is split off by a unitary transformation, which counts multiple
    eigenvalues right (Hautus 1969; Eising, "Between controllable and uncontrollable", Syst. Control Lett. 4, 1984).
    """

    rank: int
    needed: int
    eigenvalues: Array
    singular_values: Array
    uncontrollable_eigenvalues: Array

    @property
    def is_controllable(self) -> bool:
        """Whether the inputs move every mode."""
        return self.rank == self.needed


@dataclass(frozen=True, eq=False)
class Observability:
    """The answer of the Hautus test of (A, C): that of `Controllability` for the transposed plant.

    Attributes
    ----------
    rank, needed : int
        Dimension of the observable part, and of the whole.
    eigenvalues, singular_values : ndarray, shape (needed,)
        Eigenvalues of A and, for each, the relative distance from a plant in which a mode is not seen.
    unobservable_eigenvalues : ndarray, shape (needed - rank,)
        Of the part that the sensors do not see.
    """

    rank: int
    needed: int
    eigenvalues: Array
    singular_values: Array
    unobservable_eigenvalues: Array

    @property
    def is_observable(self) -> bool:
        """Whether the sensors see every mode."""
        return self.rank == self.needed


def linearise(plant: Plant, at: Values | None = None, *, dt: float | None = None) -> Linearisation:
    """Return the plant near an operating point.

    Parameters
    ----------
    plant : Plant
        Continuous or discrete.
    at : OperatingPoint or dict, optional
        State, input or parameter -> value; the rest as in `OperatingPoint.at`. It need not be an equilibrium.
    dt : float, optional
        Seconds per step, for a discrete plant whose dt is an input.

    Returns
    -------
    Linearisation
        Matrices as numbers, and as sparse expressions in `symbolic`.

    Raises
    ------
    ModelError
        If a name is not known, a value is outside its range, a derivative at the point is not finite, or dt is missing
        or outside its bounds.

    Examples
    --------
    >>> from plantc.symbolic.plant import Plant
    >>> from plantc.symbolic.analysis import linearise
    >>> tank = Plant("tank")
    >>> level = tank.state("level", unit="m", range=(0, 10))
    >>> flow = tank.input("flow", unit="m/s")
    >>> tank.dynamics({level: flow - 0.5 * level})
    >>> linearise(tank).eigenvalues()
    array([-0.5+0.j])
    """
    point = at if isinstance(at, OperatingPoint) and at.plant is plant else OperatingPoint.at(plant, at)
    symbolic = symbolic_linearisation(plant)
    step = _step(plant, dt)
    arguments = [symbolic.x, symbolic.u, symbolic.p]
    numbers: list[Any] = [point.x, point.u, point.p]
    if symbolic.dt is not None and not symbolic.dt.is_constant():
        arguments.append(symbolic.dt)
        numbers.append(step)
    expressions = [symbolic.A, symbolic.B, symbolic.C, symbolic.D, symbolic.G, symbolic.N]
    function = ca.Function("linearise", arguments, [ca.densify(item) for item in expressions])
    matrices = {}
    for name, expression, value in zip("ABCDGN", expressions, function.call(numbers)):
        matrix = np.asarray(value, dtype=float).reshape(expression.shape)
        if not np.all(np.isfinite(matrix)):
            row = int(np.argwhere(~np.isfinite(matrix))[0][0])
            label = _error_labels(plant, text=True)[row] if name in "ABG" else f"sensor row {row}"
            raise ModelError(
                f"{plant.name}: {name} is not finite in the row of {label} at the operating point; move the point away "
                "from where the model has no derivative"
            )
        matrices[name] = matrix
    process = plant.process_noises
    return Linearisation(
        plant,
        point,
        A=matrices["A"],
        B=matrices["B"],
        C=matrices["C"],
        D=matrices["D"],
        G=matrices["G"],
        N=matrices["N"],
        states=_error_labels(plant),
        inputs=_labels([symbol.signal for symbol in plant.inputs]),
        outputs=_labels([sensor.signal for sensor in plant.sensors]),
        noises=_labels([noise.signal for noise in process]),
        sensor_noises=_labels([noise.signal for noise in _sensor_noises(plant)]),
        dt=step,
        symbolic=symbolic,
    )


def symbolic_linearisation(plant: Plant) -> SymbolicLinearisation:
    """Return A, B, C, D, G, N of a plant as sparse expressions of its symbols."""
    x, u = plant.x, plant.u
    retraction = plant.retraction_jacobian()
    if plant.is_discrete:
        f, A = transition(plant)
        B = _lift(plant, f) @ ca.jacobian(f, u)
    else:
        f = plant.without_noise(plant.dynamics_expression())
        A = ca.jacobian(f, x) @ retraction
        for state in plant.states:
            if state.attitude:
                A[state.error_at, state.error_at] += -ca.skew(f[state.error_at])
        B = ca.jacobian(f, u)
    raw = plant.folded(ca.vertcat(ca.SX(0, 1), *[sensor.expression for sensor in plant.sensors]))
    h = plant.without_noise(raw)
    v = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in _sensor_noises(plant)])
    N = plant.without_noise(ca.jacobian(raw, v))
    return SymbolicLinearisation(
        A=ca.sparsify(A),
        B=ca.sparsify(B),
        C=ca.sparsify(ca.jacobian(h, x) @ retraction),
        D=ca.sparsify(ca.jacobian(h, u)),
        G=ca.sparsify(noise_gain(plant)),
        N=ca.sparsify(N),
        f=f,
        h=h,
        x=x,
        u=u,
        p=plant.p,
        dt=plant.dt_symbol,
    )


def _lift(plant: Plant, x: ca.SX) -> ca.SX:
    """Return d(error)/dx about a state x: for a unit quaternion 2 vec(q* dq), else the identity."""
    pieces = []
    for state, value in ((state, x[state.at]) for state in plant.states):
        if state.attitude:
            w, v = value[0], value[1:4]
            pieces.append(2 * ca.horzcat(-v, w * ca.SX.eye(3) - ca.skew(v)))
        else:
            pieces.append(ca.SX.eye(state.signal.size))
    return ca.diagcat(*pieces)


def _step(plant: Plant, dt: float | None) -> float | None:
    if isinstance(plant.dt, tuple):
        low, high = plant.dt
        if dt is None or not low <= dt <= high:
            found = "none is given" if dt is None else f"{dt:g} is given"
            raise ModelError(
                f"{plant.name}: its dt is an input ({low:g} .. {high:g} s) and {found}; give dt= within it, "
                "or linearise the continuous plant"
            )
        return float(dt)
    if dt is not None and dt != plant.dt:
        raise ModelError(f"{plant.name}: dt={dt!r} is given, but its dt is {plant.dt!r}; leave dt= out")
    return plant.dt


def _sensor_noises(plant: Plant) -> list[Any]:
    used = {noise.signal.name for sensor in plant.sensors for noise in plant.sensor_noises(sensor)}
    return [noise for noise in plant.noises if noise.signal.name in used]


# -- a plant from a linearisation -------------------------------------------------------------------------------------


def linearised_plant(plant: Plant, at: Values | None = None) -> Plant:
    """Return the plant whose dynamics and sensors are affine: those of `plant`, linearised at an operating point.

    Absolute values in and out: f(x_o, u_o) + A (x - x_o) + B (u - u_o), with the same names, units, ranges and noises.
    Its parameters are folded in at their values at the point; numbers are rounded to 12 digits, so that the last bits
    of a machine's libm do not reach the generated C.

    Parameters
    ----------
    plant : Plant
        Continuous or discrete, without attitudes.
    at : OperatingPoint or dict, optional
        State, input or parameter -> value; the rest as in `OperatingPoint.at`.

    Returns
    -------
    Plant
        Continuous if `plant` is. If `plant` was made by `discretise` and has densities, or dt is an input, its
        continuous plant is linearised and made discrete in the same way (at an equilibrium this is the same map);
        else the map over one step is linearised.

    Raises
    ------
    ModelError
        If it has an attitude, or as in `linearise`.
    """
    if plant.has_attitude:
        names = [state.signal.name for state in plant.states if state.attitude]
        raise ModelError(
            f"{plant.name}: the state {_listed(names)} is an attitude, which has no affine dynamics; use "
            "extended_kalman_filter, or linearise for the matrices of its error"
        )
    point = OperatingPoint.at(plant, at)
    made = plant.discretisation
    if made is not None and (plant.process_noises or isinstance(plant.dt, tuple)):
        linear = linearised_plant(made.continuous, point)
        if made.method in ("tustin", "exact"):
            linear = _affine(made.continuous, point, wrapped=False)
        assert plant.dt is not None
        linear = linear.discretise(made.method, dt=plant.dt, substeps=made.substeps)
    else:
        linear = _affine(plant, point, wrapped=made is None or made.method not in ("tustin", "exact"))
    return linear.step_noise(dict(plant.step_variances.items())) if plant.step_variances else linear


def _affine(plant: Plant, point: Values, *, wrapped: bool) -> Plant:
    """Return the affine plant; with `wrapped`, deviations of angles from a point that is not zero are wrapped."""
    lin = linearise(plant, point)
    where = lin.point
    linear = Plant(plant.name, dt=lin.dt, doc=plant.doc)
    dx, du, x_o = _copy_signals(plant, linear, where, wrapped)
    process = ca.vertcat(ca.SX(0, 1), *[_copy_noise(linear, noise) for noise in plant.process_noises])
    symbolic = lin.symbolic
    change = symbolic.f - symbolic.x if plant.is_discrete else symbolic.f
    arguments = [symbolic.x, symbolic.u, symbolic.p]
    numbers = [where.x, where.u, where.p]
    start = _offset(change, arguments, numbers) + (x_o if plant.is_discrete else 0.0)
    rates = ca.SX(_rounded(start)) + _sparse(lin.A) @ dx + _sparse(lin.B) @ du + _sparse(lin.G) @ process
    linear.dynamics({state.signal.name: rates[state.error_at] for state in plant.states})
    linear.dynamics_sources = dict(plant.dynamics_sources)
    noises = {noise.signal.name: _copy_noise(linear, noise) for noise in _sensor_noises(plant)}
    v = ca.vertcat(ca.SX(0, 1), *noises.values())
    readings = ca.SX(_rounded(_offset(symbolic.h, arguments, numbers)))
    readings = readings + _sparse(lin.C) @ dx + _sparse(lin.D) @ du
    gain = _sparse(lin.N)
    row = 0
    for sensor in plant.sensors:
        rows = slice(row, row + sensor.signal.size)
        row = rows.stop
        if plant.sensor_noises(sensor) and gain[rows, :].nnz() == 0 and _has_no_strength(sensor):
            raise ModelError(
                f"{plant.name}: the noise of the sensor {sensor.signal.name!r} vanishes at the point, to first "
                "order; give the sensor variance= as well, or another point"
            )
        with said_at(sensor.signal.source):
            _copy_sensor(plant, linear, where, sensor, readings[rows] + gain[rows, :] @ v)
    return linear


def _has_no_strength(sensor: Sensor) -> bool:
    return sensor.strength is None and sensor.variance_expression is None


def _copy_signals(plant: Plant, linear: Plant, where: OperatingPoint, wrapped: bool) -> tuple[ca.SX, ca.SX, Array]:
    """Declare the states and inputs of `plant` on `linear`; return their deviations, and the rounded state."""
    x_o, u_o = _rounded(where.x), _rounded(where.u)
    pieces, deviations = [], []
    for state in plant.states:
        signal = state.signal
        ends = None if signal.angle else (signal.low, signal.high)
        with said_at(signal.source):
            symbol = linear.state(
                signal.name, size=signal.size, unit=signal.unit, range=ends, angle=signal.angle, doc=signal.doc
            )
        away = symbol - x_o[state.at]
        turned = wrapped and signal.angle and bool(np.any(x_o[state.at]))
        pieces.append(wrap(away) if turned else away)
    start = 0
    for old in plant.inputs:
        signal = old.signal
        with said_at(signal.source):
            new = linear.input(
                signal.name, size=signal.size, unit=signal.unit, range=(signal.low, signal.high), doc=signal.doc
            )
        deviations.append(new - u_o[start : start + signal.size])
        start += signal.size
    return ca.vertcat(*pieces), ca.vertcat(ca.SX(0, 1), *deviations), x_o


def _copy_noise(linear: Plant, noise: Any) -> Symbol:
    strength = noise.strength if noise.full else np.diag(noise.strength)
    keyword = "density" if noise.is_density else "variance"
    signal = noise.signal
    with said_at(signal.source):
        return linear.noise(signal.name, size=signal.size, unit=signal.unit, doc=signal.doc, **{keyword: strength})


def _copy_sensor(plant: Plant, linear: Plant, where: OperatingPoint, sensor: Sensor, expression: ca.SX) -> None:
    signal = sensor.signal
    variance: Any = None
    if sensor.strength is not None:
        variance = sensor.strength if sensor.full else np.diag(sensor.strength)
    elif sensor.variance_expression is not None:
        old = plant.without_noise(plant.folded(sensor.variance_expression))
        old = ca.substitute(old, plant.p, ca.DM(_rounded(where.p))) if where.p.size else old

        def variance(z: ca.SX) -> ca.SX:
            was = ca.vertcat(plant.x, plant.u, ca.SX(sensor.measurement))
            return ca.substitute(old, was, ca.vertcat(linear.x, linear.u, ca.SX(z)))

    linear.sensor(
        signal.name,
        expression,
        variance=variance,
        unit=signal.unit,
        range=(signal.low, signal.high),
        angle=signal.angle,
        doc=sensor.doc or signal.doc,
    )


def _offset(expression: ca.SX, arguments: list[ca.SX], numbers: list[Array]) -> Array:
    """Return an expression at the point; what is rounding beside its own terms is zero."""
    everything = ca.vertcat(*arguments)
    outputs = [ca.densify(expression), ca.densify(ca.jacobian(expression, everything))]
    value, slope = ca.Function("offset", arguments, outputs).call(numbers)
    answer = np.asarray(value, dtype=float).ravel()
    terms = np.abs(np.asarray(slope, dtype=float)) @ np.abs(np.concatenate(numbers))
    return np.where(np.abs(answer) <= 1e-12 * terms.ravel(), 0.0, answer)


def _rounded(values: Array) -> Array:
    """Return numbers rounded to 12 significant digits."""
    flat = [float(f"{item:.{DIGITS - 1}e}") for item in np.asarray(values, dtype=float).ravel()]
    return np.array(flat, dtype=float).reshape(np.shape(values)) + 0.0


def _sparse(matrix: Array) -> ca.SX:
    """Return a numeric matrix as sparse SX, dust dropped, the rest rounded."""
    if matrix.size == 0:
        return ca.SX(*matrix.shape)
    kept = np.where(np.abs(matrix) < DUST * np.max(np.abs(matrix)), 0.0, matrix)
    return ca.SX(ca.sparsify(ca.DM(_rounded(kept))))


# -- the Hautus test --------------------------------------------------------------------------------------------------


def hautus(A: Array, B: Array, tolerance: float) -> tuple[int, int, Array, Array, Array]:
    """Return (rank, needed, eigenvalues, relative singular values, eigenvalues not reached) of (A, B)."""
    n = len(A)
    eigenvalues = eigenvalues_of(A)
    if n == 0:
        return 0, 0, eigenvalues, np.zeros(0), np.zeros(0, dtype=complex)
    a, b = _scaled(A, B)
    centre = np.trace(a) / n
    norm = float(np.linalg.norm(np.hstack([a - centre * np.eye(n), b]), 2))
    if norm == 0.0:
        return 0, n, eigenvalues, np.zeros(n), eigenvalues
    a, b = (a - centre * np.eye(n)).astype(complex) / norm, b.astype(complex) / norm
    starts = (eigenvalues - centre) / norm
    margins = np.array([_refined(a, b, start)[0] for start in starts])
    missing: list[complex] = []
    while len(a):
        found = [_refined(a, b, start) for start in (starts if len(missing) == 0 else eigenvalues_of(a))]
        distance, value, vector = min(found, key=lambda item: item[0])
        if distance > tolerance:
            break
        missing.append(value * norm + centre)
        basis = np.linalg.svd(vector.conj().reshape(1, -1))[2][1:].conj().T  # orthonormal complement of w
        a, b = basis.conj().T @ a @ basis, basis.conj().T @ b
    return n - len(missing), n, eigenvalues, margins, _real_if_close(np.array(missing, dtype=complex))


def _refined(a: Array, b: Array, start: complex) -> tuple[float, complex, Array]:
    """Return (least singular value of [s I - a, b], s, its left vector) for s near `start`, where it is least.

    The computed eigenvalue of a defective mode is off by a root of the rounding error; Newton's step on the singular
    value, or the Rayleigh quotient of its left vector, brings s to the mode that is not reached, if there is one.
    """

    def look(s: complex) -> tuple[float, complex, Array, Array]:
        left, values, right = np.linalg.svd(np.hstack([s * np.eye(len(a)) - a, b]), full_matrices=False)
        return float(values[-1]), s, left[:, -1], right[-1].conj()

    best = look(start)
    for _ in range(30):
        size, s, w, v = best
        if size < 1e-17:
            break
        overlap = complex(w.conj() @ v[: len(a)])
        trials = [complex(w.conj() @ a @ w)]
        if abs(overlap) > 1e-12:
            trials.append(s - size / overlap)
        following = min((look(trial) for trial in trials), key=lambda item: item[0])
        if not following[0] < 0.99 * size:
            break
        best = following
    return best[0], best[1], best[2]


def _scaled(A: Array, B: Array) -> tuple[Array, Array]:
    """Return (A, B) with states and inputs scaled by powers of two so that their entries are near one another.

    With x_i = 2^d_i x~_i and u_k = 2^s_k u~_k, d and s are the least squares solution (of least norm) of
    log2|a_ij| + d_j - d_i = c and log2|b_ik| + s_k - d_i = c over the entries off the diagonal that are not dust.
    """
    n, m = B.shape
    entries = []
    for matrix, offset in ((A, 0), (B, n)):
        size = np.abs(matrix)
        rows = np.max(size, axis=1, initial=0.0)
        columns = np.max(size, axis=0, initial=0.0)
        for i, j in zip(*np.nonzero(size > 1e-13 * np.maximum(rows[:, None], columns[None, :]))):
            if offset or i != j:
                entries.append((int(i), int(j) + offset, math.log2(size[i, j])))
    if not entries:
        return A, B
    table = np.zeros((len(entries), n + m + 1))
    for row, (i, j, _) in enumerate(entries):
        table[row, i] -= 1.0
        table[row, j] += 1.0
        table[row, -1] = -1.0
    powers = np.linalg.lstsq(table, -np.array([item[2] for item in entries]), rcond=1e-9)[0]
    power = np.round(np.clip(powers, -400, 400))
    states, inputs = 2.0 ** power[:n], 2.0 ** power[n : n + m]
    return A * states[None, :] / states[:, None], B * inputs[None, :] / states[:, None]


def eigenvalues_of(A: Array) -> Array:
    """Return the eigenvalues of A, those of each strongly connected part by themselves."""
    if len(A) == 0:
        return np.zeros(0, dtype=complex)
    count, label = connected_components(csr_matrix(A != 0), directed=True, connection="strong")
    parts = []
    for index in range(count):
        rows = np.flatnonzero(label == index)
        parts.append(np.linalg.eigvals(A[np.ix_(rows, rows)]).astype(complex))
    return np.concatenate(parts)


def _real_if_close(values: Array) -> Array:
    """Return values with imaginary parts that are rounding removed."""
    dust = np.abs(values.imag) <= 1e-9 * np.maximum(1.0, np.abs(values))
    return np.where(dust, values.real + 0j, values)


# -- values by name ---------------------------------------------------------------------------------------------------


def _by_name(values: Values) -> dict[str, Any]:
    return {name_of(key): value for key, value in values.items()}


def _everything(point: OperatingPoint) -> dict[str, Any]:
    return {**point.states, **point.inputs, **point.parameters}


def _named(signals: list[Signal], vector: Array) -> dict[str, Any]:
    answer: dict[str, Any] = {}
    start = 0
    for signal in signals:
        part = vector[start : start + signal.size]
        answer[signal.name] = float(part[0]) if signal.size == 1 else part
        start += signal.size
    return answer


def _numbers(plant: Plant, what: str, value: Any, size: int) -> Array:
    try:
        flat = np.asarray(value, dtype=float).ravel()
    except (TypeError, ValueError):
        raise ModelError(f"{plant.name}: {what} is {value!r}; give {size} number(s)") from None
    if flat.size == 1:
        flat = np.repeat(flat, size)
    if flat.size != size or not np.all(np.isfinite(flat)):
        raise ModelError(f"{plant.name}: {what} is {flat.tolist()}; give {size} finite number(s)")
    return flat


def _ends(plant: Plant, signal: Signal, ends: Mapping[str, Any]) -> tuple[Array, Array]:
    """Return the bounds of a signal: those given, else its range."""
    if signal.name not in ends:
        return np.array(signal.low), np.array(signal.high)
    try:
        low, high = ends[signal.name]
    except (TypeError, ValueError):
        raise ModelError(
            f"{plant.name}: bounds= of {signal.name!r} is {ends[signal.name]!r}; give (low, high)"
        ) from None
    bottom = np.maximum(_numbers(plant, f"the lower bound of {signal.name!r}", low, signal.size), signal.low)
    top = np.minimum(_numbers(plant, f"the upper bound of {signal.name!r}", high, signal.size), signal.high)
    if np.any(bottom >= top):
        raise ModelError(
            f"{plant.name}: bounds= of {signal.name!r} leave no room in {bottom.tolist()} .. {top.tolist()} (range "
            f"{signal.low[0]:g} .. {signal.high[0]:g}); widen them, or hold it"
        )
    return bottom, top


def _vectors(
    plant: Plant,
    given: Mapping[str, Any],
    what: str,
    clip: set[str] | None = None,
    ends: Mapping[str, Any] | None = None,
) -> tuple[Array, Array, Array]:
    """Return (x, u, p) from values by name; those of `clip` are brought within their bounds, not refused."""
    attitudes = {state.signal.name for state in plant.states if state.attitude}
    groups = (
        [state.signal for state in plant.states],
        *[[s.signal for s in g] for g in (plant.inputs, plant.parameters)],
    )
    known = {signal.name for group in groups for signal in group}
    unknown = sorted(set(given) - known)
    if unknown:
        raise ModelError(
            f"{plant.name}: {what} names {_listed(unknown)}, neither state, input nor parameter of this plant; it has "
            f"{_listed(sorted(known))}"
        )
    vectors = []
    for group in groups:
        parts: list[Array] = []
        for signal in group:
            attitude = signal.name in attitudes
            low, high = np.array(signal.low), np.array(signal.high)
            if signal.name not in given:
                default = signal.default if signal.default is not None else np.clip(0.0, low, high)
                value = np.array((1.0, 0.0, 0.0, 0.0) if attitude else default, dtype=float)
            else:
                value = _numbers(plant, f"{signal.name!r} in {what}", given[signal.name], signal.size)
            if attitude:
                length = float(np.linalg.norm(value))
                if abs(length - 1.0) > 1e-3:
                    raise ModelError(
                        f"{plant.name}: the attitude {signal.name!r} in {what} has length {length:.6g}; give a unit "
                        "quaternion (w, x, y, z)"
                    )
                value = value / length
            elif signal.angle and np.any(np.abs(value) > math.pi):
                value = value - 2 * math.pi * np.floor(value / (2 * math.pi) + 0.5)
            if clip is not None and signal.name in clip and not attitude:
                value = np.clip(value, *_ends(plant, signal, ends or {}))
            if np.any(value < low) or np.any(value > high):
                raise ModelError(
                    f"{plant.name}: {what} gives {value.tolist()} for {signal.name!r}, outside its range "
                    f"{signal.low[0]:g} .. {signal.high[0]:g}; change the value or the range"
                )
            parts.append(value)
        vectors.append(np.concatenate([np.zeros(0), *parts]))
    return vectors[0], vectors[1], vectors[2]


def _tidied(plant: Plant, x: Array, *, wrap_angles: bool = True) -> Array:
    """Return a state vector with quaternions of unit length and, if asked, angles within -pi .. pi."""
    answer = x.copy()
    for state in plant.states:
        part = answer[state.at]
        if state.attitude:
            answer[state.at] = part / np.linalg.norm(part)
        elif state.signal.angle and wrap_angles and np.any(np.abs(part) > math.pi):
            answer[state.at] = part - 2 * math.pi * np.floor(part / (2 * math.pi) + 0.5)
    return answer


def _frozen(vector: Array) -> Array:
    answer = np.array(vector, dtype=float)
    answer.setflags(write=False)
    return answer


def _labels(signals: list[Signal]) -> tuple[str, ...]:
    """Return a label for each element, no two alike."""
    answer: list[str] = []
    taken = {signal.name for signal in signals}
    for signal in signals:
        for index in range(signal.size):
            label = signal.name if signal.size == 1 else f"{signal.name}_{index}"
            while signal.size > 1 and label in taken:
                label += "_"
            taken.add(label)
            answer.append(label)
    return tuple(answer)


def _error_labels(plant: Plant, *, text: bool = False) -> tuple[str, ...]:
    """Return a label for each component of the error; with `text`, vectors read ``name[0]``."""
    answer: list[str] = []
    taken = {state.signal.name for state in plant.states}
    for state in plant.states:
        name = state.signal.name
        size = state.error_at.stop - state.error_at.start
        for index in range(size):
            if size == 1:
                label = name
            elif text:
                label = f"{name}[{index}]"
            else:
                label = f"{name}_e{index}" if state.attitude else f"{name}_{index}"
            while size > 1 and label in taken:
                label += "_"
            taken.add(label)
            answer.append(label)
    return tuple(answer)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(map(repr, names))


def _joined(items: Sequence[str]) -> str:
    return " and ".join([", ".join(items[:-1]), items[-1]]) if len(items) > 1 else items[0]
