"""The quadrotor of Meda-Campana (IEEE Access 2018), controlled from what each of his estimators says (eqs. 43, 44).

Each controller is an estimator and the printed state feedback in one block: a reading in, rotor speeds out. The gain is
the paper's to its printed digits, which do not give the eigenvalues that the paper lists (specs/meda2018.md, erratum E15).
"""

import numpy as np
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf, sampled, set_point
from plantc.examples.quadrotor_james_stein import quadrotor_jsse, quadrotor_jssem
from plantc.symbolic import Block
from plantc.symbolic.composition import connect, wires
from plantc.symbolic.controllers import state_feedback

printed_gain = np.array(
    [
        [-25.0, 411.0, -8.9, 399.0],
        [-4.3, 333.0, 13.0, 311.0],
        [-311.0, -20.0, -322.0, -32.0],
        [-277.0, -22.0, -299.0, -37.0],
        [199.0, 200.0, 199.0, 200.0],
        [93.0, 95.0, 93.0, 95.0],
        [711.0, 59.0, 766.0, 122.0],
        [56.0, 2.9, 67.0, 14.0],
        [28.0, 844.0, 97.0, 766.0],
        [3.4, 71.0, 15.0, 58.0],
        [177.0, -188.0, 177.0, -188.0],
        [74.0, -76.0, 74.0, -76.0],
    ]
).T  # eq. 44 prints 12 x 4 (erratum E14)

feedback = state_feedback(sampled, set_point, printed_gain, name="feedback")


def controller_of(estimator: Block, law: Block, name: str) -> Block:
    """Return an estimator and a state feedback as one block; the applied rotor speeds go back one step late.

    Parameters
    ----------
    estimator : Block
        An estimator of `sampled`: inputs `rotor_1` to `rotor_4` (rad/s) and a reading, memory named like the states.
    law : Block
        What turns the twelve states into four rotor speeds, such as `feedback`.
    name : str
        Name of the composition.

    Returns
    -------
    Block
        Inputs `estimator_has_pose` and `estimator_pose` (12), output `feedback.rotor_1` to `rotor_4`: to be applied until
        the next step. The first reading is taken with the rotors at hover.
    """
    forth = wires("estimator", "feedback", sampled.states)
    back = wires("feedback", "estimator", sampled.inputs, initial=set_point)
    return connect({"estimator": estimator, "feedback": law}, {**forth, **back}, name)


quadrotor_kf_controller = controller_of(quadrotor_kf, feedback, "quadrotor_kf_controller")
quadrotor_ekf_controller = controller_of(quadrotor_ekf, feedback, "quadrotor_ekf_controller")
quadrotor_jsse_controller = controller_of(quadrotor_jsse, feedback, "quadrotor_jsse_controller")
quadrotor_jssem_controller = controller_of(quadrotor_jssem, feedback, "quadrotor_jssem_controller")
