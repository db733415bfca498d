"""Bounds from the machine code: instructions for a call, and bytes of stack, along the worst path.

The control flow of a function is read from its instructions. A bound on instructions is the longest path through it,
callees included, where a loop counts as often as the `for` of the C it was compiled from can turn: debug information
says which line an instruction belongs to, and the emitted C has only loops whose trips can be read off. What cannot be
bounded is `Unknown`, with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import prod

from .objects import Image, Instruction


@dataclass(frozen=True)
class Unknown:
    """There is no bound, and why."""

    reason: str

    def __str__(self) -> str:
        return f"unknown because of {self.reason}"


Bound = int | Unknown

STACK_SMASHED = "__stack_chk_fail"
"""What a hardened compiler calls where a frame is no longer whole. It ends the program: what stands behind the call is
another function, and what it costs is nobody's concern."""


class _NoBound(Exception):  # noqa: N818
    """Carries the reason out of a recursion."""


# ---------------------------------------------------------------------------------------------------------------------
# Loops of the C


@dataclass(frozen=True)
class SourceLoop:
    """A loop of the C: the function it is in, its first and last line, and how often its body can run at most.

    `trips` is None where the text does not say so; `head` is that text.
    """

    function: str
    first: int
    last: int
    trips: int | None
    head: str


_FOR = re.compile(
    r"^for \((?:(?:u?int\d+_t|int) )?(?P<name>\w+) = (?P<start>[^;]+); (?P<while>[^;]+); (?P<step>[^;]+)\)$"
)
_NUMBER = re.compile(r"^\(*(\d+)U?\)*$")


def source_loops(text: str) -> list[SourceLoop]:
    """Find the loops of a C file and read off how often each can turn.

    A loop is found by its word, wherever that stands, in a macro too. Understood is the manner of this package:
    ``for (i = A; i < B; i++)`` (also with ``<=``, ``i = i + 4U``, a further condition joined by ``&&``, downwards by
    ``i > 0U; i--``), where B is a number or the counter of a loop around it, the body is in braces, and nothing in it
    writes the counter. Of any other loop, and of ``while``, ``do`` and ``goto``, the trips are None.

    Parameters
    ----------
    text : str
        The C.
    """
    code = without_comments(text)
    functions = _function_of_lines(code.split("\n"))
    loops: list[SourceLoop] = []
    around: list[tuple[int, str, int]] = []  # where a loop ends, its counter, the greatest value of it
    for found in re.finditer(r"\b(for|while|do|goto)\b", code):
        begin = found.start()
        around = [item for item in around if item[0] > begin]
        opened = found.end() if found[1] == "do" else _closing(code, found.end(), "()")
        brace = re.compile(r"\s*\{").match(code, opened)
        end = _closing(code, opened, "{}") if brace else _after(code, ";", opened)
        head = " ".join(code[begin : _after(code, ";", begin) if found[1] == "goto" else opened].split())
        counter, trips, greatest = _trips(head, code[opened:end], {name: most for _, name, most in around if name})
        trips = trips if brace else None
        first, last = (code.count("\n", 0, at) for at in (begin, max(begin, end - 1)))
        loops.append(SourceLoop(functions[first], first + 1, last + 1, trips, head))
        around.append((end, counter if trips is not None else "", greatest))
    return loops


def without_comments(text: str) -> str:
    """Return C with comments, strings and characters blanked out, line for line and place for place."""
    return re.sub(
        r"""/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'""",
        lambda found: re.sub(r"[^\n]", " ", found.group()),
        text,
        flags=re.DOTALL,
    )


def _function_of_lines(lines: Sequence[str]) -> list[str]:
    """Return for each line the function it is in."""
    function, depth, answer = "", 0, []
    for line in lines:
        if depth == 0 and (named := re.match(r"^(?:static )?[\w *]*?\b(\w+)\(", line.strip())):
            function = named.group(1)
        answer.append(function)
        depth += line.count("{") - line.count("}")
    return answer


def _closing(code: str, start: int, pair: str) -> int:
    """Return the place after the bracket that closes the first one behind a place."""
    depth = 0
    for found in re.compile("[" + re.escape(pair) + "]").finditer(code, start):
        depth += 1 if found.group() == pair[0] else -1
        if depth <= 0:
            return found.end()
    return len(code)


def _after(code: str, mark: str, start: int) -> int:
    at = code.find(mark, start)
    return len(code) if at < 0 else at + 1


