"""Blocks of every shape, for tests of what is emitted."""

import pytest
from plantc.examples.attitude_ekf import attitude_ekf
from plantc.examples.pendulum import pendulum_ekf
from plantc.examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from plantc.symbolic import Block, Plant
from plantc.symbolic.composition import connect, delay
from plantc.symbolic.estimators import extended_kalman_filter, steady_state_kalman_filter


def low_pass(name: str) -> Block:
    block = Block(name, doc="first-order low-pass filter")
    raw = block.input("raw", unit="V", range=(-10, 10))
    weight = block.parameter("weight", 0.1, range=(0, 1))
    smooth = block.memory("smooth", initial=0.0, unit="V", range=(-10, 10))
    following = smooth + weight * (raw - smooth)
    block.entry("step", inputs=[raw], following={smooth: following}, outputs={"filtered": following})
    return block


def composition() -> Block:
    return connect(
        {"first": low_pass("low_pass"), "second": low_pass("low_pass")},
        {"first.raw": delay("second.filtered"), "second.raw": "first.filtered"},
        "two_filters",
    )


def single_state(steady: bool) -> Block:
    plant = Plant("tank", dt=0.1)
    level = plant.state("level", unit="m", range=(-5, 5))
    leak = plant.noise("leak", variance=1e-4, unit="m")
    plant.dynamics({level: 0.9 * level + leak})
    plant.sensor("gauge", level, unit="m", variance=1e-2)
    made = steady_state_kalman_filter if steady else extended_kalman_filter
    return made(plant) if steady else made(plant, initial_variance={level: 1.0})


SHAPES = {
    "pendulum": pendulum_ekf,
    "attitude": attitude_ekf,
    "quadrotor_ekf": quadrotor_ekf,
    "quadrotor_kf": quadrotor_kf,
    "low_pass": low_pass("low_pass"),
    "composition": composition(),
    "one_state": single_state(False),
    "steady_state": single_state(True),
}


@pytest.fixture(params=SHAPES)
def shape(request):
    """A block of each shape in turn."""
    return SHAPES[request.param]


@pytest.fixture(params=["pendulum", "low_pass", "composition", "one_state", "steady_state"])
def small_shape(request):
    """A small block of each shape in turn."""
    return SHAPES[request.param]


@pytest.fixture
def shape_named():
    """A function that gives the block of a name."""
    return {block.name: block for block in SHAPES.values()}.__getitem__
