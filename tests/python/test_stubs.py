"""The annotations say the types that the modules have: of values, by mypy and by stubtest."""

import ast
import copy
import os
import pickle
import shutil
import subprocess
import textwrap

import numpy as np
import pytest

import lrbscope
from lrbscope import fcl
from shapes import shifted

PACKAGE = os.path.dirname(lrbscope.__file__)
NUMBERS = {
    "np.float64": "f8",
    "np.uint32": "u4",
    "np.int8": "i1",
    "np.uint8": "u1",
    "np.int64": "i8",
    "np.uint64": "u8",
    "np.bool_": "b1",
    "np.str_": "U",
    "np.void": "V",
}


# Where a class of each module has its annotations.
SOURCES = {"lrbscope": "_core.pyi", "lrbscope.collision": "collision.py", "lrbscope.fcl": "fcl.py"}


def source(module):
    with open(os.path.join(PACKAGE, SOURCES[module])) as file:
        return ast.parse(file.read())


TREES = {module: source(module) for module in SOURCES}
STUB = TREES["lrbscope"].body
ALIASES = {
    n.targets[0].id: n.value
    for tree in TREES.values()
    for n in ast.walk(tree)
    if isinstance(n, ast.Assign) and isinstance(n.targets[0], ast.Name) and n.targets[0].id.startswith("_")
}
CLASSES = {
    (module, n.name): n
    for module, tree in TREES.items()
    for n in tree.body
    if isinstance(n, ast.ClassDef)
}


def fits(value, type_):
    """Return whether a value is of a type, as annotations write it."""
    if isinstance(type_, ast.Constant):
        return value is None
    if isinstance(type_, ast.BinOp):
        return fits(value, type_.left) or fits(value, type_.right)
    if isinstance(type_, ast.Name):
        if type_.id in ALIASES:
            return fits(value, ALIASES[type_.id])
        plain = {"str": str, "int": int, "float": float, "bool": bool, "object": object}
        if type_.id in plain:
            return type(value) is plain[type_.id] or type_.id == "object"
        kind = getattr(lrbscope, type_.id, None) or getattr(fcl, type_.id, None)
        return type_.id == "Any" or isinstance(value, kind)
    outer, inner = ast.unparse(type_.value), type_.slice
    parts = inner.elts if isinstance(inner, ast.Tuple) else [inner]
    if outer == "npt.NDArray":
        return isinstance(value, np.ndarray) and value.dtype.str.lstrip("<|=").startswith(
            NUMBERS[ast.unparse(inner)]
        )
    if outer == "Literal":
        return value in [p.value for p in parts]
    if outer == "tuple":
        return isinstance(value, tuple) and len(value) == len(parts) and all(map(fits, value, parts))
    if outer in ("list", "set"):
        return type(value).__name__ == outer and all(fits(v, inner) for v in value)
    if outer == "dict":
        return isinstance(value, dict) and all(
            fits(k, parts[0]) and fits(v, parts[1]) for k, v in value.items()
        )
    raise AssertionError(f"unknown type: {ast.unparse(type_)}")


CALLED = ("figures", "levels", "dict", "summary", "json", "empty", "size")


def members(module, name):
    """Yield the public properties and annotated attributes of a class and their types, and some methods that
    take nothing; those of its base included.
    """
    node = CLASSES[module, name]
    for base in node.bases:
        if (module, base.id) in CLASSES:
            yield from members(module, base.id)
    for n in ast.walk(node):
        if isinstance(n, ast.FunctionDef) and any(ast.unparse(d) == "property" for d in n.decorator_list):
            yield n.name, n.returns
        elif isinstance(n, ast.FunctionDef) and (n.name in CALLED or n.name.startswith("get")):
            yield n.name, n.returns
        elif isinstance(n, ast.AnnAssign):
            name = ast.unparse(n.target).removeprefix("self.")
            if not name.startswith("_") and hasattr(n.target, "id" if n in node.body else "attr"):
                yield name, n.annotation


