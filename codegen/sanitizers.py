"""The shipped vectors and the fuzz harness, run under sanitizers, and libFuzzer's search for new paths.

Division by zero is no finding: a candidate value may be infinite or NaN, and the judgement refuses it. A conversion of
NaN, or of a number beyond the range, to an integer is one.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .exported import AuditError, ExportedFolder, MissingTool, run_tool, tool
from .findings import CheckResult, Findings

UNDEFINED = ("-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")
UNINITIALISED = ("-fsanitize=memory", "-fno-sanitize-recover=all")
BASE = ("-std=c99", "-O1", "-g", "-ffp-contract=off")
HARNESS = "verify/fuzz_main.c"

_SUMMARY = re.compile(r"^(\d+) calls, (\d+) refused, (\d+) lost$", re.MULTILINE)
_ENTRY = re.compile(r"^(\w+):((?: [A-Z_]+ \d+)*)$", re.MULTILINE)
_COMPLAINT = re.compile(r"^(?:.*runtime error: .*|.*(?:Address|Memory)Sanitizer: .*|lost in call .*)$", re.MULTILINE)


@dataclass
class FuzzResult:
    """What a run of the harness gave.

    Attributes
    ----------
    calls, refused, lost : int
        How many calls were made, were refused, and left something they must not.
    statuses : dict
        Entry -> status -> how often.
    complaints : list of str
        What was lost, and what a sanitizer said.
    ended : int
        Exit status of the program.
    """

    calls: int = 0
    refused: int = 0
    lost: int = 0
    statuses: dict[str, dict[str, int]] = field(default_factory=dict)
    complaints: list[str] = field(default_factory=list)
    ended: int = 0

    @property
    def good(self) -> bool:
        """Whether nothing was lost and no sanitizer complained."""
        return self.ended == 0 and self.lost == 0 and not self.complaints

    @classmethod
    def read(cls, said: str, ended: int) -> FuzzResult:
        """Read what a harness and its sanitizers printed."""
        found = _SUMMARY.search(said)
        calls, refused, lost = (int(item) for item in found.groups()) if found else (0, 0, 0)
        statuses: dict[str, dict[str, int]] = {}
        if found:
            for name, text in _ENTRY.findall(said):
                words = text.split()
                statuses[name] = {word: int(count) for word, count in zip(words[::2], words[1::2], strict=True)}
        complaints = list(dict.fromkeys(_COMPLAINT.findall(said)))
        if ended and not complaints:
            complaints = [f"the harness ended with {ended}: {said.strip()[-300:]}"]
        return cls(calls, refused, lost, statuses, complaints, ended)

    def facts(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {"calls": self.calls, "refused": self.refused, "lost": self.lost, "statuses": self.statuses}


def refusal(compiler: str, said: str) -> str:
    """Return a sentence from what a compiler printed when it refused some C."""
    lines = said.strip().split("\n")
    first = next((line for line in lines if "error" in line), lines[0])
    return f"{compiler} refused {first.strip()}; export again, or mend it"


def build(compiler: str, flags: Sequence[str], folder: Path, files: Sequence[str], target: Path) -> Path:
    """Compile C files of a folder into a program.

    Parameters
    ----------
    compiler : str
        ``gcc`` or ``clang``.
    flags : sequence of str
        What to instrument.
    folder : Path
        An exported folder.
    files : sequence of str
        Paths inside it.
    target : Path
        The program.

    Raises
    ------
    MissingTool
        If the compiler, or the run-time library of a sanitizer, is not installed.
    AuditError
        If the compiler refuses the C.
    """
    command = [tool(compiler), *BASE, *flags, "-I", "src", *files, "-lm", "-o", str(target)]
    done = run_tool(command, folder)
    if done.returncode != 0:
        said = done.stderr.strip()
        if "cannot find" in said or "No such file" in said:
            package = "libclang-rt-14-dev" if compiler == "clang" else "gcc"
            raise MissingTool(
                f"{compiler} has no run-time library for {flags[0]}; install it (Debian: apt install {package})"
            )
        raise AuditError(refusal(compiler, said))
    return target


def fuzz(
    folder: Path,
    name: str,
    *,
    calls: int,
    compiler: str = "gcc",
    flags: Sequence[str] = UNDEFINED,
    seed: int = 1,
    into: Path | None = None,
    inputs: Sequence[Path] = (),
) -> FuzzResult:
    """Run the harness of an exported folder: random calls with a fixed seed, the same on every machine.

    Parameters
    ----------
    folder : Path
        An exported folder.
    name : str
        Its block.
    calls : int
        How many calls are made at least.
    compiler, flags
        What it is built with; ``("--coverage",)`` leaves the counts of gcov in `into`.
    seed : int
        Of the random numbers.
    into : Path, optional
        Where the program and its by-products go; by default a folder that is removed again.
    inputs : sequence of Path
        Files that libFuzzer kept: replayed instead of random calls.

    Returns
    -------
    FuzzResult
        Calls, statuses, and whatever was lost.
    """
    with tempfile.TemporaryDirectory(prefix="plantc-") as temporary:
        target = (into or Path(temporary)) / "fuzz"
        program = build(compiler, flags, folder, [f"src/{name}.c", HARNESS], target.absolute())
        arguments = [str(item.absolute()) for item in inputs] or [str(calls), str(seed)]
        done = run_tool([program, *arguments], program.parent)
        return FuzzResult.read(done.stdout + done.stderr, done.returncode)


def search(
    folder: Path,
    name: str,
    *,
    seconds: float = 0.0,
    inputs: int = 0,
    seed: int = 1,
    corpus: Path | None = None,
) -> FuzzResult:
    """Let libFuzzer look for new paths through the library, under address and undefined-behaviour sanitizers.

    Parameters
    ----------
    folder : Path
        An exported folder.
    name : str
        Its block.
    seconds : float
        How long, if not 0.
    inputs : int
        How many inputs at most, if not 0; each is a sequence of calls.
    seed : int
        Of libFuzzer.
    corpus : Path, optional
        A folder that gets the fewest inputs that reach all paths found.

    Raises
    ------
    MissingTool
        If there is no clang with libFuzzer.
    """
    clang = tool("clang")
    with tempfile.TemporaryDirectory(prefix="plantc-") as temporary:
        work = Path(temporary)
        found = work / "found"
        found.mkdir()
        objects = []
        # only the library counts as new ground, not the harness
        for file, traced in ((f"src/{name}.c", ["-fsanitize=fuzzer-no-link"]), (HARNESS, ["-DWITH_LIBFUZZER"])):
            target = work / (Path(file).stem + ".o")
            done = run_tool([clang, *BASE, *UNDEFINED, *traced, "-I", "src", "-c", file, "-o", target], folder)
            if done.returncode != 0:
                raise AuditError(refusal("clang", done.stderr))
            objects.append(str(target))
        program = build("clang", ("-fsanitize=fuzzer", *UNDEFINED), folder, objects, work / "search")
        limits = [f"-max_total_time={max(1, round(seconds))}"] if seconds else []
        limits += [f"-runs={inputs}"] if inputs else []
        options = ["-len_control=0", "-max_len=4096", "-print_final_stats=0", f"-seed={seed}", *limits]
        done = run_tool([program, *options, "found"], work, seconds=seconds + 600)
        if corpus is not None:
            corpus.mkdir(parents=True, exist_ok=True)
            run_tool([program, "-merge=1", corpus.absolute(), "found"], work)
        return FuzzResult.read(done.stdout + done.stderr, done.returncode)


def both_ways(result: FuzzResult, manifest: dict[str, Any]) -> list[str]:
    """Return the entries that were never accepted, or never refused though they can be."""
    missing = []
    for name, entry in manifest["entries"].items():
        reached = result.statuses.get(name, {})
        refused = sum(count for word, count in reached.items() if word in REFUSALS)
        judged = manifest["parameters"] if name == "init" else entry["inputs"]
        if sum(reached.values()) == refused:
            missing.append(f"{name} was never accepted")
        if refused == 0 and _has_real(judged):
            missing.append(f"{name} was never refused")
    return missing


REFUSALS = frozenset({"BAD_INPUT", "BAD_PARAM", "NOT_POSITIVE", "OVERFLOW"})


def _has_real(fields: list[dict[str, Any]]) -> bool:
    return any(item["kind"] == "real" or _has_real(item.get("fields", [])) for item in fields)


def _checks(label: str, result: FuzzResult, folder: ExportedFolder) -> list[CheckResult]:
    missing = both_ways(result, folder.manifest) if result.good else []
    return [
        CheckResult(
            f"{label}: nothing lost",
            result.good,
            calls=result.calls,
            note="; ".join(result.complaints[:3]) or f"{result.refused} refused",
        ),
        CheckResult(
            f"{label}: every entry accepted and refused",
            result.good and not missing,
            calls=result.calls,
            note="; ".join(missing) or ("" if result.good else "see above"),
        ),
    ]


def _vectors(compiler: str, flags: Sequence[str], folder: ExportedFolder, label: str) -> CheckResult:
    with tempfile.TemporaryDirectory(prefix="plantc-") as name:
        files = [*folder.library, "test/test_vectors.c"]
        program = build(compiler, flags, folder.path, files, Path(name) / "vectors")
        done: subprocess.CompletedProcess[str] = run_tool([program], Path(name))
    said = (done.stdout + done.stderr).strip()
    found = re.search(r"^(\d+) vectors, 0 failed$", said, re.MULTILINE)
    passed = done.returncode == 0 and found is not None
    note = "" if passed else "; ".join(_COMPLAINT.findall(said)[:3]) or said[-300:]
    return CheckResult(f"{label}: shipped vectors", passed, calls=int(found[1]) if found else 0, note=note)


def audit_sanitizers(folder: ExportedFolder) -> Findings:
    """Run the vectors and random calls under the address and undefined-behaviour sanitizers of gcc."""
    label = "address and undefined behaviour"
    vectors = _vectors("gcc", UNDEFINED, folder, label)
    result = fuzz(folder.path, folder.name, calls=folder.calls)
    facts = {"flags": [*BASE, *UNDEFINED], "random_calls": result.facts()}
    return Findings([vectors, *_checks(label, result, folder)], facts)


def audit_uninitialised(folder: ExportedFolder) -> Findings:
    """Run the vectors and random calls under clang's sanitizer of uninitialised memory."""
    label = "uninitialised memory"
    vectors = _vectors("clang", UNINITIALISED, folder, label)
    result = fuzz(folder.path, folder.name, calls=folder.calls // 4, compiler="clang", flags=UNINITIALISED)
    facts = {"flags": [*BASE, *UNINITIALISED], "random_calls": result.facts()}
    return Findings([vectors, *_checks(label, result, folder)], facts)


def audit_libfuzzer(folder: ExportedFolder) -> Findings:
    """Let libFuzzer search for new paths, for the time that the audit was given."""
    result = search(folder.path, folder.name, seconds=folder.seconds)
    return Findings(_checks("libFuzzer", result, folder), {"seconds": folder.seconds, "search": result.facts()})
