"""Meshes and poses for the tests."""

import numpy as np

from lrbscope import fcl


class Mesh:
    """What the tests give as a mesh of somebody else's: anything with vertices and faces."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces


def cube_arrays(side=1.0, corner=0.0):
    """Return a cube from a corner on, the origin if none is given, twelve triangles. side, corner: numbers, or
    three each for a box.
    """
    v = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)], dtype=float) * side + corner
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return v, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])


def open_cube_arrays():
    """Return a cube without its last triangle, which bounds no solid."""
    vertices, faces = cube_arrays()
    return vertices, faces[:-1]


def square_arrays(side=1.0, corner=0.0):
    """Return a square in the plane from a corner on, four segments."""
    v = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float) * side + corner
    return v, np.array([[0, 1], [1, 2], [2, 3], [3, 0]])


def ball_arrays(splits=2, radius=1.0):
    """Return an octahedron, split again and again and blown up to a ball: 8 * 4 ** splits triangles."""
    vertices = [tuple(sign * row) for row in np.eye(3) for sign in (1.0, -1.0)]
    faces = [(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    faces = [(a, b, c) if (a + b + c) % 2 == 0 else (a, c, b) for a, b, c in faces]
    for _ in range(splits):
        midpoints, split = {}, []

        def midpoint(a, b):
            key = (min(a, b), max(a, b))
            if key not in midpoints:
                m = np.add(vertices[a], vertices[b])
                midpoints[key] = len(vertices)
                vertices.append(tuple(m / np.linalg.norm(m)))
            return midpoints[key]

        for a, b, c in faces:
            ab, bc, ca = midpoint(a, b), midpoint(b, c), midpoint(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    return np.array(vertices) * radius, np.array(faces)


def shifted(x, y, z):
    """Return a pose that translates."""
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def bvh_model(vertices, faces):
    """Return a mesh of lrbscope.fcl."""
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    return model


def random_poses(rng, n, reach):
    """Return rotations by random angles with translations up to `reach`, (n, 4, 4)."""
    poses = np.tile(np.eye(4), (n, 1, 1))
    for pose in poses:
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        pose[:3, :3] = q * np.sign(np.linalg.det(q))
        pose[:3, 3] = rng.uniform(-reach, reach, 3)
    return poses


def placed(vertices, pose):
    """Return points in the world, rounded as the engine defines it: products added from left to right."""
    x, y, z = np.asarray(vertices, dtype=float).T
    return np.stack([((r[0] * x + r[1] * y) + r[2] * z) + r[3] for r in np.asarray(pose)[:3]], axis=1)
