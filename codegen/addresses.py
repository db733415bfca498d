"""Fixed addresses in machine code: memory that is read or written at an address which the code itself states.

A register holds a known number from the instruction that loads it (not where the linker is to put an address there) up to
the next that writes it, and no further than the next label, jump or call. An access with such a register as its only
base, or without any base, is one to a fixed address.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from .objects import Image, Instruction

_X86_NAMES = {
    name: wide
    for wide, *names in (
        *(f"r{k}x e{k}x {k}x {k}l {k}h".split() for k in "abcd"),
        *(f"r{k} e{k} {k} {k}l".split() for k in ("si", "di", "bp", "sp")),
        *(f"r{k} r{k}d r{k}w r{k}b".split() for k in range(8, 16)),
    )
    for name in (wide, *names)
}
_NO_WRITE = re.compile(
    r"^(?:cmp|cmn|tst|teq|test|push|nop|(?:c\.)?s[bhw](?:sp)?$|(?:c\.)?f?s[bhwd](?:sp)?$|v?st[rm]|str|b|cb|ucomi)"
)


def fixed_addresses(image: Image) -> list[str]:
    """Return where the code of an object reads or writes memory at a fixed address, one sentence each."""
    items = list(image.instructions())
    labels = {item.target for item in items if item.kind == "jump" and isinstance(item.target, int)}
    access, load = {"x86-64": (_base_x86, _load_x86), "thumb": (_base, _load_thumb), "rv32": (_base, _load_riscv)}[
        image.machine
    ]
    known: dict[str, int] = {}
    faults = []
    for item in items:
        if item.address in labels or item.address in image.functions:
            known = {}
        found = None if image.is_relocated(item) else access(item, known)
        if found is not None:
            owner = image.function_at(item.address)
            faults.append(f"{item.mnemonic} at the address {found:#x} in {owner.name if owner else 'no function'}")
        known = {} if item.kind != "plain" else _after(image, item, known, load)
    return list(dict.fromkeys(faults))


def _after(
    image: Image,
    item: Instruction,
    known: Mapping[str, int],
    load: Callable[[Image, Instruction, Mapping[str, int]], int | None],
) -> dict[str, int]:
    """Return which registers hold known numbers after an instruction."""
    first = item.operands.split(",")[0].strip()
    first = _X86_NAMES.get(first, first)
    if _NO_WRITE.match(item.mnemonic) and "!" not in item.operands and "], " not in item.operands:
        return dict(known)
    value = None if item.conditional or image.is_relocated(item) else load(image, item, known)
    written = set(re.findall(r"\w+", first)) | set(re.findall(r"\[(\w+)\], |\[(\w+)[^\]]*\]!", item.operands) and known)
    if item.mnemonic.startswith(("ldrd", "ldm", "pop", "umull", "smull", "xchg", "mul", "div", "idiv", "imul", "rep")):
        written |= set(known)
    rest = {name: number for name, number in known.items() if name not in written}
    return rest if value is None else {**rest, first: value & (1 << (64 if image.machine == "x86-64" else 32)) - 1}


def _number(text: str) -> int | None:
    found = re.fullmatch(r"#?(-?(?:0x[0-9a-f]+|\d+))", text.strip())
    return int(found[1], 0) if found else None


# -- x86-64 -----------------------------------------------------------------------------------------------------------


def _base_x86(item: Instruction, known: Mapping[str, int]) -> int | None:
    if item.mnemonic in ("lea", "nop") or item.mnemonic.startswith("prefetch"):
        return None
    found = re.search(r"(\w\w:)?\[([^\]]*)\]", item.operands)
    if found is None or found[1] in ("fs:", "gs:"):  # those are of the thread: its stack's guard
        return None
    terms = found[2].replace("- ", "+ -").split(" + ")
    registers = [term for term in terms if _number(term.replace(" ", "")) is None]
    offset = sum(_number(term.replace(" ", "")) or 0 for term in terms)
    if not [term for term in registers if "*" not in term]:
        return offset
    return known[registers[0]] + offset if len(registers) == 1 and registers[0] in known else None


def _load_x86(image: Image, item: Instruction, known: Mapping[str, int]) -> int | None:
    words = item.operands.split(", ")
    return (
        _number(words[1]) if item.mnemonic in ("mov", "movabs") and len(words) == 2 and words[0] in _X86_NAMES else None
    )


# -- thumb and rv32 ---------------------------------------------------------------------------------------------------


def _base(item: Instruction, known: Mapping[str, int]) -> int | None:
    found = re.search(r"\[(\w+)(?:, #(-?(?:0x)?[0-9a-f]+))?\]", item.operands)
    if found is not None and found[1] in known:
        return known[found[1]] + int(found[2] or "0", 0)
    found = re.search(r"(-?(?:0x)?[0-9a-f]+)\((\w+)\)", item.operands)
    if found is None or (found[2] not in known and found[2] != "zero"):
        return None
    return known.get(found[2], 0) + int(found[1], 0)


def _load_thumb(image: Image, item: Instruction, known: Mapping[str, int]) -> int | None:
    words = [word.strip() for word in item.operands.split(",", 1)]
    if len(words) < 2:
        return None
    number, name = _number(words[1]), item.mnemonic.removesuffix(".w")
    if name == "movt":
        return None if number is None or words[0] not in known else (known[words[0]] & 0xFFFF) | number << 16
    if name in ("mov", "movs", "movw"):
        return number
    if name in ("mvn", "mvns") and number is not None:
        return ~number
    found = re.fullmatch(r"\[pc(?:, #(0x[0-9a-f]+|\d+))?\]", words[1])
    if name != "ldr" or found is None:
        return None
    place = (item.address + 4 & ~3) + int(found[1] or "0", 0)
    return None if image.is_relocated_at(place) else image.word(place, 4)


def _load_riscv(image: Image, item: Instruction, known: Mapping[str, int]) -> int | None:
    words = [word.strip() for word in item.operands.split(",")]
    number, name = _number(words[-1]), item.mnemonic.removeprefix("c.")
    if number is None:
        return None
    if name == "lui":
        return number << 12
    if name == "li" or (name == "addi" and len(words) == 3 and words[1] == "zero"):
        return number
    source = words[1] if len(words) == 3 else words[0]
    return known[source] + number if name == "addi" and source in known else None
