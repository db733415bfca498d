"""What all tests share: profiles of hypothesis, the command line in this process, and tools that may be missing."""

import contextlib
import importlib.util
import io
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parent.parent

settings.register_profile("plantc", deadline=None, max_examples=20, derandomize=True)
settings.load_profile("plantc")


def absent(what: str) -> None:
    """Skip a test for want of a tool; in CI that is a failure."""
    if os.environ.get("CI"):
        pytest.fail(f"{what}; CI has to install it", pytrace=False)
    pytest.skip(what)


@pytest.fixture
def needs():
    """A function that skips (in CI: fails) unless all programs are on the PATH; a name like ``python:mypy`` is a module."""

    def check(*tools: str) -> None:
        for tool in tools:
            kind, _, module = tool.partition(":")
            found = importlib.util.find_spec(module) if kind == "python" else shutil.which(tool)
            if found is None:
                absent(f"{module or tool} is not installed")

    return check


@pytest.fixture
def checkout():
    """The top of the checkout; skips (in CI: fails) where the tests run without one."""
    if not (ROOT / "pyproject.toml").is_file():
        absent("this is not a checkout")
    return ROOT


@dataclass
class Said:
    """What a run of the command line gave."""

    status: int
    out: str
    err: str

    @property
    def summary(self) -> str:
        """The last line of standard error."""
        lines = self.err.strip().splitlines()
        return lines[-1] if lines else ""


@pytest.fixture
def plantc():
    """Run the command line in this process: ``plantc("export", "model.py")``."""
    from plantc.__main__ import main

    def run(*arguments: object) -> Said:
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                main([str(item) for item in arguments], prog_name="plantc")
                status = 0
            except SystemExit as leaving:
                status = leaving.code if isinstance(leaving.code, int) else 0 if leaving.code is None else 1
        return Said(status, out.getvalue(), err.getvalue())

    return run
