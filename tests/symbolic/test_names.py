"""Names that may not become C identifiers are refused where they are given, with a name to take instead."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plantc.codegen import emit
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block, ModelError, Plant
from plantc.symbolic.names import check_name, check_unique, why_not_a_name

REASONS = {
    "keyword": ["int", "double", "class", "template", "constexpr", "namespace", "restrict", "and", "bool", "this"],
    "reserved": ["_x", "__x", "a__b", "_Bool", "trailing__"],
    "macro": ["PI", "F", "B1", "B00000001", "E", "I", "M_PI", "NULL", "min", "max", "round", "HIGH", "errno", "NAN"],
    "identifier": ["1x", "a b", "a-b", "a.b", "x[0]", "größe", "a;b", "x\n"],
    "function": ["sin", "sqrt", "atan2", "main", "floor"],
    "generated C uses": ["out", "params", "state", "status"],
    "standard C headers": ["INT_MAX", "DBL_EPSILON", "FE_DIVBYZERO", "EXIT_FAILURE", "uint32_t", "size_t", "va_arg"],
    "trailing underscore": ["float_", "x_"],
    "longer than 48": ["a" * 49],
    "not a word": ["", None, 3],
}
CASES = [(reason, name) for reason, names in REASONS.items() for name in names]


def proposal_of(message):
    return re.search(r"call it '([^']+)', say", message).group(1)


@pytest.mark.parametrize(("reason", "name"), CASES)
def test_refused_with_the_reason_and_a_name_that_is_accepted(reason, name):
    with pytest.raises(ModelError, match=reason) as caught:
        check_name("state", name, "cart")
    assert repr(name) in str(caught.value)
    assert str(caught.value).startswith("cart: the state name ")
    assert why_not_a_name(proposal_of(str(caught.value))) is None


@pytest.mark.parametrize(
    ("kind", "name", "reason"),
    [
        *(("block", name, "hides <") for name in ("math", "string", "stdbool", "Math", "fenv", "time")),
        *(("block", name, "files of its own") for name in ("test_vectors", "fan_main")),
        *(("block", name, "once more") for name in ("fe", "x")),
        *(("entry", name, "type or a function of its own") for name in (
            "model", "status_text", "init_core", "status_t", "state_t", "math_sin", "higher", "GATED", "H", "is_held"
        )),
    ],
)  # fmt: skip
def test_names_that_would_break_the_build_as_a_block_or_an_entry(kind, name, reason):
    assert kind != "block" or why_not_a_name(name) is None, "as a signal it is good"
    with pytest.raises(ModelError, match=reason) as caught:
        check_name(kind, name, "cart")
    assert why_not_a_name(proposal_of(str(caught.value)), kind) is None


def test_entries_and_parts_of_one_name_in_the_c():
    def gain(name, entry):
        block = Block(name)
        u = block.input("u", range=(-1, 1))
        block.entry(entry, inputs=[u], outputs={"y": 2 * u})
        return block

    block = gain("pair", "a_step")
    block.parts["a"] = gain("a", "step")
    with pytest.raises(ModelError, match=r"pair: .*entry 'step' of part 'a'.* both be called 'a_step'"):
        block.check()


def test_the_emitter_names_nothing_that_an_entry_may_be_called():
    """All that the C of a filter defines at file scope is an entry's, or is refused as an entry's name."""
    text = emit(pendulum_ekf, "double")
    found = set(re.findall(r"\bpendulum_ekf_(\w+)(?= ?\()", text.source)) | set(
        re.findall(r"} pendulum_ekf_(\w+);", text.header)
    )
    own = {f"{name}{end}" for name in pendulum_ekf.entries for end in ("", "_core", "_in_t", "_out_t")}
    assert {"model", "status_text", "higher", "state_t"} <= found
    assert [name for name in sorted(found - own) if why_not_a_name(name, "entry") is None] == []


@pytest.mark.parametrize("name", ["x", "theta", "B", "B2", "B101010101", "Pi", "f", "ii", "a" * 48, "x_1", "Sin", "e"])
def test_accepted(name):
    assert check_name("state", name, "cart") == name


@pytest.mark.parametrize("kind", ["state", "memory field", "parameter"])
@settings(max_examples=200, deadline=None, derandomize=True)
@given(name=st.text(max_size=60))
def test_a_proposal_can_always_be_taken(kind, name):
    if why_not_a_name(name) is None:
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name)
        assert "__" not in name
        return
    with pytest.raises(ModelError) as caught:
        check_name(kind, name, "cart")
    proposed = proposal_of(str(caught.value).replace(repr(name), ""))
    assert why_not_a_name(proposed) is None
    assert proposed != name


def test_every_kind_of_signal_has_its_name_checked():
    plant = Plant("cart")
    x = plant.state("x")
    plant.dynamics({x: 0})
    attempts = [
        lambda: Plant("for"),
        lambda: plant.input("PI"),
        lambda: plant.parameter("F", 1.0),
        lambda: plant.constant("B1", 1.0),
        lambda: plant.noise("_w", density=1.0),
        lambda: plant.sensor("int", x, variance=1.0),
        lambda: Plant("other").state("double"),
        lambda: Plant("other").attitude("sin"),
    ]
    for attempt in attempts:
        with pytest.raises(ModelError, match="call it"):
            attempt()


def test_two_things_of_one_name():
    check_unique([("a", "the input 'a'"), ("b", "the input 'b'")], "cart")
    with pytest.raises(ModelError, match=r"cart: the parameter 'p' and the noise of 'w' would both be called 'a'"):
        check_unique([("a", "the noise of 'w'"), ("a", "the parameter 'p'")], "cart")
