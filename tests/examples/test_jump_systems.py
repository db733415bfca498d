"""The systems of the jump matrix technique beside the goldens of specs/jump_matrix.md, section 6: compiled, and by hand in NumPy."""

import numpy as np
import pytest
from plantc.examples import jump_systems
from plantc.reference.jump_matrix import JumpEstimator, JumpSystem, discrete_parts, simulate
from plantc.simulation import Start, channels, closed_loop, draw, monte_carlo, replay
from plantc.simulation.closed_loop import simulate as run_loop
from scipy.linalg import solve_discrete_are

from plantc import NativeView, ReferenceView, jump_matrix_estimator, jump_simulation

STEPS = 20


def clip(value):
    return min(max(value, -1.0), 1.0)


def by_hand(name, q, r):
    """Return a system of section 5 as it is printed there, in NumPy, and x_0."""
    third, none = np.array([[0.0], [1.0], [0.0]]), np.zeros((3, 0))
    first = np.array([1.0, 0.0, 0.0])
    if name == "spring":
        A = [[0, 1, 0], [-2, -0.1, -1], [0, 0, 0]]
        jump = lambda x, w: np.array([x[0], x[1], x[0] ** 3])  # noqa: E731
        row = lambda x: [3 * x[0] ** 2, 0, 0]  # noqa: E731
        x0 = [1.5, 0.0, 1.5**3]
    else:
        A = [[0, 1, 0], [-9, 2, -2], [0, 0, 0]]
        jump = lambda x, w: np.array([x[0], x[1], x[0] ** 2 * x[1]])  # noqa: E731
        row = lambda x: [2 * x[0] * x[1], x[0] ** 2, 0]  # noqa: E731
        x0 = [5.0, 0.0, 0.0]

    def derivative(x):
        return np.array([[1, 0, 0], [0, 1, 0], row(x)], dtype=float)

    system = JumpSystem(
        np.array(A, dtype=float), none, third, 0.01, (2,), jump, derivative, lambda x: np.zeros((3, 1)), first, np.array([[q]]), r
    )  # fmt: skip
    return system, np.array(x0)


def noises(q, r, steps=STEPS):
    """Return w_0 .. and v_1 ..: the deterministic input of section 6."""
    k = np.arange(steps)
    w = np.sqrt(2 * q) * np.sin(1.7 * k + 0.3)
    v = np.sqrt(2 * r) * np.cos(2.3 * (k + 1) + 0.1)
    return w, v


GOLDENS = [
    (
        "spring", (1, 4), "jacobian",
        (1.318178919, -1.054382167, 2.278454371), (0.03709780859, -0.0256784841, 0.2096620127),
    ),
    ("spring", (1, 4), "online", (1.322366672, -1.018421097, 2.65724166), (0.04243872078, 0.01069758678, 0)),
    (
        "spring", (1, 4), "identity",
        (1.322376847, -1.018297843, 2.662818849), (0.04248599084, 0.01136889845, -0.003447993401),
    ),
    (
        "van_der_pol", (10, 25), "jacobian",
        (4.730161673, -0.9894025438, -22.14605752), (0.02340193119, 0.005285534801, -0.09605643018),
    ),
    ("van_der_pol", (10, 25), "online", (4.727937921, -1.029673789, -26.01541926), (0.01656436098, -0.02884867989, 0)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "strengths", "choice", "estimate", "gain"), GOLDENS)
def test_goldens_by_hand(name, strengths, choice, estimate, gain):
    system, x0 = by_hand(name, *strengths)
    w, v = noises(*strengths)
    truth = simulate(system, x0, np.zeros((STEPS, 0)), w[:, None], np.zeros((STEPS, 1)))
    filter_ = JumpEstimator(system, choice, x0.copy(), np.eye(3))
    for k in range(STEPS):
        filter_.step(truth[k + 1, 0] + v[k], np.zeros(0), truth[k], truth[k + 1])
    np.testing.assert_allclose(filter_.x, estimate, rtol=0, atol=1e-8)
    np.testing.assert_allclose(filter_.K, gain, rtol=0, atol=1e-8)


