"""Collisions between many named objects, asked for as in trimesh.collision.

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

Objects collide if their surfaces meet, or if one lies in another that is a solid. Contacts are where surfaces
meet; an object inside another has none. Distances are those of the solids, 0 where objects collide.
"""

import math

import numpy as np

from . import _core
from ._objects import BodyCache

_EXTERNAL = "__external"


class ContactData:
    """A contact: a triangle of one object that meets a triangle of another.

    names: set of the two objects' names. Points and vectors are in the world frame.
    """

    def __init__(self, names, faces, point, normal, depth):
        self.names = set(names)
        self._faces = dict(zip(names, faces))
        self._point, self._normal, self._depth = point, normal, depth

    @property
    def normal(self):
        """(3,) float: unit, from the first object to the second, averaged over the contact region; else
        of the first's face.
        """
        return self._normal

    @property
    def point(self):
        """(3,) float: the middle of the intersection of the two triangles."""
        return self._point

    @property
    def depth(self):
        """float: an estimate of how deep the objects are in each other in the contact region, along the
        normal.
        """
        return self._depth

    def index(self, name):
        """Return the face of the object of this name."""
        return self._faces[name]


class DistanceData:
    """The nearest points of two objects. names: set of their names."""

    def __init__(self, names, faces, points, distance):
        self.names = set(names)
        self._faces = dict(zip(names, faces))
        self._points = dict(zip(names, points))
        self._distance = distance

    @property
    def distance(self):
        """float: the distance between the two objects, the world's unit."""
        return self._distance

    def index(self, name):
        """Return the face of the object of this name that is nearest."""
        return self._faces[name]

    def point(self, name):
        """Return the nearest point on the object of this name, (3,) float, world frame."""
        return self._points[name]


class _Standing:
    """A body at a pose."""

    def __init__(self, body, transform):
        self.body = body
        self.pose = np.eye(4) if transform is None else np.array(transform, dtype=float)
        if self.pose.shape != (4, 4):
            raise _core.InputError(f"transform: expected shape (4, 4), got {self.pose.shape}")


def _face_normal(thing, face):
    corners = thing.body.vertices[thing.body.faces[face][:3]] @ thing.pose[:3, :3].T
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else normal


def contacts_of(result, a):
    """Yield (pair's number, point, normal, depth) for each pair of a result with contacts. a: has `body`
    and `pose`.
    """
    points, pair_of_point = result.points
    middles = np.zeros((len(result.pairs), 3))
    np.add.at(middles, pair_of_point, points)
    middles /= np.maximum(np.bincount(pair_of_point, minlength=len(middles)), 1)[:, None]
    faces = result.face_pairs
    for region in result.regions:
        normal, depth = region.normal, region.depth_estimate
        for i in region.pairs:
            yield int(i), middles[i], normal if normal.any() else _face_normal(a, faces[i, 0]), depth


def _contact_data(names, result, a):
    faces = result.face_pairs
    return [
        ContactData(names, (int(faces[i, 0]), int(faces[i, 1])), point, normal, depth)
        for i, point, normal, depth in contacts_of(result, a)
    ]


def _answer(first, *rest):
    """Return what was asked for: `first` alone, or with those of `rest` that are wanted, (wanted, value)
    each.
    """
    more = tuple(value for wanted, value in rest if wanted)
    return (first, *more) if more else first


def _sorted_names(names):
    try:
        return tuple(sorted(names))
    except TypeError:  # names of different kinds
        return tuple(sorted(names, key=str))


