from collections.abc import Callable, Iterable, Sequence
from enum import IntEnum
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from ._core import Body

_Floats = npt.NDArray[np.float64]
_CollisionCallback = Callable[[CollisionObject, CollisionObject, Any], bool]
_DistanceCallback = Callable[[CollisionObject, CollisionObject, Any], tuple[bool, float]]

facets: int

class Unsupported(NotImplementedError): ...

class GJKSolverType(IntEnum):
    GST_LIBCCD = 0
    GST_INDEP = 1

class CCDMotionType(IntEnum):
    CCDM_TRANS = 0
    CCDM_LINEAR = 1
    CCDM_SCREW = 2
    CCDM_SPLINE = 3

class CCDSolverType(IntEnum):
    CCDC_NAIVE = 0
    CCDC_CONSERVATIVE_ADVANCEMENT = 1
    CCDC_RAY_SHOOTING = 2
    CCDC_POLYNOMIAL_SOLVER = 3

class Transform:
    def __init__(self, *args: npt.ArrayLike | Transform) -> None: ...
    def getRotation(self) -> _Floats: ...
    def getTranslation(self) -> _Floats: ...
    def getQuatRotation(self) -> _Floats: ...
    def setRotation(self, R: npt.ArrayLike) -> None: ...
    def setTranslation(self, T: npt.ArrayLike) -> None: ...
    def setQuatRotation(self, q: npt.ArrayLike) -> None: ...

class CollisionGeometry:
    def getNodeType(self) -> int: ...
    def computeLocalAABB(self) -> None: ...
    @property
    def aabb_center(self) -> _Floats: ...
    def __setattr__(self, name: str, value: Any) -> None: ...

class BVHModel(CollisionGeometry):
    def __init__(self) -> None: ...
    def num_tries_(self) -> int: ...
    def buildState(self) -> int: ...
    def beginModel(self, num_tris_: int = 0, num_vertices_: int = 0) -> int: ...
    def addVertex(self, x: float, y: float, z: float) -> bool: ...
    def addTriangle(self, v1: npt.ArrayLike, v2: npt.ArrayLike, v3: npt.ArrayLike) -> bool: ...
    def addSubModel(self, verts: npt.ArrayLike, triangles: npt.ArrayLike) -> bool: ...
    def endModel(self) -> int: ...

class Convex(CollisionGeometry):
    num_faces: int
    def __init__(self, vertices: npt.ArrayLike, num_faces: int, faces: Iterable[int]) -> None: ...

class TriangleP(CollisionGeometry):
    a: _Floats
    b: _Floats
    c: _Floats
    def __init__(self, a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike) -> None: ...

class Box(CollisionGeometry):
    side: _Floats
    def __init__(self, x: float, y: float, z: float) -> None: ...

class Ellipsoid(CollisionGeometry):
    radii: _Floats
    def __init__(self, a: float, b: float, c: float) -> None: ...

class Sphere(CollisionGeometry):
    radius: float
    def __init__(self, radius: float) -> None: ...

class Capsule(CollisionGeometry):
    radius: float
    lz: float
    def __init__(self, radius: float, lz: float) -> None: ...

class Cone(CollisionGeometry):
    radius: float
    lz: float
    def __init__(self, radius: float, lz: float) -> None: ...

class Cylinder(CollisionGeometry):
    radius: float
    lz: float
    def __init__(self, radius: float, lz: float) -> None: ...

class Halfspace(CollisionGeometry):
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...

class Plane(CollisionGeometry):
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...

class OcTree(CollisionGeometry):
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...

class CollisionObject:
    def __init__(
        self, geom: CollisionGeometry | None = None, tf: Transform | None = None, _no_instance: bool = False
    ) -> None: ...
    def getObjectType(self) -> int: ...
    def getNodeType(self) -> int: ...
    def getTranslation(self) -> _Floats: ...
    def setTranslation(self, vec: npt.ArrayLike) -> None: ...
    def getRotation(self) -> _Floats: ...
    def setRotation(self, mat: npt.ArrayLike) -> None: ...
    def getQuatRotation(self) -> _Floats: ...
    def setQuatRotation(self, q: npt.ArrayLike) -> None: ...
    def getTransform(self) -> Transform: ...
    def setTransform(self, tf: Transform) -> None: ...
    def isOccupied(self) -> bool: ...
    def isFree(self) -> bool: ...
    def isUncertain(self) -> bool: ...
    @property
    def body(self) -> Body: ...
    @property
    def pose(self) -> _Floats: ...

class Contact:
    o1: CollisionGeometry | None
    o2: CollisionGeometry | None
    b1: int
    b2: int
    normal: _Floats
    pos: _Floats
    penetration_depth: float
    def __init__(self) -> None: ...

