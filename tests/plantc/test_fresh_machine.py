"""The two commands of the README do what they say where nothing but Python is installed."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
COREUTILS = "basename cat chmod cp cut dirname env expr head ln ls mkdir mktemp mv readlink rm sed sort tail test touch tr true uname wc".split()


def marked(kind):
    """The one line of the README that follows a mark."""
    text = (ROOT / "README.md").read_text()
    (block,) = re.findall(rf"<!-- {kind} command -->\n```[a-z]*\n(.*?)\n```", text, re.DOTALL)
    assert "\n" not in block
    return block


@pytest.mark.slow
def test_the_demo_command_needs_python_only(tmp_path):
    ignored = shutil.ignore_patterns(
        ".*", "__pycache__", "*.pyc", "*.egg-info", "build", "dist", "_build", "out", "plantc-demo"
    )
    shutil.copytree(ROOT, tmp_path / "plantc", ignore=ignored)
    programs = tmp_path / "bin"
    programs.mkdir()
    base = Path(sys.base_prefix) / "bin" / f"python3.{sys.version_info.minor}"
    (programs / "python3").symlink_to(base if base.exists() else Path(sys.executable).resolve())
    for name in COREUTILS:
        found = shutil.which(name)
        if found:
            (programs / name).symlink_to(found)
    keep = ("PIP_", "SSL_", "REQUESTS_", "LANG", "LC_")
    environment = {
        key: value for key, value in os.environ.items() if key.startswith(keep) or key.lower().endswith("_proxy")
    }
    environment |= {"PATH": str(programs), "HOME": str(tmp_path / "home"), "TMPDIR": str(tmp_path)}
    (tmp_path / "home").mkdir()
    for compiler in ("cc", "gcc", "clang"):
        assert shutil.which(compiler, path=environment["PATH"]) is None
    done = subprocess.run(
        ["/bin/sh", "-c", marked("demo")],
        cwd=tmp_path / "plantc",
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=900,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr.strip().splitlines()[-1] == "done: the C lies in plantc-demo/quadrotor_ekf"
    assert "compiled by zig (-ffp-contract=off)" in done.stderr
    assert "native = reference" in done.stderr
    assert "FAIL" not in done.stderr
    folder = tmp_path / "plantc/plantc-demo"
    assert (folder / "quadrotor_ekf/src/quadrotor_ekf.c").is_file()
    assert (folder / "quadrotor_ekf.svg").is_file()


def test_ci_runs_the_test_command_of_the_readme(needs):
    needs("sed", "grep")
    command = marked("test")
    script = ROOT / ".ci/run"
    if not script.is_file():
        pytest.skip("this is not a checkout")
    (extract,) = re.findall(r"^command=\$\((.*)\)$", script.read_text(), re.MULTILINE)
    done = subprocess.run(extract, shell=True, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == command
    assert re.search(r'^eval "\$command"$', script.read_text(), re.MULTILINE)
    assert "pytest" in command
    assert "-m" not in command.split("pytest", 1)[1]  # the slow ones too
