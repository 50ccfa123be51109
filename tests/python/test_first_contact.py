"""first_contact(), against known times and exact queries."""

import numpy as np
import pytest

import lrbscope
from lrbscope import InputError, first_contact
from shapes import random_poses, shifted


def test_cubes(cube):
    f = first_contact(cube, cube, [shifted(3, 0.1, 0.2), shifted(0, 0.1, 0.2)])
    assert f and f.outcome == "contact" and f.t0 <= 2 / 3 <= f.t1 and f.t1 - f.t0 <= 1e-9
    assert f.at_begin == "separate" and not f.at_start and f.finished
    assert np.allclose(f.normal, (1, 0, 0)) and np.isclose(f.speed, 3)
    assert np.allclose(f.points[:, 0], 1, atol=1e-6) and len(f.pair) == 2
    never = first_contact(cube, cube, [shifted(3, 0, 0), shifted(2, 5, 0)])
    assert not never and never.outcome == "never" and never.t0 == never.t1 == 1 and never.pair is None
    assert first_contact(cube, cube, shifted(0.5, 0.25, 0.125)).at_start


def test_no_contact_before_and_one_at_the_end(ball, cube, rng):
    starts, ends = random_poses(rng, 12, 4), random_poses(rng, 12, 2)
    motions = np.stack([starts, ends], axis=1)
    motions[:, 1, :3, :3] = motions[:, 0, :3, :3]  # straight, so that poses in between are known
    found = first_contact(ball, cube, motions, tolerance=1e-6)
    assert len(found) == 12 and any(found)
    for motion, f, t0, t1 in zip(motions, found, found.t0, found.t1):
        assert (f.t0, f.t1) == (t0, t1)
        along = np.linspace(0, max(t0 - 1e-6, 0), 20)[:, None, None]
        before = lrbscope.collide(ball, cube, (1 - along) * motion[0] + along * motion[1], mode="any")
        if not f.at_start:
            assert not before.counts.any()
        if f:
            assert lrbscope.collide(ball, cube, (1 - t1) * motion[0] + t1 * motion[1]).pairs.size or f.passed


def test_threads_and_one_by_one(cube, rng):
    motions = np.stack([random_poses(rng, 6, 3), random_poses(rng, 6, 3)], axis=1)
    found = [first_contact(cube, cube, motions, threads=n).t0.tolist() for n in (1, 3)]
    assert found[0] == found[1] == [first_contact(cube, cube, m).t0 for m in motions]


def test_what_is_refused(cube):
    with pytest.raises(InputError, match="tolerance"):
        first_contact(cube, cube, [shifted(3, 0, 0), shifted(0, 0, 0)], tolerance=0)
    with pytest.raises(InputError, match="motion_b: expected numbers"):
        first_contact(cube, cube, "there")
    with pytest.raises(InputError, match="motion_b: expected at least one pose, got none"):
        first_contact(cube, cube, [])
    with pytest.raises(InputError):
        first_contact(cube, cube, [shifted(3, 0, 0), np.diag([2.0, 1, 1, 1])])
    with pytest.raises(TypeError, match="a: expected a Body"):
        first_contact(None, cube, shifted(3, 0, 0))
