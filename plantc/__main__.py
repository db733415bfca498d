"""The command line: derive, export, check, audit, study, demo."""

from __future__ import annotations

import ctypes
import json
import os
import re
import sys
import time
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

import click
import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from . import models, parallel, studies
from .codegen.audit import AUDITS, AuditResult, audit_folder
from .codegen.emit import generator_version
from .codegen.exported import tool
from .codegen.findings import CheckResult, verdict_text
from .codegen.mathematics import CHOICES
from .codegen.options import Options
from .codegen.package import (
    Export,
    ExportError,
    check_folder,
    design_residuals,
    export,
    read_manifest,
    text_in,
    with_design,
    write_design,
)
from .codegen.proof import prove
from .codegen.rounding import Bound, bound_rounding
from .codegen.style import Precision
from .codegen.targets import TARGETS
from .evidence import MARKS, checks_text, evidence_text, export_json, rounding_text, sentence
from .models import UsageError
from .symbolic import Block

GOOD, CHECK_FAILED, USER_MUST_MEND = 0, 1, 2


class _Diverted:
    """Standard output sent to standard error, down to the file descriptor, until it is given back.

    What a model prints is a message, also where it is a program that the model starts, or a library in C.
    """

    def __init__(self) -> None:
        self.stream = sys.stdout
        self.own: int | None = None
        sys.stdout = sys.stderr
        try:
            self.stream.flush()
            self.own = os.dup(1)
            os.dup2(2, 1)
        except (OSError, ValueError):  # a closed one needs no diversion
            self.own = None

    def end(self) -> None:
        """Give standard output back."""
        if os.name == "posix":
            ctypes.CDLL(None).fflush(None)
        sys.stdout = self.stream
        if self.own is not None:
            os.dup2(self.own, 1)
            os.close(self.own)
            self.own = None


class Session:
    """One run of a command: where its messages go, and how it ends."""

    def __init__(self, as_json: bool, debug: bool):
        self.as_json, self.debug = as_json, debug
        self.console = Console(stderr=True, highlight=False, soft_wrap=True, emoji=False)
        self.diverted: _Diverted | None = None
        self.finished = False

    def say(self, text: str) -> None:
        """Print a message, to standard error."""
        self.console.print(text, markup=False)

    def finish(self, result: dict[str, Any], summary: str, status: int) -> NoReturn:
        """Print the JSON object if asked for, then the summary, and leave."""
        self.finished = True
        self._give_back()
        if self.as_json:
            click.echo(json.dumps({"status": status, "summary": summary, **result}, indent=2))
        self.say(summary)
        sys.exit(status)

    def _give_back(self) -> None:
        if self.diverted is not None:
            self.diverted.end()
            self.diverted = None

    def run(self, body: Callable[[], NoReturn]) -> NoReturn:
        """Run a command; whatever goes wrong becomes one sentence and an exit status."""
        self.diverted = _Diverted()
        try:
            body()
        except KeyboardInterrupt:
            self.finish({"error": "interrupted"}, "interrupted: what was being written is as it was", USER_MUST_MEND)
        except BaseException as error:  # the user's own code runs here, and may raise anything
            if self.finished:
                raise
            if self.debug:
                traceback.print_exc()
            if isinstance(error, ExportError):
                checks = [result.as_dict() for result in error.check.results]
                self.finish({"error": str(error), "checks": checks}, f"failed: {error}", CHECK_FAILED)
            text = sentence(error)
            self.finish({"error": text}, f"error: {text}", USER_MUST_MEND)
        finally:
            self._give_back()
        raise AssertionError("a command ends by finish")

    def progress(self) -> Progress:
        """Return a progress display; silent where the output is no terminal."""
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeElapsedColumn(),
        )
        return Progress(*columns, console=self.console, transient=True, disable=not self.console.is_terminal)


