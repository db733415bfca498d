"""Whether an expression is affine: its derivative does not tell, since a jump has the derivative zero."""

from __future__ import annotations

import casadi as ca

from .expressions import KINKS, tape


def kink_in(expression: ca.SX, moving: ca.SX) -> str:
    """Return an operation on some symbols that jumps or has a kink, or an empty string.

    An expression is affine in them if its derivative does not depend on them *and* there is none: `sign`, `floor` and a
    branch with constant values have a derivative of zero wherever they have one.

    Parameters
    ----------
    expression : casadi.SX
        A column.
    moving : casadi.SX
        The symbols.

    Returns
    -------
    str
        The name of the operation, in the words of the user.
    """
    names = {item.name(): item for item in ca.symvar(moving)}
    symbols = ca.symvar(expression)
    moves = [item.name() in names and bool(ca.depends_on(moving, item)) for item in symbols]
    record = tape(ca.Function("affine", symbols, [ca.densify(expression)]))
    depends: list[bool] = []
    for step in record.steps:
        if step.operation == "input":
            depends.append(moves[step.place[0]])
            continue
        turned = [depends[item] for item in step.arguments]
        # what a condition lets through may move; the condition may not
        if step.operation in KINKS and (turned[0] if step.operation == "if_else_zero" else any(turned)):
            return _WORDS.get(step.operation, step.operation)
        depends.append(any(turned))
    return ""


_WORDS = dict.fromkeys(("lt", "le", "eq", "ne", "if_else_zero"), "a comparison")
