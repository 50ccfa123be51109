"""Queries of many poses: streams of answers in one process, and clusters of dask.distributed."""

import importlib.util
import itertools
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import lrbscope
from lrbscope.many import arrays, on_cluster, stream
from shapes import ball_arrays, cube_arrays, shifted


def bodies():
    return lrbscope.Body(*ball_arrays(2)), lrbscope.Body(*cube_arrays())


def along_x(count):
    return (shifted(x, 0.1, 0.2) for x in np.linspace(-3, 3, count))


QUERIES = [
    (lrbscope.collide, {}),
    (lrbscope.collide, {"mode": "any"}),
    (lrbscope.distance, {"tolerance": 0.01}),
    (lrbscope.clash, {}),
]


@pytest.mark.parametrize("query,options", QUERIES)
@pytest.mark.parametrize("chunk", [1, 7, 1000])
def test_a_stream_has_the_answers_of_a_batch(query, options, chunk):
    a, b = bodies()
    whole = arrays(query(a, b, np.array(list(along_x(20))), **options))
    answers = list(stream(query, a, b, along_x(20), chunk=chunk, **options))
    assert len(answers) == 20
    if query is lrbscope.collide:
        assert [r.fingerprint for r in answers] == whole["fingerprints"].tolist()
    elif query is lrbscope.distance:
        assert [r.lower for r in answers] == whole["lower"].tolist()
    else:
        assert [r.kind for r in answers] == whole["kinds"].tolist()


def test_a_stream_takes_motions_and_arrays():
    a, b = bodies()
    motions = np.array([[shifted(4, y, 0), shifted(0, y, 0)] for y in (0.1, 0.2, 9)])
    found = list(stream(lrbscope.first_contact, a, b, motions, chunk=2))
    assert [x.t0 for x in found] == lrbscope.first_contact(a, b, motions).t0.tolist()


def test_a_stream_holds_one_chunk_and_ends_when_its_reader_does():
    a, b = bodies()
    taken = 0

    def endless():
        nonlocal taken
        while True:
            taken += 1
            yield shifted(1, 0, 0)

    assert all(itertools.islice(stream(lrbscope.collide, a, b, endless(), chunk=10), 25))
    assert taken == 30
    assert list(stream(lrbscope.collide, a, b, [])) == []


def test_bad_chunks_and_poses_are_refused():
    a, b = bodies()
    with pytest.raises(lrbscope.InputError, match="chunk: expected at least 1 pose, found 0"):
        next(stream(lrbscope.collide, a, b, along_x(3), chunk=0))
    bad = [np.eye(4), np.full((4, 4), np.nan)]
    with pytest.raises(lrbscope.InputError):
        list(stream(lrbscope.collide, a, b, bad))


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, silence_logs=50
    ) as cluster, distributed.Client(cluster) as connected:
        yield connected


def joined(chunks):
    chunks = list(chunks)
    return {key: np.concatenate([chunk[key] for chunk in chunks]) for key in chunks[0]}


@pytest.mark.parametrize("query,options", QUERIES)
def test_a_cluster_has_the_answers_of_one_process(client, tmp_path, query, options):
    a, b = bodies()
    file = str(tmp_path / "a.lrb")
    a.save(file)
    whole = arrays(query(a, b, np.array(list(along_x(50))), **options))
    found = joined(on_cluster(client, query, file, b, along_x(50), chunk=8, **options))
    assert list(found) == list(whole)
    for key in whole:
        assert found[key].tobytes() == whole[key].astype(found[key].dtype).tobytes()


def test_a_worker_that_dies_loses_no_chunk_and_repeats_none(client, tmp_path):
    a, b = bodies()
    file = str(tmp_path / "a.lrb")
    a.save(file)
    poses = np.array(list(along_x(20000)))
    whole = arrays(lrbscope.collide(a, b, poses))
    chunks = on_cluster(client, lrbscope.collide, file, b, poses, chunk=500, ahead=16)
    found = [next(chunks)]
    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
    found += chunks
    assert len(found) == 40
    assert joined(found)["fingerprints"].tolist() == whole["fingerprints"].tolist()


def test_the_example_counts_what_one_process_counts(client, tmp_path):
    a, b = bodies()
    a.save(str(tmp_path / "a.ply"))
    b.save(str(tmp_path / "b.ply"))
    example = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "cluster.py")
    spec = importlib.util.spec_from_file_location("cluster", example)
    cluster = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(cluster)
    command = [sys.executable, example, str(tmp_path / "a.ply"), str(tmp_path / "b.ply"), client.scheduler.address]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    hits = sum(bool(r) for r in stream(lrbscope.collide, a, b, cluster.poses(1.0), chunk=10000, mode="any"))
    assert done.stdout.splitlines()[-1] == f"{hits} poses meet so far"


def test_errors_and_answers_of_a_cluster(client):
    a, b = bodies()
    with pytest.raises(lrbscope.InputError):
        list(on_cluster(client, lrbscope.collide, a, b, [np.full((4, 4), np.inf)]))
    with pytest.raises(lrbscope.InputError, match="no.lrb"):
        list(on_cluster(client, lrbscope.collide, "no.lrb", b, [np.eye(4)]))
    counts = on_cluster(client, lrbscope.collide, a, b, along_x(9), chunk=4, answer=lambda r: int(r.counts.sum()))
    assert len(list(counts)) == 3
