"""Objects that only __new__ made raise TypeError wherever they are used; names of files may be no UTF-8."""

import os
import pickle
import subprocess
import sys
import textwrap

import pytest

import lrbscope
from lrbscope import Body
from shapes import cube_arrays, shifted

# Runs in a process of its own: what this is about once ended the interpreter.
PROBE = """
import copy, pickle
import lrbscope
from lrbscope import _core
from shapes import cube_arrays

cube = lrbscope.Body(*cube_arrays())
classes = [c for c in vars(_core).values() if isinstance(c, type) and not issubclass(c, Exception)]
functions = [f for f in vars(_core).values() if callable(f) and not isinstance(f, type)]
assert len(classes) >= 18 and len(functions) >= 10
uses = 0


def refused(what, use, *arguments, allowed=TypeError):
    global uses
    uses += 1
    try:
        found = use(*arguments)
    except allowed as error:
        return str(error)
    raise AssertionError(f"{what}{arguments[1:]!r}: returned a {type(found).__name__}")


def check_member(cls, name, member, made):
    what = f"{cls.__name__}.{name}"
    if isinstance(member, property):
        said = [refused(what, getattr, made, name)]
    else:
        said = [refused(what, getattr(cls, name), made, *[None] * n) for n in range(16)]
    assert any("__new__" in line and "\\n" not in line for line in said), (what, said)


for bound in classes:
    for cls in (bound, type("Derived", (bound,), {})):
        made = cls.__new__(cls)
        for base in bound.__mro__:
            if base.__module__ != bound.__module__:
                continue
            for name, member in vars(base).items():
                is_method = callable(member) and not isinstance(member, (staticmethod, type))
                if name in ("__init__", "__new__", "__setstate__", "__reduce__") or not (is_method or isinstance(member, property)):
                    continue
                if name.startswith("_pybind11"):  # its own, since 2.13
                    continue
                check_member(cls, name, member, made)
        for use in (pickle.dumps, copy.copy, copy.deepcopy):
            refused(f"{use.__name__} of {cls.__name__}", use, made)
        if "__repr__" not in vars(bound):
            repr(made)  # that of object, which asks for nothing
        for f in functions:
            for arguments in ((made,), (made, made), (cube, made), (cube, cube, made), (cube, cube, made, made)):
                refused(f.__name__, f, *arguments, allowed=(TypeError, lrbscope.InputError))
        for use in (lrbscope.Wrapper, lrbscope.Scene().add, lrbscope.Scene().collide):
            refused("a body that is none", use, made)
        refused("a body that is none", lrbscope.CoherentQuery, cube, made)

body = lrbscope.Body.__new__(lrbscope.Body)
body.__init__(*cube_arrays())  # nothing is lost: it can be made later
assert lrbscope.collide(body, cube).relation == "touching"
print(uses, "uses refused")
"""


def run(script):
    here = os.path.dirname(__file__)
    path = os.pathsep.join([here, os.path.dirname(os.path.dirname(lrbscope.__file__))])
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    )


def test_f4_what_only_new_made_is_refused_everywhere():
    done = run(PROBE)
    assert done.returncode == 0, done.stdout + done.stderr
    assert int(done.stdout.split()[0]) > 5000


@pytest.fixture()
def odd_file(tmp_path):
    """Return the name of a cube's file, with a byte that UTF-8 has not."""
    name = os.fsencode(tmp_path) + b"/a\xff.obj"
    vertices, faces = cube_arrays()
    with open(name, "w") as file:
        for v in vertices:
            print("v", *v, file=file)
        for f in faces:
            print("f", *(i + 1 for i in f), file=file)
    return os.fsdecode(name)


def test_f6_a_file_name_that_is_no_utf8_loads(odd_file, cube):
    body = Body.load(odd_file)
    assert body.real_face_count == 12 and body.name.endswith("a\\xff.obj")
    assert "\\xff" in repr(body) and "\\xff" in repr(lrbscope.Wrapper(body))
    assert pickle.loads(pickle.dumps(body)).name == body.name
    recorded = lrbscope.trace(body, cube, shifted(0.5, 0.25, 0.125))
    assert repr(recorded) and recorded.json() and recorded.summary() and recorded.html()
    assert str(lrbscope.explain_walk(body, cube)) and str(lrbscope.explain_pair(body, cube, (0, 0)))
    assert lrbscope.explain_walk(body, cube).dict() and body.figures()
    saved = os.path.dirname(odd_file) + "/b\udcff.lrb"
    body.save(saved)
    assert Body.load(saved).hash == body.hash
