"""Every line of the C has a parent, and a line without one is found."""

import importlib

import pytest
from plantc.codegen import writer
from plantc.codegen.emit import emit
from plantc.codegen.provenance import TracedLines, orphans
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic.origins import place_of_call


@pytest.mark.parametrize("precision", ["double", "float"])
def test_no_line_lacks_a_parent(shape, precision):
    text = emit(shape, precision)
    lines = text.source.split("\n")
    assert [lines[k - 1] for k in orphans(text.source, text.provenance)] == []
    covered = sum(last - first + 1 for first, last, _ in text.provenance.runs())
    assert covered > 0.5 * len(lines)
    assert {function for function, _, _ in text.provenance.functions} >= {
        f"{shape.name}_{entry}" for entry in shape.entries
    }


def test_a_line_written_without_a_parent_is_found(monkeypatch):
    def without(self, what):
        self.lines.parent = None
        return None

    monkeypatch.setattr(writer.CoreWriter, "_bookkeeping", without)
    text = emit(pendulum_ekf, "float")
    lost = {text.source.split("\n")[k - 1].strip() for k in orphans(text.source, text.provenance)}
    assert "return status;" in lost
    assert "pendulum_ekf_status_t status = PENDULUM_EKF_OK;" in lost


def test_a_helper_function_without_a_purpose_is_found(monkeypatch):
    def silent(prefix, *args):
        return ["", f"static int {prefix}_odd(void)", "{", "    return 1;", "}"]

    monkeypatch.setattr(importlib.import_module("plantc.codegen.emit"), "bounded_helper", silent)
    text = emit(pendulum_ekf, "float")
    assert [text.source.split("\n")[k - 1] for k in orphans(text.source, text.provenance)] == [
        "static int pendulum_ekf_odd(void)", "{", "    return 1;", "}",
    ]  # fmt: skip


def test_equations_lead_back_to_their_lines_of_the_model():
    parents = emit(pendulum_ekf, "float").provenance.parents
    dynamics = {parent.text.split(" ")[0]: parent.sources for parent in parents if parent.kind == "dynamics"}
    assert dynamics == {"theta'": ("pendulum.py:17",), "omega'": ("pendulum.py:18",)}
    assert {parent.sources for parent in parents if parent.kind == "sensor"} == {("pendulum.py:21",)}
    judged = next(parent for parent in parents if parent.entry == "predict" and "BAD_INPUT" in parent.text)
    assert judged.sources[0] == "pendulum.py:9"
    assert "-10 <= torque <= 10 N m" in judged.text


MODEL = """
from plantc.symbolic import Plant
from plantc.symbolic.estimators import extended_kalman_filter

plant = Plant("tank", dt=0.1)
level = plant.state("level", unit="m", range=(-5, 5))
leak = plant.noise("leak", variance=1e-4, unit="m")
plant.dynamics({level: 0.9 * level + leak})
plant.sensor("gauge", level, unit="m", variance=1e-2)
block = extended_kalman_filter(plant, initial_variance={level: 1.0})
"""


def test_the_hash_and_the_c_do_not_depend_on_line_numbers():
    made = []
    for text in (MODEL, "\n\n\n" + MODEL):
        names = {"__name__": "elsewhere"}
        exec(compile(text, "/some/where/tank.py", "exec"), names)
        made.append(names["block"])
    assert [block.source for block in made] == ["tank.py:10", "tank.py:13"]
    assert made[0].model_hash() == made[1].model_hash()
    assert emit(made[0]).source == emit(made[1]).source


def test_the_place_of_a_call_is_a_base_name():
    here = place_of_call()
    assert here.startswith("test_provenance.py:")
    assert "/" not in here


def test_lines_keep_the_parent_they_were_added_under():
    lines = TracedLines()
    lines.append("lost")
    lines += ["also lost"]
    assert [line.parent for line in lines] == [None, None]
