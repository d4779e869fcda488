"""Scenes of the gallery through Python and through the command line: the same bytes."""

import os
import pickle
import subprocess
from pathlib import Path

import pycognate as cg
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


def test_python_obeys_the_set_up_beside_a_model_as_the_command_line_does(tmp_path):
    folder = ROOT / "tests" / "data" / "loaded"
    for asked, ran in [
        (["loaded.acf"], lambda: cg.run(folder / "loaded.acf")),
        (["loaded.adm"], lambda: cg.Model.read(folder / "loaded.adm").run()),
        (["loaded.adm"], lambda: pickle.loads(pickle.dumps(cg.Model.read(folder / "loaded.adm"))).run()),
        (["loaded.adm", "--end", "0.5"], lambda: cg.Model.read(folder / "loaded.adm").run(end=0.5)),
    ]:
        model, *more = asked
        words = [program(), "run", str(folder / model), *more, "--out", str(tmp_path), "--name", "shell"]
        subprocess.run([*words, "--format", "csv", "--quiet"], check=True)
        ran().to_csv(tmp_path / "python.csv")
        assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "shell.csv").read_bytes()
        again = tmp_path / "session.csv"
        if more or model.endswith(".acf"):
            continue
        session = cg.Model.read(folder / model).session()
        assert session.simulate(end=0.8, steps=40) == "completed"
        session.run.to_csv(again)
        assert again.read_bytes() == (tmp_path / "shell.csv").read_bytes()
    alone = cg.Model.read(folder / "loaded.adm", setup=False)
    assert alone.loads is None
    assert cg.Model.read(folder / "loaded.adm").loads == (["gravity", "MOTION/1"], ["SFORCE/1"])


def test_a_pickled_model_keeps_its_changes_and_its_set_up_once():
    read = cg.Model.read(ROOT / "tests" / "data" / "loaded" / "loaded.adm")
    changed = read.changed("PART/2, MASS=3").changed("PART/3, MASS=3")
    again = pickle.loads(pickle.dumps(changed))
    assert (again.text, again.loads, again.file) == (changed.text, changed.loads, changed.file)
    here, there = changed.run(), again.run()
    assert here.record["loads"] == there.record["loads"]
    assert all((here[name] == there[name]).all() for name in here.names)
    assert not (here["DM(30,22)"] == read.run()["DM(30,22)"]).all()
