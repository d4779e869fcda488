"""Sweeps on the workers of a Dask cluster; imported where a client is given."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

# lambdas and functions of a notebook are pickled, too; Dask brings it
import cloudpickle
from distributed import WorkerPlugin, as_completed
from distributed.scheduler import KilledWorker

from . import _core

if TYPE_CHECKING:
    from ._sweep import Job, Row

__all__ = ["run_on_cluster"]

#: Chunks for each thread of a cluster, where the caller does not choose: late ones fill gaps.
_CHUNKS_A_THREAD = 8

#: Jobs that this worker has been given, by their keys, and the sweeps made of them.
_pickled: dict[str, bytes] = {}
_sweeps: dict[str, _core.Sweep] = {}


class _Delivery(WorkerPlugin):  # type: ignore[misc]
    """A job for every worker, also for those that take the place of lost ones."""

    def __init__(self, key: str, pickled: bytes) -> None:
        self.name = f"pycognate-{key}"
        self._key, self._job = key, pickled

    def setup(self, worker: Any) -> None:
        """Take the job."""
        _pickled[self._key] = self._job

    def teardown(self, worker: Any) -> None:
        """Forget it."""
        _pickled.pop(self._key, None)
        _sweeps.pop(self._key, None)


def _chunk(key: str, indices: list[int], points: list[list[float]]) -> list[Row]:
    """Run some points on a worker, in one thread."""
    if key not in _sweeps:
        job: Job = pickle.loads(_pickled[key])
        _sweeps[key] = job.sweep()
    rows: list[Row] = []
    _sweeps[key].run(points, list(range(len(points))), 1, rows.append)
    return [(indices[row[0]], *row[1:]) for row in rows]


def run_on_cluster(
    client: Any,
    job: Job,
    points: Sequence[list[float]],
    wanted: Sequence[int],
    chunk: int | None,
    take: Callable[[Row], None],
) -> None:
    """Run points on the workers of a Dask cluster; hand rows over as they come.

    A chunk whose worker is lost is given to another. Dask gives one up that was there when several
    workers died; its runs become rows with that reason and the status of a limit, so that a table
    that is gone on with tries them again.
    """
    threads = sum(client.nthreads().values()) or 1
    size = chunk or max(1, -(-len(wanted) // (_CHUNKS_A_THREAD * threads)))
    delivery = _Delivery(job.key, cloudpickle.dumps(job))
    client.register_plugin(delivery)
    chunks: dict[str, Sequence[int]] = {}
    queue = as_completed()
    try:
        for k in range(0, len(wanted), size):
            indices = list(wanted[k : k + size])
            given = [points[run] for run in indices]
            future = client.submit(_chunk, job.key, indices, given, pure=False)
            chunks[future.key] = indices
            queue.add(future)
        for future in queue:
            wrong = future.exception()
            if wrong is None:
                for row in future.result():
                    take(row)
            elif isinstance(wrong, KilledWorker):
                measures = [float("nan")] * len(job.measures)
                reason = "its workers died, one after another"
                for run in chunks[future.key]:
                    take((run, points[run], measures, "limit", 0, reason))
            else:
                raise wrong
            future.release()
    finally:
        client.cancel(list(queue.futures))
        client.unregister_worker_plugin(delivery.name)
