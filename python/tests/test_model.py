"""Models: read, change, verify, run, linearize, USER, interruption, pickles."""

import _thread
import errno
import pickle
import threading
import time

import pycognate as cg
import numpy as np
import pytest
from conftest import FALLING, ROOT, SLIDER_CRANK


def test_a_ball_falls(falling):
    run = falling.run(end=2.0, steps=4, columns=["VZ(2)"])
    assert run.ok and run.status == "completed" and len(run) == len(run.time) == 5
    assert list(run) == run.keys() and "ball.Z" in run and run.get("nothing") is None
    assert [name for name, column in run.items() if len(column) != len(run)] == []
    assert set(dict(run)) == set(run)
    np.testing.assert_allclose(run["ball.Z"], -5 * run.time**2, atol=1e-9)
    np.testing.assert_allclose(run["vz( 2 )"], -10 * run.time, atol=1e-9)
    assert run.units["VZ(2)"] == "meter/sec"
    assert (falling.title, falling.names["PART/2"]) == ("a falling ball", "ball")
    assert "REQUEST/1" in falling.elements


def test_all_mistakes_of_a_dataset_come_at_once():
    text = FALLING.replace("MASS=2,", "MASS=-2,").replace("DZ(2)", "DZZ(2)")
    with pytest.raises(cg.ModelError) as caught:
        cg.Model.from_text(text, "ball.adm")
    error = caught.value
    assert len(error.errors) >= 2
    assert {e.element for e in error.errors} >= {"PART/2", "REQUEST/1"}
    assert all(e.line and e.column and e.file == "ball.adm" for e in error.errors)
    assert error.errors[0].name == "ball"
    assert pickle.loads(pickle.dumps(error)).errors == error.errors
    with pytest.raises(cg.ModelError, match="cannot be opened"):
        cg.Model.read("nowhere.adm")


def test_a_file_that_is_not_there_is_told_as_python_does(tmp_path):
    elsewhere = tmp_path / "elsewhere.acf"
    elsewhere.write_text("nowhere\n\nSIMULATE/DYNAMIC, END=1, STEPS=1\nSTOP\n")
    for read, ours in [
        (lambda: cg.Model.read(tmp_path / "nowhere.adm"), cg.ModelError),
        (lambda: cg.run(tmp_path / "nowhere.acf"), cg.ModelError),
        (lambda: cg.run(elsewhere), cg.ModelError),
        (lambda: cg.read_results(tmp_path / "nowhere.csv"), cg.ResultsError),
        (lambda: cg.read_res(tmp_path / "nowhere.res"), cg.ResultsError),
        (lambda: cg.get_results(tmp_path / "nowhere.res"), cg.ResultsError),
    ]:
        with pytest.raises(FileNotFoundError) as caught:
            read()
        error = caught.value
        assert isinstance(error, ours) and error.errno == errno.ENOENT
        assert "nowhere" in error.filename and "nowhere" in str(error)
        assert error.code in ("cannot_open", "file_unreadable")
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and again.errors == error.errors
    # what is there, and is wrong, is none of them
    wrong = tmp_path / "wrong.adm"
    wrong.write_text("wrong\nPART/2, MASS=-1\nEND\n")
    with pytest.raises(cg.ModelError) as found:
        cg.Model.read(wrong)
    assert not isinstance(found.value, OSError)


def test_columns_are_checked_before_anything_runs(falling):
    with pytest.raises(cg.ModelError) as caught:
        falling.run(end=1.0, columns=["DZ(2)", "DZ(7)", "SIN("])
    assert [e.file for e in caught.value.errors] == ["columns[1]", "columns[2]"]
    with pytest.raises(TypeError, match="list"):
        falling.run(end=1.0, columns="DZ(2)")
    with pytest.raises(TypeError, match="no option"):
        falling.run(end=1.0, tolerance=1e-3)
    for nonsense in ({}, {"end": -1.0}, {"end": float("nan")}):
        with pytest.raises(cg.ModelError):
            falling.run(**nonsense)


def test_threads_of_a_run_change_no_bit_of_it(falling):
    one = falling.run(end=1.0, steps=20)
    for run in (falling.run(end=1.0, steps=20, threads=2), falling.session(threads=2)):
        if isinstance(run, cg.Session):
            run.simulate(end=1.0, steps=20)
            run = run.run
        np.testing.assert_array_equal(run["ball.Z"], one["ball.Z"])
    for nonsense in (0, -1, 1.5, "2"):
        with pytest.raises(ValueError, match="threads"):
            falling.run(end=1.0, threads=nonsense)


def test_a_command_file_is_obeyed(slider_crank):
    run = cg.run(ROOT / "examples" / "slider_crank.acf")
    assert run.ok and [kind for _, kind, _ in run.sequences][-2:] == ["kinematic", "dynamic"]
    same = slider_crank.run_script(ROOT / "examples" / "slider_crank.acf")
    np.testing.assert_array_equal(same["slider.X"], run["slider.X"])
    text = "simulate/kinematic, end=1.0, steps=200\ndeactivate/motion, id=1\n"
    text += "simulate/dynamic, end=2.0, steps=200"
    typed = slider_crank.run_script(commands=text)
    np.testing.assert_array_equal(typed["slider.X"], run["slider.X"])


def test_sessions_go_on_and_states_are_carried_over(slider_crank):
    whole = cg.run(ROOT / "examples" / "slider_crank.acf")
    session = slider_crank.session()
    assert session.simulate(end=1.0, steps=200, kind="kinematic") == "completed"
    state = session.state
    session.command("DEACTIVATE/MOTION, ID=1")
    session.simulate(end=2.0, steps=200, kind="dynamic")
    assert session.time == 2.0
    np.testing.assert_array_equal(session.run["slider.X"], whole["slider.X"])
    other = slider_crank.session()
    other.state = state
    assert other.time == 1.0
    with pytest.raises(cg.ModelError):
        other.state = "nonsense"


def test_statements_change_a_copy(falling):
    heavy = falling.changed("ACCGRAV/KGRAV=-20\nPART/2, MASS=3")
    assert heavy.run(end=1.0, steps=1)["ball.Z"][-1] == pytest.approx(-10)
    assert falling.run(end=1.0, steps=1)["ball.Z"][-1] == pytest.approx(-5)
    assert pickle.loads(pickle.dumps(heavy)).run(end=1.0)["ball.Z"][-1] == pytest.approx(-10)
    for wrong in ("PART/9, MASS=3", "SIMULATE/DYNAMIC, END=1", "PRAT/2, MASS=3"):
        with pytest.raises(cg.ModelError):
            falling.changed(wrong)


def test_freedoms_are_explained(slider_crank):
    found = slider_crank.verify()
    assert (found.freedom, found.consistent) == (0, True)
    free = slider_crank.changed("DEACTIVATE/MOTION, ID=1").verify()
    assert free.freedom == 1 and len(free.free) == 1
    assert "freedom: 1" in str(free)


def test_linear_systems_are_what_python_control_takes(falling):
    plant = FALLING.replace(
        "END\n",
        "SFORCE/1, TRANSLATIONAL, I=2, J=1, ACTIONONLY, FUNCTION=VARVAL(1)-8*DZ(2)\\\n"
        "VARIABLE/1, FUNCTION=0\nVARIABLE/2, FUNCTION=DZ(2)\n"
        "PINPUT/1, VARIABLES=1\nPOUTPUT/1, VARIABLES=2\nEND\n",
    ).replace("MARKER/2, PART=2", "MARKER/2, PART=2\nMARKER/3, PART=1\nJOINT/1, TRANSLATIONAL, I=2, J=3")
    A, B, C, D, names = cg.Model.from_text(plant).linear()
    assert A.shape == (2, 2) and B.shape == (2, 1) and C.shape == (1, 2) and D.shape == (1, 1)
    np.testing.assert_allclose(np.linalg.eigvals(A), [2j, -2j], atol=1e-9)
    modes = cg.Model.from_text(plant).modes()
    assert modes[0].eigenvalue == pytest.approx(2j)
    assert abs(modes[0].shape["PART/2.Z"]) == pytest.approx(1)
    assert modes[0].shape["PART/2.X"] == modes[0].shape["PART/2.AY"] == 0
    control = pytest.importorskip("control")
    system = control.ss(A, B, C, D, **names)
    assert system.dcgain() == pytest.approx(1 / 8)


