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
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator, Sequence
    from typing import Literal, Optional, Protocol

    import numpy.typing as npt

    from ._core import Body, Result, Scene

    class _Mesh(Protocol):
        @property
        def vertices(self) -> Any: ...
        @property
        def faces(self) -> Any: ...

    _Floats = npt.NDArray[np.float64]
    _Pose = Optional[npt.ArrayLike]
    _Names = tuple[Any, Any]
    _Contacts = list["ContactData"]
    _Nearest = Optional["DistanceData"]
    _No = Literal[False]
    _Yes = Literal[True]

_EXTERNAL = "__external"


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
    if isinstance(value, np.ndarray):
        if value.size > 4:
            return f"({', '.join(map(str, value.shape))}) array"
        return "[" + ", ".join(f"{x:.4g}" for x in value.ravel()) + "]"
    if isinstance(value, list) and len(value) > 2:
        return f"[{len(value)} items]"
    if isinstance(value, list):
        return "[" + ", ".join(map(_short, value)) + "]"
    text = repr(value)
    return text if len(text) <= 80 else f"<{type(value).__name__}>"


class ContactData(Shown):
    """A contact: a triangle of one object that intersects a triangle of another.

    names: set of the two objects' names. Points and vectors are in the world frame.
    """

    def __init__(
        self, names: _Names, faces: Sequence[int], point: _Floats, normal: _Floats, depth: float
    ) -> None:
        self.names: set[Any] = set(names)
        self._faces: dict[Any, int] = dict(zip(names, faces))
        self._point, self._normal, self._depth = point, normal, depth

    @property
    def normal(self) -> _Floats:
        """(3,) float: unit, from the first object to the second, averaged over the contact region, or the
        normal of the first's face if undefined.
        """
        return self._normal

    @property
    def point(self) -> _Floats:
        """(3,) float: the centre of the intersection of the two triangles."""
        return self._point

    @property
    def depth(self) -> float:
        """float: an estimate of the penetration depth in the contact region, along the normal."""
        return self._depth

    def index(self, name: Hashable) -> int:
        """Return the intersecting face of the object of this name."""
        return self._faces[name]


class DistanceData(Shown):
    """The closest points of two objects. names: set of their names."""

    def __init__(self, names: _Names, faces: Sequence[int], points: _Floats, distance: float) -> None:
        self.names: set[Any] = set(names)
        self._faces: dict[Any, int] = dict(zip(names, faces))
        self._points: dict[Any, _Floats] = dict(zip(names, points))
        self._distance = distance

    @property
    def distance(self) -> float:
        """float: the distance between the two objects, the world's unit."""
        return self._distance

    def index(self, name: Hashable) -> int:
        """Return the closest face of the object of this name."""
        return self._faces[name]

    def point(self, name: Hashable) -> _Floats:
        """Return the closest point on the object of this name, (3,) float, world frame."""
        return self._points[name]


