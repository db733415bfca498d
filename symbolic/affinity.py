"""Whether an expression is affine: its derivative does not tell, since a jump has the derivative zero."""

from __future__ import annotations

import math

import casadi as ca

from .expressions import KINKS, Step, Tape, tape


def kink_in(expression: ca.SX, moving: ca.SX, *, but_turns: bool = False) -> str:
    """Return an operation on some symbols that jumps or has a kink, or an empty string.

    An expression is affine in them if its derivative does not depend on them *and* there is none: `sign`, `floor` and a
    branch with constant values have a derivative of zero wherever they have one.

    Parameters
    ----------
    expression : casadi.SX
        A column.
    moving : casadi.SX
        The symbols.
    but_turns : bool
        Whether whole turns do not count, 2 pi times `floor` of something: an angle that is wrapped is linear but for them.

    Returns
    -------
    str
        The name of the operation, in the words of the user.
    """
    names = {item.name(): item for item in ca.symvar(moving)}
    symbols = ca.symvar(expression)
    moves = [item.name() in names and bool(ca.depends_on(moving, item)) for item in symbols]
    record = tape(ca.Function("affine", symbols, [ca.densify(expression)]))
    turns = _whole_turns(record) if but_turns else set()
    depends: list[bool] = []
    for k, step in enumerate(record.steps):
        if step.operation == "input":
            depends.append(moves[step.place[0]])
            continue
        turned = [depends[item] for item in step.arguments]
        # what a condition lets through may move; the condition may not
        if k in turns:
            depends.append(False)
            continue
        if step.operation in KINKS and (turned[0] if step.operation == "if_else_zero" else any(turned)):
            return _WORDS.get(step.operation, step.operation)
        depends.append(any(turned))
    return ""


def _whole_turns(record: Tape) -> set[int]:
    """Return the steps that are `floor` of something, of which nothing is used but 2 pi times it."""
    used: dict[int, list[Step]] = {k: [] for k, step in enumerate(record.steps) if step.operation == "floor"}
    for step in record.steps:
        for item in step.arguments:
            if item in used:
                used[item].append(step)
    given = {item for output in record.outputs for item in output}

    def is_turn(step: Step) -> bool:
        factors = [record.steps[item] for item in step.arguments]
        return step.operation == "mul" and any(
            item.operation == "const" and abs(item.value) == 2 * math.pi for item in factors
        )

    return {k for k, steps in used.items() if steps and k not in given and all(map(is_turn, steps))}


_WORDS = dict.fromkeys(("lt", "le", "eq", "ne", "if_else_zero"), "a comparison")
