"""The interface of python-fcl on top of lrbscope: `from lrbscope import fcl`.

>>> from lrbscope import fcl
>>> box = fcl.Box(1, 2, 3)
>>> near = fcl.CollisionObject(box, fcl.Transform(np.array([0.5, 0.25, 0.125])))
>>> result = fcl.CollisionResult()
>>> fcl.collide(fcl.CollisionObject(box), near, fcl.CollisionRequest(), result), result.is_collision
(1, True)

As in FCL, a mesh is a surface and a shape is a solid: an object inside a shape collides with it. Round shapes are
inscribed polyhedra with `facets` facets around, for which answers are exact: they deviate by at most 0.0012 of the
radius for 64 facets. Halfspace, Plane, OcTree, costs, and motions other than CCDM_TRANS and CCDM_LINEAR raise
Unsupported.
"""

from __future__ import annotations

import itertools
import math
import operator
import sys
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from .collision import Objects, Shown, contacts_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import numpy.typing as npt

    from ._core import Body, Clash, Result, _Floats

    _Surface = tuple[_Floats, Any]  # vertices and faces

facets: int = 64
"""int: the number of facets around the axis, for shapes made afterwards."""


class Unsupported(NotImplementedError):
    """Raised for features of FCL that this module does not support."""


# Numbers of FCL. OT_BVH is a mesh, a surface; OT_GEOM a shape, a solid. Solvers have no effect here.
OBJECT_TYPE = IntEnum("OBJECT_TYPE", "OT_UNKNOWN OT_BVH OT_GEOM OT_OCTREE OT_COUNT", start=0)
NODE_TYPE = IntEnum(
    "NODE_TYPE",
    "BV_UNKNOWN BV_AABB BV_OBB BV_RSS BV_kIOS BV_OBBRSS BV_KDOP16 BV_KDOP18 BV_KDOP24 GEOM_BOX GEOM_SPHERE"
    " GEOM_ELLIPSOID GEOM_CAPSULE GEOM_CONE GEOM_CYLINDER GEOM_CONVEX GEOM_PLANE GEOM_HALFSPACE GEOM_TRIANGLE"
    " GEOM_OCTREE NODE_COUNT",
    start=0,
)
GJKSolverType = IntEnum("GJKSolverType", "GST_LIBCCD GST_INDEP", start=0)
CCDMotionType = IntEnum("CCDMotionType", "CCDM_TRANS CCDM_LINEAR CCDM_SCREW CCDM_SPLINE", start=0)
CCDSolverType = IntEnum(
    "CCDSolverType", "CCDC_NAIVE CCDC_CONSERVATIVE_ADVANCEMENT CCDC_RAY_SHOOTING CCDC_POLYNOMIAL_SOLVER", start=0
)


class Transform:
    """A rotation and a translation: Transform(), (q), (R), (T), (q, T), (R, T) or (Transform); q is w, x, y, z."""

    def __init__(self, *args: npt.ArrayLike | Transform) -> None:
        self._pose = np.eye(4)
        given: list[Any] = list(args)
        if len(given) > 2:
            raise ValueError("Too many arguments to Transform().")
        if len(given) == 1 and isinstance(given[0], Transform):
            self.setTransform(given.pop())
        elif len(given) == 2 or (given and np.size(given[0]) == 3):
            T = given.pop()
            self.setTranslation(T.ravel() if isinstance(T, np.ndarray) and T.ndim == 2 else T)
        if given:
            self.setQuatRotation(given[0]) if np.size(given[0]) == 4 else self.setRotation(given[0])

    def __repr__(self) -> str:
        return f"<{type(self).__module__}.{type(self).__name__} {self._pose[:3].tolist()}>"

    def getTranslation(self) -> _Floats:
        return self._pose[:3, 3].copy()

    def setTranslation(self, T: npt.ArrayLike) -> None:
        self._pose[:3, 3] = _core._numbers(T, "translation", (3,))

    def getRotation(self) -> _Floats:
        return self._pose[:3, :3].copy()

    def setRotation(self, R: npt.ArrayLike) -> None:
        self._pose[:3, :3] = _core._numbers(R, "rotation", (3, 3))

    def getQuatRotation(self) -> _Floats:
        """Return the rotation as w, x, y, z with w >= 0."""
        r = self._pose[:3, :3]
        products = np.empty((4, 4))  # 4 q_i q_j
        products[0, 0] = 1 + np.trace(r)
        products[0, 1:] = products[1:, 0] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
        products[1:, 1:] = r + r.T + (1 - np.trace(r)) * np.eye(3)
        q: _Floats = products[np.argmax(np.diag(products))]  # of the largest component, to avoid cancellation
        return q / float(np.copysign(np.linalg.norm(q), q[0]))

    def setQuatRotation(self, q: npt.ArrayLike) -> None:
        """Set the rotation from w, x, y, z, of any length but 0."""
        q = _core._numbers(q, "quaternion", (4,))
        if not np.linalg.norm(q) > 0:
            raise ValueError("quaternion: expected one other than zero")
        w, *v = q / np.linalg.norm(q)
        self.setRotation((w * w - np.dot(v, v)) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * np.cross(v, np.eye(3)).T)

    def setTransform(self, tf: Transform) -> None:
        self._pose = tf.pose

    @property
    def pose(self) -> _Floats:
        """(4, 4) float: the pose."""
        return self._pose.copy()


