"""What piecewise functions and their derivatives cost: instructions of one step on Cortex-M4 and M7, beyond those of x itself.

`python benchmarks/piecewise.py` prints the table of docs/piecewise.md. The most that was seen of 300 calls, by QEMU.
"""

import casadi as ca
import numpy as np
from plantc.codegen.costs import read
from plantc.codegen.crosscheck import CrossCheck, make_probes, make_views
from plantc.codegen.emulator import TargetView
from plantc.codegen.on_target import free_trace, run_on_target
from plantc.codegen.targets import TARGETS
from plantc.symbolic import fabs, fmax, fmin, if_else
from plantc.symbolic.piecewise import dead_zone, look_up, maximum, minimum, relay, saturated

from plantc import Block, NativeView


def uneven(count):
    """Return a table of so many points that are not evenly spaced."""
    at = np.linspace(-3, 3, count) ** 3
    return at, np.tanh(at)


def even(count):
    """Return one whose points are."""
    at = np.linspace(-8, 8, count)
    return at, np.tanh(at)


FUNCTIONS = {
    "saturated(x, -1, 1)": lambda x: saturated(x, -1, 1),
    "fmin(fmax(x, -1), 1)": lambda x: fmin(fmax(x, -1), 1),
    "dead_zone(x, -1, 1)": lambda x: dead_zone(x, -1, 1),
    "relay(x, 2)": lambda x: relay(x, 2),
    "fabs(x)": fabs,
    "minimum(x, 1)": lambda x: minimum(x, 1),
    "maximum(x, 1)": lambda x: maximum(x, 1),
    "if_else(x < 1, x, 1)": lambda x: if_else(x < 1, x, 1),
    "look_up, 5 points": lambda x: look_up(x, *uneven(5)),
    "look_up, 17 points": lambda x: look_up(x, *uneven(17)),
    "look_up, 129 points": lambda x: look_up(x, *uneven(129)),
    "look_up, 5 even points": lambda x: look_up(x, *even(5)),
    "look_up, 129 even points": lambda x: look_up(x, *even(129)),
}
"""What is measured, of x in -20 .. 20."""


def instructions(make, target):
    """Return the most instructions that a step of y = make(x) + z was seen to take."""
    block = Block("cost")
    x, z = block.input("x", range=(-20, 20)), block.input("z", range=(-20, 20))
    block.entry("step", inputs=[x, z], following={}, outputs={"y": make(ca.SX(x)) + z})
    native = NativeView(block, "float")
    probes = make_probes(block, "float", make_views(block, "float", native), 150, 0)
    for probe in probes:
        probe.answer = native.call(probe.entry, probe.memory, probe.inputs, probe.params)
    view = TargetView(block, "float", TARGETS[target])
    found = run_on_target(view, native, CrossCheck([], {}, probes), native.run(free_trace(block, 150)))
    return read("instructions", found.facts)["step"].seen


def main():
    """Print the table."""
    targets = ("cortex-m4", "cortex-m7")
    plain = {target: instructions(lambda x: x, target) for target in targets}
    print(f"{'':28}{'value: M4':>12}{'M7':>6}{'slope: M4':>12}{'M7':>6}")
    for name, make in FUNCTIONS.items():
        row = []
        for of in (make, lambda x, make=make: ca.jacobian(make(x), x)):
            row += [instructions(of, target) - plain[target] for target in targets]
        print(f"{name:28}{row[0]:12}{row[1]:6}{row[2]:12}{row[3]:6}")


if __name__ == "__main__":
    main()
