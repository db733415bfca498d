"""The machines an export can be measured on: their flags and sizes, the compilers that build for them, their emulators."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import shutil
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from elftools.elf.elffile import ELFFile

from .compiler import BASE_FLAGS, WARNINGS, Compiler, CompilerError, cache_folder, contraction_flag, find_compiler
from .emit import CText, templates

STACK = 32 * 1024
"""Bytes of stack that the emulated machine paints at least; a call that uses more is told."""

MACHINE_MEMORY = 4 * 1024 * 1024
"""Bytes of program memory and of data memory that the emulated machines have, whatever a target is said to have."""

SHIM = {"math.h": "freestanding_math.h", "string.h": "freestanding_string.h"}
"""Headers of the C library, as templates, for a compiler that comes without one (the zig wheel)."""


class TargetError(CompilerError):
    """A target that is not known, whose tools are missing, or that the code does not fit. One sentence."""


@dataclass(frozen=True)
class Target:
    """A machine the C is measured on.

    Attributes
    ----------
    name : str
        As the command line calls it.
    description : str
        What stands behind the name.
    flags : tuple of str
        Of the cross compiler, beside those every target gets.
    zig_flags : tuple of str
        The same machine in the words of the zig wheel.
    flash, ram : int
        Bytes a library and one instance of it must fit into; 0 where there is no such limit.
    fpu : str
        What it computes in hardware, in words.
    prefix : str
        Of the GNU cross compiler.
    compiler_packages, emulator_package : str
        Debian packages that bring them.
    emulator, machine : tuple of str
        Program and options of QEMU.
    script : str
        Template of the linker script.
    ticks_of_instruction : float
        Steps of the counter in the emulator for one instruction.
    """

    name: str
    description: str
    flags: tuple[str, ...] = ()
    zig_flags: tuple[str, ...] = ()
    flash: int = 0
    ram: int = 0
    fpu: str = ""
    prefix: str = ""
    compiler_packages: str = ""
    emulator: str = ""
    emulator_package: str = ""
    machine: tuple[str, ...] = ()
    script: str = ""
    ticks_of_instruction: float = 1.0

    @property
    def is_host(self) -> bool:
        """Whether it is the machine that exports."""
        return not self.emulator

    def with_sizes(self, flash: int | None = None, ram: int | None = None) -> Target:
        """Return the target with other sizes of flash and RAM, in bytes."""
        return replace(self, flash=flash or self.flash, ram=ram or self.ram)


_ARM = {
    "prefix": "arm-none-eabi-",
    "compiler_packages": "gcc-arm-none-eabi libnewlib-arm-none-eabi",
    "emulator": "qemu-system-arm",
    "emulator_package": "qemu-system-arm",
    "script": "arm.ld.j2",
}
# one instruction is 1024 ns of emulated time, and the boards' timers count at 25 MHz
_ARM_ICOUNT, _ARM_TICKS = ("-icount", "shift=10"), 1024.0 / 40.0

TARGETS: dict[str, Target] = {
    target.name: target
    for target in (
        Target("host", "the machine that exports", fpu="float and double in hardware"),
        Target(
            "cortex-m4",
            "Cortex-M4F, as on QEMU's board mps2-an386",
            flags=("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"),
            # without +vfp4d16sp zig silently calls soft-float functions, in an ELF marked hard-float
            zig_flags=("-target", "thumb-freestanding-eabihf", "-mcpu=cortex_m4+vfp4d16sp"),
            flash=1024 * 1024,
            ram=256 * 1024,
            fpu="float in hardware, double in software",
            machine=("-M", "mps2-an386", *_ARM_ICOUNT),
            ticks_of_instruction=_ARM_TICKS,
            **_ARM,
        ),
        Target(
            "cortex-m7",
            "Cortex-M7 with a double precision FPU, as on QEMU's board mps2-an500",
            flags=("-mcpu=cortex-m7", "-mthumb", "-mfpu=fpv5-d16", "-mfloat-abi=hard"),
            zig_flags=("-target", "thumb-freestanding-eabihf", "-mcpu=cortex_m7+fp_armv8d16"),
            flash=2 * 1024 * 1024,
            ram=512 * 1024,
            fpu="float and double in hardware",
            machine=("-M", "mps2-an500", *_ARM_ICOUNT),
            ticks_of_instruction=_ARM_TICKS,
            **_ARM,
        ),
        Target(
            "rv32",
            "RISC-V rv32imafc, as on QEMU's board virt",
            flags=("-march=rv32imafc", "-mabi=ilp32f", "--specs=picolibc.specs"),
            zig_flags=("-target", "riscv32-freestanding-none", "-mcpu=generic_rv32+m+a+f+c"),
            flash=1024 * 1024,
            ram=256 * 1024,
            fpu="float in hardware, double in software",
            prefix="riscv64-unknown-elf-",
            compiler_packages="gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf",
            emulator="qemu-system-riscv32",
            emulator_package="qemu-system-misc",
            machine=("-M", "virt", "-bios", "none", "-icount", "shift=0"),
            script="rv32.ld.j2",
        ),
    )
}
"""Every target, by name."""


def target_named(name: str) -> Target:
    """Return a target.

    Raises
    ------
    TargetError
        If there is none of that name; it lists those there are.
    """
    try:
        return TARGETS[name]
    except KeyError:
        raise TargetError(f"there is no target {name!r}; take one of {', '.join(TARGETS)}") from None


@dataclass(frozen=True)
class Toolchain:
    """A compiler that builds for a target.

    Attributes
    ----------
    target : Target
        What it builds for.
    compiler : Compiler
        What is called.
    kind : {"gcc", "zig", "host"}
        Whose words the flags are.
    """

    target: Target
    compiler: Compiler
    kind: str

    @property
    def flags(self) -> tuple[str, ...]:
        """Flags of every compilation for the target, but for contraction. Debug information changes no code."""
        if self.kind == "host":
            return (*BASE_FLAGS, "-g", "-fno-math-errno")  # as on the targets: else sqrt is called to set errno
        if self.kind == "zig":
            unwanted = (
                "-fno-asynchronous-unwind-tables",
                "-fno-unwind-tables",
                "-fno-sanitize=all",
                "-fno-stack-protector",
            )
            # freestanding turns builtins off, and with them the FPU's own instructions for fabs and sqrt
            return (*BASE_FLAGS, "-g", *self.target.zig_flags, "-fbuiltin", "-fno-short-enums", *unwanted, "-Ishim")
        # enums as wide as on the host, so that the structs are laid out alike
        return (
            *BASE_FLAGS,
            "-g",
            *self.target.flags,
            "-fno-short-enums",
            "-fno-math-errno",
            "-ffunction-sections",
            "-fdata-sections",
        )

    def as_dict(self, contract: bool) -> dict[str, object]:
        """Return it for the evidence."""
        return {
            "label": self.compiler.label,
            "version": self.compiler.version(),
            "flags": [*self.flags, contraction_flag(contract)],
        }

    def key(self) -> str:
        """Return what two toolchains that build alike have in common."""
        own = [templates().get_template(name).render() for name in (*SHIM.values(), "freestanding_main.c")]
        return "\0".join([*self.compiler.command, self.compiler.version(), *self.flags, *own])

    def run(self, arguments: list[str], folder: Path) -> None:
        """Call the compiler.

        Raises
        ------
        TargetError
            If its C library is missing, or the code does not fit the target.
        CompilerError
            With what it said, otherwise.
        """
        try:
            self.compiler.run(arguments, folder)
        except CompilerError as error:
            said = str(error)
            absent = ("math.h: No such file", "cannot read spec file", "cannot find -l", "stdint.h: No such file")
            if any(words in said for words in absent):
                raise TargetError(
                    f"{self.compiler.label} finds no C library for the target {self.target.name}; install it: "
                    f"apt install {self.target.compiler_packages}"
                ) from None
            raise

    def compile(self, sources: Mapping[str, str], folder: Path, *, contract: bool = False) -> None:
        """Write sources into a folder and compile each ``.c`` that is library code into an object of its name."""
        if self.kind == "zig":
            (folder / "shim").mkdir(exist_ok=True)
            for file, template in SHIM.items():
                (folder / "shim" / file).write_text(templates().get_template(template).render())
        for file, text in sources.items():
            (folder / file).write_text(text)
            if file.endswith(".c") and not file.endswith("_main.c"):
                self.run([*self.flags, *WARNINGS, contraction_flag(contract), "-c", file], folder)

    def library_object(self, text: CText, folder: Path, *, contract: bool = False) -> Path:
        """Compile a library into ``folder/<name>.o`` with the target's flags, and return the object."""
        self.compile({f"{text.name}.h": text.header, f"{text.name}.c": text.source}, folder, contract=contract)
        return folder / f"{text.name}.o"

    def link(
        self, objects: list[str], result: str, folder: Path, *, flash: int, ram: int, entry: str, stack: int = STACK
    ) -> Path:
        """Link objects (and ``_main.c`` files) for the target, without anybody's start-up code."""
        script = templates().get_template(self.target.script).render(flash=flash, ram=ram, entry=entry, stack=stack)
        (folder / f"{result}.ld").write_text(script)
        libraries = ["-lm"] if self.kind == "gcc" else []
        if self.kind == "zig":
            (folder / "freestanding_main.c").write_text(templates().get_template("freestanding_main.c").render())
            self.run([*self.flags, "-fno-builtin", "-ffunction-sections", "-c", "freestanding_main.c"], folder)
            own = ["freestanding_main.o", f"-Wl,-e,{entry}", "-Wl,--no-eh-frame-hdr"]
        else:
            own = ["-nostartfiles"]
        options = [*self.flags, *own, "-Wl,--gc-sections", "-T", f"{result}.ld"]
        self.run([*options, *objects, *libraries, "-o", f"{result}.elf"], folder)
        return folder / f"{result}.elf"

    def program(self, sources: Mapping[str, str], *, contract: bool = False, stack: int = STACK) -> Path:
        """Return a program of some C text for the emulator, linked once for each text and toolchain.

        Parameters
        ----------
        sources : dict
            File name -> text. Library code, and files ending in ``_main.c``, which get no contraction.
        contract : bool
            Whether a product and a sum may be fused in the library.
        stack : int
            Bytes of stack to paint.
        """
        digest = hashlib.sha256(f"{self.key()}\0{self.target.name}\0{contract}\0".encode())
        script = templates().get_template(self.target.script).render(flash=0, ram=0, entry="reset", stack=stack)
        for name in sorted(sources):
            digest.update(f"{name}\0{sources[name]}\0".encode())
        digest.update(script.encode())
        kept = cache_folder() / f"{digest.hexdigest()[:24]}.elf"
        if kept.exists():
            return kept
        with tempfile.TemporaryDirectory(prefix="plantc-") as name:
            folder = Path(name)
            self.compile(sources, folder, contract=contract)
            parts = [f"{file.removesuffix('.c')}.o" for file in sources if _is_library(file)]
            parts += [file for file in sources if file.endswith("_main.c")]
            size = MACHINE_MEMORY
            built = self.link(parts, "program", folder, flash=size, ram=size, entry="reset", stack=stack)
            partial = kept.with_suffix(f".{os.getpid()}.tmp")
            shutil.copy(built, partial)
            os.replace(partial, kept)
        return kept


