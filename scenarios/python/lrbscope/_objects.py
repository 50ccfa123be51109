"""What managers of many objects share: bodies of meshes, boxes, and which pairs to ask for."""

import hashlib
from collections import OrderedDict

import numpy as np

from . import _core

# Boxes are exact, but the gap between two of them is rounded.
_ROUNDING = 1 - 1e-12


class BodyCache:
    """Bodies of meshes that were given lately, so that one mesh is not taken in again and again."""

    _MOST = 64

    def __init__(self):
        self._bodies = OrderedDict()

    def body(self, mesh):
        """Return the body of anything with `vertices` and `faces`; without regions, which no answer here
        needs.
        """
        if isinstance(mesh, _core.Body):
            return mesh
        try:
            vertices, faces = mesh.vertices, mesh.faces
        except AttributeError:
            kind = type(mesh).__name__
            raise TypeError(f"mesh: expected something with vertices and faces, got {kind}") from None
        vertices, faces = np.ascontiguousarray(vertices), np.ascontiguousarray(faces)
        key = tuple(
            (a.dtype.str, a.shape, hashlib.blake2b(a.view(np.uint8).reshape(-1) if a.size else b"").digest())
            for a in (vertices, faces)
        )
        if key not in self._bodies:
            self._bodies[key] = _core.Body(vertices, faces, regions=False, name="mesh")
            if len(self._bodies) > self._MOST:
                self._bodies.popitem(last=False)
        self._bodies.move_to_end(key)
        return self._bodies[key]


def gaps(box, boxes):
    """Return how far a box (2, 3) is from each of some boxes (n, 2, 3): (n,), rounded down, 0 where they
    meet.
    """
    apart = np.maximum(boxes[:, 0] - box[1], box[0] - boxes[:, 1])
    return np.linalg.norm(np.maximum(apart, 0), axis=1) * _ROUNDING


def meeting(box, boxes):
    """Return the numbers of the boxes (n, 2, 3) that a box (2, 3) has a point in common with."""
    return np.flatnonzero(((boxes[:, 0] <= box[1]) & (box[0] <= boxes[:, 1])).all(axis=1))


def by_gap(boxes_a, boxes_b=None):
    """Yield (gap, i, j) for pairs of boxes, in each row the nearest first; without boxes_b the pairs i <
    j of boxes_a.
    """
    for i, box in enumerate(boxes_a):
        first = i + 1 if boxes_b is None else 0
        row = gaps(box, (boxes_a if boxes_b is None else boxes_b)[first:])
        for j in np.argsort(row, kind="stable"):
            yield row[j], i, first + int(j)
