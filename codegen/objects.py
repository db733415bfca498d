"""Reading object files and linked programs: what is in them, and what each instruction does to the flow of control.

A relocatable file is laid out as if it were linked: each section gets addresses of its own, and relocations say where
branches go. So an object of the host and a program for a target are read by the same code. pyelftools reads the file,
capstone the instructions; the branches of RISC-V are read here, since capstone's operands for them differ by version.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from io import BytesIO
from pathlib import Path
from typing import Any

import capstone
from capstone import arm as arm_codes
from elftools.elf.elffile import ELFFile
from elftools.elf.relocation import RelocationSection

MACHINES = {"EM_X86_64": "x86-64", "EM_ARM": "thumb", "EM_RISCV": "rv32"}
"""What is understood here: name in the file -> our name."""

_SECTION_GAP = 0x1000
_WRITE, _ALLOC, _EXECUTE = 1, 2, 4
_OFFSETS = {"x86-64": (2,), "rv32": (35,)}
"""Relocations of offsets from a table's own address: R_X86_64_PC32, R_RISCV_ADD32 (with its SUB32)."""
_JALR = 0x67
"""Opcode on RISC-V of a jump to a register, for which an auipc before it may hold the upper part of the address."""
_IGNORED_SYMBOLS = frozenset({"", "_GLOBAL_OFFSET_TABLE_"})


class ObjectError(ValueError):
    """A file that is no object file for a machine that is understood here; one sentence."""


@dataclass(frozen=True)
class Function:
    """A function: name, first address, size in bytes, whether other files can call it."""

    name: str
    address: int
    size: int
    is_global: bool


@dataclass(frozen=True)
class DataObject:
    """A named piece of data: its section, its size in bytes, whether the program may write it."""

    name: str
    section: str
    size: int
    writable: bool


@dataclass(frozen=True)
class Sizes:
    """Sizes in bytes: code with constants (as `size` counts text), initialised and zeroed data."""

    text: int
    data: int
    bss: int


@dataclass(frozen=True)
class Instruction:
    """One instruction and where control goes from it.

    Attributes
    ----------
    address, size : int
        Where it is, and its bytes.
    mnemonic, operands : str
        As capstone prints them.
    kind : str
        ``plain``, ``jump``, ``call``, ``return``, ``table`` (a jump through a table) or ``trap`` (never goes on).
    conditional : bool
        Whether it may also do nothing and go on to the next.
    target : int, str or None
        Address of a jump or a call; the name of an undefined symbol; None for an indirect one.
    raw : capstone instruction
        For those who look closer.
    """

    address: int
    size: int
    mnemonic: str
    operands: str
    kind: str
    conditional: bool
    target: int | str | None
    raw: Any = field(repr=False, compare=False, default=None)

    @property
    def next(self) -> int:
        """Address of what follows."""
        return self.address + self.size


@dataclass(frozen=True)
class _Section:
    name: str
    base: int
    size: int
    flags: int
    data: bytes