def _is_library(file: str) -> bool:
    return file.endswith(".c") and not file.endswith("_main.c")


def find_toolchain(target: Target, *, kind: str = "") -> Toolchain:
    """Return the GNU cross compiler of a target where it is installed, else the zig wheel.

    Parameters
    ----------
    target : Target
        What to build for.
    kind : {"", "gcc", "zig"}
        Take this one and no other.

    Raises
    ------
    TargetError
        If there is none; it says what to install.
    """
    if target.is_host:
        return Toolchain(target, find_compiler(), "host")
    label = f"{target.prefix}gcc"
    path = shutil.which(label)
    if path and kind in ("", "gcc"):
        return Toolchain(target, Compiler((path,), label), "gcc")
    if importlib.util.find_spec("ziglang") is not None and kind in ("", "zig"):
        return Toolchain(target, Compiler((sys.executable, "-m", "ziglang", "cc"), "zig"), "zig")
    raise TargetError(
        f"no compiler for the target {target.name} found: neither {label} nor the zig wheel; install one: "
        f"apt install {target.compiler_packages}, or pip install 'plantc[compiler]'"
    )


def find_emulator(target: Target) -> str:
    """Return the path of a target's emulator.

    Raises
    ------
    TargetError
        If it is not installed; it says what to install.
    """
    path = shutil.which(target.emulator)
    if path is None:
        raise TargetError(
            f"no emulator for the target {target.name} found: {target.emulator} is not on the PATH; install it: "
            f"apt install {target.emulator_package}"
        )
    return path