class CollisionManager:
    """Objects by name, and which of them collide or are near. Takes whatever has `vertices` and `faces`,
    or a Body. The objects are bodies of a Scene.
    """

    def __init__(self):
        self._cache = BodyCache()
        self._scene = _core.Scene()
        self._keys, self._names = {}, {}  # keys by name, names by key

    def add_object(self, name, mesh, transform=None):
        """Add an object, or replace the one of this name. transform: (4, 4) float. Returns its Body."""
        thing = _Standing(self._cache.body(mesh), transform)
        key = self._scene.add(thing.body, thing.pose)
        if name in self._keys:
            self.remove_object(name)
        self._keys[name], self._names[key] = key, name
        return thing.body

    def remove_object(self, name):
        """Take an object out. Raises ValueError if there is none of this name."""
        key = self._known(name)
        self._scene.remove(key)
        del self._keys[name], self._names[key]

    def set_transform(self, name, transform):
        """Move an object. transform: (4, 4) float. Raises ValueError if there is none of this name."""
        self._scene.move(self._known(name), _Standing(None, transform).pose)

    def in_collision_single(self, mesh, transform=None, return_names=False, return_data=False):
        """Ask whether a mesh collides with any object.

        Returns bool; with return_names also a set of names; with return_data also a list of ContactData, in
        which the mesh is called '__external' and is the first object.
        """
        other = _Standing(self._cache.body(mesh), transform)
        hit, names, data = self._collide(return_names, return_data, outside=other)
        return _answer(hit, (return_names, {b for _, b in names}), (return_data, data))

    def in_collision_internal(self, return_names=False, return_data=False):
        """Ask whether any two objects collide.

        Returns bool; with return_names also a set of pairs of names, each in alphabetical order; with
        return_data also a list of ContactData.
        """
        hit, names, data = self._collide(return_names, return_data)
        return _answer(hit, (return_names, {_sorted_names(n) for n in names}), (return_data, data))

    def in_collision_other(self, other_manager, return_names=False, return_data=False):
        """Ask whether any object collides with one of another manager.

        Returns bool; with return_names also a set of pairs of names, this manager's first; with return_data
        also a list of ContactData.
        """
        hit, names, data = self._collide(return_names, return_data, other=other_manager)
        return _answer(hit, (return_names, set(names)), (return_data, data))

    def min_distance_single(self, mesh, transform=None, return_name=False, return_data=False):
        """Find how far a mesh is from the nearest object.

        Returns float, inf if there is none; with return_name also its name; with return_data also a
        DistanceData, in which the mesh is called '__external'.
        """
        other = _Standing(self._cache.body(mesh), transform)
        distance, names, data = self._nearest(outside=other)
        return _answer(distance, (return_name, names[1]), (return_data, data))

    def min_distance_internal(self, return_names=False, return_data=False):
        """Find how far the two nearest objects are apart.

        Returns float, inf if there are not two; with return_names also their names in alphabetical order;
        with return_data also a DistanceData.
        """
        distance, names, data = self._nearest()
        names = names if data is None else _sorted_names(names)
        return _answer(distance, (return_names, names), (return_data, data))

    def min_distance_other(self, other_manager, return_names=False, return_data=False):
        """Find how far the objects are from the nearest of another manager.

        Returns float, inf if one has no objects; with return_names also the names, this manager's first; with
        return_data also a DistanceData.
        """
        found = self._nearest(other=other_manager)
        return _answer(found[0], (return_names, found[1]), (return_data, found[2]))

    def _known(self, name):
        if name not in self._keys:
            raise ValueError(f"{name} not in collision manager!")
        return self._keys[name]

    def _others(self, outside, other):
        """Return the arguments that name the others to a scene's functions, and what gives names to pairs of
        keys.
        """
        if outside is not None:
            return (outside.body, outside.pose), lambda a, b: (_EXTERNAL, self._names[b])
        if other is self:  # each object meets itself
            other = self._copy()
        names = self._names if other is None else other._names
        scene = None if other is None else other._scene
        return (scene,), lambda a, b: (self._names[a], names[b])

    def _copy(self):
        copy = CollisionManager()
        for name, key in self._keys.items():
            copy.add_object(name, self._scene.body(key), self._scene.pose(key))
        return copy

    def _collide(self, want_names, want_data, outside=None, other=None):
        """Return whether any pair collides, names of those that do, and their contacts."""
        others, names_of = self._others(outside, other)
        if not (want_names or want_data):
            return self._scene.any_meet(*others), [], []
        met = self._scene.collide(*others, mode="all" if want_data else "any", contacts=want_data)
        names, data = [names_of(a, b) for a, b in met.keys.tolist()], []
        if want_data:
            for pair, (a, _), result in zip(names, met.keys.tolist(), met):
                first = outside or _Standing(self._scene.body(a), self._scene.pose(a))
                data += _contact_data(pair, result, first)
        return bool(names), names, data

    def _nearest(self, outside=None, other=None):
        """Return distance, names and data of the nearest pair."""
        others, names_of = self._others(outside, other)
        found = self._scene.nearest(*others, solids=True)
        if found is None:
            return math.inf, (None, None), None
        a, b, nearest = found
        names, distance = names_of(a, b), nearest.solids[1]
        return distance, names, DistanceData(names, nearest.faces, nearest.points, distance)


def scene_to_collision(scene):
    """Make a CollisionManager of all nodes of a trimesh.Scene that have a geometry.

    Returns the manager, in which objects have their nodes' names, and a dict of the nodes' bodies.
    """
    manager, objects = CollisionManager(), {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects
