"""The house is as the design says: packages, imports, style, types."""

import ast
import doctest
import importlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
pytestmark = pytest.mark.usefixtures("checkout")


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text())


def packages(project):
    """Import name -> folder."""
    return {name: ROOT / folder for name, folder in project["tool"]["setuptools"]["package-dir"].items()}


def sources(folder):
    return sorted(path for path in (ROOT / folder).rglob("*.py") if "__pycache__" not in path.parts)


def imported(path, package):
    """Absolute names of all that a file imports, inside functions too; nothing that only the type checker sees."""
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)


# -- packages ---------------------------------------------------------------------------------------------------------


def test_every_package_of_the_tree_is_mapped(project):
    table = packages(project)
    assert sorted(project["tool"]["setuptools"]["packages"]) == sorted(table)
    hidden = {"tests", "build", "dist", "docs", "generated_c"}
    tree = {
        path.parent
        for path in ROOT.glob("*/**/__init__.py")
        if not path.relative_to(ROOT).parts[0].startswith(".") and path.relative_to(ROOT).parts[0] not in hidden
    }
    assert set(table.values()) == tree
    for name, folder in table.items():
        assert name == "plantc" or name == f"plantc.{folder.relative_to(ROOT).as_posix().replace('/', '.')}"
        assert (folder / "py.typed").is_file(), f"{folder} has no py.typed"


def test_the_version_is_in_the_changelog(project):
    version = project["project"]["version"]
    assert re.search(rf"^## {re.escape(version)}\b", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    from plantc.codegen.emit import generator_version

    assert generator_version() == version


# -- imports run one way ----------------------------------------------------------------------------------------------

ORDER = ["plantc.reference", "plantc.symbolic", "plantc.codegen", "plantc.simulation"]


@pytest.mark.parametrize("package", ORDER)
def test_imports_run_one_way(project, package):
    forbidden = {"plantc", *(name for name in packages(project) if name not in ORDER[: ORDER.index(package) + 1])}
    for path in sources(packages(project)[package]):
        for name in imported(path, package):
            parts = name.split(".")
            assert name not in forbidden - {package}, f"{path.relative_to(ROOT)} imports {name}"
            assert ".".join(parts[:2]) not in forbidden, f"{path.relative_to(ROOT)} imports {name}"


def test_the_reference_knows_no_casadi_and_nothing_of_plantc(project):
    for path in sources("reference"):
        for name in imported(path, "plantc.reference"):
            assert name.split(".")[0] != "casadi", path
            assert not name.startswith("plantc.") or name.startswith("plantc.reference"), f"{path.name} imports {name}"


def test_codegen_knows_no_filter_theory(project):
    for path in sources("codegen"):
        for name in imported(path, "plantc.codegen"):
            assert "estimator" not in name, f"{path.name} imports {name}"
        for number, line in enumerate(path.read_text().splitlines(), start=1):
            assert not re.search(r"kalman|innovation", line, re.IGNORECASE), (
                f"{path.name}, line {number}: {line.strip()}"
            )


# -- style ------------------------------------------------------------------------------------------------------------


def tool(*arguments, cwd=ROOT, **environment):
    command = [sys.executable, "-m", *map(str, arguments)]
    return subprocess.run(
        command, cwd=cwd, capture_output=True, text=True, check=False, env={**os.environ, **environment}
    )


def test_ruff_finds_nothing(needs):
    needs("python:ruff")
    done = tool("ruff", "check", "--no-cache", "--output-format", "concise", ".")
    assert done.returncode == 0, done.stdout[-3000:]


def test_ruff_would_format_nothing(needs):
    needs("python:ruff")
    done = tool("ruff", "format", "--no-cache", "--check", ".")
    changes = [line for line in (done.stdout + done.stderr).splitlines() if "-->" in line or line.startswith("Would")]
    assert done.returncode == 0, "\n".join(changes)


@pytest.mark.slow
def test_mypy_finds_nothing(needs, project, tmp_path):
    needs("python:mypy")
    for name, folder in packages(project).items():  # laid out as they are installed
        target = tmp_path.joinpath(*name.split("."))
        target.mkdir(parents=True, exist_ok=True)
        for path in (*folder.glob("*.py"), folder / "py.typed"):
            shutil.copy(path, target)
    arguments = ("--config-file", ROOT / "pyproject.toml", "--cache-dir", tmp_path / "cache", "-p", "plantc")
    done = tool("mypy", *arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]


DOCTESTED = [
    "plantc",
    "plantc.symbolic.plant",
    "plantc.symbolic.block",
    "plantc.symbolic.analysis",
    "plantc.symbolic.command_filter",
    "plantc.symbolic.composition",
    "plantc.symbolic.controllers",
    "plantc.symbolic.design",
    "plantc.symbolic.fuzzy",
    "plantc.symbolic.intervals",
    "plantc.symbolic.piecewise",
    "plantc.symbolic.power_series",
    "plantc.symbolic.regulator_equations",
    "plantc.symbolic.regulator_map",
    "plantc.symbolic.sliding_mode",
    "plantc.symbolic.taylor",
]


@pytest.mark.parametrize("name", DOCTESTED)
def test_examples_in_docstrings_run(name):
    said: list[str] = []
    module = importlib.import_module(name)
    runner = doctest.DocTestRunner(verbose=False)
    for test in doctest.DocTestFinder().find(module):
        runner.run(test, out=said.append)
    assert runner.failures == 0, "".join(said)
    assert runner.tries > 0


def test_no_example_in_a_docstring_is_left_out(project):
    have = set()
    for name, folder in packages(project).items():
        for path in sources(folder):
            if path.parent == folder and ">>> " in path.read_text():
                have.add(name if path.stem == "__init__" else f"{name}.{path.stem}")
    assert have <= set(DOCTESTED)


# -- what is tracked --------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def tracked():
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("this is not a clone")
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(done.stderr.strip())
    return [ROOT / name for name in done.stdout.split("\0") if name and (ROOT / name).is_file()]


def test_no_lock_file_is_tracked(tracked):
    locks = {"uv.lock", "poetry.lock", "pdm.lock", "Pipfile.lock", "pixi.lock", "requirements.txt"}
    assert [path for path in tracked if path.name in locks or path.suffix == ".lock"] == []


def test_no_large_file_is_tracked(tracked):
    assert [path for path in tracked if path.stat().st_size > 1_000_000] == []


def test_no_byproduct_is_tracked(tracked):
    suffixes = {".pyc", ".o", ".so", ".a", ".dll", ".exe"}
    assert [path for path in tracked if path.suffix in suffixes or "__pycache__" in path.parts] == []
