#!/usr/bin/python3
"""What calls of lrbscope cost beside those of python-fcl, for a mesh with itself at 50 poses.

PYTHONPATH=build/release/python tests/python/bench.py [MESH]
"""

import os
import sys
import timeit

import fcl
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import lrbscope
from shapes import ball_arrays, random_poses


def beside_fcl(body, poses):
    """Print the time of calls beside those of python-fcl."""
    mesh = fcl.BVHModel()
    mesh.beginModel(len(body.vertices), len(body.faces))
    mesh.addSubModel(body.vertices, body.faces)
    mesh.endModel()
    one = fcl.CollisionObject(mesh)
    others = [fcl.CollisionObject(mesh, fcl.Transform(p[:3, :3], p[:3, 3])) for p in poses]
    first, every = fcl.CollisionRequest(), fcl.CollisionRequest(num_max_contacts=10**6)
    for name, ours, theirs in (
        ("yes or no", lambda p: lrbscope.collide(body, body, p, mode="any"), lambda o: fcl.collide(one, o, first)),
        ("all pairs", lambda p: lrbscope.collide(body, body, p), lambda o: fcl.collide(one, o, every)),
        ("distance", lambda p: lrbscope.distance(body, body, p), lambda o: fcl.distance(one, o)),
    ):
        tried = (lambda: list(map(ours, poses)), lambda: list(map(theirs, others)))
        times = [min(timeit.repeat(action, number=1)) for action in tried]
        texts = [f"{1e6 * t / len(poses):.1f} us" for t in times]
        print(f"  {name}: {texts[0]} a call, python-fcl {texts[1]}: {times[1] / times[0]:.1f} times as long")


body = lrbscope.Body.load(sys.argv[1]) if len(sys.argv) > 1 else lrbscope.Body(*ball_arrays(4))
size = np.linalg.norm(np.subtract(*body.box()))
print(f"{body.name}, {body.real_face_count} faces, with itself")
for what, shift in (("in contact", 0.3), ("apart", 1.1)):
    turned = random_poses(np.random.default_rng(1), 50, 0)
    turned[:, :3, 3] = shift * size * np.array([0.8, 0.6, 0])
    print(f"{what}:")
    beside_fcl(body, turned)
