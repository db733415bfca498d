"""The elementary functions that plantc emits itself: the same bits on every machine.

A C library's `sin` differs in its last bits from another's, and between the targets of one. So the generated C brings
its own, as static functions with the block's prefix, of + - * /, square roots, comparisons and exact conversions only.
The coefficients are those of polynomials through Chebyshev nodes; benchmarks/mathematics_coefficients.py derives them,
and a test derives them again.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..symbolic.errors import ModelError
from .style import WIDTH, Precision, wrap_line

EXACT = frozenset({"sqrt", "fabs", "floor", "ceil"})
"""Functions of <math.h> whose result IEEE 754 fixes to the last bit: these are called as they are."""

CHOICES = ("own", "libm")
"""Whose mathematics the C may call: plantc's own, or the C library's."""

LIMITS = {"float": 2.0**30, "double": 2.0**24}
"""The largest |x| that sin, cos and tan take; beyond it they give NaN."""

ERROR_BOUNDS: dict[str, dict[str, float]] = {
    "float": {
        "sin": 1.5, "cos": 1.5, "tan": 1.5, "asin": 1.2, "acos": 1.2, "atan": 1.5, "atan2": 1.6, "exp": 1.1, "log": 1.0,
        "pow": 1.1, "tanh": 1.6, "sinh": 1.7, "cosh": 1.6,
    },
    "double": {
        "sin": 1.3, "cos": 1.3, "tan": 1.3, "asin": 1.2, "acos": 1.2, "atan": 1.5, "atan2": 1.6, "exp": 1.1, "log": 1.0,
        "pow": 1.1, "tanh": 1.6, "sinh": 1.7, "cosh": 1.6,
    },
}  # fmt: skip
"""The largest error of each function, in units in the last place of the true value."""

_NEEDS = {
    "sin": ("sin_series", "cos_series", "reduce", "turned"),
    "cos": ("sin_series", "cos_series", "reduce", "turned"),
    "tan": ("tan_series", "reduce"),
    "asin": ("asin_series",),
    "acos": ("asin_series",),
    "atan": ("atan_series",),
    "atan2": ("atan_series", "is_negative"),
    "exp": ("exp_series", "scaled"),
    "log": ("log_series", "normalised"),
    "pow": ("pow_log_series", "normalised", "exp_series", "scaled", "is_negative"),
    "tanh": ("tanh_series", "exp_series", "scaled"),
    "sinh": ("sinh_series", "exp_series", "scaled"),
    "cosh": ("exp_series", "scaled"),
}
"""What each function needs beside itself."""

OWN = frozenset(_NEEDS)
"""Functions that have a body of ours."""

_NOTES = {
    "sin": "for |x| <= {limit}; NaN beyond, and for infinities and NaN.",
    "cos": "for |x| <= {limit}; NaN beyond, and for infinities and NaN.",
    "tan": "for |x| <= {limit}; NaN beyond, and for infinities and NaN.",
    "asin": "NaN outside -1 .. 1.",
    "acos": "NaN outside -1 .. 1.",
    "atan": "for every x, infinities too; NaN gives NaN.",
    "exp": "infinity where it overflows, 0 where it underflows; NaN gives NaN.",
    "log": "-infinity of 0, NaN of negative numbers and of NaN.",
    "pow": "special cases as C99 says: pow(x, 0) = pow(1, y) = 1, NaN for negative x and y no integer.",
    "tanh": "for every x; NaN gives NaN.",
    "sinh": "infinity where it overflows; NaN gives NaN.",
    "cosh": "infinity where it overflows; NaN gives NaN.",
    "atan2": "signed zeros and infinities as C99 says; NaN gives NaN.",
}

COEFFICIENTS: dict[str, dict[str, tuple[float, ...]]] = {
    "float": {
        "sin": (
            -0.16666667,
            0.008333332,
            -0.00019840087,
            2.7249926e-06,
        ),
        "cos": (
            0.041666664,
            -0.0013888302,
            2.4547942e-05,
        ),
        "tan": (
            0.33333334,
            0.13333343,
            0.053965017,
            0.021910677,
            0.008609249,
            0.0044253157,
            3.364407e-11,
            0.0017892512,
        ),
        "asin": (
            0.16666666,
            0.07500094,
            0.044599403,
            0.031100662,
            0.017149238,
            0.033690847,
        ),
        "atan": (
            -0.33333334,
            0.19999875,
            -0.142798,
            0.110068806,
            -0.08235506,
            0.04225686,
        ),
        "exp": (
            0.5,
            0.16666667,
            0.041666467,
            0.0083333105,
            0.0013933642,
            0.00019890981,
        ),
        "log": (
            0.66666687,
            0.3998878,
            0.2957995,
        ),
        "tanh": (
            -0.33333334,
            0.13333324,
            -0.0539647,
            0.02181845,
            -0.008526333,
            0.0025263906,
        ),
        "sinh": (
            0.16666667,
            0.008333339,
            0.00019838102,
            2.8062802e-06,
        ),
        "pow_log": (
            0.6666667,
            0.4001429,
        ),
    },
    "double": {
        "sin": (
            -0.16666666666666666,
            0.008333333333333331,
            -0.00019841269841265065,
            2.7557319219339167e-06,
            -2.5052106232447578e-08,
            1.6058531618986147e-10,
            -7.586697117706918e-13,
        ),
        "cos": (
            0.041666666666666664,
            -0.0013888888888887398,
            2.480158729876569e-05,
            -2.7557317271729793e-07,
            2.08761462684032e-09,
            -1.1382632425521717e-11,
        ),
        "tan": (
            0.3333333333333333,
            0.13333333333333,
            0.05396825396865546,
            0.02186948851707438,
            0.008863236003485818,
            0.0035921209805615966,
            0.0014559027390503058,
            0.0005895756061544555,
            0.000241226353512688,
            8.998520298342289e-05,
            5.558784710570148e-05,
            -1.1013613221811344e-05,
            3.651618193613342e-05,
            -1.83153428020867e-05,
            8.48334725267473e-06,
        ),
        "asin": (
            0.16666666666666669,
            0.07499999999998433,
            0.04464285714635543,
            0.030381944138531247,
            0.02237217294214989,
            0.017352392720869973,
            0.013971212973552933,
            0.011479177415184906,
            0.01032281435018578,
            0.005457506718640358,
            0.01740087944269402,
            -0.014851887071247204,
            0.028757851367421566,
        ),
        "atan": (
            -0.3333333333333333,
            0.19999999999999488,
            -0.14285714285599188,
            0.11111111100917376,
            -0.09090908620322523,
            0.07692294712540285,
            -0.06666435677235948,
            0.05879578429582425,
            -0.05240099507994713,
            0.04628024868570153,
            -0.03806653672057366,
            0.025006503566489507,
            -0.009215792047089858,
        ),
        "exp": (
            0.5,
            0.16666666666666666,
            0.04166666666666668,
            0.008333333333333333,
            0.0013888888888879082,
            0.00019841269841263304,
            2.480158733642132e-05,
            2.755731924720479e-06,
            2.755726330147475e-07,
            2.5052071109214447e-08,
            2.0918129454967065e-09,
            1.6086622436215554e-10,
        ),
        "log": (
            0.666666666666667,
            0.39999999999899505,
            0.28571428625975487,
            0.2222221113479508,
            0.18182889125261723,
            0.15331721600556042,
            0.14616449685043406,
        ),
        "tanh": (
            -0.3333333333333333,
            0.13333333333332714,
            -0.053968253967434016,
            0.021869488493666944,
            -0.008863234397814355,
            0.003592110378689024,
            -0.001455661830100716,
            0.0005889360520074057,
            -0.0002346347410887237,
            8.511313685577672e-05,
            -2.060276537636634e-05,
        ),
        "sinh": (
            0.16666666666666666,
            0.008333333333333299,
            0.00019841269841324198,
            2.7557319191381816e-06,
            2.5052117695907823e-08,
            1.6057679623801638e-10,
            7.746178593018827e-13,
        ),
        "pow_log": (
            0.6666666666666666,
            0.40000000000568653,
            0.2857142288528101,
            0.222404146227464,
        ),
    },
}
"""Precision -> correction -> coefficients, constant first; what each corrects is said in the template."""

CONSTANTS: dict[str, dict[str, tuple[Any, ...]]] = {
    "float": {
        "pi_half": (1.5703125, 0.0004838268),
        "pi_multiples": (
            (0.0, 0.0),
            (0.7853982, -2.1855694e-08),
            (1.5707964, -4.371139e-08),
            (2.3561945, -5.9624403e-09),
            (3.1415927, -8.742278e-08),
        ),
        "ln2": (0.69311523, 3.1946183e-05),
        "sixteenths": (
            (-0.37469345, 3.8705097e-09),
            (-0.2876821, 1.37775436e-08),
            (-0.20763937, 1.6100764e-09),
            (-0.13353139, -1.0038866e-09),
            (-0.06453852, 2.4172309e-09),
            (0.0, 0.0),
            (0.06062462, 7.905942e-12),
            (0.11778303, 3.2986907e-09),
            (0.17185026, -7.145759e-09),
            (0.22314355, 3.5408485e-09),
            (0.2719337, 1.0869003e-08),
            (0.31845373, 1.9658553e-09),
            (0.3629055, -8.629968e-09),
        ),
    },
    "double": {
        "pi_half": (1.570796325802803, 9.920935774287987e-10, 2.2517417706346578e-18, 3.5215598651832e-27),
        "pi_multiples": (
            (0.0, 0.0),
            (0.7853981633974483, 3.061616997868383e-17),
            (1.5707963267948966, 6.123233995736766e-17),
            (2.356194490192345, 9.184850993605148e-17),
            (3.141592653589793, 1.2246467991473532e-16),
        ),
        "ln2": (0.6931471805592082, 7.371002565167799e-13),
        "sixteenths": (
            (-0.3746934494414107, 3.9243112288632396e-18),
            (-0.2876820724517809, -2.607160616442564e-17),
            (-0.2076393647782445, -1.2053243216686129e-17),
            (-0.13353139262452263, 3.664457663660085e-18),
            (-0.06453852113757118, 6.470486661692933e-18),
            (0.0, 0.0),
            (0.06062462181643484, 2.6424025938726934e-18),
            (0.11778303565638346, -1.1971685747593677e-18),
            (0.17185025692665923, -6.0224538210113705e-18),
            (0.22314355131420976, -9.091270597324799e-18),
            (0.27193371548364176, 7.83319637697442e-19),
            (0.3184537311185346, 2.7114779367326236e-17),
            (0.3629054936893685, -2.1492361455310972e-17),
        ),
    },
}
"""Precision -> other numbers: parts of pi/2 and of ln 2, all but the last short, so that products with a small integer are
exact; multiples of pi/4 and the logarithms of 11/16 .. 23/16: the nearest number, and what is missing."""


def mathematics_name(prefix: str, function: str) -> str:
    """Return the name of an own function in the C of a block."""
    return f"{prefix}_math_{function}"


def mathematics_note(precision: Precision, functions: Iterable[str], mathematics: str) -> str:
    """Return the sentence of the header that says whose mathematics the C calls; empty where it calls none."""
    names = sorted(functions)
    if not names:
        return ""
    if mathematics == "libm":
        return (
            f"Mathematics: {', '.join(names)} of the C library. Its last bits differ from one library to another, and so "
            "do the results."
        )
    bounds = ERROR_BOUNDS[precision.name]
    listed = ", ".join(f"{name} ({bounds[name]:g} ulp)" for name in names)
    return (
        f"Mathematics: plantc's own, in the source; largest errors: {listed}. The same bits on every machine if built "
        "with -ffp-contract=off."
    )


def mathematics_text(prefix: str, precision: Precision, functions: Iterable[str]) -> str:
    """Return the C of the own functions named, and of what they need.

    Parameters
    ----------
    prefix : str
        Of every name.
    precision : Precision
        Of every number.
    functions : iterable of str
        Names as in <math.h>, without the f of single precision.

    Raises
    ------
    ModelError
        If a function has no body of ours.
    """
    from .emit import templates

    wanted = set(functions)
    unknown = sorted(wanted - OWN)
    if unknown:
        raise ModelError(
            f"plantc has no {', '.join(unknown)} of its own; rewrite it with {', '.join(sorted(OWN | EXACT))}, "
            'or export with mathematics="libm"'
        )
    if not wanted:
        return ""
    needed = wanted.union(*(_NEEDS[name] for name in wanted))
    kind = precision.name
    info = np.finfo(precision.dtype)
    limit = f"{LIMITS[kind]:.0f}"
    context: dict[str, Any] = {
        "p": f"{prefix}_math",
        "real": kind,
        "f": "f" if precision.is_float else "",
        "is_float": precision.is_float,
        "c": precision.literal,
        "needed": needed.__contains__,
        "coefficients": COEFFICIENTS[kind],
        **CONSTANTS[kind],
        "two_over_pi": 2.0 / math.pi,
        "per_ln2": 1.0 / math.log(2.0),
        "most": 89.0 if precision.is_float else 710.0,
        "least": -104.0 if precision.is_float else -746.0,
        "flat": 10.0 if precision.is_float else 22.0,
        "fine": range(16 if precision.is_float else 32),
        "coarse": range(5 if precision.is_float else 17),
        "top": 64 if precision.is_float else 512,
        "splitter": 4097.0 if precision.is_float else 134217729.0,
        "smallest": float(info.smallest_normal),
        "infinity": "INFINITY" if precision.is_float else "(double)INFINITY",
        "limit": LIMITS[kind],
        "limit_text": limit,
        "tiny": 2.0**-13 if precision.is_float else 2.0**-27,
        "largest": float(info.max),
        "huge": float(info.max) / 4,
        "nan": "NAN" if precision.is_float else "(double)NAN",
        "bounds": {name: f"{ERROR_BOUNDS[kind][name]:g}" for name in wanted},
        "notes": {name: _NOTES[name].format(limit=limit) for name in wanted},
    }
    text = templates().get_template("mathematics.c.j2").render(**context)
    return "\n".join(line for long in text.split("\n") for line in _narrow(long))


def _narrow(line: str) -> list[str]:
    """Break a line that a long prefix made too wide."""
    indent = line[: len(line) - len(line.lstrip())]
    return [line] if len(line) <= WIDTH else wrap_line(line.strip(), indent)
