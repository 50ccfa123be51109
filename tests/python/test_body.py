"""Bodies: from arrays and files, their properties, what is refused."""

import pickle
import sys
from unittest import mock

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError
from shapes import (
    ball_arrays,
    cube_arrays,
    placed,
    random_poses,
    shifted,
    square_arrays,
)


def test_arrays_come_back_without_a_copy():
    vertices, faces = ball_arrays(1)
    body = Body(vertices, faces)
    assert np.array_equal(body.vertices, vertices) and body.vertices.dtype == np.float64
    assert np.array_equal(body.faces, faces) and body.faces.dtype == np.uint32
    assert np.shares_memory(body.vertices, body.vertices) and np.shares_memory(body.faces, body.triangles)
    assert np.shares_memory(body.vertices, body.all_vertices)
    with pytest.raises(ValueError):
        body.vertices[0, 0] = 1
    kept = Body(vertices, faces).vertices  # keeps its body
    assert np.array_equal(kept, vertices)


def test_polygons_and_triangles_of_their_fans():
    vertices, _ = cube_arrays()
    quads = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    body = Body(vertices, quads)
    assert body.is_solid and np.array_equal(body.faces, quads)
    assert np.array_equal(body.triangles, cube_arrays()[1])
    assert body.face_of_triangle.tolist() == [i // 2 for i in range(12)]
    mixed = [(0, 1, 3), (0, 3, 2)] + quads[1:].tolist()
    again = Body(vertices, mixed)
    assert [f.tolist() for f in again.faces] == [list(f) for f in mixed]
    r = lrbscope.collide(body, again, shifted(0.5, 0.25, 0.125))
    assert r.face_pairs.max() < 7 and len(r.face_pairs) == len(r.pairs)


def test_a_body_in_the_plane():
    vertices, faces = square_arrays()
    square = Body(vertices.tolist(), faces.tolist())
    assert square.dim == 2 and square.is_solid
    assert np.array_equal(square.vertices, vertices) and np.array_equal(square.faces, faces)
    assert np.array_equal(square.triangles, faces) and square.all_vertices.shape[1] == 2
    assert np.shares_memory(square.vertices, square.all_vertices)
    with pytest.raises(ValueError):
        square.vertices[0, 0] = 1
    for again in (Body(square.vertices, square.faces), pickle.loads(pickle.dumps(square))):
        assert again.hash == square.hash and np.array_equal(again.vertices, vertices)
    assert lrbscope.collide(square, square, shifted(0.5, 0.5, 0)).relation == "crossing"


def test_vertices_and_faces_make_the_body_again(ball, tmp_path):
    star = np.array([np.exp(2j * np.pi * i / 10) * (1 + i % 2) for i in range(10)])
    plane = Body(np.column_stack([star.real, star.imag]), [[i, (i + 1) % 10] for i in range(10)])
    assert plane.region_count > 0 and len(plane.all_vertices) > len(plane.vertices) == 10
    plane.save(tmp_path / "plane.lrb")
    for body in (ball, plane, Body.load(tmp_path / "plane.lrb")):
        again = Body(body.vertices, body.faces, name=body.name)
        assert again.hash == body.hash and again.vertices.shape == body.vertices.shape
        assert np.array_equal(again.all_vertices, body.all_vertices)


@pytest.mark.parametrize("ending", ["lrb", "ply", "obj"])
def test_files(ball, tmp_path, ending):
    path = tmp_path / f"ball.{ending}"
    ball.save(path)
    again = Body.load(str(path))
    assert np.array_equal(again.vertices, ball.vertices) and np.array_equal(again.faces, ball.faces)
    assert again.hash == ball.hash
    assert Body.load(path, regions=False).real_face_count == ball.real_face_count


def test_a_damaged_pickle_is_refused(cube):
    version, data = cube.__getstate__()
    for state, said in (
        (("1.0", data), "another version"),
        ((version, 0, data), "another version"),
        ((version, data[:-8] + bytes(8)), "another build"),
        ((version, data[:-9]), "damaged"),
        ((version, data + b"\0"), "damaged"),
        ((version, data.replace(cube.faces.tobytes(), b"\xff" * cube.faces.nbytes)), ""),
    ):
        with pytest.raises(InputError, match=said):
            Body.__new__(Body).__setstate__(state)


def test_figures_and_levels(ball):
    figures = ball.figures()
    assert figures["real_faces"] == ball.real_face_count == 512
    assert figures["total_faces"] == ball.face_count and figures["regions"] == ball.region_count
    assert figures["build_seconds"] == ball.build_seconds > 0
    assert 4.0 < figures["volume_solid"] < 4.19 < figures["volume_outer"]
    bounds = [level["bound"] for level in ball.levels()]
    assert bounds == sorted(bounds, reverse=True)


def test_options_of_the_build():
    arrays = ball_arrays(3)
    plain = Body(*arrays)
    assert Body(*arrays, threads=3).hash == plain.hash != Body(*arrays, seed=2).hash
    assert Body(*arrays, lean=True).face_count < plain.face_count
    assert Body(*arrays, max_lids=12).region_count > plain.region_count
    assert Body(*cube_arrays(4), merge_planes=True).region_count == 6


def test_box(cube, ball, rng):
    assert cube.box(shifted(1, 2, 3)).tolist() == [[1, 2, 3], [2, 3, 4]]
    for pose in random_poses(rng, 5, 3):
        world = placed(ball.vertices, pose)
        assert np.array_equal(ball.box(pose), [world.min(axis=0), world.max(axis=0)])


def test_builds_report_their_progress(tmp_path):
    arrays, reports = ball_arrays(3), []
    body = Body(*arrays, progress=lambda *report: reports.append(report))
    passes = [done for _, done, _ in reports]
    assert passes and passes == sorted(set(passes))
    assert all("faces" in what and total == 0 for what, _, total in reports)
    body.save(tmp_path / "ball.ply")
    again = []
    Body.load(tmp_path / "ball.ply", progress=lambda *report: again.append(report))
    assert again == reports
    # Faces alone are made without passes.
    Body.load(tmp_path / "ball.ply", regions=False, progress=lambda *_: 1 // 0)


def test_progress_that_fails():
    with pytest.raises(ZeroDivisionError):
        Body(*ball_arrays(3), progress=lambda *_: 1 // 0)


def test_progress_bar(monkeypatch):
    module = mock.Mock()  # stands in for tqdm, which need not be installed
    bar = module.tqdm.return_value
    for name in ("tqdm", "tqdm.auto"):
        monkeypatch.setitem(sys.modules, name, module)
    Body(*ball_arrays(3), progress=True)
    assert module.tqdm.call_count == bar.close.call_count == 1 and bar.refresh.called and bar.total is None
    assert "faces" in bar.set_description_str.call_args[0][0]
    # Without tqdm: what to do instead.
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ModuleNotFoundError, match="pass a function"):
        Body(*ball_arrays(3), progress=True)


def test_a_cache_keeps_built_bodies(tmp_path, monkeypatch):
    arrays = ball_arrays(3)
    cache = tmp_path / "cache"
    first = Body(*arrays, cache=cache)
    again = Body(*arrays, cache=str(cache), name="another")
    assert again.hash == first.hash and first.build_seconds > again.build_seconds == 0 and again.name == "another"
    first.save(tmp_path / "ball.ply")
    monkeypatch.setenv("LRBSCOPE_CACHE", str(cache))
    assert Body.load(tmp_path / "ball.ply").build_seconds == 0
    with pytest.raises(TypeError, match="cache"):
        Body(*arrays, cache=3)