def _size(ctx: click.Context, param: click.Parameter, value: str) -> int:
    """Return bytes from a number with or without K or M behind it; 0 where nothing is given."""
    if not value:
        return 0
    found = re.fullmatch(r"([1-9]\d{0,9})([KkMm]?)", value)
    if found is None:
        raise click.BadParameter(f"{value!r} is no size; give bytes, or a number with K or M, such as 128K")
    return int(found[1]) * {"": 1, "K": 1024, "M": 1024 * 1024}[found[2].upper()]


class _Commands(click.Group):
    """The group of commands; a wrong command line is told like any other mistake, as JSON too."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, **extra: Any) -> Any:
        given = list(sys.argv[1:] if args is None else args)
        if not given:
            given = ["--help"]
        extra["standalone_mode"] = False
        try:
            sys.exit(super().main(given, *rest, **extra))
        except click.ClickException as error:
            text = error.format_message()
            Session("--json" in given, False).finish({"error": text}, f"error: {text}", USER_MUST_MEND)
        except click.Abort:
            Session("--json" in given, False).finish({"error": "interrupted"}, "interrupted", USER_MUST_MEND)


def _common(function: Callable[..., Any]) -> Callable[..., Any]:
    for option in (
        click.option("--json", "as_json", is_flag=True, help="Print one JSON object on standard output."),
        click.option("--debug", is_flag=True, help="Show a traceback if something fails."),
    ):
        function = option(function)
    return function


_target = click.option(
    "--target",
    "targets",
    type=click.Choice(list(TARGETS)),
    multiple=True,
    default=["host"],
    show_default=True,
    help="Machine the C is run on as well; may be given several times.",
)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(generator_version(), prog_name="plantc")
def main() -> None:
    """Compile plants: a symbolic model in Python in, verified standalone C99 out.

    Exit status: 0 good, 1 a check failed, 2 something to mend.
    """


@main.command(name="derive")
@click.argument("model")
@click.option("--at", "point", default="", help="Operating point: a name in the file, or x=1,u=2.")
@click.option("--dt", type=float, default=None, help="Time step, for a discrete plant whose time step is an input.")
@_common
def derive_command(model: str, point: str, dt: float | None, as_json: bool, debug: bool) -> None:
    """Matrices, eigenvalues and ranks of the plants in MODEL (file.py or file.py:name) at an operating point."""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        plants, names, path = models.plants_of(model)
        answers = []
        if dt is not None and not any(isinstance(plant.dt, tuple) for _, plant in plants):
            raise UsageError(f"{path}: --dt is given, but no plant has its time step as an input; leave it out")
        for label, plant in plants:
            if isinstance(plant.dt, tuple) and dt is None:
                low, high = plant.dt
                raise UsageError(
                    f"{path}: the time step of {label} is an input ({low:g} .. {high:g} s); give --dt, or name a plant: "
                    f"{path}:{plants[0][0]}"
                )
            given = models.operating_point(point, plant, names, path) if point else {}
            answer = _derived(label, plant, given, dt)
            answers.append(answer)
            for line in _derived_text(answer):
                session.say(line)
        session.finish({"plants": answers}, f"{path}: {len(answers)} plant(s) derived", GOOD)

    session.run(body)


def _derived(label: str, plant: Any, given: dict[str, Any], dt: float | None) -> dict[str, Any]:
    from .symbolic.analysis import OperatingPoint, linearise

    at = OperatingPoint.at(plant, given)
    options = {"dt": dt} if isinstance(plant.dt, tuple) else {}
    made = linearise(plant, at, **options)
    control, observe = made.controllability(), made.observability()
    return {
        "name": label,
        "plant": plant.name,
        "discrete": plant.is_discrete,
        "at": {key: np.asarray(value).tolist() for key, value in at.items()},
        "states": list(made.states),
        "inputs": list(made.inputs),
        "outputs": list(made.outputs),
        "A": made.A.tolist(),
        "B": made.B.tolist(),
        "C": made.C.tolist(),
        "D": made.D.tolist(),
        "eigenvalues": [[float(value.real), float(value.imag)] for value in made.eigenvalues()],
        "controllability_rank": control.rank,
        "observability_rank": observe.rank,
    }


def _derived_text(answer: dict[str, Any]) -> list[str]:
    n = len(answer["states"])
    kind = "discrete" if answer["discrete"] else "continuous"
    lines = [f"{answer['name']} (plant {answer['plant']}, {kind}), states {', '.join(answer['states'])}"]
    for key in "ABCD":
        matrix = np.array(answer[key]) + 0.0  # no minus zero
        if matrix.size and not matrix.any():
            lines.append(f"{key} = 0 ({matrix.shape[0]} x {matrix.shape[1]})")
        elif matrix.size:
            text = np.array2string(matrix, precision=6, suppress_small=True, max_line_width=118, threshold=400)
            lines += [f"{key} =", text]
    values = ", ".join(f"{re:.6g}{im:+.6g}j" if im else f"{re:.6g}" for re, im in answer["eigenvalues"])
    lines.append(f"eigenvalues: {values}")
    lines.append(
        f"controllable: rank {answer['controllability_rank']} of {n}; observable: rank {answer['observability_rank']} of {n}"
    )
    return lines


@main.command(name="export")
@click.argument("model")
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("generated_c"), show_default=True, help="Output folder."
)
@click.option("--precision", type=click.Choice(["double", "float"]), default="double", show_default=True)
@click.option(
    "--steps", type=click.IntRange(20, 100000), default=100, show_default=True, help="Length of the nominal trace."
)
@click.option("--redesign", is_flag=True, help="Design the numbers of design.json anew.")
@click.option(
    "--jobs", type=click.IntRange(1, 64), default=1, show_default=True, help="Blocks that are exported at a time."
)
@click.option("--no-cache", is_flag=True, help="Do all work anew, even if the same export was done before.")
@click.option("--force", is_flag=True, help="Write over files of an earlier export even if they were changed since.")
@click.option("--fmu", is_flag=True, help="Write an FMI 2.0 co-simulation unit of the same C too, BLOCK.fmu.")
@click.option("--tables", is_flag=True, help="Also measure the tables that the model brings; may take minutes.")
@_target
@click.option(
    "--contract",
    type=click.Choice(["on", "off"]),
    default="off",
    show_default=True,
    help="Whether a product and a sum may become one fused operation.",
)
@click.option(
    "--mathematics",
    type=click.Choice(CHOICES),
    default="own",
    show_default=True,
    help="Whose sin, exp ... the C calls: plantc's own, the same bits everywhere, or the C library's.",
)
@click.option(
    "--flash",
    callback=_size,
    default="",
    metavar="BYTES",
    help="Flash of the target, as 128K or 1M; default the target's own.",
)
@click.option("--ram", callback=_size, default="", metavar="BYTES", help="RAM of the target, likewise.")
@_common
def export_command(
    model: str,
    out: Path,
    precision: str,
    steps: int,
    redesign: bool,
    jobs: int,
    no_cache: bool,
    force: bool,
    fmu: bool,
    as_json: bool,
    debug: bool,
    **machine: Any,
) -> None:
    """Write C for the blocks of MODEL into OUT/BLOCK/, compiled and cross-checked; nothing is written if a check fails."""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        blocks, path = models.blocks_of(model)
        options = _options(precision, **machine)
        if options.tables and not any(block.tables for block in blocks):
            raise UsageError(f"{path}: --tables is given, but no block brings a table; leave it out")
        how = {"steps": steps, "fmu": fmu, "cached": not no_cache, "force": force}
        if jobs > 1 and len(blocks) > 1:
            outcomes = parallel.export_all(path, blocks, out, options, redesign, how, jobs)
            designed = {name: numbers for outcome in outcomes for name, numbers in outcome.designed.items()}
            if designed:  # the one file that all of them would write
                _write_design(session, path, designed)
            _finish_jobs(session, outcomes)
        exports = _export_all(session, blocks, path, out, options, redesign, how)
        result = {"blocks": [export_json(item) for item in exports]}
        folders = ", ".join(str(item.folder) for item in exports)
        session.finish(result, f"exported, {_verdict(result)}: {folders}", GOOD)

    session.run(body)


def _verdict(result: dict[str, Any]) -> str:
    """Return what is to be said of the checks of exported blocks."""
    return verdict_text(check["verdict"] for block in result["blocks"] for check in block["checks"])


def _finish_jobs(session: Session, outcomes: list[parallel.Outcome]) -> NoReturn:
    """Say what became of blocks that were exported side by side, in their order; the worst of it is the exit status."""
    for outcome in outcomes:
        for line in outcome.lines:
            session.say(line)
    done = {"blocks": [outcome.result for outcome in outcomes if outcome.status == GOOD]}
    bad = [outcome for outcome in outcomes if outcome.status != GOOD]
    if bad:
        worst = max(outcome.status for outcome in bad)
        word = "failed" if worst == CHECK_FAILED else "error"
        text = "; ".join(outcome.error for outcome in bad)
        rest = f"; {len(done['blocks'])} of {len(outcomes)} blocks were exported"
        session.finish({"error": text, **done}, f"{word}: {text}{rest}", worst)
    folders = ", ".join(item["folder"] for item in done["blocks"])
    session.finish(done, f"exported, {_verdict(done)}: {folders}", GOOD)


def _options(
    precision: str, targets: tuple[str, ...], contract: str, mathematics: str, flash: int, ram: int, tables: bool
) -> Options:
    names = tuple(dict.fromkeys(targets))
    if (flash or ram) and set(names) <= {"host"}:
        raise UsageError("--flash and --ram are sizes of a target, and there is none; give --target, or leave them out")
    return Options(Precision(precision), names, contract == "on", mathematics, flash=flash, ram=ram, tables=tables)


def _export_all(
    session: Session,
    blocks: list[Block],
    path: Path,
    out: Path,
    options: Options,
    redesign: bool = False,
    how: dict[str, Any] | None = None,
) -> list[Export]:
    """Export blocks one after the other; `how` is for `export`."""
    exports = []
    for given in blocks:
        block, designed = with_design(given, path.parent / "design.json", redesign=redesign, write=False)
        started = time.perf_counter()
        with session.progress() as display:
            task = display.add_task(block.name, total=None)

            def report(what: str, done: int, total: int, task: Any = task, name: str = block.name) -> None:
                display.update(task, description=f"{name}: {what}", completed=done, total=total)

            exports.append(export(block, out, options=options, progress=report, **(how or {})))
        if designed is not None:  # now that nothing stands against it
            _write_design(session, path, {block.name: designed})
        for line in evidence_text(exports[-1], time.perf_counter() - started):
            session.say(line)
    return exports


def _write_design(session: Session, path: Path, designed: dict[str, Any]) -> None:
    file = path.parent / "design.json"
    write_design(file, designed)
    session.say(f"{', '.join(designed)}: designed numbers written to {file}")


@main.command(name="check")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--model", required=True, help="The model, file.py or file.py:name.")
@click.option(
    "--steps", type=click.IntRange(20, 100000), default=100, show_default=True, help="Length of the nominal trace."
)
@click.option(
    "--prove",
    "proved",
    is_flag=True,
    help="Also prove by Frama-C that no call takes the memory out of its ranges, and bound rounding errors by Gappa.",
)
@_target
@_common
def check_command(
    folder: Path, model: str, steps: int, proved: bool, targets: tuple[str, ...], as_json: bool, debug: bool
) -> None:
    """Is what lies in FOLDER still what its model gives, and does it still pass?"""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        manifest = read_manifest(folder)
        blocks, path = models.blocks_of(model)
        wanted = [block for block in blocks if block.name == manifest["name"]]
        if not wanted:
            names = ", ".join(block.name for block in blocks)
            raise UsageError(
                f"{path}: it has no block {manifest['name']!r}, which {folder} was written from; it has {names}"
            )
        block, _ = with_design(wanted[0], path.parent / "design.json", write=False)
        with session.progress() as display:
            task = display.add_task(block.name, total=None)
            found = check_folder(
                folder,
                block,
                targets=targets,
                steps=steps,
                progress=lambda what, done, total: display.update(
                    task, description=f"{block.name}: {what}", completed=done, total=total
                ),
            )
        found.check.results += design_residuals(block)
        if proved and not found.missing:
            found.check.results += _proved(session, block, folder, manifest)
        for line in checks_text(found.check.results):
            session.say(line)
        bounds = _bounded(session, block, manifest) if proved and not found.missing else []
        for file in found.changed:
            session.say(f"  FAIL {folder / file} is not what the model gives now")
        for file in found.missing:
            session.say(f"  FAIL {folder / file} is missing")
        result = {
            "folder": str(folder),
            "changed": found.changed,
            "missing": found.missing,
            "checks": [item.as_dict() for item in found.check.results],
            **({"rounding": [item.as_dict() for item in bounds]} if proved else {}),
        }
        if found.passed:
            verdict = verdict_text(item.verdict for item in found.check.results)
            session.finish(result, f"{folder}: as the model gives it, {verdict}", GOOD)
        what = "a check failed" if not found.check.passed else "not what the model gives now; export again"
        session.finish(result, f"failed: {folder}: {what}", CHECK_FAILED)

    session.run(body)


def _proved(session: Session, block: Block, folder: Path, manifest: dict[str, Any]) -> list[CheckResult]:
    """Prove, and return a check for each function; both tools are asked for first."""
    if manifest.get("contract") == "on":
        raise UsageError(
            f"{folder}: it was exported with --contract on, and what a compiler may fuse is not what --prove looks at; "
            "export it with --contract off"
        )
    for name, package in (("frama-c", "frama-c-base"), ("gappa", "gappa")):
        tool(name, package)
    session.say(f"{block.name}: Frama-C, function by function; a filter of twelve states takes minutes")
    return prove(block, text_in(folder, manifest)).checks


def _bounded(session: Session, block: Block, manifest: dict[str, Any]) -> list[Bound]:
    """Bound what one call loses to rounding, and print it."""
    precision = Precision(manifest["precision"])
    bounds = bound_rounding(block, precision, mathematics=manifest.get("mathematics", "own"))
    for line in rounding_text(bounds, precision):
        session.say(line)
    return bounds


@main.command(name="audit")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--only", multiple=True, metavar="NAME", help=f"Run this audit only (again for more): {', '.join(dict(AUDITS))}."
)
@click.option(
    "--calls",
    type=click.IntRange(1000, 10**9),
    default=3_000_000,
    show_default=True,
    help="Random calls for sanitizers.",
)
@click.option(
    "--seconds", type=click.FloatRange(1, 86400), default=5, show_default=True, help="How long libFuzzer searches."
)
@_common
def audit_command(folder: Path, only: tuple[str, ...], calls: int, seconds: float, as_json: bool, debug: bool) -> None:
    """Look at the C in FOLDER with analysers, sanitizers and fuzzers; writes FOLDER/audit.json, shown in its report.html."""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        with session.progress() as display:
            task = display.add_task("audit", total=None)
            found = audit_folder(
                folder,
                only=only,
                calls=calls,
                seconds=seconds,
                progress=lambda what, done, total: display.update(
                    task, description=f"{folder.name}: {what}", completed=done, total=total
                ),
            )
        for line in audit_text(found):
            session.say(line)
        result = {"folder": str(folder), **found.as_dict()}
        if not found.passed:
            session.finish(result, f"failed: {folder}: an audit has a finding", CHECK_FAILED)
        if found.missing:
            session.finish(result, f"error: {'; '.join(dict.fromkeys(found.missing.values()))}", USER_MUST_MEND)
        session.finish(result, f"{folder}: no finding in {', '.join(found.findings)}", GOOD)

    session.run(body)


def audit_text(found: AuditResult) -> list[str]:
    """Return what the audits of a folder found, for a terminal."""
    lines = []
    for check in found.checks:
        calls = f"  {check.calls} calls" if check.calls else ""
        lines.append(f"  {MARKS[check.verdict]} {check.name}{calls}{f'  {check.remark}' if check.remark else ''}")
    for row in found.findings["misra"].facts["deviations"] if "misra" in found.findings else []:
        lines.append(f"       {row['file']}: rule {row['rule']}, {row['count']} times: {row['reason']}")
    lines += [f"  not run: {name}" for name in found.missing]
    if found.folder.changed:
        lines.append(f"  changed since the export: {', '.join(found.folder.changed)}")
    return lines


@main.command(
    name="study",
    help="Do a published result again: figures, tables and one page into OUT/NAME/. "
    f"NAME: {', '.join(studies.STUDIES)}.",
)
@click.argument("name")
@click.option(
    "--runs", type=click.IntRange(1, 100_000), default=None, help="Runs of each case.  [default: what the study says]"
)
@click.option(
    "--seed", type=click.IntRange(0, 2**64 - 1), default=2018, show_default=True, help="Key of the random streams."
)
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("studies"), show_default=True, help="Output folder."
)
@click.option("--on", default=None, metavar="ADDRESS", help="Run on a cluster: dask://HOST:PORT, a Dask scheduler.")
@click.option("--force", is_flag=True, help="Write over files of an earlier run even if they were changed since.")
@_common
def study_command(
    name: str, runs: int | None, seed: int, out: Path, on: str | None, force: bool, as_json: bool, debug: bool
) -> None:
    """Do a published result again."""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        from .simulation import ClusterError, ResultError, check_study_folder, write_study

        made = studies.find(name)
        check_study_folder(name, out, force=force)
        with session.progress() as display:
            task = display.add_task(name, total=None)

            def report(what: str, done: int, total: int) -> None:
                display.update(task, description=f"{name}: {what}", completed=done, total=total)

            try:
                asked = {} if runs is None else {"runs": runs}
                found = made(seed=seed, on=on, progress=report, **asked)
            except (ClusterError, ResultError) as error:
                raise UsageError(str(error)) from None
        files = write_study(found, out, force=force)
        for item in found.comparisons:
            session.say(f"  {item.verdict}: {item.published}: {item.ours}")
        result = {"folder": str(files[0].parent), "page": str(files[0]), "verdicts": found.counts()}
        both = {"results": found.results(), "evidence": found.evidence()}
        session.finish({**result, **both}, f"done: {found.verdicts()}: {files[0]}", GOOD)

    session.run(body)


@main.command(name="demo")
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("plantc-demo"), show_default=True, help="Output folder."
)
@_common
def demo_command(out: Path, as_json: bool, debug: bool) -> None:
    """The main job in a minute: the Kalman filter of a quadrotor as verified C, its evidence, and a picture of it at work."""
    session = Session(as_json, debug)

    def body() -> NoReturn:
        from .demo import picture
        from .examples.quadrotor_ekf import quadrotor_ekf

        session.say(
            "The extended Kalman filter of a 12-state quadrotor: derived, written as C, compiled, cross-checked."
        )
        path = Path(__file__).resolve().parent
        exports = _export_all(session, [quadrotor_ekf], path / "demo.py", out, Options())
        image = picture(quadrotor_ekf, out / "quadrotor_ekf.svg")
        session.say(f"  the compiled C at work: {image}")
        result = {"blocks": [export_json(item) for item in exports], "picture": str(image)}
        session.finish(result, f"done: the C lies in {exports[0].folder}", GOOD)

    session.run(body)


if __name__ == "__main__":
    main()
