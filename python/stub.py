#!/usr/bin/env python3
"""stub.py FOLDER: writes FOLDER/_core.pyi, the annotations of the compiled module in FOLDER.

The type of a property is the beginning of its text, such as "(n, 3) float64: ..." or "list of str: ...". Parameters have their types
by their names, in PARAMETERS; what functions return is in RETURNS, for one pose and for many where that makes a difference.
"""

import importlib.machinery
import importlib.util
import inspect
import re
import sys

HEAD = """
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
_Vector = npt.ArrayLike
_Direction = npt.ArrayLike | Literal["x", "y", "z", "-x", "-y", "-z"]
# One pose gives one answer, many poses give as many. NumPy 2.2 and later know the number of dimensions of np.eye(4)
# and the like; a query with an array of an unknown number returns either kind, typed Any.
_Rows = Sequence[Sequence[float]]
_Pose = _Rows | np.ndarray[tuple[int, int], np.dtype[Any]]
_Poses = Sequence[npt.NDArray[Any]] | Sequence[_Rows] | np.ndarray[tuple[int, int, int], np.dtype[Any]]
_Array = npt.NDArray[Any]
_Indices = Sequence[int] | npt.NDArray[np.integer[Any]]
_Progress = Callable[[str, int, int], object] | bool
_Shape = Body | _Mesh  # a mesh of another library, such as a trimesh.Trimesh

def _encode_png(pixels: npt.ArrayLike) -> bytes: ...
def _numbers(given: object, what: str, shape: tuple[int, ...]) -> _Floats: ...
def _integers(given: object, what: str, shape: tuple[int, ...]) -> _Keys: ...
"""
ARRAYS = {"float64": "_Floats", "uint32": "_Ids", "bool": "_Flags", "int64": "_Keys", "str": "npt.NDArray[np.str_]"}
ARRAYS.update({name: f"npt.NDArray[np.{name}]" for name in ("int8", "uint8", "uint64")}, records="npt.NDArray[np.void]")
PARAMETERS = {  # the type: its parameters, some of one function only
    "_Shape": "a b body",
    "Sequence[_Shape]": "bodies_a bodies_b",
    "npt.ArrayLike": "vertices points pose pose_a pose_b poses_a poses_b motion_a along",
    "npt.ArrayLike | Sequence[Sequence[int]]": "faces",
    "int": "seed threads max_lids step nearest max_tests max_pairs max_steps max_events key region face",
    "_Indices": "pair",
    "int | _Indices": "Scene.move.key",
    "float": "tolerance relative_tolerance max_time within margin clearance zoom",
    "bool": "regions lean merge_planes contacts interiors_overlap separation always relation depth volume solids orthographic wrappers close_up"
    " transparent",
    "str": "name",
    "_Path": "path out path_or_name cache",
    "_Progress": "progress",
    "_Direction": "view_from up",
    "_Vector": "look_at",
    "tuple[int, int]": "size",
    "Scene | _Shape": "other",
    "Manifolds": "previous",
}
RETURNS = {  # the type, for one pose and for many where that makes a difference: functions
    "Body": "Body.load Scene.body",
    "Wrapper": "Wrapper.at",
    "Trace": "Scenario.record trace",
    "Outcome": "Scenario.run",
    "Picture": "Trace.picture render",
    "Meetings": "Scene.collide",
    "bool": "Wrapper.refine Wrapper.refine_face Wrapper.coarsen Wrapper.includes Scene.any_meet __bool__ __contains__",
    "int": "Scene.add __len__",
    "float": "__float__",
    "str": "Trace.json Trace.html",
    "list[str]": "scenarios",
    "dict[str, Any]": "Body.figures PairExplanation.dict WalkExplanation.dict Trace.summary",
    "list[dict[str, Any]]": "Body.levels",
    "_Floats": "Body.box Scene.pose",
    "int | None": "Wrapper.region_behind",
    "tuple[_Keys, _Floats]": "Scene.near",
    "tuple[int, int, float] | None": "Scene.nearest_boxes",
    "tuple[int, int, Distance] | None": "Scene.nearest",
    "Result": "CoherentQuery.collide",
    "Result; Results": "collide",
    "list[Result]": "collide_pairs",
    "list[ContactRegion]; list[list[ContactRegion]]": "contacts",
    "Distance; Distances": "distance",
    "Clash; list[Clash]": "clash",
    "FirstContact; ": "first_contact",
    "NearPairs": "near_pairs",
    "Manifolds": "contact_manifolds",
    "SelfIntersections": "self_intersections",
    "PointDistances": "signed_distance",
    "PairExplanation": "explain_pair",
    "WalkExplanation": "explain_walk",
    "None": "Body.save Scene.remove Scene.move Wrapper.refine_all Wrapper.reset Trace.save __init__",
}
ITEMS = {"Results": "Result", "Distances": "Distance", "FirstContacts": "FirstContact"}
REPORT = (  # Scene.report, which lrbscope/report.py adds
    "def report(self, *, clearance: float = 0, pictures: bool = True, size: tuple[int, int] = (480, 360), "
    'up: npt.ArrayLike | str = "z") -> Report: ...'
)


def literal(words):
    return "Literal[" + ", ".join(f'"{word}"' for word in words) + "]"