def followed(system, choice, strengths, view, steps=STEPS, **options):
    """Return the estimate and the gain after `steps` of the deterministic input, by a view of simulation and estimator."""
    names = [state.signal.name for state in system.plant.states]
    estimator = jump_matrix_estimator(
        system.model, choice, **{"initial_variance": 1.0, "around": system.start} | options
    )
    truth, filter_ = view(jump_simulation(system.model, around=system.start)), view(estimator)
    settings = truth.params(), filter_.params()
    moved, memory = truth.init(settings[0]), filter_.init(settings[1])
    for w, v in zip(*noises(*strengths, steps=steps), strict=True):
        answer = truth.call("step", moved, truth.inputs("step", {"w": w, "z_noise": v}), settings[0])
        assert answer.status == 0
        moved = answer.memory
        given = {"has_z": True, "z": answer.outputs["z"]}
        if choice == "online":
            given |= {f"true_{name}": moved[name] for name in system.model.clamps}
        answer = filter_.call("step", memory, filter_.inputs("step", given), settings[1])
        assert answer.status == 0
        memory = answer.memory
    packed = np.array(memory["covariance"], dtype=float)
    # (I - K H) M H' = K R: the first column of P is the gain times R
    return np.array([float(memory[name]) for name in names]), packed[: len(names)] / strengths[1]


@pytest.mark.parametrize("view", [NativeView, ReferenceView])
@pytest.mark.parametrize(("name", "strengths", "choice", "estimate", "gain"), GOLDENS)
def test_goldens_of_the_blocks(name, strengths, choice, estimate, gain, view):
    """The compiled C, and the oracle."""
    x, K = followed(jump_systems.SYSTEMS[name](), choice, strengths, view)
    np.testing.assert_allclose(x, estimate, rtol=0, atol=1e-8)
    np.testing.assert_allclose(K, gain, rtol=0, atol=1e-8)


def test_golden_of_one_step_and_of_the_exact_matrices():
    model = jump_systems.spring().model
    Phi = [
        [0.999900034991, 0.00999466850287, -4.99825045046e-05],
        [-0.0199893370057, 0.998900568141, -0.00999466850287],
        [0, 0, 1],
    ]
    np.testing.assert_allclose(model.Phi, Phi, rtol=1e-11)
    np.testing.assert_allclose(model.Psi, [[4.99825045046e-05], [0.00999466850287], [0]], rtol=1e-11)
    view = NativeView(jump_simulation(model, around={"x1": 1.5}))
    params = view.params()
    w, v = noises(1, 4)
    answer = view.call("step", view.init(params), view.inputs("step", {"w": w[0], "z_noise": v[0]}), params)
    after = [float(answer.memory[name]) for name in ("x1", "x2", "cubic")]
    np.testing.assert_allclose(after, [1.499702251, -0.05953895305, 3.372990591], rtol=0, atol=1e-9)


@pytest.mark.parametrize("make", jump_systems.SYSTEMS.values(), ids=list(jump_systems.SYSTEMS))
def test_exact_matrices_of_every_system_beside_scipy(make):
    """Phi, Gam and Psi, their zeros and unit rows exactly."""
    model = make().model
    Phi, Gam, Psi = discrete_parts(model.A, model.B, model.L, 0.01)
    for ours, theirs in ((model.Phi, Phi), (model.Gam, Gam), (model.Psi, Psi)):
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-18)
    rows = list(model.clamped)
    assert np.array_equal(model.Phi[rows], np.eye(len(model.Phi))[rows])
    assert not np.any(model.Gam[rows]) and not np.any(model.Psi[rows])


