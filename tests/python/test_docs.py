"""Docstrings, annotations and the pages: examples run, names agree."""

import doctest
import inspect
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import lrbscope
import lrbscope.capture
import lrbscope.collision
import lrbscope.fcl
import lrbscope.many
from lrbscope import capture
from shapes import ball_arrays, cube_arrays, shifted

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))


def documented():
    """Return (name, docstring) of the modules and of all public functions, classes and their members."""
    found = []
    for module in (lrbscope, lrbscope.capture, lrbscope.collision, lrbscope.fcl, lrbscope.many):
        found.append((module.__name__, module.__doc__))
        names = getattr(module, "__all__", [n for n in vars(module) if not n.startswith("_")])
        for name in names:
            thing = getattr(module, name)
            if not (inspect.isclass(thing) or callable(thing)):
                continue
            found.append((f"{module.__name__}.{name}", thing.__doc__))
            if inspect.isclass(thing) and thing.__module__.startswith("lrbscope"):
                for member, value in vars(thing).items():
                    is_shown = callable(value) or isinstance(value, (property, staticmethod))
                    if is_shown and not member.startswith("_"):
                        found.append((f"{module.__name__}.{name}.{member}", getattr(value, "__doc__", None)))
    return found


DOCUMENTED = documented()


def test_everything_public_has_a_docstring():
    assert len(DOCUMENTED) > 150
    of_fcl = re.compile(r"lrbscope\.fcl\.(\w+\.\w+|[A-Z]+_TYPE|\w+Type)$")  # methods and constants with names of FCL
    assert [name for name, text in DOCUMENTED if not (text and text.strip()) and not of_fcl.match(name)] == []


@pytest.mark.parametrize("name", [name for name, text in DOCUMENTED if text and ">>>" in text])
def test_docstrings_do_as_they_say(name, cube, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = dict(DOCUMENTED)[name]
    names = {**vars(lrbscope), **vars(lrbscope.collision), **vars(lrbscope.capture), "cube": cube, "shifted": shifted, "np": np}
    test = doctest.DocTestParser().get_doctest(text, names, name, None, 0)
    assert test.examples
    said = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=said.append)
    assert not said, "".join(said)


def blocks(page):
    """Return the Python blocks of a page, and the lines that they begin at."""
    with open(os.path.join(ROOT, page)) as file:
        text = file.read()
    found = re.finditer(r"^```python\n(.*?)^```", text, re.S | re.M)
    return [(text[: m.start()].count("\n") + 1, m.group(1)) for m in found]


@pytest.mark.parametrize("page", ["docs/python.md", "docs/capture.md", "docs/formats.md", "README.md"])
def test_blocks_of_pages_run(page, tmp_path):
    """All blocks of a page as one script, in a folder with the files that they read."""
    lrbscope.Body(*ball_arrays(4)).save(tmp_path / "cow.obj")
    lrbscope.Body(*cube_arrays(1.3)).save(tmp_path / "man.obj")
    query = [capture.chunk("QRYB", query=1), capture.chunk("EVTS", query=1, events=[(0, 0, 0, 1, 255, 1)]), capture.chunk("QRYE", query=1)]
    capture.write(tmp_path / "run.lrbcap", capture.begin("engine") + query)
    (tmp_path / "poses.json").write_text(
        json.dumps([shifted(i, 0, 0)[:3].ravel().tolist() for i in range(2)])
    )
    found = blocks(page)
    assert found
    script = "\n".join("\n" * 2 + f"# {page}:{line}\n" + text for line, text in found)
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for line in re.findall(r"print\(.*\)  # (.*)", script):
        assert line in done.stdout, f"{line}\n{done.stdout}"
