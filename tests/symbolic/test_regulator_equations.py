"""The regulator equations against specs/output_regulation.md, sections 2, 3, 4, 6, 9, 11 and 14."""

import ast
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from plantc.symbolic import regulator_equations
from plantc.symbolic.exosystems import compose, constant, exosystem, harmonic, polynomial, superpose
from plantc.symbolic.regulator_equations import (
    LinearModel,
    RegulatorError,
    closed_loop,
    francis,
    linear_model,
    regulated,
    solvability,
    transmission_zeros,
)
from scipy.linalg import solve_discrete_are

from plantc import ModelError, Plant, linearise

T = 0.02
G, MASS, ARM, B_LIFT, D_DRAG = 9.81, 1.0, 0.24, 54.2e-6, 1.1e-6
IXX, IYY, IZZ = 8.1e-3, 8.1e-3, 14.2e-3
HOVER = np.sqrt(MASS * G / (4 * B_LIFT))
OUTPUTS = ("x", "y", "z", "yaw")


def quadrotor(E=None):
    """The linearisation at hover of section 7, continuous."""
    A, B = np.zeros((12, 12)), np.zeros((12, 4))
    for k in (0, 2, 4, 6, 8, 10):
        A[k, k + 1] = 1
    A[1, 8], A[3, 6] = G, -G
    kt = 2 * B_LIFT * HOVER
    B[5] = kt / MASS
    B[7] = kt * ARM / IXX * np.array([-1, -1, 1, 1])
    B[9] = kt * ARM / IYY * np.array([-1, 1, 1, -1])
    B[11] = 2 * D_DRAG * HOVER / IZZ * np.array([1, -1, 1, -1])
    made = linear_model(A, B, np.eye(12)[[0, 2, 4, 10]], E=E, name="quadrotor")
    labels = made.states, made.inputs, OUTPUTS, ("wind",) if E is not None else ()
    return LinearModel(made.A, made.B, made.C, made.D, made.E, made.F, None, *labels, "quadrotor")


def chains(degree, names=OUTPUTS):
    return compose([polynomial(name, degree) for name in names])


def placed(shape, entries):
    """A matrix of (row, column, value), 1-based as the paper counts."""
    matrix = np.zeros(shape)
    for i, j, value in entries:
        matrix[i - 1, j - 1] = value
    return matrix


def flat(degree):
    """The closed form of section 9, from flatness; w[i][j] is column j of chain i."""
    size = degree + 1
    Pi, Gamma = np.zeros((12, 4 * size)), np.zeros((4, 4 * size))

    def put(matrix, row, chain, j, value):
        if j <= size:
            matrix[row, chain * size + j - 1] += value

    for row, chain, j, value in (
        (0, 0, 1, 1), (1, 0, 2, 1), (2, 1, 1, 1), (3, 1, 2, 1), (4, 2, 1, 1), (5, 2, 2, 1), (6, 1, 3, -1 / G),
        (7, 1, 4, -1 / G), (8, 0, 3, 1 / G), (9, 0, 4, 1 / G), (10, 3, 1, 1), (11, 3, 2, 1),
    ):  # fmt: skip
        put(Pi, row, chain, j, value)
    signs = np.array([[-1, -1, 1, 1], [-1, 1, 1, -1], [1, -1, 1, -1]])
    b = 8 * B_LIFT * HOVER
    for k in range(4):
        put(Gamma, k, 2, 3, MASS / b)
        put(Gamma, k, 1, 5, -IXX / (b * ARM * G) * signs[0][k])
        put(Gamma, k, 0, 5, IYY / (b * ARM * G) * signs[1][k])
        put(Gamma, k, 3, 3, IZZ / (8 * D_DRAG * HOVER) * signs[2][k])
    return Pi, Gamma


def both(model, generator, bound=6e-13):
    """Solutions by both solvers, which have to agree."""
    first, second = (francis(model, generator, solver=name) for name in ("kronecker", "schur"))
    for name in ("state_map", "input_map"):
        np.testing.assert_allclose(getattr(first, name), getattr(second, name), rtol=0, atol=bound)
    assert first.rank == first.rows == second.rank
    assert max(first.residual, second.residual) < 1e-13
    return second


# -- section 9 --------------------------------------------------------------------------------------------------------


def test_the_printed_solution_of_degree_2():
    found = both(quadrotor().sampled(T, "euler"), chains(2).sampled(T, "euler"))
    assert found.rank == 192
    Pi = placed(
        (12, 12), [(1, 1, 1), (2, 2, 1), (3, 4, 1), (4, 5, 1), (5, 7, 1), (6, 8, 1), (11, 10, 1), (12, 11, 1),
                   (9, 3, 0.1019368), (7, 6, -0.1019368)],
    )  # fmt: skip
    Gamma = placed((4, 12), [(k, 9, 10.841912) for k in (1, 2, 3, 4)])
    Gamma[:, 11] = 7.5857899 * np.array([1, -1, 1, -1])
    np.testing.assert_allclose(found.state_map, Pi, atol=1e-7)
    np.testing.assert_allclose(found.input_map, Gamma, atol=1e-6)
    for mine, formula in zip((found.state_map, found.input_map), flat(2), strict=True):
        np.testing.assert_allclose(mine, formula, atol=1e-9)


