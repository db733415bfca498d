"""The quadrotor of `examples/quadrotor_ekf.py` with the paper's other two estimators: James-Stein, and its modified form.

Meda-Campana (IEEE Access 2018, eqs. 20-25), in the order predict, then correct. All twelve states are measured, so that
C = Pi = I and the weights are numbers: n* = 12, c = 10. `docs/james_stein.md` says when to use them, and when not.
"""

from plantc.examples.quadrotor_ekf import sampled, set_point
from plantc.symbolic.james_stein import james_stein_estimator

quadrotor_jsse = james_stein_estimator(sampled, around=set_point)
quadrotor_jssem = james_stein_estimator(sampled, around=set_point, gamma=0.15)
