#!/usr/bin/python3
"""What calls from Python cost beside those from C++, and beside python-fcl if it is installed.

PYTHONPATH=build/release/python tests/python/bench.py [MESH]

Compares with the figures that the module measures inside itself, without Python in between. Ratios within one
run.
"""

import os
import sys
import time

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import lrbscope
from lrbscope import _core
from shapes import ball_arrays, random_poses, shifted


def best(action, repeats=7):
    """Return the least time that an action took, in seconds."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        action()
        times.append(time.perf_counter() - begin)
    return min(times)


def calls(a, b, pose, n=20000):
    """Print the time of a call from Python and of the query alone."""

    def loop():
        ask = lrbscope.collide
        for _ in range(n):
            ask(a, b, pose)

    alone = best(lambda: _core._collide_alone(a, b, np.broadcast_to(pose, (n, 4, 4)), 1)) / n
    from_python = best(loop) / n
    beyond = from_python - alone
    times = [f"{1e6 * t:.2f} us" for t in (from_python, alone, beyond)]
    print("  a call: {}, the query alone {}, beyond it {}".format(*times))


def batches(a, b, poses):
    """Print the time of batches beside the same loop in C++."""
    threads = [1] if os.cpu_count() == 1 else [1, os.cpu_count()]
    times = {}
    for n in threads:
        alone = best(lambda: _core._collide_alone(a, b, poses, n), 5)
        times[n] = best(lambda: lrbscope.collide(a, b, poses, threads=n), 5)
        print(f"  {len(poses)} poses, {n} threads: {times[n] / alone:.3f} of C++ ({1e3 * times[n]:.1f} ms)")
    if len(threads) > 1:
        print(f"  {threads[1]} threads are {times[1] / times[threads[1]]:.2f} times as fast as one")


def beside_fcl(body, poses):
    """Print the time of calls beside those of python-fcl, at poses in contact and apart."""
    try:
        import fcl
    except ImportError:
        print("python-fcl is not installed")
        return
    mesh = fcl.BVHModel()
    mesh.beginModel(len(body.vertices), len(body.faces))
    mesh.addSubModel(body.vertices, body.faces)
    mesh.endModel()
    one = fcl.CollisionObject(mesh)
    others = [fcl.CollisionObject(mesh, fcl.Transform(p[:3, :3], p[:3, 3])) for p in poses]
    first, every = fcl.CollisionRequest(), fcl.CollisionRequest(num_max_contacts=10**6)
    rows = [
        ("yes or no", lambda p: lrbscope.collide(body, body, p, mode="any"), lambda o: fcl.collide(one, o, first)),
        ("all pairs", lambda p: lrbscope.collide(body, body, p), lambda o: fcl.collide(one, o, every)),
        ("distance", lambda p: lrbscope.distance(body, body, p), lambda o: fcl.distance(one, o)),
    ]
    for name, ours, theirs in rows:
        times = [best(lambda: list(map(ours, poses)), 5), best(lambda: list(map(theirs, others)), 5)]
        texts = [f"{1e6 * t / len(poses):.1f} us" for t in times]
        print(f"  {name}: {texts[0]} a call, python-fcl {texts[1]}: {times[1] / times[0]:.1f} times as long")


def main():
    rng = np.random.default_rng(1)
    body = lrbscope.Body.load(sys.argv[1]) if len(sys.argv) > 1 else lrbscope.Body(*ball_arrays(4))
    box = body.box()
    size = np.linalg.norm(box[1] - box[0])
    print(f"{body.name}, {body.real_face_count} faces, with itself")
    print("apart:")
    calls(body, body, shifted(2 * size, 0, 0))
    print("in contact:")
    calls(body, body, shifted(0.4 * size, 0.1 * size, 0.05 * size), 2000)
    batches(body, body, random_poses(rng, 10000, 0.5 * size))
    for what, shift in (("in contact", 0.3), ("apart", 1.1)):
        print(f"{what}, beside python-fcl:")
        turned = random_poses(rng, 50, 0)
        turned[:, :3, 3] = shift * size * np.array([0.8, 0.6, 0])
        beside_fcl(body, turned)


if __name__ == "__main__":
    main()
