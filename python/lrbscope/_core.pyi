from collections.abc import Callable, Iterator, Sequence
from os import PathLike
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

from ._picture import Picture
from .collision import _Mesh
from .report import Report

__version__: str

_Path = str | bytes | PathLike[str] | PathLike[bytes]
_Floats = npt.NDArray[np.float64]
_Ids = npt.NDArray[np.uint32]
_Flags = npt.NDArray[np.bool_]
_Keys = npt.NDArray[np.int64]
_Mode = Literal["all", "first", "any"]
_Recursion = Literal["complete", "paper", "paper_strict", "paper_wrapper"]
_Relation = Literal["separate", "crossing", "touching", "a_inside_b", "b_inside_a", "undefined", "unresolved"]
_Colours = Literal[
    "kind",
    "layer",
    "region",
    "face_tests",
    "refinements",
    "hits",
    "misses",
    "expansions",
    "box_tests",
    "plane_tests",
]
_Vector = npt.ArrayLike
_Direction = npt.ArrayLike | Literal["x", "y", "z", "-x", "-y", "-z"]
# One pose gives one answer, many poses give as many. NumPy 2.2 and later know the number of dimensions of np.eye(4)
# and the like; a query with an array of an unknown number returns either kind, typed Any.
_Rows = Sequence[Sequence[float]]
_Pose = _Rows | np.ndarray[tuple[int, int], np.dtype[Any]]
_Poses = Sequence[npt.NDArray[Any]] | Sequence[_Rows] | np.ndarray[tuple[int, int, int], np.dtype[Any]]
_Array = npt.NDArray[Any]
_Meet = Literal["disjoint", "touch", "cross"]
_DecidedBy = Literal["node_boxes", "node_edges", "face_boxes", "planes", "floats", "exact"]
_ClashKind = Literal[
    "apart",
    "within_clearance",
    "touching_point",
    "touching_edge",
    "touching_face",
    "protrudes",
    "pierces",
    "cuts_through",
    "a_inside_b",
    "b_inside_a",
    "equal",
    "undecided",
]
_Feature = Literal["corner", "edge", "inside"]
_Progress = Callable[[str, int, int], object] | bool

class InputError(ValueError): ...
class EnvironmentError(OSError): ...

_Shape = Body | _Mesh  # a mesh of another library, such as a trimesh.Trimesh

