"""The interface of python-fcl on top of lrbscope: `from lrbscope import fcl`.

>>> from lrbscope import fcl
>>> box = fcl.Box(1, 2, 3)
>>> near = fcl.CollisionObject(box, fcl.Transform(np.array([0.5, 0.25, 0.125])))
>>> result = fcl.CollisionResult()
>>> fcl.collide(fcl.CollisionObject(box), near, fcl.CollisionRequest(), result), result.is_collision
(1, True)

Meshes (BVHModel) and boxes are exact. Round shapes are inscribed polyhedra with `facets` facets around: they
deviate by at most 0.0012 of the radius for 64 facets. Intersections are decided exactly for these polyhedra.

As in FCL, a mesh is a surface and a shape is a solid: an object inside a shape collides with it. Contacts have the
normal and depth of their contact manifold; signed distances of shapes are proven. Unsupported features raise
Unsupported: Halfspace, Plane, OcTree, costs, motions other than CCDM_TRANS and CCDM_LINEAR.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from .collision import Crowd, Shown, _short, contacts_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    import numpy.typing as npt

    from ._core import Body, Result

    _Floats = npt.NDArray[np.float64]
    _Surface = tuple[_Floats, Any]  # vertices and faces

facets: int = 64
"""int: the number of facets around the axis, for shapes made afterwards."""


class Unsupported(NotImplementedError):
    """Raised for features of FCL that this module does not support."""


class GJKSolverType(IntEnum):
    """The solver of FCL; has no effect here."""

    GST_LIBCCD, GST_INDEP = range(2)


class CCDMotionType(IntEnum):
    """The motion of objects between two poses."""

    CCDM_TRANS, CCDM_LINEAR, CCDM_SCREW, CCDM_SPLINE = range(4)


class CCDSolverType(IntEnum):
    """The solver of FCL; has no effect here."""

    CCDC_NAIVE, CCDC_CONSERVATIVE_ADVANCEMENT, CCDC_RAY_SHOOTING, CCDC_POLYNOMIAL_SOLVER = range(4)


def _array(given: npt.ArrayLike, shape: tuple[int, ...], what: str) -> _Floats:
    out = np.array(given, dtype=float)
    out = out.squeeze() if len(shape) == 1 else out
    if out.shape != shape:
        raise ValueError(f"{what}: expected shape {shape}, got {np.shape(given)}")
    return out


class _Posed:
    """A rotation and a translation."""

    def __init__(self) -> None:
        self._pose = np.eye(4)

    def getTranslation(self) -> _Floats:
        """Return the translation, (3,)."""
        return self._pose[:3, 3].copy()

    def setTranslation(self, T: npt.ArrayLike) -> None:
        """Set the translation, (3,)."""
        self._pose[:3, 3] = _array(T, (3,), "a translation")

    def getRotation(self) -> _Floats:
        """Return the rotation, (3, 3)."""
        return self._pose[:3, :3].copy()

    def setRotation(self, R: npt.ArrayLike) -> None:
        """Set the rotation, (3, 3)."""
        self._pose[:3, :3] = _array(R, (3, 3), "a rotation")

    def getQuatRotation(self) -> _Floats:
        """Return the rotation as w, x, y, z with w >= 0."""
        r = self._pose[:3, :3]
        squares = np.array([np.trace(r), *(2 * np.diag(r) - np.trace(r))]) + 1
        differences = {(0, 1): r[2, 1] - r[1, 2], (0, 2): r[0, 2] - r[2, 0], (0, 3): r[1, 0] - r[0, 1]}
        sums = {(1, 2): r[0, 1] + r[1, 0], (1, 3): r[0, 2] + r[2, 0], (2, 3): r[1, 2] + r[2, 1]}
        products = {**differences, **sums}  # four times q[i] q[j]
        i = int(np.argmax(squares))  # the largest component, to avoid cancellation
        q = np.array([squares[i] if j == i else products[min(i, j), max(i, j)] for j in range(4)])
        q /= np.linalg.norm(q)
        return -q if q[0] < 0 else q

    def setQuatRotation(self, q: npt.ArrayLike) -> None:
        """Set the rotation from w, x, y, z, of any length but 0."""
        q = _array(q, (4,), "a quaternion")
        length = np.linalg.norm(q)
        if not length > 0:
            raise ValueError("a quaternion: expected one other than zero")
        w, v = q[0] / length, q[1:] / length
        self.setRotation((w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * np.cross(v, np.eye(3)).T)

    @property
    def pose(self) -> _Floats:
        """(4, 4) float: the pose."""
        return self._pose.copy()


class Transform(_Posed):
    """A rotation and a translation: Transform(), (q), (R), (T), (q, T), (R, T) or (Transform); q is w, x,
    y, z.
    """

    def __init__(self, *args: npt.ArrayLike | _Posed) -> None:
        super().__init__()
        given: list[Any] = list(args)
        if len(given) > 2:
            raise ValueError("Too many arguments to Transform().")
        if len(given) == 1 and isinstance(given[0], _Posed):
            self._pose = given.pop().pose
        if len(given) == 2 or (given and np.shape(given[0]) == (3,)):
            self.setTranslation(given.pop())
        if given and np.shape(given[0]) == (3, 3):
            self.setRotation(given[0])
        elif given and np.shape(given[0]) == (4,):
            self.setQuatRotation(given[0])
        elif given:
            raise ValueError("Invalid input to Transform().")

    def __repr__(self) -> str:
        parts = (self.getRotation(), self.getTranslation())
        rotation, translation = (np.array2string(x, separator=", ") for x in parts)
        return f"<lrbscope.fcl.Transform {' '.join(rotation.split())}, {' '.join(translation.split())}>"


class CollisionGeometry:
    """A shape. Its body is made on first use."""

    _node_type = 0
    _object_type = 2  # a shape: a solid; 1: a mesh, a surface
    _made: Body | None = None

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):  # a dimension, which the body depends on
            self._made = None
            if isinstance(value, (list, tuple, np.ndarray)):
                value = np.array(value, dtype=float)
                value.flags.writeable = False
        object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        dimensions = [f"{name}={_short(value)}" for name, value in vars(self).items() if not name.startswith("_")]
        return f"<lrbscope.fcl.{' '.join([type(self).__name__, ', '.join(dimensions)]).strip()}>"

    def getNodeType(self) -> int:
        """Return FCL's number of the kind of shape."""
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

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key != "_made"}


