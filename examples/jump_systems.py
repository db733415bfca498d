"""The systems of the jump matrix technique (specs/jump_matrix.md, section 5), by the name of what each does.

All are sampled every 0.01 s and measure x1. The strength of a process noise is said as the variance sigma_w^2 of its value held
over a step, `HELD * sigma_w^2` as a density; that of the reading is sigma_v^2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
from plantc.symbolic import Block, Plant
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.controllers import state_feedback
from plantc.symbolic.jump_matrix import JumpModel, jump_matrix_estimator, jump_model
from plantc.symbolic.piecewise import saturated

T = 0.01
HELD = T
"""A density that is held over a step has the variance density / T: this times a variance is its density."""


@dataclass(frozen=True, eq=False)
class JumpSystem:
    """A system, where it starts, and how its state is fed back, if it is.

    Attributes
    ----------
    model : JumpModel
        By the jump matrix technique.
    start : dict
        x_0, u_0 by name, nonlinearities included.
    gain : tuple of float
        F of u = r - F xh; empty where nothing is fed back.
    reference : float
        r.
    """

    model: JumpModel
    start: dict[str, float]
    gain: tuple[float, ...] = ()
    reference: float = 0.0

    @property
    def plant(self) -> Plant:
        """The discrete plant."""
        return self.model.plant


def _clipped(value: ca.SX) -> ca.SX:
    return saturated(value, -1.0, 1.0)


# -- chapter III: without control -------------------------------------------------------------------------------------


def spring(h: float = 1.0, noise: float = 1.0, reading: float = 4.0) -> JumpSystem:
    """Nonlinear spring x'' + 0.1 x' + 2 x + h x^3 = w: soft for h < 0, hard for h > 0 (sec. 5.1)."""
    plant = Plant("spring", doc="nonlinear spring with a mass")
    x1 = plant.state("x1", unit="m", range=(-50, 50), doc="position")
    x2 = plant.state("x2", unit="m/s", range=(-500, 500), doc="velocity")
    mu = plant.constant("mu", 0.1, unit="1/s", doc="damping")
    stiffness = plant.constant("w0_squared", 2.0, unit="1/s^2")
    hardening = plant.constant("h", h, unit="1/(m^2 s^2)")
    w = plant.noise("w", density=HELD * noise, unit="m/s^2", doc="force on the mass")
    cubic = x1**3
    plant.dynamics({x1: x2, x2: -stiffness * x1 - mu * x2 - hardening * cubic + w})
    plant.sensor("z", x1, variance=reading, unit="m", range=(-200, 200))
    model = jump_model(plant, {"cubic": cubic}, T, units={"cubic": "m^3"}, ranges={"cubic": (-1.25e5, 1.25e5)})
    return JumpSystem(model, model.point({x1: 1.5}))


def van_der_pol(eps: float = 2.0, noise: float = 10.0, reading: float = 25.0) -> JumpSystem:
    """Van der Pol's oscillator x'' - eps (1 - x^2) x' + 9 x = w (sec. 5.2); held, it is stable for |x| < sqrt(1 + 2 / (eps T))."""
    plant = Plant("van_der_pol", doc="oscillator of van der Pol")
    x1 = plant.state("x1", range=(-50, 50))
    x2 = plant.state("x2", unit="1/s", range=(-5000, 5000))
    excitation = plant.constant("eps", eps, unit="1/s")
    w = plant.noise("w", density=HELD * noise, unit="1/s^2")
    braking = x1**2 * x2
    plant.dynamics({x1: x2, x2: excitation * x2 - excitation * braking - 9 * x1 + w})
    plant.sensor("z", x1, variance=reading, range=(-500, 500))
    model = jump_model(plant, {"braking": braking}, T, units={"braking": "1/s"}, ranges={"braking": (-1.25e7, 1.25e7)})
    return JumpSystem(model, model.point({x1: 5.0}))


def relay(slope: float = 10.0, noise: float = 0.1, reading: float = 1.0) -> JumpSystem:
    """Unity feedback of 1 / (s (s + 1)) by a saturating amplifier, the noise in front of the amplifier (sec. 5.3)."""
    plant = Plant("relay", doc="relay control, the noise in front of the amplifier")
    x1 = plant.state("x1", range=(-1e3, 1e3), doc="position")
    x2 = plant.state("x2", unit="1/s", range=(-1e3, 1e3), doc="velocity")
    steepness = plant.parameter("slope", slope, range=(1e-3, 1e4), doc="of the amplifier where it does not saturate")
    w = plant.noise("w", density=HELD * noise)
    amplified = _clipped(steepness * (1.0 - x1 + w))
    plant.dynamics({x1: x2, x2: -x2 + amplified})
    plant.sensor("z", x1, variance=reading, range=(-1e3, 1e3))
    model = jump_model(plant, {"amplified": amplified}, T, ranges={"amplified": (-1e3, 1e3)})
    return JumpSystem(model, model.point())


def modified_relay(slope: float = 10.0, noise: float = 0.1, reading: float = 1.0) -> JumpSystem:
    """The same without noise; the noise enters the second of the two first-order filters (sec. 5.4)."""
    plant = Plant("modified_relay", doc="relay control, the noise behind the amplifier")
    x1 = plant.state("x1", range=(-1e3, 1e3), doc="position")
    x2 = plant.state("x2", range=(-1e3, 1e3), doc="amplified error, integrated")
    steepness = plant.parameter("slope", slope, range=(1e-3, 1e4), doc="of the amplifier where it does not saturate")
    w = plant.noise("w", density=HELD * noise)
    amplified = _clipped(steepness * (1.0 - x1))
    plant.dynamics({x1: -x1 + x2 + w, x2: amplified})
    plant.sensor("z", x1, variance=reading, range=(-1e3, 1e3))
    model = jump_model(plant, {"amplified": amplified}, T, ranges={"amplified": (-1e3, 1e3)})
    return JumpSystem(model, model.point())


