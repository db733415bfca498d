"""C helpers of a filter: two rows of a whole-state measurement at a time, and the fast test of a covariance.

A sensor that measures every state, in their order, is taken two rows at a time. The two rows measured are the first of
the triangle; the result is written with them moved to the end, so that the next two are first and the same functions
serve again: after size / 2 turns the order is what it was. Rows of the triangle are contiguous, and the stores of a
function leave gaps between them (where the measured pair goes), which lets a compiler use two lanes per operation.
"""

from __future__ import annotations

import re
from collections import Counter

from ..symbolic.kernels import SMALLEST_VARIANCE
from ..symbolic.program import packed_index, packed_size
from .style import Precision


def pair_helpers(prefix: str, precision: Precision, size: int) -> list[str]:
    """Return the type and the three functions that correct by two measured states."""
    real, packed, rest = precision.name, packed_size(size), size - 2
    one, least = precision.literal(1.0), precision.literal(SMALLEST_VARIANCE)
    every, others = range(size), range(2, size)

    def moved(i: int, j: int) -> int:
        a, b = sorted(((i - 2) % size, (j - 2) % size))
        return packed_index(size, a, b)

    lines = [
        "",
        "/* Between the steps of one update: the correction d, what the rows give, and the rows of P just measured. */",
        "typedef struct",
        "{",
        f"    {real} delta[{size}];",
        f"    {real} loss_a[{rest}];",
        f"    {real} loss_b[{rest}];",
        f"    {real} cross_b[{rest}];",
        f"    {real} row_a[{rest}];",
        f"    {real} row_b[{rest}];",
        f"    {real} row_variance[{size}];",
        f"    {real} nis;",
        f"}} {prefix}_rows_t;",
        "",
        "/* Rows a and b measure the first two states: d = d + K e, in the order that has these two last. loss is -K,",
        " * cross is P H'; b is after a. The measured rows of P become r K. */",
        f"static void {prefix}_gain(const {real} p[{packed}], {real} q[{packed}], {prefix}_rows_t *work,",
        f"{' ' * (len(prefix) + 18)}const {real} residual[2], const {real} r[2], {real} variance[2])",
        "{",
    ]
    add = lines.append

    def constant(name: str, text: str) -> None:
        add(f"    const {real} {name} = {text};")

    for j in every:
        constant(f"a_{j}", f"p[{j}]")
    for j in every[1:]:
        constant(f"p_{j}", f"p[{size - 1 + j}]")
    constant("s_a", "r[0] + a_0")
    constant("minus_per_a", f"-{one} / ((s_a >= {least}) ? s_a : {one})")
    constant("minus_r_a", "-r[0]")
    constant("minus_r_b", "-r[1]")
    for j in every:
        constant(f"n_{j}", f"a_{j} * minus_per_a")
    constant("b_0", "n_1 * minus_r_a")
    for j in every[1:]:
        constant(f"b_{j}", f"p_{j} + (a_{j} * n_1)")
    constant("s_b", "r[1] + b_1")
    constant("minus_per_b", f"-{one} / ((s_b >= {least}) ? s_b : {one})")
    for j in every:
        constant(f"k_{j}", f"b_{j} * minus_per_b")
    add("")
    for name, value in (("loss_a", "n"), ("cross_b", "b"), ("loss_b", "k")):
        for j in others:
            add(f"    work->{name}[{j - 2}] = {value}_{j};")
    for j in others:
        add(f"    work->row_b[{j - 2}] = k_{j} * minus_r_b;")
    for j in others:
        add(f"    work->row_a[{j - 2}] = (n_{j} * minus_r_a) + (b_{j} * k_0);")
    add(f"    q[{moved(0, 0)}] = (n_0 * minus_r_a) + (b_0 * k_0);")
    add(f"    q[{moved(0, 1)}] = k_0 * minus_r_b;")
    add(f"    q[{moved(1, 1)}] = k_1 * minus_r_b;")
    add("    variance[0] = s_a;")
    add("    variance[1] = s_b;")
    add("")
    constant("d_0", "work->delta[0]")
    constant("d_1", "work->delta[1]")
    constant("minus_e_a", "d_0 - residual[0]")
    constant("minus_e_b", "(d_1 + (n_1 * minus_e_a)) - residual[1]")
    for j in others:
        add(f"    work->delta[{j - 2}] = (work->delta[{j}] + (n_{j} * minus_e_a)) + (k_{j} * minus_e_b);")
    for j in (0, 1):
        add(f"    work->delta[{size - 2 + j}] = (d_{j} + (n_{j} * minus_e_a)) + (k_{j} * minus_e_b);")
    constant("nis", "work->nis - (minus_e_a * (minus_per_a * minus_e_a))")
    add("    work->nis = nis - (minus_e_b * (minus_per_b * minus_e_b));")
    lines += [
        "}",
        "",
        "/* The rows just measured become the last two columns. */",
        f"static void {prefix}_place({real} q[{packed}], const {prefix}_rows_t *work)",
        "{",
    ]
    for j in others:
        add(f"    q[{moved(0, j)}] = work->row_a[{j - 2}];")
        add(f"    q[{moved(1, j)}] = work->row_b[{j - 2}];")
    lines += [
        "}",
        "",
        "/* P = P - K s K' for what was not measured, two rows at once. */",
        f"static void {prefix}_downdate(const {real} p[{packed}], {real} q[{packed}], const {prefix}_rows_t *work)",
        "{",
    ]
    for j in others:
        constant(f"a_{j}", f"p[{j}]")
        constant(f"b_{j}", f"work->cross_b[{j - 2}]")
    for i in others:
        add("")
        constant(f"n_{i}", f"work->loss_a[{i - 2}]")
        constant(f"k_{i}", f"work->loss_b[{i - 2}]")
        for j in range(i, size):
            constant(f"p_{i}_{j}", f"p[{packed_index(size, i, j)}]")
        for j in range(i, size):
            add(f"    q[{moved(i, j)}] = (p_{i}_{j} + (a_{j} * n_{i})) + (b_{j} * k_{i});")
    add("}")
    return lines


