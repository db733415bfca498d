"""What lies under generated_c/ is what the generator gives now, byte for byte."""

import hashlib
import json
from pathlib import Path

import pytest
from plantc.codegen.package import MEASURED, build_files

from plantc import emit
from plantc.regenerate import CONTROLLERS, EXAMPLES, REGULATORS

FOLDER = Path(__file__).resolve().parents[2] / "generated_c"

BY_C_ALONE = {
    "quadrotor_kf_controller",
    "quadrotor_ekf_controller",
    "quadrotor_regulator",
    "quadrotor_together_regulator",
    "quadrotor_steady_regulator",
}
"""CI's time is short, and choosing vectors is what takes it: of these the C is written anew, and the rest is as exported."""

WHOLE = [(block, precision) for block, precision in EXAMPLES if block.name not in BY_C_ALONE]


@pytest.mark.slow
@pytest.mark.parametrize(("block", "precision"), WHOLE, ids=[f"{block.name}-{precision}" for block, precision in WHOLE])
def test_regenerating_gives_the_same_bytes(block, precision):
    files = build_files(block, precision)
    folder = FOLDER / block.name
    lying = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert lying - MEASURED == set(files), "run python -m plantc.regenerate"
    for name, text in files.items():
        assert (folder / name).read_text() == text, f"{name} differs: run python -m plantc.regenerate"


@pytest.mark.parametrize("name", sorted(BY_C_ALONE))
def test_the_c_is_what_the_model_gives(name):
    block, precision = next(item for item in EXAMPLES if item[0].name == name)
    text, folder = emit(block, precision), FOLDER / name
    assert (folder / f"src/{name}.h").read_text() == text.header, "run python -m plantc.regenerate"
    assert (folder / f"src/{name}.c").read_text() == text.source, "run python -m plantc.regenerate"
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["model"] == block.model_hash()
    lying = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    assert lying.keys() - MEASURED - {"manifest.json"} == manifest["files"].keys()
    for file, digest in manifest["files"].items():
        assert hashlib.sha256(lying[file].read_bytes()).hexdigest() == digest, f"{file} was changed after the export"


def test_nothing_else_lies_there():
    assert {path.name for path in FOLDER.iterdir()} == {"proofs.json", *(block.name for block, _ in EXAMPLES)}


def row(name):
    """A line of a table in the docs, from what export measured."""
    evidence = json.loads((FOLDER / name / "evidence.json").read_text())
    targets = [evidence["targets"][target] for target in ("cortex-m4", "cortex-m7", "rv32")]
    assert all(target["free_run"]["equal_to_host"] for target in targets)
    worst = next(check["worst"] for check in evidence["checks"] if check["name"] == "float = double")
    m4 = targets[0]
    sizes = [m4["instruction_bound"]["step"], m4["stack_bound"]["step"], m4["object"]["text"], evidence["memory_bytes"]]
    seen = [target["instructions"]["step"] for target in targets]
    return f"| `{name}` | {' | '.join(map(str, seen + sizes))} | {worst:.1e} |"


@pytest.mark.parametrize(("page", "blocks"), [("controllers", CONTROLLERS), ("regulation", REGULATORS)])
def test_the_page_says_what_was_measured(page, blocks):
    rows = "\n".join(row(block.name) for block, _ in blocks)
    assert rows in (FOLDER.parent / f"docs/{page}.md").read_text(), f"the table should be:\n{rows}"
