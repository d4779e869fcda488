"""Sweeps on a cluster of processes: the rows of one process, also when a worker is killed."""

import os
import signal

import pycognate as cg
import numpy as np
import pytest
from test_sweep import DROP

distributed = pytest.importorskip("distributed")
dask = pytest.importorskip("dask")
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(scope="module")
def cluster():
    options = dict(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    # a chunk is given up at the second worker that dies over it, not at the fourth
    dask.config.set({"distributed.scheduler.allowed-failures": 1})
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        yield client


def asked(points):
    return dict(parameters={"VARIABLE/3": f"1:9:{points}", "PART/2.MASS": [1, 2]},
                measures=["last(DX(2))"], end=1.0, steps=20)  # fmt: skip


def test_a_cluster_makes_the_rows_of_one_process(cluster):
    model = cg.Model.from_text(DROP)
    here = model.sweep(**asked(6))
    there = model.sweep(client=cluster, **asked(6))
    for name in here:
        np.testing.assert_array_equal(there[name], here[name])
    assert there.status == here.status and list(there.run) == list(range(12))


def test_a_killed_worker_loses_nothing_and_repeats_nothing(cluster, tmp_path):
    model = cg.Model.from_text(DROP)
    pids = list(cluster.run(os.getpid).values())
    killed = []

    def kill_one(done):
        if done >= 10 and not killed:
            killed.append(pids[0])
            os.kill(pids[0], signal.SIGKILL)

    out = tmp_path / "table.csv"
    options = dict(client=cluster, chunk=3, progress=kill_one, out=out)
    there = model.sweep(**options, **asked(60))
    assert killed and list(there.run) == list(range(120)) and there.ok.all()
    here = model.sweep(**asked(60))
    np.testing.assert_array_equal(there["last(DX(2))"], here["last(DX(2))"])
    here.to_csv(tmp_path / "here.csv")
    assert out.read_bytes() == (tmp_path / "here.csv").read_bytes()


def test_a_run_that_kills_its_workers_is_a_row_with_its_reason(cluster):
    text = DROP.replace("FX=VARVAL(3)\\ FY=0\\ FZ=0", "FUNCTION=USER(1)")
    model = cg.Model.from_text(text)

    def law(time, constants, values):
        if values[0] == 3:
            os.kill(os.getpid(), signal.SIGKILL)
        return [values[0], 0.0, 0.0]

    model.user("VFORCE/1", ["VARVAL(3)"], law)
    table = model.sweep({"VARIABLE/3": [3]}, "last(DX(2))", 1.0, 2, client=cluster)
    assert list(table.status) == ["limit"] and "died" in table.reasons[0]
    table = model.sweep({"VARIABLE/3": [1, 2, 4]}, "last(DX(2))", 1.0, 2, client=cluster)
    np.testing.assert_allclose(table["last(DX(2))"], [0.5, 1, 2], rtol=1e-6)
