"""contact.py PICTURE.png: where two rings made of NumPy arrays intersect, how deep, and a picture of it."""

import sys

import lrbscope
import numpy as np


def ring(radius, thickness, n=64, m=24):
    """Return the vertices (n m, 3) and triangles (2 n m, 3) of a torus around the z axis."""
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    u, v = 2 * np.pi * i / n, 2 * np.pi * j / m
    r = radius + thickness * np.cos(v)
    vertices = np.stack([r * np.cos(u), r * np.sin(u), thickness * np.sin(v)], axis=-1)
    corner = [((i + a) % n * m + (j + b) % m).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = np.concatenate([np.stack([corner[k] for k in abc], 1) for abc in ((0, 1, 2), (0, 2, 3))])
    return vertices.reshape(-1, 3), triangles


if len(sys.argv) != 2:
    sys.exit("usage: contact.py PICTURE.png")
a = lrbscope.Body(*ring(1.0, 0.25), name="large ring")
b = lrbscope.Body(*ring(0.8, 0.2), name="small ring")
pose = np.eye(4)  # of B, body to world; (k, 4, 4) for many poses
pose[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
pose[:3, 3] = 1.45, 0.1, 0.2

result = lrbscope.collide(a, b, pose)
print(result.relation, len(result.pairs), "pairs of triangles")
for region in lrbscope.contacts(a, b, pose):
    print(f"{len(region.curves)} curves, length {region.length:.3f}, normal {region.normal.round(3)}")
clash = lrbscope.clash(a, b, pose)
print("depth {:.3f} to {:.3f}".format(*clash.depth), "B is free when moved by", clash.translation.round(3))
try:
    lrbscope.render(a, b, pose, size=(960, 720)).save(sys.argv[1])
except OSError as error:
    sys.exit(error)