@pytest.fixture(scope="module")
def samples(tmp_path_factory, ball, cube):
    """Return some objects of every class, made so that what may be None is there once."""
    near, far = shifted(1.2, 0.3, 0.2), shifted(3, 0, 0)
    scene = lrbscope.Scene()
    for pose in (near, far, np.eye(4)):
        scene.add(ball, pose)
    poly = lrbscope.Body(
        cube.vertices,
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]],
    )
    motion = [far, np.eye(4)]
    full = lrbscope.collide(ball, ball, near, contacts=True, interiors_overlap=True)
    trace = lrbscope.trace(ball, ball, near)
    scenario = lrbscope.Scenario(lrbscope.scenarios()[0])
    outcome = scenario.run(tmp_path_factory.mktemp("out") / "run")
    clashes = [lrbscope.clash(cube, cube, shifted(x, 0.1, 0.2), along=(1, 0, 0)) for x in (0.5, 3)]
    walks = [lrbscope.explain_walk(ball, ball, pose) for pose in (near, far)]
    pairs = [lrbscope.explain_pair(ball, ball, p, near) for p in ([0, 0], full.pairs[0])]
    manager = lrbscope.CollisionManager()
    for name, pose in (("a", np.eye(4)), ("b", near)):
        manager.add_object(name, ball, pose)
    box = fcl.CollisionObject(fcl.Box(1, 2, 3))
    found, apart, crowd = fcl.CollisionResult(), fcl.DistanceResult(), fcl.DynamicAABBTreeCollisionManager()
    fcl.collide(box, box, fcl.CollisionRequest(enable_contact=True), found)
    fcl.distance(box, box, None, apart)
    crowd.registerObject(box)
    return [
        *manager.in_collision_internal(return_data=True)[1],
        manager.min_distance_internal(return_data=True)[1],
        box,
        box._geom,
        fcl.TriangleP(*np.eye(3)),
        box.getTransform(),
        found,
        *found.contacts,
        apart,
        crowd,
        ball,
        cube,
        poly,
        full,
        lrbscope.collide(ball, ball, far, separation=True),
        *full.regions,
        lrbscope.collide(ball, ball, [near, far]),
        lrbscope.distance(ball, ball, far),
        scene,
        scene.collide(),
        lrbscope.distance(ball, ball, far, within=1.0),
        lrbscope.distance(ball, ball, [near, far]),
        lrbscope.near_pairs(ball, ball, far, within=1.0),
        lrbscope.contact_manifolds(ball, ball, near),
        lrbscope.signed_distance(ball, np.eye(3)),
        lrbscope.self_intersections(ball),
        *clashes,
        lrbscope.first_contact(ball, ball, motion),
        lrbscope.first_contact(ball, ball, np.array([motion])),
        lrbscope.CoherentQuery(ball, cube),
        *walks,
        *pairs,
        lrbscope.Wrapper(ball),
        trace,
        scenario,
        outcome,
    ]


def test_values_are_of_the_types_that_annotations_say(samples):
    seen = set()
    for thing in samples:
        module, name = type(thing).__module__, type(thing).__name__
        for member, type_ in members(module, name):
            value = getattr(thing, member)
            value = value() if callable(value) else value
            assert fits(value, type_), f"{name}.{member}: {ast.unparse(type_)} is not {value!r}"
            seen.add((module, name))
    without = {("lrbscope", name) for name in ("InputError", "EnvironmentError")}
    assert {s for s in seen if s[0] == "lrbscope"} == {c for c in CLASSES if c[0] == "lrbscope"} - without
    of_python = {name for module, name in seen if module in ("lrbscope.collision", "lrbscope.fcl")}
    wanted = "ContactData DistanceData Box TriangleP Transform CollisionObject CollisionResult Contact"
    wanted += " DistanceResult DynamicAABBTreeCollisionManager"
    assert of_python == set(wanted.split())


def same(x, y):
    if isinstance(x, np.ndarray):
        return x.dtype == y.dtype and np.array_equal(x, y)
    if isinstance(x, dict):
        return same(list(x.items()), list(y.items()))
    if isinstance(x, (list, tuple)):
        return len(x) == len(y) and all(map(same, x, y))
    return repr(x) == repr(y) if type(x).__module__.startswith("lrbscope") else x == y


