"""Collisions between many named objects, with the interface of trimesh.collision.

>>> m = CollisionManager()
>>> _ = m.add_object("left", cube)
>>> _ = m.add_object("right", cube, shifted(3, 0, 0))
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
import reprlib
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator, Sequence
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
    _Other = Union["Objects", _Placed, tuple[()]]
    _Side = tuple[dict[int, Any], Callable[[int], Any]]  # names and placed bodies, by keys of a scene


class Shown:
    """Displays an object in one line, with its public attributes."""

    def __repr__(self) -> str:
        shown = "".join(f" {name}={reprlib.repr(value)}" for name, value in vars(self).items() if name[0] != "_")
        return f"<{type(self).__module__}.{type(self).__name__}{shown}>"


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
    def __init__(self, names: Sequence[Any], faces: Sequence[int], **values: Any) -> None:
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


_recent: dict[bytes, Body] = {}  # of the last 4 different meshes, by hashes of their arrays


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
    arrays: list[Any] = [a if isinstance(a, (list, tuple)) else np.asanyarray(a) for a in (vertices, faces)]
    if all(isinstance(a, np.ndarray) and a.dtype.kind in "fiu" and not np.ma.isMA(a) for a in arrays):
        content = hashlib.sha256()
        for a in arrays:
            content.update(f"{a.dtype.str} {a.shape} ".encode())
            content.update(np.ascontiguousarray(a))
        key = content.digest()
        body = _recent.pop(key, None) or _core.Body(*arrays, regions=False, name="mesh")
        _recent[key] = body
        for old in list(_recent)[:-4]:  # a copy, because other threads may change it
            _recent.pop(old, None)
        return body
    return _core.Body(vertices, faces, regions=False, name="mesh")  # lists and masked arrays


def _pose_of(transform: _Pose) -> _Floats:
    return np.eye(4) if transform is None else _core._numbers(transform, "transform", (4, 4))


def _answer(first: Any, *rest: tuple[bool, Any]) -> Any:
    """Return `first`, followed by the values of `rest`, a list of (wanted, value), that are wanted, if any."""
    more = tuple(value for wanted, value in rest if wanted)
    return (first, *more) if more else first


def _sorted_names(*names: Any) -> Any:
    return tuple(sorted(names, key=lambda name: (type(name).__name__, name)))


class Objects:
    """Named objects, which are the bodies of a Scene: what managers have in common."""

    def __init__(self) -> None:
        self._scene = _core.Scene()
        self._keys: dict[Any, int] = {}  # by name
        self._names: dict[int, Any] = {}  # by key

    def __repr__(self) -> str:
        return f"<{type(self).__module__}.{type(self).__name__} of {len(self._keys)} objects>"

    def _add(self, name: Hashable, body: Body, pose: _Floats) -> None:
        key = self._scene.add(body, pose)
        if name in self._keys:
            self._remove(name)
        self._keys[name], self._names[key] = key, name

    def _remove(self, name: Hashable) -> None:
        self._scene.remove(self._known(name))
        del self._names[self._keys.pop(name)]

    def _known(self, name: Hashable) -> int:
        if name not in self._keys:
            raise ValueError(f"{name} not in collision manager!")
        return self._keys[name]

    def _placed(self, key: int) -> _Placed:
        return self._scene.body(key), self._scene.pose(key)

    def _without(self, *names: Hashable) -> Any:
        """Return a manager of all objects but those of these names."""
        others = CollisionManager()
        for key, name in self._names.items():
            if name not in names:
                others._add(name, *self._placed(key))
        return others

    def _manager(self, other: Any) -> Any:
        """Return another manager; of this one a copy, as each object intersects itself."""
        if not isinstance(other, CollisionManager):
            raise TypeError(f"other_manager: expected a CollisionManager, got {type(other).__name__}")
        return self._without() if other is self else other

    def _selected(self, other: _Other, outside: Any = "__external") -> tuple[tuple[Any, ...], _Side, _Side]:
        """Return the arguments that select the others in the scene's functions, and both sides of the pairs that
        these find: of all objects (an empty tuple), with those of another manager, or with a body at a pose, called
        `outside`.
        """
        own = self._names, self._placed
        if isinstance(other, tuple):
            placed: Any = other
            return placed, (({-1: outside}, lambda _: placed) if placed else own), own
        return (other._scene,), own, (other._names, other._placed)


class CollisionManager(Objects):
    """Collisions and distances of named objects. Accepts any object with `vertices` and `faces`, or a Body.

    in_collision_...: return a bool; with return_names also the set of colliding objects, or of pairs of them; with
    return_data also a list of ContactData. min_distance_...: return a float, inf without objects; with return_names
    also the closest object or pair; with return_data also a DistanceData. transform: (4, 4) float. Methods raise
    ValueError for a name that is unknown. Without flags, queries return a bool or float alone, else a tuple.
    """

    def add_object(self, name: Hashable, mesh: _Mesh, transform: _Pose = None) -> Body:
        """Add an object, or replace the one of this name. Returns its Body."""
        body = body_of(mesh)
        self._add(name, body, _pose_of(transform))
        return body

    def remove_object(self, name: Hashable) -> None:
        """Remove an object."""
        self._remove(name)

    def set_transform(self, name: Hashable, transform: npt.ArrayLike) -> None:
        """Move an object."""
        self._scene.move(self._known(name), _pose_of(transform))

    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return whether a mesh collides with any object. In ContactData it is called '__external' and comes first."""
        return self._collide((body_of(mesh), _pose_of(transform)), return_names, return_data, lambda _, b: b)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return whether any two objects collide. Pairs of names are in alphabetical order."""
        return self._collide((), return_names, return_data, _sorted_names)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return whether any object collides with one of another manager. This manager's names come first."""
        return self._collide(self._manager(other_manager), return_names, return_data, lambda a, b: (a, b))

    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """Return the distance from a mesh to the closest object. In DistanceData the mesh is called '__external'."""
        distance, names, data = self._nearest((body_of(mesh), _pose_of(transform)))
        return _answer(distance, (return_name, names[1]), (return_data, data))

    def min_distance_internal(self, name: Hashable = None, return_names: bool = False, return_data: bool = False) -> Any:
        """Return the minimum distance between two objects; `name`: between this one and the others. Names are in
        alphabetical order.
        """
        one: Any = () if name is None else self._placed(self._known(name))
        distance, names, data = self._without(name)._nearest(one, name) if one else self._nearest(one)
        return _answer(distance, (return_names, _sorted_names(*names)), (return_data, data))

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return the minimum distance to the objects of another manager. This manager's name comes first."""
        distance, names, data = self._nearest(self._manager(other_manager))
        return _answer(distance, (return_names, names), (return_data, data))

    def _collide(self, other: _Other, names: bool, data: bool, named: Callable[[Any, Any], Any]) -> Any:
        others, (first, first_placed), (second, second_placed) = self._selected(other)
        if not (names or data):
            return self._scene.any_meet(*others)
        met = self._scene.collide(*others, mode="all" if data else "any", contacts=data)
        found = [(a, b, (first[a], second[b])) for a, b in met.keys.tolist()]
        contacts = []
        for (a, b, pair), result in zip(found if data else [], met):
            faces = result.face_pairs.tolist()
            for i, point, normal, depth in contacts_of(result, first_placed(a), second_placed(b)):
                contacts.append(ContactData(pair, faces[i], point=point, normal=normal, depth=depth))
        return _answer(bool(found), (names, {named(*pair) for _, _, pair in found}), (data, contacts))

    def _nearest(self, other: _Other, outside: Any = "__external") -> tuple[float, tuple[Any, Any], DistanceData | None]:
        """Return distance, names and data of the closest pair."""
        others, (first, _), (second, _) = self._selected(other, outside)
        found = self._scene.nearest(*others, solids=True)
        if found is None:
            return math.inf, (None, None), None
        a, b, distance = found
        names, upper = (first[a], second[b]), distance.solids[1]
        points = dict(zip(names, distance.points))
        return upper, names, DistanceData(names, distance.faces, distance=upper, _points=points)


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[Any, Body]]:
    """Make a CollisionManager of all nodes of a trimesh.Scene that have a geometry.

    Returns the manager, in which objects have their nodes' names, and a dict of the nodes' bodies.
    """
    manager, objects = CollisionManager(), {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects
