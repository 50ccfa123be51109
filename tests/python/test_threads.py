"""Threads, forks, interrupts."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, collide
from shapes import ball_arrays, random_poses, shifted


def test_threads_share_bodies(ball, rng):
    poses = random_poses(rng, 64, 1.5)
    wanted = [collide(ball, ball, p).fingerprint for p in poses]
    with ThreadPoolExecutor(4) as pool:
        for _ in range(3):
            assert list(pool.map(lambda p: collide(ball, ball, p).fingerprint, poses)) == wanted
            batches = pool.map(lambda _: collide(ball, ball, poses).fingerprints.tolist(), range(4))
            assert all(b == wanted for b in batches)
        nearest = list(pool.map(lambda p: lrbscope.distance(ball, ball, p).upper, poses))
    assert nearest == lrbscope.distance(ball, ball, poses).upper.tolist()


class TenTurns(Exception):
    """Raised in the main thread by the signal of a thread that had its turns."""


def test_a_batch_lets_other_threads_run(ball, rng):
    """A thread that gets its turns while a batch runs ends the batch; otherwise the batch would end by itself."""
    poses = np.tile(random_poses(rng, 1000, 0.3), (300, 1, 1))

    def stop(*_):
        raise TenTurns

    def ten_turns():
        for _ in range(10):
            time.sleep(0.001)
        signal.pthread_kill(threading.main_thread().ident, signal.SIGUSR1)

    kept = signal.signal(signal.SIGUSR1, stop)
    thread = threading.Thread(target=ten_turns)
    try:
        with pytest.raises(TenTurns):
            thread.start()
            collide(ball, ball, poses)
    finally:
        signal.signal(signal.SIGUSR1, signal.SIG_IGN)  # the thread may not have had its turns yet
        thread.join()
        signal.signal(signal.SIGUSR1, kept)


def _query_in_a_child(given):
    copy, pose = given
    body = Body(*ball_arrays(3))
    return copy.hash, collide(body, body, [pose] * 10, threads=0), collide(copy, body, pose, contacts=True)


@pytest.mark.parametrize("way", ["fork", "spawn"])
def test_processes(ball, way):
    """Bodies go to other processes, and answers come back."""
    poses = [shifted(1.1 + 0.1 * i, 0.2, 0.3) for i in range(4)]
    collide(ball, ball, poses)  # threads have been started before the fork
    with multiprocessing.get_context(way).Pool(2) as pool:
        found = pool.map(_query_in_a_child, [(ball, pose) for pose in poses])
    for pose, (hash_, many, one) in zip(poses, found):
        wanted = collide(ball, ball, pose, contacts=True)
        assert hash_ == ball.hash and {*many.fingerprints, one.fingerprint} == {wanted.fingerprint}
        assert np.array_equal(one.face_pairs, wanted.face_pairs) and one.counters == wanted.counters
        assert [r.depth_estimate for r in one.regions] == [r.depth_estimate for r in wanted.regions]


INTERRUPTED = """
    import sys
    import time
    import numpy as np
    import lrbscope
    sys.path.insert(0, {here!r})
    from shapes import ball_arrays, random_poses
    ball = lrbscope.Body(*ball_arrays(4))
    poses = np.tile(random_poses(np.random.default_rng(1), 100, 0.3), (3000, 1, 1))
    print("ready", flush=True)
    try:
        {call}
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""


@pytest.mark.parametrize(
    "call",
    [
        "lrbscope.collide(ball, ball, poses)",
        "lrbscope.distance(ball, ball, poses)",
        "lrbscope.trace(ball, ball, poses, max_events=1)",
    ],
)
def test_interrupts_end_a_batch(call):
    here = os.path.dirname(os.path.abspath(__file__))
    script = textwrap.dedent(INTERRUPTED).format(here=here, call=call)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        try:
            said, _ = child.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            child.kill()
            raise
    assert said == "interrupted\n" and child.returncode == 0


def test_memory_is_given_back(ball):
    """Results and views in a loop do not pile up."""
    pose = shifted(1.1, 0.3, 0.2)

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1])

    def ask(n):
        for _ in range(n):
            r = collide(ball, ball, pose, contacts=True)
            assert r.pairs.base is not None and r.regions[0].curves

    ask(200)
    before = resident()
    ask(1000)
    assert resident() - before < 2000  # pages; 1000 answers would be 10,000
