"""The command `cognate` that the package brings: as a script, and as `python -m pycognate`."""

import re
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pycognate as cg
import pytest
from conftest import FALLING, ROOT

SCRIPT = [str(Path(sysconfig.get_path("scripts")) / "cognate")]
MODULE = [sys.executable, "-m", "pycognate"]


def command(program, *words, folder):
    """Run a command; return its exit code and what it wrote on its two streams."""
    done = subprocess.run([*program, *words], cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def exit_codes():
    """Return the exit codes by the first word of what docs/commands.md says they mean."""
    page = (ROOT / "docs" / "commands.md").read_text()
    rows = re.findall(r"^\| (\d+) \| (\w+)", page.split("## Exit codes")[1], re.MULTILINE)
    return {word: int(code) for code, word in rows}


@pytest.fixture
def model(tmp_path):
    file = tmp_path / "ball.adm"
    file.write_text(FALLING)
    return file


@pytest.mark.parametrize("program", [SCRIPT, MODULE], ids=["script", "module"])
def test_a_run_writes_the_results_that_python_has(program, model, tmp_path):
    words = ["run", "ball.adm", "--end", "1", "--steps", "10", "--format", "csv", "--out", "out", "--quiet"]
    code, out, said = command(program, *words, folder=tmp_path)
    assert (code, said) == (exit_codes()["done"], ""), out
    cg.Model.read(model).run(end=1.0, steps=10).to_csv(tmp_path / "python.csv")
    assert (tmp_path / "out" / "ball.csv").read_bytes() == (tmp_path / "python.csv").read_bytes()
    # the process has the streams of its own, and nothing else is written to them
    words = ["run", "-", "--end", "1", "--steps", "10", "-o", "-", "--quiet"]
    piped = subprocess.run([*program, *words], input=model.read_bytes(), capture_output=True)
    assert (piped.returncode, piped.stderr) == (0, b"")
    assert piped.stdout == (tmp_path / "python.csv").read_bytes()


@pytest.mark.parametrize("program", [SCRIPT, MODULE], ids=["script", "module"])
def test_exit_codes_are_those_of_the_documentation(program, model, tmp_path):
    codes = exit_codes()
    model.with_name("wrong.adm").write_text(FALLING.replace("MASS=2", "MASSE=2"))
    for words, meaning, where, what in [
        (["--version"], "done", 1, f"cognate {cg.__version__}"),
        (["run", "--help"], "done", 1, "Usage: cognate run"),
        (["eval", "1/0"], "input", 2, "division"),
        (["check", "wrong.adm"], "input", 2, "MASSE"),
        (["run", "wrong.adm", "--end", "1"], "input", 2, "MASSE"),
        (["run", "missing.adm", "--end", "1"], "input", 2, "missing.adm"),
        (["runn"], "usage", 2, "unrecognized subcommand 'runn'"),
        ([], "usage", 2, "Usage: cognate"),
    ]:
        done = command(program, *words, folder=tmp_path)
        assert done[0] == codes[meaning], (words, done)
        assert what in done[where], (words, done)


def test_ctrl_c_ends_a_run_which_keeps_its_results(model, tmp_path):
    words = ["run", "ball.adm", "--end", "1e6", "--steps", "9000000", "--format", "csv", "--out", "out"]
    running = subprocess.Popen([*MODULE, *words], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    try:
        end = time.monotonic() + 60
        while running.poll() is None and not list(tmp_path.glob("out/*.csv*")) and time.monotonic() < end:
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=60)
    finally:
        running.kill()
    assert running.returncode == exit_codes()["interrupted"], said
    assert "Traceback" not in said
    assert len((tmp_path / "out" / "ball.csv").read_text().splitlines()) > 2


def test_ctrl_c_ends_a_command_that_does_not_hear_it_as_in_a_shell(tmp_path):
    # it waits for standard input
    waiting = subprocess.Popen(
        [*MODULE, "check", "-"], cwd=tmp_path, stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        time.sleep(3)
        waiting.send_signal(signal.SIGINT)
        assert waiting.wait(timeout=60) == -signal.SIGINT
        assert waiting.stderr.read() == ""
    finally:
        waiting.kill()
        waiting.communicate()


def test_scripts_of_the_command_call_it_through_python(model, tmp_path):
    assert command(MODULE, "mdi", "--install", "solver", folder=tmp_path)[0] == 0
    (tmp_path / "fall.acf").write_text("FILE/MODEL=ball\nSIMULATE/DYNAMIC, END=1, STEPS=10\nSTOP\n")
    called = command([str(tmp_path / "solver" / "mdi")], "-c", "ru-standard", "i", "fall.acf", "exit", folder=tmp_path)
    assert called[0] == 0, called
    assert list(tmp_path.glob("*.res"))
