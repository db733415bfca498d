"""Literals round-trip and are short; lines are not long."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plantc.codegen import emit
from plantc.codegen.style import WIDTH, Precision, comment_lines, wrap_line
from plantc.symbolic import Block, ModelError


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_double_literal_reads_back_exactly(value):
    text = Precision("double").literal(value)
    assert float(text) == value
    assert "." in text
    assert not text.endswith("f")


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_a_float_literal_reads_back_exactly_and_is_marked(value):
    text = Precision("float").literal(value)
    assert text.endswith("f")
    assert np.float32(text[:-1]) == np.float32(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [(1e-8, "1.0e-8"), (0.1, "0.1"), (9.81, "9.81"), (-2.5, "-2.5"), (1e9, "1.0e9"), (125.0, "125.0"), (0.0, "0.0")],
)
def test_literals_are_written_as_a_person_would(value, text):
    assert Precision("double").literal(value) == text
    assert Precision("float").literal(value) == text + "f"


def test_what_does_not_fit_is_refused():
    with pytest.raises(OverflowError, match="single precision"):
        Precision("float").literal(1e300)
    for value in (1e-46, -1e-46, 2e-45, 1e-300):
        with pytest.raises(OverflowError, match=rf"{value!r} is too small for single precision"):
            Precision("float").literal(value)
    with pytest.raises(OverflowError, match="literal"):
        Precision("double").literal(float("nan"))
    with pytest.raises(ValueError, match="'half'"):
        Precision("half")


@given(st.lists(st.text("abc*/", min_size=1, max_size=30), min_size=1, max_size=60))
def test_lines_and_comments_keep_to_the_width(words):
    text = " ".join(words)
    assert all(len(line) <= WIDTH for line in wrap_line(text, "    "))
    comment = comment_lines(text, "    ")
    assert all(len(line) <= WIDTH for line in comment)
    inside = "\n".join(comment).strip().removeprefix("/*").removesuffix("*/")
    assert "*/" not in inside


def scaled(factor, **words):
    block = Block("scaled", doc=words.pop("doc", ""))
    u = block.input("u", range=(-1, 1), **words)
    block.entry("step", inputs=[u], outputs={"y": u * factor})
    return block


def test_a_constant_that_would_become_zero_is_a_sentence():
    assert "1.0e-46" in emit(scaled(1e-46), "double").source
    with pytest.raises(ModelError, match=r"scaled: the number 1e-46 is too small .* become 0; .*export in double"):
        emit(scaled(1e-46), "float")


@pytest.mark.parametrize("character", ["\u202e", "\u2066", "\u200f", "\0", "\x1b"])
@pytest.mark.parametrize("where", ["doc", "unit"])
def test_characters_that_hide_text_are_refused(character, where):
    code = f"U\\+{ord(character):04X}"
    with pytest.raises(ModelError, match=rf"holds the control character {code}.*; take it out"):
        emit(scaled(2.0, **{where: f"a {character}b"}), "double")
    block = Block("plain", doc=f"a {character}b")
    block.entry("step", outputs={"y": 1.0})
    with pytest.raises(ModelError, match=code):
        emit(block, "double")
    emit(scaled(2.0, **{where: "\u00e9 \u03b1\u00b2\n\u2028 \u05d0\u05d1 \U0001f600"}), "double")
