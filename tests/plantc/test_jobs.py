"""Blocks of a model exported side by side: in their order, and none lost for another's fault."""

import json

import pytest

MODEL = """
from plantc import Block

def gain(name, factor):
    block = Block(name)
    u = block.input("u", range=(-1, 1))
    block.entry("step", inputs=[u], outputs={"y": factor * u}, output_ranges={"y": (-1e3, 1e3)})
    return block

second = gain("second", 2.0)
first = gain("first", 3.0)
"""

BROKEN = (
    MODEL
    + """
class Wrong:
    def call(self, entry, memory, inputs, params, precision=float):
        import numpy as np
        return 0, {}, {} if entry == "init" else {"y": np.array([7.0])}

first.oracle = Wrong()
"""
)


@pytest.fixture
def at(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
def test_blocks_side_by_side_are_told_in_their_order(at, plantc):
    (at / "two.py").write_text(MODEL)
    said = plantc("export", "two.py", "--jobs", "2", "--steps", "20", "--no-cache", "--json")
    assert said.status == 0, said.err
    told = json.loads(said.out)
    assert [item["name"] for item in told["blocks"]] == ["second", "first"]
    assert said.err.index("second: model") < said.err.index("first: model")
    for name in ("first", "second"):
        assert (at / "generated_c" / name / "manifest.json").is_file()


@pytest.mark.slow
def test_a_block_that_fails_does_not_lose_the_other(at, plantc):
    (at / "two.py").write_text(BROKEN)
    said = plantc("export", "two.py", "--jobs", "2", "--steps", "20", "--no-cache", "--json")
    assert said.status == 1
    assert [item["name"] for item in json.loads(said.out)["blocks"]] == ["second"]
    assert "first: the check" in said.summary
    assert "1 of 2 blocks were exported" in said.summary
    assert not (at / "generated_c" / "first").exists()
