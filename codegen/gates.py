"""Gates that every export passes: what is in the object file, what loops there are, what compilers say.

A symbol belongs to one gate: heap functions to "no heap", software double to "no double in float" (in a float build), all
others to "only listed symbols". So a fault is told by the gate that is named after it.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from .addresses import fixed_addresses
from .bounds import Analysis, Unknown, source_loops, without_comments
from .compiler import BASE_FLAGS, WARNINGS, Compiler, CompilerError
from .emit import CText
from .findings import CheckResult
from .objects import Image, read_image

HEAP = frozenset(
    "malloc calloc realloc reallocarray free aligned_alloc posix_memalign memalign valloc pvalloc strdup strndup asprintf "
    "vasprintf getline sbrk _sbrk brk mmap munmap _malloc_r _calloc_r _realloc_r _free_r pvPortMalloc vPortFree k_malloc "
    "k_free _Znwm _Znam _Znwj _Znaj _ZdlPv _ZdaPv".split()
)
"""Functions that take or give memory at run time."""

INSERTED = frozenset(
    "memcpy memset memmove __aeabi_memcpy __aeabi_memcpy4 __aeabi_memcpy8 __aeabi_memset __aeabi_memset4 __aeabi_memset8 "
    "__aeabi_memclr __aeabi_memclr4 __aeabi_memclr8 __aeabi_memmove __stack_chk_fail __stack_chk_guard "
    "__aeabi_unwind_cpp_pr0".split()
)
"""What a compiler may call where the C assigns a struct, and what a hardened one adds."""

LONG_INTEGERS = frozenset(
    "__aeabi_lmul __aeabi_llsl __aeabi_llsr __aeabi_lasr __aeabi_uldivmod __aeabi_ldivmod __muldi3 __ashldi3 __lshrdi3 "
    "__ashrdi3 __udivdi3 __umoddi3 __divdi3 __moddi3 __clzsi2 __clzdi2".split()
)
"""Integers of 64 bits on a processor of 32."""

SOFT_DOUBLE = frozenset(
    "__aeabi_dadd __aeabi_dsub __aeabi_drsub __aeabi_dmul __aeabi_ddiv __aeabi_dcmpeq __aeabi_dcmplt __aeabi_dcmple "
    "__aeabi_dcmpge __aeabi_dcmpgt __aeabi_dcmpun __aeabi_cdcmpeq __aeabi_cdcmple __aeabi_cdrcmple __aeabi_i2d "
    "__aeabi_ui2d __aeabi_l2d __aeabi_ul2d __aeabi_d2iz __aeabi_d2uiz __aeabi_d2lz __aeabi_d2ulz __aeabi_d2f __aeabi_f2d "
    "__adddf3 __subdf3 __muldf3 __divdf3 __negdf2 __eqdf2 __nedf2 __ltdf2 __ledf2 __gedf2 __gtdf2 __unorddf2 __fixdfsi "
    "__fixunsdfsi __fixdfdi __fixunsdfdi __floatsidf __floatunsidf __floatdidf __floatundidf __truncdfsf2 "
    "__extendsfdf2".split()
)
"""Double in software: allowed in a double build, and a fault in a float one."""

_MATHEMATICS = (
    "sin cos tan asin acos atan atan2 exp log pow tanh sinh cosh log1p expm1 hypot fmod sqrt fabs floor".split()
)
_DOUBLE_X86 = re.compile(
    r"v?(?:(?:add|sub|mul|div|sqrt|min|max|cmp\w*|u?comi|round|dp|hadd|hsub|fn?m(?:add|sub)\d+)[sp]d|cvt\w*[sp]d\w*)"
)
_DOUBLE_RISCV = re.compile(r"f(?!mv\.)\w+(?:\.\w+)*\.d(?:\.\w+)?|fcvt\.d\.\w+")


def allowed_symbols(text: CText, machine: str) -> set[str]:
    """Return what may be undefined in the object of some C: what a compiler inserts, and the functions of math.h it calls."""
    code = re.sub(r"/\*.*?\*/", " ", text.source, flags=re.DOTALL)
    suffix = "f" if text.precision.is_float else ""
    called = {name for name in _MATHEMATICS if re.search(rf"\b{name}{suffix}\(", code)}
    names = {f"{name}{suffix}" for name in called} | INSERTED
    if {"sin", "cos"} <= called:
        names.add(f"sincos{suffix}")
    if machine != "x86-64":
        names |= LONG_INTEGERS
        if not text.precision.is_float:
            names |= SOFT_DOUBLE
    return names


PLAIN = (
    *("-O0", "-fno-optimize-sibling-calls", "-fno-jump-tables", "-fstack-usage"),
    *("-fno-stack-protector", "-fno-sanitize=all"),
)
"""Flags of a build as a debugger wants it: what `-O2` hides (a recursion made a loop, say) is there to be seen, and
nothing that a compiler adds unasked where it does not optimise (the zig wheel does)."""

ROOM_WARNINGS = ("-Wvla", "-Walloca")
"""Warnings of stack that is taken at run time, as far as a compiler knows them."""


@dataclass(frozen=True)
class Plain:
    """A library built with the flags `PLAIN`.

    Attributes
    ----------
    image : Image
        Its object.
    usage : dict
        Function -> kind of its frame as the compiler states it: ``static``, ``dynamic`` or ``dynamic,bounded``; empty
        where the compiler states none.
    """

    image: Image
    usage: Mapping[str, str]


def build_plain(run: Callable[[list[str], Path], None], flags: Sequence[str], text: CText, folder: Path) -> Plain:
    """Compile a library that lies in a folder with a compiler's flags and `PLAIN`.

    Raises
    ------
    ObjectError
        If the object is not for a machine that is understood.
    """
    for old in folder.glob("*.su"):
        old.unlink()
    run([*flags, *PLAIN, "-c", f"{text.name}.c", "-o", "plain.o"], folder)
    rows = [line.split("\t") for path in folder.glob("*.su") for line in path.read_text().splitlines()]
    return Plain(read_image(folder / "plain.o"), {row[0].split(":")[-1]: row[2] for row in rows if len(row) > 2})


def object_gates(image: Image, text: CText, where: str = "host", plain: Plain | None = None) -> list[CheckResult]:
    """Look at an object file: heap, symbols, double in float, recursion, frames, globals, fixed addresses, loops.

    Parameters
    ----------
    image : Image
        The object of the library, not linked.
    text : CText
        The C it was compiled from.
    where : str
        The machine, for the names of the checks.
    plain : Plain, optional
        The same built plainly: recursion, frames and addresses are looked for there too, and loops there alone.
    """

    def gate(name: str, faults: Sequence[str]) -> CheckResult:
        shown = "; ".join(faults[:5]) + (f"; and {len(faults) - 5} more" if len(faults) > 5 else "")
        return CheckResult(f"{name} ({where})", not faults, note=shown)

    heap = [name for name in image.undefined if name in HEAP]
    allowed = allowed_symbols(text, image.machine)
    soft = SOFT_DOUBLE if text.precision.is_float else frozenset()
    others = [name for name in image.undefined if name not in allowed | HEAP | soft]
    results = [
        gate("no heap", [f"it calls {name}" for name in heap]),
        gate("only listed symbols", [f"it needs {name}, which is not on the list" for name in others]),
    ]
    if text.precision.is_float:
        results.append(gate("no double in float", _doubles(image)))
    images = [image] if plain is None else [image, plain.image]
    results.append(gate("no recursion", _once(fault for item in images for fault in _recursion(item.calls()))))
    results.append(gate("frames of fixed size", _frames(image, {} if plain is None else plain.usage)))
    globals_ = [f"{item.name} ({item.size} bytes in {item.section})" for item in image.objects if item.writable]
    globals_ += [] if globals_ else [f"{name} has {size} bytes" for name, size in image.writable_sections]
    results.append(gate("no globals", globals_))
    results.append(gate("no fixed address", _once(fault for item in images for fault in fixed_addresses(item))))
    if plain is not None:
        results.append(gate("no loop but those of the C", _loops_beside(plain.image, text)))
    return results


def _once(faults: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(faults))


def loops_gate(text: CText) -> CheckResult:
    """Look at the C: every loop is a `for` whose trips are fixed, and the header has none."""
    free = [(loop, "") for loop in source_loops(text.source) if loop.trips is None]
    free += [(loop, " of the header") for loop in source_loops(text.header)]
    note = "; ".join(f"line {loop.first}{where}: {loop.head}" for loop, where in free[:5])
    return CheckResult("no unbounded loop", not free, note=note)


_TO_POINTER = re.compile(
    r"\*\s*(?:const|volatile|restrict|\s)*\)\s*\(*\s*(?:0[xX][0-9a-fA-F]+|[1-9]\d*)[uUlL]*\b|\bu?intptr_t\b"
)


def addresses_gate(text: CText) -> CheckResult:
    """Look at the C and its header: no number is made a pointer, and no pointer a number."""
    faults = []
    for file, content in ((f"{text.name}.c", text.source), (f"{text.name}.h", text.header)):
        code = without_comments(content)
        faults += [f"line {code.count(chr(10), 0, at.start()) + 1} of {file}" for at in _TO_POINTER.finditer(code)]
    return CheckResult("no number made a pointer", not faults, note="; ".join(faults[:5]))


def _frames(image: Image, usage: Mapping[str, str]) -> list[str]:
    """Return the functions whose frame is not of a fixed size: as the compiler says, and as the machine code shows."""
    faults = [
        f"{name} takes stack at run time, says the compiler ({kind})"
        for name, kind in usage.items()
        if "dynamic" in kind and "bounded" not in kind
    ]
    graph, analysis = image.calls(), Analysis(image)
    for name, callees in graph.items():
        if None not in callees:  # else it fails for that, and its code cannot be followed
            reason = analysis.takes_stack_freely(name)
            faults += [f"the frame of {name} is unknown because of {reason}"] if reason else []
    return faults


def _loops_beside(image: Image, text: CText) -> list[str]:
    """Return the functions whose machine code has more loops than their C has bounded ones."""
    known = Counter(loop.function for loop in source_loops(text.source) if loop.trips is not None)
    analysis = Analysis(image)
    faults = []
    for name, callees in image.calls().items():
        found = analysis.cycles(name)
        if isinstance(found, Unknown):
            faults += [] if None in callees else [f"the loops of {name} are {found}"]
        elif found > known[name]:
            faults.append(f"{name} has {found} in machine code, {known[name]} bounded in the C")
    return faults


def _doubles(image: Image) -> list[str]:
    """Return where a float object computes in double: instructions, and software double."""
    faults = [f"it calls {name}" for name in image.undefined if name in SOFT_DOUBLE]
    for item in image.instructions():
        name = item.mnemonic
        found = (
            (
                image.machine == "x86-64"
                and (_DOUBLE_X86.fullmatch(name) or re.match(r"f(?:ld|add|mul|st|div|sub)", name))
            )
            or (image.machine == "thumb" and ".f64" in name and not name.startswith("vmov"))
            or (image.machine == "rv32" and _DOUBLE_RISCV.fullmatch(name))
        )
        if found:
            owner = image.function_at(item.address)
            faults.append(f"{name} in {owner.name if owner else 'no function'}")
    return list(dict.fromkeys(faults))


def _recursion(graph: Mapping[str, set[str | None]]) -> list[str]:
    """Return the cycles of a call graph, one for each function that reaches itself, and the indirect calls."""
    faults = [
        f"an indirect call in {name}, which could go anywhere" for name, callees in graph.items() if None in callees
    ]
    for name in graph:
        todo, seen = [item for item in graph[name] if item], set()
        while todo:
            item = todo.pop()
            if item not in seen:
                seen.add(item)
                todo += [callee for callee in graph.get(item, ()) if callee]
        if name in seen:
            faults.append(f"{name} reaches itself")
    return faults


# ---------------------------------------------------------------------------------------------------------------------
# Compilers


def installed_compilers() -> tuple[list[Compiler], list[str]]:
    """Return gcc and clang as far as they are installed, and the names of those that are not."""
    found = {name: shutil.which(name) for name in ("gcc", "clang")}
    have = [Compiler((path,), name) for name, path in found.items() if path]
    return have, [name for name, path in found.items() if not path]


def warnings_gate(compiler: Compiler, text: CText, folder: Path) -> CheckResult:
    """Compile a library as C99 with all warnings as errors: those of `WARNINGS` and `ROOM_WARNINGS`."""
    write_library(text, folder)
    flags = [
        *BASE_FLAGS,
        *WARNINGS,
        *[flag for flag in ROOM_WARNINGS if _knows(compiler, flag, folder)],
        "-ffp-contract=off",
        "-c",
        f"{text.name}.c",
        "-o",
        f"{text.name}.{compiler.label}.o",
    ]
    return _said_nothing(f"no warnings ({compiler.label})", compiler, flags, folder)


def header_gate(compiler: Compiler, text: CText, folder: Path) -> CheckResult:
    """Compile the header of a library as C++, with warnings as errors."""
    write_library(text, folder)
    (folder / "header_main.cpp").write_text(
        f'#include "{text.name}.h"\nint main() {{ {text.name}_state_t state; (void)state; return 0; }}\n'
    )
    flags = ["-x", "c++", "-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "header_main.cpp"]
    return _said_nothing(f"header as C++ ({compiler.label})", compiler, flags, folder)


def write_library(text: CText, folder: Path) -> None:
    """Write header and source into a folder."""
    (folder / f"{text.name}.h").write_text(text.header)
    (folder / f"{text.name}.c").write_text(text.source)


def _knows(compiler: Compiler, flag: str, folder: Path) -> bool:
    with tempfile.TemporaryDirectory(dir=folder) as aside:  # a block may have any name
        (Path(aside) / "empty.c").write_text("typedef int nothing;\n")
        return _said_nothing("", compiler, ["-Werror", flag, "-fsyntax-only", "empty.c"], Path(aside)).passed


def _said_nothing(name: str, compiler: Compiler, flags: Sequence[str], folder: Path) -> CheckResult:
    try:
        compiler.run(flags, folder)
    except CompilerError as error:
        return CheckResult(name, False, note=str(error)[:600])
    return CheckResult(name, True)
