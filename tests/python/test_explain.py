"""Queries of bodies that move by little, and explanations."""

import numpy as np
import pytest

import lrbscope
from lrbscope import CoherentQuery
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


def test_pairs_are_explained(cube):
    pose = shifted(0.5, 0.25, 0.125)
    meeting = {tuple(p) for p in lrbscope.collide(cube, cube, pose).pairs.tolist()}
    for i, j in ((0, 0), (3, 4), *sorted(meeting)[:3]):
        e = lrbscope.explain_pair(cube, cube, (i, j), pose)
        assert e.meet == ("cross" if (i, j) in meeting else "disjoint") and len(e.hidden_by) == 2
        assert (e.distance > 0) == (e.meet == "disjoint") and e.points.shape[1] == 3
        as_dict = e.dict()
        assert as_dict["pair"] == [i, j] and as_dict["meet"] == e.meet and as_dict["decided_by"] == e.decided_by
        assert str(e).startswith(f"simplex {i} of A") and e.meet in str(e)


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