# -- chapter IV: control by the estimated state, u = r - F xh held for a step -----------------------------------------


def linear_amplifier(noise: float = 0.1, reading: float = 0.01) -> JumpSystem:
    """Two first-order filters with a linear amplifier of gain 10 between them; closed, 10 / (s^2 + 4 s + 8) (sec. 5.5)."""
    plant = Plant("linear_amplifier", doc="a filter behind a linear amplifier behind an integrator")
    x1, x2 = plant.state("x1", range=(-1e3, 1e3)), plant.state("x2", range=(-1e3, 1e3))
    u = plant.input("u", range=(-1e4, 1e4))
    w = plant.noise("w", density=HELD * noise)
    plant.dynamics({x1: -x1 + 10 * x2, x2: u + w})
    plant.sensor("z", x1, variance=reading, range=(-1e3, 1e3))
    model = jump_model(plant, {}, T)
    return _controlled(model, {}, (0.5, 3.0), 1.0)


def saturating_amplifier(noise: float = 0.1, reading: float = 0.01) -> JumpSystem:
    """The same with an amplifier that saturates at 1; the nonlinearity stands in the middle of x (sec. 5.5)."""
    plant = Plant("saturating_amplifier", doc="a filter behind a saturating amplifier behind an integrator")
    x1, x3 = plant.state("x1", range=(-1e3, 1e3)), plant.state("x3", range=(-1e3, 1e3))
    u = plant.input("u", range=(-1e4, 1e4))
    w = plant.noise("w", density=HELD * noise)
    amplified = _clipped(10 * x3)
    plant.dynamics({x1: -x1 + amplified, x3: u + w})
    plant.sensor("z", x1, variance=reading, range=(-1e3, 1e3))
    model = jump_model(
        plant, {"amplified": amplified}, T, order=[x1, "amplified", x3], ranges={"amplified": (-1e3, 1e3)}
    )
    return _controlled(model, {}, (0.5, 0.0, 3.0), 1.0)


def controlled_spring(noise: float = 1.0, reading: float = 4.0) -> JumpSystem:
    """The hard spring whose linear force and damping are the feedback u = -(2 xh1 + 0.1 xh2) (sec. 5.5)."""
    return _spring_in_the_loop("controlled_spring", False, noise, reading)


def saturated_spring(noise: float = 1.0, reading: float = 4.0) -> JumpSystem:
    """The same with a cubic force that saturates at |x1| = 1 (sec. 5.5)."""
    return _spring_in_the_loop("saturated_spring", True, noise, reading)


def _spring_in_the_loop(name: str, saturated: bool, noise: float, reading: float) -> JumpSystem:
    plant = Plant(name, doc="cubic spring, the rest of its force by feedback of the estimate")
    x1 = plant.state("x1", unit="m", range=(-50, 50), doc="position")
    x2 = plant.state("x2", unit="m/s", range=(-500, 500), doc="velocity")
    u = plant.input("u", unit="m/s^2", range=(-1e4, 1e4))
    w = plant.noise("w", density=HELD * noise, unit="m/s^2", doc="force on the mass")
    force = (_clipped(x1) if saturated else x1) ** 3
    plant.dynamics({x1: x2, x2: u - force + w})
    plant.sensor("z", x1, variance=reading, unit="m", range=(-200, 200))
    model = jump_model(plant, {"force": force}, T, units={"force": "m/s^2"}, ranges={"force": (-1.25e5, 1.25e5)})
    return _controlled(model, {x1: 1.5}, (2.0, 0.1, 0.0), 0.0)


def _controlled(model: JumpModel, at: dict[object, float], gain: tuple[float, ...], r: float) -> JumpSystem:
    start = model.point(at)
    x = [start[state.signal.name] for state in model.plant.states]
    start["u"] = r - sum(f * value for f, value in zip(gain, x, strict=True))
    return JumpSystem(model, start, gain, r)


def controller(system: JumpSystem, estimator: Block, name: str = "") -> Block:
    """Return an estimator and the feedback of its estimate, u = r - F xh, held for a step and known to the estimator."""
    plant = system.plant
    feedback = state_feedback(plant, {"u": system.reference}, [list(system.gain)])
    return connect(
        {"estimator": estimator, "feedback": feedback},
        wires("estimator", "feedback", plant.states)
        | wires("feedback", "estimator", plant.inputs, initial=system.start),
        name or f"{plant.name}_controller",
    )


SYSTEMS: dict[str, Callable[..., JumpSystem]] = {
    make.__name__: make
    for make in (
        spring,
        van_der_pol,
        relay,
        modified_relay,
        linear_amplifier,
        saturating_amplifier,
        controlled_spring,
        saturated_spring,
    )
}


def _estimator(system: JumpSystem, variance: float = 1.0) -> Block:
    return jump_matrix_estimator(system.model, initial_variance=variance, around=system.start)


spring_estimator = _estimator(spring())
van_der_pol_estimator = _estimator(van_der_pol())
relay_estimator = _estimator(relay())
modified_relay_estimator = _estimator(modified_relay())
saturating_controller = controller(_saturating := saturating_amplifier(), _estimator(_saturating))
