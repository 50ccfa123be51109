"""Scenes against all pairs of their bodies."""

import math
import multiprocessing
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError, Scene
from shapes import ball_arrays, cube_arrays, open_cube_arrays, random_poses, shifted


def brute(bodies, poses):
    """Return the results of all pairs that meet, by their keys."""
    found = {}
    for j in range(len(bodies)):
        for i in range(j):
            r = lrbscope.collide(bodies[i], bodies[j], poses[j], poses[i])
            if r:
                found[i, j] = (r.relation, r.fingerprint)
    return found


def scene_of(bodies, poses):
    s = Scene()
    for body, pose in zip(bodies, poses):
        s.add(body, pose)
    return s


def as_dict(meetings):
    return {tuple(k): (r.relation, r.fingerprint) for k, r in zip(meetings.keys.tolist(), meetings)}


@pytest.fixture(scope="module")
def kinds():
    return [
        Body(*ball_arrays(1, 0.8)),
        Body(*cube_arrays(0.2), regions=False),
        Body(*open_cube_arrays()),
    ]


@pytest.fixture()
def crowd(kinds, rng):
    bodies = [kinds[i % 3] for i in range(60)]
    return bodies, random_poses(rng, 60, 2.5)


def test_all_pairs(crowd):
    bodies, poses = crowd
    s = Scene(threads=3)
    assert [s.add(b, p) for b, p in zip(bodies, poses)] == list(range(60))
    wanted = brute(bodies, poses)
    found = s.collide()
    assert len(wanted) > 20 and as_dict(found) == wanted and len(found) == len(wanted)
    assert found.keys.tolist() == sorted(found.keys.tolist())
    assert found.relations.tolist() == [r.relation for r in found]
    assert found.counts.sum() == len(found.all_pairs)
    assert found.hits.all() and s.any_meet()
    r = found[-1]
    assert (r.face_pairs[:, 0] < bodies[found.keys[-1, 0]].real_face_count).all()


def test_bodies_come_go_and_move(crowd):
    bodies, poses = crowd
    s = scene_of(bodies, poses)
    s.remove(0)
    key = s.add(bodies[1], poses[0])
    assert key == 60, "keys are never given again"
    assert key in s and 0 not in s and 10**6 not in s and "x" not in s and -1 not in s
    s.move([5, 7], poses[[1, 2]])
    s.move(key, poses[1])
    assert len(s) == len(s.keys) == 60 and s.body(key) is bodies[1]
    assert np.array_equal(s.pose(key), poses[1]) and np.array_equal(s.pose(7), poses[2])


def test_near_boxes(kinds):
    s = scene_of(kinds, [shifted(4 * i, 0, 0) for i in range(3)])
    keys, gaps = s.near(math.inf)
    assert keys.shape == (3, 2) and (np.diff(gaps) >= 0).all() and s.nearest_boxes()[2] == gaps[0]
    assert Scene().nearest() is None and s.nearest(Scene()) is None and Scene().nearest_boxes() is None


def test_bodies_stay_if_one_cannot_move(kinds):
    s = Scene()
    key = s.add(kinds[0])
    with pytest.raises(InputError, match="no body 9"):
        s.move([key, 9], np.tile(shifted(1, 0, 0), (2, 1, 1)))
    assert np.array_equal(s.pose(key), np.eye(4))
    s.add(kinds[1], shifted(math.nan, 0, 0))
    with pytest.raises(InputError):
        s.collide()


def test_threads_share_a_scene(crowd):
    one, two = scene_of(*crowd), scene_of(*crowd)
    wanted, across = as_dict(one.collide()), as_dict(one.collide(two))
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda i: as_dict(one.collide()) if i % 2 else as_dict(two.collide(one)), range(12)))
    assert all(f == wanted for f in found[1::2])
    assert all(f.keys() == across.keys() for f in found[::2])


SCENE = None


def _query_in_a_child(_):
    return as_dict(SCENE.collide())


def test_a_scene_goes_on_after_a_fork(crowd):
    global SCENE
    SCENE = scene_of(*crowd)
    wanted = as_dict(SCENE.collide())  # threads have been started before the fork
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map(_query_in_a_child, range(3)) == [wanted] * 3