class BVHModel(CollisionGeometry):
    """A triangle mesh: beginModel(), then addSubModel(), addTriangle() or addVertex(), then endModel()."""

    _node_type = 5  # OBBRSS, as in python-fcl
    _object_type = 1

    def __init__(self) -> None:
        self._state = 0  # 1: after beginModel(), 2: after endModel()
        self._vertices: list[_Floats] = []
        self._triangles: list[tuple[int, int, int]] = []

    def num_tries_(self) -> int:
        """Return the number of triangles."""
        return len(self._triangles)

    def buildState(self) -> int:
        """Return 0 before beginModel(), 1 between beginModel() and endModel(), then 2."""
        return self._state

    def beginModel(self, num_tris_: int = 0, num_vertices_: int = 0) -> int:
        """Start a new model. The arguments have no effect. Returns 0."""
        self._state, self._vertices, self._triangles, self._made = 1, [], [], None
        return 0

    def addVertex(self, x: float, y: float, z: float) -> bool:
        """Add a vertex."""
        self._check(1)
        self._vertices.append(_array([x, y, z], (3,), "a vertex"))
        return True

    def addTriangle(self, v1: npt.ArrayLike, v2: npt.ArrayLike, v3: npt.ArrayLike) -> bool:
        """Add a triangle of three points, (3,) each."""
        return self.addSubModel([_array(v, (3,), "a vertex") for v in (v1, v2, v3)], [[0, 1, 2]])

    def addSubModel(self, verts: npt.ArrayLike, triangles: npt.ArrayLike) -> bool:
        """Add a mesh: verts (n, 3) float, triangles (m, 3) int."""
        self._check(1)
        verts, triangles = np.asarray(verts, dtype=float), np.asarray(triangles)
        for a, what in ((verts, "verts"), (triangles, "triangles")):
            if a.ndim != 2 or a.shape[1] != 3:
                raise ValueError(f"{what}: expected shape (n, 3), got {a.shape}")
        if triangles.dtype.kind not in "iu":
            raise ValueError(f"triangles: expected integers, got {triangles.dtype}")
        n = len(self._vertices)
        self._vertices += list(verts)
        self._triangles += [(int(a) + n, int(b) + n, int(c) + n) for a, b, c in triangles]
        return True

    def endModel(self) -> int:
        """Finish the model. Returns 0."""
        self._check(1)
        self._state = 2
        self._body()  # raises here if the mesh cannot be queried
        return 0

    def _check(self, state: int) -> None:
        if self._state != state:
            raise ValueError("BVH construction does not follow correct sequence")

    def _surface(self) -> _Surface:
        self._check(2)
        vertices, triangles = np.array(self._vertices), np.array(self._triangles, dtype=np.int64)
        return vertices.reshape(-1, 3), triangles.reshape(-1, 3)