def _trips(head: str, body: str, around: Mapping[str, int]) -> tuple[str, int | None, int]:
    """Return the counter of a loop, its trips (None: not known), and the greatest value the counter has inside."""
    found = _FOR.match(re.sub(r"\s+", " ", head))
    if found is None:
        return "", None, 0
    name = found["name"]
    if re.search(
        rf"(?<![\w>.]){name}\s*(?:[-+*/|&^]|<<|>>)?=(?!=)|(?<![\w>.]){name}\s*(?:\+\+|--)|&[\s(]*{name}\b", body
    ):
        return name, None, 0
    step = re.fullmatch(
        rf"{name}(\+\+|--)|{name} = {name} ([-+]) (\d+)U?|{name} ([-+])= (\d+)U?|(\+\+|--){name}", found["step"]
    )
    if step is None:
        return name, None, 0
    sign = (step[1] or step[2] or step[4] or step[6])[0]
    by = int(step[3] or step[5] or 1)
    conditions = [item.strip().strip("()") for item in found["while"].split("&&")]
    limit = next((c for item in conditions if (c := re.fullmatch(rf"{name} (<|<=|>|>=|!=) (\w+)", item))), None)
    if limit is None or by == 0:
        return name, None, 0
    first, bound = _value(found["start"], around), _value(limit[2], around)
    if sign == "+" and limit[1] in ("<", "<=") and bound is not None:
        start = first if first is not None and _NUMBER.match(found["start"]) else 0
        count = bound - start + (limit[1] == "<=")
        return name, max(0, -(-count // by)) if bound < 1 << 31 else None, bound
    lowest = _NUMBER.match(limit[2])
    if sign == "-" and limit[1] in (">", ">=") and first is not None and lowest:
        if int(lowest[1]) + (limit[1] == ">") < by:  # it passes zero, and an unsigned counter goes on at its largest
            return name, None, 0
        count = first - int(lowest[1]) + (limit[1] == ">=")
        return name, max(0, -(-count // by)), first
    return name, None, 0


def _value(text: str, around: Mapping[str, int]) -> int | None:
    """Return the greatest value of a bound: a number, or the counter of a loop around it."""
    number = _NUMBER.match(text.strip())
    return int(number[1]) if number else around.get(text.strip())


# ---------------------------------------------------------------------------------------------------------------------
# Control flow


@dataclass
class _Block:
    """Instructions that run one after another, and the addresses of the blocks that may follow."""

    items: list[Instruction]
    after: list[int] = field(default_factory=list)
    leaves: bool = False
    calls: list[tuple[Instruction, int | str]] = field(default_factory=list)


_COPIES = re.compile(r"^(?:__aeabi_)?mem(?:cpy|set|move|clr)[48]?$")
_COUNT_REGISTERS = {"thumb": "r2", "rv32": "a2", "x86-64": "edx"}
_BIT_LOOPS = {
    "thumb": {"__aeabi_dmul": 52, "__aeabi_ddiv": 13, "__ieee754_sqrt": 32},
    "rv32": {"__ieee754_sqrt": 32, "sqrt": 32},
}
"""Turns of the loops in double arithmetic in software, read from its text. libgcc's ieee754-df.S (gcc 12): a fraction of 52 bits
is shifted by one bit until its first is in place; a quotient is found four bits a turn, in words of 5 and 8 turns. Sun's
e_sqrt.c in newlib and picolibc: a root is found bit by bit, in words of 22 and 32 bits."""
_FILLS_FIRST = re.compile(r"^__aeabi_mem(?:set|clr)[48]?$")


class Analysis:
    """Bounds of the functions of one image.

    Parameters
    ----------
    image : Image
        A linked program; of an object file, what is undefined in it has no bound.
    loops : list of SourceLoop
        Of the C file, see `source_loops`.
    file : str
        The C file's name, as debug information has it.
    largest : int
        Bytes of the largest struct of the C: how much a loop copies that the compiler made for an assignment.
    """

    def __init__(self, image: Image, loops: Sequence[SourceLoop] = (), file: str = "", largest: int = 0):
        self.image, self.loops, self.file, self.largest = image, list(loops), file, largest
        self._bodies: dict[int, dict[int, _Block]] = {}
        self._costs: dict[tuple[int, int | None], int] = {}
        self._stacks: dict[int, int] = {}
        self._busy: list[int] = []

    # -- what is asked ------------------------------------------------------------------------------------------------

    def instructions(self, function: str) -> Bound:
        """Return a bound on the instructions of one call of a function, callees included."""
        return self._ask(function, lambda address: self._cost(address, None))

    def stack(self, function: str) -> Bound:
        """Return a bound on the bytes of stack that a call of a function takes, callees included."""
        return self._ask(function, self._stack)

    def frame(self, function: str) -> Bound:
        """Return the bytes of stack of a function alone, callees left out."""
        return self._ask(function, lambda address: self._deepest_stack(address, lambda target: 0))

    def takes_stack_freely(self, function: str) -> str:
        """Return why the frame of a function is not of a fixed size, or nothing.

        A frame that is aligned, or given back by way of a frame pointer, is of a fixed size though it has no bound here.
        """
        frame, start = self.frame(function), self.image.function_named(function)
        if not isinstance(frame, Unknown) or start is None:
            return ""
        items = [item for item in self.image.instructions() if self.image.function_at(item.address) == start]
        moves = [
            _gives_back(self.image.machine, item, items[max(0, k - 1) : k])
            for k, item in enumerate(items)
            if _sp_change(self.image.machine, item, items[:k]) is None
        ]
        return "" if moves and all(moves) else frame.reason

    def cycles(self, function: str) -> Bound:
        """Return how many loops the machine code of a function has: the blocks to which it jumps back."""
        return self._ask(function, lambda address: len(_heads(address, self._body(address))))

    def callees(self, function: str) -> list[str]:
        """Return the names of all functions that a call may reach, itself left out; undefined ones too."""
        start = self.image.function_named(function)
        names: set[str] = set()
        todo = [] if start is None else [start.address]
        seen = set(todo)
        while todo:
            try:
                blocks = self._body(todo.pop())
            except _NoBound:  # what cannot be read calls what cannot be known
                continue
            for block in blocks.values():
                for _, target in block.calls:
                    names.add(self._name(target))
                    if isinstance(target, int) and target not in seen:
                        seen.add(target)
                        todo.append(target)
        return sorted(names - {function})

    def _ask(self, function: str, how: Callable[[int], int]) -> Bound:
        start = self.image.function_named(function)
        if start is None:
            return Unknown(f"no function {function!r} in {self.image.name}")
        self._busy = []
        try:
            return how(start.address)
        except _NoBound as reason:
            return Unknown(str(reason))

    def _name(self, target: int | str) -> str:
        if isinstance(target, str):
            return target
        function = self.image.function_at(target)
        if function is None:
            return f"code at {target:#x}"
        return function.name if function.address == target else f"{function.name}+{target - function.address:#x}"

    # -- blocks -------------------------------------------------------------------------------------------------------

    def _body(self, start: int) -> dict[int, _Block]:
        """Return the blocks of a function by their first address."""
        if start not in self._bodies:
            self._bodies[start] = self._read_body(start)
        return self._bodies[start]

    def _read_body(self, start: int) -> dict[int, _Block]:
        follow: dict[int, list[int]] = {}
        leaving: set[int] = set()
        calls: dict[int, list[tuple[Instruction, int | str]]] = {}
        items: dict[int, Instruction] = {}
        leaders, todo = {start}, [start]
        while todo:
            address = todo.pop()
            if address in items:
                continue
            item = self.image.at(address)
            if item is None:
                raise _NoBound(f"{self._name(start)}, whose code cannot be read at {address:#x}")
            items[address] = item
            targets = self._follow(start, item, items, calls, leaving)
            follow[address] = targets
            todo += targets
            if item.kind != "plain" and item.kind != "call":
                leaders.update(targets)
                if item.conditional:
                    leaders.add(item.next)
        for address, targets in follow.items():
            leaders.update(target for target in targets if target != items[address].next)
        return _blocks(items, follow, leaders & items.keys(), calls, leaving)

    def _follow(
        self,
        start: int,
        item: Instruction,
        items: Mapping[int, Instruction],
        calls: dict[int, list[tuple[Instruction, int | str]]],
        leaving: set[int],
    ) -> list[int]:
        """Return where control may go from an instruction inside the function; note calls and ways out."""
        after = [item.next] if item.kind in ("plain", "call") or item.conditional else []
        if item.kind in ("return", "trap"):
            leaving.add(item.address)
        elif item.kind == "call" and item.target == STACK_SMASHED:
            leaving.add(item.address)
            return []
        elif item.kind == "table":
            return self._table(item, items)
        elif item.kind == "call":
            if item.target is None:
                raise _NoBound(f"an indirect call in {self._name(start)}")
            calls.setdefault(item.address, []).append((item, item.target))
        elif item.kind == "jump":
            if item.target is None:
                return self._switch(start, item, items)
            if self._is_other(start, item.target):
                calls.setdefault(item.address, []).append((item, item.target))
                leaving.add(item.address)
            else:
                after.append(int(item.target))
        return after

    def _is_other(self, start: int, target: int | str) -> bool:
        """Whether a jump goes to another function: a call in the last place."""
        if isinstance(target, str):
            return True
        found = self.image.functions.get(target)
        return found is not None and target != start and ".cold" not in found.name

    def _table(self, item: Instruction, items: Mapping[int, Instruction]) -> list[int]:
        """Return the targets of `tbb` and `tbh`: the comparison before it says how many there are."""
        width = 1 if item.mnemonic == "tbb" else 2
        index = item.operands.strip("[]").split(",")[1].strip()
        before = [items[a] for a in sorted(items) if item.address - 24 <= a < item.address]
        counts = [
            int(found[1], 0)
            for other in before
            if other.mnemonic.startswith("cmp") and (found := re.fullmatch(rf"{index}, #(\w+)", other.operands))
        ]
        if not item.operands.startswith("[pc") or not counts:
            raise _NoBound(f"a table of jumps at {item.address:#x} that is not understood")
        targets = []
        for k in range(counts[-1] + 1):
            word = self.image.word(item.next + k * width, width)
            if word is None:
                raise _NoBound(f"a table of jumps at {item.address:#x} that is not understood")
            targets.append(item.next + 2 * word)
        return list(dict.fromkeys(targets))

    def _switch(self, start: int, jump: Instruction, items: Mapping[int, Instruction]) -> list[int]:
        """Return the targets of a `switch`: in an object as its relocations say, in a program for RISC-V as gcc writes it.

        There a table holds offsets from its own address, and before the jump stand ``bltu limit, index``, the address of
        the table, ``slli``, ``add``, ``lw``, ``add``. An indirect jump of another kind has no bound.
        """
        before = [items[at] for at in sorted(items) if jump.address - 60 <= at < jump.address]
        if targets := self.image.switch_targets([*before, jump]):
            return targets
        last = [(item.mnemonic.removeprefix("c."), re.split(r", |[()]", item.operands)) for item in before]
        names = [name for name, _ in last[-4:]]
        no_table = _NoBound(f"an indirect jump in {self._name(start)}")
        if self.image.machine != "rv32" or names != ["slli", "add", "lw", "add"]:
            raise no_table
        table = next((word for word in last[-1][1][1:] if word != jump.operands), "")
        base = self._riscv_address(table, before)
        branch = next(((name, words) for name, words in reversed(last[:-4]) if name in ("bltu", "bgeu")), None)
        limit = _loaded(branch[1][0], before[: last.index(branch)]) if branch is not None else None
        if base is None or branch is None or branch[0] != "bltu" or limit is None or not 0 < limit < 256:
            raise no_table
        targets = []
        for k in range(limit + 1):
            offset = self.image.word(base + 4 * k, 4)
            if offset is None:
                raise no_table
            targets.append((base + offset) & 0xFFFFFFFF)
        return list(dict.fromkeys(targets))

    def _riscv_address(self, register: str, before: Sequence[Instruction]) -> int | None:
        """Return the address in a register that `auipc` or `lui` and `addi` have put there."""
        value: int | None = None
        for item in before:
            words = [word.strip() for word in item.operands.split(",")]
            number = _immediate(words[-1])
            if words[0] != register or item.mnemonic.startswith(("b", "s", "c.b", "c.s")):
                continue
            if item.mnemonic == "auipc" and number is not None:
                value = item.address + (number << 12)
            elif item.mnemonic in ("lui", "c.lui") and number is not None:
                value = number << 12
            elif item.mnemonic in ("addi", "c.addi") and value is not None and number is not None:
                value += number
            elif item.mnemonic != "c.mv" or words[-1] != register:
                value = None
        return None if value is None else value & 0xFFFFFFFF

    # -- instructions -------------------------------------------------------------------------------------------------

    def _cost(self, start: int, count: int | None) -> int:
        """Return the most instructions of a function; `count`: the bytes that a copying function is to copy."""
        key = (start, count)
        if key in self._costs:
            return self._costs[key]
        if start in self._busy:
            raise _NoBound(f"recursion through {self._name(start)}")
        self._busy.append(start)
        body = self._body(start)
        weights = {at: len(block.items) + self._callees(body, at, start, count) for at, block in body.items()}
        entry = -1  # ahead of the first block, which may itself be the head of a loop
        blocks = {entry: _Block([], [start]), **body}
        longest, _ = self._region(entry, blocks, set(blocks), {entry: 0, **weights}, start, count)
        leaves = [longest[at] for at, block in body.items() if block.leaves]
        if not leaves:
            raise _NoBound(f"{self._name(start)}, which never returns")
        self._busy.pop()
        self._costs[key] = max(leaves)
        return self._costs[key]

    def _callees(self, body: Mapping[int, _Block], at: int, start: int, count: int | None) -> int:
        total = 0
        for item, target in body[at].calls:
            if isinstance(target, str):
                raise _NoBound(f"{target}, which is not in {self.image.name}")
            amount = None
            if _COPIES.match(self._name(target)):
                own = self._name(start)
                amount = count if _COPIES.match(own) else self._constant(body, at, start, item, self._name(target))
                if amount is None:
                    raise _NoBound(f"{self._name(target)}, called by {own} for a size that is not constant")
            total += self._cost(target, amount)
        return total

    def _constant(self, body: Mapping[int, _Block], at: int, start: int, call: Instruction, callee: str) -> int | None:
        """Return the constant in the register that says how much is copied, looking back from a call."""
        register = _COUNT_REGISTERS[self.image.machine]
        if _FILLS_FIRST.match(callee):
            register = "r1"
        before = [item for item in body[at].items if item.address < call.address]
        return self._greatest(body, at, before, register, frozenset({start}))  # what the caller left there is not known

    def _greatest(
        self, body: Mapping[int, _Block], at: int, before: Sequence[Instruction], register: str, seen: frozenset[int]
    ) -> int | None:
        """Return the greatest constant that a register may hold after some instructions of a block, over all ways there."""
        for item in reversed(before):
            if item.kind == "call":
                return None
            if re.match(rf"^{register}\b", item.operands) and not item.mnemonic.startswith(
                ("cmp", "cmn", "tst", "str", "s", "test", "push", "b", "cb")
            ):
                found = re.fullmatch(rf"{register}, (?:zero, )?#?(0x[0-9a-f]+|\d+)", item.operands)
                loads = item.mnemonic in ("movs", "mov", "mov.w", "movw", "c.li", "li", "addi")
                return int(found[1], 0) if found and loads else None
        sources = [key for key, block in body.items() if at in block.after]
        if not sources or at in seen or len(seen) > 9:
            return None
        values = [self._greatest(body, key, body[key].items, register, seen | {at}) for key in sources]
        known = [value for value in values if value is not None]
        return max(known) if len(known) == len(values) else None

    def _region(
        self,
        head: int,
        blocks: Mapping[int, _Block],
        inside: set[int],
        weights: Mapping[int, int],
        start: int,
        count: int | None,
    ) -> tuple[dict[int, int], int]:
        """Return the longest way from the head of a loop to the end of each of its blocks, and once around."""
        edges = {at: [t for t in blocks[at].after if t in inside and t != head] for at in inside}
        arriving: dict[int, int] = {head: 0}
        longest: dict[int, int] = {}
        for part in reversed(_components(sorted(inside), edges)):
            entries = [at for at in part if at in arriving]
            if not entries:
                continue
            if len(part) == 1 and part[0] not in edges[part[0]]:
                at = part[0]
                longest[at] = arriving[at] + weights[at]
            else:
                longest.update(self._loop(entries, blocks, set(part), weights, start, count, arriving))
            for at in part:
                for target in edges[at]:
                    if target not in part and at in longest:
                        arriving[target] = max(arriving.get(target, 0), longest[at])
        back = [longest[at] for at in longest if head in blocks[at].after]
        return longest, max(back, default=0)

    def _loop(
        self,
        entries: Sequence[int],
        blocks: Mapping[int, _Block],
        members: set[int],
        weights: Mapping[int, int],
        start: int,
        count: int | None,
        arriving: Mapping[int, int],
    ) -> dict[int, int]:
        """Return the longest way to the end of each block of a loop.

        A loop that is one of the C's turns as often as that. Where a compiler made two loops in each other of one, or a
        loop with two entries, each instruction runs at most as often as what it was compiled from, and is so counted.
        """
        begin = max(arriving[at] for at in entries)
        copying = count is not None and bool(_COPIES.match(self._name(start)))
        if len(entries) == 1:
            inner, around = self._region(entries[0], blocks, members, weights, start, count)
            turns = self._turns(entries[0], blocks, members, start, count)
            if turns is not None:
                return {at: begin + turns * around + way for at, way in inner.items()}
        touched = self._touched(blocks, members)
        if copying or not touched:
            raise _NoBound(f"a loop with several entries in {self._name(start)}")
        whole = sum(weights[at] for at in members) * (self._product(touched, 1))
        return {at: begin + whole for at in members}

    # -- how often a loop turns ---------------------------------------------------------------------------------------

    def _turns(
        self, head: int, blocks: Mapping[int, _Block], members: set[int], start: int, count: int | None
    ) -> int | None:
        """Return how often a loop of the machine code can turn; None where it is no loop of its own in the C."""
        if count is not None and _COPIES.match(self._name(start)):
            return self._copy_turns(blocks, members, start, count)
        touched = self._touched(blocks, members)
        bits = _BIT_LOOPS.get(self.image.machine, {}).get(self._name(head).split("+")[0])
        if bits is not None:
            return bits
        if not touched:  # of an assignment of a struct, which a compiler may write as a loop
            lines = [self.image.line_of(item.address) for at in members for item in blocks[at].items]
            if not self.largest or not all(line is not None and line[0] == self.file for line in lines):
                raise _NoBound(f"a loop in {self._name(start)}")
            return self._copy_turns(blocks, members, start, self.largest)
        edges = {at: [t for t in blocks[at].after if t in members and t != head] for at in members}
        inner: set[int] = set()
        for part in _components(sorted(members), edges):
            if len(part) > 1 or part[0] in edges[part[0]]:
                inner |= self._touched(blocks, set(part))
        own = touched - inner
        return self._product(own, 0) if own else None

    def _product(self, chosen: set[int], more: int) -> int:
        """Return the trips of loops (each with `more` on top) that may lie in each other."""
        answer = 1
        for function in {self.loops[k].function for k in chosen}:
            answer *= self._deepest([k for k in chosen if self.loops[k].function == function], more)
        return answer

    def _deepest(self, chosen: Sequence[int], more: int) -> int:
        """Return the greatest product of trips over loops that lie in each other."""
        best = 1
        for k in chosen:
            loop = self.loops[k]
            chain = [
                self.loops[j] for j in chosen if self.loops[j].first <= loop.first and loop.last <= self.loops[j].last
            ]
            unbounded = next((item for item in chain if item.trips is None), None)
            if unbounded is not None:
                raise _NoBound(f"the loop in line {unbounded.first} of {self.file}, whose trips are not fixed")
            best = max(best, prod((item.trips or 0) + more for item in chain))
        return best

    def _touched(self, blocks: Mapping[int, _Block], members: Iterable[int]) -> set[int]:
        """Return the loops of the C, by their number, that have instructions in some blocks: the innermost of a line."""
        answer = set()
        for at in members:
            for item in blocks[at].items:
                line = self.image.line_of(item.address)
                if line is None or line[0] != self.file:
                    continue
                around = [k for k, loop in enumerate(self.loops) if loop.first <= line[1] <= loop.last]
                if around:
                    answer.add(max(around, key=lambda k: self.loops[k].first))
        return answer

    def _copy_turns(self, blocks: Mapping[int, _Block], members: set[int], start: int, count: int) -> int:
        """Return how often a loop of `memcpy` and its like turns: each turn moves a counter by a fixed stride.

        Counters of these routines span no more than the bytes they are given. The counter is one that a single
        instruction of the loop changes, by a constant, and that the branch which closes the loop looks at.
        """
        items = [item for at in sorted(members) for item in blocks[at].items]
        strides = []
        for at in members:
            last = blocks[at].items[-1]
            if last.kind != "jump" or not last.conditional:
                continue
            rest = {b: [t for t in blocks[b].after if t in members and t != at] for b in members if b != at}
            if any(len(part) > 1 or part[0] in rest[part[0]] for part in _components(sorted(rest), rest)):
                continue  # a turn may pass this branch by
            if all(target in members for target in blocks[at].after):
                continue  # it does not leave
            for register in _looked_at(blocks[at].items):
                changes = [item for item in items if _changes(item, register)]
                stride = _stride(changes[0], register) if len(changes) == 1 else 0
                if stride:
                    strides.append(stride)
        if not strides:
            raise _NoBound(f"a loop in {self._name(start)}")
        return count // min(strides) + 1

    # -- stack --------------------------------------------------------------------------------------------------------

    def _stack(self, start: int) -> int:
        if start in self._stacks:
            return self._stacks[start]
        if start in self._busy:
            raise _NoBound(f"recursion through {self._name(start)}")
        self._busy.append(start)
        most = self._deepest_stack(start, self._callee_stack)
        self._busy.pop()
        self._stacks[start] = most
        return most

    def _deepest_stack(self, start: int, callee: Callable[[int | str], int]) -> int:
        body = self._body(start)
        own = 8 if self.image.machine == "x86-64" else 0  # the address to return to
        depths, todo, most = {start: own}, [start], own
        while todo:
            at = todo.pop()
            depth = depths[at]
            calls = {item.address: target for item, target in body[at].calls}
            for position, item in enumerate(body[at].items):
                moved = _sp_change(self.image.machine, item, body[at].items[:position])
                if moved is None:
                    raise _NoBound(f"{self._name(start)}, whose stack pointer moves by what is not constant")
                if item.address in calls:
                    most = max(most, depth - (own if item.kind == "jump" else 0) + callee(calls[item.address]))
                if saved := re.fullmatch(r"__riscv_save_(\d+)", self._name(calls.get(item.address, ""))):
                    moved = 16 * (int(saved[1]) // 4 + 1)  # it returns with the registers saved on the stack
                depth += 0 if item.conditional and item.kind == "return" else moved
                most = max(most, depth)
            for target in body[at].after:
                if target not in depths:
                    depths[target] = depth
                    todo.append(target)
                elif depths[target] != depth:
                    raise _NoBound(f"{self._name(start)}, whose stack differs between paths")
        return most

    def _callee_stack(self, target: int | str) -> int:
        if isinstance(target, str):
            raise _NoBound(f"{target}, which is not in {self.image.name}")
        return self._stack(target)


def _blocks(
    items: Mapping[int, Instruction],
    follow: Mapping[int, list[int]],
    leaders: set[int],
    calls: Mapping[int, list[tuple[Instruction, int | str]]],
    leaving: set[int],
) -> dict[int, _Block]:
    blocks = {}
    for leader in leaders:
        block = _Block([])
        address = leader
        while True:
            block.items.append(items[address])
            block.calls += calls.get(address, [])
            block.leaves = block.leaves or address in leaving
            targets = follow[address]
            if targets == [items[address].next] and targets[0] not in leaders:
                address = targets[0]
                continue
            block.after = list(dict.fromkeys(targets))
            break
        blocks[leader] = block
    return blocks


def _heads(start: int, blocks: Mapping[int, _Block]) -> set[int]:
    """Return the blocks that are reached again from what follows them: the heads of loops."""
    heads: set[int] = set()
    path, done = {start}, {start}
    work = [(start, iter(blocks[start].after))]
    while work:
        at, after = work[-1]
        target = next(after, None)
        if target is None:
            path.discard(at)
            work.pop()
        elif target in path:
            heads.add(target)
        elif target not in done:
            path.add(target)
            done.add(target)
            work.append((target, iter(blocks[target].after)))
    return heads


def _components(nodes: Sequence[int], edges: Mapping[int, Sequence[int]]) -> list[list[int]]:
    """Return the strongly connected components (Tarjan), each after those that it leads to."""
    order: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    on_stack: set[int] = set()
    answer: list[list[int]] = []
    for root in nodes:
        if root in order:
            continue
        work: list[tuple[int, int]] = [(root, 0)]
        while work:
            node, position = work.pop()
            if position == 0:
                order[node] = low[node] = len(order)
                stack.append(node)
                on_stack.add(node)
            advanced = False
            for k in range(position, len(edges[node])):
                target = edges[node][k]
                if target not in order:
                    work += [(node, k + 1), (target, 0)]
                    advanced = True
                    break
                if target in on_stack:
                    low[node] = min(low[node], order[target])
            if advanced:
                continue
            if low[node] == order[node]:
                part = []
                while True:
                    member = stack.pop()
                    on_stack.discard(member)
                    part.append(member)
                    if member == node:
                        break
                answer.append(part)
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[node])
    return answer


# ---------------------------------------------------------------------------------------------------------------------
# What instructions do to registers


def _changes(item: Instruction, register: str) -> bool:
    """Whether an instruction of a copying routine writes a register, judged by its text; rather yes than no."""
    first, *rest = re.split(r",\s*(?![^\[{]*[\]}])", item.operands)
    if re.match(r"^(?:str|st|cmp|cmn|tst|c?\.?s[bhw]|b|c\.b|cb)", item.mnemonic) and item.mnemonic not in (
        "bic",
        "bfi",
    ):
        return (f"[{register}]" in item.operands and bool(rest[1:])) or (
            f"[{register}, " in item.operands and "!" in item.operands
        )
    if re.search(rf"\b{register}\b", first):
        return True
    if item.mnemonic.startswith("ldrd") and rest and rest[0] == register:
        return True
    written_back = rf"\[{register}\], |\[{register}, [^\]]*\]!"
    return re.search(written_back, item.operands) is not None or first == f"{register}!"


def _stride(item: Instruction, register: str) -> int:
    """Return by how much an instruction moves a register, if by a constant; else 0."""
    found = re.fullmatch(rf"{register}, (?:{register}, )?#?(-?(?:0x[0-9a-f]+|\d+))", item.operands)
    if found and re.match(r"^(?:c\.)?(?:add|sub)[siw.]*$", item.mnemonic):
        return abs(int(found[1], 0))
    found = re.search(rf"\[{register}\], #(-?(?:0x[0-9a-f]+|\d+))", item.operands)
    found = found or re.search(rf"\[{register}, #(-?(?:0x[0-9a-f]+|\d+))\]!", item.operands)
    return abs(int(found[1], 0)) if found else 0


def _looked_at(items: Sequence[Instruction]) -> list[str]:
    """Return the registers that the conditional branch at the end of a block looks at."""
    last = items[-1]
    if re.match(r"^(?:c\.)?b(?:eq|ne|lt|ge|ltu|geu|gt|le|gtu|leu|eqz|nez|ltz|gez|gtz|lez)$", last.mnemonic) and (
        "," in last.operands
    ):
        return [word.strip() for word in last.operands.split(",")[:-1]]
    if last.mnemonic in ("cbz", "cbnz"):
        return [last.operands.split(",")[0]]
    for item in reversed(items[:-1]):
        if item.mnemonic.startswith(("cmp", "cmn")):
            return [word.strip() for word in item.operands.split(",") if not word.strip().startswith("#")]
        if re.match(r"^(?:adds|subs)", item.mnemonic):
            return [item.operands.split(",")[0]]
        if re.match(r"^(?:\w+s)(?:\.w)?$", item.mnemonic) and not item.mnemonic.startswith(("ldrs", "vab")):
            return []
    return []


def _sp_change(machine: str, item: Instruction, before: Sequence[Instruction]) -> int | None:
    """Return by how many bytes an instruction deepens the stack; None where that is not known."""
    return {"x86-64": _sp_x86, "thumb": _sp_thumb, "rv32": _sp_riscv}[machine](item, before)


def _gives_back(machine: str, item: Instruction, before: Sequence[Instruction]) -> bool:
    """Whether an instruction aligns the stack, or sets it from a register that points to its frame."""
    text = f"{item.mnemonic} {item.operands}"
    if machine == "x86-64":
        return bool(re.fullmatch(r"leave ?|and rsp, -?\w+|mov rsp, rbp|lea rsp, \[(?!rsp)\w+( [-+] \w+)?\]", text))
    if machine == "thumb" and (moved := re.fullmatch(r"mov sp, (\w+)", text)):
        last = f"{before[-1].mnemonic} {before[-1].operands}" if before else ""
        return moved[1] == "r7" or re.fullmatch(rf"subs?(?:\.w|w)? {moved[1]}, r7, #\w+", last) is not None
    return machine == "rv32" and re.fullmatch(r"(?:c\.)?mv sp, s0|addi sp, s0, -?\w+", text) is not None


def _immediate(text: str) -> int | None:
    found = re.fullmatch(r"#?(-?(?:0x[0-9a-f]+|\d+))", text.strip())
    return int(found[1], 0) if found else None


def _loaded(register: str, before: Sequence[Instruction]) -> int | None:
    """Return the constant that the instructions of this block before it loaded into a register."""
    value: int | None = None
    for item in before:
        words = [word.strip() for word in item.operands.split(",")]
        if words[0] != register:
            continue
        number = _immediate(words[-1])
        if number is None:
            value = None
        elif item.mnemonic in ("lui", "c.lui"):
            value = (number << 12) & 0xFFFFFFFF
        elif item.mnemonic in ("movt",):
            value = None if value is None else (value & 0xFFFF) | (number << 16)
        elif (item.mnemonic in ("addi", "c.addi") and words[1] == register) or item.mnemonic == "c.addi":
            value = None if value is None else (value + number) & 0xFFFFFFFF
        elif item.mnemonic in ("movw", "mov", "mov.w", "movs", "li", "c.li") or words[1] == "zero":
            value = number & 0xFFFFFFFF
        else:
            value = None
    return None if value is None else value - (1 << 32) if value >> 31 else value


def _sp_x86(item: Instruction, before: Sequence[Instruction]) -> int | None:
    words = [word.strip() for word in item.operands.split(",")]
    if item.mnemonic == "push":
        return 8
    if item.mnemonic == "pop":
        return -8
    if item.mnemonic in ("sub", "add") and words[0] == "rsp":
        number = _immediate(words[1])
        return None if number is None else number if item.mnemonic == "sub" else -number
    if item.mnemonic == "lea" and words[0] == "rsp":
        found = re.fullmatch(r"\[rsp ([-+]) (0x[0-9a-f]+|\d+)\]", words[1])
        return None if not found else int(found[2], 0) * (1 if found[1] == "-" else -1)
    if (words[0] == "rsp" and item.mnemonic not in ("cmp", "test")) or item.mnemonic in ("leave", "enter"):
        return None
    return 0


def _sp_thumb(item: Instruction, before: Sequence[Instruction]) -> int | None:
    name, text = item.mnemonic, item.operands
    if name.startswith(("push", "vpush", "pop", "vpop")):
        size = sum(8 if re.match(r"d\d", word.strip()) else 4 for word in text.strip("{}").split(","))
        return size if name.startswith(("push", "vpush")) else -size
    words = [word.strip() for word in text.split(",")]
    if name.startswith(("add", "sub")) and words[0] == "sp":
        number = _immediate(words[-1])
        if number is None:
            number = _loaded(words[-1], before)
        return None if number is None else number if name.startswith("sub") else -number
    if re.search(r"\[sp, [^\]]*\]!", text) or re.search(r"\[sp\], ", text):
        found = re.search(r"\[sp, #(-?(?:0x[0-9a-f]+|\d+))\]!|\[sp\], #(-?(?:0x[0-9a-f]+|\d+))", text)
        return None if not found else -int(found[1] or found[2], 0)
    if words[0] == "sp!":
        size = sum(8 if re.match(r"d\d", word.strip(" {}")) else 4 for word in words[1:])
        return size if name.startswith(("stm", "vstm")) else -size
    if words[0] == "sp" and not name.startswith(("cmp", "str", "tst", "ldm", "stm", "vldm", "vstm")):
        return None
    return 0


def _sp_riscv(item: Instruction, before: Sequence[Instruction]) -> int | None:
    words = [word.strip() for word in item.operands.split(",")]
    if words[0] != "sp" or re.match(r"^(?:c\.)?f?s[bhwd](?:sp)?$|^b", item.mnemonic):
        return 0
    number = _immediate(words[-1])
    if item.mnemonic in ("addi", "c.addi", "c.addi16sp"):
        return None if number is None else -number
    if item.mnemonic in ("add", "c.add"):
        number = _loaded(words[-1], before)
        return None if number is None else -number
    return None