def pair_operations(size: int) -> Counter[str]:
    """Return the operations of a whole update by these functions, counted in their text."""
    text = re.sub(r"/\*.*?\*/", "", "\n".join(pair_helpers("x", Precision("double"), size)), flags=re.DOTALL)
    signs = {
        "addition": r" [+-] ",
        "multiplication": r" \* ",
        "division": r" / ",
        "negation": r"= -",
        "selection": r" \? ",
    }
    return Counter({word: size // 2 * len(re.findall(sign, text)) for word, sign in signs.items()})


def bounded_helper(prefix: str, precision: Precision, size: int, floor: tuple[float, ...], limit: float) -> list[str]:
    """Return the test that passes a covariance at once: sufficient, and what it does not pass is looked at closely."""
    real, packed = precision.name, packed_size(size)
    lanes = next(k for k in (6, 4, 2, 5, 3, 7, 1) if packed % k == 0)
    zero = precision.literal(0.0)
    lines = [
        "",
        "/* Whether a covariance is within its bounds beyond doubt: a sum of magnitudes below a bound bounds each of them,",
        " * and is not below it where one is NaN. */",
        f"static bool {prefix}_is_bounded(const {real} covariance[{packed}])",
        "{",
        *[f"    {real} sum_{k} = {zero};" for k in range(lanes)],
        "",
        f"    for (uint32_t i = 0U; i < {packed}U; i = i + {lanes}U)",
        "    {",
        *[
            f"        sum_{k} = sum_{k} + {precision.function('fabs')}(covariance[i{f' + {k}U' if k else ''}]);"
            for k in range(lanes)
        ],
        "    }",
    ]
    terms = [f"sum_{k}" for k in range(lanes)]
    while len(terms) > 1:
        terms = [f"({' + '.join(terms[k : k + 2])})" for k in range(0, len(terms), 2)]
    total = terms[0]
    lines.append(f"    return ({total} <= {precision.literal(limit)})")
    for i in range(size):
        at = packed_index(size, i, i)
        lines.append(f"           && (covariance[{at}] >= {precision.literal(floor[i])})")
    lines[-1] += ";"
    lines.append("}")
    return lines
