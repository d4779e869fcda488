"""Types: the stubs fit the compiled half, the rest fits the stubs, examples in docs are true."""

import doctest
import subprocess
import sys
from pathlib import Path

import pycognate as cg
import pytest

CONFIGURATION = Path(__file__).parents[1] / "pyproject.toml"


def run_module(folder, *arguments):
    """Run a tool on the package as it is installed."""
    done = subprocess.run(
        [sys.executable, "-m", *arguments], cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_those_of_the_compiled_half(tmp_path):
    pytest.importorskip("mypy")
    run_module(tmp_path, "mypy.stubtest", "pycognate._core")


def test_the_package_passes_strict_mypy(tmp_path):
    pytest.importorskip("mypy")
    run_module(tmp_path, "mypy", "--config-file", str(CONFIGURATION), "-p", "pycognate")


def test_the_package_says_that_it_is_typed():
    assert (Path(cg.__file__).parent / "py.typed").exists()


def test_everything_public_has_a_docstring_with_its_parameters():
    for name in cg.__all__:
        thing = getattr(cg, name)
        if name.startswith("__"):
            continue
        assert thing.__doc__, name
        members = vars(thing).items() if isinstance(thing, type) else []
        for member, value in members:
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{member}"


def test_examples_in_docstrings_are_true():
    import numpy as np

    for module in (cg._expr, cg):
        failed, _ = doctest.testmod(module, extraglobs={"np": np})
        assert failed == 0
    finder = doctest.DocTestFinder()
    runner = doctest.DocTestRunner()
    for test in finder.find(cg.Expr, "Expr", module=False, globs={"Expr": cg.Expr}):
        runner.run(test)
    assert runner.tries >= 2 and runner.failures == 0
