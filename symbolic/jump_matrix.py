"""The jump matrix technique: hold each nonlinearity over the step, discretise the rest exactly, jump at the sample.

A plant whose rates are affine once each named memoryless subexpression n_i = phi_i(s) is held becomes, with x = (s, n),
the discrete plant x+ = J(Phi x + Gam u + Psi w): linear over the step, and a jump J that sets n to phi(s) at its end. It is
simulated, and estimated by a Kalman filter whose covariance passes the jump by a matrix a: with a = dJ/dx that is the extended
Kalman filter of the discrete plant. Source: specs/jump_matrix.md, a thesis rebuilt; sec. and eq. below are the spec's.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..reference.jump_matrix import SMALLEST_DIFFERENCE, Choice, ErrorStep, JumpMap
from ..reference.model import CarriedModel
from .affinity import kink_in
from .block import Block
from .components import matrix_of
from .errors import ModelError, expect
from .estimators import Carried, CovarianceStep, filter_of
from .exponentials import held_exponential
from .expressions import equation_text, numpy_callable
from .names import name_of
from .origins import place_of_call
from .plant import HIGHEST_VARIANCE, Noise, Plant, Sensor, State, Symbol
from .signals import Signal
from .simulated import simulated_plant
from .subexpressions import Subexpressions

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JumpModel:
    """A plant by the jump matrix technique; made by `jump_model`.

    The state x has the plant's states and, at the places `clamped`, the held nonlinearities. u are the plant's inputs and w
    its process noises, both held over the step.

    Attributes
    ----------
    plant : Plant
        The discrete plant x+ = J(Phi x + Gam u + Psi w). It has the sensors of the continuous one; the strength of a
        noise is a variance per step, density / dt, of the value that is held.
    continuous : Plant
        What it was made of.
    clamps : tuple of str
        The nonlinearities, each after those it depends on.
    clamped : tuple of int
        Where each of them is in x.
    A, B, L : array (N, N), (N, m), (N, q)
        Of the continuous linear part x' = A x + B u + L w; rows of nonlinearities are zero.
    Phi, Gam, Psi : array (N, N), (N, m), (N, q)
        Of the exact step; rows of nonlinearities are those of the unit matrix, and zero.
    projection : casadi.SX (N, 1)
        The state before the jump, Phi x + Gam u + Psi w, and what a constant in the rates adds over a step.
    J, DJ : casadi.SX (N, 1), (N, N)
        The jump as an expression of plant.x, plant.u, plant.p and the noises, and its derivative by x at noise zero. The old
        values of nonlinearities do not occur, so that J(J(x)) = J(x).
    noise_gain : casadi.SX (N, q)
        dJ/dw at noise zero: of the noises that stand inside nonlinearities.
    rates : casadi.SX (N, 1)
        A x + B u + L w and a constant, which may depend on parameters.
    """

    plant: Plant
    continuous: Plant
    clamps: tuple[str, ...]
    clamped: tuple[int, ...]
    A: Array
    B: Array
    L: Array
    Phi: Array
    Gam: Array
    Psi: Array
    projection: ca.SX
    J: ca.SX
    DJ: ca.SX
    noise_gain: ca.SX
    rates: ca.SX

    @property
    def truth(self) -> Plant:
        """The discrete plant with a sensor ``true_<nonlinearity>`` without noise for each: the truth of an online gain."""
        truth = copy.copy(self.plant)
        truth._books = replace(self.plant._books, sensors=list(self.plant.sensors))
        truth._owners = dict(self.plant._owners)
        for state in self._clamp_states():
            said = state.signal
            signal = Signal(f"true_{said.name}", said.size, said.unit, said.low, said.high, f"true {said.name}")
            symbol = truth._own(Symbol(signal))
            truth._books.sensors.append(Sensor(signal, ca.SX(state.symbol), symbol, None, False, None, signal.doc))
        return truth

    @property
    def one_step(self) -> Plant:
        """The same map for the plant's own states: s+ = Phi_ss s + Phi_sn phi(s) + Gam_s u + Psi_s w (sec. 8).

        From a state whose nonlinearities fit it moves as `plant` does, but that an input or noise inside a nonlinearity is that
        of the start of the step. Its extended Kalman filter linearises phi at the corrected estimate, not at the projected one.
        """
        plant = copy.copy(self.plant)
        names = {state.signal.name for state in self._clamp_states()}
        kept, start = [], 0
        for state in self.plant.states:
            if state.signal.name not in names:
                at = slice(start, start + state.signal.size)
                kept.append(replace(state, at=at, error_at=at))
                start = at.stop
        plant._books = replace(self.plant._books, states=kept)
        plant.independent = None
        plant.step_variances = {key: value for key, value in self.plant.step_variances.items() if key not in names}
        following = ca.substitute(self.projection, self.plant.x, self.J)
        places = {state.signal.name: state.at for state in self.plant.states}
        plant._dynamics = {state.signal.name: following[places[state.signal.name]] for state in kept}
        return plant

    def point(self, values: Mapping[Any, Any] | None = None) -> dict[str, Any]:
        """Return a point of the discrete plant: state or input (or its name) -> value, nonlinearities at their values there.

        Parameters
        ----------
        values : dict, optional
            State, input or nonlinearity (or its name) -> value. What is left out is zero, or the end of the range nearest to
            it; a nonlinearity that is left out follows from the states, at the default parameters and without noise.
        """
        from .analysis import OperatingPoint

        plant = self.plant
        given = {name_of(key): value for key, value in (values or {}).items()}
        at = OperatingPoint.at(plant, given)
        jump = ca.Function("jump", [plant.x, plant.u, plant.p], [plant.without_noise(self.J)])
        after = np.array(jump(at.x, at.u, at.p), dtype=float).ravel()
        answer = {**at.states, **at.inputs}
        for state in self._clamp_states():
            if state.signal.name not in given:
                value = after[state.at]
                answer[state.signal.name] = float(value[0]) if state.signal.size == 1 else value
        return answer

    def closed_transition(self, gain: Any) -> Array:
        """Return Phi - Gam F, (N, N), of the feedback u = r - F x: for `covariance_transition` (sec. 5.5).

        Parameters
        ----------
        gain : array (m, N)
            F.
        """
        F = matrix_of(self.plant.name, "the gain", gain)
        if F.shape != (self.B.shape[1], len(self.Phi)):
            raise ModelError(
                f"{self.plant.name}: the gain has shape {F.shape}; give one row for each of the {self.B.shape[1]} inputs, and one "
                f"column for each of the {len(self.Phi)} states, nonlinearities included"
            )
        answer = self.Phi.copy()
        for k in range(F.shape[0]):  # not by a matrix product, whose last bits depend on the machine
            answer -= np.outer(self.Gam[:, k], F[k])
        return answer

    def _clamp_states(self) -> list[State]:
        return [state for state in self.plant.states if state.signal.name in self.clamps]


def jump_model(
    plant: Plant,
    nonlinearities: Mapping[str, Any],
    dt: float,
    *,
    order: Sequence[Any] | None = None,
    units: Mapping[str, str] | None = None,
    ranges: Mapping[str, tuple[Any, Any]] | None = None,
) -> JumpModel:
    """Return the discrete plant of the jump matrix technique.

    Parameters
    ----------
    plant : Plant
        Continuous.
    nonlinearities : dict
        Name -> the memoryless subexpression of the dynamics that is held over the step, a scalar or a column vector. It may
        depend on states, inputs, parameters, noises, and on other nonlinearities that are part of it. An input or noise inside
        it is taken at the end of the step, and moves the rest from the next step on: one step of dead time. For a controlled
        loop take `JumpModel.one_step`, in which it acts at once.
    dt : float
        Seconds per step.
    order : sequence of str or Symbol, optional
        States and nonlinearities in the order in which they are to stand in x; default the states, then the nonlinearities.
    units, ranges : dict, optional
        Nonlinearity -> its unit; (low, high), outside which a call is refused. Default no unit, and -1e6 .. 1e6.

    Returns
    -------
    JumpModel

    Raises
    ------
    ModelError
        If the plant is discrete or has an attitude; if a subexpression does not occur; if the rest is not affine in states, inputs
        and noises, or a coefficient of it depends on a parameter; if a noise stands inside a nonlinearity and outside of it.
    """
    expect(plant, Plant, "jump_model: the plant", "a continuous Plant")
    expect(
        order if order is not None else (), (list, tuple), f"{plant.name}: order", "a list of states and nonlinearities"
    )
    for what, table in (("units", units), ("ranges", ranges)):
        expect(table or {}, Mapping, f"{plant.name}: {what}", "a dictionary by the names of the nonlinearities")
    return _Construction(plant, nonlinearities, dt, order, units or {}, ranges or {}).build()


class _Construction:
    """Finds the nonlinearities, checks the rest, and makes the discrete plant."""

    def __init__(
        self,
        plant: Plant,
        nonlinearities: Mapping[str, Any],
        dt: float,
        order: Sequence[Any] | None,
        units: Mapping[str, str],
        ranges: Mapping[str, tuple[Any, Any]],
    ):
        if not isinstance(nonlinearities, Mapping):
            raise ModelError(
                f"{plant.name}: the nonlinearities are given as {type(nonlinearities).__name__}; give a dictionary, name -> "
                "subexpression"
            )
        if plant.is_discrete:
            raise ModelError(
                f"{plant.name}: the jump matrix technique discretises a plant itself, and this one is discrete; give it the "
                "continuous plant"
            )
        if plant.has_attitude:
            raise ModelError(
                f"{plant.name}: an attitude is not affine between two jumps; use discretise('rk4', dt=...) instead"
            )
        if isinstance(dt, bool) or not isinstance(dt, (int, float)) or not np.isfinite(dt) or dt <= 0:
            raise ModelError(f"{plant.name}: dt is {dt!r}; give the seconds per step as a positive number")
        for what, table in (("units", units), ("ranges", ranges)):
            unknown = sorted(set(table) - set(nonlinearities))
            if unknown:
                raise ModelError(f"{plant.name}: {what}= names {unknown[0]!r}, which is no nonlinearity")
        self.original, self.dt = plant, float(dt)
        self.plant = copy.copy(plant)
        self.plant._owners = dict(plant._owners)
        self.phis: dict[str, ca.SX] = {}
        clamps: list[State] = []
        for name, value in nonlinearities.items():
            phi = plant._checked(f"the nonlinearity {name!r}", value)
            self.phis[name] = ca.reshape(phi, phi.numel(), 1)
            if not ca.symvar(phi):
                raise ModelError(f"{plant.name}: the nonlinearity {name!r} is the constant {phi}; leave it out")
            signal = self.plant._signal(
                "nonlinearity", name, phi.numel(), units.get(name, ""), ranges.get(name), (-1e6, 1e6), "", False
            )
            text = "; ".join(equation_text(self.phis[name], plant.symbol_names(), 200))
            symbol = self.plant._own(Symbol(replace(signal, doc=f"held nonlinearity {text}")))
            clamps.append(State(symbol.signal, symbol, False, slice(0), slice(0)))
        self.clamps = clamps
        self._arrange(order)
        self._find()

    def _arrange(self, order: Sequence[Any] | None) -> None:
        """Give each state its place in x."""
        states = {state.signal.name: state for state in (*self.original.states, *self.clamps)}
        names = [name_of(item) for item in order] if order is not None else list(states)
        if sorted(names) != sorted(states):
            raise ModelError(
                f"{self.original.name}: order= is {names}; give each state and nonlinearity once: {', '.join(states)}"
            )
        placed, start = [], 0
        for name in names:
            at = slice(start, start + states[name].signal.size)
            placed.append(replace(states[name], at=at, error_at=at))
            start = at.stop
        self.size = start
        self.states = {state.signal.name: state for state in placed}
        self.plant._books = replace(self.original._books, states=placed)

    def _find(self) -> None:
        """Replace the subexpressions by symbols, in the rates and in each other."""
        plant = self.original
        rates = plant.dynamics_expression(fold=False)
        symbols = [symbol for symbol, _ in plant.symbol_names()]
        table = Subexpressions(symbols, [rates, *self.phis.values()])
        held = {
            table.node(1 + k, i): (name, i)
            for k, (name, phi) in enumerate(self.phis.items())
            for i in range(phi.numel())
        }
        count = sum(phi.numel() for phi in self.phis.values())
        if len(held) < count:
            raise ModelError(f"{plant.name}: two nonlinearities are the same expression; name it once")
        values = {node: ca.SX(self.states[name].symbol)[i] for node, (name, i) in held.items()}
        self.rates = table.rebuilt(0, values)
        # phi by the symbols of others that are part of it
        self.partial = {name: table.rebuilt(1 + k, values, inside=True) for k, name in enumerate(self.phis)}
        everything = ca.vertcat(self.rates, *self.partial.values())
        for name in self.phis:
            symbol = self.states[name].symbol
            if any(not ca.depends_on(everything, symbol[i]) for i in range(symbol.numel())):
                text = "; ".join(equation_text(self.phis[name], plant.symbol_names(), 200))
                raise ModelError(
                    f"{plant.name}: the nonlinearity {name!r} = {text} does not occur in the dynamics as it is written there; "
                    "write the dynamics with the same expression"
                )
        names: list[str] = []
        while len(names) < len(self.phis):
            for name, phi in self.partial.items():
                waiting = [other for other in self.phis if other not in (*names, name)]
                if name not in names and not any(ca.depends_on(phi, self.states[other].symbol) for other in waiting):
                    names.append(name)
        self.names = tuple(names)

    # -- the affine rest ----------------------------------------------------------------------------------------------

    def _parts(self) -> tuple[Array, Array, Array, ca.SX, ca.SX]:
        """Return A, B, L, the rates (N, 1) with the nonlinearities held, and what of them is constant."""
        plant, original = self.plant, self.original
        full = ca.SX.zeros(self.size)
        for state in original.states:
            full[self.states[state.signal.name].at] = self.rates[state.error_at]
        rates = original.folded(full)
        noises = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in self._process_noises()])
        moving = ca.vertcat(plant.x, plant.u, noises)
        jacobian = ca.sparsify(ca.jacobian(rates, moving))
        self._refuse_coefficients(jacobian, moving)
        self._refuse_kinks(rates, moving)
        numbers = np.array(ca.DM(ca.evalf(ca.densify(jacobian))), dtype=float).reshape(self.size, moving.numel())
        constant = ca.substitute(rates, moving, ca.DM.zeros(moving.numel()))
        n, m = self.size, plant.u.numel()
        return numbers[:, :n], numbers[:, n : n + m], numbers[:, n + m :], rates, constant

    def _refuse_coefficients(self, jacobian: ca.SX, moving: ca.SX) -> None:
        plant = self.original
        rows = [name for state in self.plant.states for name in [state.signal.name] * state.signal.size]
        names = [*self.plant.symbol_names()]
        for i, j in zip(jacobian.sparsity().row(), jacobian.sparsity().get_col(), strict=True):
            item = jacobian[i, j]
            if item.is_constant():
                continue
            text, by = equation_text(item, names, 200)[0], moving[j].name()
            if ca.depends_on(item, moving):
                named = f" besides {', '.join(self.phis)}" if self.phis else ""
                raise ModelError(
                    f"{plant.name}: the dynamics of {rows[i]!r} are not affine{named}: their derivative by {by!r} is {text}; name "
                    "that nonlinear subexpression too"
                )
            raise ModelError(
                f"{plant.name}: the coefficient {text} of {by!r} in the dynamics of {rows[i]!r} depends on a run-time parameter, "
                "and the exact step is computed at export; make it a constant, or name the product as a nonlinearity"
            )

    def _refuse_kinks(self, rates: ca.SX, moving: ca.SX) -> None:
        """Refuse what jumps or has a kink: its derivative may be zero, and it would be held at its value at zero."""
        rows = [name for state in self.plant.states for name in [state.signal.name] * state.signal.size]
        for i in range(self.size):
            found = kink_in(rates[i], moving)
            if found:
                named = f" besides {', '.join(self.phis)}" if self.phis else ""
                raise ModelError(
                    f"{self.original.name}: the dynamics of {rows[i]!r} are not affine{named}: they hold {found}, which has a jump "
                    "or a kink; name that nonlinear subexpression too"
                )

    def _process_noises(self) -> list[Noise]:
        """Return the noises of the dynamics, with what they are per step."""
        plant = self.original
        made = []
        inside = ca.vertcat(*self.phis.values()) if self.phis else ca.SX(0, 1)
        for noise in plant.process_noises:
            name = noise.signal.name
            if ca.depends_on(inside, noise.symbol) and ca.depends_on(self.rates, noise.symbol):
                raise ModelError(
                    f"{plant.name}: the noise {name!r} stands inside a nonlinearity, which takes it at the end of the step, and "
                    "outside, where it is held over the step; use two noises"
                )
            strength = np.array([[float(f"{item:.15g}") for item in row] for row in noise.strength / self.dt])
            if np.max(np.diag(strength)) > HIGHEST_VARIANCE:
                raise ModelError(
                    f"{plant.name}: the density of the noise {name!r} over dt is the variance {np.max(np.diag(strength)):g} of its "
                    f"value held over the step, above {HIGHEST_VARIANCE:g}; rescale the signal, or take a longer step"
                )
            made.append(replace(noise, is_density=False, strength=strength))
        return made

    # -- assembly -----------------------------------------------------------------------------------------------------

    def build(self) -> JumpModel:
        """Make the discrete plant."""
        plant, original = self.plant, self.original
        A, B, L, rates, constant = self._parts()
        n, m = self.size, B.shape[1]
        drifting = [i for i in range(n) if not constant[i].is_zero()]
        held = np.eye(n)[:, drifting]
        Phi, driven = held_exponential(A, np.hstack([B, L, held]), self.dt)
        if not (np.all(np.isfinite(Phi)) and np.all(np.isfinite(driven))):
            raise ModelError(
                f"{original.name}: over dt = {self.dt:g} s the linear part grows beyond all numbers; take a shorter step"
            )
        Gam, Psi = driven[:, :m], driven[:, m : m + L.shape[1]]
        drift = _sparse(driven[:, m + L.shape[1] :]) @ constant[drifting] if drifting else ca.SX(n, 1)
        jump = ca.SX(plant.x)
        for name in self.names:
            jump[self.states[name].at] = self.phis[name]
        noises = self._process_noises()
        self._settle(noises)
        folded = original.folded(jump)
        stacked = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in noises])
        projection = _sparse(Phi) @ plant.x + _sparse(Gam) @ plant.u + _sparse(Psi) @ stacked + drift
        model = JumpModel(
            plant,
            original,
            self.names,
            tuple(i for name in self.names for i in range(*self.states[name].at.indices(n))),
            A, B, L, Phi, Gam, Psi, projection, folded,
            plant.without_noise(ca.jacobian(folded, plant.x)),
            plant.without_noise(ca.jacobian(folded, stacked)),
            rates,
        )  # fmt: skip
        following = ca.substitute(jump, plant.x, projection)
        plant._dynamics = {name: following[state.at] for name, state in self.states.items()}
        plant.independent = _independent(model)
        return model

    def _settle(self, noises: list[Noise]) -> None:
        """Make the copy a discrete plant."""
        plant, original = self.plant, self.original
        converted = {noise.signal.name: noise for noise in noises}
        plant.dt, plant.dt_symbol, plant.step_variances = self.dt, ca.SX(self.dt), {}
        plant._books = replace(
            plant._books, noises=[converted.get(noise.signal.name, noise) for noise in original.noises]
        )
        said = place_of_call()
        plant.dynamics_sources = {**original.dynamics_sources, **dict.fromkeys(self.names, said)}
        plant._dynamics = {name: ca.SX(state.symbol) for name, state in self.states.items()}


def jump_simulation(
    model: JumpModel, *, around: Mapping[Any, Any] | None = None, name: str | None = None, doc: str = ""
) -> Block:
    """Return the plant by the jump matrix technique as a Block, every noise an input (sec. 2).

    Without noise it is ETD1, the first-order exponential integrator (exponential Euler): the nonlinearities are held over a step.

    Parameters
    ----------
    model : JumpModel
        What `jump_model` gave.
    around : dict, optional
        State or input -> nominal value: default of the initial state, and where the test traces stay. Nonlinearities that are
        left out follow from it.
    name, doc : str, optional
        Of the block; default name ``<plant>_jump_simulation``.

    Returns
    -------
    Block
        As `simulated_plant` gives it: entries `init` and `step`.
    """
    plant = _checked(model).plant
    title = doc or f'The plant "{plant.name}" by the jump matrix technique, simulated: every noise is an input'
    title_name = name or f"{plant.name}_jump_simulation"
    block = simulated_plant(plant, around=model.point(around), name=title_name, doc=title)
    block.notes.append(_integrator(model))
    return block


def jump_matrix_estimator(
    model: JumpModel,
    a: Choice = "jacobian",
    *,
    initial_variance: Mapping[Any, Any] | float,
    covariance_transition: Any = None,
    around: Mapping[Any, Any] | None = None,
    name: str | None = None,
    doc: str = "",
    **options: Any,
) -> Block:
    """Return the estimator of the jump matrix technique (sec. 3).

    With ``a="jacobian"`` it is the extended Kalman filter of the discrete plant x+ = J(Phi x + Gam u + Psi w), and estimates as
    well as the usual extended Kalman filter of the plant does (sec. 8): take it where the exact linear part is what you want.

    Parameters
    ----------
    model : JumpModel
        What `jump_model` gave.
    a : {"jacobian", "identity", "online"}
        By what the covariance passes the jump, M = a (Phi P Phi' + Psi Q Psi') a' + G Q G' with G = dJ/dw: the derivative of the
        jump at the projected estimate; the unit matrix, which makes the gain that of a linear Kalman filter; the ratios
        (J(x-) - J(xh-)) / (x- - xh-) of true to estimated differences (eq. 2.30). The last reads the true nonlinearities by inputs
        ``true_<nonlinearity>``, and so is for simulation only: an export refuses it.
    initial_variance : dict or float
        State or nonlinearity (or its name) -> variance of its initial error, or one number for all.
    covariance_transition : array (N, N), optional
        In M in place of Phi; ``model.closed_transition(F)`` is that of a feedback u = r - F xh (sec. 5.5).
    around : dict, optional
        State or input -> nominal value: default of the initial estimate, and where the test traces stay. Nonlinearities that are
        left out follow from it.
    name, doc : str, optional
        Default name ``<plant>_jump_estimator``.
    **options
        As for `extended_kalman_filter`. The default `form` is "joseph", since the jump makes P singular; and by default a
        variance has no floor if it is of a nonlinearity, which is known exactly where it saturates, or starts at zero. With
        ``form="ud"`` all have a floor, and none may start at zero.

    Returns
    -------
    Block
        As `extended_kalman_filter` gives it: entries `init`, `predict`, one ``update_<sensor>`` each, `step`, `inflate`.

    Raises
    ------
    ModelError
        If a choice is not known, `covariance_transition` has another shape, or as by `extended_kalman_filter`.
    """
    plant = _checked(model).plant
    if a not in get_args(Choice):
        raise ModelError(f"{plant.name}: a is {a!r}; take one of {', '.join(map(repr, get_args(Choice)))}")
    if not isinstance(initial_variance, Mapping):
        initial_variance = {state.signal.name: initial_variance for state in plant.states}
    # the jump makes P singular, and Joseph's form takes that well
    if options.setdefault("form", "joseph") != "ud":
        # on a saturated branch, or by a zero of the online gain, the variance of a nonlinearity is exactly zero
        known = [name_of(key) for key, value in initial_variance.items() if np.any(np.asarray(value) == 0)]
        options.setdefault("variance_floor", dict.fromkeys((*model.clamps, *known), 0.0))
    title = doc or f'Estimator of the plant "{plant.name}" by the jump matrix technique'
    step = None if a == "jacobian" and covariance_transition is None else _error_step(model, a, covariance_transition)
    block = filter_of(
        plant,
        step,
        initial_variance=initial_variance,
        around=model.point(around),
        name=name or f"{plant.name}_jump_estimator",
        doc=title,
        **options,
    )
    block.notes += [_integrator(model), _NOTES[a]]
    if covariance_transition is not None:
        block.notes.append("The covariance is propagated by a transition matrix that was given, not by Phi.")
    if a == "online":
        block.simulation_only = _ONLY_SIMULATED
    return block


_ONLY_SIMULATED = (
    "its online gain needs the true nonlinearities, which only a simulation knows; take a='jacobian' or a='identity'"
)
_NOTES: dict[str, str] = {
    "jacobian": "The covariance passes the jump by its derivative at the projected estimate.",
    "identity": "The covariance passes the jump by the unit matrix.",
    "online": "The covariance passes the jump by ratios of true to estimated differences: for simulation only.",
}


def _integrator(model: JumpModel) -> str:
    if not model.clamps:
        return "The step is exact."
    return f"{', '.join(model.clamps)} held over the step, the rest exact: a first-order exponential integrator."


def _checked(model: Any) -> JumpModel:
    """Return a jump model; refuse anything else."""
    if not isinstance(model, JumpModel):
        raise ModelError(
            f"a {type(model).__name__} is given where a jump model is needed; give what jump_model(plant, {{name: subexpression}}, "
            "dt) returns"
        )
    return model


def _error_step(model: JumpModel, a: Choice, transition: Any) -> CovarianceStep:
    """Return F = a Phi and G = a Psi + dJ/dw, as expressions and for the oracle."""
    plant, n = model.plant, len(model.Phi)
    given = None
    if transition is not None:
        given = matrix_of(plant.name, "covariance_transition", transition)
        if given.shape != (n, n):
            raise ModelError(
                f"{plant.name}: covariance_transition has shape {given.shape}; give finite numbers, {n} x {n}, in the order "
                f"{', '.join(state.signal.name for state in plant.states)}"
            )
    projection = plant.without_noise(model.projection)
    at = [model.DJ, model.noise_gain]
    DJ, inside = (ca.substitute(item, plant.x, projection) for item in at)
    carried: list[Carried] = []
    if a == "identity":
        matrix = ca.SX.eye(n)
    elif a == "jacobian":
        matrix = DJ
    else:
        clamps = sorted(model._clamp_states(), key=lambda state: model.clamps.index(state.signal.name))
        carried = [_true_value(state) for state in clamps]
        matrix = _online(model, projection, carried)
    F = ca.sparsify(matrix @ _sparse(model.Phi if given is None else given))
    G = ca.sparsify(matrix @ _sparse(model.Psi) + inside)
    return CovarianceStep(F, G, tuple(carried), _reference(model, a, given, carried))


def _independent(model: JumpModel) -> JumpMap:
    """Return the step for the oracle, of the continuous rates and of the jump."""
    plant = model.plant
    noises = ca.vertcat(ca.SX(0, 1), *[noise.symbol for noise in plant.process_noises])
    x, u, p = plant.x, plant.u, plant.p
    rates, jump = (
        numpy_callable(ca.Function(what, [x, u, p, noises], [ca.densify(value)]))
        for what, value in (("rates", model.rates), ("jump", model.J))
    )
    defaults = np.array([item for symbol in plant.parameters for item in symbol.signal.default or ()], dtype=float)
    sizes = (len(model.Phi), u.numel(), noises.numel())
    return JumpMap(rates, jump, sizes, defaults, float(plant.dt))  # type: ignore[arg-type]


def _true_value(state: State) -> Carried:
    """Return the input that is the true value of a nonlinearity, and the field that keeps it for the next sample."""
    said = state.signal
    signal = Signal(f"true_{said.name}", said.size, said.unit, said.low, said.high, f"true {said.name} at the sample")
    return Carried(Symbol(signal), Symbol(replace(signal, doc=f"true {said.name} at the last sample")), state)


def _online(model: JumpModel, projection: ca.SX, carried: Sequence[Carried]) -> ca.SX:
    """Return diag(a_ii) (eq. 2.30); a difference of at most 1e-12 makes the element zero."""
    plant = model.plant
    jumped = ca.substitute(plant.without_noise(model.J), plant.x, projection)
    diagonal = ca.SX.ones(len(model.Phi))
    now = ca.vertcat(ca.SX(0, 1), *[ca.SX(item.now) for item in carried])
    before = ca.vertcat(ca.SX(0, 1), *[ca.SX(item.before) for item in carried])
    for k, i in enumerate(model.clamped):
        difference = before[k] - projection[i]
        large = ca.fabs(difference) > SMALLEST_DIFFERENCE
        ratio = (now[k] - jumped[i]) / ca.if_else(large, difference, 1.0)
        diagonal[i] = ca.if_else(large, ratio, 0.0)
    return ca.diag(diagonal)


def _reference(model: JumpModel, a: Choice, transition: Array | None, carried: Sequence[Carried]) -> Any:
    """Return what propagates the covariance of the oracle, and what it reads beside the state."""
    plant = model.plant
    names = tuple(item.now.signal.name for item in carried)
    told = []
    for name, signal in zip(names, (item.state.signal for item in carried), strict=True):
        told.append(CarriedModel(name, signal.size, np.array(signal.low), np.array(signal.high), signal.name))
    return ErrorStep(plant.independent, model.clamped, a, transition, names), tuple(told)


def _sparse(matrix: Array) -> ca.SX:
    if not matrix.size:
        return ca.SX(*matrix.shape)
    return ca.SX(ca.sparsify(ca.DM(matrix)))