def test_matrices_of_section_5():
    """A, B, L and the place of the nonlinearity, as printed."""
    printed = {
        "relay": ([[0, 1, 0], [0, -1, 1], [0, 0, 0]], None, [0, 0, 0], (2,)),
        "modified_relay": ([[-1, 1, 0], [0, 0, 1], [0, 0, 0]], None, [1, 0, 0], (2,)),
        "linear_amplifier": ([[-1, 10], [0, 0]], [0, 1], [0, 1], ()),
        "saturating_amplifier": ([[-1, 1, 0], [0, 0, 0], [0, 0, 0]], [0, 0, 1], [0, 0, 1], (1,)),
        "controlled_spring": ([[0, 1, 0], [0, 0, -1], [0, 0, 0]], [0, 1, 0], [0, 1, 0], (2,)),
        "saturated_spring": ([[0, 1, 0], [0, 0, -1], [0, 0, 0]], [0, 1, 0], [0, 1, 0], (2,)),
    }
    for name, (A, B, L, clamped) in printed.items():
        model = jump_systems.SYSTEMS[name]().model
        assert np.array_equal(model.A, A), name
        assert np.array_equal(model.L.ravel(), L), name
        assert B is None or np.array_equal(model.B.ravel(), B), name
        assert model.clamped == clamped, name


def test_a_zero_coefficient_gives_a_zero_column():
    """h = 0 (section 1): the column of the nonlinearity is zero above the diagonal."""
    assert np.array_equal(jump_systems.spring(h=0.0).model.Phi[:2, 2], [0, 0])