class Convex(CollisionGeometry):
    """A convex polyhedron: vertices (n, 3), the number of faces, and for each face its number of corners
    followed by the corners, in one flat list.
    """

    _node_type = 15

    def __init__(self, vertices: npt.ArrayLike, num_faces: int, faces: Iterable[int]) -> None:
        self.num_faces = num_faces
        rest = iter(map(int, faces))
        self._faces = [[next(rest) for _ in range(n)] for n in rest]
        if len(self._faces) != num_faces:
            raise ValueError(f"faces: expected {num_faces}, got {len(self._faces)}")
        self._vertices = np.array(vertices, dtype=float)

    def _surface(self) -> _Surface:
        return self._vertices, self._faces


class TriangleP(CollisionGeometry):
    """A triangle of three points, (3,) each."""

    _node_type = 18

    def __init__(self, a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike) -> None:
        self.a, self.b, self.c = (_array(v, (3,), "a corner") for v in (a, b, c))

    def _surface(self) -> _Surface:
        return np.array([self.a, self.b, self.c]), np.array([[0, 1, 2]])


class Box(CollisionGeometry):
    """A box with these side lengths, centred at the origin."""

    _node_type = 9

    def __init__(self, x: float, y: float, z: float) -> None:
        self.side = np.array([x, y, z], dtype=float)

    def _surface(self) -> _Surface:
        corners = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)]) - 0.5
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        return corners * self.side, [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]


class _Round(CollisionGeometry):
    """A surface of revolution about z."""

    radius: float
    lz: float

    def __init__(self, radius: float, lz: float) -> None:
        self.radius, self.lz = float(radius), float(lz)

    def _profile(self) -> list[tuple[float, float]]:
        """Return points (radius, z) from the lower pole to the upper."""
        raise NotImplementedError

    def _surface(self) -> _Surface:
        profile = self._profile()
        angles = 2 * np.pi * np.arange(facets) / facets
        around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        rings = [np.column_stack([around * r, np.full(facets, z)]) for r, z in profile[1:-1]]
        poles = [np.array([[0, 0, z]]) for _, z in (profile[0], profile[-1])]
        faces, last = [], 1 + (len(rings) - 1) * facets
        for k in range(facets):
            n = (k + 1) % facets
            faces.append((0, 1 + n, 1 + k))
            for low in range(1, last, facets):
                faces += [(low + k, low + n, low + facets + n), (low + k, low + facets + n, low + facets + k)]
            faces.append((last + facets, last + k, last + n))
        return np.concatenate([poles[0], *rings, poles[1]]), faces


