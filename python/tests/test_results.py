"""Results: views, units, bars, tables, pictures, files, pickles."""

import gc
import pickle

import pycognate as cg
import numpy as np
import pytest


@pytest.fixture
def run(slider_crank):
    return slider_crank.run(end=1.0, steps=50, columns=["DX(41,22)"])


def test_columns_are_views_that_cannot_be_written(run):
    column = run["slider.X"]
    assert isinstance(column, np.ndarray) and column.dtype == np.float64
    assert not column.flags.owndata and not column.flags.writeable
    assert run["slider.x"] is column
    with pytest.raises(ValueError):
        column[0] = 1.0
    values = column.tolist()
    del run
    gc.collect()
    assert column.tolist() == values


def test_columns_have_units_and_rows(run):
    assert run.units["slider.X"] == "mm" and run.units["crank.WZ"] == "rad/sec"
    assert run.units["time"] == "sec" and len(run.time) == 51
    assert list(run)[0] == "time" and "DX(41,22)" in run and "nothing" not in run
    assert run.entities["slider"]["X"] == "slider.X"
    assert [kind for _, kind, _ in run.sequences] == ["initialConditions", "kinematic"]
    _, _, rows = run.sequences[-1]
    assert run.time[rows][-1] == 1.0


def test_a_column_that_is_not_there_is_told_with_near_names(run):
    with pytest.raises(cg.ColumnError, match="did you mean slider.X") as caught:
        run["slider.XX"]
    assert isinstance(caught.value, KeyError) and caught.value.code == "unknown_column"


def test_motions_of_markers_are_found_after_a_run(slider_crank):
    run = slider_crank.run(end=1.0, steps=50, columns=["DX(41,22)", "VX(41,22)"], full=True)
    for name in ("DX(41,22)", "VX(41,22)"):
        np.testing.assert_allclose(run.measure(name), run[name], rtol=1e-6, atol=1e-6)
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.measure("DX(41,22)"), run.measure("DX(41,22)"))
    for wrong in ("DX(41,99)", "2*DX(41,22)", "FX(41,22)"):
        with pytest.raises(cg.ModelError):
            run.measure(wrong)


def test_bars_of_error_hold(falling):
    assert "believe" in falling.run(end=1.0, steps=10).accuracy
    assert falling.run(end=1.0, steps=10, accuracy=False).accuracy is None
    run = falling.run(end=1.0, steps=10, accuracy=True)
    assert np.all(run.bars("ball.Z") >= 0)
    with pytest.raises(cg.ColumnError):
        falling.run(end=1.0).bars("ball.Z")


def test_the_record_is_a_dictionary(run):
    assert run.record["status"] == "completed" and run.record["freedom"] == 0
    assert "slider" in run.log.lower()
    assert "completed" in run._repr_html_() and "<Run" in repr(run)


def test_tables_of_other_packages(run):
    pandas = pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "time"
    np.testing.assert_array_equal(frame["slider.X"], run["slider.X"])
    assert frame.attrs["units"]["slider.X"] == "mm"
    assert list(run.to_pandas(["slider.X"]).columns) == ["slider.X"]
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data["slider.X"].attrs["units"] == "mm" and data.sizes["time"] == 51


def test_plots_have_a_panel_for_each_unit(run):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = run.plot(["slider.X", "DX(41,22)", "crank.WZ"])
    assert [a.get_ylabel() for a in axes] == ["mm", "rad/sec"]
    assert len(axes[0].lines) == 2
    assert run.plot("slider.X").get_ylabel() == "mm"
    matplotlib.pyplot.close("all")


def test_a_run_is_a_page_that_moves(slider_crank, falling, tmp_path):
    with pytest.raises(cg.ResultsError, match="frames=True"):
        falling.run(end=1.0, steps=2).animate()
    moved = slider_crank.run(end=0.1, steps=5, frames=True).animate()
    moved.save(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert page == moved.html and page.startswith("<!DOCTYPE html>")
    # nothing is fetched, nor is another page shown in its place
    assert "default-src 'none'" in page and "http-equiv=\"refresh\"" not in page
    shown = moved._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and shown.count('"') == 4


@pytest.mark.parametrize("ending", ["csv", "parquet", "res"])
def test_files_come_back_as_they_went(run, tmp_path, ending):
    path = tmp_path / f"run.{ending}"
    getattr(run, f"to_{ending}")(path)
    again = cg.read_results(path)
    np.testing.assert_array_equal(again.time, run.time)
    name = "slider.X"
    np.testing.assert_array_equal(again[name], run[name])
    assert again.units[name] == run.units[name]
    with pytest.raises(ValueError, match="ends in"):
        getattr(run, f"to_{ending}")(tmp_path / "run.txt")


def test_result_files_are_read_by_set_and_component(slider_crank, tmp_path):
    path = tmp_path / "crank.res"
    slider_crank.run(end=1.0, steps=50).to_res(path)
    read = cg.read_res(path)
    assert read.entities["slider"]["X"] in read
    pytest.importorskip("pandas")
    data, units = cg.get_results(path, {"slider": ["X", "VX"]}, t_min=0.25, t_max=0.5)
    assert list(data.columns) == [("slider", "X"), ("slider", "VX")]
    assert data.index[0] == 0.26 and data.index[-1] == 0.5
    assert units == {"slider": {"X": "mm", "VX": "mm/sec"}}
    with pytest.raises(cg.ColumnError):
        cg.get_results(path, {"slider": ["Q"]})
    broken = tmp_path / "broken.res"
    broken.write_text("<Results><nothing")
    with pytest.raises(cg.ResultsError) as caught:
        cg.read_res(broken)
    assert caught.value.file == str(broken)


def test_results_pickle(run, tmp_path):
    again = pickle.loads(pickle.dumps(run))
    assert list(again) == list(run) and again.record == run.record and again.units == run.units
    for name in run.names:
        np.testing.assert_array_equal(again[name], run[name])
    again.to_res(tmp_path / "again.res")
    run.to_res(tmp_path / "run.res")
    assert (tmp_path / "again.res").read_bytes() == (tmp_path / "run.res").read_bytes()