class _BodyCache:
    """Cache of the bodies of recently used meshes, so that a mesh is converted only once."""

    _MOST = 64

    def __init__(self) -> None:
        self._bodies: OrderedDict[Any, Body] = OrderedDict()

    def body(self, mesh: _Mesh) -> Body:
        """Return the body of an object with `vertices` and `faces`, without regions, which this module does not
        use.
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


def _pose_of(transform: _Pose) -> _Floats:
    pose = np.eye(4) if transform is None else np.array(transform, dtype=float)
    if pose.shape != (4, 4):
        raise _core.InputError(f"transform: expected shape (4, 4), got {pose.shape}")
    return pose


def _face_normal(body: Body, pose: _Floats, face: int) -> _Floats:
    corners = body.vertices[body.faces[face][:3]] @ pose[:3, : body.dim].T
    along = [0, 0, 1] if body.dim == 2 else corners[2] - corners[0]
    normal: _Floats = np.cross(corners[1] - corners[0], along)
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else normal


def contacts_of(result: Result, body: Body, pose: _Floats) -> Iterator[tuple[int, _Floats, _Floats, float]]:
    """Yield (index of the pair, point, normal, depth) for each pair of a result with contacts. body, pose: A."""
    points, pair_of_point = result.points
    centroids = np.zeros((len(result.pairs), 3))
    np.add.at(centroids, pair_of_point, points)
    centroids /= np.maximum(np.bincount(pair_of_point, minlength=len(centroids)), 1)[:, None]
    faces = result.face_pairs
    for region in result.regions:
        normal, depth = region.normal, region.depth_estimate
        for i in region.pairs:
            yield int(i), centroids[i], normal if normal.any() else _face_normal(body, pose, faces[i, 0]), depth


def _contact_data(names: _Names, result: Result, body: Body, pose: _Floats) -> _Contacts:
    faces = result.face_pairs
    return [
        ContactData(names, (int(faces[i, 0]), int(faces[i, 1])), point, normal, depth)
        for i, point, normal, depth in contacts_of(result, body, pose)
    ]


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

    # The type of the return value depends on two flags; if these are not literals, it is Any.

    def __init__(self) -> None:
        self._cache = _BodyCache()
        self._scene = _core.Scene()
        self._keys: dict[Any, int] = {}  # by name
        self._names: dict[int, Any] = {}  # by key

    def __repr__(self) -> str:
        return f"<lrbscope.CollisionManager of {len(self._keys)} objects>"

    def add_object(self, name: Hashable, mesh: _Mesh, transform: _Pose = None) -> Body:
        """Add an object, or replace the one of this name. transform: (4, 4) float. Returns its Body."""
        body = self._cache.body(mesh)
        key = self._scene.add(body, _pose_of(transform))
        if name in self._keys:
            self.remove_object(name)
        self._keys[name], self._names[key] = key, name
        return body

    def remove_object(self, name: Hashable) -> None:
        """Remove an object. Raises ValueError if the name is unknown."""
        key = self._known(name)
        self._scene.remove(key)
        del self._keys[name], self._names[key]

    def set_transform(self, name: Hashable, transform: npt.ArrayLike) -> None:
        """Move an object. transform: (4, 4) float. Raises ValueError if the name is unknown."""
        self._scene.move(self._known(name), _pose_of(transform))

    @overload
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: _No = False, return_data: _No = False
    ) -> bool: ...
    @overload
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, *, return_names: _Yes, return_data: _No = False
    ) -> tuple[bool, set[Any]]: ...
    @overload
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: _No = False, *, return_data: _Yes
    ) -> tuple[bool, _Contacts]: ...
    @overload
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, *, return_names: _Yes, return_data: _Yes
    ) -> tuple[bool, set[Any], _Contacts]: ...
    @overload
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: bool = False, return_data: bool = False
    ) -> Any: ...
    def in_collision_single(
        self, mesh: _Mesh, transform: _Pose = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return True if a mesh collides with any object.

        With return_names also a set of names; with return_data also a list of ContactData, in which the mesh is
        called '__external' and is the first object.
        """
        outside = self._cache.body(mesh), _pose_of(transform)
        hit, names, data = self._collide(return_names, return_data, outside=outside)
        return _answer(hit, (return_names, {b for _, b in names}), (return_data, data))

    @overload
    def in_collision_internal(self, return_names: _No = False, return_data: _No = False) -> bool: ...
    @overload
    def in_collision_internal(
        self, return_names: _Yes, return_data: _No = False
    ) -> tuple[bool, set[_Names]]: ...
    @overload
    def in_collision_internal(
        self, return_names: _No = False, *, return_data: _Yes
    ) -> tuple[bool, _Contacts]: ...
    @overload
    def in_collision_internal(
        self, return_names: _Yes, return_data: _Yes
    ) -> tuple[bool, set[_Names], _Contacts]: ...
    @overload
    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any: ...
    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return True if any two objects collide.

        With return_names also a set of pairs of names, each in alphabetical order; with return_data also a
        list of ContactData.
        """
        hit, names, data = self._collide(return_names, return_data)
        return _answer(hit, (return_names, {_sorted_names(n) for n in names}), (return_data, data))

    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: _No = False, return_data: _No = False
    ) -> bool: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: _Yes, return_data: _No = False
    ) -> tuple[bool, set[_Names]]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: _No = False, *, return_data: _Yes
    ) -> tuple[bool, _Contacts]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: _Yes, return_data: _Yes
    ) -> tuple[bool, set[_Names], _Contacts]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any: ...
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return True if any object collides with one of another manager.

        With return_names also a set of pairs of names, this manager's first; with return_data also a list of
        ContactData.
        """
        hit, names, data = self._collide(return_names, return_data, other=other_manager)
        return _answer(hit, (return_names, set(names)), (return_data, data))

    @overload
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: _No = False, return_data: _No = False
    ) -> float: ...
    @overload
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, *, return_name: _Yes, return_data: _No = False
    ) -> tuple[float, Any]: ...
    @overload
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: _No = False, *, return_data: _Yes
    ) -> tuple[float, _Nearest]: ...
    @overload
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, *, return_name: _Yes, return_data: _Yes
    ) -> tuple[float, Any, _Nearest]: ...
    @overload
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: bool = False, return_data: bool = False
    ) -> Any: ...
    def min_distance_single(
        self, mesh: _Mesh, transform: _Pose = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """Return the distance from a mesh to the closest object, or inf if there is no object.

        With return_name also its name; with return_data also a DistanceData, in which the mesh is called
        '__external'.
        """
        outside = self._cache.body(mesh), _pose_of(transform)
        distance, names, data = self._nearest(outside=outside)
        return _answer(distance, (return_name, names[1]), (return_data, data))

    @overload
    def min_distance_internal(self, return_names: _No = False, return_data: _No = False) -> float: ...
    @overload
    def min_distance_internal(self, return_names: _Yes, return_data: _No = False) -> tuple[float, _Names]: ...
    @overload
    def min_distance_internal(
        self, return_names: _No = False, *, return_data: _Yes
    ) -> tuple[float, _Nearest]: ...
    @overload
    def min_distance_internal(
        self, return_names: _Yes, return_data: _Yes
    ) -> tuple[float, _Names, _Nearest]: ...
    @overload
    def min_distance_internal(self, return_names: bool = False, return_data: bool = False) -> Any: ...
    def min_distance_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Return the minimum distance between two objects, or inf if there are fewer than two.

        With return_names also their names in alphabetical order; with return_data also a DistanceData.
        """
        distance, names, data = self._nearest()
        names = names if data is None else _sorted_names(names)
        return _answer(distance, (return_names, names), (return_data, data))

    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: _No = False, return_data: _No = False
    ) -> float: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: _Yes, return_data: _No = False
    ) -> tuple[float, _Names]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: _No = False, *, return_data: _Yes
    ) -> tuple[float, _Nearest]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: _Yes, return_data: _Yes
    ) -> tuple[float, _Names, _Nearest]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any: ...
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Return the minimum distance to the objects of another manager, or inf if either has no objects.

        With return_names also the names, this manager's first; with return_data also a DistanceData.
        """
        found = self._nearest(other=other_manager)
        return _answer(found[0], (return_names, found[1]), (return_data, found[2]))

    def _known(self, name: Hashable) -> int:
        if name not in self._keys:
            raise ValueError(f"{name} not in collision manager!")
        return self._keys[name]

    def _others(
        self, outside: tuple[Body, _Floats] | None, other: CollisionManager | None
    ) -> tuple[tuple[Scene | Body | None, _Floats | None], Callable[[int, int], _Names]]:
        """Return the arguments that select the others in a scene's functions, and a function from pairs of
        keys to names.
        """
        if outside is not None:
            return outside, lambda a, b: (_EXTERNAL, self._names[b])
        if other is self:  # each object intersects itself
            other = self._copy()
        names = self._names if other is None else other._names
        scene = None if other is None else other._scene
        return (scene, None), lambda a, b: (self._names[a], names[b])

    def _copy(self) -> CollisionManager:
        copy = CollisionManager()
        for name, key in self._keys.items():
            copy.add_object(name, self._scene.body(key), self._scene.pose(key))
        return copy

    def _collide(
        self,
        want_names: bool,
        want_data: bool,
        outside: tuple[Body, _Floats] | None = None,
        other: CollisionManager | None = None,
    ) -> tuple[bool, list[_Names], _Contacts]:
        """Return whether any pair collides, the names of colliding objects, and their contacts."""
        others, names_of = self._others(outside, other)
        if not (want_names or want_data):
            return self._scene.any_meet(*others), [], []
        met = self._scene.collide(*others, mode="all" if want_data else "any", contacts=want_data)
        keys = met.keys.tolist()
        names, data = [names_of(a, b) for a, b in keys], []
        if want_data:
            for pair, (a, _), result in zip(names, keys, met):
                data += _contact_data(pair, result, *outside or (self._scene.body(a), self._scene.pose(a)))
        return bool(names), names, data

    def _nearest(
        self, outside: tuple[Body, _Floats] | None = None, other: CollisionManager | None = None
    ) -> tuple[float, _Names, _Nearest]:
        """Return distance, names and data of the closest pair."""
        others, names_of = self._others(outside, other)
        found = self._scene.nearest(*others, solids=True)
        if found is None:
            return math.inf, (None, None), None
        a, b, nearest = found
        names, distance = names_of(a, b), nearest.solids[1]
        return distance, names, DistanceData(names, nearest.faces, nearest.points, distance)


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[Any, Body]]:
    """Make a CollisionManager of all nodes of a trimesh.Scene that have a geometry.

    Returns the manager, in which objects have their nodes' names, and a dict of the nodes' bodies.
    """
    manager, objects = CollisionManager(), {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects
