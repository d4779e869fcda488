"""Many runs of one model: laws of the rows, the same bits however they are made, interruption."""

import _thread
import threading

import pycognate as cg
import numpy as np
import pytest
from conftest import PUSHED

DROP = """a drop
UNITS/SYSTEM=MKS
PART/1, GROUND
PART/2, MASS=1, CM=2, IP=1,1,1
MARKER/2, PART=2
VARIABLE/3, FUNCTION=1
VFORCE/1, I=2, JFLOAT=9, FX=VARVAL(3)\\ FY=0\\ FZ=0
MARKER/9, PART=1, FLOATING
END
"""


@pytest.fixture
def drop():
    return cg.Model.from_text(DROP)


def test_rows_obey_newton_and_do_not_depend_on_threads(drop):
    parameters = {"VARIABLE/3": "1:4:4", "PART/2.MASS": np.array([1, 2, 8])}
    asked = dict(end=1.0, steps=10, kind="dynamic")
    table = drop.sweep(parameters, ["last(DX(2))", "max(VX(2))"], **asked)
    assert table.parameters == ("VARIABLE/3", "PART/2.MASS") and len(table) == 12
    way = 0.5 * table["VARIABLE/3"] / table["PART/2.MASS"]
    np.testing.assert_allclose(table["last(DX(2))"], way, atol=1e-6)
    assert table.ok.all() and table.units["last(DX(2))"] == "meter"
    alone = cg.sweep(drop, parameters, ["last(DX(2))", "max(VX(2))"], threads=1, **asked)
    for name in table:
        np.testing.assert_array_equal(alone[name], table[name])
    single = drop.changed("VARIABLE/3, FUNCTION=2").changed("PART/2, MASS=8")
    run = single.run(columns=["DX(2)"], **asked)
    (row,) = np.flatnonzero((table["VARIABLE/3"] == 2) & (table["PART/2.MASS"] == 8))
    assert run["DX(2)"][-1] == table["last(DX(2))"][row]


def test_a_table_grows_in_a_file_and_is_gone_on_with(drop, tmp_path):
    pandas = pytest.importorskip("pandas")
    out = tmp_path / "table.csv"
    asked = dict(measures="last(DX(2))", end=1.0, steps=5, out=out)
    first = drop.sweep({"VARIABLE/3": [1, 2]}, **asked)
    seen = []
    table = drop.sweep({"VARIABLE/3": [1, 2, 3]}, progress=seen.append, **asked)
    assert seen == [3.0]
    np.testing.assert_array_equal(table["last(DX(2))"][:2], first["last(DX(2))"])
    read = pandas.read_csv(out, skiprows=[1])
    np.testing.assert_array_equal(read["last(DX(2))"].astype(float), table["last(DX(2))"])
    table.to_csv(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == out.read_bytes()
    frame = table.to_pandas()
    assert list(frame["status"]) == ["completed"] * 3 and frame.index.name == "run"
    with pytest.raises(cg.ModelError, match="no table of this sweep"):
        drop.sweep({"VARIABLE/3": [1]}, "last(VX(2))", end=1.0, steps=5, out=out)


def test_designs_and_plots(drop):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    latin = dict(design="latin", runs=5, seed=3, end=1.0, steps=2)
    table = drop.sweep({"VARIABLE/3": "0:10"}, "last(DX(2))", **latin)
    assert sorted(int(x // 2) for x in table["VARIABLE/3"]) == [0, 1, 2, 3, 4]
    given = drop.sweep({"VARIABLE/3": []}, "last(DX(2))", end=1.0, steps=2, design=[[3.0], [1.0]])
    np.testing.assert_array_equal(given["VARIABLE/3"], [3, 1])
    axes = table.plot()
    assert axes.get_xlabel() == "VARIABLE/3" and "meter" in axes.get_ylabel()
    grid = {"PART/2.MASS": [2, 1], "VARIABLE/3": [1, 3, 2]}
    axes = drop.sweep(grid, "last(DX(2))", end=1.0, steps=2).plot("VARIABLE/3")
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["PART/2.MASS = 2", "PART/2.MASS = 1"]
    for line in axes.lines:
        np.testing.assert_array_equal(line.get_xdata(), [1, 2, 3])
    scattered = drop.sweep({"VARIABLE/3": "0:1", "PART/2.MASS": "1:2"}, "last(DX(2))", **latin)
    (points,) = scattered.plot().lines
    assert points.get_linestyle() == "None" and len(points.get_xdata()) == 5
    with pytest.raises(ValueError, match="column for each parameter"):
        drop.sweep({"VARIABLE/3": []}, "last(DX(2))", end=1.0, design=[[1.0, 2.0]])


def test_mistakes_come_at_once_and_failures_are_rows(drop):
    with pytest.raises(cg.ModelError) as caught:
        drop.sweep({"PART/2.MAS5": [1], "VARIABLE/3": [1]}, ["last(DX(7))", "best(DX(2))"], end=1.0)
    assert len(caught.value.errors) == 3
    table = drop.sweep({"PART/2.MASS": [1, -1]}, "last(DX(2))", end=1.0, steps=2)
    assert list(table.ok) == [True, False] and np.isnan(table["last(DX(2))"][1])
    assert "negative_mass" in table.reasons[1] and table.reasons[0] == ""


def test_routines_are_called_and_what_they_raise_comes_out():
    model = cg.Model.from_text(PUSHED)
    parameters = {"PART/2.MASS": [1.0, 2.0, 4.0]}
    model.user("SFORCE/3", ["TIME"], lambda time, constants, values: constants[0])
    table = model.sweep(parameters, "last(DX(2))", end=1.0, steps=2)
    np.testing.assert_allclose(table["last(DX(2))"], 25 / table["PART/2.MASS"], rtol=1e-6)

    def broken(time, constants, values):
        raise ArithmeticError("no force today")

    model.user("SFORCE/3", [], broken)
    with pytest.raises(ArithmeticError, match="today"):
        model.sweep(parameters, "last(DX(2))", end=1.0, steps=2)


def test_ctrl_c_keeps_the_rows_so_far(drop):
    def soon(done):
        if done == 2:
            threading.Timer(0.0, _thread.interrupt_main).start()

    with pytest.raises(KeyboardInterrupt) as caught:
        drop.sweep({"VARIABLE/3": "1:2:20000"}, "last(DX(2))", end=1.0, steps=50, progress=soon)
    table = caught.value.table
    assert 2 <= len(table.run) < 20000 and table.ok.all()
