"""Collisions between many named objects, with the interface of trimesh.collision.

>>> m = CollisionManager()
>>> _ = m.add_object("left", cube)
>>> _ = m.add_object("right", cube, shifted(3, 0, 0))
>>> m.in_collision_internal()
False
>>> round(m.min_distance_internal(), 9)
2.0
>>> m.set_transform("right", shifted(0.5, 0.25, 0.125))
>>> m.in_collision_internal(return_names=True)
(True, {('left', 'right')})

Objects collide if their surfaces intersect, or if one is inside another that is a solid. Only intersecting
surfaces have contacts, not an object inside another. Distances refer to the solids, 0 if objects collide.
"""

from __future__ import annotations

import hashlib
import math
import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator, Sequence
    from typing import Optional, Protocol

    import numpy.typing as npt

    from ._core import Body, Result

    class _Mesh(Protocol):
        @property
        def vertices(self) -> Any: ...
        @property
        def faces(self) -> Any: ...

    _Floats = npt.NDArray[np.float64]
    _Pose = Optional[npt.ArrayLike]
    _Placed = tuple[Body, _Floats]
    _Names = tuple[Any, Any]
    _Contacts = list["ContactData"]
    _Nearest = Optional["DistanceData"]


class Shown:
    """Displays an object in one line, with its public attributes and properties."""

    def __repr__(self) -> str:
        names = [name for name in vars(self) if not name.startswith("_")]
        names += [name for name, value in vars(type(self)).items() if isinstance(value, property)]
        shown = ", ".join(f"{name}={_short(getattr(self, name))}" for name in names)
        return f"<{type(self).__module__}.{type(self).__name__}{' ' if shown else ''}{shown}>"


def _short(value: Any) -> str:
    """Return a value in a few characters: numbers rounded, lists and large arrays counted."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, np.ndarray) and value.size > 4:
        return f"({', '.join(map(str, value.shape))}) array"
    if isinstance(value, list) and len(value) > 2:
        return f"[{len(value)} items]"
    if isinstance(value, (list, np.ndarray)):
        return "[" + ", ".join(map(_short, value)) + "]"
    text = repr(value)
    return text if len(text) <= 80 else f"<{type(value).__name__}>"


class Crowd:
    """Labelled objects in a Scene: the core of both collision managers."""

    def __init__(self) -> None:
        self.scene = _core.Scene()
        self.labels: dict[int, Any] = {}  # by key

    def add(self, label: Any, body: Body, pose: _Floats) -> int:
        """Add an object. Returns its key."""
        key = self.scene.add(body, pose)
        self.labels[key] = label
        return key

    def remove(self, key: int) -> None:
        """Remove an object."""
        self.scene.remove(key)
        del self.labels[key]

    def copy(self) -> Crowd:
        """Return a scene of the same objects."""
        copy = Crowd()
        for key, label in self.labels.items():
            copy.add(label, *self.placed(key))
        return copy

    def placed(self, key: int) -> _Placed:
        """Return the body of an object and its pose."""
        return self.scene.body(key), self.scene.pose(key)

    def against(
        self, other: Crowd | _Placed | None, outside: Any = None
    ) -> tuple[tuple[Any, ...], Callable[[int, int], _Names]]:
        """Return the arguments that select `other` in the scene's functions, and a function from pairs of keys
        to labels. outside: the label of a body that is not in a scene, the first of a pair.
        """
        if isinstance(other, Crowd):
            theirs = other.labels
            return (other.scene,), lambda a, b: (self.labels[a], theirs[b])
        if other is None:
            return (), lambda a, b: (self.labels[a], self.labels[b])
        return other, lambda _, b: (outside, self.labels[b])


def contacts_of(result: Result, a: _Placed, b: _Placed) -> Iterator[tuple[int, _Floats, _Floats, float]]:
    """Yield (index of the pair, point, normal, depth) for each pair of a result with contacts of two bodies at
    their poses: the centre of the intersection of its triangles, normal and depth of its contact manifold.
    """
    points, pair_of_point = result.points
    centroids = np.zeros((len(result.pairs), 3))
    np.add.at(centroids, pair_of_point, points)
    centroids /= np.maximum(np.bincount(pair_of_point, minlength=len(centroids)), 1)[:, None]
    manifolds = _core.contact_manifolds(a[0], b[0], b[1], a[1])
    deepest = manifolds.depths[np.searchsorted(manifolds.manifold, range(len(manifolds)))]
    manifold_of = np.zeros(len(centroids), dtype=int)
    for m, pairs in enumerate(manifolds.pairs):
        manifold_of[pairs] = m
    for i, m in enumerate(manifold_of):
        yield i, centroids[i], manifolds.normals[m], max(float(deepest[m]), 0.0)


class _OfPair(Shown):
    def __init__(self, names: _Names, faces: Sequence[int], **values: Any) -> None:
        self.names: set[Any] = set(names)
        self._faces: dict[Any, int] = dict(zip(names, faces))
        vars(self).update(values)

    def index(self, name: Hashable) -> int:
        """Return the intersecting, or closest, face of the object of this name."""
        return self._faces[name]


class ContactData(_OfPair):
    """A contact: a triangle of one object that intersects a triangle of another.

    names: set of the two objects' names; point, (3,) float: the centre of the triangles' intersection; normal,
    (3,) float, and depth: of their contact manifold. The normal is a unit vector from the first object to the
    second, or zero if undefined. World frame.
    """

    point: _Floats
    normal: _Floats
    depth: float


class DistanceData(_OfPair):
    """The closest points of two objects. names: set of their names; distance: float, the world's unit."""

    distance: float
    _points: dict[Any, _Floats]

    def point(self, name: Hashable) -> _Floats:
        """Return the closest point on the object of this name, (3,) float, world frame."""
        return self._points[name]


