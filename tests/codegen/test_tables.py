"""Tables and other piecewise functions in the C: against NumPy, in both precisions, for anything that is looked up."""

import dataclasses
import re

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen.bounds import source_loops
from plantc.codegen.crosscheck import ON_KINKS, CrossCheck, cross_check, make_probes, make_views
from plantc.codegen.emit import emit
from plantc.codegen.emulator import TargetView
from plantc.codegen.on_target import free_trace, run_on_target
from plantc.codegen.proof import prove
from plantc.codegen.rounding import bound_rounding
from plantc.codegen.tables import Table
from plantc.codegen.targets import TARGETS
from plantc.codegen.views import InterpretView, NativeView
from plantc.symbolic import ModelError, Plant, fmax, fmin, sqrt
from plantc.symbolic.piecewise import dead_zone, look_up, maximum, minimum, relay, saturated
from plantc.symbolic.signals import Status

from plantc import Block, extended_kalman_filter

AT, OF = [-5.0, -1.0, 0.0, 0.5, 2.0, 6.0], [-9.0, -1.0, 0.0, 0.25, 2.0, 11.0]
EVEN_AT, EVEN_OF = np.linspace(-8, 8, 9), np.sin(np.linspace(-2, 2, 9))
PRECISIONS = ("double", "float")


def servo():
    """A user's own block: everything that is piecewise, and the derivatives of what has any."""
    block = Block("servo", doc="piecewise functions and their derivatives")
    x = block.input("x", range=(-20, 20))
    y = block.input("y", range=(-20, 20))
    limit = block.parameter("limit", 2.0, range=(1, 5))
    last = block.memory("last", range=(-20, 20))
    made = {
        "held": saturated(x, -limit, limit),
        "dead": dead_zone(x, -1, 1),
        "switched": relay(x, 3, at_zero=1),
        "least": minimum(x, y),
        "most": maximum(x, y),
        "drag": look_up(x, AT, OF),
        "ramp": look_up(x, EVEN_AT, EVEN_OF),
    }
    slopes = {f"{name}_slope": ca.jacobian(value, ca.SX(x)) for name, value in made.items()}
    block.entry("step", inputs=[x, y], following={last: 0.5 * last + 0.5 * made["held"]}, outputs={**made, **slopes})
    return block


SERVO = servo()


def cart():
    """A filter whose dynamics and sensor saturate, and that looks up a drag and a ramp."""
    plant = Plant("cart")
    position = plant.state("position", unit="m", range=(-20, 20))
    speed = plant.state("speed", unit="m/s", range=(-10, 10))
    voltage = plant.input("voltage", unit="V", range=(-24, 24))
    gust = plant.noise("gust", density=0.01, unit="m/s^2")
    force = saturated(0.5 * voltage, -3, 3) - look_up(speed, AT, OF) - look_up(position, EVEN_AT, EVEN_OF)
    plant.dynamics({position: speed, speed: force + gust})
    plant.sensor("gps", saturated(position, -10, 10), unit="m", variance=0.04)
    return extended_kalman_filter(plant.discretise("euler", dt=0.02), initial_variance={position: 1, speed: 1})


CART = cart()


def looked_up(at, of, name="table"):
    block = Block(name)
    x = block.input("x", range=(-1e4, 1e4))
    block.entry("step", inputs=[x], following={}, outputs={"y": look_up(x, at, of)})
    return block


@pytest.fixture(scope="module", params=PRECISIONS)
def answers(request):
    """A function that asks the C and the program in Python: (x, y) -> outputs of both, and the status."""
    precision = request.param
    native, interpret = NativeView(SERVO, precision), InterpretView(SERVO)

    def ask(x, y):
        found = []
        for view in (native, interpret):
            given_ = native.inputs("step", {"x": x, "y": y})
            inputs = view.inputs("step", {name: given_[name] for name in ("x", "y")})
            answer = view.call("step", view.init(), inputs, view.params())
            found.append(answer.outputs)
        return (*found, native.precision.dtype)

    return ask


def near(first, second, real):
    for name in first.dtype.names:
        a, b = float(first[name]), float(second[name])
        assert a == pytest.approx(b, rel=30 * float(np.finfo(real).eps), abs=30 * float(np.finfo(real).eps)), name


