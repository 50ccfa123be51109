"""distance(), against known distances and samples."""

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError, collide, contact_manifolds, distance, near_pairs, signed_distance
from shapes import cube_arrays, placed, random_poses, shifted


def test_cubes(cube):
    d = distance(cube, cube, shifted(3, 0, 0))
    assert d.lower <= 2 <= d.upper and d.upper - d.lower < 1e-11 and float(d) == d.upper
    assert d.points[0, 0] == 1 and d.points[1, 0] == 3
    assert d.relation == "separate" and not d.meet and d.finished
    assert d.solids == (d.lower, d.upper)
    corner = distance(cube, cube, shifted(2, 2, 2))
    assert corner.features == ("corner", "corner") and np.isclose(corner.upper, np.sqrt(3))
    assert [c.tolist() for c in corner.corners] == [[7], [0]]


def test_surfaces_that_meet_and_solids(cube):
    d = distance(cube, cube, shifted(0.5, 0.25, 0.125))
    assert d.meet and d.lower == d.upper == 0
    small = Body(*cube_arrays(0.5, 0.25))
    inside = distance(small, cube)
    assert not inside.meet and np.isclose(inside.upper, 0.25) and inside.solids == (0, 0)
    assert inside.relation == "a_inside_b"


def test_intervals_hold_what_samples_show(ball, cube, rng):
    weights = rng.dirichlet((1, 1, 1), 40)
    samples = np.einsum("wk,tkx->twx", weights, ball.vertices[ball.faces]).reshape(-1, 3)
    poses = random_poses(rng, 20, 3)
    found = distance(cube, ball, poses)
    assert len(found) == 20
    for pose, d in zip(poses, found):
        if d.relation != "separate":
            continue
        world = placed(samples, pose)
        nearest = np.linalg.norm(world - np.clip(world, 0, 1), axis=1).min()
        assert d.lower <= nearest + 1e-9 and np.isclose(np.linalg.norm(d.points[0] - d.points[1]), d.upper)
        assert nearest - d.upper < 0.05
    assert np.array_equal(found.upper, [d.upper for d in found])
    assert np.array_equal(found.lower, [float(distance(cube, ball, p).lower) for p in poses])


def test_within_and_limits(cube):
    assert distance(cube, cube, shifted(3, 0, 0), within=2.5).within is True
    assert distance(cube, cube, shifted(3, 0, 0), within=1.5).within is False
    assert distance(cube, cube, shifted(3, 0, 0)).within is None
    rough = distance(cube, cube, shifted(3, 0, 0), tolerance=0.5)
    assert rough.upper - rough.lower <= 0.5 and rough.lower <= 2 <= rough.upper
    assert distance(cube, cube, shifted(3, 0, 0), relation=False).relation == "undefined"
    with pytest.raises(InputError, match="within"):
        distance(cube, cube, within=-1)
    with pytest.raises(InputError):
        distance(cube, cube, tolerance=np.nan)
    with pytest.raises(TypeError, match="b: expected a Body"):
        distance(cube, 3)


def test_faces_and_counters(ball):
    d = distance(ball, ball, shifted(3, 0.1, 0.2))
    for side in (0, 1):
        assert d.faces[side] == d.triangles[side] < ball.real_face_count
    assert d.counters["box_tests"] > 0
    assert lrbscope.Distance.__module__ == "lrbscope"


def test_signed_distances_of_points(cube, ball, rng):
    d = signed_distance(cube, [[0.5, 0.5, 0.75], [2, 0.5, 0.5], [1, 0.5, 0.25]])
    assert len(d) == 3 and d.side.tolist() == [-1, 1, 0]
    assert np.allclose(d.lower, [-0.25, 1, 0]) and np.all(d.lower <= d.upper)
    assert d.points.shape == (3, 3) and d.points[1].tolist() == [1, 0.5, 0.5]
    assert d.lower[2] == d.upper[2] == 0
    points = rng.uniform(-2, 2, (2000, 3))
    found = signed_distance(ball, points, threads=2)
    alone = signed_distance(ball, points, threads=1)
    assert np.array_equal(found.lower, alone.lower) and np.array_equal(found.faces, alone.faces)
    gap = np.linalg.norm(found.points - points, axis=1)
    assert np.allclose(gap, np.abs(found.upper)) and {-1, 1} == set(found.side)
    moved = signed_distance(ball, points + [3, 0, 0], shifted(3, 0, 0))
    assert np.allclose(moved.upper, found.upper)


