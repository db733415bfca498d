"""The quadrotor with six sensors, positions and angles: a filter that keeps its covariance as factors U D U'.

In single precision a sharp sensor after a vague beginning is where a covariance stops being one; its factors stay positive
(Bierman 1977). `plantc export --tables` measures that, see `plantc.examples.conditioning`.
"""

import casadi as ca
from plantc.examples.quadrotor_ekf import hover, quadrotor
from plantc.symbolic import Plant, Table, vertcat
from plantc.symbolic.estimators import extended_kalman_filter

quadrotor6 = Plant("quadrotor6", doc="quadrotor of Meda-Campana 2018 of which positions and angles are measured")
states = []
for item in quadrotor.states:
    signal = item.signal
    states.append(
        quadrotor6.state(signal.name, unit=signal.unit, range=(signal.low[0], signal.high[0]), doc=signal.doc)
    )
rotors = [
    quadrotor6.input(f"rotor_{k}", unit="rad/s", range=(-1000, 1000), doc=f"speed of rotor {k}") for k in (1, 2, 3, 4)
]
rates = ca.substitute(
    quadrotor.dynamics_expression(), vertcat(quadrotor.x, quadrotor.u), vertcat(*states, *rotors)
)  # the same equations, of these symbols
quadrotor6.dynamics({state: rates[i] for i, state in enumerate(states)})
quadrotor6.sensor("pose", vertcat(*states[0::2]), variance=0.1**2, doc="x, y, z, roll, pitch, yaw")

sampled6 = quadrotor6.discretise("euler", dt=1 / 40).step_noise({state: 1e-6 for state in states})

quadrotor_ud = extended_kalman_filter(
    sampled6,
    initial_variance={state: 0.01 / 3 for state in states},
    around={states[4]: 30.0, **{rotor: hover for rotor in rotors}},
    form="ud",
    name="quadrotor_ud",
)


def conditioning() -> Table:
    """Return how long this filter in single precision keeps its covariance, beside other forms (takes a minute)."""
    from plantc.examples.conditioning import table

    return table()


quadrotor_ud.tables["Conditioning"] = conditioning