class Body:
    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike | Sequence[Sequence[int]],
        *,
        regions: bool = True,
        lean: bool = False,
        seed: int = 1,
        threads: int = 0,
        name: str = "body",
        progress: _Progress | None = None,
        cache: _Path | None = None,
    ) -> None: ...
    @staticmethod
    def load(
        path: _Path,
        *,
        regions: bool = True,
        lean: bool = False,
        seed: int = 1,
        threads: int = 0,
        progress: _Progress | None = None,
        cache: _Path | None = None,
    ) -> Body: ...
    def save(self, path: _Path) -> None: ...
    def __copy__(self) -> Body: ...
    def __deepcopy__(self, memo: dict[int, Any], /) -> Body: ...
    def box(self, pose: npt.ArrayLike | None = None) -> _Floats: ...
    def figures(self) -> dict[str, Any]: ...
    def levels(self, *, threads: int = 0) -> list[dict[str, Any]]: ...
    @property
    def vertices(self) -> _Floats: ...
    @property
    def all_vertices(self) -> _Floats: ...
    @property
    def faces(self) -> _Ids | list[_Ids]: ...
    @property
    def triangles(self) -> _Ids: ...
    @property
    def face_of_triangle(self) -> _Ids: ...
    @property
    def name(self) -> str: ...
    @property
    def dim(self) -> int: ...
    @property
    def is_solid(self) -> bool: ...
    @property
    def real_face_count(self) -> int: ...
    @property
    def face_count(self) -> int: ...
    @property
    def region_count(self) -> int: ...
    @property
    def layer_count(self) -> int: ...
    @property
    def hash(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def build_seconds(self) -> float: ...
    @property
    def memory_bytes(self) -> int: ...

class ContactRegion:
    @property
    def pairs(self) -> _Ids: ...
    @property
    def curves(self) -> list[tuple[_Floats, bool]]: ...
    @property
    def length(self) -> float: ...
    @property
    def area(self) -> float: ...
    @property
    def centroid(self) -> _Floats: ...
    @property
    def normal(self) -> _Floats: ...
    @property
    def depth_estimate(self) -> float: ...

class Result:
    @property
    def relation(self) -> _Relation: ...
    @property
    def pairs(self) -> _Ids: ...
    @property
    def face_pairs(self) -> _Ids: ...
    @property
    def crosses(self) -> _Flags: ...
    @property
    def fingerprint(self) -> str: ...
    @property
    def interiors_overlap(self) -> bool | None: ...
    @property
    def regions(self) -> list[ContactRegion]: ...
    @property
    def points(self) -> tuple[_Floats, _Ids]: ...
    @property
    def counters(self) -> dict[str, int | list[int]]: ...
    @property
    def error_bound(self) -> float: ...
    @property
    def finished(self) -> bool: ...
    @property
    def separation(self) -> dict[str, Any] | None: ...
    @property
    def opened(self) -> tuple[_Ids, _Ids]: ...
    def __bool__(self) -> bool: ...

class Results:
    @property
    def relations(self) -> npt.NDArray[np.str_]: ...
    @property
    def fingerprints(self) -> npt.NDArray[np.str_]: ...
    @property
    def counts(self) -> npt.NDArray[np.int64]: ...
    @property
    def hits(self) -> _Flags: ...
    @property
    def all_pairs(self) -> _Ids: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, i: int) -> Result: ...
    @overload
    def __getitem__(self, i: slice) -> list[Result]: ...
    def __iter__(self) -> Iterator[Result]: ...

class Meetings(Results):
    @property
    def keys(self) -> _Keys: ...

class Distance:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def solids(self) -> tuple[float, float]: ...
    @property
    def meet(self) -> bool: ...
    @property
    def within(self) -> bool | None: ...
    @property
    def finished(self) -> bool: ...
    @property
    def relation(self) -> _Relation: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def triangles(self) -> tuple[int, int]: ...
    @property
    def faces(self) -> tuple[int, int]: ...
    @property
    def features(self) -> tuple[_Feature, _Feature]: ...
    @property
    def corners(self) -> tuple[_Ids, _Ids]: ...
    @property
    def counters(self) -> dict[str, int]: ...
    def __float__(self) -> float: ...

class Distances:
    @property
    def lower(self) -> _Floats: ...
    @property
    def upper(self) -> _Floats: ...
    def __len__(self) -> int: ...
    def __getitem__(self, i: int) -> Distance: ...
    def __iter__(self) -> Iterator[Distance]: ...

class Clash:
    @property
    def kind(self) -> _ClashKind: ...
    @property
    def reason(self) -> str | None: ...
    @property
    def interiors_overlap(self) -> bool | None: ...
    @property
    def shares_faces(self) -> bool: ...
    @property
    def distance(self) -> tuple[float, float]: ...
    @property
    def depth(self) -> tuple[float, float] | None: ...
    @property
    def translation(self) -> _Floats: ...
    @property
    def along(self) -> tuple[float, float] | None: ...
    @property
    def volume(self) -> tuple[float, float] | None: ...

class NearPairs:
    @property
    def found(self) -> int: ...
    @property
    def triangles(self) -> _Ids: ...
    @property
    def faces(self) -> _Ids: ...
    @property
    def meet(self) -> npt.NDArray[np.uint8]: ...
    @property
    def lower(self) -> _Floats: ...
    @property
    def upper(self) -> _Floats: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def counters(self) -> dict[str, int]: ...
    def __len__(self) -> int: ...