def test_both_relays_are_the_same_without_noise():
    """Section 5.4, on the compiled C; the held nonlinearity sees the same x1 in both."""
    ends = []
    for make in (jump_systems.relay, jump_systems.modified_relay):
        system = make()
        view = NativeView(jump_simulation(system.model, around=system.start))
        params, inputs = view.params(), view.inputs("step", {})
        memory = view.init(params)
        ends.append([])
        for _ in range(300):
            memory = view.call("step", memory, inputs, params).memory
            ends[-1].append(float(memory["x1"]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-11)
    assert max(ends[0]) > 1.0  # it has moved, and overshot


# -- the theorem of section 4 -----------------------------------------------------------------------------------------


def without_clamp_variance(system, choice, steps=200, p0=0.0):
    """Return estimates over a run of the compiled C with P_0 zero where the nonlinearities are."""
    names = [state.signal.name for state in system.plant.states]
    variances = {name: 0.0 if name in system.model.clamps else p0 for name in names}
    q, r = 1.0, 4.0
    return np.concatenate(
        followed(system, choice, (q, r), NativeView, steps, initial_variance=variances, variance_floor=0.0)
    )


@pytest.mark.parametrize("name", ["spring", "van_der_pol"])
def test_theorem_online_is_identity_without_initial_variance(name):
    """(i): P_0 = 0, bit for bit."""
    system = jump_systems.SYSTEMS[name](**({"noise": 1.0, "reading": 4.0}))
    online, identity = (without_clamp_variance(system, choice) for choice in ("online", "identity"))
    assert online.tobytes() == identity.tobytes()
    assert np.any(online[-3:] != 0)  # the gain is not zero altogether


def test_theorem_any_gain_of_the_clamp_is_inert():
    """With the clamp's rows of P_0 zero they stay zero, K_n = 0, and the rest is the linear filter: P_0 of the rest is one."""
    system = jump_systems.spring()
    online = without_clamp_variance(system, "online", p0=1.0)
    identity = without_clamp_variance(system, "identity", p0=1.0)
    assert online.tobytes() == identity.tobytes()
    assert online[-1] == 0.0
    assert without_clamp_variance(system, "jacobian", p0=1.0)[-1] != 0.0  # not block diagonal: the theorem says nothing


def test_theorem_online_and_jacobian_agree_where_the_plant_is_linear():
    """(iii): h = 0, any P_0; the estimate of (x1, x2) is that of the two-state Kalman filter."""
    system = jump_systems.spring(h=0.0)
    ends = [followed(system, choice, (1, 4), NativeView, 300)[0] for choice in ("online", "jacobian", "identity")]
    np.testing.assert_allclose(ends[0][:2], ends[1][:2], rtol=0, atol=1e-13)
    np.testing.assert_allclose(ends[2][:2], ends[1][:2], rtol=0, atol=1e-13)
    assert abs(ends[2][2] - ends[1][2]) > 1e-3  # the third is none of theirs


def test_theorem_does_not_hold_with_noise_inside_the_nonlinearity():
    """The original relay once it no longer saturates: G Q G' feeds the clamp, and its gain is not zero."""
    system = jump_systems.relay()
    _, K = followed(system, "online", (0.1, 1.0), NativeView, 181, initial_variance=0.0)
    assert abs(K[2]) > 0.01


# -- chapter IV -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("closed", "gain"), [(False, (0.067744, 0.030533)), (True, (0.040292, 0.012314))])
def test_steady_gains_of_the_linear_case(closed, gain):
    """Section 6: K_OL and K_CL, also by the Riccati equation of the transition that is used."""
    system = jump_systems.linear_amplifier()
    model = system.model
    transition = model.closed_transition([system.gain]) if closed else None
    estimator = jump_matrix_estimator(model, initial_variance=1.0, covariance_transition=transition)
    view = NativeView(estimator)
    params = view.params()
    memory, inputs = view.init(params), view.inputs("step", {"u": 1.0, "has_z": True, "z": 0.0})
    for _ in range(3000):
        answer = view.call("step", memory, inputs, params)
        assert answer.status == 0
        memory = answer.memory
    K = np.array(memory["covariance"], dtype=float)[:2] / 0.01
    np.testing.assert_allclose(K, gain, rtol=0, atol=6e-7)
    F = model.Phi if transition is None else transition
    M = solve_discrete_are(F.T, np.array([[1.0], [0.0]]), 0.1 * model.Psi @ model.Psi.T, np.array([[0.01]]))
    np.testing.assert_allclose(K, M[:, 0] / (M[0, 0] + 0.01), rtol=1e-8)


def test_the_estimate_is_fed_back_held_for_a_step():
    """(4.4), x(k+1) = Phi_CL x + Gam r + Gam F e + Psi w, along the loop of plant and controller."""
    system = jump_systems.linear_amplifier()
    model = system.model
    estimator = jump_matrix_estimator(model, initial_variance=1.0, around=system.start)
    loop = closed_loop(system.plant, jump_systems.controller(system, estimator), system.start)
    rng = np.random.default_rng(3)
    noise = {"w": 0.3 * rng.normal(size=(50, 1)), "z_noise": 0.1 * rng.normal(size=(50, 1))}
    history = run_loop(loop, NativeView(loop.truth), NativeView(loop.controller), 50, noise=noise)
    F = np.array([system.gain])
    x, error = history.truth[:-1], (history.truth - history.estimate)[:-1]
    expected = (
        x @ model.closed_transition(F).T
        + (model.Gam @ [[1.0]]).T
        + error @ (model.Gam @ F).T
        + noise["w"][1:] @ model.Psi.T
    )
    np.testing.assert_allclose(history.truth[1:], expected, rtol=0, atol=1e-13)
    assert np.max(np.abs(error)) > 1e-3


# -- the compiled Monte-Carlo, without commands -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "choice", "strengths"), [("spring", "jacobian", (1, 4)), ("van_der_pol", "online", (10, 25))]
)
def test_the_mean_square_error_of_a_run_is_that_of_section_3(name, choice, strengths):
    """Plant and estimator as one C call, beside both by hand, at the same noise: k = 1 .. N, the start included."""
    system = jump_systems.SYSTEMS[name]()
    estimator = jump_matrix_estimator(system.model, choice, initial_variance=1.0, around=system.start)
    loop = closed_loop(system.model.truth if choice == "online" else system.plant, estimator, system.start)
    steps = 300
    result = monte_carlo(loop, runs=2, steps=steps, seed=5)
    assert result.count("kept") == 2
    hand, x0 = by_hand(name, *strengths)
    for run in range(2):
        noise = {item.name: draw(item, 5, run, steps) for item in channels(loop.noises)}
        assert noise.keys() == {"w", "z_noise"}  # the true values are read without noise
        truth = simulate(hand, x0, np.zeros((steps, 0)), noise["w"], np.zeros((steps, 1)))
        filter_ = JumpEstimator(hand, choice, x0.copy(), np.eye(3))
        errors = []
        for k in range(steps):
            filter_.step(truth[k + 1, 0] + noise["z_noise"][k, 0], np.zeros(0), truth[k], truth[k + 1])
            errors.append(truth[k + 1] - filter_.x)
        squares = np.mean(np.square(errors), axis=0)
        for state, expected in zip(loop.layout.states, squares, strict=True):
            assert result.judgements[run].metrics[f"error_{state.name}"] == pytest.approx(expected, rel=1e-8)
    history = replay(loop, 1, steps=steps, seed=5)
    assert history.commands.shape == (steps, 0)


