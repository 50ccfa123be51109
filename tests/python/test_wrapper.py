"""Wrappers: refining, coarsening, tolerances."""

import numpy as np
import pytest

import lrbscope
from lrbscope import InputError, Wrapper
from shapes import ball_arrays


def test_from_outermost_to_the_body(ball):
    w = Wrapper(ball)
    outermost = w.faces
    assert len(w) == len(outermost) < 40 and not w.is_real.all()
    order = []
    while not w.is_real.all():
        face = w.faces[~w.is_real][0]
        region = w.region_behind(face)
        assert w.includes(region) and w.refine(region) and not w.refine(region)
        assert not w.includes(region)
        order.append(region)
    assert w.excluded.tolist() == order and w.region_behind(0) is None
    assert np.array_equal(np.sort(w.faces), np.arange(ball.real_face_count))
    for region in reversed(order):
        assert w.coarsen(region)
    assert np.array_equal(w.faces, outermost)


def test_triangles_enclose_the_body(ball):
    w = Wrapper(ball)
    corners = ball.all_vertices[w.triangles]
    volume = np.einsum("ij,ij", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert np.isclose(volume, ball.figures()["volume_outer"])
    w.refine_all()
    assert np.array_equal(w.triangles, ball.triangles) and len(w.excluded) == ball.region_count
    w.reset()
    assert len(w.excluded) == 0


def test_at_a_tolerance(ball):
    sizes = [len(Wrapper.at(ball, t)) for t in (0, 0.01, 0.1, 1, 10)]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] == ball.real_face_count > sizes[3]
    with pytest.raises(InputError, match="tolerance"):
        Wrapper.at(ball, -1)


def test_unregularised(ball):
    w = Wrapper(ball, "unregularised")
    before = len(w)
    assert w.refine_face(w.faces[0]) and len(w) != before
    with pytest.raises(InputError, match="mode"):
        Wrapper(ball, "neither")


def test_what_is_refused(ball):
    w = Wrapper(ball)
    with pytest.raises(InputError, match="region: expected a number below"):
        w.refine(ball.region_count)
    with pytest.raises(InputError, match="face: expected a number below"):
        w.refine_face(ball.face_count)
    with pytest.raises(TypeError, match="body: expected a Body, got Wrapper"):
        Wrapper(w)


def test_a_wrapper_keeps_its_body():
    w = Wrapper(lrbscope.Body(*ball_arrays(2)))
    w.refine_all()
    assert len(w) == w.body.real_face_count