class Manifolds:
    @property
    def normals(self) -> _Floats: ...
    @property
    def regions(self) -> _Ids: ...
    @property
    def intersects(self) -> _Flags: ...
    @property
    def manifold(self) -> _Ids: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def depths(self) -> _Floats: ...
    @property
    def ids(self) -> npt.NDArray[np.uint64]: ...
    @property
    def features(self) -> _Ids: ...
    @property
    def triangles(self) -> _Ids: ...
    @property
    def pairs(self) -> list[_Ids]: ...
    def __len__(self) -> int: ...

class SelfIntersections:
    @property
    def faces(self) -> _Ids: ...
    @property
    def kind(self) -> npt.NDArray[np.uint8]: ...
    @property
    def shared(self) -> _Ids: ...
    @property
    def curve(self) -> _Ids: ...
    @property
    def first_segment(self) -> _Ids: ...
    @property
    def segment_counts(self) -> _Ids: ...
    @property
    def segments(self) -> _Floats: ...
    @property
    def curves(self) -> int: ...
    def __len__(self) -> int: ...

class PointDistances:
    @property
    def lower(self) -> _Floats: ...
    @property
    def upper(self) -> _Floats: ...
    @property
    def side(self) -> npt.NDArray[np.int8]: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def faces(self) -> _Ids: ...
    def __len__(self) -> int: ...

class FirstContact:
    @property
    def outcome(self) -> Literal["contact", "never", "undecided"]: ...
    @property
    def t0(self) -> float: ...
    @property
    def t1(self) -> float: ...
    @property
    def at_start(self) -> bool: ...
    @property
    def grazing(self) -> bool: ...
    @property
    def passed(self) -> bool: ...
    @property
    def finished(self) -> bool: ...
    @property
    def unresolved(self) -> Literal["rounding", "steps"] | None: ...
    @property
    def speed(self) -> float: ...
    @property
    def at_begin(self) -> _Relation: ...
    @property
    def ambiguous(self) -> _Floats: ...
    @property
    def pair(self) -> tuple[int, int] | None: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def normal(self) -> _Floats: ...
    @property
    def counters(self) -> dict[str, int]: ...
    def __bool__(self) -> bool: ...

class FirstContacts:
    @property
    def t0(self) -> _Floats: ...
    @property
    def t1(self) -> _Floats: ...
    def __len__(self) -> int: ...
    def __getitem__(self, i: int) -> FirstContact: ...
    def __iter__(self) -> Iterator[FirstContact]: ...

class CoherentQuery:
    def __init__(
        self,
        a: _Shape,
        b: _Shape,
        *,
        mode: _Mode | None = "all",
        contacts: bool | None = False,
        interiors_overlap: bool | None = False,
        max_pairs: int | None = 0,
        always: bool | None = False,
    ) -> None: ...
    def collide(self, pose_b: npt.ArrayLike | None = None, pose_a: npt.ArrayLike | None = None) -> Result: ...
    @property
    def statistics(self) -> dict[str, int]: ...
    @property
    def a(self) -> Body: ...
    @property
    def b(self) -> Body: ...

class PairExplanation:
    @property
    def meet(self) -> _Meet: ...
    @property
    def decided_by(self) -> _DecidedBy: ...
    @property
    def hidden_by(self) -> tuple[_Ids, _Ids]: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def distance(self) -> float: ...
    def dict(self) -> dict[str, Any]: ...

class WalkExplanation:
    @property
    def result(self) -> Result: ...
    @property
    def plane(self) -> tuple[_Floats, float, float] | None: ...
    @property
    def near_pairs(self) -> _Ids: ...
    def dict(self) -> dict[str, Any]: ...

class Scene:
    def __init__(self, *, threads: int | None = 0) -> None: ...
    def add(self, body: _Shape, pose: npt.ArrayLike | None = None) -> int: ...
    def remove(self, key: int) -> None: ...
    @overload
    def move(self, key: int, pose: npt.ArrayLike) -> None: ...
    @overload
    def move(self, key: Sequence[int] | npt.NDArray[np.integer[Any]], pose: npt.ArrayLike) -> None: ...
    def body(self, key: int) -> Body: ...
    def pose(self, key: int) -> _Floats: ...
    @property
    def keys(self) -> _Keys: ...
    def near(
        self,
        within: float | None = 0,
        other: Scene | _Shape | None = None,
        pose: npt.ArrayLike | None = None,
    ) -> tuple[_Keys, _Floats]: ...
    def nearest_boxes(
        self, other: Scene | _Shape | None = None, pose: npt.ArrayLike | None = None
    ) -> tuple[int, int, float] | None: ...
    def collide(
        self,
        other: Scene | _Shape | None = None,
        pose: npt.ArrayLike | None = None,
        *,
        mode: _Mode | None = "all",
        contacts: bool | None = False,
        interiors_overlap: bool | None = False,
        max_pairs: int | None = 0,
    ) -> Meetings: ...
    def any_meet(self, other: Scene | _Shape | None = None, pose: npt.ArrayLike | None = None) -> bool: ...
    def nearest(
        self,
        other: Scene | _Shape | None = None,
        pose: npt.ArrayLike | None = None,
        *,
        solids: bool | None = False,
        relative_tolerance: float | None = 0,
        tolerance: float | None = 0,
    ) -> tuple[int, int, Distance] | None: ...
    def report(
        self,
        *,
        clearance: float = 0,
        pictures: bool = True,
        size: tuple[int, int] = (480, 360),
        up: npt.ArrayLike | str = "z",
    ) -> Report: ...
    def __len__(self) -> int: ...
    def __contains__(self, key: object) -> bool: ...

class Wrapper:
    def __init__(self, body: _Shape, mode: Literal["regularised", "unregularised"] | None = "regularised") -> None: ...
    @staticmethod
    def at(body: _Shape, tolerance: float, *, threads: int = 0) -> Wrapper: ...
    def refine(self, region: int) -> bool: ...
    def refine_face(self, face: int) -> bool: ...
    def coarsen(self, region: int) -> bool: ...
    def refine_all(self) -> None: ...
    def reset(self) -> None: ...
    def includes(self, region: int) -> bool: ...
    def region_behind(self, face: int) -> int | None: ...
    @property
    def body(self) -> Body: ...
    @property
    def faces(self) -> _Ids: ...
    @property
    def is_real(self) -> _Flags: ...
    @property
    def triangles(self) -> _Ids: ...
    @property
    def excluded(self) -> _Ids: ...
    def __len__(self) -> int: ...

class Trace:
    kinds: list[str]
    @property
    def events(self) -> npt.NDArray[np.void]: ...
    @property
    def steps(self) -> npt.NDArray[np.void]: ...
    @property
    def results(self) -> Results: ...
    @property
    def notes(self) -> list[str]: ...
    def json(self) -> str: ...
    def summary(self) -> dict[str, Any]: ...
    def save(self, path: _Path) -> None: ...
    def html(self) -> str: ...
    def picture(
        self,
        step: int = -1,
        *,
        size: tuple[int, int] | None = (960, 720),
        view_from: _Direction | None = None,
        up: _Direction | None = (0, 0, 1),
        look_at: _Vector | None = None,
        zoom: float | None = 1,
        orthographic: bool | None = False,
        wrappers: bool | None = False,
        close_up: bool | None = False,
        colour_by: _Colours | None = "kind",
        transparent: bool | None = False,
    ) -> Picture: ...
    def __len__(self) -> int: ...

class Outcome:
    @property
    def folder(self) -> str: ...
    @property
    def page(self) -> str: ...
    @property
    def frames(self) -> int: ...
    @property
    def mismatches(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def summary(self) -> dict[str, Any]: ...

class Scenario:
    def __init__(self, path_or_name: _Path) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def purpose(self) -> str: ...
    def record(self, *, progress: _Progress | None = None) -> Trace: ...
    def run(self, out: _Path, *, progress: _Progress | None = None) -> Outcome: ...

class SweepAndPrune:
    def __init__(self) -> None: ...
    def update(self, boxes: npt.ArrayLike) -> _Ids: ...

@overload
def collide(
    a: _Shape,
    b: _Shape,
    poses_b: _Pose | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    mode: _Mode | None = "all",
    contacts: bool | None = False,
    interiors_overlap: bool | None = False,
    tolerance: float | None = 0,
    max_tests: int | None = 0,
    max_time: float | None = 0,
    separation: bool | None = False,
    max_pairs: int | None = 0,
    recursion: _Recursion | None = "complete",
    threads: int | None = 0,
) -> Result: ...
@overload
def collide(
    a: _Shape,
    b: _Shape,
    poses_b: _Poses,
    pose_a: npt.ArrayLike | None = None,
    *,
    mode: _Mode | None = "all",
    contacts: bool | None = False,
    interiors_overlap: bool | None = False,
    tolerance: float | None = 0,
    max_tests: int | None = 0,
    max_time: float | None = 0,
    separation: bool | None = False,
    max_pairs: int | None = 0,
    recursion: _Recursion | None = "complete",
    threads: int | None = 0,
) -> Results: ...
@overload
def collide(
    a: _Shape,
    b: _Shape,
    poses_b: _Array,
    pose_a: npt.ArrayLike | None = None,
    *,
    mode: _Mode | None = "all",
    contacts: bool | None = False,
    interiors_overlap: bool | None = False,
    tolerance: float | None = 0,
    max_tests: int | None = 0,
    max_time: float | None = 0,
    separation: bool | None = False,
    max_pairs: int | None = 0,
    recursion: _Recursion | None = "complete",
    threads: int | None = 0,
) -> Any: ...
def collide_pairs(
    bodies_a: Sequence[_Shape],
    poses_a: npt.ArrayLike,
    bodies_b: Sequence[_Shape],
    poses_b: npt.ArrayLike,
    *,
    mode: _Mode | None = "all",
    contacts: bool | None = False,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> list[Result]: ...
@overload
def contacts(
    a: _Shape,
    b: _Shape,
    poses_b: _Pose | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> list[ContactRegion]: ...
@overload
def contacts(
    a: _Shape,
    b: _Shape,
    poses_b: _Poses,
    pose_a: npt.ArrayLike | None = None,
    *,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> list[list[ContactRegion]]: ...
@overload
def contacts(
    a: _Shape,
    b: _Shape,
    poses_b: _Array,
    pose_a: npt.ArrayLike | None = None,
    *,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> Any: ...
@overload
def distance(
    a: _Shape,
    b: _Shape,
    poses_b: _Pose | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    within: float | None = None,
    tolerance: float | None = 0,
    relative_tolerance: float | None = 0,
    max_steps: int | None = 0,
    relation: bool | None = True,
    threads: int | None = 0,
) -> Distance: ...
@overload
def distance(
    a: _Shape,
    b: _Shape,
    poses_b: _Poses,
    pose_a: npt.ArrayLike | None = None,
    *,
    within: float | None = None,
    tolerance: float | None = 0,
    relative_tolerance: float | None = 0,
    max_steps: int | None = 0,
    relation: bool | None = True,
    threads: int | None = 0,
) -> Distances: ...
@overload
def distance(
    a: _Shape,
    b: _Shape,
    poses_b: _Array,
    pose_a: npt.ArrayLike | None = None,
    *,
    within: float | None = None,
    tolerance: float | None = 0,
    relative_tolerance: float | None = 0,
    max_steps: int | None = 0,
    relation: bool | None = True,
    threads: int | None = 0,
) -> Any: ...
def near_pairs(
    a: _Shape,
    b: _Shape,
    pose_b: npt.ArrayLike | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    within: float,
    nearest: int | None = 0,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> NearPairs: ...
def contact_manifolds(
    a: _Shape,
    b: _Shape,
    pose_b: npt.ArrayLike | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    margin: float | None = 0,
    previous: Manifolds | None = None,
    max_pairs: int | None = 0,
    threads: int | None = 0,
) -> Manifolds: ...
def self_intersections(
    body: _Shape, *, max_pairs: int | None = 0, threads: int | None = 0
) -> SelfIntersections: ...
def signed_distance(
    body: _Shape,
    points: npt.ArrayLike,
    pose: npt.ArrayLike | None = None,
    *,
    tolerance: float | None = 0,
    relative_tolerance: float | None = 0,
    threads: int | None = 0,
) -> PointDistances: ...
@overload
def clash(
    a: _Shape,
    b: _Shape,
    poses_b: _Pose | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    clearance: float | None = 0,
    along: npt.ArrayLike | None = None,
    depth: bool | None = True,
    volume: bool | None = True,
    threads: int | None = 0,
) -> Clash: ...
@overload
def clash(
    a: _Shape,
    b: _Shape,
    poses_b: _Poses,
    pose_a: npt.ArrayLike | None = None,
    *,
    clearance: float | None = 0,
    along: npt.ArrayLike | None = None,
    depth: bool | None = True,
    volume: bool | None = True,
    threads: int | None = 0,
) -> list[Clash]: ...
@overload
def clash(
    a: _Shape,
    b: _Shape,
    poses_b: _Array,
    pose_a: npt.ArrayLike | None = None,
    *,
    clearance: float | None = 0,
    along: npt.ArrayLike | None = None,
    depth: bool | None = True,
    volume: bool | None = True,
    threads: int | None = 0,
) -> Any: ...
@overload
def first_contact(
    a: _Shape,
    b: _Shape,
    motion_b: _Pose | _Poses,
    motion_a: npt.ArrayLike | None = None,
    *,
    tolerance: float | None = 1e-09,
    max_steps: int | None = 10000000,
    relation: bool | None = True,
    threads: int | None = 0,
) -> FirstContact: ...
@overload
def first_contact(
    a: _Shape,
    b: _Shape,
    motion_b: _Array,
    motion_a: npt.ArrayLike | None = None,
    *,
    tolerance: float | None = 1e-09,
    max_steps: int | None = 10000000,
    relation: bool | None = True,
    threads: int | None = 0,
) -> Any: ...
def trace(
    a: _Shape,
    b: _Shape,
    poses_b: npt.ArrayLike | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    events: Literal["faces", "nodes", "all"] | None = "faces",
    max_events: int | None = 1000000,
    mode: _Mode | None = "all",
    contacts: bool | None = None,
    tolerance: float | None = 0,
    max_tests: int | None = 0,
    separation: bool | None = False,
    recursion: _Recursion | None = "complete",
) -> Trace: ...
def render(
    a: _Shape,
    b: _Shape | None = None,
    pose_b: npt.ArrayLike | None = None,
    pose_a: npt.ArrayLike | None = None,
    *,
    size: tuple[int, int] | None = (960, 720),
    view_from: _Direction | None = None,
    up: _Direction | None = (0, 0, 1),
    look_at: _Vector | None = None,
    zoom: float | None = 1,
    orthographic: bool | None = False,
    wrappers: bool | None = False,
    close_up: bool | None = False,
    colour_by: _Colours | None = "kind",
    transparent: bool | None = False,
) -> Picture: ...
def scenarios() -> list[str]: ...
def _encode_png(pixels: npt.ArrayLike) -> bytes: ...
def explain_pair(
    a: _Shape,
    b: _Shape,
    pair: Sequence[int] | npt.NDArray[np.integer[Any]],
    pose_b: npt.ArrayLike | None = None,
    pose_a: npt.ArrayLike | None = None,
) -> PairExplanation: ...
def explain_walk(
    a: _Shape, b: _Shape, pose_b: npt.ArrayLike | None = None, pose_a: npt.ArrayLike | None = None
) -> WalkExplanation: ...
