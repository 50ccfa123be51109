"""collide(), contacts() and batches, against brute force."""

import inspect

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError, collide
from shapes import ball_arrays, brute_pairs, cube_arrays, placed, random_poses, shifted


def test_relations(cube):
    small = Body(*cube_arrays(0.25, 0.3))
    for pose, relation in [
        (shifted(0.5, 0.25, 0.125), "crossing"),
        (shifted(1, 0, 0), "touching"),
        (shifted(0.5, 0, 0), "touching"),
        (shifted(1.0000000001, 0, 0), "separate"),
    ]:
        assert collide(cube, cube, pose).relation == relation
    assert collide(small, cube).relation == "a_inside_b" and collide(cube, small).relation == "b_inside_a"
    assert bool(collide(small, cube)) and not collide(cube, cube, shifted(9, 0, 0))


def test_pairs_are_those_of_brute_force(rng):
    (va, fa), (vb, fb) = ball_arrays(2), ball_arrays(1, 0.8)
    va, vb = va * rng.uniform(0.9, 1.1, (len(va), 1)), vb * rng.uniform(0.9, 1.1, (len(vb), 1))
    a, b = Body(va, fa), Body(vb, fb)
    pose_a = random_poses(rng, 1, 1)[0]
    poses = random_poses(rng, 60, 1.6)
    found = collide(a, b, poses, pose_a)
    for pose, result in zip(poses, found):
        wanted = brute_pairs(placed(va, pose_a), fa, placed(vb, pose), fb)
        assert np.array_equal(result.pairs, wanted)
        assert result.relation == "crossing" if len(wanted) else result.relation != "crossing"
        assert result.crosses.all()
    assert 10 < found.hits.sum() < 60


def test_one_query_on_several_threads():
    big = Body(*ball_arrays(5))
    alone, *others = (collide(big, big, threads=n) for n in (1, 2, 5, 0))
    assert len(alone.pairs) > 10_000
    for other in others:
        assert np.array_equal(other.pairs, alone.pairs) and np.array_equal(other.crosses, alone.crosses)
        assert (other.relation, other.counters) == (alone.relation, alone.counters)
    with pytest.raises(InputError, match="threads"):
        collide(big, big, threads=-1)


def test_one_pose_and_many_agree(ball, rng):
    poses = random_poses(rng, 40, 1.5)
    for threads in (1, 2, 5):
        many = collide(ball, ball, poses, threads=threads)
        assert len(many) == 40
        for pose, result in zip(poses, many):
            one = collide(ball, ball, pose)
            assert (one.relation, one.fingerprint) == (result.relation, result.fingerprint)
            assert one.counters == result.counters
    assert many.counts.tolist() == [len(r.pairs) for r in many]
    assert many.relations.tolist() == [r.relation for r in many]
    assert many.fingerprints.tolist() == [r.fingerprint for r in many]
    assert many.hits.tolist() == [bool(r) for r in many]
    rows = many.all_pairs
    assert np.array_equal(rows[rows[:, 0] == 7][:, 1:], many[7].pairs)


def test_results_are_a_sequence(cube):
    many = collide(cube, cube, [shifted(x, 0.2, 0.1) for x in (0.5, 3, 0.25)])
    assert [r.relation for r in many[::2]] == ["crossing", "crossing"]
    assert many[-1].fingerprint == many[2].fingerprint
    with pytest.raises(IndexError):
        many[3]
    assert len(collide(cube, cube, [])) == 0 and len(collide(cube, cube, np.empty((0, 4, 4)))) == 0


def test_pairs_outlive_their_result(ball):
    pairs = collide(ball, ball, [shifted(1.1, 0.3, 0.2)] * 2)[1].pairs
    assert np.array_equal(pairs, collide(ball, ball, shifted(1.1, 0.3, 0.2)).pairs)
    assert not pairs.flags.writeable and not pairs.flags.owndata


@pytest.mark.parametrize("shape", [(4, 4), (3, 4)])
def test_shapes_and_types_of_poses(cube, shape):
    pose = shifted(0.5, 0.25, 0.125)[: shape[0]]
    wanted = collide(cube, cube, shifted(0.5, 0.25, 0.125)).fingerprint
    wide = np.zeros((shape[0], 8))
    wide[:, ::2] = pose
    for given in (pose, pose.astype(np.float32), pose.tolist(), np.asfortranarray(pose), wide[:, ::2]):
        assert collide(cube, cube, given).fingerprint == wanted
        assert collide(cube, cube, [given])[0].fingerprint == wanted
    assert collide(cube, cube, shifted(0, 0, 0), pose).relation == "crossing"


@pytest.mark.parametrize(
    ("pose", "said"),
    [
        (np.eye(3), r"poses_b: expected numbers of shape \(4, 4\) or \(k, 4, 4\), got shape \(3, 3\)"),
        (np.zeros((2, 2, 4, 4)), "poses_b: "),
        (np.zeros(16), r"poses_b: .*got shape \(16,\)"),
        ("text", "poses_b: expected numbers"),
        (np.full((4, 4), "x"), "poses_b: expected numbers"),
        (np.eye(4) * 2, "poses_b: the last row of a pose must be 0 0 0 1"),
        (np.eye(4) * np.nan, "poses_b: the last row"),
        (shifted(np.nan, 0, 0), "finite numbers"),
        (shifted(0, np.inf, 0), "finite numbers"),
        (np.diag([1e308, 1, 1, 1]) * 1.0 + shifted(1.7e308, 0, 0) - np.eye(4), "exceeds 1.8e308"),
    ],
)
def test_poses_that_are_refused(cube, pose, said):
    with pytest.raises(InputError, match=said) as error:
        collide(cube, cube, pose)
    assert "\n" not in str(error.value)