class Image:
    """An object file or a linked program.

    Parameters
    ----------
    content : bytes
        The file.
    name : str
        What to call it in errors.

    Raises
    ------
    ObjectError
        If it is no ELF file, or for another machine.
    """

    def __init__(self, content: bytes, name: str = "the object"):
        if content[:4] != b"\x7fELF":
            raise ObjectError(f"{name} is not an ELF file; objects of other formats are not looked into")
        self._elf = ELFFile(BytesIO(content))
        machine = self._elf["e_machine"]
        if machine not in MACHINES or (machine == "EM_RISCV" and self._elf.elfclass != 32):
            raise ObjectError(f"{name} is for {machine}; only {', '.join(MACHINES.values())} are looked into")
        self.name = name
        self.machine = MACHINES[machine]
        self.is_relocatable = self._elf["e_type"] == "ET_REL"
        self._sections = self._lay_out()
        self._decoder = _decoder(self.machine)
        self._decoded: dict[int, Instruction | None] = {}
        self.functions: dict[int, Function] = {}
        self.undefined: list[str] = []
        self.objects: list[DataObject] = []
        self._tables: dict[str, list[Any]] = {}
        self._marks: list[tuple[int, bool]] = []  # where code (True) or data begins inside code sections
        self._read_symbols()
        self._fixed: dict[int, tuple[int | str, int]] = {}
        self._pointers: dict[int, tuple[int, bool]] = {}  # in data: place -> (address, whether it is an offset)
        if self.is_relocatable:
            self._read_relocations()

    # -- reading ------------------------------------------------------------------------------------------------------

    def _lay_out(self) -> dict[int, _Section]:
        sections, base = {}, _SECTION_GAP
        for index, section in enumerate(self._elf.iter_sections()):
            if not section["sh_flags"] & _ALLOC:
                continue
            size = section["sh_size"]
            data = b"" if section["sh_type"] == "SHT_NOBITS" else section.data()
            start = base if self.is_relocatable else section["sh_addr"]
            sections[index] = _Section(section.name, start, size, section["sh_flags"], data)
            base += (size // _SECTION_GAP + 2) * _SECTION_GAP
        return sections

    def _address_of(self, symbol: Any) -> int | None:
        index = symbol["st_shndx"]
        if not isinstance(index, int) or index not in self._sections:
            return None
        value: int = symbol["st_value"]
        if self.machine == "thumb" and symbol["st_info"]["type"] == "STT_FUNC":
            value &= ~1
        return value + (self._sections[index].base if self.is_relocatable else 0)

    def _symbols_of(self, table: Any) -> list[Any]:
        """Return the symbols of a table, which relocations refer to again and again."""
        if table.name not in self._tables:
            self._tables[table.name] = list(table.iter_symbols())
        return self._tables[table.name]

    def _read_symbols(self) -> None:
        table = self._elf.get_section_by_name(".symtab")
        if table is None:
            raise ObjectError(f"{self.name} has no symbol table; build it without stripping")
        for symbol in self._symbols_of(table):
            kind, binding = symbol["st_info"]["type"], symbol["st_info"]["bind"]
            if symbol["st_shndx"] == "SHN_UNDEF":
                if symbol.name not in _IGNORED_SYMBOLS:
                    self.undefined.append(symbol.name)
                continue
            if symbol["st_shndx"] == "SHN_COMMON":
                self.objects.append(DataObject(symbol.name, "COMMON", symbol["st_size"], True))
                continue
            address = self._address_of(symbol)
            if address is None:
                continue
            section = self._sections[symbol["st_shndx"]]
            in_code = bool(section.flags & _EXECUTE)
            if in_code and re.fullmatch(r"\$[xtd](\..*)?", symbol.name):
                self._marks.append((address, symbol.name[1] != "d"))
            elif kind == "STT_FUNC" or (kind == "STT_NOTYPE" and in_code and binding == "STB_GLOBAL"):
                known = self.functions.get(address)
                if known is None or (binding == "STB_GLOBAL" and not known.is_global):
                    self.functions[address] = Function(symbol.name, address, symbol["st_size"], binding != "STB_LOCAL")
            elif kind == "STT_OBJECT" and symbol["st_size"]:
                self.objects.append(
                    DataObject(symbol.name, section.name, symbol["st_size"], _is_writable(section.name, section.flags))
                )
        self._marks.sort()
        self.undefined.sort()

    def _read_relocations(self) -> None:
        """Read where code refers to (address or undefined name, addend), and which words of data point into the file."""
        for section in self._elf.iter_sections():
            if not isinstance(section, RelocationSection) or section["sh_info"] not in self._sections:
                continue
            place = self._sections[section["sh_info"]]
            symbols = self._symbols_of(self._elf.get_section(section["sh_link"]))
            for item in section.iter_relocations():
                symbol = symbols[item["r_info_sym"]]
                where = self._address_of(symbol)
                addend = item["r_addend"] if section.is_RELA() else 0
                at = place.base + item["r_offset"]
                if not place.flags & _EXECUTE:
                    is_offset = item["r_info_type"] in _OFFSETS.get(self.machine, ())
                    if where is not None:
                        self._pointers.setdefault(at, (where + addend, is_offset))
                elif where is not None or symbol.name not in _IGNORED_SYMBOLS:
                    self._fixed[at] = (symbol.name if where is None else where, addend)

    # -- what is in it ------------------------------------------------------------------------------------------------

    @property
    def sizes(self) -> Sizes:
        """Sizes of what is loaded; constants count as text, as `size` does it."""
        text = data = bss = 0
        for section in self._sections.values():
            if not section.flags & _WRITE:
                text += section.size
            elif section.data:
                data += section.size
            else:
                bss += section.size
        return Sizes(text, data, bss)

    @property
    def writable_sections(self) -> list[tuple[str, int]]:
        """Name and size of the sections that the program may write and that are not empty."""
        return [(s.name, s.size) for s in self._sections.values() if s.size and _is_writable(s.name, s.flags)]

    def function_named(self, name: str) -> Function | None:
        """Return a function by its name."""
        return next((item for item in self.functions.values() if item.name == name), None)

    @cached_property
    def _starts(self) -> list[int]:
        return sorted(self.functions)

    def function_at(self, address: int) -> Function | None:
        """Return the function whose code holds an address."""
        position = bisect_right(self._starts, address) - 1
        return self.functions[self._starts[position]] if position >= 0 else None

    @cached_property
    def lines(self) -> list[tuple[int, str, int]]:
        """(address, file name, line) in order of address, from the debug information; empty without ``-g``.

        Of a relocatable file only where all its code is in one section, since the addresses start anew in each, and not
        of RISC-V, whose lines are relocated in ways that pyelftools does not know.
        """
        rows: list[tuple[int, str, int]] = []
        code = [section for section in self._sections.values() if section.flags & _EXECUTE and section.size]
        if not self._elf.has_dwarf_info() or (self.is_relocatable and (len(code) != 1 or self.machine == "rv32")):
            return rows
        shift = code[0].base if self.is_relocatable else 0
        dwarf = self._elf.get_dwarf_info()
        for unit in dwarf.iter_CUs():
            program = dwarf.line_program_for_CU(unit)
            if program is None:
                continue
            files, first = program["file_entry"], 0 if program["version"] >= 5 else 1
            for entry in program.get_entries():
                state = entry.state
                if state is None:
                    continue
                position = state.file - first
                file = files[position].name.decode() if 0 <= position < len(files) else ""
                rows.append((state.address + shift, "" if state.end_sequence else Path(file).name, state.line))
        return sorted(rows, key=lambda row: (row[0], row[1] != ""))

    @cached_property
    def _line_starts(self) -> list[int]:
        return [row[0] for row in self.lines]

    def line_of(self, address: int) -> tuple[str, int] | None:
        """Return (file name, line) of an instruction, or None."""
        position = bisect_right(self._line_starts, address) - 1
        if position < 0 or not self.lines[position][1]:
            return None
        return self.lines[position][1], self.lines[position][2]

    # -- instructions -------------------------------------------------------------------------------------------------

    def _bytes(self, address: int, count: int) -> bytes:
        for section in self._sections.values():
            if section.base <= address < section.base + len(section.data):
                return section.data[address - section.base :][:count]
        return b""

    def word(self, address: int, size: int) -> int | None:
        """Return an unsigned little-endian number of the file, or None where there is nothing."""
        data = self._bytes(address, size)
        return int.from_bytes(data, "little") if len(data) == size else None

    def at(self, address: int) -> Instruction | None:
        """Return the instruction at an address, or None where there is none."""
        if address not in self._decoded:
            self._decoded[address] = self._decode(address)
        return self._decoded[address]

    def _decode(self, address: int) -> Instruction | None:
        raw = next(self._decoder.disasm(self._bytes(address, 16), address, count=1), None)
        if raw is None:
            return None
        if self.machine == "thumb" and re.fullmatch(r"it[te]{0,3}", raw.mnemonic):
            # what follows an IT is conditional, which only shows where both are decoded together
            block = self._decoder.disasm(self._bytes(address, 24), address, count=len(raw.mnemonic))
            for follower in list(block)[1:]:
                self._decoded[follower.address] = self._instruction(follower)
        return self._instruction(raw)

    def _instruction(self, raw: Any) -> Instruction:
        classify = {"x86-64": _classify_x86, "thumb": _classify_thumb, "rv32": self._classify_riscv}[self.machine]
        kind, conditional, place = classify(raw)
        target = self._relocated(raw, place) if kind in ("jump", "call") else place
        return Instruction(raw.address, raw.size, raw.mnemonic, raw.op_str, kind, conditional, target, raw)

    def _relocated(self, raw: Any, target: int | None) -> int | str | None:
        places = [raw.address + k for k in range(raw.size)]
        if self.machine == "rv32" and raw.size == 4 and raw.bytes[0] & 0x7F == _JALR:
            places.append(
                raw.address - 4
            )  # of auipc and jalr, the first has it; what stands before a branch is not its own
        found = next((self._fixed[place] for place in places if place in self._fixed), None)
        if found is None:
            return target
        where: int | str = found[0]
        addend: int = found[1]
        if isinstance(where, str):
            return where
        if self.machine == "x86-64":
            return where + addend + 4
        if self.machine == "thumb":
            return where + int((target or raw.address) - raw.address)
        return where + addend

    def _classify_riscv(self, raw: Any) -> tuple[str, bool, int | None]:
        word = int.from_bytes(raw.bytes, "little")
        if raw.size == 2:
            return _classify_compressed(word, raw.address)
        opcode, rd, rs1 = word & 0x7F, (word >> 7) & 31, (word >> 15) & 31
        if opcode == 0x6F:
            at = raw.address + _signed(
                ((word >> 31) << 20)
                | (((word >> 12) & 0xFF) << 12)
                | (((word >> 20) & 1) << 11)
                | (((word >> 21) & 0x3FF) << 1),
                21,
            )
            return ("jump" if rd == 0 else "call"), False, at
        if opcode == 0x63:
            at = raw.address + _signed(
                ((word >> 31) << 12)
                | (((word >> 7) & 1) << 11)
                | (((word >> 25) & 0x3F) << 5)
                | (((word >> 8) & 0xF) << 1),
                13,
            )
            return "jump", True, at
        if opcode == _JALR:
            offset = _signed(word >> 20, 12)
            if rd == 0 and rs1 in (1, 5) and not offset and not self._is_upper(raw.address - 4, rs1):
                return "return", False, None
            before = self.word(raw.address - 4, 4)
            far = None
            if before is not None and self._is_upper(raw.address - 4, rs1):
                far = (raw.address - 4 + (before & 0xFFFFF000) + offset) & 0xFFFFFFFF
            return ("jump" if rd == 0 else "call"), False, far
        if word in (0x00100073,):  # ebreak
            return "trap", False, None
        return "plain", False, None

    def _is_upper(self, address: int, register: int) -> bool:
        """Whether an instruction is `auipc` into a register."""
        word = self.word(address, 4)
        return word is not None and word & 0x7F == 0x17 and (word >> 7) & 31 == register

    def instructions(self) -> Iterator[Instruction]:
        """All instructions of the file, one after another, leaving out data that lies between them."""
        for section in self._sections.values():
            if section.flags & _EXECUTE:
                yield from self._sweep(section)

    def _sweep(self, section: _Section) -> Iterator[Instruction]:
        end = section.base + len(section.data)
        marks = [mark for mark in self._marks if section.base <= mark[0] < end]
        spans = [(section.base, end)]
        if marks:
            edges = [*marks, (end, False)]
            spans = [(at, edges[k + 1][0]) for k, (at, is_code) in enumerate(marks) if is_code]
        for start, stop in spans:
            address = start
            while address < stop:
                found = self.at(address)
                if found is None:
                    address += 1 if self.machine == "x86-64" else 2
                    continue
                yield found
                address = found.next

    def is_relocated(self, item: Instruction) -> bool:
        """Whether the linker is to put an address into an instruction."""
        return any(item.address + k in self._fixed for k in range(item.size))

    def is_relocated_at(self, place: int) -> bool:
        """Whether the linker is to put an address into the word at a place of the code."""
        return place in self._fixed

    def switch_targets(self, recent: Sequence[Instruction]) -> list[int]:
        """Return where the last of some instructions in a row may jump, if it jumps through a table of its function.

        A `switch` is known by how compilers write it (on x86-64 an offset is loaded, scaled, and added to the table's own
        address; on RISC-V the index is scaled and a word loaded), and by its table, which has to be in this file and to
        lead into the function itself. A table of functions is none, nor is anything else: the list is empty.
        """
        jump, before = recent[-1], recent[:-1]
        owner = self.function_at(jump.address)
        if jump.kind != "jump" or jump.target is not None or owner is None or not self._is_like_a_switch(jump, before):
            return []
        for item in reversed(before):
            found = next((self._fixed[a] for k in range(item.size) if (a := item.address + k) in self._fixed), None)
            if found is None or isinstance(found[0], str) or item.kind != "plain":
                continue
            targets = self._targets_of(found[0] + found[1] + (4 if self.machine == "x86-64" else 0), owner)
            if targets:
                return targets
        return []

    def _targets_of(self, table: int, owner: Function) -> list[int]:
        """Return the targets in a table, as far as they lie in a function and are not its beginning."""
        targets = []
        place = table
        while place in self._pointers:
            address, is_offset = self._pointers[place]
            if is_offset and self.machine == "x86-64":
                address -= place - table
            inside = self.function_at(address)
            is_own = inside is not None and (inside == owner or inside.name.startswith(f"{owner.name}.cold"))
            if not is_own or address == owner.address:
                break
            targets.append(address)
            place += 4
        return list(dict.fromkeys(targets))

    def _is_like_a_switch(self, jump: Instruction, before: Sequence[Instruction]) -> bool:
        if self.machine == "x86-64":
            scaled = any(item.mnemonic == "movsxd" and "*4]" in item.operands for item in before)
            return scaled and any(item.mnemonic == "lea" and "rip" in item.operands for item in before)
        if self.machine == "rv32":
            shifts = any(item.mnemonic in ("slli", "c.slli", "sh2add") for item in before)
            loads = any(
                item.mnemonic in ("lw", "c.lw") and item.operands.startswith(f"{jump.operands},") for item in before
            )
            return shifts and (loads or any(item.mnemonic in ("lw", "c.lw") for item in before))
        return False

    def calls(self) -> dict[str, set[str | None]]:
        """Return the call graph: function -> names it calls or jumps to; None stands for an indirect call."""
        graph: dict[str, set[str | None]] = {item.name: set() for item in self.functions.values()}
        recent: list[Instruction] = []
        for item in self.instructions():
            owner = self.function_at(item.address)
            recent = [*recent[-8:], item]
            if owner is None or item.kind not in ("call", "jump") or self.switch_targets(recent):
                continue
            if isinstance(item.target, int):
                callee = self.function_at(item.target)
                is_inside = callee == owner and (item.kind == "jump" and item.target != owner.address)
                if callee is not None and not is_inside:
                    graph[owner.name].add(callee.name)
            else:
                graph[owner.name].add(item.target)
        return graph


def read_image(path: Path) -> Image:
    """Read an object file or a linked program.

    Raises
    ------
    ObjectError
        See `Image`.
    """
    return Image(path.read_bytes(), path.name)


# ---------------------------------------------------------------------------------------------------------------------
# Machines


def _decoder(machine: str) -> Any:
    mode = {
        "x86-64": (capstone.CS_ARCH_X86, capstone.CS_MODE_64),
        "thumb": (capstone.CS_ARCH_ARM, capstone.CS_MODE_THUMB | capstone.CS_MODE_MCLASS),
        "rv32": (capstone.CS_ARCH_RISCV, capstone.CS_MODE_RISCV32 | capstone.CS_MODE_RISCVC),
    }[machine]
    decoder = capstone.Cs(*mode)
    decoder.detail = True
    return decoder


def _is_writable(name: str, flags: int) -> bool:
    """Whether the program may write a section; what is constant but for its relocation is not."""
    return bool(flags & _WRITE) and not name.startswith((".data.rel.ro", ".init_array", ".fini_array", ".got", ".plt"))


def _signed(value: int, bits: int) -> int:
    return value - (1 << bits) if value >> (bits - 1) & 1 else value


def _classify_x86(raw: Any) -> tuple[str, bool, int | None]:
    target = raw.operands[0].imm if len(raw.operands) == 1 and raw.operands[0].type == capstone.CS_OP_IMM else None
    if raw.group(capstone.CS_GRP_CALL):
        return "call", False, target
    if raw.group(capstone.CS_GRP_RET):
        return "return", False, None
    if raw.group(capstone.CS_GRP_JUMP):
        return "jump", not raw.mnemonic.endswith("jmp"), target
    return ("trap" if raw.mnemonic in ("ud2", "hlt") else "plain"), False, None


_THUMB_BRANCHES = {arm_codes.ARM_INS_B, arm_codes.ARM_INS_CBZ, arm_codes.ARM_INS_CBNZ}


def _classify_thumb(raw: Any) -> tuple[str, bool, int | None]:
    conditional = raw.cc not in (arm_codes.ARM_CC_INVALID, arm_codes.ARM_CC_AL)
    last = raw.operands[-1] if raw.operands else None
    target = last.imm if last is not None and last.type == capstone.CS_OP_IMM else None
    if raw.id in (arm_codes.ARM_INS_BL, arm_codes.ARM_INS_BLX):
        return "call", conditional, target
    if raw.id in _THUMB_BRANCHES:
        return "jump", conditional or raw.id != arm_codes.ARM_INS_B, target
    if raw.id in (arm_codes.ARM_INS_TBB, arm_codes.ARM_INS_TBH):
        return "table", False, None
    if raw.id in (arm_codes.ARM_INS_BX, arm_codes.ARM_INS_BXNS):
        return ("return" if raw.op_str == "lr" else "jump"), conditional, None
    if raw.id in (arm_codes.ARM_INS_UDF, arm_codes.ARM_INS_BKPT):
        return "trap", conditional, None
    written = raw.op_str.split("[")[0] if raw.mnemonic.startswith(("pop", "ldm", "ldr")) else raw.op_str.split(",")[0]
    if re.search(r"\bpc\b", written) and not raw.mnemonic.startswith(("cmp", "cmn", "tst", "teq", "str", "push", "b")):
        is_return = raw.mnemonic.startswith(("pop", "ldm")) or re.match(r"pc, \[sp\], ", raw.op_str)
        is_return = is_return or (raw.mnemonic.startswith("mov") and raw.op_str == "pc, lr")
        return ("return" if is_return else "jump"), conditional, None
    return "plain", conditional, None


def _classify_compressed(word: int, address: int) -> tuple[str, bool, int | None]:
    quadrant, function = word & 3, word >> 13

    def bit(k: int) -> int:
        return (word >> k) & 1

    if quadrant == 1 and function in (1, 5):
        offset = (
            (bit(12) << 11) | (bit(11) << 4) | (((word >> 9) & 3) << 8) | (bit(8) << 10) | (bit(7) << 6)
            | (bit(6) << 7) | (((word >> 3) & 7) << 1) | (bit(2) << 5)
        )  # fmt: skip
        return ("call" if function == 1 else "jump"), False, address + _signed(offset, 12)
    if quadrant == 1 and function in (6, 7):
        offset = (
            (bit(12) << 8) | (((word >> 10) & 3) << 3) | (((word >> 5) & 3) << 6) | (((word >> 3) & 3) << 1)
            | (bit(2) << 5)
        )  # fmt: skip
        return "jump", True, address + _signed(offset, 9)
    if quadrant == 2 and function == 4 and (word >> 2) & 31 == 0:
        register = (word >> 7) & 31
        if bit(12):
            return ("call" if register else "trap"), False, None
        if register:
            return ("return" if register in (1, 5) else "jump"), False, None
    return "plain", False, None
