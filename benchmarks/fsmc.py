"""What the autopilot of Ghanai 2018 costs in float on each target, whole and by parts, and that it is the same bits there."""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Collection
from typing import Any

from plantc.codegen.crosscheck import cross_check, make_views
from plantc.codegen.emit import emit
from plantc.codegen.on_target import measure_targets
from plantc.codegen.options import Options
from plantc.codegen.style import Precision
from plantc.codegen.views import NativeView
from plantc.examples.fsmc_autopilot import autopilot, control_law
from plantc.examples.fsmc_quadrotor import ekf, mixer

TARGETS = ("cortex-m4", "cortex-m7", "rv32")
STEPS = 20
"""Of the nominal trace; an export has 100."""


BLOCKS = {"autopilot": autopilot, "filter": ekf, "law": control_law, "mixer": mixer}


def measure(targets: tuple[str, ...] = TARGETS, which: Collection[str] = tuple(BLOCKS)) -> dict[str, Any]:
    """Return block -> what its `step` costs by target, from the calls of a cross-check and a free run."""
    blocks = {name: BLOCKS[name]() for name in which}
    options = Options(precision=Precision("float"), targets=targets)
    answer: dict[str, Any] = {}
    for name, block in blocks.items():
        text = emit(block, "float")
        check = cross_check(
            block, "float", steps=STEPS, views=make_views(block, "float", NativeView(block, "float", text=text))
        )
        found = measure_targets(block, options, text, check)
        failed = [item.name for item in (*check.failures, *[item for item in found.checks if not item.passed])]
        if failed:
            raise SystemExit(f"{name}: {', '.join(failed)} failed")
        rows = {}
        for target in targets:
            facts = found.facts["targets"][target]
            rows[target] = {
                "instructions": facts["instructions"]["step"],
                "instruction_bound": facts["instruction_bound"]["step"],
                "stack": facts["stack"]["step"],
                "stack_bound": facts["stack_bound"]["step"],
                "text": facts["object"]["text"],
                "linked": facts["linked"]["text"],
                "ram": facts["ram"]["needed"],
                "equal_to_host": facts["free_run"]["equal_to_host"],
            }
        answer[name] = rows
    return answer


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--m4", action="store_true", help="the autopilot on the Cortex-M4 only")
    arguments = parser.parse_args()
    for tool in ("gcc", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc", "qemu-system-arm", "qemu-system-riscv32"):
        if shutil.which(tool) is None:
            raise SystemExit(f"{tool} is missing; install it")
    found = measure(("cortex-m4",), which=("autopilot",)) if arguments.m4 else measure()
    if arguments.json:
        print(json.dumps(found))
        return
    print("| block | target | instructions | bound | stack | bound | text | linked | same bits as the host |")
    for name, rows in found.items():
        for target, row in rows.items():
            said = "yes" if row["equal_to_host"] else "no"
            cells = [
                row[key] for key in ("instructions", "instruction_bound", "stack", "stack_bound", "text", "linked")
            ]
            print(f"| {name} | {target} | {' | '.join(map(str, cells))} | {said} |")


if __name__ == "__main__":
    main()