def test_signed_distances_without_a_sign_and_bad_points(cube):
    vertices, faces = cube_arrays()
    sheet = Body(vertices, faces[2:])
    d = signed_distance(sheet, [[0.5, 0.5, 0.75]])
    assert d.side.tolist() == [2] and d.lower[0] > 0
    for points, text in (([[0, 0]], "3 coordinates"), ([[0, 0, np.nan]], "point 0"), ([0, 0, 0], "shape")):
        with pytest.raises(InputError, match=text):
            signed_distance(cube, points)
    with pytest.raises(InputError, match="tolerance"):
        signed_distance(cube, [[0, 0, 0]], tolerance=-1)
    assert len(signed_distance(cube, [])) == 0


def test_near_pairs(cube, ball):
    pairs = near_pairs(cube, cube, shifted(3, 0, 0), within=2)
    assert len(pairs) == pairs.found == 62 and not pairs.meet.any()
    assert np.allclose(pairs.lower, 2) and (pairs.upper == 2).all()
    assert pairs.points.shape == (62, 2, 3) and (pairs.points[:, :, 0] == [1, 3]).all()
    assert pairs.triangles.dtype == np.uint32 and pairs.faces.tolist() == pairs.triangles.tolist()
    at = shifted(2.05, 0.1, 0.2)
    alone, all_cores = (near_pairs(ball, ball, at, within=0.3, threads=n) for n in (1, 2))
    assert len(alone) > 10 and np.array_equal(alone.points, all_cores.points)
    gap = np.linalg.norm(alone.points[:, 1] - alone.points[:, 0], axis=1)
    assert np.all(alone.lower <= gap + 1e-12) and np.all(gap <= alone.upper + 1e-12) and np.all(alone.lower <= 0.3)
    nearest = near_pairs(ball, ball, at, within=0.3, nearest=5)
    assert len(nearest) == 5 and nearest.found == len(alone) and np.all(np.diff(nearest.lower) >= 0)
    assert np.array_equal(np.sort(alone.lower)[:5], nearest.lower)
    assert nearest.upper[0] >= distance(ball, ball, at).lower
    through = shifted(0.3, 0.1, 0.2)
    met = near_pairs(ball, ball, through, within=0)
    assert np.array_equal(met.triangles, collide(ball, ball, through).pairs) and met.meet.all()
    assert not met.upper.any() and np.array_equal(met.points[:, 0], met.points[:, 1])
    assert repr(pairs) == "<lrbscope.NearPairs of 62 pairs>" and pairs.counters["candidates"] >= 62


def test_near_pairs_reject_bad_requests(cube):
    for more, text in (({"within": -1}, "within"), ({"within": np.nan}, "within"), ({"within": None}, "within"),
                       ({"within": 2, "max_pairs": 3}, "max_pairs|--max-pairs")):
        with pytest.raises(InputError, match=text):
            near_pairs(cube, cube, shifted(3, 0, 0), **more)
    with pytest.raises(TypeError):
        near_pairs(cube, cube)


def test_contact_manifolds(cube, ball):
    sunk = contact_manifolds(cube, cube, shifted(0.125, 0.25, 0.875))
    assert len(sunk) == 1 and sunk.intersects.tolist() == [True] and sunk.regions.tolist() == [0]
    assert sunk.normals.tolist() == [[0, 0, 1]] and sunk.manifold.tolist() == [0, 0, 0, 0]
    assert sunk.depths.tolist() == [0.125] * 4 and sunk.ids.tolist() == [0, 1, 2, 3]
    gaps = sunk.points[:, 0] - sunk.points[:, 1] - sunk.depths[:, None] * sunk.normals[sunk.manifold]
    assert np.abs(gaps).max() < 1e-15 and sunk.features.shape == (4, 2, 3)
    assert sunk.triangles.tolist() == collide(cube, cube, shifted(0.125, 0.25, 0.875)).pairs.tolist()
    moved = contact_manifolds(cube, cube, shifted(0.126, 0.25, 1.001), margin=0.01, previous=sunk)
    assert sorted(moved.ids.tolist()) == [0, 1, 2, 3] and moved.intersects.tolist() == [False]
    assert np.allclose(moved.depths, -0.001)
    apart = contact_manifolds(cube, cube, shifted(3, 0, 0))
    assert len(apart) == 0 and apart.points.shape == (0, 2, 3) and apart.pairs == []
    at = shifted(1.5, 0.1, 0.2)
    alone, all_cores = (contact_manifolds(ball, ball, at, margin=0.1, threads=n) for n in (1, 2))
    assert (alone.points == all_cores.points).all() and (alone.ids == all_cores.ids).all()
    assert sorted(np.concatenate(alone.pairs)) == list(range(len(alone.triangles)))


def test_contact_manifolds_reject_bad_requests(cube):
    for more in ({"margin": -1}, {"margin": np.nan}, {"margin": np.inf}, {"max_pairs": 1}, {"previous": 3}):
        with pytest.raises(InputError) as e:
            contact_manifolds(cube, cube, shifted(0.5, 0, 0), **more)
        assert "\n" not in str(e.value)