def test_data_can_be_pickled(samples):
    """Answers and bodies keep all that they know; of others the error says what to keep."""
    refused = set()
    for thing in samples:
        module, name = type(thing).__module__, type(thing).__name__
        try:
            again = pickle.loads(pickle.dumps(thing))
        except TypeError as error:
            said = str(error)
            refused.add(said.split()[1])
            for use in (copy.deepcopy, copy.copy)[: 1 + (module == "lrbscope")]:
                with pytest.raises(TypeError, match=f"^a {said.split()[1]} cannot be copied or pickled: .*(keep|make|open)"):
                    use(thing)
            continue
        assert module != "lrbscope" or (copy.copy(thing) is copy.deepcopy(thing) is thing)
        for member, _ in members(module, name):
            values = [getattr(x, member) for x in (thing, again)]
            values = [v() if callable(v) else v for v in values]
            assert member in ("memory_bytes", "figures") or same(*values), f"{name}.{member}: {values}"
        if hasattr(thing, "__getitem__"):
            assert same(list(thing), list(again))
    assert refused == set("Scene CoherentQuery Wrapper Trace Scenario Outcome PairExplanation WalkExplanation".split())


USE = """
    import numpy as np
    import lrbscope.fcl
    body = lrbscope.Body(np.eye(3), [[0, 1, 2]])
    reveal_type(lrbscope.collide(body, body))
    reveal_type(lrbscope.collide(body, body, [np.eye(4), np.eye(4)]))
    reveal_type(lrbscope.contacts(body, body))
    reveal_type(lrbscope.Scene().collide()[0])
    reveal_type(lrbscope.render(body))
    manager = lrbscope.CollisionManager()
    reveal_type(manager.add_object("first", body))
    reveal_type(lrbscope.fcl.collide(lrbscope.fcl.CollisionObject(), lrbscope.fcl.CollisionObject()))
    manager.add_object("body", body)
    reveal_type([r.relation for r in lrbscope.collide(body, body, [np.eye(4)])][0])
    plane: lrbscope.fcl.Plane | None = None
    lrbscope.collide(body, 3)
    lrbscope.Wrapper(body, "quick")
    manager.add_object("three", 3)
    lrbscope.fcl.Box("1", 2, 3)
"""


@pytest.mark.skipif(shutil.which("mypy") is None, reason="mypy is not installed")
def test_what_mypy_makes_of_it(tmp_path):
    (tmp_path / "use.py").write_text(textwrap.dedent(USE))
    done = subprocess.run(
        ["mypy", "--strict", "--no-incremental", "--cache-dir", os.devnull, "use.py"],
        cwd=tmp_path,
        env={**os.environ, "MYPYPATH": os.path.dirname(PACKAGE)},
        capture_output=True,
        text=True,
    )
    said = done.stdout.splitlines()[:-1]
    assert all(line.startswith("use.py") for line in said), done.stdout
    shown = [line.split('"')[1].replace("lrbscope._core.", "") for line in said if "Revealed" in line]
    assert shown[:2] == ["Result", "Results"] and shown[2] == "builtins.list[ContactRegion]", done.stdout
    assert shown[3] == "Result" and shown[4].startswith("lrbscope._picture.Picture")
    assert shown[5] == "Body" and shown[6] == "builtins.int"
    assert "separate" in [line for line in said if "Revealed" in line][7]
    errors = [line.split(":")[1] for line in said if ": error:" in line]
    assert errors == ["16", "17", "18", "19"], done.stdout


@pytest.mark.skipif(shutil.which("stubtest") is None, reason="stubtest is not installed")
def test_what_stubtest_finds_in_the_stub():
    done = subprocess.run(
        ["stubtest", "--concise", "lrbscope._core"],
        env={**os.environ, "MYPYPATH": os.path.dirname(PACKAGE)},
        capture_output=True,
        text=True,
    )
    # What pybind11 does to all classes: a metaclass of its own, an __init__ that refuses.
    known = ("metaclass differs", 'stub does not have *args argument "args"')
    found = [line for line in done.stdout.splitlines() if line.strip() and not line.endswith(known)]
    assert found == [] and done.stderr == "", done.stdout + done.stderr
