"""How long a covariance in single precision stays one, by form, beside the textbook formulas in CasADi's own C.

The quadrotor with six sensors (positions and angles), the pseudo-noise of Meda-Campana 2018 (specs, section 10.1(e)) scaled to
each case. The oracle is the same filter in 60 digits, fed the same single-precision numbers; errors are in its sigma. A
covariance counts as lost where what is stored is not positive definite (exactly: the stored numbers are factorised in 60
digits) or not finite, or where the call was refused. `plantc export --tables` of the example `quadrotor_ud` puts the table
into its evidence and its report; it needs mpmath.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi as ca
import mpmath  # type: ignore[import-untyped]
import numpy as np
from plantc.codegen import NativeView, find_compiler
from plantc.codegen.compiler import BASE_FLAGS, contraction_flag
from plantc.examples.quadrotor_ekf import hover
from plantc.examples.quadrotor_ud import quadrotor6, quadrotor_ud, sampled6
from plantc.symbolic import Block, Table
from plantc.symbolic.discretisation import transition
from plantc.symbolic.expressions import tape

from plantc import extended_kalman_filter

STEPS = 200
SEEN = np.arange(0, 12, 2)
"""The states that are measured."""

CENTRE = np.where(np.arange(12) == 4, 30.0, 0.0)
GAIN = np.array(
    [
        [-25.0, 411.0, -8.9, 399.0], [-4.3, 333.0, 13.0, 311.0], [-311.0, -20.0, -322.0, -32.0],
        [-277.0, -22.0, -299.0, -37.0], [199.0, 200.0, 199.0, 200.0], [93.0, 95.0, 93.0, 95.0],
        [711.0, 59.0, 766.0, 122.0], [56.0, 2.9, 67.0, 14.0], [28.0, 844.0, 97.0, 766.0],
        [3.4, 71.0, 15.0, 58.0], [177.0, -188.0, 177.0, -188.0], [74.0, -76.0, 74.0, -76.0],
    ]
)  # fmt: skip
"""The state feedback F44 of the paper, eq. (44)."""


@dataclass(frozen=True)
class Case:
    """Noise of the sensors, initial variance, and noise of the process per step."""

    name: str
    r: float
    p0: float
    q: float


CASES = (
    Case("nominal", 1e-2, 1e-2 / 3, 1e-6),
    Case("sharp sensor, vague prior", 1e-8, 1e4, 1e-6),
    Case("and little process noise", 1e-8, 1e4, 1e-12),
)
"""The nominal case, and those in which a covariance in single precision stops being one."""

FORMS = ("conventional", "joseph", "ud")
TEXTBOOK = "CasADi textbook"


def trace_of(case: Case, steps: int = STEPS) -> list[tuple[Any, Any]]:
    """Return (rotor speeds, reading) of each step, rounded to single precision: a closed loop with true-state feedback."""
    step = ca.Function("f", [sampled6.x, sampled6.u], [transition(sampled6)[0]])
    i, x, rows = np.arange(1, 13), CENTRE + 0.05 * (-1.0) ** np.arange(1, 13), []
    for k in range(1, steps + 1):
        u = np.float32(hover - GAIN.T @ (x - CENTRE))
        w = np.sqrt(2 * case.q) * np.sin(1.1 * k * i + 2.3 * i + 0.5)
        v = np.sqrt(2 * case.r) * np.sin(1.7 * k * i + 0.7 * i**2 + 0.2)
        x = np.array(step(x, u.astype(float))).ravel() + w
        rows.append((u, np.float32((x + v)[SEEN])))
    return rows


# -- the oracle -------------------------------------------------------------------------------------------------------


def lowered(function: ca.Function) -> Callable[..., list[list[Any]]]:
    """Return a CasADi function that computes with mpmath."""
    record = tape(function)
    unary = {"sin": mpmath.sin, "cos": mpmath.cos, "neg": lambda a: -a, "sq": lambda a: a * a, "twice": lambda a: 2 * a}
    binary = {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
    }

    def call(*arguments: list[Any]) -> list[list[Any]]:
        values: list[Any] = []
        for item in record.steps:
            given = [values[k] for k in item.arguments]
            if item.operation == "input":
                values.append(arguments[item.place[0]][item.place[1]])
            elif item.operation == "const":
                values.append(mpmath.mpf(item.value))
            else:
                values.append((unary.get(item.operation) or binary[item.operation])(*given))
        return [[values[k] for k in output] for output in record.outputs]

    return call


def oracle(case: Case, trace: list[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    """Return (x, P) of the filter in 60 digits after each step."""
    following, F = transition(sampled6)
    call = lowered(ca.Function("f", [sampled6.x, sampled6.u], [ca.densify(following), ca.densify(F)]))
    r, p0, q = (mpmath.mpf(float(np.float32(item))) for item in (case.r, case.p0, case.q))
    x = [mpmath.mpf(float(item)) for item in CENTRE]
    P = mpmath.diag([p0] * 12)
    answer = []
    for u, z in trace:
        x, flat = call(x, [mpmath.mpf(float(item)) for item in u])
        matrix = mpmath.matrix(12, 12)
        for j in range(12):
            for i in range(12):
                matrix[i, j] = flat[12 * j + i]
        P = matrix * P * matrix.T + mpmath.diag([q] * 12)
        for row, at in enumerate(SEEN):
            column = [P[k, int(at)] for k in range(12)]
            s = column[int(at)] + r
            e = mpmath.mpf(float(z[row])) - x[int(at)]
            x = [item + c * e / s for item, c in zip(x, column, strict=True)]
            for i in range(12):
                for j in range(12):
                    P[i, j] -= column[i] * column[j] / s
        answer.append((np.array(x), np.array(P.tolist())))
    return answer


def is_definite(P: Any) -> bool:
    """Whether a matrix of floating-point numbers is positive definite, exactly (its factorisation in 60 digits)."""
    if not np.all(np.isfinite(np.asarray(P, dtype=float))):
        return False
    rest = [[mpmath.mpf(float(item)) for item in row] for row in P]
    for k in range(len(rest)):
        if rest[k][k] <= 0:
            return False
        for i in range(k + 1, len(rest)):
            factor = rest[i][k] / rest[k][k]
            for j in range(k + 1, len(rest)):
                rest[i][j] -= factor * rest[k][j]
    return True


# -- what is compared -------------------------------------------------------------------------------------------------


def _block(form: str) -> Block:
    """Return the filter of the example, or the same one in another form: variances are run-time parameters of all."""
    if form == "ud":
        return quadrotor_ud
    names = [state.signal.name for state in quadrotor6.states]
    variances = dict.fromkeys(names, 0.01 / 3)
    around = dict(zip(names, CENTRE, strict=True)) | {f"rotor_{k}": hover for k in (1, 2, 3, 4)}
    return extended_kalman_filter(
        sampled6, initial_variance=variances, around=around, form=form, name=f"quadrotor_{form}"
    )


def ours(form: str, case: Case, trace: list[tuple[Any, Any]]) -> Iterator[tuple[Any, Any, bool]]:
    """Yield (x, P, whether it holds) of the compiled filter in single precision."""
    names = [state.signal.name for state in quadrotor6.states]
    view = NativeView(_block(form), "float")
    params = view.params(
        variance_pose=np.full(6, case.r),
        gate_pose=0.0,
        **{f"variance_step_{name}": case.q for name in names},
        **{f"variance_{name}_0": case.p0 for name in names},
    )
    memory = view.init(params)
    for u, z in trace:
        inputs = {**{f"rotor_{i + 1}": u[i] for i in range(4)}, "has_pose": True, "pose": z}
        answer = view.call("step", memory, view.inputs("step", inputs), params)
        taken = answer.status >= 0 and int(answer.outputs["status_pose"]) >= 0
        memory = answer.memory
        x = np.array([memory[name] for name in names], dtype=float)
        if form == "ud":
            table = np.zeros((12, 12))
            table[np.triu_indices(12)] = memory["factors"]
            upper, weights = np.triu(table, 1) + np.eye(12), np.diag(table)
            exact = [[mpmath.mpf(float(item)) for item in row] for row in upper]
            P = np.array(
                [
                    [
                        sum(exact[i][k] * exact[j][k] * mpmath.mpf(float(weights[k])) for k in range(12))
                        for j in range(12)
                    ]
                    for i in range(12)
                ]
            )
            yield x, P, taken and bool(np.all(weights > 0))  # U is unit triangular: definite just where D is positive
        else:
            table = np.zeros((12, 12))
            table[np.triu_indices(12)] = memory["covariance"]
            P = table + np.triu(table, 1).T
            yield x, P, taken and is_definite(P)


def textbook(case: Case, trace: list[tuple[Any, Any]]) -> Iterator[tuple[Any, Any, bool]]:
    """Yield the same for P = (I - K H) P by CasADi's generator, in single precision."""
    following, F = transition(sampled6)
    P, z = ca.SX.sym("P", 12, 12), ca.SX.sym("z", 6)
    H = ca.SX(6, 12)
    for row, at in enumerate(SEEN):
        H[row, int(at)] = 1
    prior = ca.densify(F) @ P @ ca.densify(F).T + case.q * ca.SX.eye(12)
    gain = ca.solve(H @ prior @ H.T + case.r * ca.SX.eye(6), H @ prior).T
    step = ca.Function(
        "textbook",
        [sampled6.x, P, sampled6.u, z],
        [following + gain @ (z - H @ following), (ca.SX.eye(12) - gain @ H) @ prior],
    )
    with tempfile.TemporaryDirectory() as name:
        generator = ca.CodeGenerator("textbook.c", {"casadi_real": "float"})
        generator.add(step)
        generator.generate(name + "/")
        flags = [*BASE_FLAGS, contraction_flag(False), "-fPIC", "-shared"]
        find_compiler().run([*flags, "textbook.c", "-o", "textbook.so", "-lm"], Path(name))
        library = ctypes.CDLL(str(Path(name) / "textbook.so"))
        x: Any = np.float32(CENTRE)
        own: Any = np.float32(case.p0 * np.eye(12))
        work, whole = np.zeros(max(1, step.sz_w()), dtype=np.float32), np.zeros(max(1, step.sz_iw()), dtype=np.int64)
        for u, reading in trace:
            after, spread = np.zeros(12, dtype=np.float32), np.zeros((12, 12), dtype=np.float32)
            given = (ctypes.c_void_p * max(4, step.sz_arg()))(*[item.ctypes.data for item in (x, own, u, reading)])
            results = (ctypes.c_void_p * max(2, step.sz_res()))(*[item.ctypes.data for item in (after, spread)])
            library.textbook(given, results, ctypes.c_void_p(whole.ctypes.data), ctypes.c_void_p(work.ctypes.data), 0)
            x, own = after, spread
            yield x.astype(float), own.T.astype(float), is_definite(own)


