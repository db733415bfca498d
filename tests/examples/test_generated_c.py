"""What lies under generated_c/ is what the generator gives now, byte for byte."""

from pathlib import Path

import pytest
from plantc.codegen.package import MEASURED, build_files

from plantc.regenerate import EXAMPLES

FOLDER = Path(__file__).resolve().parents[2] / "generated_c"


@pytest.mark.parametrize(
    ("block", "precision"), EXAMPLES, ids=[f"{block.name}-{precision}" for block, precision in EXAMPLES]
)
def test_regenerating_gives_the_same_bytes(block, precision):
    files = build_files(block, precision)
    folder = FOLDER / block.name
    lying = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert lying - MEASURED == set(files), "run python -m plantc.regenerate"
    for name, text in files.items():
        assert (folder / name).read_text() == text, f"{name} differs: run python -m plantc.regenerate"


def test_nothing_else_lies_there():
    assert {path.name for path in FOLDER.iterdir()} == {"proofs.json", *(block.name for block, _ in EXAMPLES)}
