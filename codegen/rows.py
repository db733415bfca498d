"""C helpers of a filter: two rows of a whole-state measurement at a time, and the fast test of a covariance.

A sensor that measures every state, in their order, is taken two rows at a time. The two rows measured are the first of
the triangle; the result is written with them moved to the end, so that the next two are first and the same functions
serve again: after size / 2 turns the order is what it was. Rows of the triangle are contiguous, and the stores of a
function leave gaps between them (where the measured pair goes), which lets a compiler use two lanes per operation.
"""

from __future__ import annotations

import math
import re
from collections import Counter

from ..symbolic.kernels import SMALLEST_VARIANCE
from ..symbolic.program import HoldFactors, Packing, packed_index, packed_size
from .style import Precision, wrap_line


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


def bounded_helper(
    prefix: str,
    precision: Precision,
    packing: Packing,
    floor: tuple[float, ...],
    limits: tuple[float, ...],
    array: str = "covariance",
) -> list[str]:
    """Return the test that passes a covariance at once: sufficient, and what it does not pass is looked at closely.

    Two comparisons for each element are avoided by sums: k elements of the same limit L pass if each is at most
    L / 2k and their sum at least -L / 2, so that none is below -L / 2 - (k - 1) L / 2k > -L. Rounding of the sum is far
    smaller than the L / 2k left. An interval analysis follows that backwards through the sum.
    """
    real, packed = precision.name, packing.count
    diagonal = list(packing.diagonal)
    clauses = [
        _true(f"{_element(at, array)} >= {precision.literal(low)}") for at, low in zip(diagonal, floor, strict=True)
    ]
    for group in _groups(diagonal, limits):
        most = precision.literal(_rounded_down(0.99 * limits[group[0]]))
        clauses.append(_true(f"{_sum(group, array)} <= {most}"))
    for group in _groups([at for at in range(packed) if at not in diagonal], limits):
        limit = limits[group[0]]
        most = precision.literal(_rounded_down(limit / (2 * len(group))))
        least = precision.literal(-_rounded_down(limit / 2))
        clauses += [_true(f"{_element(at, array)} <= {most}") for at in group]
        clauses.append(_true(f"{_sum(group, array)} >= {least}"))
    what = "a covariance is within its" if array == "covariance" else "factors are within their"
    return [
        "",
        f"/* Whether {what} bounds beyond doubt. Elements that are small, and whose sum is not far below",
        " * zero, are not far below zero themselves. False for NaN. */",
        f"static bool {prefix}_is_bounded(const {real} {array}[{packed}])",
        "{",
        f"    return {clauses[0]}",
        *[line for clause in clauses[1:-1] for line in wrap_line(f"&& {clause}", " " * 11)],
        *wrap_line(f"&& {clauses[-1]};", " " * 11),
        "}",
    ]


_LONGEST_SUM = 8


def certain_factors(hold: HoldFactors) -> tuple[float, ...]:
    """Return limits of packed factors, each for the elements of its group, under which `HoldFactors` changes nothing."""
    most, total = hold.certain()
    groups = -(-hold.size // _LONGEST_SUM)
    own = iter(hold.limits())
    return tuple(min(next(own), total / groups if i == j else most) for i, j in hold.layout.pairs)


def _groups(elements: list[int], limits: tuple[float, ...]) -> list[list[int]]:
    """Return elements of the same limit in groups: short ones, so that all their values fit into registers."""
    by_limit: dict[float, list[int]] = {}
    for at in elements:
        by_limit.setdefault(limits[at], []).append(at)
    return [
        own[start : start + _LONGEST_SUM] for own in by_limit.values() for start in range(0, len(own), _LONGEST_SUM)
    ]


def _element(at: int, array: str) -> str:
    return f"{array}[{at}]"


def _true(text: str) -> str:
    return f"(({text}) == true)"


def _sum(group: list[int], array: str) -> str:
    text = _element(group[0], array)
    for k, at in enumerate(group[1:], start=1):
        text = f"{text} + {_element(at, array)}" if k == 1 else f"({text}) + {_element(at, array)}"
    return f"({text})" if len(group) > 1 else text


def _rounded_down(value: float) -> float:
    """Return the positive number with two digits that is not above `value`."""
    power = math.floor(math.log10(value)) - 1
    return float(f"{math.floor(value / 10.0**power)}e{power}")