def test_arguments_that_are_refused(cube):
    with pytest.raises(TypeError, match="a: expected a Body, got str"):
        collide("cube", cube)
    with pytest.raises(TypeError, match="b: expected a Body, got None"):
        collide(cube, None)
    with pytest.raises(InputError, match='mode: "some" is not one of all, first or any'):
        collide(cube, cube, mode="some")
    with pytest.raises(InputError, match=r"pose_a: expected shape \(4, 4\)"):
        collide(cube, cube, pose_a=np.zeros((2, 4, 4)))
    with pytest.raises(InputError, match="max_tests: expected an integer of at least 0"):
        collide(cube, cube, max_tests=-1)
    with pytest.raises(TypeError, match="contacts: expected True or False"):
        collide(cube, cube, contacts=1)
    with pytest.raises(TypeError, match="tolerance: expected a number"):
        collide(cube, cube, tolerance="1")
    with pytest.raises(InputError, match="tolerance: expected a finite number of at least 0, got -1"):
        collide(cube, cube, tolerance=-1)
    with pytest.raises(TypeError, match=r"^collide\(\): missing a required argument: 'b'$"):
        collide(cube)
    with pytest.raises(TypeError, match=r"^Body\(\): missing a required argument: 'vertices'$"):
        lrbscope.Body()
    for name, thing in inspect.getmembers(lrbscope._core, lambda x: inspect.isbuiltin(x) or inspect.isclass(x)):
        if not name.startswith("_") and not (inspect.isclass(thing) and issubclass(thing, Exception)):
            with pytest.raises(TypeError, match="^[^\n]*$"):
                thing(nonsense=1)


def test_an_error_in_a_batch_is_that_of_the_first_pose(cube):
    poses = np.tile(np.eye(4), (100, 1, 1))
    poses[40, 0, 3] = np.nan
    with pytest.raises(InputError, match="finite numbers"):
        collide(cube, cube, poses)


def test_separation(ball):
    found = collide(ball, ball, shifted(2.5, 0, 0), separation=True)
    assert found.relation == "separate" and found.separation["faces_a"] >= 4
    assert collide(ball, ball, shifted(1, 0, 0), separation=True).separation is None


def test_counters_and_opened_regions(ball):
    r = collide(ball, ball, shifted(1.5, 0.4, 0.3))
    assert r.counters["face_tests"] >= len(r.pairs) > 0
    assert r.counters["regions_opened"] == sum(len(side) for side in r.opened) > 0


def test_too_many_pairs_are_refused(ball):
    with pytest.raises(InputError, match="pairs"):
        collide(ball, ball, shifted(1.1, 0.3, 0.2), max_pairs=2)


def test_contacts(cube):
    regions = lrbscope.contacts(cube, cube, shifted(0.5, 0.25, 0.125))
    assert len(regions) == 1
    region = regions[0]
    (points, closed), *others = region.curves
    assert closed and not others and points.shape[1] == 3
    lengths = np.linalg.norm(np.diff(np.vstack([points, points[:1]]), axis=0), axis=1)
    assert np.isclose(lengths.sum(), region.length)
    assert np.isclose(np.linalg.norm(region.normal), 1) and region.depth_estimate > 0
    assert sorted(region.pairs) == list(range(len(region.pairs)))
    assert points.min() >= 0 and points.max() <= 1
    many = lrbscope.contacts(cube, cube, [shifted(0.5, 0.25, 0.125), shifted(9, 0, 0)])
    assert [len(r) for r in many] == [1, 0]


def test_points_of_contact(cube):
    r = collide(cube, cube, shifted(0.5, 0.25, 0.125), contacts=True)
    points, pair = r.points
    assert len(points) == len(pair) and set(pair) == set(range(len(r.pairs)))
    on_a = np.isclose(points, 0) | np.isclose(points, 1)
    assert on_a.any(axis=1).all()
    assert r.interiors_overlap in (True, None)
    assert collide(cube, cube, shifted(0.5, 0, 0), interiors_overlap=True).interiors_overlap is True
    assert collide(cube, cube, shifted(1, 0, 0), interiors_overlap=True).interiors_overlap is False


def test_touching_pairs_do_not_cross(cube):
    r = collide(cube, cube, shifted(1, 0, 0))
    assert r.relation == "touching" and len(r.pairs) > 0 and not r.crosses.any()


def test_pairs_of_bodies(cube, ball, rng):
    poses = random_poses(rng, 20, 1.5)
    found = lrbscope.collide_pairs([cube, ball] * 10, np.tile(np.eye(4), (20, 1, 1)), [ball] * 20, poses)
    for i, (pose, result) in enumerate(zip(poses, found)):
        assert result.fingerprint == collide([cube, ball][i % 2], ball, pose).fingerprint
    assert lrbscope.collide_pairs([], [], [], []) == []
    with pytest.raises(InputError, match="poses_b: expected as many as bodies_b, 1, got 2"):
        lrbscope.collide_pairs([cube], [np.eye(4)], [ball], [np.eye(4)] * 2)


def test_affine_poses(cube):
    flat = np.diag([1.0, 1.0, 0.0, 1.0]) @ shifted(0.5, 0.5, 0)
    assert collide(cube, cube, shifted(0, 0, 0.5) @ flat).relation in ("crossing", "touching")
    mirrored = np.diag([-2.0, 2.0, 2.0, 1.0]) @ shifted(-0.2, 0.1, 0.05)
    assert collide(cube, cube, mirrored).relation == "crossing"
