"""Rewrites `generated_c/` from the examples: `python -m plantc.regenerate`, in a checkout.

Every example is measured on all targets whose tools are installed; those that are missing are named.
"""

from __future__ import annotations

import sys
from pathlib import Path

from .codegen import export
from .codegen.options import Options
from .codegen.style import Precision
from .codegen.targets import TARGETS, installed_targets
from .examples.attitude_ekf import attitude_ekf
from .examples.pendulum import pendulum_ekf
from .examples.quadrotor_ekf import quadrotor_ekf, quadrotor_kf
from .examples.quadrotor_ud import quadrotor_ud
from .symbolic import Block

EXAMPLES: list[tuple[Block, str]] = [
    (pendulum_ekf, "float"),
    (quadrotor_ekf, "double"),
    (quadrotor_kf, "double"),
    (attitude_ekf, "float"),
    (quadrotor_ud, "float"),
]
"""Block and precision of everything under `generated_c/`."""


def main() -> None:
    """Export every example."""
    folder = Path("generated_c")
    if not folder.is_dir():
        sys.exit("there is no generated_c here; run this at the top of a checkout of plantc")
    targets = installed_targets()
    for name in TARGETS:
        if name not in targets:
            print(f"not measured on {name}: its compiler or emulator is not installed")
    for block, precision in EXAMPLES:
        done = export(block, folder, options=Options(Precision(precision), targets, tables=True), force=True)
        print(f"{done.folder}: {len(done.files)} files, model {block.model_hash()}")


if __name__ == "__main__":
    main()
