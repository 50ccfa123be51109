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
    from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
    from typing import Optional, Protocol, Union

    import numpy.typing as npt

    from ._core import Body, Result, _Floats

    class _Mesh(Protocol):
        @property
        def vertices(self) -> Any: ...
        @property
        def faces(self) -> Any: ...

    _Pose = Optional[npt.ArrayLike]
    _Placed = tuple[Body, _Floats]
    _Names = tuple[Any, Any]
    _Other = Union["Crowd", _Placed, None]


class Shown:
    """Displays an object in one line, with its public attributes."""

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={_short(value)}" for name, value in vars(self).items() if name[0] != "_")
        return f"<{type(self).__module__}.{type(self).__name__}{' ' * bool(shown)}{shown}>"


def _short(value: Any) -> str:
    """Return a value in a few characters: lists and large arrays are counted."""
    if isinstance(value, np.ndarray):
        return str(value.tolist()) if value.size <= 4 else f"{value.shape} array"
    return f"[{len(value)} items]" if isinstance(value, list) and len(value) > 2 else repr(value)


class Crowd:
    """Labelled objects in a Scene: the core of both collision managers. Queries ask for all pairs of its objects;
    or for pairs with those of another Crowd; or with a body at a pose, which is the first of a pair and called
    `outside`.
    """

    def __init__(self, objects: Iterable[tuple[Any, Body, _Floats]] = ()) -> None:
        self.scene = _core.Scene()
        self.labels: dict[int, Any] = {}  # by key
        for each in objects:
            self.add(*each)

    def add(self, label: Any, body: Body, pose: _Floats) -> int:
        """Add an object. Returns its key."""
        key = self.scene.add(body, pose)
        self.labels[key] = label
        return key

    def remove(self, key: int) -> None:
        """Remove an object."""
        self.scene.remove(key)
        del self.labels[key]

    def placed(self, key: int) -> _Placed:
        """Return the body of an object and its pose."""
        return self.scene.body(key), self.scene.pose(key)

    def objects(self) -> list[tuple[Any, Body, _Floats]]:
        """Return label, body and pose of each object."""
        return [(label, *self.placed(key)) for key, label in self.labels.items()]

    def against(self, other: _Other, outside: Any) -> tuple[tuple[Any, ...], Callable[[int, int], _Names]]:
        """Return the arguments that select `other` in the scene's functions, and a function from pairs of keys to
        labels.
        """
        if isinstance(other, Crowd):
            theirs = other.labels
            return (other.scene,), lambda a, b: (self.labels[a], theirs[b])
        return other or (), lambda a, b: (self.labels.get(a, outside), self.labels[b])

    def collide(self, other: _Other, outside: Any, data: bool) -> tuple[list[_Names], list[ContactData]]:
        """Return the labels of colliding objects and, if requested, their contacts."""
        others, labels_of = self.against(other, outside)
        theirs = other if isinstance(other, Crowd) else self
        met = self.scene.collide(*others, mode="all" if data else "any", contacts=data)
        keys, contacts = met.keys.tolist(), []
        for (a, b), result in zip(keys, list(met) if data else []):
            first = other if isinstance(other, tuple) else self.placed(a)
            faces = result.face_pairs.tolist()
            for i, point, normal, depth in contacts_of(result, first, theirs.placed(b)):
                contacts.append(ContactData(labels_of(a, b), faces[i], point=point, normal=normal, depth=depth))
        return [labels_of(a, b) for a, b in keys], contacts

    def nearest(self, other: _Other, outside: Any) -> tuple[float, _Names, DistanceData | None]:
        """Return distance, labels and data of the closest pair."""
        others, labels_of = self.against(other, outside)
        found = self.scene.nearest(*others, solids=True)
        if found is None:
            return math.inf, (None, None), None
        names, distance = labels_of(*found[:2]), found[2].solids[1]
        points = dict(zip(names, found[2].points))
        return distance, names, DistanceData(names, found[2].faces, distance=distance, _points=points)


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
    vertices, faces, triangles = (getattr(mesh, name, None) for name in ("vertices", "faces", "triangles"))
    faces = triangles if faces is None else faces
    if vertices is None or faces is None:
        raise TypeError(f"mesh: expected something with vertices and faces, got {type(mesh).__name__}")
    key = None  # of lists and masked arrays, which Body reads
    arrays = [a if isinstance(a, (list, tuple)) else np.asanyarray(a) for a in (vertices, faces)]
    if all(isinstance(a, np.ndarray) and a.dtype.kind in "fiu" and not np.ma.isMA(a) for a in arrays):
        key = tuple((a.dtype.str, a.shape, hashlib.blake2b(a.tobytes()).digest()) for a in arrays)
    with _lock:
        body = _bodies.pop(key, None)
    if body is None:
        body = _core.Body(vertices, faces, regions=False, name="mesh")
    with _lock:
        if key is not None:
            _bodies[key] = body
        if len(_bodies) > _MOST:
            _bodies.popitem(last=False)
    return body