def measure(cases: tuple[Case, ...] = CASES, steps: int = STEPS) -> list[dict[str, Any]]:
    """Return a row for each case and form: steps before the first loss, losses, and the largest errors in sigma."""
    with mpmath.workdps(60):
        return [row for case in cases for row in _measured(case, steps)]


def _measured(case: Case, steps: int) -> list[dict[str, Any]]:
    rows = []
    trace = trace_of(case, steps)
    truth = oracle(case, trace)
    runs = {form: ours(form, case, trace) for form in FORMS} | {TEXTBOOK: textbook(case, trace)}
    for form, run in runs.items():
        lost, first, worst_x, worst_p = 0, None, 0.0, 0.0
        for k, ((x, P, holds), (exact_x, exact_p)) in enumerate(zip(run, truth, strict=True), start=1):
            if not holds:
                lost += 1
                first = first or k
            sigma = np.array([mpmath.sqrt(exact_p[i, i]) for i in range(12)])
            with np.errstate(invalid="ignore"):  # not a number where the covariance is lost
                worst_x = _largest(worst_x, (x - exact_x) / sigma)
                worst_p = _largest(worst_p, (P - exact_p) / np.outer(sigma, sigma))
        rows.append(
            {
                "case": case.name, "form": form, "steps_until_lost": None if first is None else first - 1,
                "steps_lost": lost, "worst_x": worst_x, "worst_p": worst_p,
            }
        )  # fmt: skip
    return rows