def test_the_printed_solution_of_degree_6():
    """Section 14, item 5, too: S and A have all their eigenvalues, ones, in common."""
    found = both(quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler"))
    assert found.rank == 448
    for mine, formula in zip((found.state_map, found.input_map), flat(6), strict=True):
        np.testing.assert_allclose(mine, formula, atol=1e-9)
    columns = {5: 0.037300155 * np.array([-1, 1, 1, -1]), 12: 0.037300155 * np.array([1, 1, -1, -1]),
               17: 10.841912 * np.ones(4), 24: 7.5857899 * np.array([1, -1, 1, -1])}  # fmt: skip
    for column, printed in columns.items():
        np.testing.assert_allclose(found.input_map[:, column - 1], printed, atol=1e-6)
    rest = np.delete(found.input_map, [column - 1 for column in columns], axis=1)
    assert np.max(np.abs(rest)) < 1e-12
    assert [(mode.eigenvalue, mode.rank, mode.needed) for mode in found.modes] == [(1.0, 16, 16)]
    assert found.modes[0].sigma == pytest.approx(9.22e-4, rel=1e-3)  # small, and nothing is wrong
    assert found.warnings == ()
    # the unrounded speed of hover matters for the printed digits
    assert found.input_map[0, 16] == pytest.approx(10.841912, abs=5e-7)
    assert 10.841912 - MASS / (8 * B_LIFT * 212.72) > 5e-5


def test_least_singular_value_of_the_kronecker_matrix():
    found = francis(quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler"), solver="kronecker")
    n, S = 12, polynomial("x", 6).sampled(T, "euler").matrix
    plant = quadrotor().sampled(T, "euler")
    M = np.block(
        [
            [np.kron(np.eye(7), plant.A) - np.kron(S.T, np.eye(n)), np.kron(np.eye(7), plant.B)],
            [np.kron(np.eye(7), plant.C), np.kron(np.eye(7), plant.D)],
        ]
    )
    sizes = np.linalg.svd(M, compute_uv=False)
    assert sizes[-1] == pytest.approx(6.52e-4, rel=2e-3)
    assert found.singular_ratio == pytest.approx(sizes[-1] / sizes[0], rel=1e-6)


def test_euler_plant_and_euler_exosystem_have_the_continuous_solution():
    continuous = both(quadrotor(), chains(6))
    euler = both(quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler"))
    np.testing.assert_allclose(continuous.state_map, euler.state_map, atol=1e-10)
    np.testing.assert_allclose(continuous.input_map, euler.input_map, atol=1e-9)
    other = francis(quadrotor().sampled(T, "euler"), chains(6).sampled(T))
    assert np.max(np.abs(other.input_map - euler.input_map)) > 0.1


def test_exact_exosystem_on_both_plants():
    euler = both(quadrotor().sampled(T, "euler"), chains(6).sampled(T), 6e-12)
    Pi, Gamma = euler.state_map, euler.input_map
    found = [Pi[1, 2], Pi[1, 3], Pi[8, 3], Gamma[0, 5], Gamma[0, 17]]
    np.testing.assert_allclose(found, [0.01, 6.6667e-5, 0.002038736, -0.0014920062, 0.21683823], rtol=1e-5)
    exact = both(quadrotor().sampled(T), chains(6).sampled(T))
    Pi, Gamma = exact.state_map, exact.input_map
    found = [Pi[5, 17], Gamma[0, 4], Gamma[0, 5], Gamma[0, 17], Gamma[0, 18]]
    np.testing.assert_allclose(found, [-1e-4 / 3, -0.037300155, -3.7300155e-4, 0.10841912, 3.6139705e-4], rtol=1e-5)
    assert abs(Pi[1, 2]) < 1e-12


def test_the_modified_equations_of_the_high_gain_observer():
    found = both(quadrotor().sampled(T, "euler"), chains(1).sampled(T, "euler"))  # S + S_H Q of (101), (102)
    repaired = placed((12, 8), [(k, k, 1) for k in (1, 2, 3, 4, 5, 6)] + [(11, 7, 1), (12, 8, 1)])
    np.testing.assert_allclose(found.state_map, repaired, atol=3e-13)
    assert np.max(np.abs(found.input_map)) < 3e-9
    block = np.array([[-1, 1 / 50], [-50, 1.0]])
    plain = exosystem(np.kron(np.eye(4), block), np.kron(np.eye(4), [[1.0, 0]]), OUTPUTS, dt=T)
    wrong = francis(quadrotor().sampled(T, "euler"), plain)
    assert wrong.state_map[1, 0] == pytest.approx(-100, rel=1e-6)
    assert np.max(np.abs(wrong.input_map)) == pytest.approx(1.17e6, rel=5e-3)


# -- sections 2 and 3 -------------------------------------------------------------------------------------------------

ZERO = [[0, 1], [-1, -2]], [[0], [1]], [[0, 1]]  # a zero at s = 0
ZEROS = [[0, 1, 0], [0, 0, 1], [-1, -3, -3]], [[0], [0], [1]], [[1, 0, 1]]  # at +-j


def test_f1_a_zero_at_the_eigenvalue_of_a_constant():
    says = (
        r"the plant: the regulator equations have no solution: a transmission zero of the plant is an eigenvalue of the "
        r"exosystem \(at 0 the rank is 2 of 3; rank of the equations 2 of 3, relative residual 0.70710678\)"
    )
    with pytest.raises(RegulatorError, match=says):
        francis(linear_model(*ZERO), constant("y_0"))
    (mode,) = solvability(linear_model(*ZERO), constant("y_0"))
    assert (mode.rank, mode.needed) == (2, 3) and mode.distance < 1e-12
    disturbed = exosystem([[0]], [[0], [1]], ("y_0", "d_0"))
    found = francis(linear_model(*ZERO, E=[[0], [1]]), disturbed)
    np.testing.assert_allclose(found.state_map, [[0.5], [0]], atol=1e-14)
    np.testing.assert_allclose(found.input_map, [[-0.5]], atol=1e-14)
    assert found.solver == "kronecker" and found.rank == 2 and found.rows == 3
    assert any("for these references and disturbances, not for all" in item for item in found.warnings)
    with pytest.raises(ModelError, match=r"full rank at every eigenvalue \(at 0 the rank is 2 of 3\)"):
        francis(linear_model(*ZERO, E=[[0], [1]]), disturbed, solver="schur")


def test_f2_a_zero_at_the_frequency_of_a_harmonic():
    with pytest.raises(RegulatorError, match=r"at 0\+-1j the rank is 3 of 4; .* relative residual 0.57735"):
        francis(linear_model(*ZEROS), harmonic("y_0", 1.0))
    for delta, sigma, size in ((0.1, 0.0341, 15.64), (0.01, 0.003476, 142.8), (0.001, 0.000348, 1415.6)):
        found = both_loosely(linear_model(*ZEROS), harmonic("y_0", 1 + delta))
        (mode,) = found.modes
        assert mode.rank == 4 and mode.sigma == pytest.approx(sigma, rel=2e-3)
        assert mode.distance == pytest.approx(delta, rel=1e-6)
        assert np.linalg.norm(found.input_map) == pytest.approx(size, rel=5e-4)
        assert bool(found.warnings) == (delta < 0.02)


def both_loosely(model, generator):
    first, second = (francis(model, generator, solver=name) for name in ("kronecker", "schur"))
    np.testing.assert_allclose(first.input_map, second.input_map, rtol=1e-8)
    return second


def test_f3_discretisation_moves_the_zero_away_a_little():
    plant = linear_model(*ZEROS).sampled(T, "euler")
    with pytest.raises(RegulatorError, match="the rank is 3 of 4"):
        francis(plant, harmonic("y_0", 1.0).sampled(T, "euler"))
    found = francis(plant, harmonic("y_0", 1.0).sampled(T))
    (mode,) = found.modes
    assert mode.rank == 4 and mode.sigma == pytest.approx(8.54e-5, rel=2e-3)
    assert any("a transmission zero is 0.0002 from the eigenvalue" in item for item in found.warnings)


def test_more_inputs_than_references():
    plant = linear_model([[0, 1], [0, 0]], [[0, 0], [1, 2]], [[1, 0]])
    found = francis(plant, harmonic("y_0", 2.0))
    np.testing.assert_allclose(found.state_map, np.diag([1, 2]), atol=1e-14)
    np.testing.assert_allclose(found.input_map, [[-0.8, 0], [-1.6, 0]], atol=1e-14)
    assert found.rank == found.rows == 6 and np.isnan(found.modes[0].distance)
    assert found.warnings == ("2 of 8 numbers are free; the solution of least norm is taken",)
    with pytest.raises(ModelError, match=r"needs as many inputs as references \(2 and 1\)"):
        francis(plant, harmonic("y_0", 2.0), solver="schur")


def test_fewer_inputs_than_references():
    plant = linear_model([[0, 1], [0, 0]], [[0], [1]], np.eye(2))
    S = harmonic("y_0", 2.0).matrix
    found = francis(plant, exosystem(S, [[1, 0], [0, 2]], ("y_0", "y_1")))
    np.testing.assert_allclose(found.input_map, [[-4, 0]], atol=1e-13)
    assert found.residual < 1e-12
    with pytest.raises(RegulatorError, match=r"1 input\(s\) act on 2 regulated output\(s\).*residual 0.28867513"):
        francis(plant, exosystem(S, np.eye(2), ("y_0", "y_1")))


def test_a_least_squares_answer_is_never_handed_over(monkeypatch):
    """The planted fault: with the test of the residual off, F-1 hands out what does not regulate."""
    monkeypatch.setattr(regulator_equations, "SOLVABLE", np.inf)
    wrong = francis(linear_model(*ZERO), constant("y_0"))
    assert wrong.residual > 0.7


def test_a_change_of_coordinates_of_the_exosystem():
    plant, generator = quadrotor().sampled(T), chains(2).sampled(T)
    V = np.random.default_rng(3).normal(size=(12, 12))
    back = np.linalg.inv(V)
    turned = exosystem(V @ generator.matrix @ back, generator.output @ back, OUTPUTS, dt=T)
    first, second = francis(plant, generator), francis(plant, turned)
    np.testing.assert_allclose(second.state_map, first.state_map @ back, atol=1e-8)
    np.testing.assert_allclose(second.input_map, first.input_map @ back, atol=1e-7)


def test_invariance_the_error_stays_zero_for_any_gain():
    plant = quadrotor().sampled(T, "euler")
    position = superpose([harmonic("x", np.pi / 20), harmonic("x", np.pi / 20 + 0.1)])
    generator = compose([position, harmonic("y", np.pi / 20), constant("z"), constant("yaw")]).sampled(T)
    found = both(plant, generator)
    w = generator.initial({"x": [(0, 1), (0, 1)], "y": (1, 0), "z": 5})
    x, worst = found.state_map @ w, 0.0
    K = np.random.default_rng(0).normal(size=(4, 12))  # stabilises nothing
    for _ in range(200):
        worst = max(worst, np.max(np.abs(plant.C @ x - generator.output @ w)))
        x = plant.A @ x + plant.B @ (found.input_map @ w - K @ (x - found.state_map @ w))
        w = generator.matrix @ w
    assert worst < 1e-10
    assert np.linalg.norm(found.input_map) > 1e-4


# -- section 11 -------------------------------------------------------------------------------------------------------

SMALL = linear_model([[0, 1], [-1, -0.4]], [[0], [1]], [[1, 0]], E=[[0.5], [1]])


def disturbed():
    return compose([harmonic("y_0", 0.5), superpose([harmonic("d_0", 0.9), constant("d_0")])])


def small_exosystem(dt=None):
    """Section 11 weights the disturbance: Q_dis = [0, 0, 0.8, 0, 1]."""
    whole = disturbed() if dt is None else disturbed().sampled(dt)
    output = whole.output.copy()
    output[1, 2] = 0.8
    return exosystem(whole.matrix, output, whole.signals, dt=dt)


def test_disturbances_are_rejected_by_what_is_known_of_them():
    found = both(SMALL, small_exosystem())
    np.testing.assert_allclose(found.state_map, [[1, 0, 0, 0, 0], [0, 0.5, -0.4, 0, -0.5]], atol=1e-13)
    np.testing.assert_allclose(found.input_map, [[0.75, 0.2, -0.96, -0.36, -1.2]], atol=1e-13)
    discrete = both(SMALL.sampled(T, "euler"), small_exosystem(T))
    np.testing.assert_allclose(discrete.state_map[1], [-0.0024999792, 0.49999167, -0.4, 0, -0.5], atol=5e-9)
    np.testing.assert_allclose(
        discrete.input_map[0], [0.74901459, 0.19749673, -0.95676009, -0.35998056, -1.2], atol=5e-9
    )


def test_polynomial_references_and_disturbances():
    generator = compose([polynomial("y_0", 2), polynomial("d_0", 2)])
    for plant, chain in ((SMALL, generator), (SMALL.sampled(T, "euler"), generator.sampled(T, "euler"))):
        found = both(plant, chain)
        np.testing.assert_allclose(found.state_map[1], [0, 1, 0, -0.5, 0, 0], atol=1e-12)
        np.testing.assert_allclose(found.input_map[0], [1, 0.4, 1, -1.2, -0.5, 0], atol=1e-12)


def test_a_wind_that_the_quadrotor_leans_against():
    wind = quadrotor(E=np.eye(12)[:, 1:2]).sampled(T, "euler")
    found = both(wind, chains(2, (*OUTPUTS, "wind")).sampled(T, "euler"))
    expected = np.zeros((12, 3))
    expected[8, 0] = expected[9, 1] = -1 / G
    np.testing.assert_allclose(found.state_map[:, 12:], expected, atol=1e-9)
    np.testing.assert_allclose(found.input_map[:, 14], 0.037300155 * np.array([1, -1, -1, 1]), atol=1e-8)


def test_a_disturbance_that_enters_the_output_too():
    plant = linear_model([[0.5]], [[1]], [[1]], E=[[2]], F=[[3]], dt=0.1)
    found = both(plant, compose([constant("y_0"), constant("d_0")]).sampled(0.1))
    for w in np.eye(2):
        x, u = found.state_map @ w, found.input_map @ w
        np.testing.assert_allclose(0.5 * x + u + 2 * w[1], x)
        np.testing.assert_allclose(x + 3 * w[1], w[0])


# -- models by name ---------------------------------------------------------------------------------------------------


def test_a_plant_by_the_names_of_its_signals():
    """Section 14, item 8, too: the time base is said once and kept with the data."""
    cart = Plant("cart")
    position, speed = cart.state("position", unit="m"), cart.state("speed", unit="m/s")
    force, slope = cart.input("force", unit="N"), cart.input("slope", unit="rad", range=(-1, 1))
    cart.dynamics({position: speed, speed: force - 9.81 * slope - 0.1 * speed})
    cart.sensor("gps", position, unit="m", variance=1.0)
    at = linearise(cart)
    view, Q, P = regulated(at, compose([constant("slope"), polynomial("gps", 1)]))
    assert view.inputs == ("force",) and view.outputs == ("gps",) and view.disturbances == ("slope",)
    np.testing.assert_allclose(P, [[0, 0, 0], [-9.81, 0, 0]])
    np.testing.assert_array_equal(Q, [[0, 1, 0]])
    found = both(at, compose([constant("slope"), polynomial("gps", 1)]))
    np.testing.assert_allclose(found.input_map, [[9.81, 0, 0.1]], atol=1e-12)
    state = both(at.to_state_space(), compose([constant("slope"), polynomial("position", 1)]))  # a state will do
    np.testing.assert_allclose(state.input_map, found.input_map, atol=1e-12)
    sampled = linearise(cart.discretise("euler", dt=0.1))
    discrete = both(sampled, compose([constant("slope"), polynomial("gps", 1)]).sampled(0.1))
    np.testing.assert_allclose(discrete.input_map, found.input_map, atol=1e-12)
    with pytest.raises(ModelError, match=r"cart is discrete with dt = 0.1 s and the exosystem of gps is continuous"):
        francis(sampled, constant("gps"))
    with pytest.raises(ModelError, match=r"the exosystem generates altitude, neither an output nor an input"):
        francis(at, constant("altitude"))
    with pytest.raises(ModelError, match="dict is given; give linearise"):
        francis({}, constant("altitude"))


# -- section 14 -------------------------------------------------------------------------------------------------------


def test_every_edge_case_has_a_test():
    """Items of section 14 stand in the docstrings of the tests that are of them; the list is the specification's."""
    named: dict[int, list[str]] = {number: [] for number in range(1, 15)}
    for path in sorted(Path(__file__).parents[1].glob("*/test_*.py")):
        text = path.read_text()
        for node in ast.walk(ast.parse(text)) if "ection 14, item" in text else ():
            said = ast.get_docstring(node) or "" if isinstance(node, ast.FunctionDef) else ""
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                for items in re.findall(r"[Ss]ection 14, items? (\d+(?: and \d+)*)", said):
                    for number in re.findall(r"\d+", items):
                        named[int(number)].append(node.name)
    assert [number for number, tests in named.items() if not tests] == []


def test_no_exosystem_and_no_reference():
    """Section 14, items 1 and 2: r = 0 gives empty maps, m = 0 the maps of least norm."""
    plant = linear_model(*ZEROS)
    nothing = francis(plant, compose([]))
    assert nothing.state_map.shape == (3, 0) and nothing.input_map.shape == (1, 0) and nothing.residual == 0
    assert nothing.modes == ()
    only = francis(linear_model([[0, 1], [-1, -1]], [[0], [1]], np.zeros((0, 2)), E=[[1], [0]]), constant("d_0"))
    left = only.model.A @ only.state_map + only.model.B @ only.input_map + [[1], [0]]
    np.testing.assert_allclose(left, 0, atol=1e-14)
    # least norm: x2 = -1 is forced, then x1 = u - 1 has least x1^2 + u^2 at u = 1/2
    np.testing.assert_allclose(np.vstack([only.state_map, only.input_map]).ravel(), [0.5, -1, -0.5], atol=1e-14)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: linear_model(np.eye(2), np.ones((3, 1)), np.ones((1, 2))), r"B has shape \(3, 1\).*ask for 2 x any"),
        (lambda: linear_model(np.eye(2), np.ones((2, 1)), np.ones((1, 3))), r"C has shape \(1, 3\).*ask for any x 2"),
        (lambda: linear_model(np.ones((2, 3)), np.ones((2, 1)), np.ones((1, 2))), r"A has shape \(2, 3\)"),
        (lambda: linear_model(np.eye(2), np.ones((2, 1)), np.ones((1, 2)), E=[[1]]), r"E has shape \(1, 1\)"),
        (lambda: linear_model([[np.inf]], [[1]], [[1]]), "A is no matrix of finite numbers"),
        (lambda: linear_model([[1]], [[np.nan]], [[1]]), "B is no matrix of finite numbers"),
        (lambda: linear_model(*ZERO, dt=0.1).sampled(0.1), "it is discrete with dt = 0.1 s"),
        (lambda: francis(linear_model(*ZEROS), constant("y_0"), solver="cramer"), "the solver 'cramer' is not known"),
    ],
)
def test_sentences(make, says):
    """Section 14, items 3 and 4: shapes that do not match are named, and what is not finite is refused."""
    with pytest.raises(ModelError, match=says):
        make()