class CollisionGeometry(Shown):
    """A shape. Its body is made on first use."""

    _node_type = NODE_TYPE.BV_UNKNOWN
    _made: Body | None = None

    def __init_subclass__(cls, node_type: NODE_TYPE = NODE_TYPE.BV_UNKNOWN) -> None:
        cls._node_type = node_type or cls._node_type

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):  # a dimension, which the body depends on
            self._made = None
            value = _core._numbers(value, name, np.shape(value))
            value.flags.writeable = False
            value = value if value.ndim else float(value)
        object.__setattr__(self, name, value)

    def getNodeType(self) -> NODE_TYPE:
        return self._node_type

    def computeLocalAABB(self) -> None:
        """Do nothing: boxes are computed on demand."""

    @property
    def aabb_center(self) -> _Floats:
        """(3,) float: the centre of the geometry's bounding box."""
        centre: _Floats = self._body().box().mean(axis=0)
        return centre

    def _surface(self) -> _Surface:
        """Return vertices and faces."""
        raise ValueError("this geometry has no surface; use one of its subclasses, such as BVHModel")

    def _body(self) -> Body:
        if self._made is None:
            self._made = _core.Body(*self._surface(), regions=False, name=type(self).__name__)
        return self._made


class BVHModel(CollisionGeometry, node_type=NODE_TYPE.BV_OBBRSS):
    """A triangle mesh: beginModel(), then addSubModel(), addTriangle() or addVertex(), then endModel()."""

    def __init__(self) -> None:
        self._state = 0  # 1: after beginModel(), 2: after endModel()
        self._vertices: list[_Floats] = []
        self._triangles: list[list[int]] = []

    def num_tries_(self) -> int:
        return len(self._triangles)

    def buildState(self) -> int:
        return self._state

    def beginModel(self, num_tris_: int = 0, num_vertices_: int = 0) -> int:
        self._state, self._vertices, self._triangles, self._made = 1, [], [], None
        return 0

    def addVertex(self, x: float, y: float, z: float) -> bool:
        return self.addSubModel([[x, y, z]], np.empty((0, 3)))

    def addTriangle(self, v1: npt.ArrayLike, v2: npt.ArrayLike, v3: npt.ArrayLike) -> bool:
        """Add a triangle of three points, (3,) each."""
        return self.addSubModel([_core._numbers(v, "vertex", (3,)) for v in (v1, v2, v3)], [[0, 1, 2]])

    def addSubModel(self, verts: npt.ArrayLike, triangles: npt.ArrayLike) -> bool:
        """Add a mesh: verts (n, 3) float, triangles (m, 3) int."""
        self._check(1)
        corners = _core._numbers(verts, "verts", (-1, 3))
        self._triangles += (_core._integers(triangles, "triangles", (-1, 3)) + len(self._vertices)).tolist()
        self._vertices += list(corners)
        return True

    def endModel(self) -> int:
        self._check(1)
        self._state = 2
        self._body()  # raises here if the mesh cannot be queried
        return 0

    def _check(self, state: int) -> None:
        if self._state != state:
            raise ValueError("BVH construction does not follow correct sequence")

    def _surface(self) -> _Surface:
        self._check(2)
        return np.array(self._vertices).reshape(-1, 3), self._triangles


class Convex(CollisionGeometry, node_type=NODE_TYPE.GEOM_CONVEX):
    """A convex polyhedron: vertices (n, 3), the number of faces, and for each face its number of corners
    followed by the corners, in one flat list.
    """

    def __init__(self, vertices: npt.ArrayLike, num_faces: int, faces: Iterable[int]) -> None:
        rest = iter(flat := [operator.index(i) for i in faces])
        self._faces = [list(itertools.islice(rest, n)) for n in rest]
        if len(self._faces) != num_faces or sum(map(len, self._faces)) + num_faces != len(flat):
            raise ValueError(f"faces: expected {num_faces} faces, got {len(self._faces)} in {len(flat)} numbers")
        self._vertices = _core._numbers(vertices, "vertices", (-1, 3))

    @property
    def num_faces(self) -> int:
        """int: the number of faces."""
        return len(self._faces)

    def _surface(self) -> _Surface:
        return self._vertices, self._faces


class TriangleP(CollisionGeometry, node_type=NODE_TYPE.GEOM_TRIANGLE):
    """A triangle of three points, (3,) each."""

    def __init__(self, a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike) -> None:
        self.a, self.b, self.c = (_core._numbers(v, "corner", (3,)) for v in (a, b, c))

    def _surface(self) -> _Surface:
        return np.array([self.a, self.b, self.c]), np.array([[0, 1, 2]])


class Box(CollisionGeometry, node_type=NODE_TYPE.GEOM_BOX):
    """A box with these side lengths, centred at the origin."""

    def __init__(self, x: float, y: float, z: float) -> None:
        self.side = np.array([x, y, z], dtype=float)

    def _surface(self) -> _Surface:
        corners = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)]) - 0.5
        return corners * self.side, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def _revolved(profile: list[tuple[float, float]]) -> _Surface:
    """Return the surface of revolution about z through points (radius, z), from the lower pole to the upper."""
    angles = 2 * np.pi * np.arange(facets) / facets
    rings = [np.column_stack([np.cos(angles) * r, np.sin(angles) * r, np.full(facets, z)]) for r, z in profile[1:-1]]
    last = 1 + len(rings) * facets
    rows = np.vstack([np.zeros(facets), np.arange(1, last).reshape(-1, facets), np.full(facets, last)]).astype(int)
    low, high = rows[:-1].T, rows[1:].T
    faces = np.stack([low, np.roll(low, -1, 0), np.roll(high, -1, 0), low, np.roll(high, -1, 0), high], 2).reshape(-1, 3)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2])]  # one triangle for a corner at a pole
    return np.vstack([[0, 0, profile[0][1]], *rings, [0, 0, profile[-1][1]]]), faces


def _arc(radius: float, begin: float, end: float, z: float = 0) -> list[tuple[float, float]]:
    """Return points of an arc about the height z between two angles of latitude."""
    angles = np.linspace(begin, end, facets // 2 + 1 if end - begin > 2 else facets // 4 + 1)
    return [(radius * math.cos(a), z + radius * math.sin(a)) for a in angles]


@dataclass(eq=False, repr=False)
class Sphere(CollisionGeometry, node_type=NODE_TYPE.GEOM_SPHERE):
    """A sphere."""

    radius: float

    def _surface(self) -> _Surface:
        return _revolved(_arc(self.radius, -math.pi / 2, math.pi / 2))


class Ellipsoid(CollisionGeometry, node_type=NODE_TYPE.GEOM_ELLIPSOID):
    """An ellipsoid with these radii along x, y and z."""

    def __init__(self, a: float, b: float, c: float) -> None:
        self.radii = np.array([a, b, c], dtype=float)

    def _surface(self) -> _Surface:
        vertices, faces = Sphere(1)._surface()
        return vertices * self.radii, faces


@dataclass(eq=False, repr=False)
class Cylinder(CollisionGeometry, node_type=NODE_TYPE.GEOM_CYLINDER):
    """A cylinder of height lz along z, centred at the origin."""

    radius: float
    lz: float

    def _surface(self) -> _Surface:
        return _revolved(self._profile(self.radius, self.lz / 2))

    def _profile(self, r: float, half: float) -> list[tuple[float, float]]:
        return [(0, -half), (r, -half), (r, half), (0, half)]


class Capsule(Cylinder, node_type=NODE_TYPE.GEOM_CAPSULE):
    """A cylinder of height lz along z with a hemisphere on either end."""

    def _profile(self, r: float, half: float) -> list[tuple[float, float]]:
        return _arc(r, -math.pi / 2, 0, -half) + _arc(r, 0, math.pi / 2, half)


class Cone(Cylinder, node_type=NODE_TYPE.GEOM_CONE):
    """A cone of height lz along z, base down, with the midpoint of its axis at the origin."""

    def _profile(self, r: float, half: float) -> list[tuple[float, float]]:
        return [(0, -half), (r, -half), (0, half)]


class OcTree(CollisionGeometry):
    """Raises Unsupported."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise Unsupported("lrbscope.fcl has no Halfspace, Plane or OcTree; take a large Box, or a mesh of occupied cells")


Halfspace = OcTree
Plane = OcTree


class CollisionObject(Transform):
    """A geometry at a pose."""

    def __init__(
        self, geom: CollisionGeometry | None = None, tf: Transform | None = None, _no_instance: bool = False
    ) -> None:
        if geom is None:
            raise ValueError("a CollisionObject needs a geometry")
        super().__init__(tf or Transform())
        self._geom = geom
        self._is_shape = not isinstance(geom, BVHModel)

    def getObjectType(self) -> OBJECT_TYPE:
        return OBJECT_TYPE.OT_GEOM if self._is_shape else OBJECT_TYPE.OT_BVH

    def getNodeType(self) -> NODE_TYPE:
        return self._geom.getNodeType()

    def getTransform(self) -> Transform:
        return Transform(self)

    def isOccupied(self) -> bool:
        return True

    def isFree(self) -> bool:
        return False

    isUncertain = isFree

    @property
    def body(self) -> Body:
        """The lrbscope.Body of its geometry."""
        return self._geom._body()


@dataclass(eq=False, repr=False)
class Contact(Shown):
    """A contact of two objects. b1, b2: triangles, -1 for shapes; normal: from o1 to o2; pos: world frame."""
    o1: CollisionGeometry | None = None
    o2: CollisionGeometry | None = None
    b1: int = -1
    b2: int = -1
    pos: _Floats = field(default_factory=lambda: np.zeros(3))
    normal: _Floats = field(default_factory=lambda: np.zeros(3))
    penetration_depth: float = 0.0


class CostSource:
    """Never created: costs are not supported."""


@dataclass(eq=False, repr=False)
class CollisionRequest(Shown):
    """num_max_contacts: maximum number of contacts; enable_contact: with point, normal and depth."""
    num_max_contacts: int = 1
    enable_contact: bool = False
    num_max_cost_sources: int = 1
    enable_cost: bool = False
    use_approximate_cost: bool = True
    gjk_solver_type: int = GJKSolverType.GST_LIBCCD

    def __post_init__(self) -> None:
        if self.enable_cost:
            raise Unsupported("lrbscope.fcl does not support costs; leave enable_cost out")


@dataclass(eq=False, repr=False)
class CollisionResult(Shown):
    """is_collision: bool; contacts: list of Contact."""
    is_collision: bool = False
    contacts: list[Contact] = field(default_factory=list)
    cost_sources: list[CostSource] = field(default_factory=list)


@dataclass(eq=False, repr=False)
class DistanceRequest(Shown):
    """Closest points are always computed."""
    enable_nearest_points: bool = False
    enable_signed_distance: bool = False
    gjk_solver_type: int = GJKSolverType.GST_LIBCCD


class DistanceResult(Shown):
    """min_distance; nearest_points: two (3,) arrays, world frame; b1, b2: triangles, -1 for shapes."""

    def __init__(self, min_distance_: float = sys.float_info.max) -> None:
        self.min_distance, self.b1, self.b2 = min_distance_, -1, -1
        self.nearest_points: list[Any] = [None, None]
        self.o1: CollisionGeometry | None = None
        self.o2: CollisionGeometry | None = None


@dataclass(eq=False, repr=False)
class ContinuousCollisionRequest(Shown):
    """toc_err: maximum error of the time of contact. The rest has no effect here."""
    num_max_iterations: int = 10
    toc_err: float = 0.0001
    ccd_motion_type: int = CCDMotionType.CCDM_TRANS
    gjk_solver_type: int = GJKSolverType.GST_LIBCCD
    ccd_solver_type: int = CCDSolverType.CCDC_NAIVE


@dataclass(eq=False, repr=False)
class ContinuousCollisionResult(Shown):
    """is_collide: bool; time_of_contact: from 0 to 1, 1 if there is no contact."""
    is_collide: bool = False
    time_of_contact: float = 1.0


@dataclass(eq=False, repr=False)
class CollisionData(Shown):
    """Data that managers pass to collision callbacks."""
    request: CollisionRequest = field(default_factory=CollisionRequest)
    result: CollisionResult = field(default_factory=CollisionResult)
    done: bool = False


@dataclass(eq=False, repr=False)
class DistanceData(Shown):
    """Data that managers pass to distance callbacks."""
    request: DistanceRequest = field(default_factory=DistanceRequest)
    result: DistanceResult = field(default_factory=DistanceResult)
    done: bool = False


def _check_objects(*objects: Any) -> None:
    for o in objects:
        if not isinstance(o, CollisionObject):
            raise TypeError(f"expected a CollisionObject, got {type(o).__name__}")


def _holds(o1: CollisionObject, o2: CollisionObject, relation: str) -> bool:
    """Return True if a shape contains the other object. A mesh is a surface and contains nothing."""
    holder = {"a_inside_b": o2, "b_inside_a": o1}.get(relation)
    return holder is not None and holder._is_shape


def _ids(o1: CollisionObject, o2: CollisionObject, b1: int = -1, b2: int = -1) -> tuple[Any, Any, int, int]:
    """Return o1, o2, b1, b2 of a result."""
    return o1._geom, o2._geom, -1 if o1._is_shape else int(b1), -1 if o2._is_shape else int(b2)


def _separated(o1: CollisionObject, o2: CollisionObject) -> tuple[Clash, list[_Floats]]:
    """Return the clash of two shapes, and the points at which they touch once they are separated by its translation,
    with the second one moved back.
    """
    overlap, separate = _core.clash(o1.body, o2.body, o2.pose, o1.pose, volume=False), o2.pose
    separate[:3, 3] += overlap.translation
    one, other = _core.distance(o1.body, o2.body, separate, o1.pose).points
    return overlap, [one, other - overlap.translation]


def _contact_of_shapes(o1: CollisionObject, o2: CollisionObject) -> Contact:
    """Return the contact of two shapes: normal and length of the shortest translation that separates them."""
    overlap, points = _separated(o1, o2)
    depth, normal = overlap.depth[1] if overlap.depth else 0.0, overlap.translation
    if depth > 0:
        normal = normal / depth
    elif normals := _core.contact_manifolds(o1.body, o2.body, o2.pose, o1.pose).normals.tolist():  # they touch
        normal = np.array(normals[0])
    return Contact(*_ids(o1, o2), np.mean(points, axis=0), normal, depth)


def _contacts(o1: CollisionObject, o2: CollisionObject, result: Result, full: bool) -> Iterator[Contact]:
    """Yield a Contact for each pair of triangles of two meshes, or for each triangle of a mesh in a shape."""
    found: Iterable[Any] = zip(range(len(result.pairs)))
    if full and len(result.pairs):
        found = contacts_of(result, (o1.body, o1.pose), (o2.body, o2.pose))
    seen = set()
    for i, *values in found:
        ids = _ids(o1, o2, *result.pairs[i])
        if ids[2:] not in seen:
            seen.add(ids[2:])
            yield Contact(*ids, *values)
    shape, mesh = (o1, o2) if o1._is_shape else (o2, o1)
    if not shape._is_shape or result.relation == "separate":
        return
    # Triangles inside the shape: none intersects its surface, so that one corner decides.
    corners = (mesh.body.vertices @ mesh.getRotation().T + mesh.getTranslation())[mesh.body.triangles]
    low, high = shape.body.box(shape.pose)
    candidates = np.flatnonzero(((corners >= low) & (corners <= high)).all(axis=(1, 2)))
    candidates = np.setdiff1d(candidates, result.pairs[:, 1 if shape is o1 else 0])
    sides = _core.signed_distance(shape.body, corners[candidates, 0], shape.pose).side
    for t in candidates[sides < 0].tolist():
        c = Contact(*_ids(o1, o2, t, t))
        if full:  # of the deepest corner to the surface
            ways = _core.signed_distance(shape.body, corners[t], shape.pose)
            k = int(np.argmin(ways.upper))
            c.pos, c.penetration_depth = corners[t, k], -float(ways.lower[k])
            way = ways.points[k] - c.pos if shape is o1 else c.pos - ways.points[k]
            c.normal = way / np.linalg.norm(way)
        yield c


def collide(
    o1: CollisionObject, o2: CollisionObject, request: CollisionRequest | None = None, result: CollisionResult | None = None
) -> int:
    """Find the contacts of two objects. Returns their number; adds them to `result`."""
    _check_objects(o1, o2)
    request, result = request or CollisionRequest(), result or CollisionResult()
    full, shapes = bool(request.enable_contact), o1._is_shape and o2._is_shape
    mode: Any = "any" if shapes or not (full or request.num_max_contacts > 1) else "all"
    found = _core.collide(o1.body, o2.body, o2.pose, o1.pose, mode=mode, contacts=full and not shapes)
    if shapes:
        contacts = [_contact_of_shapes(o1, o2) if full else Contact(*_ids(o1, o2))] if found else []
    else:
        contacts = list(itertools.islice(_contacts(o1, o2, found, full), request.num_max_contacts))
    result.is_collision = result.is_collision or bool(len(found.pairs)) or bool(contacts)
    result.contacts += contacts
    return len(contacts)


def distance(
    o1: CollisionObject, o2: CollisionObject, request: DistanceRequest | None = None, result: DistanceResult | None = None
) -> float:
    """Return the distance of two objects, in the world's unit.

    0 for intersecting meshes, -1 if a shape and another object overlap. Updates `result` if it is smaller.
    """
    _check_objects(o1, o2)
    request, result = request or DistanceRequest(), result or DistanceResult()
    found = _core.distance(o1.body, o2.body, o2.pose, o1.pose)
    value, points = found.upper, list(found.points)
    if (found.meet and (o1._is_shape or o2._is_shape)) or _holds(o1, o2, found.relation):
        value = -1.0
        if request.enable_signed_distance and o1._is_shape and o2._is_shape:
            overlap, points = _separated(o1, o2)
            value = -overlap.depth[1] if overlap.depth else value
    if value < result.min_distance:
        result.min_distance, result.nearest_points = value, points
        result.o1, result.o2, result.b1, result.b2 = _ids(o1, o2, *found.triangles)
    return value


def defaultCollisionCallback(o1: CollisionObject, o2: CollisionObject, cdata: CollisionData) -> bool:
    """Collide two objects; returns True once there are more contacts than requested."""
    if not cdata.done:
        collide(o1, o2, cdata.request, cdata.result)
        found = cdata.result
        cdata.done = found.is_collision and len(found.contacts) > cdata.request.num_max_contacts
    return cdata.done


def defaultDistanceCallback(o1: CollisionObject, o2: CollisionObject, cdata: DistanceData) -> tuple[bool, float]:
    """Measure two objects; returns whether to stop, and the minimum distance so far."""
    if not cdata.done:
        distance(o1, o2, cdata.request, cdata.result)
    nearest = cdata.result.min_distance
    return cdata.done or nearest <= 0, nearest


class DynamicAABBTreeCollisionManager(Objects):
    """Many objects. Poses are read at each query, so that setup() and update() do nothing; parameters of FCL's
    tree have no effect.
    """

    max_tree_nonbalanced_level = tree_incremental_balance_pass = 10
    tree_topdown_balance_threshold = 2
    tree_topdown_level = tree_init_level = 0
    octree_as_geometry_collide, octree_as_geometry_distance = True, False

    def registerObjects(self, other_objs: Iterable[CollisionObject]) -> None:
        for o in other_objs:
            self.registerObject(o)

    def registerObject(self, obj: CollisionObject) -> None:
        _check_objects(obj)
        self._add(obj, obj.body, obj.pose)

    def unregisterObject(self, obj: CollisionObject) -> None:
        if obj in self._keys:
            self._remove(obj)

    def setup(self, arg: CollisionObject | Sequence[CollisionObject] | None = None) -> None:
        """Do nothing."""

    update = setup

    def getObjects(self) -> list[CollisionObject]:
        return list(self._keys)

    def clear(self) -> None:
        super().__init__()

    def empty(self) -> bool:
        return not self._keys

    def size(self) -> int:
        return len(self._keys)

    def _moved(self) -> DynamicAABBTreeCollisionManager:
        """Give the objects their current poses and bodies."""
        for o in self.getObjects():
            if o.body is not self._scene.body(self._keys[o]):
                self._add(o, o.body, o.pose)
        self._scene.move(list(self._names), np.array([o.pose for o in self._names.values()]))
        return self

    def _arguments(self, args: tuple[Any, ...]) -> tuple[Any, ...]:
        """Return the arguments that select the others in the scene's functions, a function from pairs of keys to
        objects, data and callback.
        """
        if len(args) not in (2, 3) or not callable(args[-1]):
            raise ValueError("expected data and callback, optionally after an object or a manager")
        other, step = args[0] if len(args) == 3 else self, 1
        whose: Any = ()
        if not isinstance(other, DynamicAABBTreeCollisionManager):
            _check_objects(other)
            whose, step = (other.body, other.pose), -1  # the manager's objects come first
        elif other is not self:
            whose = other._moved()
        self._moved()
        others, (first, _), (second, _) = self._selected(whose, other)
        return (others, lambda a, b: (first[a], second[b])[::step], *args[-2:])

    def collide(self, *args: Any) -> None:
        """collide(data, callback), (object, data, callback) or (manager, data, callback).

        Calls callback(o1, o2, data) for objects with overlapping boxes, until it returns True.
        """
        others, objects_of, data, callback = self._arguments(args)
        for a, b in self._scene.near(0, *others)[0].tolist():
            if callback(*objects_of(a, b), data):
                return

    def distance(self, *args: Any) -> None:
        """distance(data, callback), (object, data, callback) or (manager, data, callback).

        Calls callback(o1, o2, data), which returns whether to stop and the minimum distance so far, for
        objects whose boxes are closer than that, closest first.
        """
        others, objects_of, data, callback = self._arguments(args)
        likely = self._scene.nearest_boxes(*others)
        if likely is None:
            return
        done, nearest = callback(*objects_of(*likely[:2]), data)
        keys, gaps = self._scene.near(0.0 if done else max(nearest, 0.0), *others)
        for pair, gap in zip(map(tuple, keys.tolist()), gaps):
            if done or gap > nearest:
                return
            if pair != likely[:2]:
                done, nearest = callback(*objects_of(*pair), data)


def _motion(o: CollisionObject, tf_end: Transform, kind: int) -> _Floats:
    """Return the start and end pose of an object's motion, (2, 4, 4)."""
    end = Transform(tf_end)
    if kind == CCDMotionType.CCDM_TRANS:
        end.setRotation(o.getRotation())
    elif kind != CCDMotionType.CCDM_LINEAR:
        raise Unsupported("lrbscope.fcl does not support CCDM_SCREW and CCDM_SPLINE; use CCDM_TRANS or CCDM_LINEAR")
    return np.array([o.pose, end.pose])


def continuousCollide(
    o1: CollisionObject, tf1_end: Transform, o2: CollisionObject, tf2_end: Transform,
    request: ContinuousCollisionRequest | None = None, result: ContinuousCollisionResult | None = None,
) -> float:  # fmt: skip
    """Find the first contact of two objects that move from their poses to the given Transforms.

    Depending on ccd_motion_type they keep their rotation (CCDM_TRANS) or rotate by the shortest arc
    (CCDM_LINEAR). Returns a time from 0 to 1, 1 if they do not collide: there is no contact before it, and
    contact at most toc_err later. Objects within rounding errors of contact count as colliding.
    """
    _check_objects(o1, o2)
    request, result = request or ContinuousCollisionRequest(), result or ContinuousCollisionResult()
    motions = [_motion(o, end, request.ccd_motion_type) for o, end in ((o1, tf1_end), (o2, tf2_end))]
    tolerance = min(request.toc_err, 1.0)
    found = _core.first_contact(o1.body, o2.body, motions[1], motions[0], tolerance=tolerance)
    inside = _holds(o1, o2, found.at_begin)
    time: float = 0.0 if inside else found.t0
    result.is_collide = result.is_collide or inside or found.outcome != "never"
    result.time_of_contact = min(time, result.time_of_contact)
    return time