def _pose_of(transform: _Pose) -> _Floats:
    return np.eye(4) if transform is None else _core._numbers(transform, "transform", (4, 4))


def _answer(first: Any, *rest: tuple[bool, Any]) -> Any:
    """Return `first`, followed by the values of `rest`, a list of (wanted, value), that are wanted, if any."""
    more = tuple(value for wanted, value in rest if wanted)
    return (first, *more) if more else first


def _sorted_names(*names: Any) -> Any:
    return tuple(sorted(names, key=lambda name: (type(name).__name__, name)))


class CollisionManager:
    """Collisions and distances of named objects. Accepts any object with `vertices` and `faces`, or a Body. The
    objects are bodies of a Scene.

    in_collision_...: return a bool; with return_names also the set of colliding objects, or of pairs of them; with
    return_data also a list of ContactData. min_distance_...: return a float, inf without objects; with return_names
    also the closest object or pair; with return_data also a DistanceData. transform: (4, 4) float. Methods raise
    ValueError for a name that is unknown. Without flags, queries return a bool or float alone, else a tuple.
    """

    def __init__(self) -> None:
        self._crowd = Crowd()
        self._keys: dict[Any, int] = {}  # by name

    def __repr__(self) -> str:
        return f"<lrbscope.CollisionManager of {len(self._keys)} objects>"

    def add_object(self, name: Hashable, mesh: _Mesh, transform: _Pose = None) -> Body:
        """Add an object, or replace the one of this name. Returns its Body."""
        body = body_of(mesh)
        key = self._crowd.add(name, body, _pose_of(transform))
        if name in self._keys:
            self.remove_object(name)
        self._keys[name] = key
        return body

    def remove_object(self, name: Hashable) -> None:
        """Remove an object."""
        self._crowd.remove(self._known(name))
        del self._keys[name]

    def set_transform(self, name: Hashable, transform: npt.ArrayLike) -> None:
        """Move an object."""
        self._crowd.scene.move(self._known(name), _pose_of(transform))

    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return whether a mesh collides with any object. In ContactData it is called '__external' and comes first."""
        outside = body_of(mesh), _pose_of(transform)
        return self._collide(outside, return_names, return_data, lambda _, b: b)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return whether any two objects collide. Pairs of names are in alphabetical order."""
        return self._collide(None, return_names, return_data, _sorted_names)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return whether any object collides with one of another manager. This manager's names come first."""
        return self._collide(self._other(other_manager), return_names, return_data, lambda a, b: (a, b))

    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """Return the distance from a mesh to the closest object. In DistanceData the mesh is called '__external'."""
        distance, names, data = self._crowd.nearest((body_of(mesh), _pose_of(transform)), "__external")
        return _answer(distance, (return_name, names[1]), (return_data, data))

    def min_distance_internal(self, name: Hashable = None, return_names: bool = False, return_data: bool = False) -> Any:
        """Return the minimum distance between two objects; `name`: between this one and the others. Names are in
        alphabetical order.
        """
        crowd, one = self._crowd, None
        if name is not None:
            one = crowd.placed(self._known(name))
            crowd = Crowd(each for each in crowd.objects() if each[0] != name)
        distance, names, data = crowd.nearest(one, name)
        return _answer(distance, (return_names, _sorted_names(*names)), (return_data, data))

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return the minimum distance to the objects of another manager. This manager's name comes first."""
        distance, names, data = self._crowd.nearest(self._other(other_manager), None)
        return _answer(distance, (return_names, names), (return_data, data))

    def _known(self, name: Hashable) -> int:
        if name not in self._keys:
            raise ValueError(f"{name} not in collision manager!")
        return self._keys[name]

    def _other(self, manager: CollisionManager) -> Crowd:
        crowd = manager._crowd  # with itself: each object intersects itself
        return Crowd(crowd.objects()) if crowd is self._crowd else crowd

    def _collide(self, other: _Other, names: bool, data: bool, named: Callable[[Any, Any], Any]) -> Any:
        if not (names or data):
            return self._crowd.scene.any_meet(*self._crowd.against(other, None)[0])
        met, contacts = self._crowd.collide(other, "__external", data)
        return _answer(bool(met), (names, {named(*pair) for pair in met}), (data, contacts))


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[Any, Body]]:
    """Make a CollisionManager of all nodes of a trimesh.Scene that have a geometry.

    Returns the manager, in which objects have their nodes' names, and a dict of the nodes' bodies.
    """
    manager, objects = CollisionManager(), {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects
