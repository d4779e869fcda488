"""Elements by their names, and runs that are asked for nothing."""

import pytest

import pycognate as cg

FALLING = """falling
ACCGRAV/JGRAV=-10
!  adams_view_name='ground'
PART/1, GROUND
MARKER/10, PART=1
!  adams_view_name='ball'
PART/2, MASS=1, CM=20, IP=1,1,1
MARKER/20, PART=2
!  adams_view_name='tip'
MARKER/21, PART=2, QP=1,0,0
!  adams_view_name='rail'
JOINT/1, TRANSLATIONAL, I=22, J=11
MARKER/22, PART=2, REULER=0,90D,0
MARKER/11, PART=1, REULER=0,90D,0
END
"""


def test_a_run_without_columns_has_every_body_and_joint():
    model = cg.Model.from_text(FALLING)
    run = model.run(end=0.1, steps=2)
    assert {"ball_XFORM.X", "rail.FX", "rail_VARIABLES.DISTANCE"} <= set(run)
    assert list(model.run(end=0.1, steps=2, full=False)) == ["time"]
    assert list(model.run(end=0.1, steps=2, columns=["TIME*2"])) == ["time", "TIME*2"]


def test_elements_have_their_names_in_columns():
    model = cg.Model.from_text(FALLING)
    names = ["DY(ball.cm, ground)", "DX(ball.tip)", "rail.FX"]
    run = model.run(end=0.1, steps=2, columns=names)
    assert list(run) == ["time", *names]
    assert (run["DX(ball.tip)"] == 1).all() and (run["rail.fx"] == run["rail.FX"]).all()
    run = model.run(end=0.1, steps=2)
    assert (run.measure("DX(ball.tip)") == 1).all() and (run["JOINT/1.FX"] == run["rail.FX"]).all()
    assert set(run.to_pandas(["rail.*"]).columns) == {f"rail.{c}" for c in ("FX", "FY", "FZ", "TX", "TY", "TZ")}
    with pytest.raises(cg.ModelError, match="did you mean ball.tip") as caught:
        model.run(end=0.1, columns=["1+DX(ball.tpi)"])
    assert caught.value.file == "columns[0]" and caught.value.column == 6
    with pytest.raises(cg.ColumnError, match="ball_XFORM.X, ball_DISPLACEMENT.X"):
        run["ball.X"]


def test_a_cell_that_runs_twice_is_refused():
    builder = cg.ModelBuilder("twice").units("MKS")
    for _ in range(2):
        rod = builder.part("rod").mass(1).inertia(1, 1, 1).center([0.5, 0, 0])
        builder.revolute("hinge", rod.at([0, 0, 0]), builder.ground)
    with pytest.raises(cg.ModelError, match="PART/2 has this name already") as caught:
        builder.build()
    assert [e.name for e in caught.value.errors] == ["rod", "hinge"]