def looked_up(table, *names):
    """Return the type that a table has for the first of these names that it knows."""
    for name in names:
        for type_, all_of_it in table.items():
            if name in all_of_it.split():
                return type_
    raise SystemExit(f"stub.py: no type for {names[0]}")


def type_of(text):
    """Return the type that the text of a property begins with."""
    head, _, rest = " ".join(text.split()).partition(":")
    head = re.sub(r", in 2D .*", "", re.sub(r" records .*", " records", head)).rstrip(".")
    head = re.sub(rf"\((?:\w+,? ?)+\) ({'|'.join(ARRAYS)})\b", lambda m: ARRAYS[m[1]], head)
    if rest.startswith(" '"):  # the words that a str may be
        head = re.sub(r"\bstr\b", literal(re.findall(r"'(\w+)'", rest)), head)
    same = re.search(r"\bas (\w+)\.(\w+)", rest)
    if same and head == "str":
        return type_of(getattr(getattr(core, same[1]), same[2]).__doc__)
    head = head.replace("(", "tuple[").replace(")", "]").replace("dict of ", "dict of str, ")
    head = re.sub(r"\b(list|dict) of (.+?)(?= or |$)", r"\1[\2]", head)
    head = re.sub(r"\bdict\b(?!\[)", "dict[str, Any]", head).replace(" or ", " | ")
    if not head or re.search(r"[\w\]] \w", head):
        raise SystemExit(f"stub.py: no type at the beginning of: {text}")
    return head


def text_lines(text):
    """Return the lines of a docstring."""
    return ['    """' + (text or "").strip().replace("\\", "\\\\") + '"""']


def function_lines(owner, name, function):
    """Return the lines that declare a function or method."""
    full = f"{owner}.{name}".lstrip(".")
    one, *many = looked_up(RETURNS, full, name).split("; ")
    variants = [({}, one)]
    if many == [""]:
        variants = [({"motion_b": "_Pose | _Poses"}, one), ({"motion_b": "_Array"}, "Any")]
    elif many:
        variants = [({}, one), ({"poses_b": "_Poses"}, many[0]), ({"poses_b": "_Array"}, "Any")]
        variants[0][0]["poses_b"] = "_Pose | None"
    lines = []
    for number, (types, result) in enumerate(variants):
        parts = []
        for p in inspect.signature(function).parameters.values():
            if p.kind is p.KEYWORD_ONLY and "*" not in parts:
                parts.append("*")
            if p.name == "self":
                parts.append("self")
                continue
            words = core._words.get(f"{owner}.{p.name}", core._words.get(p.name))
            type_ = types.get(p.name) or (literal(words) if words else looked_up(PARAMETERS, f"{full}.{p.name}", p.name))
            is_optional = p.default is not p.empty and not (number and p.name in types)
            none = " | None" * (is_optional and "None" not in type_)  # None: the default
            parts.append(f"{p.name}: {type_}{none}" + f" = {p.default!r}" * is_optional)
        lines += ["@overload"] * (len(variants) > 1) + [f"def {name}({', '.join(parts)}) -> {result}:"]
        lines += text_lines(function.__doc__) if number == 0 else ["    ..."]
    return lines


def class_lines(cls):
    name, item, lines = cls.__name__, ITEMS.get(cls.__name__), []
    for member, value in vars(cls).items():
        if isinstance(value, property):
            lines += ["@property", f"def {member}(self) -> {type_of(value.__doc__)}:", *text_lines(value.__doc__)]
        elif isinstance(value, list):
            lines.append(f"{member}: list[str]")
        elif member == "__getitem__":
            for index, found in (("int", item), ("slice", f"list[{item}]")):
                lines += ["@overload", f"def __getitem__(self, i: {index}) -> {found}: ..."]
        elif member == "__iter__":
            lines.append(f"def __iter__(self) -> Iterator[{item}]: ...")
        elif member in ("__bool__", "__float__", "__len__", "__contains__", "__copy__", "__deepcopy__"):
            more = {"__contains__": ", key: object", "__deepcopy__": ", memo: dict[int, Any], /"}.get(member, "")
            result = name if "copy" in member else looked_up(RETURNS, f"{name}.{member}", member)
            lines.append(f"def {member}(self{more}) -> {result}: ...")
        elif type(value).__name__ in ("instancemethod", "staticmethod") and (member == "__init__" or member[0] != "_"):
            lines += ["@staticmethod"] * isinstance(value, staticmethod)
            lines += function_lines(name, member, getattr(cls, member))
    lines += [REPORT] * (name == "Scene")
    base = cls.__base__.__name__
    begin = f"class {name}" + f"({base})" * (base not in ("object", "pybind11_object")) + ":"
    return [begin, *text_lines(cls.__doc__), *("    " + line for line in lines)]


folder = sys.argv[1]
spec = importlib.machinery.PathFinder.find_spec("_core", [folder])
core = importlib.util.module_from_spec(spec)
spec.loader.exec_module(core)
out = HEAD.strip().splitlines()
for name, value in vars(core).items():
    if inspect.isclass(value):
        out += ["", *class_lines(value)]
    elif callable(value) and name[0] != "_":
        out += function_lines("", name, value)
with open(f"{folder}/_core.pyi", "w", encoding="utf-8") as file:
    file.write("\n".join(out) + "\n")
