"""Rewrites `generated_c/` from the examples: `python -m plantc.regenerate [--prove] [EXAMPLE ...]`, in a checkout.

Every example is measured on all targets whose tools are installed; those that are missing are named. With ``--prove`` the
examples are proved instead, and `generated_c/proofs.json` says what was: it takes minutes, and only for what has changed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .codegen import emit, export
from .codegen.folder import write_file
from .codegen.options import Options
from .codegen.proof_record import read_record, record_proof, record_text
from .codegen.style import Precision
from .codegen.targets import TARGETS, installed_targets
from .examples.attitude_ekf import attitude_ekf
from .examples.pendulum import pendulum_ekf
from .examples.quadrotor_controllers import (
    quadrotor_ekf_controller,
    quadrotor_jsse_controller,
    quadrotor_jssem_controller,
    quadrotor_kf_controller,
)
from .examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from .examples.quadrotor_regulator import (
    quadrotor_high_gain_regulator,
    quadrotor_regulator,
    quadrotor_steady_regulator,
    quadrotor_together_regulator,
)
from .examples.quadrotor_ud import quadrotor_ud
from .symbolic import Block

PARTS: list[tuple[Block, str]] = [
    (pendulum_ekf, "float"),
    (quadrotor_ekf, "double"),
    (quadrotor_kf, "double"),
    (attitude_ekf, "float"),
    (quadrotor_ud, "float"),
]
"""Block and precision of what CI also audits and proves: filters by themselves, all kernels among them."""

CONTROLLERS: list[tuple[Block, str]] = [
    (quadrotor_kf_controller, "float"),
    (quadrotor_ekf_controller, "float"),
    (quadrotor_jsse_controller, "float"),
    (quadrotor_jssem_controller, "float"),
]
"""Compositions of a filter and a feedback. CI looks for drift, and whether their proofs are on record; no audit."""

REGULATORS: list[tuple[Block, str]] = [
    (quadrotor_regulator, "float"),
    (quadrotor_together_regulator, "float"),
    (quadrotor_steady_regulator, "float"),
    (quadrotor_high_gain_regulator, "float"),
]
"""Observers of four references and a feedback: with a flag for each reading, with one for all, and two that are cheaper.

CI does with them what it does with controllers, and runs the second on every target."""

EXAMPLES = PARTS + CONTROLLERS + REGULATORS
"""Block and precision of everything under `generated_c/`."""


def main() -> None:
    """Export or prove every example, or those that are named."""
    parser = argparse.ArgumentParser(prog="python -m plantc.regenerate")
    parser.add_argument("examples", nargs="*", metavar="EXAMPLE", help="default: every one")
    parser.add_argument("--prove", action="store_true", help="prove what is not on record, instead of exporting")
    asked = parser.parse_args()
    unknown = set(asked.examples) - {block.name for block, _ in EXAMPLES}
    if unknown:
        sys.exit(
            f"no example is called {', '.join(sorted(unknown))}; there are {', '.join(b.name for b, _ in EXAMPLES)}"
        )
    folder = Path("generated_c")
    if not folder.is_dir():
        sys.exit("there is no generated_c here; run this at the top of a checkout of plantc")
    wanted = [(block, precision) for block, precision in EXAMPLES if not asked.examples or block.name in asked.examples]
    if asked.prove:
        _prove(folder / "proofs.json", wanted)
    else:
        _export(folder, wanted)


def _export(folder: Path, wanted: list[tuple[Block, str]]) -> None:
    targets = installed_targets()
    for name in TARGETS:
        if name not in targets:
            print(f"not measured on {name}: its compiler or emulator is not installed")
    for block, precision in wanted:
        done = export(block, folder, options=Options(Precision(precision), targets, tables=True), force=True)
        print(f"{done.folder}: {len(done.files)} files, model {block.model_hash()}")


def _prove(path: Path, wanted: list[tuple[Block, str]]) -> None:
    """Prove each example; what is proved is written down after each, and what is no example any more is dropped."""
    names = {block.name for block, _ in EXAMPLES}
    record = {name: item for name, item in read_record(path).items() if name in names}
    failed = []
    for block, precision in wanted:
        record[block.name], faults = record_proof(block, emit(block, precision), record)
        write_file(path, record_text(record))
        print(f"{block.name}: {len(record[block.name])} functions proved")
        failed += [f"{block.name}: {fault}" for fault in faults]
    if failed:
        sys.exit("\n".join(["not proved:", *failed]))


if __name__ == "__main__":
    main()