def test_advice_names_keywords_of_python(pushed):
    with pytest.raises(cg.ModelError, match="zero_user=True"):
        pushed.run(end=1.0)
    with pytest.raises(cg.ModelError, match="^error: "):
        pushed.run(end=1.0, error=-1.0)
    for wrong in (dict(steps=-1), dict(steps=1.5), dict(steps="9")):
        with pytest.raises(ValueError, match="whole number"):
            pushed.run(end=1.0, **wrong)
    with pytest.raises(TypeError, match="end is a number"):
        pushed.run(end="1")


def test_routines_are_callables(pushed):
    seen = []

    @pushed.user("50", inputs=["DZ(2, 1, 1)", "VZ(2, 1, 1)"])
    def spring(time, constants, values):
        seen.append((time, constants.tolist()))
        return 8.0 - 8.0 * values[0]

    run = pushed.run(end=3.0, steps=30, columns=["DZ(2, 1, 1)"], error=1e-8)
    np.testing.assert_allclose(run["DZ(2,1,1)"], 1 - np.cos(2 * run.time), atol=1e-6)
    assert seen[0][1] == [50.0]

    class Broken(Exception):
        pass

    def broken(time, constants, values):
        raise Broken(time)

    pushed.user("50", law=broken)
    with pytest.raises(Broken):
        pushed.run(end=3.0)
    pushed.user("50", law=lambda *_: [1.0, 2.0])
    with pytest.raises(ValueError, match="2 numbers"):
        pushed.run(end=3.0)
    pushed.user("50", law=lambda *_: float("nan"))
    with pytest.raises(ValueError, match="NaN at time"):
        pushed.run(end=3.0)
    with pytest.raises(cg.ModelError):
        cg.Model.from_text(pushed.text).run(end=1.0)
    assert cg.Model.from_text(pushed.text).run(end=1.0, zero_user=True).ok


LONG = {"end": 1e9, "steps": 1}
SWINGING = FALLING.replace(
    "END\n", "SFORCE/1, TRANSLATIONAL, I=2, J=1, FUNCTION=-8*(DM(2,1)-1)\\\nEND\n"
).replace("PART/2, MASS", "PART/2, QG=1,0,0, MASS")


def test_ctrl_c_ends_a_run_and_keeps_its_results():
    model = cg.Model.from_text(SWINGING)
    timer = threading.Timer(0.5, _thread.interrupt_main)
    begun = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt) as caught:
        model.run(**LONG)
    assert time.monotonic() - begun < 20
    assert caught.value.run.status == "interrupted"
    assert len(caught.value.run.time) >= 1


def test_other_threads_go_on_while_a_run_does():
    model = cg.Model.from_text(SWINGING)
    ended = threading.Event()

    def watch(now):
        if ended.is_set():
            raise StopIteration

    def go():
        with pytest.raises(StopIteration):
            model.run(**LONG, progress=watch)

    thread = threading.Thread(target=go)
    thread.start()
    beats = 0
    begun = time.monotonic()
    while time.monotonic() - begun < 0.5:
        beats += 1
        time.sleep(0.01)
    ended.set()
    thread.join(20)
    assert not thread.is_alive() and beats > 10


def test_a_run_that_ends_early_is_warned_of():
    with pytest.warns(cg.IncompleteRun, match="limit"):
        run = cg.Model.from_text(SWINGING).run(end=100.0, steps=10, max_steps=20)
    assert not run.ok and run.status == "limit" and run.stop_reason
    with pytest.raises(ValueError, match="notebook"):
        cg.Model.from_text(SWINGING).run(end=1.0, progress=True)


def test_models_pickle(slider_crank):
    again = pickle.loads(pickle.dumps(slider_crank))
    assert again.file == str(SLIDER_CRANK) and again.elements == slider_crank.elements
    first, second = (m.run(end=0.5, steps=20) for m in (slider_crank, again))
    np.testing.assert_array_equal(first["slider.X"], second["slider.X"])