_MOST = 64
_bodies: OrderedDict[Any, Body] = OrderedDict()  # of recently used meshes, by their contents
_lock = threading.Lock()


def body_of(mesh: _Mesh) -> Body:
    """Return the body of an object with `vertices` and `faces` (or `triangles`, as Open3D has them), without
    regions. A mesh that was used recently is not converted again.
    """
    if isinstance(mesh, _core.Body):
        return mesh
    found = [getattr(mesh, name, None) for name in ("vertices", "faces", "triangles")]
    vertices, faces = found[0], found[2] if found[1] is None else found[1]
    if vertices is None or faces is None:
        kind = type(mesh).__name__
        raise TypeError(f"mesh: expected something with vertices and faces, got {kind}")
    vertices, faces = np.ascontiguousarray(vertices), np.ascontiguousarray(faces)
    key = tuple(
        (a.dtype.str, a.shape, hashlib.blake2b(a.view(np.uint8).reshape(-1) if a.size else b"").digest())
        for a in (vertices, faces)
    )
    with _lock:
        body = _bodies.pop(key, None)
    if body is None:
        body = _core.Body(vertices, faces, regions=False, name="mesh")
    with _lock:
        _bodies[key] = body
        if len(_bodies) > _MOST:
            _bodies.popitem(last=False)
    return body


def _pose_of(transform: _Pose) -> _Floats:
    pose = np.eye(4) if transform is None else np.array(transform, dtype=float)
    if pose.shape != (4, 4):
        raise _core.InputError(f"transform: expected shape (4, 4), got {pose.shape}")
    return pose


def _answer(first: Any, *rest: tuple[bool, Any]) -> Any:
    """Return the requested values: `first` alone, or followed by the values of `rest`, a list of
    (wanted, value), that are wanted.
    """
    more = tuple(value for wanted, value in rest if wanted)
    return (first, *more) if more else first


def _sorted_names(names: _Names) -> _Names:
    try:
        a, b = sorted(names)
    except TypeError:  # names of different types
        a, b = sorted(names, key=str)
    return a, b