class CostSource: ...

class CollisionRequest:
    num_max_contacts: int
    enable_contact: bool
    num_max_cost_sources: int
    enable_cost: bool
    use_approximate_cost: bool
    gjk_solver_type: GJKSolverType
    def __init__(
        self,
        num_max_contacts: int = 1,
        enable_contact: bool = False,
        num_max_cost_sources: int = 1,
        enable_cost: bool = False,
        use_approximate_cost: bool = True,
        gjk_solver_type: GJKSolverType = ...,
    ) -> None: ...

class CollisionResult:
    is_collision: bool
    contacts: list[Contact]
    cost_sources: list[CostSource]
    def __init__(self) -> None: ...

class DistanceRequest:
    enable_nearest_points: bool
    enable_signed_distance: bool
    gjk_solver_type: GJKSolverType
    def __init__(
        self,
        enable_nearest_points: bool = False,
        enable_signed_distance: bool = False,
        gjk_solver_type: GJKSolverType = ...,
    ) -> None: ...

class DistanceResult:
    min_distance: float
    nearest_points: list[Any]
    o1: CollisionGeometry | None
    o2: CollisionGeometry | None
    b1: int
    b2: int
    def __init__(self, min_distance_: float = ...) -> None: ...

class ContinuousCollisionRequest:
    num_max_iterations: int
    toc_err: float
    ccd_motion_type: CCDMotionType
    gjk_solver_type: GJKSolverType
    ccd_solver_type: CCDSolverType
    def __init__(
        self,
        num_max_iterations: int = 10,
        toc_err: float = 0.0001,
        ccd_motion_type: CCDMotionType = ...,
        gjk_solver_type: GJKSolverType = ...,
        ccd_solver_type: CCDSolverType = ...,
    ) -> None: ...

class ContinuousCollisionResult:
    is_collide: bool
    time_of_contact: float
    def __init__(self, is_collide: bool = False, time_of_contact: float = 1.0) -> None: ...

class CollisionData:
    request: CollisionRequest
    result: CollisionResult
    done: bool
    def __init__(
        self, request: CollisionRequest | None = None, result: CollisionResult | None = None
    ) -> None: ...

class DistanceData:
    request: DistanceRequest
    result: DistanceResult
    done: bool
    def __init__(
        self, request: DistanceRequest | None = None, result: DistanceResult | None = None
    ) -> None: ...

class DynamicAABBTreeCollisionManager:
    max_tree_nonbalanced_level: int
    tree_incremental_balance_pass: int
    tree_topdown_balance_threshold: int
    tree_topdown_level: int
    tree_init_level: int
    octree_as_geometry_collide: bool
    octree_as_geometry_distance: bool
    def __init__(self) -> None: ...
    def registerObjects(self, other_objs: Iterable[CollisionObject]) -> None: ...
    def registerObject(self, obj: CollisionObject) -> None: ...
    def unregisterObject(self, obj: CollisionObject) -> None: ...
    def setup(self) -> None: ...
    def update(self, arg: CollisionObject | Sequence[CollisionObject] | None = None) -> None: ...
    def getObjects(self) -> list[CollisionObject]: ...
    def clear(self) -> None: ...
    def empty(self) -> bool: ...
    def size(self) -> int: ...
    @overload
    def collide(self, data: Any, callback: _CollisionCallback, /) -> None: ...
    @overload
    def collide(
        self,
        other: CollisionObject | DynamicAABBTreeCollisionManager,
        data: Any,
        callback: _CollisionCallback,
        /,
    ) -> None: ...
    @overload
    def distance(self, data: Any, callback: _DistanceCallback, /) -> None: ...
    @overload
    def distance(
        self,
        other: CollisionObject | DynamicAABBTreeCollisionManager,
        data: Any,
        callback: _DistanceCallback,
        /,
    ) -> None: ...

def collide(
    o1: CollisionObject,
    o2: CollisionObject,
    request: CollisionRequest | None = None,
    result: CollisionResult | None = None,
) -> int: ...
def distance(
    o1: CollisionObject,
    o2: CollisionObject,
    request: DistanceRequest | None = None,
    result: DistanceResult | None = None,
) -> float: ...
def continuousCollide(
    o1: CollisionObject,
    tf1_end: Transform,
    o2: CollisionObject,
    tf2_end: Transform,
    request: ContinuousCollisionRequest | None = None,
    result: ContinuousCollisionResult | None = None,
) -> float: ...
def defaultCollisionCallback(o1: CollisionObject, o2: CollisionObject, cdata: CollisionData) -> bool: ...
def defaultDistanceCallback(
    o1: CollisionObject, o2: CollisionObject, cdata: DistanceData
) -> tuple[bool, float]: ...