def _arc(radius: float, begin: float, end: float, z: float = 0) -> list[tuple[float, float]]:
    """Return points of an arc about the height z between two angles of latitude."""
    angles = np.linspace(begin, end, facets // 2 + 1 if end - begin > 2 else facets // 4 + 1)
    return [(radius * math.cos(a), z + radius * math.sin(a)) for a in angles]


class Sphere(_Round):
    """A sphere."""

    _node_type = 10

    def __init__(self, radius: float) -> None:
        self.radius = float(radius)

    def _profile(self) -> list[tuple[float, float]]:
        return _arc(self.radius, -math.pi / 2, math.pi / 2)


class Ellipsoid(CollisionGeometry):
    """An ellipsoid with these radii along x, y and z."""

    _node_type = 11

    def __init__(self, a: float, b: float, c: float) -> None:
        self.radii = np.array([a, b, c], dtype=float)

    def _surface(self) -> _Surface:
        vertices, faces = Sphere(1)._surface()
        return vertices * self.radii, faces


class Capsule(_Round):
    """A cylinder of height lz along z with a hemisphere on either end."""

    _node_type = 12

    def _profile(self) -> list[tuple[float, float]]:
        r, half = self.radius, self.lz / 2
        return _arc(r, -math.pi / 2, 0, -half) + _arc(r, 0, math.pi / 2, half)


class Cone(_Round):
    """A cone of height lz along z, base down, with the midpoint of its axis at the origin."""

    _node_type = 13

    def _profile(self) -> list[tuple[float, float]]:
        return [(0, -self.lz / 2), (self.radius, -self.lz / 2), (0, self.lz / 2)]


class Cylinder(_Round):
    """A cylinder of height lz along z, centred at the origin."""

    _node_type = 14

    def _profile(self) -> list[tuple[float, float]]:
        r, half = self.radius, self.lz / 2
        return [(0, -half), (r, -half), (r, half), (0, half)]


class _Missing(CollisionGeometry):
    _instead = "it has no end; take a Box that is large enough"

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise Unsupported(f"lrbscope.fcl has no {type(self).__name__}: {self._instead}")


class Halfspace(_Missing):
    """Raises Unsupported: it is unbounded."""


class Plane(_Missing):
    """Raises Unsupported: it is unbounded."""


class OcTree(_Missing):
    """Raises Unsupported."""

    _instead = "make a mesh of its occupied cells"


class CollisionObject(_Posed):
    """A geometry at a pose."""

    def __init__(
        self, geom: CollisionGeometry | None = None, tf: Transform | None = None, _no_instance: bool = False
    ) -> None:
        if geom is None:
            raise ValueError("a CollisionObject needs a geometry")
        self._geom = geom
        self.setTransform(Transform() if tf is None else tf)

    def __repr__(self) -> str:
        return f"<lrbscope.fcl.CollisionObject of {self._geom!r} at {self.getTransform()!r}>"

    def getObjectType(self) -> int:
        """Return FCL's type number: 1 for a mesh, 2 for a shape."""
        return self._geom._object_type

    def getNodeType(self) -> int:
        """Return FCL's number of the kind of shape."""
        return self._geom.getNodeType()

    def getTransform(self) -> Transform:
        """Return the pose."""
        return Transform(self)

    def setTransform(self, tf: Transform) -> None:
        """Set the pose."""
        self._pose = tf.pose

    def isOccupied(self) -> bool:
        """Return True: there are no octree cells."""
        return True

    def isFree(self) -> bool:
        """Return False."""
        return False

    isUncertain = isFree

    @property
    def body(self) -> Body:
        """The lrbscope.Body of its geometry."""
        return self._geom._body()

    @property
    def _is_shape(self) -> bool:
        return self._geom._object_type == 2


@dataclass(repr=False, eq=False)
class Contact(Shown):
    """A contact of two objects. b1, b2: triangles, -1 for shapes; normal: from o1 to o2; pos: world frame."""

    o1: CollisionGeometry | None = None
    o2: CollisionGeometry | None = None
    b1: int = -1
    b2: int = -1
    normal: _Floats = field(default_factory=lambda: np.zeros(3))
    pos: _Floats = field(default_factory=lambda: np.zeros(3))
    penetration_depth: float = 0.0


class CostSource:
    """Never created: costs are not supported."""


@dataclass(repr=False, eq=False)
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


@dataclass(repr=False, eq=False)
class CollisionResult(Shown):
    """is_collision: bool; contacts: list of Contact."""

    is_collision: bool = False
    contacts: list[Contact] = field(default_factory=list)
    cost_sources: list[CostSource] = field(default_factory=list)


@dataclass(repr=False, eq=False)
class DistanceRequest(Shown):
    """Closest points are always computed."""

    enable_nearest_points: bool = False
    enable_signed_distance: bool = False
    gjk_solver_type: int = GJKSolverType.GST_LIBCCD


class DistanceResult(Shown):
    """min_distance; nearest_points: two (3,) arrays, world frame; b1, b2: triangles, -1 for shapes."""

    def __init__(self, min_distance_: float = sys.float_info.max) -> None:
        self.min_distance = min_distance_
        self.nearest_points: list[Any] = [None, None]
        self.o1: CollisionGeometry | None = None
        self.o2: CollisionGeometry | None = None
        self.b1 = self.b2 = -1


@dataclass(repr=False, eq=False)
class ContinuousCollisionRequest(Shown):
    """toc_err: maximum error of the time of contact. The rest has no effect here."""

    num_max_iterations: int = 10
    toc_err: float = 0.0001
    ccd_motion_type: int = CCDMotionType.CCDM_TRANS
    gjk_solver_type: int = GJKSolverType.GST_LIBCCD
    ccd_solver_type: int = CCDSolverType.CCDC_NAIVE


@dataclass(repr=False, eq=False)
class ContinuousCollisionResult(Shown):
    """is_collide: bool; time_of_contact: from 0 to 1, 1 if there is no contact."""

    is_collide: bool = False
    time_of_contact: float = 1.0


class CollisionData(Shown):
    """Data that managers pass to collision callbacks."""

    def __init__(
        self, request: CollisionRequest | None = None, result: CollisionResult | None = None
    ) -> None:
        self.request, self.result = request or CollisionRequest(), result or CollisionResult()
        self.done = False


class DistanceData(Shown):
    """Data that managers pass to distance callbacks."""

    def __init__(self, request: DistanceRequest | None = None, result: DistanceResult | None = None) -> None:
        self.request, self.result = request or DistanceRequest(), result or DistanceResult()
        self.done = False


def _holds(o1: CollisionObject, o2: CollisionObject, relation: str) -> bool:
    """Return True if a shape contains the other object. A mesh is a surface and contains nothing."""
    holder = {"a_inside_b": o2, "b_inside_a": o1}.get(relation)
    return holder is not None and holder._is_shape


def _ids(o1: CollisionObject, o2: CollisionObject, b1: int = -1, b2: int = -1) -> tuple[Any, ...]:
    """Return o1, o2, b1, b2 of a result."""
    return (o1._geom, o2._geom, *(-1 if o._is_shape else int(b) for o, b in ((o1, b1), (o2, b2))))


def _contacts(o1: CollisionObject, o2: CollisionObject, result: Result, full: bool) -> Iterator[Contact]:
    """Yield a Contact for each pair of triangles.

    If one object is a shape: for each triangle of the other. For two shapes: for each contact region.
    """
    regions = result.regions if o1._is_shape and o2._is_shape else []
    of_region = {int(i): n for n, region in enumerate(regions) for i in region.pairs}
    found: Iterable[Any] = ((i,) for i in range(len(result.pairs)))
    if full:
        found = contacts_of(result, (o1.body, o1.pose), (o2.body, o2.pose))
    seen = set()
    for i, *geometry in found:
        c = Contact(*_ids(o1, o2, *result.pairs[i]))
        key = (c.b1, c.b2, of_region.get(i))
        if key in seen:
            continue
        seen.add(key)
        if full:
            c.pos, c.normal, c.penetration_depth = geometry
            c.pos = regions[of_region[i]].centroid if regions else c.pos
        yield c


def collide(
    o1: CollisionObject, o2: CollisionObject, request: CollisionRequest | None = None, result: CollisionResult | None = None
) -> int:
    """Find the contacts of two objects. Returns their number; adds them to `result`."""
    request, result = request or CollisionRequest(), result or CollisionResult()
    full = bool(request.enable_contact)
    mode: Any = "all" if request.num_max_contacts > 1 or full else "any"
    found = _core.collide(o1.body, o2.body, o2.pose, o1.pose, mode=mode, contacts=full)
    contacts: list[Contact] = []
    if len(found.pairs):
        for c in _contacts(o1, o2, found, full):
            if len(contacts) >= request.num_max_contacts:
                break
            contacts.append(c)
    elif _holds(o1, o2, found.relation):
        inner = o1 if found.relation == "a_inside_b" else o2
        contacts.append(Contact(*_ids(o1, o2)))
        contacts[0].pos = inner.pose[:3, : inner.body.dim] @ inner.body.vertices[0] + inner.pose[:3, 3]
    result.is_collision = result.is_collision or bool(len(found.pairs)) or bool(contacts)
    result.contacts += contacts
    return len(contacts)


def distance(
    o1: CollisionObject, o2: CollisionObject, request: DistanceRequest | None = None, result: DistanceResult | None = None
) -> float:
    """Return the distance of two objects, in the world's unit.

    0 for intersecting meshes, -1 if a shape and another object overlap. Updates `result` if it is smaller.
    """
    request, result = request or DistanceRequest(), result or DistanceResult()
    found = _core.distance(o1.body, o2.body, o2.pose, o1.pose)
    shapes = [o for o in (o1, o2) if o._is_shape]
    value, points = found.upper, [found.points[0], found.points[1]]
    if (found.meet and shapes) or _holds(o1, o2, found.relation):
        value = -1.0
        if request.enable_signed_distance and len(shapes) == 2:
            overlap = _core.clash(o1.body, o2.body, o2.pose, o1.pose, volume=False)
            value = -overlap.depth[1] if overlap.depth else value
            # The points at which the shapes touch once they are separated, with the second one moved back.
            separate = o2.pose
            separate[:3, 3] += overlap.translation
            points = list(_core.distance(o1.body, o2.body, separate, o1.pose).points)
            points[1] = points[1] - overlap.translation
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


def defaultDistanceCallback(
    o1: CollisionObject, o2: CollisionObject, cdata: DistanceData
) -> tuple[bool, float]:
    """Measure two objects; returns whether to stop, and the minimum distance so far."""
    if not cdata.done:
        distance(o1, o2, cdata.request, cdata.result)
    nearest = cdata.result.min_distance
    return cdata.done or nearest <= 0, nearest


class DynamicAABBTreeCollisionManager:
    """Many objects: the bodies of a Scene. Poses are read at each query, so that setup() and update() do
    nothing; parameters of FCL's tree have no effect.
    """

    max_tree_nonbalanced_level = tree_incremental_balance_pass = 10
    tree_topdown_balance_threshold = 2
    tree_topdown_level = tree_init_level = 0
    octree_as_geometry_collide, octree_as_geometry_distance = True, False

    def __init__(self) -> None:
        self._crowd = Crowd()

    def __repr__(self) -> str:
        return f"<lrbscope.fcl.DynamicAABBTreeCollisionManager of {self.size()} objects>"

    def registerObjects(self, other_objs: Iterable[CollisionObject]) -> None:
        """Add objects."""
        for o in other_objs:
            self.registerObject(o)

    def registerObject(self, obj: CollisionObject) -> None:
        """Add an object."""
        if not isinstance(obj, CollisionObject):
            raise TypeError(f"expected a CollisionObject, got {type(obj).__name__}")
        self._crowd.add(obj, obj.body, obj.pose)

    def unregisterObject(self, obj: CollisionObject) -> None:
        """Remove an object if it is present."""
        for key in [key for key, o in self._crowd.labels.items() if o is obj]:
            self._crowd.remove(key)

    def setup(self) -> None:
        """Do nothing."""

    def update(self, arg: CollisionObject | Sequence[CollisionObject] | None = None) -> None:
        """Do nothing."""

    def getObjects(self) -> list[CollisionObject]:
        """Return a list of the objects."""
        return list(self._crowd.labels.values())

    def clear(self) -> None:
        """Remove all objects."""
        self._crowd = Crowd()

    def empty(self) -> bool:
        """Return whether there are no objects."""
        return not self._crowd.labels

    def size(self) -> int:
        """Return the number of objects."""
        return len(self._crowd.labels)

    def _moved(self) -> Crowd:
        """Return the objects at their current poses and with their current bodies."""
        crowd, objects = self._crowd, self.getObjects()
        if any(o.body is not crowd.scene.body(key) for key, o in crowd.labels.items()):
            self.clear()
            self.registerObjects(objects)
        elif objects:
            crowd.scene.move(list(crowd.labels), np.array([o.pose for o in objects]))
        return self._crowd

    def _arguments(self, args: tuple[Any, ...]) -> tuple[Any, ...]:
        """Return the scene, the arguments that select the others in its functions, a function from pairs of
        keys to objects, and data and callback.
        """
        if len(args) not in (2, 3) or not callable(args[-1]):
            raise ValueError("expected data and callback, optionally after an object or a manager")
        crowd, other = self._moved(), args[0] if len(args) == 3 else self
        if isinstance(other, DynamicAABBTreeCollisionManager):
            others, objects_of = crowd.against(None if other is self else other._moved())
        else:
            others, of_pair = crowd.against((other.body, other.pose), other)
            objects_of = lambda a, b: of_pair(a, b)[::-1]
        return (crowd.scene, others, objects_of, *args[-2:])

    def collide(self, *args: Any) -> None:
        """collide(data, callback), (object, data, callback) or (manager, data, callback).

        Calls callback(o1, o2, data) for objects with overlapping boxes, until it returns True.
        """
        scene, others, objects_of, data, callback = self._arguments(args)
        for a, b in scene.near(0, *others)[0].tolist():
            if callback(*objects_of(a, b), data):
                return

    def distance(self, *args: Any) -> None:
        """distance(data, callback), (object, data, callback) or (manager, data, callback).

        Calls callback(o1, o2, data), which returns whether to stop and the minimum distance so far, for
        objects whose boxes are closer than that, closest first.
        """
        scene, others, objects_of, data, callback = self._arguments(args)
        likely = scene.nearest_boxes(*others)
        if likely is None:
            return
        done, nearest = callback(*objects_of(*likely[:2]), data)
        if done:
            return
        keys, gaps = scene.near(max(nearest, 0.0), *others)
        for (a, b), gap in zip(keys.tolist(), gaps):
            if (a, b) == likely[:2]:
                continue
            if gap > nearest:
                return
            done, nearest = callback(*objects_of(a, b), data)
            if done:
                return


def _motion(o: CollisionObject, tf_end: Transform, kind: int) -> _Floats:
    """Return the start and end pose of an object's motion, (2, 4, 4)."""
    end = Transform(tf_end)
    if kind == CCDMotionType.CCDM_TRANS:
        end.setRotation(o.getRotation())
    elif kind != CCDMotionType.CCDM_LINEAR:
        raise Unsupported("lrbscope.fcl does not support CCDM_SCREW and CCDM_SPLINE; use CCDM_TRANS or CCDM_LINEAR")
    return np.array([o.pose, end.pose])


def continuousCollide(
    o1: CollisionObject,
    tf1_end: Transform,
    o2: CollisionObject,
    tf2_end: Transform,
    request: ContinuousCollisionRequest | None = None,
    result: ContinuousCollisionResult | None = None,
) -> float:
    """Find the first contact of two objects that move from their poses to the given Transforms.

    Depending on ccd_motion_type they keep their rotation (CCDM_TRANS) or rotate by the shortest arc
    (CCDM_LINEAR). Returns a time from 0 to 1, 1 if they do not collide: there is no contact before it, and
    contact at most toc_err later. Objects within rounding errors of contact count as colliding.
    """
    request, result = request or ContinuousCollisionRequest(), result or ContinuousCollisionResult()
    motions = [_motion(o, end, request.ccd_motion_type) for o, end in ((o1, tf1_end), (o2, tf2_end))]
    tolerance = min(request.toc_err, 1.0)
    found = _core.first_contact(o1.body, o2.body, motions[1], motions[0], tolerance=tolerance)
    inside = _holds(o1, o2, found.at_begin)
    time: float = 0.0 if inside else found.t0
    result.is_collide = result.is_collide or inside or found.outcome != "never"
    result.time_of_contact = min(time, result.time_of_contact)
    return time