def test_decaying_and_growing_modes_are_said():
    """Section 14, item 7: the equations of modes that decay are valid, and following them is no achievement."""
    plant = linear_model(*ZEROS).sampled(T)
    found = francis(plant, exosystem([[0.9]], [[1]], ("y_0",), dt=T))
    assert any("the exosystem decays at 0.9" in item for item in found.warnings)
    found = francis(plant, harmonic("y_0", 3.0).sampled(T, "euler"))
    assert any("the exosystem grows at 1+-0.06j" in item for item in found.warnings)


def test_transmission_zeros():
    np.testing.assert_allclose(np.sort_complex(transmission_zeros(linear_model(*ZEROS))), [-1j, 1j], atol=1e-12)
    assert len(transmission_zeros(quadrotor())) == 0
    assert transmission_zeros(linear_model([[0]], [[1, 1]], [[1]])) is None


def test_a_gain_that_does_not_stabilise_is_refused():
    """Section 14, item 6: with the spectral radius, or the largest real part."""
    plant = quadrotor().sampled(T, "euler")
    P = solve_discrete_are(plant.A, plant.B, 100 * np.eye(12), np.eye(4))
    K = np.linalg.solve(np.eye(4) + plant.B.T @ P @ plant.B, plant.B.T @ P @ plant.A)
    assert np.max(np.abs(closed_loop(plant, K))) == pytest.approx(0.98940274, abs=5e-9)
    with pytest.raises(RegulatorError, match=r"A - B K has spectral radius 1\.\d+, not below 1\); -K would"):
        closed_loop(plant, -K)
    radius = np.max(np.abs(closed_loop(plant, -K, accept_unstable=True)))
    assert radius > 1
    with pytest.raises(RegulatorError, match="has largest real part 0, not below 0"):
        closed_loop(quadrotor(), np.zeros((4, 12)))
    with pytest.raises(ModelError, match=r"the gain has shape \(2, 12\), and B \(12, 4\)"):
        closed_loop(plant, K[:2])