def _largest(so_far: float, errors: Any) -> float:
    numbers = np.abs(np.array([float(item) for item in np.ravel(errors)]))
    return float("inf") if not np.all(np.isfinite(numbers)) else max(so_far, float(np.max(numbers)))


COLUMNS = ("case", "form", "steps until P is lost", "steps lost", "error of x, sigma", "error of P, sigma")


def _cells(row: dict[str, Any], steps: int) -> list[str]:
    until = f"never in {steps}" if row["steps_until_lost"] is None else str(row["steps_until_lost"])
    return [row["case"], row["form"], until, str(row["steps_lost"]), f"{row['worst_x']:.2g}", f"{row['worst_p']:.2g}"]


def table_text(rows: list[dict[str, Any]]) -> str:
    """Return the rows as a Markdown table."""
    lines = [COLUMNS, ("---",) * len(COLUMNS), *(_cells(row, STEPS) for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines).replace("| --- ", "|---").replace("--- |", "---|")


def table(cases: tuple[Case, ...] = CASES, steps: int = STEPS) -> Table:
    """Measure, for the evidence and the report of an export; see the top of this file.

    Parameters
    ----------
    cases : tuple of Case
        What is measured.
    steps : int
        Length of the closed loop.
    """
    values = "; ".join(f"{item.name}: r = {item.r:.3g}, initial {item.p0:.3g}, process {item.q:.3g}" for item in cases)
    return Table(
        f"Steps until the covariance is lost, by form, of {steps}",
        COLUMNS,
        [
            (
                row["case"],
                row["form"],
                f"never in {steps}" if row["steps_until_lost"] is None else row["steps_until_lost"],
                row["steps_lost"],
                *(row[key] if np.isfinite(row[key]) else "not finite" for key in ("worst_x", "worst_p")),
            )
            for row in measure(cases, steps)
        ],
        "Measured: the compiled C in single precision, in the form of this block and in the others, beside the textbook "
        "formulas printed by CasADi's own generator. A covariance is lost where what is stored is not positive definite "
        "(judged exactly), not finite, or where the call was refused. Errors are the largest of the run, in sigma of the same "
        "filter in 60 digits fed the same single-precision numbers. Variances by case, of each reading, state and step: "
        f"{values}. Closed loop of Meda-Campana 2018 on the true state.",
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON list")
    rows = measure()
    print(json.dumps(rows, indent=2) if parser.parse_args().json else table_text(rows))


if __name__ == "__main__":
    main()
