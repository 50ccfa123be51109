"""What managers of many objects share: bodies of meshes."""

import hashlib
from collections import OrderedDict

import numpy as np

from . import _core


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
