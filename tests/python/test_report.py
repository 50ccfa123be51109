"""Interference reports, displays of pictures, and signatures for call tips."""

import inspect
import re

import numpy as np
import pytest

import lrbscope
from shapes import shifted


@pytest.fixture
def scene(cube):
    """Return cubes, some in contact: pierced by a rod, overlapping by a quarter, face to face, and alone."""
    rod = lrbscope.Body(cube.vertices * [0.5, 0.5, 3] + [0.2, 0.2, -1], cube.faces, name="rod <1>")
    shell = lrbscope.Body(cube.vertices, cube.faces[:-1], name="shell")
    out = lrbscope.Scene()
    for body, x in ((cube, 0), (cube, 0.75), (rod, 0), (cube, 5), (cube, 6), (shell, 20.5), (cube, 20), (cube, 40)):
        out.add(body, shifted(x, 0, 0))
    return out


def test_rows_are_the_clashes_of_the_scene(scene):
    """Every pair in contact is a row, with kind, depth and volume of clash(), deepest first."""
    report = scene.report(pictures=False)
    assert len(report) == len(report.rows) == len(list(report))
    expected = {tuple(k) for k in scene.collide().keys.tolist()}
    assert {row.keys for row in report} == expected
    assert (3, 4) in expected
    for row in report:
        a, b = (scene.body(k) for k in row.keys)
        assert (row.a, row.b) == (a.name, b.name)
        if not (a.is_solid and b.is_solid):
            assert row.depth is None and row.volume is None and "not closed" in row.note
            continue
        clash = lrbscope.clash(a, b, scene.pose(row.keys[1]), scene.pose(row.keys[0]))
        assert (row.kind, row.depth, row.volume) == (clash.kind, clash.depth, clash.volume)
    depths = [row.depth[1] for row in report if row.depth]
    assert depths == sorted(depths, reverse=True)
    assert report.rows[-1].kind == "touching_face"


def test_clearance_adds_pairs(scene):
    """Solids that are near are reported only with a clearance."""
    assert all(row.kind != "within_clearance" for row in scene.report(pictures=False))
    near = [row for row in scene.report(pictures=False, clearance=4) if row.kind == "within_clearance"]
    assert near and all(row.pairs == 0 for row in near)


def test_the_page_shows_names_numbers_and_pictures(scene, tmp_path):
    """The page escapes names, and has a picture of every row."""
    report = scene.report(up="y", size=(320, 240))
    report.save(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == len(report)
    assert "rod &lt;1&gt;" in page and "rod <1>" not in page
    assert re.search(r"<td>0\.25</td>", page)
    assert "8 bodies: " in page and "1 touches" in page
    assert report._repr_html_() in page
    assert all(row.picture.shape == (240, 320, 3) for row in report)
    assert "data:image" not in scene.report(pictures=False).html()


def test_a_picture_is_displayed_by_its_size(cube):
    """A picture is displayed by its size; its channels are arrays."""
    picture = lrbscope.render(cube, size=(320, 240))
    assert repr(picture) == "<lrbscope.Picture 320x240>"
    assert repr(picture[:2, :2, 0]).startswith("Picture(")


def test_up_and_view_from_are_axes_or_vectors(cube):
    """A word stands for the direction of an axis."""
    for word, vector in (("y", (0, 1, 0)), ("-x", (-1, 0, 0)), ("z", (0, 0, 1))):
        of_word = lrbscope.render(cube, up=word, view_from=(1, 2, 3), size=(320, 240))
        assert np.array_equal(of_word, lrbscope.render(cube, up=vector, view_from=(1, 2, 3), size=(320, 240)))


def test_signatures_are_those_of_the_docs(cube):
    """Functions, classes and methods have signatures, for call tips; bound methods without self."""
    assert inspect.signature(lrbscope.collide).parameters["threads"].kind is inspect.Parameter.KEYWORD_ONLY
    assert list(inspect.signature(lrbscope.Scene().collide).parameters)[:2] == ["other", "pose"]
    assert not lrbscope.collide.__doc__.startswith("collide(")