def test_beyond_2000_rows_the_kronecker_matrix_is_not_formed():
    plant = quadrotor().sampled(T, "euler")
    rng = np.random.default_rng(0)
    turn = np.linalg.qr(rng.normal(size=(130, 130)))[0]
    output = rng.normal(size=(4, 130))
    dense = exosystem(0.9 * turn, output, OUTPUTS, dt=T)
    with pytest.raises(ModelError, match=r"a part with 130 exosystem states has 2080 rows, more than 2000"):
        francis(plant, dense, solver="kronecker")
    found = francis(plant, dense)
    assert found.solver == "schur" and found.residual < 1e-9
    assert found.rank == 2080


# -- what is recorded -------------------------------------------------------------------------------------------------


def test_a_wrong_solution_is_seen_in_the_record():
    found = francis(quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler"))
    good = found.properties()
    assert all(value <= limit for value, limit in good.values()), good
    wrong = found.rounded()
    wrong["input_map"] = wrong["input_map"] * (1 + 1e-5)
    assert any(value > limit for value, limit in found.properties(wrong).values())
    assert found.source() == francis(quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler")).source()
    assert found.source() != francis(quadrotor().sampled(T), chains(6).sampled(T, "euler")).source()


# -- scales -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [1e-8, 1e-10, 1e-14])
def test_a_small_reference_is_no_solution(size):
    with pytest.raises(RegulatorError, match=r"rank of the equations 2 of 3, relative residual 0\.70710678"):
        francis(linear_model(*ZERO), exosystem([[0.0]], [[size]], ["y_0"]))


def test_a_large_disturbance_hides_no_reference_that_cannot_be_followed(monkeypatch):
    plant = linear_model(*ZERO, E=[[0], [2e9]])
    signals = compose([constant("y_0"), constant("d_0")])
    with pytest.raises(RegulatorError, match=r"at 0 the rank is 2 of 3; .* relative residual 0\.70710678"):
        francis(plant, signals)
    # the planted fault: the properties of design.json see it, too
    monkeypatch.setattr(regulator_equations, "SOLVABLE", np.inf)
    ((share, limit),) = francis(plant, signals).properties().values()
    assert share > 0.1 > limit
    # and a right-hand side that is rounding is none
    monkeypatch.undo()
    assert francis(plant, exosystem(np.zeros((2, 2)), [[1e-8, 0.0], [0.0, 1.0]], ["y_0", "d_0"])).residual < 1e-9


@pytest.mark.parametrize("delta", [1e-9, 1e-12])
def test_a_solution_lost_in_rounding_is_called_that(delta):
    with pytest.raises(
        RegulatorError, match="have a solution that is too large to be computed: .* the rank is 4 of 4"
    ) as found:
        francis(linear_model(*ZEROS), harmonic("y_0", 1 + delta))
    assert "a transmission zero of the plant is an eigenvalue" not in str(found.value)


def test_a_plant_that_is_not_square_is_warned_of_by_its_least_singular_value():
    A, _, C = ZEROS
    for delta, says in ((0.1, False), (1e-3, True)):
        found = francis(linear_model(A, [[0, 0], [0, 0], [1, 2]], C), harmonic("y_0", 1 + delta))
        assert any("the rank is nearly lost" in item for item in found.warnings) == says


@pytest.mark.parametrize("unit", [1.0, 1e-15, 1e12])
def test_what_is_rounding_depends_on_no_unit(unit):
    """A disturbance counted in photons; the same maps, whatever is counted."""
    plant = linear_model([[0, 1], [0, -0.3]], [[0], [1]], [[1, 0]], E=[[0], [unit]]).sampled(T, "euler")
    found = francis(plant, compose([polynomial("y_0", 2), polynomial("d_0", 1)]).sampled(T)).rounded()
    np.testing.assert_allclose(found["input_map"][0, 3:] / unit, [-1.0, 0.0], rtol=1e-8, atol=0)
    np.testing.assert_allclose(found["state_map"], [[1, 0, 0, 0, 0], [0, 1, T / 2, 0, 0]], rtol=1e-8, atol=0)
    # another unit of the input, of which Gamma is small
    thrust = linear_model([[0, 1], [0, -0.3]], [[0], [1e14]], [[1, 0]]).sampled(T, "euler")
    maps = francis(thrust, polynomial("y_0", 2).sampled(T), solver="schur").rounded()["input_map"]
    np.testing.assert_allclose(maps * 1e14, [[0, 0.3, 1 + 0.3 * T / 2]], rtol=1e-8, atol=0)


def in_units(model, generator, decades, seed=0):
    """The same plant and references, each state, input and output in a unit of its own; and these units."""
    rng = np.random.default_rng(seed)
    x, u, y = (10.0 ** rng.uniform(-decades, decades, size) for size in (len(model.A), model.B.shape[1], len(model.C)))
    other = replace(model, A=model.A * x / x[:, None], B=model.B * u / x[:, None], C=model.C * x / y[:, None])
    return other, replace(generator, output=generator.output / y[:, None]), x, u


@pytest.mark.parametrize("decades", [3, 6])
@pytest.mark.parametrize("solver", ["schur", "kronecker"])
def test_millimetres_beside_kilometres_are_no_reason_to_refuse(monkeypatch, decades, solver):
    """Units up to 6 decades up or down, twelve from the smallest to the largest."""
    model, generator = quadrotor().sampled(T, "euler"), chains(6).sampled(T, "euler")
    other, turned, x, u = in_units(model, generator, decades)
    wanted, found = francis(model, generator), francis(other, turned, solver=solver)
    np.testing.assert_allclose(found.state_map * x[:, None], wanted.state_map, atol=1e-12)
    np.testing.assert_allclose(found.input_map * u[:, None], wanted.input_map, atol=1e-12)
    assert found.rank == 448 and found.warnings == () and [mode.rank for mode in found.modes] == [16]
    assert all(value <= limit for value, limit in found.properties().values())
    if decades > 3:  # the planted fault: as it was before rows and columns were scaled
        monkeypatch.setattr(regulator_equations, "_scales", lambda matrix: tuple(map(np.ones, matrix.shape)))
        with pytest.raises(RegulatorError, match=r"the rank is \d+ of 16"):
            francis(other, turned)


@pytest.mark.parametrize("decades", [3, 6, 9])
def test_units_hide_no_transmission_zero(decades):
    for model, generator, says in (
        (linear_model(*ZERO), constant("y_0"), "at 0 the rank is 2 of 3; rank of the equations 2 of 3"),
        (linear_model(*ZEROS), harmonic("y_0", 1.0), r"at 0\+-1j the rank is 3 of 4; rank of the equations 6 of 8"),
    ):
        for seed in range(5):
            other, turned, _, _ = in_units(model, generator, decades, seed)
            with pytest.raises(RegulatorError, match=says):
                francis(other, turned)
            np.testing.assert_allclose(
                np.sort_complex(transmission_zeros(other)), np.sort_complex(transmission_zeros(model)), atol=1e-7
            )


@pytest.mark.parametrize("size", [1.0, 1e9, 1e12])
def test_within_a_coupled_part_a_large_disturbance_hides_no_reference(monkeypatch, size):
    """The constant of F-1 that cannot be followed; the disturbance, which can be undone, drives it a little."""
    plant = linear_model(*ZERO, E=[[0], [size]])
    coupled = exosystem([[0, 1e-3], [0, 0]], np.eye(2), ["y_0", "d_0"])
    with pytest.raises(RegulatorError, match="at 0 the rank is 2 of 3; rank of the equations 5 of 6"):
        francis(plant, coupled)
    if size > 1:  # the planted fault: judged by the norm of the whole alone
        monkeypatch.setattr(regulator_equations, "worst_share", lambda *given: 0.0)
        assert francis(plant, coupled).residual < 1e-9


def test_the_solution_of_least_norm_is_that_of_the_pseudo_inverse():
    rng = np.random.default_rng(7)
    for rows, columns, rank in ((5, 9, 5), (6, 6, 4), (9, 5, 3)):
        M = rng.normal(size=(rows, rank)) @ rng.normal(size=(rank, columns)) * 10.0 ** rng.uniform(-2, 2, columns)
        right = M @ rng.normal(size=columns)
        z, found = regulator_equations._least_norm(M, right)
        assert found == rank
        np.testing.assert_allclose(z, np.linalg.pinv(M, rcond=1e-12) @ right, rtol=1e-7, atol=1e-9)


# -- cost -------------------------------------------------------------------------------------------------------------


def counted(monkeypatch, model, generator, solver):
    """Operations of the decompositions and solves that a solution takes: leading terms of Golub and Van Loan (2013)."""
    total = 0.0

    def count(module, name, cost):
        original = getattr(module, name)

        def counting(*given, **options):
            nonlocal total
            total += cost(*given, **options)
            return original(*given, **options)

        patch.setattr(module, name, counting)

    def singular(a, full_matrices=True, compute_uv=True, **_):
        large, little = max(a.shape), min(a.shape)
        return 4 * large**2 * little + 22 * little**3 if compute_uv else 4 * large * little**2

    with monkeypatch.context() as patch:
        count(regulator_equations, "lu_factor", lambda a: 2 / 3 * len(a) ** 3)
        count(regulator_equations, "lu_solve", lambda factors, b: 2 * len(b) ** 2)
        count(regulator_equations, "eigvals", lambda a, b, **_: 30 * len(a) ** 3)
        count(regulator_equations, "schur", lambda a, **_: 25 * len(a) ** 3)
        count(np.linalg, "svd", singular)
        assert francis(model, generator, solver=solver).solver == solver
    assert total > 0
    return total


def pairs(count):
    """Double integrators, coupled at random: n + m = 3 count, no transmission zero."""
    rng = np.random.default_rng(0)
    B = np.kron(np.eye(count) + 0.1 * rng.normal(size=(count, count)) / count, [[0.0], [1.0]])
    A = np.kron(np.eye(count), np.eye(2, k=1))
    return linear_model(A, B, np.kron(np.eye(count), [[1.0, 0.0]])).sampled(T, "euler")


def shares(monkeypatch, cases, solver):
    """Operations of r (n + m)^3."""
    found = []
    for model, generator in cases:
        size = len(model.A) + len(model.C)
        found.append(counted(monkeypatch, model, generator, solver) / (generator.order * size**3))
    return np.array(found)


def test_the_cost_by_columns_grows_no_faster_than_r_times_the_cube_of_n_plus_m(monkeypatch):
    """Counted, not timed: more chains for one plant, larger plants with more chains, and one longer chain."""
    more = [(pairs(16), chains(degree, [f"y_{k}" for k in range(16)]).sampled(T, "euler")) for degree in (0, 1, 3, 6)]
    larger = [(pairs(n), chains(6, [f"y_{k}" for k in range(n)]).sampled(T, "euler")) for n in (4, 8, 16, 32)]
    longer = [
        (pairs(2), compose([polynomial("y_0", degree), constant("y_1")]).sampled(T, "euler")) for degree in (3, 7, 15)
    ]
    turning = [  # an eigenvalue of its own for every pair of columns: as many factors as there can be
        (pairs(2), compose([superpose([harmonic("y_0", 0.1 * (k + 1)) for k in range(n)]), constant("y_1")]).sampled(T))
        for n in (2, 4, 8, 16)
    ]
    for cases in (more, larger, longer, turning):
        found = shares(monkeypatch, cases, "schur")
        assert np.all(np.diff(found) <= 1e-9 * found[0]), found
    # what it is compared with: the Kronecker matrix of one part costs r^3 (n + m)^3
    whole = shares(monkeypatch, longer, "kronecker")
    assert whole[-1] > 8 * whole[0]
