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
from ._objects import BodyCache, by_gap, meeting

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


class _Object:
    """A body at a pose, and its box."""

    def __init__(self, body, transform):
        self.body = body
        self.move(transform)

    def move(self, transform):
        self.pose = np.eye(4) if transform is None else np.array(transform, dtype=float)
        if self.pose.shape != (4, 4):
            raise _core.InputError(f"transform: expected shape (4, 4), got {self.pose.shape}")
        self.box = self.body.box(self.pose)


def _face_normal(thing, face):
    corners = thing.body.vertices[thing.body.faces[face][:3]] @ thing.pose[:3, :3].T
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else normal


def contacts_of(result, a, b):
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


def _contact_data(names, result, a, b):
    faces = result.face_pairs
    return [
        ContactData(names, (int(faces[i, 0]), int(faces[i, 1])), point, normal, depth)
        for i, point, normal, depth in contacts_of(result, a, b)
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
    or a Body.
    """

    _CHUNK = 1024  # pairs that are asked for at once where one is enough

    def __init__(self):
        self._objects = {}
        self._cache = BodyCache()
        self._sweep = _core.SweepAndPrune()

    def add_object(self, name, mesh, transform=None):
        """Add an object, or replace the one of this name. transform: (4, 4) float. Returns its Body."""
        self._objects[name] = _Object(self._cache.body(mesh), transform)
        return self._objects[name].body

    def remove_object(self, name):
        """Take an object out. Raises ValueError if there is none of this name."""
        del self._objects[self._known(name)]

    def set_transform(self, name, transform):
        """Move an object. transform: (4, 4) float. Raises ValueError if there is none of this name."""
        self._objects[self._known(name)].move(transform)

    def in_collision_single(self, mesh, transform=None, return_names=False, return_data=False):
        """Ask whether a mesh collides with any object.

        Returns bool; with return_names also a set of names; with return_data also a list of ContactData, in
        which the mesh is called '__external'.
        """
        other = _Object(self._cache.body(mesh), transform)
        mine = [(name, thing) for name, thing in self._objects.items()]
        pairs = [(mine[i], (_EXTERNAL, other)) for i in meeting(other.box, self._boxes())]
        hit, names, data = self._collide(pairs, return_names, return_data)
        return _answer(hit, (return_names, {a for a, _ in names}), (return_data, data))

    def in_collision_internal(self, return_names=False, return_data=False):
        """Ask whether any two objects collide.

        Returns bool; with return_names also a set of pairs of names, each in alphabetical order; with
        return_data also a list of ContactData.
        """
        mine = list(self._objects.items())
        pairs = [(mine[i], mine[j]) for i, j in self._sweep.update(self._boxes())]
        hit, names, data = self._collide(pairs, return_names, return_data)
        return _answer(hit, (return_names, {_sorted_names(n) for n in names}), (return_data, data))

    def in_collision_other(self, other_manager, return_names=False, return_data=False):
        """Ask whether any object collides with one of another manager.

        Returns bool; with return_names also a set of pairs of names, this manager's first; with return_data
        also a list of ContactData.
        """
        mine, theirs = list(self._objects.items()), list(other_manager._objects.items())
        boxes = other_manager._boxes()
        pairs = [(one, theirs[j]) for one in mine for j in meeting(one[1].box, boxes)]
        hit, names, data = self._collide(pairs, return_names, return_data)
        return _answer(hit, (return_names, set(names)), (return_data, data))

    def min_distance_single(self, mesh, transform=None, return_name=False, return_data=False):
        """Find how far a mesh is from the nearest object.

        Returns float, inf if there is none; with return_name also its name; with return_data also a
        DistanceData, in which the mesh is called '__external'.
        """
        other = _Object(self._cache.body(mesh), transform)
        mine = list(self._objects.items())
        rows = by_gap(other.box[None], self._boxes())
        distance, names, data = self._nearest(rows, [(_EXTERNAL, other)], mine)
        return _answer(distance, (return_name, names[1]), (return_data, data))

    def min_distance_internal(self, return_names=False, return_data=False):
        """Find how far the two nearest objects are apart.

        Returns float, inf if there are not two; with return_names also their names in alphabetical order;
        with return_data also a DistanceData.
        """
        mine = list(self._objects.items())
        distance, names, data = self._nearest(by_gap(self._boxes()), mine, mine)
        names = names if data is None else _sorted_names(names)
        return _answer(distance, (return_names, names), (return_data, data))

    def min_distance_other(self, other_manager, return_names=False, return_data=False):
        """Find how far the objects are from the nearest of another manager.

        Returns float, inf if one has no objects; with return_names also the names, this manager's first; with
        return_data also a DistanceData.
        """
        rows = by_gap(self._boxes(), other_manager._boxes())
        found = self._nearest(rows, list(self._objects.items()), list(other_manager._objects.items()))
        return _answer(found[0], (return_names, found[1]), (return_data, found[2]))

    def _known(self, name):
        if name not in self._objects:
            raise ValueError(f"{name} not in collision manager!")
        return name

    def _boxes(self):
        boxes = [thing.box for thing in self._objects.values()]
        return np.array(boxes) if boxes else np.empty((0, 2, 3))

    def _collide(self, pairs, want_names, want_data):
        """Ask for pairs of (name, object). Returns whether any collides, names of those that do, and
        their contacts.
        """
        names, data = [], []
        for begin in range(0, len(pairs), self._CHUNK):
            chunk = pairs[begin : begin + self._CHUNK]
            results = _core.collide_pairs(
                [a.body for (_, a), _ in chunk],
                np.array([a.pose for (_, a), _ in chunk]),
                [b.body for _, (_, b) in chunk],
                np.array([b.pose for _, (_, b) in chunk]),
                mode="all" if want_data else "any",
                contacts=want_data,
            )
            for ((name_a, a), (name_b, b)), result in zip(chunk, results):
                if not result:
                    continue
                names.append((name_a, name_b))
                if want_data:
                    data += _contact_data(names[-1], result, a, b)
            if names and not (want_names or want_data):
                break
        return bool(names), names, data

    @staticmethod
    def _nearest(rows, mine, theirs):
        """Return distance, names and data of the nearest of pairs (gap, i, j)."""
        best, names, data = math.inf, (None, None), None
        for gap, i, j in rows:
            if gap >= best:
                continue
            (name_a, a), (name_b, b) = mine[i], theirs[j]
            found = _core.distance(a.body, b.body, b.pose, a.pose)
            distance = found.solids[1]
            if distance < best:
                best, names = distance, (name_a, name_b)
                data = DistanceData(names, found.faces, found.points, distance)
            if best == 0:
                break
        return best, names, data
