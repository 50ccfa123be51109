"""Queries for more poses than fit in memory, or than one machine can answer in time.

>>> import numpy as np
>>> import lrbscope
>>> from lrbscope.many import stream
>>> cube = lrbscope.Body(
...     [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
...     [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]],
... )
>>> def poses():
...     for x in range(4):
...         pose = np.eye(4)
...         pose[0, 3] = x
...         yield pose
>>> [result.relation for result in stream(lrbscope.collide, cube, cube, poses())]
['touching', 'touching', 'separate', 'separate']
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Body, Distances, FirstContacts, InputError, Results

__all__ = ["arrays", "on_cluster", "stream"]

_Query = Callable[..., Any]
_Arrays = dict[str, npt.NDArray[Any]]


def _chunks(poses: Iterable[npt.ArrayLike], chunk: int) -> Iterator[npt.NDArray[np.float64]]:
    if chunk < 1:
        raise InputError(f"chunk: expected at least 1 pose, found {chunk}")
    rest = iter(poses)
    while taken := list(itertools.islice(rest, chunk)):
        yield np.asarray(taken, dtype=np.float64)


def stream(
    query: _Query, a: Body, b: Body, poses_b: Iterable[npt.ArrayLike], *, chunk: int = 1024, **options: Any
) -> Iterator[Any]:
    """Yield the answer for each pose of B (4, 4), in their order, as they come.

    `query` is `collide`, `distance`, `clash`, `contacts` or `first_contact` (whose "poses" are motions), with
    its `options`. `poses_b` may be an array (k, 4, 4) or any iterable, such as a generator that reads a file.
    At most `chunk` poses and answers are in memory; each chunk is answered on all cores. Stop whenever you
    like: with `break`, or with Ctrl-C, which ends the current chunk.
    """
    for taken in _chunks(poses_b, chunk):
        yield from query(a, b, taken, **options)


def arrays(answers: Any) -> _Arrays:
    """Return the arrays of a batch's answers, one entry for each pose.

    Results: relations, counts (of pairs of faces) and fingerprints; Distances: lower and upper; FirstContacts:
    t0 and t1; a list of Clash: kinds, and depths (k, 2), NaN for bodies without a depth.
    """
    if isinstance(answers, Results):
        return {
            "relations": answers.relations,
            "counts": answers.counts,
            "fingerprints": answers.fingerprints,
        }
    if isinstance(answers, Distances):
        return {"lower": answers.lower, "upper": answers.upper}
    if isinstance(answers, FirstContacts):
        return {"t0": answers.t0, "t1": answers.t1}
    none = (np.nan, np.nan)
    return {
        "kinds": np.array([clash.kind for clash in answers]),
        "depths": np.array([clash.depth or none for clash in answers], dtype=np.float64).reshape(-1, 2),
    }


def _load(path: str) -> Body:
    return Body.load(path)


def _answer(
    query: str, a: Body, b: Body, poses: npt.NDArray[np.float64], answer: Callable[[Any], Any], options: Any
) -> Any:
    # A worker of the cluster may have several of these at a time, one for each of its threads.
    return answer(getattr(_core, query)(a, b, poses, threads=1, **options))


def on_cluster(
    client: Any,
    query: _Query,
    a: Body | str,
    b: Body | str,
    poses_b: Iterable[npt.ArrayLike],
    *,
    chunk: int = 4096,
    ahead: int = 0,
    answer: Callable[[Any], Any] = arrays,
    **options: Any,
) -> Iterator[Any]:
    """Yield answer(answers) for each chunk of poses, in their order, computed by a dask.distributed cluster.

    `client` is a `distributed.Client`, or has its `submit`, `scatter` and `cancel`. A body is a `Body`, copied
    to every worker, or the name of a file that every worker can read. Chunks of a worker that dies are
    computed again by the others: no chunk is lost or comes twice, and the answers equal those of one process,
    bit for bit. A body that was copied is lost with the last worker that has it; a file is read again.
    `ahead`: how many chunks are submitted before the first is awaited [four for each thread of the cluster].
    """
    bodies = [
        client.submit(_load, body, pure=False)
        if isinstance(body, str)
        else client.scatter(body, broadcast=True, hash=False)
        for body in (a, b)
    ]
    most = ahead or 4 * max(1, sum(client.nthreads().values()))
    waiting: deque[Any] = deque()
    try:
        for taken in _chunks(poses_b, chunk):
            if len(waiting) == most:
                yield waiting.popleft().result()
            waiting.append(client.submit(_answer, query.__name__, *bodies, taken, answer, options, pure=False))
        while waiting:
            yield waiting.popleft().result()
    finally:
        client.cancel(list(waiting))