def test_the_other_noise_is_another_error():
    """The companion: the number above is not met by the noise of another run."""
    system = jump_systems.spring()
    estimator = jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start)
    result = monte_carlo(closed_loop(system.plant, estimator, system.start), runs=2, steps=300, seed=5)
    first, second = result.every("error_x1")
    assert abs(first / second - 1) > 1e-2


def test_a_known_start_needs_no_command_where_there_is_none():
    system = jump_systems.spring()
    estimator = jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start)
    loop = closed_loop(system.plant, estimator, system.start)
    history = replay(loop, 0, steps=1, start=Start({"x1": 0.1}, known=True), std={"w": 0.0, "z_noise": 0.0})
    # x3 of the start is that of the set point, in truth and estimate alike
    np.testing.assert_allclose(history.truth, history.estimate, rtol=0, atol=1e-14)


EXPECTED = [
    # variance of w, of the reading, P_0; section 6
    (1, 0.1, 0, 0.0016014), (1, 4, 0, 0.0070415), (1, 100, 0, 0.0090163), (0.1, 4, 0, 0.00088374), (10, 4, 0, 0.032720),
    (1, 0.1, 1, 0.0024282), (1, 4, 1, 0.028160), (1, 100, 1, 0.10716), (0.1, 4, 1, 0.024832), (10, 4, 1, 0.047209),
]  # fmt: skip


@pytest.mark.slow
def test_the_mean_square_error_of_the_linear_case():
    """h = 0, 400 runs for each row, one compiled loop: within 4 % of the exact expectation (section 6)."""
    system = jump_systems.spring(h=0.0)
    estimator = jump_matrix_estimator(system.model, initial_variance=0.0, variance_floor=0.0, around=system.start)
    loop = closed_loop(system.plant, estimator, system.start)
    for q, r, p0, expected in EXPECTED:
        params = {f"controller.variance_{name}_0": p0 for name in ("x1", "x2", "cubic")}
        params |= {"controller.variance_w": q, "controller.variance_z": r}
        std = {"w": np.sqrt(q), "z_noise": np.sqrt(r)}
        result = monte_carlo(loop, runs=400, steps=1000, seed=7, params=params, std=std)
        assert result.mean("error_x1").value == pytest.approx(expected, rel=0.04), (q, r, p0)


def test_runs_that_escape_count_as_diverged():
    """The soft spring has saddles at |x1| = 2: beyond them a run escapes to infinity (section 5.1)."""
    system = jump_systems.spring(h=-0.5, noise=10.0)
    estimator = jump_matrix_estimator(system.model, initial_variance=1.0, around=system.start)
    result = monte_carlo(closed_loop(system.plant, estimator, system.start), runs=100, steps=1000, seed=2)
    errors = result.every("error_x1", above=1e3)
    diverged = np.mean(np.isinf(errors))
    assert result.count("frozen") == np.sum(np.isinf(errors))
    assert 0.08 < diverged < 0.3
    assert np.sum(np.isinf(result.every("error_x1", above=float(np.median(errors))))) == 50