class CollisionManager:
    """Collisions and distances of named objects. Accepts any object with `vertices` and
    `faces`, or a Body. The objects are bodies of a Scene.
    """

    # What queries return depends on two flags: a bool or float alone, or a tuple.

    def __init__(self) -> None:
        self._crowd = Crowd()
        self._keys: dict[Any, int] = {}  # by name

    def __repr__(self) -> str:
        return f"<lrbscope.CollisionManager of {len(self._keys)} objects>"

    def add_object(self, name: Hashable, mesh: _Mesh, transform: _Pose = None) -> Body:
        """Add an object, or replace the one of this name. transform: (4, 4) float. Returns its Body."""
        body = body_of(mesh)
        key = self._crowd.add(name, body, _pose_of(transform))
        if name in self._keys:
            self.remove_object(name)
        self._keys[name] = key
        return body

    def remove_object(self, name: Hashable) -> None:
        """Remove an object. Raises ValueError if the name is unknown."""
        self._crowd.remove(self._known(name))
        del self._keys[name]

    def set_transform(self, name: Hashable, transform: npt.ArrayLike) -> None:
        """Move an object. transform: (4, 4) float. Raises ValueError if the name is unknown."""
        self._crowd.scene.move(self._known(name), _pose_of(transform))

    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return True if a mesh collides with any object.

        With return_names also a set of names; with return_data also a list of ContactData, in which the mesh is
        called '__external' and is the first object.
        """
        outside = body_of(mesh), _pose_of(transform)
        hit, names, data = self._collide(return_names, return_data, outside)
        return _answer(hit, (return_names, {b for _, b in names}), (return_data, data))

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return True if any two objects collide.

        With return_names also a set of pairs of names, each in alphabetical order; with return_data also a
        list of ContactData.
        """
        hit, names, data = self._collide(return_names, return_data)
        return _answer(hit, (return_names, {_sorted_names(n) for n in names}), (return_data, data))

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return True if any object collides with one of another manager.

        With return_names also a set of pairs of names, this manager's first; with return_data also a list of
        ContactData.
        """
        hit, names, data = self._collide(return_names, return_data, self._other(other_manager))
        return _answer(hit, (return_names, set(names)), (return_data, data))

    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """Return the distance from a mesh to the closest object, or inf if there is no object.

        With return_name also its name; with return_data also a DistanceData, in which the mesh is called
        '__external'.
        """
        distance, names, data = self._nearest((body_of(mesh), _pose_of(transform)))
        return _answer(distance, (return_name, names[1]), (return_data, data))

    def min_distance_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return the minimum distance between two objects, or inf if there are fewer than two.

        With return_names also their names in alphabetical order; with return_data also a DistanceData.
        """
        distance, names, data = self._nearest()
        names = names if data is None else _sorted_names(names)
        return _answer(distance, (return_names, names), (return_data, data))

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return the minimum distance to the objects of another manager, or inf if either has no objects.

        With return_names also the names, this manager's first; with return_data also a DistanceData.
        """
        distance, names, data = self._nearest(self._other(other_manager))
        return _answer(distance, (return_names, names), (return_data, data))

    def _known(self, name: Hashable) -> int:
        if name not in self._keys:
            raise ValueError(f"{name} not in collision manager!")
        return self._keys[name]

    def _other(self, manager: CollisionManager) -> Crowd:
        crowd = manager._crowd
        return crowd.copy() if crowd is self._crowd else crowd  # with itself: each object intersects itself

    def _collide(
        self, want_names: bool, want_data: bool, other: Crowd | _Placed | None = None
    ) -> tuple[bool, list[_Names], _Contacts]:
        """Return whether any pair collides, the names of colliding objects, and their contacts."""
        others, names_of = self._crowd.against(other, "__external")
        scene = self._crowd.scene
        if not (want_names or want_data):
            return scene.any_meet(*others), [], []
        met = scene.collide(*others, mode="all" if want_data else "any", contacts=want_data)
        keys = met.keys.tolist()
        names, data = [names_of(a, b) for a, b in keys], []
        theirs = other if isinstance(other, Crowd) else self._crowd
        if not want_data:
            return bool(names), names, data
        for pair, (a, b), result in zip(names, keys, met):
            first = other if isinstance(other, tuple) else self._crowd.placed(a)
            faces = result.face_pairs.tolist()
            for i, point, normal, depth in contacts_of(result, first, theirs.placed(b)):
                data.append(ContactData(pair, faces[i], point=point, normal=normal, depth=depth))
        return bool(names), names, data

    def _nearest(self, other: Crowd | _Placed | None = None) -> tuple[float, _Names, _Nearest]:
        """Return distance, names and data of the closest pair."""
        others, names_of = self._crowd.against(other, "__external")
        found = self._crowd.scene.nearest(*others, solids=True)
        if found is None:
            return math.inf, (None, None), None
        a, b, nearest = found
        names, distance = names_of(a, b), nearest.solids[1]
        return distance, names, DistanceData(names, nearest.faces, distance=distance, _points=dict(zip(names, nearest.points)))


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[Any, Body]]:
    """Make a CollisionManager of all nodes of a trimesh.Scene that have a geometry.

    Returns the manager, in which objects have their nodes' names, and a dict of the nodes' bodies.
    """
    manager, objects = CollisionManager(), {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects
