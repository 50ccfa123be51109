"""Queries of bodies that move by little, and explanations."""

import numpy as np
import pytest

import lrbscope
from lrbscope import CoherentQuery, InputError
from shapes import shifted


@pytest.mark.parametrize("always", [False, True])
def test_coherent_answers_are_those_of_collide(ball, cube, always):
    q = CoherentQuery(cube, ball, always=always)
    kept = []
    for x in np.linspace(1.5, 0.5, 60):
        pose = shifted(x, 0.3, 0.2)
        wanted = lrbscope.collide(cube, ball, pose)
        found = q.collide(pose)
        assert (found.relation, found.fingerprint) == (wanted.relation, wanted.fingerprint)
        kept.append((found, wanted.fingerprint))
    assert all(r.fingerprint == f for r, f in kept), "answers outlive the next query"
    statistics = q.statistics
    assert statistics["from_cache"] + statistics["caches_made"] + statistics["from_scratch"] == 60
    assert not always or statistics["from_cache"] > 10
    assert q.a is cube and q.b is ball
    q.collide(shifted(0.5, 0, 0), shifted(0.1, 0, 0))
    with pytest.raises(InputError, match="pose_b"):
        q.collide(np.eye(3))
    with pytest.raises(TypeError, match="a: expected"):
        CoherentQuery(3, cube)


def test_every_pair_is_explained(cube):
    pose = shifted(0.5, 0.25, 0.125)
    result = lrbscope.collide(cube, cube, pose, contacts=True)
    crosses = {tuple(p): bool(c) for p, c in zip(result.pairs.tolist(), result.crosses)}
    for i in range(12):
        for j in range(12):
            e = lrbscope.explain_pair(cube, cube, (i, j), pose)
            assert (e.meet != "disjoint") == ((i, j) in crosses)
            if e.meet == "disjoint":
                assert e.points.shape == (2, 3) and e.distance > 0
                assert np.isclose(np.linalg.norm(e.points[1] - e.points[0]), e.distance)
            else:
                assert (e.meet == "cross") == crosses[i, j] and e.distance == 0
            as_dict = e.dict()
            assert as_dict["pair"] == [i, j] and as_dict["meet"] == e.meet and as_dict["decided_by"] == e.decided_by
            assert str(e).startswith(f"simplex {i} of A") and e.meet in str(e)
            assert len(e.hidden_by) == 2


def test_bodies_apart_are_explained(ball):
    walk = lrbscope.explain_walk(ball, ball, shifted(2.5, 0, 0))
    assert walk.result.relation == "separate" and "separate" in str(walk)
    normal, of_a, of_b = walk.plane
    assert of_b > of_a and (ball.vertices @ normal).max() <= of_a + 1e-12
    assert ((ball.vertices + [2.5, 0, 0]) @ normal).min() >= of_b - 1e-12
    assert walk.dict()["relation"] == "separate" and walk.near_pairs.shape[1] == 2
    meeting = lrbscope.explain_walk(ball, ball, shifted(1, 0, 0))
    assert (
        meeting.plane is None
        and meeting.result.fingerprint == lrbscope.collide(ball, ball, shifted(1, 0, 0)).fingerprint
    )


@pytest.mark.parametrize("pair", [(0,), 3, "ab", (0, 1, 2), (0, 2**40), (0, -1), (0, 12)])
def test_pairs_that_are_none(cube, pair):
    with pytest.raises(InputError, match="pair: expected (integers|numbers of triangles)|12"):
        lrbscope.explain_pair(cube, cube, pair)