def installed_targets() -> tuple[str, ...]:
    """Return the names of the targets whose tools are all installed, the host first."""
    names = []
    for target in TARGETS.values():
        try:
            find_toolchain(target)
            if not target.is_host:
                find_emulator(target)
        except CompilerError:
            continue
        names.append(target.name)
    return tuple(names)


# ---------------------------------------------------------------------------------------------------------------------
# Sizes


@dataclass(frozen=True)
class Sizes:
    """Bytes of an object or a program: code and constants, initialised data, zeroed data."""

    text: int
    data: int
    bss: int

    def as_dict(self) -> dict[str, int]:
        """Return it for the evidence."""
        return {"text": self.text, "data": self.data, "bss": self.bss}

    @classmethod
    def of(cls, path: Path) -> Sizes | None:
        """Return those of an ELF file (unwind tables, which bare metal discards, left out); None for other formats."""
        with path.open("rb") as stream:
            if stream.read(4) != b"\x7fELF":
                return None
            stream.seek(0)
            text = data = bss = 0
            for section in ELFFile(stream).iter_sections():
                flags = section["sh_flags"]
                if not flags & 2 or section.name.startswith((".eh_frame", ".ARM.ex", ".note")):  # 2: allocated
                    continue
                if section["sh_type"] == "SHT_NOBITS":
                    bss += section["sh_size"]
                elif flags & 1:  # writable
                    data += section["sh_size"]
                else:
                    text += section["sh_size"]
            return cls(text, data, bss)


def linked_library(
    toolchain: Toolchain, text: CText, entries: Sequence[str], folder: Path, *, contract: bool = False
) -> Path:
    """Return a library linked for a target with all it calls (the compiler's and the C library's functions), and no more.

    Parameters
    ----------
    toolchain : Toolchain
        Not the host's.
    text : CText
        The library.
    entries : sequence of str
        What a user may call.
    folder : Path
        Where it is built.
    contract : bool
        Whether a product and a sum may be fused.
    """
    toolchain.library_object(text, folder, contract=contract)
    table = "".join(
        f"extern int {text.name}_{entry}(void);\nint (*const keep_{entry})(void) __attribute__((section("
        f'".vectors"), used)) = {text.name}_{entry};\n'
        for entry in entries
    )
    (folder / "table_main.c").write_text(table)
    parts, first = [f"{text.name}.o", "table_main.c"], f"{text.name}_{entries[0]}"
    return toolchain.link(parts, "library", folder, flash=MACHINE_MEMORY, ram=MACHINE_MEMORY, entry=first)
