"""Figures: the same text for the same numbers, identifiers of their own, colours left to the page."""

import re
import subprocess
import sys

import numpy as np
import pytest
from plantc.codegen import figures

COUNTS = {"step": {"addition": 3, "multiplication": 4, "sinf": 1}, "init": {}}
DRAWN = {
    "operations": lambda: figures.operations(COUNTS),
    "grouped": lambda: figures.grouped({"m4": {"step": 10.0}}, {"m4": {"step": 12.0}}, "instructions"),
    "errors": lambda: figures.errors([{"name": "a = b", "worst": 0.0, "limit": 1e-9}]),
    "per_call": lambda: figures.per_call({"float": [0.0, 1e-5]}, 0.05),
    "statuses": lambda: figures.statuses({"OK": 3, "GATED": 1}),
    "memory": lambda: figures.memory({"x": (np.arange(3.0), np.ones(3), "m"), "y": (np.arange(3.0), None, "")}),
}


@pytest.mark.parametrize("name", DRAWN)
def test_a_figure_is_the_same_twice_and_belongs_to_the_page(name):
    first, second = (figures.svg_of(DRAWN[name](), f"figure-{name}", "A <title>", "What & why") for _ in range(2))
    assert first == second
    assert first.startswith(f'<svg id="figure-{name}"')
    assert "A &lt;title&gt;" in first
    assert "What &amp; why" in first
    assert not re.search(r"#[0-9a-f]{6}", first)
    assert "var(--c1)" in first
    assert all(item.startswith(f"figure-{name}") for item in re.findall(r'\bid="([^"]+)"', first))
    assert not re.search(r"20\d\d-\d\d-\d\d", first)


def test_what_has_no_operations_is_left_out():
    svg = figures.svg_of(figures.operations(COUNTS), "f", "t", "d")
    assert "step" in svg
    assert "init" not in svg
    assert "negation" not in svg


def test_a_bound_without_a_number_and_a_number_without_a_bound_are_drawn():
    rows, bounds = {"host": {}, "m4": {"step": 10.0}}, {"host": {"step": 12345.0}, "m4": {}}
    svg = figures.svg_of(figures.grouped(rows, bounds, "instructions"), "f", "t", "d")
    assert "≤ 12,345" in svg
    assert ">10<" in svg


def test_a_command_that_draws_nothing_does_not_import_matplotlib():
    """It takes longer than all else that the command line needs at its start."""
    code = "import sys, plantc.__main__; print([name for name in ('matplotlib', 'mpmath') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
