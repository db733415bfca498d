"""Derives the coefficients of plantc.codegen.mathematics: interpolation at Chebyshev nodes, in 60 digits.

Each function is a leading term that is exact in floating point and a correction, a smooth function g of z that a
polynomial stands for. The polynomial that meets g at the Chebyshev nodes of an interval is within a small factor of
the best one of its degree, and has no free choice in it: this file and the formula of g are all there is to check.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mpmath as mp
import numpy as np

mp.mp.dps = 60


def _odd(function: Callable[[mp.mpf], mp.mpf]) -> Callable[[mp.mpf], mp.mpf]:
    """Return g(z) = (function(x) - x) / x^3 with z = x^2."""

    def correction(z: mp.mpf) -> mp.mpf:
        x = mp.sqrt(z)
        return (function(x) - x) / (x * z)

    return correction


def _logarithm(z: mp.mpf) -> mp.mpf:
    """(2 atanh(s) - 2 s) / s^3 with z = s^2."""
    s = mp.sqrt(z)
    return (2 * mp.atanh(s) - 2 * s) / (s * z)


def _exponential(r: mp.mpf) -> mp.mpf:
    """(e^r - 1 - r) / r^2."""
    return (mp.exp(r) - 1 - r) / r**2 if abs(r) > mp.mpf("1e-30") else mp.mpf("0.5")


@dataclass(frozen=True)
class Correction:
    """A correction g, the interval it is needed on, and how many coefficients each precision takes."""

    g: Callable[[mp.mpf], mp.mpf]
    low: mp.mpf
    high: mp.mpf
    float_terms: int
    double_terms: int


CORRECTIONS = {
    "sin": Correction(_odd(mp.sin), mp.mpf(0), (mp.pi / 4) ** 2, 4, 7),
    "cos": Correction(lambda z: (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2, mp.mpf(0), (mp.pi / 4) ** 2, 3, 6),
    "tan": Correction(_odd(mp.tan), mp.mpf(0), (mp.pi / 4) ** 2, 8, 15),
    "asin": Correction(_odd(mp.asin), mp.mpf(0), mp.mpf("0.25"), 6, 13),
    "atan": Correction(_odd(mp.atan), mp.mpf(0), mp.mpf("0.25"), 6, 13),
    "exp": Correction(_exponential, -mp.log(2) / 2, mp.log(2) / 2, 6, 12),
    "log": Correction(_logarithm, mp.mpf(0), (3 - 2 * mp.sqrt(2)) ** 2, 3, 7),
    "tanh": Correction(_odd(mp.tanh), mp.mpf(0), mp.mpf("0.3025"), 6, 11),
    "sinh": Correction(_odd(mp.sinh), mp.mpf(0), mp.mpf(1), 4, 7),
    "pow_log": Correction(_logarithm, mp.mpf(0), mp.mpf(1) / 2000, 2, 4),
}


def polynomial(correction: Correction, terms: int) -> list[mp.mpf]:
    """Return the coefficients, constant first, of the polynomial that meets g at `terms` Chebyshev nodes."""
    middle, half = (correction.high + correction.low) / 2, (correction.high - correction.low) / 2
    nodes = [middle + half * mp.cos(mp.pi * (2 * k + 1) / (2 * terms)) for k in range(terms)]
    system = mp.matrix(terms, terms)
    for row, node in enumerate(nodes):
        for column in range(terms):
            system[row, column] = node**column
    solved = mp.lu_solve(system, mp.matrix([correction.g(node) for node in nodes]))
    return [solved[k] for k in range(terms)]


def rounded(value: mp.mpf, is_float: bool) -> float:
    """Return the nearest number of a precision."""
    # a float is written by the shortest decimal that reads back as it
    return float(str(np.float32(mp.nstr(value, 30)))) if is_float else float(value)


def parts(value: mp.mpf, bits: list[int]) -> list[float]:
    """Split a number into summands of so many bits each, the last one rounded to nearest."""
    answer, rest = [], value
    for count in bits:
        exponent = mp.floor(mp.log(abs(rest), 2))
        unit = mp.mpf(2) ** (exponent - count + 1)
        part = mp.nint(rest / unit) * unit if count == bits[-1] else mp.floor(rest / unit) * unit
        answer.append(float(part))
        rest -= part
    return answer


def coefficients() -> dict[str, dict[str, tuple[float, ...]]]:
    """Return precision -> name -> coefficients."""
    answer: dict[str, dict[str, tuple[float, ...]]] = {"float": {}, "double": {}}
    for name, correction in CORRECTIONS.items():
        for precision, terms in (("float", correction.float_terms), ("double", correction.double_terms)):
            values = polynomial(correction, terms)
            answer[precision][name] = tuple(rounded(value, precision == "float") for value in values)
    return answer


def constants() -> dict[str, dict[str, tuple[object, ...]]]:
    """Return precision -> name -> numbers that are no coefficients: parts of pi/2 and ln 2, nearest numbers and rests."""
    answer: dict[str, dict[str, tuple[object, ...]]] = {}
    for precision, quarter, natural in (("float", [12, 24], [14, 24]), ("double", [29, 29, 29, 53], [40, 53])):
        single = precision == "float"

        def pair(value: mp.mpf, single: bool = single) -> tuple[float, float]:
            near = rounded(value, single)
            exact = mp.mpf(float(np.float32(near))) if single else mp.mpf(near)
            return near, rounded(value - exact, single)

        answer[precision] = {
            "pi_half": tuple(rounded(mp.mpf(part), single) for part in parts(mp.pi / 2, quarter)),
            "pi_multiples": tuple(pair(k * mp.pi / 4) for k in range(5)),
            "ln2": tuple(rounded(mp.mpf(part), single) for part in parts(mp.log(2), natural)),
            "sixteenths": tuple(pair(mp.log(mp.mpf(k) / 16)) for k in range(11, 24)),
        }
    return answer


def _value(polynomial_of_z: list[mp.mpf], z: mp.mpf) -> mp.mpf:
    return sum(value * z**k for k, value in enumerate(polynomial_of_z))


def truncation(name: str, terms: int) -> float:
    """Return the largest |polynomial - g| on the interval, before the coefficients are rounded."""
    correction = CORRECTIONS[name]
    values = polynomial(correction, terms)
    worst = mp.mpf(0)
    for k in range(1, 400):
        z = correction.low + (correction.high - correction.low) * k / mp.mpf(400)
        if abs(z) > mp.mpf("1e-9"):
            worst = max(worst, abs(_value(values, z) - correction.g(z)))
    return float(worst)


def main() -> None:
    """Print the tables as they stand in plantc.codegen.mathematics."""
    for precision, table in coefficients().items():
        print(f'    "{precision}": {{')
        for name, values in table.items():
            print(f'        "{name}": (')
            for value in values:
                print(f"            {value!r},")
            print("        ),")
        print("    },")
    for precision, numbers in constants().items():
        print(f'    "{precision}": {{')
        for name, values in numbers.items():
            print(f'        "{name}": {values!r},')
        print("    },")


if __name__ == "__main__":
    main()
