"""Scenes of the gallery through Python and through the command line: the same bytes."""

import os
import subprocess
from pathlib import Path

import cognate as cg
import pytest
from conftest import ROOT

SCENES = (ROOT / "tests" / "data" / "doors.txt").read_text().split()


def program():
    """Return the command line of this repository, where it has been built."""
    built = os.environ.get("COGNATE", ROOT / "target" / "debug" / "cognate")
    if not Path(built).exists():
        pytest.skip("the command line is not built: cargo build, or COGNATE=…")
    return built


@pytest.mark.parametrize("scene", SCENES)
def test_python_and_the_command_line_write_the_same_bytes(scene, tmp_path):
    commands = ROOT / "examples" / "gallery" / f"{scene}.acf"
    asked = [program(), "run", str(commands), "--out", str(tmp_path), "--name", "shell", "--quiet"]
    subprocess.run([*asked, "--format", "csv"], check=True)
    run = cg.run(commands)
    assert run.ok
    run.to_csv(tmp_path / "python.csv")
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "shell.csv").read_bytes()