@given(x=st.floats(-20, 20, width=32), y=st.floats(-20, 20, width=32))
def test_the_c_is_the_program(answers, x, y):
    native, interpret, real = answers(x, y)
    near(native, interpret, real)
    assert float(native["drag"]) == pytest.approx(np.interp(x, AT, OF), rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("towards", [-np.inf, None, np.inf])
def test_on_a_kink_and_beside_it(answers, towards):
    for x in sorted({*AT, *EVEN_AT, -2.0, 2.0, 1.0, -1.0, 0.0}):
        beside = x if towards is None else float(np.nextafter(np.float32(x), np.float32(towards)))
        native, interpret, real = answers(beside, x)
        near(native, interpret, real)
        if towards is None and x in AT:
            assert float(native["drag"]) == float(real(OF[AT.index(x)]))


@pytest.mark.parametrize("precision", PRECISIONS)
@given(data=st.data())
def test_any_table_is_that_of_numpy(precision, data):
    count = data.draw(st.integers(2, 40))
    even = data.draw(st.booleans())
    seed = data.draw(st.integers(0, 1000))
    rng = np.random.default_rng(seed)
    at = (
        np.linspace(-3, 1 + count, count)
        if even
        else np.sort(rng.choice(np.arange(-999, 999), count, replace=False)) / 8
    )
    of = rng.normal(size=count)
    table = Table(tuple(at), tuple(of))
    assert (table.per_unit > 0) == (even or count == 2)
    view = _view(at, of, precision)
    info = np.finfo(view.precision.dtype)
    for x in [*at, *rng.uniform(at[0] - 3, at[-1] + 3, 20), 9e3, -9e3]:
        given_ = view.inputs("step", {"x": x})
        found = float(view.call("step", view.memory(), given_, view.params()).outputs["y"])
        wanted = np.interp(float(given_["x"]), at, of)
        assert abs(found - wanted) <= table.rounding(float(info.epsneg)) + 4 * np.finfo(float).eps * np.max(np.abs(of))


def _view(at, of, precision):
    return NativeView(looked_up(at, of), precision)


def root(value):
    block = Block("hidden")
    x = block.input("x", range=(-1, 1))
    y = block.memory("y", range=(-9, 9))
    block.entry("step", inputs=[x], following={y: value(sqrt(x))}, outputs={})
    return block


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize(
    "value",
    [
        lambda v: saturated(v, -1, 1), lambda v: dead_zone(v, -1, 1), lambda v: look_up(v, [0, 1], [3, 4]),
        lambda v: look_up(v, [0, 1, 5], [3, 3, 3]), lambda v: minimum(v, 1), lambda v: maximum(0, v), relay,
    ],
)  # fmt: skip
def test_what_is_no_number_reaches_the_judgement(precision, value):
    block = root(value)
    for view in (NativeView(block, precision), InterpretView(block)):
        call = [view.call("step", view.memory(), view.inputs("step", {"x": x}), view.params()) for x in (-1.0, 0.25)]
        assert [item.status for item in call] == [Status.OVERFLOW, Status.OK]


@pytest.mark.parametrize("precision", PRECISIONS)
def test_fmin_and_fmax_hide_it_from_the_judgement(precision):
    block = root(lambda v: fmin(fmax(v, -1), 1))
    for view in (NativeView(block, precision), InterpretView(block)):
        answer = view.call("step", view.memory(), view.inputs("step", {"x": -1.0}), view.params())
        assert (answer.status, float(answer.memory["y"])) == (Status.OK, -1.0)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("block", [SERVO, CART], ids=lambda block: block.name)
def test_all_views_agree(precision, block):
    check = cross_check(block, precision, steps=40)
    assert check.passed, [str(item.mismatch) for item in check.failures]


FAULTS = {
    "the slope on a breakpoint is that of one side": ("slope = 0.5{f} * (before + slope);", "slope = before;"),
    "the slope on a limit is that inside": ("? 0.5{f} : 0.0{f}", "? 1.0{f} : 0.0{f}"),
    "a table off by one": ("points_1, 5U, x)", "points_1, 4U, x)"),
    "a search that stops too early": ("(x >= points[next].at)", "(x > points[next].at)"),
    "a wrong value in a table": ("{2.0{f}, 2.0{f}, 2.25{f}}", "{2.0{f}, 2.5{f}, 2.25{f}}"),
    "a wrong slope in a table": ("{2.0{f}, 2.0{f}, 2.25{f}}", "{2.0{f}, 2.0{f}, 1.25{f}}"),
    "limits exchanged": ("? (-1.0{f}) : x", "? 1.0{f} : x"),
}


def with_fault(block, precision, fault):
    right, wrong = (item.replace("{f}", "f" * (precision == "float")) for item in FAULTS[fault])
    text = emit(block, precision)
    assert right in text.source, "the fault was not planted"
    native = NativeView(block, precision, text=dataclasses.replace(text, source=text.source.replace(right, wrong)))
    return cross_check(block, precision, views=make_views(block, precision, native), steps=20)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_caught(precision, fault):
    assert not with_fault(SERVO, precision, fault).passed


@pytest.mark.parametrize("fault", list(FAULTS)[:4])
def test_a_fault_in_a_filter_is_caught_in_double(fault):
    """In single precision only beyond the filter's float_bound, in sigma."""
    check = with_fault(CART, "double", fault)
    mismatch = next(item for item in check.failures if item.name == "native = interpret").mismatch
    assert "limit" not in fault or mismatch.trace == "kinks"


def test_the_same_table_is_there_once_and_every_loop_is_bounded():
    source = emit(CART, "float").source
    assert re.findall(r"static const cart_ekf_point_t (\w+)\[(\d+)\]", source) == [
        ("cart_ekf_points_1", "6"), ("cart_ekf_points_2", "9")
    ]  # fmt: skip
    assert all(loop.trips is not None for loop in source_loops(source))
    assert "fmin" not in source
    assert "fmax" not in source


def test_a_table_that_one_function_uses_stands_in_it():
    source = emit(looked_up(AT, OF), "double").source
    assert "\n    static const table_point_t table_points_1[6] =" in source


def test_breakpoints_that_single_precision_does_not_tell_apart_are_refused():
    block = looked_up([1.0, 1.0 + 1e-9, 2.0], [0.0, 1.0, 2.0])
    assert emit(block, "double")
    with pytest.raises(ModelError, match="the breakpoints 1.0 and 1.000000001 of a table are one number in float"):
        emit(block, "float")


@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_rounding_of_a_look_up_has_a_bound(needs, precision):
    needs("gappa")
    rng = np.random.default_rng(3)
    block = Block("table")
    x = block.input("x", range=(-9, 9))
    block.entry("step", inputs=[x], following={}, outputs={"y": look_up(0.3 * x, AT, OF)})
    (bound,) = [item for item in bound_rounding(block, precision) if item.name == "y"]
    view = NativeView(block, precision)
    worst = 0.0
    for x_value in rng.uniform(-9, 9, 300):
        inputs = view.inputs("step", {"x": x_value})
        found = float(view.call("step", view.memory(), inputs, view.params()).outputs["y"])
        worst = max(worst, abs(found - np.interp(0.3 * float(inputs["x"]), AT, OF)))
    assert bound.error is not None, bound.reason
    assert worst <= bound.error <= 2e3 * np.finfo(view.precision.dtype).eps
    assert worst > 0.0 or precision == "double"
    assert (bound.low, bound.high) == pytest.approx((np.interp(-2.7, AT, OF), 11.0), abs=7.0)


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
def test_no_index_leaves_its_table_whatever_is_looked_up(needs, precision):
    needs("frama-c")
    block = Block("table")
    x = block.input("x", range=(-9, 9))
    y = block.memory("y", range=(-99, 99))
    looked = look_up(sqrt(x) / x, AT, OF) + look_up(1 / x, EVEN_AT, EVEN_OF)
    slope = ca.jacobian(look_up(y, AT, OF) + look_up(y, EVEN_AT, EVEN_OF), ca.SX(y))
    block.entry("step", inputs=[x], following={y: looked}, outputs={"slope": slope})
    text = emit(block, precision)
    found = prove(block, text)
    assert all(item.passed for item in found.checks), [item.note for item in found.checks]
    broken = dataclasses.replace(text, source=text.source.replace("(next <= last) && ", ""))
    assert broken.source != text.source
    assert not all(item.passed for item in prove(block, broken).checks)


@pytest.mark.slow
@pytest.mark.parametrize("target", ["cortex-m4", "cortex-m7", "rv32"])
def test_every_target_gives_the_same_bits(needs, target):
    needs(f"{TARGETS[target].prefix}gcc", TARGETS[target].emulator)
    native = NativeView(SERVO, "float")
    probes = make_probes(SERVO, "float", make_views(SERVO, "float", native), 40, 0)
    assert any(probe.trace == ON_KINKS for probe in probes)
    for probe in probes:
        probe.answer = native.call(probe.entry, probe.memory, probe.inputs, probe.params)
    view = TargetView(SERVO, "float", TARGETS[target])
    found = run_on_target(view, native, CrossCheck([], {}, probes), native.run(free_trace(SERVO, 100)))
    assert all(item.passed for item in found.checks[:2]), [str(item.mismatch) for item in found.checks]
