"""Tables and figures of the study `plantc.examples.fsmc2018`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from plantc.examples import fsmc_jacobian
from plantc.examples.fsmc_autopilot import CHANNELS, GAIN, LAWS, SLOPE
from plantc.examples.fsmc_quadrotor import DT, READ, SET_A, SET_B, TUNINGS
from plantc.examples.fsmc_runs import (
    BELIEFS,
    FOUR,
    FREQUENCIES,
    GAIN_SCALES,
    LATE,
    PRINTED,
    PUSH,
    PUSHES,
    RAISED,
    READINGS,
    SHARES,
    STEPS,
    VARIANTS,
    WIDTH_SCALES,
    Case,
    Found,
    Outcome,
    chattering_of,
    coefficients_of,
    consistency,
    heavy,
    place,
    poles,
    pushed,
    ramp,
    remaining,
    scaled,
    streams,
    turned,
)
from plantc.reference import fsmc
from plantc.reference.fsmc import Run
from plantc.simulation import Picture, StudyTable
from plantc.simulation.study import Cell

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Row = tuple[Cell, ...]

AXES = ("x", "y", "z", "yaw")
COMMANDS = ("CI u1", "CI u2", "CI u3", "CI u4")
QUIET = (2.0, 5.0)


def _errors(own: Outcome, *axes: str, window: tuple[float, float] = LATE) -> list[float]:
    return [float(own.tracking[window][place(axis)]) for axis in axes]


def _velocities(own: Outcome) -> float:
    """Return the root mean square of the six errors of estimated velocities."""
    return float(np.sqrt(np.mean(own.estimation[LATE][1::2] ** 2)))


def _mean(own: list[Outcome]) -> list[float]:
    """Return errors of tracking, of velocities, and chattering indices: means over runs."""
    rows = [[*_errors(item, *AXES), _velocities(item), *map(float, item.chattering[LATE])] for item in own]
    return [float(value) for value in np.mean(rows, axis=0)]


MEASURED = (*AXES, "velocities", *COMMANDS)
UNITS = "Root mean square errors over 5 to 10 s (m, rad; of velocities m/s and rad/s together); CI: chattering index, N/s, N m/s."


# ---------------------------------------------------------------------------------------------------------------------
# Tables


def _laws_table(found: Found, runs: int, seed: int) -> StudyTable:
    rows: list[Row] = []
    for law in LAWS:
        own = [found[case] for case in streams(law, runs, seed)]
        rows.append((law, *_mean(own), float(np.mean([item.saturated[LATE] for item in own]))))
    smc, fuzzy = (chattering_of(found, law, runs, seed) for law in ("SMC", "FSMC"))
    rows.append(("FSMC / SMC", *[None] * 5, *map(float, fuzzy / smc), None))
    return StudyTable(
        "laws",
        "SMC, tanh and FSMC beside one another, with noise",
        ("law", *MEASURED, "saturated"),
        tuple(rows),
        f"{UNITS} Means over {runs} streams; saturated: share of the steps.",
    )


def _quiet_table(found: Found) -> StudyTable:
    rows: list[Row] = [(law, *map(float, found[Case(law)].chattering[QUIET])) for law in LAWS]
    smc, fuzzy = (found[Case(law)].chattering[QUIET] for law in ("SMC", "FSMC"))
    rows.append(("FSMC / SMC", *map(float, fuzzy / smc)))
    return StudyTable(
        "quiet",
        "Chattering without any noise, 2 to 5 s",
        ("law", *COMMANDS),
        tuple(rows),
        f"SMC flips the sign of u1 in every step: 2 K m / dt = {2 * GAIN['z'] * SET_A['mass'] / DT:.4g} N/s; of u4 "
        f"2 K Iz / dt = {2 * GAIN['yaw'] * SET_A['inertia_z'] / DT:.4g} N m/s.",
    )


BANDS: dict[str, tuple[float, float]] = {
    "x": (0, 0.012), "y": (0, 0.013), "z": (0.0115, 0.0155), "yaw": (0, 0.002), "roll": (0, 0.0015), "pitch": (0, 0.0015),
    "velocities": (0.0030, 0.0075), "positions": (0.0036, 0.0043),
}  # fmt: skip
"""What section 11.5 accepts of each stream."""


def spread(found: Found, runs: int, seed: int) -> dict[str, tuple[float, float, float]]:
    """Return least, mean and largest of each quantity of `BANDS` over the streams of FSMC."""
    own = [found[case] for case in streams("FSMC", runs, seed)]
    values: dict[str, Array] = {axis: np.array([_errors(item, axis) for item in own]) for axis in BANDS if axis in READ}
    values["velocities"] = np.array([item.estimation[LATE][1::2] for item in own])
    values["positions"] = np.array([item.estimation[LATE][::2] for item in own])
    return {key: (float(np.min(item)), float(np.mean(item)), float(np.max(item))) for key, item in values.items()}


def _streams_table(found: Found, runs: int, seed: int) -> StudyTable:
    rows: list[Row] = []
    for key, (least, mean, most) in spread(found, runs, seed).items():
        low, high = BANDS[key]
        rows.append((key, least, mean, most, low, high, "yes" if low <= least and most <= high else "no"))
    return StudyTable(
        "streams",
        f"FSMC over {runs} streams of noise",
        ("error of", "least", "mean", "largest", "band from", "to", "inside"),
        tuple(rows),
        "Root mean square errors 5 to 10 s; roll and pitch against their filtered commands; velocities and positions: of the "
        "estimate, each of six. The bands are those of the specification, of an independent simulation.",
    )


def _push_table(found: Found) -> StudyTable:
    rows: list[Row] = []
    for law, tuning in PUSHES:
        for share in RAISED:
            own = found[pushed(law, tuning, share)]
            bias = fsmc.velocity_bias(fsmc.TUNINGS[tuning], fsmc.SET_A.a[11], PUSH) if tuning else None
            rows.append(
                (
                    tuning or "true state", law, share, float(own.last[10] - own.wanted[10]),
                    float(own.last[11] - own.seen[11]) if tuning else None, bias, bias / SLOPE["z"] if bias is not None else None,
                )
            )  # fmt: skip
    return StudyTable(
        "push",
        f"A constant acceleration of {PUSH} m/s^2 along z: no switching gain removes what the filter does not know",
        ("filter", "law", "K_z times", "z - z_d", "vz - estimate", "bias, theory", "z of SMC, theory"),
        tuple(rows),
        "After 10 s. Theory of a constant d in steady state: rho d / (1 - a11 rho), rho the ratio of the filter's gains. The "
        "position that the matched filter says is biased too.",
    )


def _mass_table(found: Found, seed: int) -> StudyTable:
    rows: list[Row] = []
    for share in SHARES:
        for tuning in (*TUNINGS, ""):
            pair = [
                found[heavy(share, tuning, law, seed) if tuning else
                      Case(law, seed=seed, estimated=False, params=(("plant.mass", share * SET_A["mass"]),))]
                for law in ("SMC", "FSMC")
            ]  # fmt: skip
            seen = [float(item.estimation[LATE][11]) if tuning else None for item in pair]
            rows.append((f"{share - 1:+.0%}", tuning or "true state", *[_errors(item, "z")[0] for item in pair], *seen))
    return StudyTable(
        "mass",
        "A vehicle that weighs something else than filter and law believe",
        ("mass", "filter", "z, SMC", "z, FSMC", "vz estimated, SMC", "FSMC"),
        tuple(rows),
        "Root mean square errors over 5 to 10 s, m and m/s, one stream of noise.",
    )


def _tuning_table(found: Found, runs: int, seed: int) -> StudyTable:
    rows: list[Row] = []
    for tuning in TUNINGS:
        own = [found[case] for case in streams("FSMC", runs, seed, tuning=tuning)]
        position, velocity = consistency(found, tuning, runs, seed)
        rows.append((tuning, *poles(tuning), *_mean(own), position, velocity, remaining(found, tuning)))
    return StudyTable(
        "tuning",
        "The printed Q and R beside filters that are tuned",
        ("filter", "K position", "K velocity", "slow 1/s", "fast 1/s", *MEASURED, "own sigma / error, positions",
         "own sigma / error, velocities", "left of a wrong vz"),
        tuple(rows),
        f"FSMC. {UNITS} Own sigma: what the filter says over what there is, 1 where it is consistent. Left: of a wrong start, "
        f"after 1 s. Means over {runs} streams.",
    )  # fmt: skip


def _outputs_table(found: Found, runs: int, seed: int) -> StudyTable:
    rows: list[Row] = []
    for tuning in TUNINGS:
        for read, words in ((READ, "six"), (FOUR, "four")):
            own = [found[case] for case in streams("FSMC", runs, seed, tuning=tuning, read=read)]
            tilt = float(np.sqrt(np.mean([item.estimation[LATE][[0, 2]] ** 2 for item in own])))
            rows.append((tuning, words, *_mean(own), tilt, _errors(found[turned(read, tuning)], "x")[0]))
    return StudyTable(
        "outputs",
        "Six outputs (section 3) and four (section 5: x, y, z, psi)",
        ("filter", "outputs", *MEASURED, "tilt estimated", "x, roll pushed"),
        tuple(rows),
        f"FSMC. {UNITS} Tilt estimated: error of roll and pitch, rad. Roll pushed: a constant 0.5 rad/s^2 on it, no noise. "
        f"Means over {runs} streams.",
    )


def _sets_table(found: Found, seed: int) -> StudyTable:
    rows: list[Row] = []
    for which, believed in BELIEFS:
        own = found[Case(seed=seed, which=which, believed=believed)]
        rows.append((which, believed or which, *_mean([own]), own.saturated[0.0, 5.0]))
    return StudyTable(
        "sets",
        "The two vehicles that the paper mixes",
        ("vehicle", "filter and law", *MEASURED, "saturated, 0-5 s"),
        tuple(rows),
        f"FSMC, one stream. {UNITS} A: Table 2. B: the one whose coefficients are printed. printed: its coefficients with the "
        "mass of Table 2.",
    )


def _coefficients_table() -> StudyTable:
    a, b = coefficients_of(SET_A), coefficients_of(SET_B)
    rows: list[Row] = [
        (key, value, a[key], b[key], a[key] / value - 1, b[key] / value - 1) for key, value in PRINTED.items()
    ]
    return StudyTable(
        "coefficients",
        "The printed coefficients, and what two vehicles give",
        ("coefficient", "printed", "set A", "set B", "A off", "B off"),
        tuple(rows),
        "Set A is m = 400 g, l = 20.5 cm of Table 2; set B m = 486 g, l = 25 cm, Iy, Iz = 3.8288e-3, 7.6566e-3, with the "
        "rotational drag for the translational.",
    )


def _jacobian_table() -> StudyTable:
    rows: list[Row] = [
        (f"F{item.row},{item.column}", item.printed, item.derived, item.difference, "yes" if item.right else "no")
        for item in fsmc_jacobian.compare()
    ]
    rows += [(f"F{row},{column}", "lost", "", None, "") for row, column in fsmc_jacobian.LOST]
    return StudyTable(
        "jacobian",
        "The printed Jacobian, entry by entry",
        ("entry", "printed", "derived", "largest difference", "right"),
        tuple(rows),
        "At 50 points, by the values of set B, of whose coefficients none is zero.",
    )


def _noise_table(found: Found, seed: int) -> StudyTable:
    rows: list[Row] = []
    for q_of in ("d", *READINGS):
        own = found[Case(seed=seed, q_of=q_of)]
        tilt = float(np.max(own.tracking[LATE][[0, 2]]))
        rows.append((q_of, own.largest_d, *_errors(own, "x", "y", "z"), tilt, own.saturated[LATE], own.diverged))
    return StudyTable(
        "noise",
        "What q = 1e-2 may be the variance of",
        ("q of", "largest |d|", "x", "y", "z", "roll or pitch", "saturated", "over at"),
        tuple(rows),
        "FSMC, printed filter, one stream. d: accelerations, each step. all states: added to them, as (5) has it; d is the sine "
        "only. velocities: to those only. density: continuous. forces: forces and torques of (1).",
    )


def _range_table(found: Found, seed: int) -> StudyTable:
    rows: list[Row] = []
    own = [(f"K times {gain:g}", law, Case(law, seed=seed, params=scaled(gain)))
           for law in ("SMC", "FSMC") for gain in GAIN_SCALES]  # fmt: skip
    own += [(f"Phi times {width:g}", "FSMC", Case(seed=seed, params=scaled(width=width))) for width in WIDTH_SCALES]
    own += [(f"filter of {value:g} rad/s", law, Case(law, seed=seed, params=scaled(frequency=value)))
            for law in ("SMC", "FSMC") for value in FREQUENCIES]  # fmt: skip
    for name, law, case in own:
        item = found[case]
        rows.append(
            (law, name, *_errors(item, *AXES, "roll"), *map(float, item.chattering[LATE]), item.saturated[LATE])
        )
    far = found[Case(seed=seed, start="far", steps=2 * STEPS)]
    rows.append(("FSMC", "start 4 m off, 15-20 s", *_errors(far, *AXES, "roll", window=(15.0, 20.0)),
                 *map(float, far.chattering[15.0, 20.0]), far.saturated[15.0, 20.0]))  # fmt: skip
    return StudyTable(
        "range",
        "Where it works: gains, widths, and filters of the attitude's commands",
        ("law", "changed", *AXES, "roll", *COMMANDS, "saturated"),
        tuple(rows),
        f"One stream. {UNITS} The start that is far off has the sine of an angle clipped in {far.clipped:.1%} of the first 5 s.",
    )


def _variants_table(found: Found, seed: int) -> StudyTable:
    rows: list[Row] = [("compiled", *_mean([found[Case(seed=seed)]]), None)]
    names = {"plain": "the NumPy reference", "printed Jacobian": "with the printed Jacobian", "divided": "with m / b for 1 / b",
             "literal": "with -K_fuzzy sgn(s) as printed", "Runge-Kutta": "with Runge-Kutta for the vehicle"}  # fmt: skip
    plain = found[Case(seed=seed, variant="plain")]
    for variant in VARIANTS:
        own = found[Case(seed=seed, variant=variant)]
        rows.append((names[variant], *_mean([own]), float(own.first[1] / plain.first[1])))
    return StudyTable(
        "variants",
        "What is misprinted, as printed",
        ("", *MEASURED, "first u2 over ours"),
        tuple(rows),
        f"FSMC, one stream, all but the first row by the NumPy reference, which shares no code with what is generated. {UNITS}",
    )


def _ramp_table(found: Found, seed: int) -> StudyTable:
    own = found[ramp(seed)]
    rows: tuple[Row, ...] = tuple(
        (f"{start:g} to {end:g} s", *_errors(own, *AXES, window=(start, end)))
        for start, end in ((0.0, 5.0), (5.0, 10.0), (10.0, 20.0))
    )
    return StudyTable(
        "ramp",
        "Fig. 13: z_d = 5 t over 20 s",
        ("window", *AXES),
        rows,
        "FSMC, one stream; root mean square errors, m and rad.",
    )


def tables(found: Found, runs: int, seed: int) -> list[StudyTable]:
    """Return all tables of the page."""
    return [
        _laws_table(found, runs, seed),
        _quiet_table(found),
        _streams_table(found, runs, seed),
        _tuning_table(found, runs, seed),
        _push_table(found),
        _mass_table(found, seed),
        _outputs_table(found, runs, seed),
        _sets_table(found, seed),
        _coefficients_table(),
        _jacobian_table(),
        _variants_table(found, seed),
        _noise_table(found, seed),
        _ramp_table(found, seed),
        _range_table(found, seed),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# Figures


def _tidy(axes: Any, title: str, *, time: bool = False) -> None:
    from plantc.codegen.figures import INK, MUTED

    axes.set_title(title, loc="left", fontsize=8, color=INK)
    axes.tick_params(length=0, labelcolor=MUTED)
    axes.grid(axis="y")
    if axes.get_yscale() == "linear":
        axes.locator_params(axis="y", nbins=5, steps=[1, 2, 5, 10])
    if time:
        axes.set_xlabel("time [s]")


def _whole(found: Found, case: Case) -> Run:
    own = found[case].run
    assert own is not None
    return own


def _tracking_figure(found: Found, seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    own = _whole(found, Case(seed=seed))
    t = DT * np.arange(len(own.X))[::20]
    with styled():
        figure = blank(3.8)
        grid = figure.subplots(2, 2, sharex=True)
        for axes, axis in zip(grid.ravel(), AXES, strict=True):
            for colour, (label, values) in zip(
                SERIES, (("reference", own.reference), ("vehicle", own.X)), strict=False
            ):
                axes.plot(
                    t, values[::20, place(axis)], color=colour, linewidth=0.9, label=label if axis == "x" else None
                )
            _tidy(axes, f"{axis} [{'rad' if axis == 'yaw' else 'm'}]", time=axis in ("z", "yaw"))
        figure.legend(loc="outside upper left", ncols=2, handlelength=1.2)
        return figure


def _velocity_figure(found: Found, seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    own = _whole(found, Case(seed=seed))
    t = DT * np.arange(len(own.X))[::20]
    with styled():
        figure = blank(2.3)
        left, right = figure.subplots(1, 2)
        for colour, axis in zip(SERIES, ("vx", "vy", "vz"), strict=False):
            k = place(axis)
            left.plot(t, (own.X - own.reference)[::20, k], color=colour, linewidth=0.9, label=axis)
            right.plot(t, 1e3 * (own.X - own.estimate)[::20, k], color=colour, linewidth=0.7)
        _tidy(left, "velocity less reference [m/s]", time=True)
        _tidy(right, "velocity less estimate [mm/s]", time=True)
        figure.legend(loc="outside upper left", ncols=3, handlelength=1.2)
        return figure


def _commands_figure(found: Found, seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    at = slice(9000, 9100)
    t = np.arange(at.stop - at.start)
    with styled():
        figure = blank(2.3)
        grid = figure.subplots(1, 2)
        for axes, k, title in zip(grid, (0, 1), ("u1 [N], a tenth of a second", "u2 [N]"), strict=True):
            for colour, law in zip(SERIES, ("SMC", "FSMC"), strict=False):
                own = _whole(found, Case(law, seed=seed))
                axes.plot(t, own.u[at, k], color=colour, linewidth=0.9, label=law if k == 0 else None)
            _tidy(axes, title)
            axes.set_xlabel("milliseconds from 9 s on")
        figure.legend(loc="outside upper left", ncols=2, handlelength=1.2)
        return figure


def _gains_figure(found: Found, seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    own = _whole(found, Case(seed=seed))
    t = DT * np.arange(len(own.X))[::20]
    with styled():
        figure = blank(3.6)
        grid = figure.subplots(3, 2, sharex=True)
        for k, axis in enumerate(CHANNELS):
            axes = grid[k % 3, k // 3]
            axes.plot(t, own.switching[::20, k], color=SERIES[0], linewidth=0.8)
            axes.axhline(GAIN[axis], color=SERIES[1], linewidth=0.7)
            axes.set_ylim(0, 1.1 * GAIN[axis])
            _tidy(axes, f"{axis} [{'m' if k > 2 else 'rad'}/s²]", time=k % 3 == 2)
        return figure


def _push_figure(found: Found) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    with styled():
        figure = blank(2.4)
        left, right = figure.subplots(1, 2)
        shown = (("SMC", "printed"), ("FSMC", "printed"), ("FSMC", "robust"), ("FSMC", ""))
        for colour, (law, tuning) in zip(SERIES, shown, strict=False):
            own = found[pushed(law, tuning)].along_z
            t = 10 * DT * np.arange(len(own))
            left.plot(t, own[:, 0], color=colour, linewidth=0.9, label=f"{law}, {tuning or 'true state'}")
            if tuning:
                right.plot(t, own[:, 1], color=colour, linewidth=0.9)
        left.set_ylim(-1, 1)
        _tidy(left, "z less reference [m]", time=True)
        _tidy(right, "vz less estimate [m/s]", time=True)
        figure.legend(loc="outside upper left", ncols=4, handlelength=1.2)
        return figure


def _ramp_figure(found: Found, seed: int) -> Figure:
    from plantc.codegen.figures import SERIES, blank, styled

    own = _whole(found, ramp(seed))
    with styled():
        figure = blank(2.6)
        left, right = figure.subplots(1, 2)
        for colour, (label, values) in zip(SERIES, (("reference", own.reference), ("vehicle", own.X)), strict=False):
            left.plot(values[::20, 6], values[::20, 8], color=colour, linewidth=0.9, label=label)
            right.plot(values[::20, 6], values[::20, 10], color=colour, linewidth=0.9)
        _tidy(left, "y over x [m], from above")
        _tidy(right, "z over x [m], from the side")
        for axes in (left, right):
            axes.set_xlabel("x [m]")
        figure.legend(loc="outside upper left", ncols=2, handlelength=1.2)
        return figure


def pictures(found: Found, seed: int) -> list[Picture]:
    """Return all figures of the page."""
    return [
        Picture(
            "tracking",
            "Figs. 6, 7: positions and yaw, FSMC",
            f"Reference and vehicle, noise of run {seed} from 5 s on: they meet within two to five seconds and stay together.",
            _tracking_figure(found, seed),
        ),
        Picture(
            "velocities",
            "Figs. 8 to 10: velocities",
            "Left, truth less reference: it decays at about 1/s, it does not end. Right, truth less estimate: zero until noise "
            "comes at 5 s, since the filter's model is the vehicle itself.",
            _velocity_figure(found, seed),
        ),
        Picture(
            "commands",
            "Fig. 11: thrust and roll command, SMC and FSMC",
            "A tenth of a second with noise: the conventional law jumps, the fuzzy one passes on the noise of the estimate.",
            _commands_figure(found, seed),
        ),
        Picture(
            "gains",
            "Fig. 12: the fuzzy switching gains",
            "k_hat of each channel, and K, which it never exceeds: large at the start, near zero after; so the condition (22), "
            "which asks for a constant, is not met.",
            _gains_figure(found, seed),
        ),
        Picture(
            "push",
            f"A constant acceleration of {PUSH} m/s^2 along z",
            "Left: with the printed filter z drifts to half a metre and more whatever the law; what is left with the true state is "
            "the layer. Right: the bias of the estimated velocity, which is the cause.",
            _push_figure(found),
        ),
        Picture(
            "ramp",
            "Fig. 13: z_d = 5 t",
            "Two and a half turns of the circle while climbing to 100 m.",
            _ramp_figure(found, seed),
        ),
    ]
