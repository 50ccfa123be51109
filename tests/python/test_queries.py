"""What Python adds to queries: arrays and their types, batches, threads, errors. tests/matrix checks the answers."""

import inspect

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError, clash, collide, distance, fcl, first_contact
from lrbscope.collision import CollisionManager
from shapes import Mesh, ball_arrays, bvh_model, cube_arrays, open_cube_arrays, random_poses, shifted

CROSSING = shifted(0.5, 0.25, 0.125)


def motions_to(poses):
    """Return straight motions that end at poses, (k, 2, 4, 4)."""
    starts = poses.copy()
    starts[:, 0, 3] += 4
    return np.stack([starts, poses], axis=1)


def of_region(regions):
    return [(r.pairs.tolist(), r.centroid.tolist(), r.normal.tolist(), r.depth_estimate) for r in regions]


# Queries of many poses, and their answers as plain values.
BATCHES = {
    "collide": (collide, lambda r: (r.relation, r.fingerprint, r.pairs.tolist(), r.counters)),
    "contacts": (lrbscope.contacts, of_region),
    "distance": (distance, lambda d: (d.lower, d.upper, d.relation, d.points.tolist(), d.faces, d.features)),
    "clash": (clash, lambda c: (c.kind, c.depth, c.volume, c.translation.tolist())),
    "first_contact": (first_contact, lambda f: (f.outcome, f.t0, f.t1, f.pair, f.normal.tolist())),
}


@pytest.mark.parametrize("name", BATCHES)
def test_batches_have_the_answers_of_single_queries(name, rng):
    query, values = BATCHES[name]
    count = 6 if query is clash else 24
    ball, poses = Body(*ball_arrays(1)), random_poses(rng, count, 1.5)
    given = motions_to(poses) if query is first_contact else poses
    single = [values(query(ball, ball, pose)) for pose in given]
    for threads in (1, 2, 5):
        many = query(ball, ball, given, threads=threads)
        assert len(many) == count and [values(r) for r in many] == single
    assert len({str(v) for v in single}) > count / 3
    if query is not first_contact:
        assert len(query(ball, ball, [])) == len(query(ball, ball, np.empty((0, 4, 4)))) == 0
        bad = np.tile(np.eye(4), (100, 1, 1))
        bad[40, 0, 3] = np.nan
        with pytest.raises(InputError, match="finite numbers"):
            query(ball, ball, bad)


def test_arrays_of_batches(ball, rng):
    poses = random_poses(rng, 24, 1.5)
    many = collide(ball, ball, poses)
    assert many.counts.tolist() == [len(r.pairs) for r in many]
    assert many.relations.tolist() == [r.relation for r in many]
    assert many.fingerprints.tolist() == [r.fingerprint for r in many]
    assert many.hits.tolist() == [bool(r) for r in many] and 5 < many.hits.sum()
    rows = many.all_pairs
    assert np.array_equal(rows[rows[:, 0] == 7][:, 1:], many[7].pairs)
    assert [r.fingerprint for r in many[::2]] == many.fingerprints[::2].tolist()
    assert many[-1].fingerprint == many[23].fingerprint
    for answers in (many, distance(ball, ball, poses)):
        with pytest.raises(IndexError):
            answers[24]
    near = distance(ball, ball, poses)
    assert near.upper.tolist() == [d.upper for d in near] and near.lower.tolist() == [d.lower for d in near]
    small = Body(*ball_arrays(1))
    moved = first_contact(small, small, motions_to(poses))
    assert moved.t0.tolist() == [f.t0 for f in moved] and moved.t1.tolist() == [f.t1 for f in moved]


def test_views_outlive_their_result(ball):
    pairs = collide(ball, ball, [shifted(1.1, 0.3, 0.2)] * 2)[1].pairs
    assert np.array_equal(pairs, collide(ball, ball, shifted(1.1, 0.3, 0.2)).pairs)
    assert not pairs.flags.writeable and not pairs.flags.owndata
    query = lrbscope.CoherentQuery(ball, ball, always=True)
    kept = [query.collide(shifted(x, 0.3, 0.2)) for x in np.linspace(1.1, 1.098, 5)]
    assert np.array_equal(kept[0].pairs, pairs) and query.a is ball and query.statistics["from_cache"] > 0


def test_pairs_and_planes_are_explained(cube):
    pose = shifted(0.5, 0.25, 0.125)
    pair = collide(cube, cube, pose).pairs[0]
    why = lrbscope.explain_pair(cube, cube, pair, pose)
    assert (why.meet, why.distance, why.dict()["pair"]) == ("cross", 0, pair.tolist())
    normal, of_a, of_b = lrbscope.explain_walk(cube, cube, shifted(2.5, 0, 0)).plane
    assert (cube.vertices @ normal).max() <= of_a + 1e-12 < of_b <= ((cube.vertices + [2.5, 0, 0]) @ normal).min() + 1e-12


def test_meshes_of_other_libraries_are_bodies(cube):
    """Objects with vertices and faces, as trimesh has them, or triangles, as Open3D."""
    mesh = Mesh(*cube_arrays())
    triangles = type("TriangleMesh", (), {"vertices": mesh.vertices.tolist(), "triangles": mesh.faces.tolist()})()
    wanted = collide(cube, cube, CROSSING).fingerprint
    for given in (mesh, triangles):
        assert collide(given, cube, CROSSING).fingerprint == collide(cube, given, CROSSING).fingerprint == wanted
        assert np.isclose(distance(given, given, shifted(3, 0, 0)).upper, 2)
        assert lrbscope.CoherentQuery(given, given).collide(CROSSING).fingerprint == wanted
        assert len(lrbscope.signed_distance(given, np.eye(3))) == 3
        scene = lrbscope.Scene()
        assert scene.body(scene.add(given)).real_face_count == 12 and scene.any_meet(given, CROSSING)
    assert [r.pairs.size for r in collide(mesh, triangles, [CROSSING] * 200)] == [24] * 200


def test_answers_do_not_depend_on_threads(ball):
    big = Body(*ball_arrays(5))
    alone, *others = (collide(big, big, threads=n) for n in (1, 2, 0))
    assert len(alone.pairs) > 10_000
    for other in others:
        assert np.array_equal(other.pairs, alone.pairs) and other.counters == alone.counters
    for query, limit in ((lrbscope.near_pairs, "within"), (lrbscope.contact_manifolds, "margin")):
        one, two = (query(ball, ball, shifted(1.9, 0.1, 0.2), **{limit: 0.3}, threads=n) for n in (1, 2))
        assert (one.points == two.points).all() and len(one) > 0


BOTH = "cube, cube, "
REFUSED = [
    (f"collide({BOTH}threads=-1)", InputError, "threads"),
    ("lrbscope.CoherentQuery(cube, cube).collide(np.eye(3))", InputError, "pose_b"),
    (f"collide({BOTH}np.eye(4) * 2)", InputError, "poses_b: the last row of a pose must be 0 0 0 1"),
    (f"collide({BOTH}np.diag([1e308, 1, 1, 1]) + shifted(1.7e308, 0, 0) - np.eye(4))", InputError, "exceeds 1.8e308"),
    ("collide('cube', cube)", TypeError, "a: expected a Body, got str"),
    ("collide(cube, None)", TypeError, "b: expected a Body, got None"),
    ("collide(cube)", TypeError, r"^collide\(\): missing a required argument: 'b'$"),
    ("lrbscope.collide_pairs(3, [np.eye(4)], [cube], [np.eye(4)])", TypeError, "bodies_a: expected a sequence of bodies, got int"),
    ("Body.save(None, 'x')", TypeError, "got an object of another class"),
    ("CollisionManager().in_collision_other(None)", TypeError, "expected a CollisionManager"),
    ("CollisionManager().min_distance_other((cube, np.eye(4)))", TypeError, "got tuple"),
    ("Body()", TypeError, r"^Body\(\): missing a required argument: 'vertices'$"),
    (f"collide({BOTH}mode='some')", InputError, 'mode: "some" is not one of all, first or any'),
    (f"collide({BOTH}pose_a=[np.eye(4)] * 2)", InputError, r"pose_a: expected numbers of shape \(4, 4\), got 2 poses"),
    (f"collide({BOTH}max_tests=-1)", InputError, "max_tests: expected an integer of at least 0"),
    (f"collide({BOTH}contacts=1)", TypeError, "contacts: expected True or False"),
    (f"collide({BOTH}tolerance='1')", TypeError, "tolerance: expected a number"),
    ("lrbscope.collide_pairs([cube], [np.eye(4)], [cube], [np.eye(4)] * 2)", InputError, "poses_b: expected as many"),
    (f"first_contact({BOTH}[])", InputError, "motion_b: expected at least one pose, got none"),
    (f"first_contact({BOTH}[shifted(3, 0, 0), np.diag([2.0, 1, 1, 1])])", InputError, ""),
    (f"lrbscope.near_pairs({BOTH}within=None)", InputError, "within"),
    (f"lrbscope.contact_manifolds({BOTH}previous=3)", InputError, "previous"),
    ("lrbscope.explain_pair(cube, cube, (0, 12))", InputError, "simplex of B: expected a number below 12"),
    ("lrbscope.explain_pair(cube, cube, (0, -1))", InputError, "pair: expected numbers of triangles"),
    ("lrbscope.CoherentQuery(3, cube)", TypeError, "a: expected"),
    (r"Body.load('a\udcff')", InputError, r"\\xff"),
    (r"Body(*cube_arrays(), name='a\udcff')", InputError, "name: expected a valid Unicode string"),
    (r"Body(*cube_arrays(), **{'a\udcff': 1})", TypeError, r"unexpected keyword argument 'a\\udcff'"),
    ("Body.load(3)", TypeError, "expected a path, got int"),
    ("Body(*cube_arrays(), lean='yes')", TypeError, "lean: expected True or False, got str"),
    ("Body(*cube_arrays(), threads=-1)", InputError, "threads: expected an integer of at least 0, got -1"),
    ("Body(*cube_arrays(), seed=0.5)", TypeError, "seed: expected an integer, got float"),
    ("Body(*cube_arrays(), max_lids=2000)", InputError, "max_lids: expected at most 1000, got 2000"),
    ("Body(*cube_arrays(), lean=True, merge_planes=True)", InputError, "merge planes"),
    ("Body(*cube_arrays(), progress='yes')", TypeError, "progress: expected a callable, True or None"),
    ("Body(np.eye(3), [[0, 1]])", InputError, "faces: face 0 has 2 corners"),
    ("Body(np.eye(3), [[0, 1, 2], [0, 1, 2.5, 3]])", InputError, "faces: face 1: expected integers"),
    ("lrbscope.Wrapper(cube, 'neither')", InputError, "mode"),
    ("lrbscope.Wrapper.at(cube, -1)", InputError, "tolerance"),
    ("lrbscope.Wrapper(cube).refine(10**6)", InputError, "region: expected a number below"),
    ("lrbscope.Wrapper(cube).refine_face(10**6)", InputError, "face: expected a number below"),
    ("scene.remove(7)", InputError, "key: no body 7 in the scene"),
    ("scene.move(7, np.eye(4))", InputError, "key: no body 7 in the scene"),
    ("scene.move([0], np.tile(np.eye(4), (2, 1, 1)))", InputError, r"keys: expected integers of shape \(2,\), got shape"),
    ("scene.collide(3)", TypeError, "other: expected a Scene or a Body, got int"),
    ("scene.collide(scene)", InputError, "other: expected another scene"),
    ("scene.collide(pose=np.eye(4))", InputError, "pose: only allowed if"),
    ("scene.near(-1)", InputError, "within: expected a number of at least 0"),
    ("scene.add('cow')", TypeError, "body: expected"),
    ("lrbscope.trace(cube, cube, events='none')", InputError, "events"),
    ("lrbscope.render(cube, size=(3, 3))", InputError, "size: expected two numbers from 16 to 8192, got 3"),
    ("lrbscope.render(cube, view_from=(0, 0, 0))", InputError, "view_from: expected a direction"),
    ("lrbscope.render(cube, up=(0, 1))", InputError, r"up: expected numbers of shape \(3,\)"),
    ("lrbscope.render(cube, up='xy')", InputError, "up: expected three numbers, 'x'"),
    ("lrbscope.render(cube, zoom=0)", InputError, "zoom: expected"),
    ("lrbscope.render(cube, colour_by='taste')", InputError, "colour_by: "),
    ("lrbscope.render(cube, colour_by='box_tests')", InputError, "two bodies"),
    ("lrbscope.Wrapper(lrbscope.Wrapper(cube))", TypeError, "body: expected a Body, got Wrapper"),
]


def test_what_is_refused(cube):
    """Errors are one line that names the argument."""
    scene = lrbscope.Scene()
    scene.add(cube)
    for call, kind, said in REFUSED:
        with pytest.raises(kind, match=said) as error:
            eval(call, {**globals(), "cube": cube, "scene": scene})
        assert "\n" not in str(error.value), call
    for name, thing in inspect.getmembers(lrbscope._core, lambda x: inspect.isbuiltin(x) or inspect.isclass(x)):
        if not name.startswith("_") and not (inspect.isclass(thing) and issubclass(thing, Exception)):
            with pytest.raises(TypeError, match="^[^\n]*$"):
                thing(nonsense=1)


def test_members_of_results(cube, ball):
    r = collide(cube, cube, CROSSING, contacts=True)
    points, pair = r.points
    assert len(points) == len(pair) and set(pair) == set(range(len(r.pairs)))
    assert (np.isclose(points, 0) | np.isclose(points, 1)).any(axis=1).all()
    (region,) = r.regions
    ((curve, closed),) = region.curves
    lengths = np.linalg.norm(np.diff(np.vstack([curve, curve[:1]]), axis=0), axis=1)
    (half_edges,) = region.half_edges
    assert half_edges.shape == (len(curve), 5) and set(half_edges[:, 0]) <= set(region.pairs)
    assert closed and np.isclose(lengths.sum(), region.length) and region.pairs.tolist() == list(range(12))
    assert collide(cube, cube, shifted(0.5, 0, 0), interiors_overlap=True).interiors_overlap is True
    assert collide(cube, cube, shifted(1, 0, 0), interiors_overlap=True).interiors_overlap is False
    assert not collide(cube, cube, shifted(1, 0, 0)).crosses.any()
    far = collide(ball, ball, shifted(2.5, 0, 0), separation=True)
    assert far.separation["faces_a"] >= 4 and not far
    opened = collide(ball, ball, shifted(1.5, 0.4, 0.3))
    assert opened.counters["regions_opened"] == sum(len(side) for side in opened.opened) > 0
    found = lrbscope.collide_pairs([cube, ball] * 2, [np.eye(4)] * 4, [ball] * 4, [CROSSING] * 4)
    assert [f.fingerprint for f in found] == [collide(x, ball, CROSSING).fingerprint for x in (cube, ball) * 2]


def test_members_of_distances(cube):
    d = distance(cube, cube, shifted(3, 0, 0))
    assert d.lower <= 2 <= d.upper == float(d) and d.points[:, 0].tolist() == [1, 3] and d.solids == (d.lower, d.upper)
    corner = distance(cube, cube, shifted(2, 2, 2))
    assert corner.features == ("corner", "corner") and [c.tolist() for c in corner.corners] == [[7], [0]]
    assert corner.faces == corner.triangles and corner.counters["box_tests"] > 0
    inside = distance(Body(*cube_arrays(0.5, 0.25)), cube)
    assert not inside.meet and inside.solids == (0, 0) and inside.relation == "a_inside_b"
    assert [distance(cube, cube, shifted(3, 0, 0), within=w).within for w in (2.5, 1.5, None)] == [True, False, None]
    signed = lrbscope.signed_distance(cube, [[0.5, 0.5, 0.75], [2, 0.5, 0.5], [1, 0.5, 0.25]])
    assert signed.side.tolist() == [-1, 1, 0] and np.allclose(signed.lower, [-0.25, 1, 0])
    assert signed.points[1].tolist() == [1, 0.5, 0.5] and signed.faces.shape == (3,)
    sheet = lrbscope.signed_distance(Body(*open_cube_arrays()), [[0.5, 0.5, 0.75]])
    assert sheet.side.tolist() == [2] and sheet.lower[0] > 0 and len(lrbscope.signed_distance(cube, [])) == 0


def test_members_of_clashes_and_first_contacts(cube):
    c = clash(cube, cube, shifted(0.75, 0.25, 0.125), along=(0, 2, 0))
    assert c.kind == "protrudes" and c.interiors_overlap is True and c.shares_faces is False and c.reason is None
    assert c.depth[0] <= 0.25 <= c.depth[1] and np.isclose(np.linalg.norm(c.translation), c.depth[1])
    assert c.along[0] <= 0.75 <= c.along[1] and np.isclose(c.volume[1], 0.25 * 0.75 * 0.875)
    assert clash(cube, cube, CROSSING, depth=False, volume=False, max_steps=1000).volume is None
    assert clash(cube, Body(*open_cube_arrays()), CROSSING).reason == "B bounds no solid"
    f = first_contact(cube, cube, [shifted(3, 0.1, 0.2), shifted(0, 0.1, 0.2)])
    assert f and f.outcome == "contact" and f.t0 <= 2 / 3 <= f.t1 and f.at_begin == "separate"
    assert np.allclose(f.normal, (1, 0, 0)) and np.isclose(f.speed, 3) and len(f.pair) == 2
    never = first_contact(cube, cube, [shifted(3, 0, 0), shifted(2, 5, 0)])
    assert not never and never.t0 == never.t1 == 1 and never.pair is None
    assert first_contact(cube, cube, CROSSING).at_start


def test_columns_of_near_pairs_and_manifolds(cube, ball):
    pairs = lrbscope.near_pairs(cube, cube, shifted(3, 0, 0), within=2)
    assert len(pairs) == pairs.found == 62 and not pairs.meet.any() and (pairs.upper == 2).all()
    assert (pairs.points[:, :, 0] == [1, 3]).all() and pairs.faces.tolist() == pairs.triangles.tolist()
    assert len(lrbscope.near_pairs(cube, cube, shifted(3, 0, 0), within=2, nearest=5)) == 5
    sunk = lrbscope.contact_manifolds(cube, cube, shifted(0.125, 0.25, 0.875))
    assert sunk.normals.tolist() == [[0, 0, 1]] and sunk.depths.tolist() == [0.125] * 4
    assert sunk.ids.tolist() == [0, 1, 2, 3] and sunk.features.shape == (4, 2, 3)
    assert np.abs(sunk.points[:, 0] - sunk.points[:, 1] - [0, 0, 0.125]).max() < 1e-15
    moved = lrbscope.contact_manifolds(cube, cube, shifted(0.126, 0.25, 1.001), margin=0.01, previous=sunk)
    assert sorted(moved.ids.tolist()) == [0, 1, 2, 3] and moved.intersects.tolist() == [False]
    apart = lrbscope.contact_manifolds(cube, cube, shifted(3, 0, 0))
    assert len(apart) == 0 and apart.points.shape == (0, 2, 3) and apart.pairs == []


def box(low, high):
    return cube_arrays(np.subtract(high, low), low)


UNIT, PLATE = box((0, 0, 0), (1, 1, 1)), box((-5, -5, -1), (5, 5, 0))
SUNK, WALL, OTHER_WALL = (
    box((-0.1, -0.1, -0.05), (0.1, 0.1, 0.15)),
    box((0, 0, 0), (4, 0.3, 3)),
    box((3.9, 0, 0), (4.2, 3, 3)),
)


@pytest.mark.parametrize(
    ("a", "b", "moved", "depth", "normal"),
    [
        (UNIT, UNIT, (0.75, 0, 0), 0.25, (1, 0, 0)),
        (UNIT, UNIT, (0.75, 0.25, 0.25), 0.25, (1, 0, 0)),
        (PLATE, SUNK, (0, 0, 0), 0.05, (0, 0, 1)),
        (PLATE, SUNK, (5, 0, 0), 0.05, (0, 0, 1)),
        (WALL, OTHER_WALL, (0, 0, 0), 0.1, (1, 0, 0)),
    ],
)
def test_contacts_have_depth_and_normal_of_the_overlap(a, b, moved, depth, normal):
    """Boxes, for which the separating axis test gives both; FCL #106, #503, IfcOpenShell #2430, Coal #357."""
    one, other, pose = Body(*a), Body(*b), shifted(*moved)
    (region,) = lrbscope.contacts(one, other, pose)
    assert np.allclose(region.normal, normal) and np.isclose(region.depth_estimate, depth)
    (again,) = collide(one, other, pose, contacts=True).regions
    assert (again.depth_estimate, again.normal.tolist()) == (region.depth_estimate, region.normal.tolist())
    manager = lrbscope.CollisionManager()
    manager.add_object("b", other, pose)
    found = [(c.depth, c.normal) for c in manager.in_collision_single(one, return_data=True)[1]]
    result, place = fcl.CollisionResult(), fcl.Transform(np.array(moved))
    objects = fcl.CollisionObject(bvh_model(*a)), fcl.CollisionObject(bvh_model(*b), place)
    fcl.collide(*objects, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result)
    of_fcl = [(c.penetration_depth, c.normal) for c in result.contacts]
    assert len(found) == len(of_fcl) > 0 and str(found) == str(of_fcl)
    deepest = 0.1 if moved == (5, 0, 0) else depth  # over the edge of the plate there is another side
    assert {True} == {np.isclose(d, depth) or np.isclose(d, deepest) for d, _ in found}
    assert any(np.allclose(n, normal) for _, n in found)


def test_wrappers(ball):
    w = lrbscope.Wrapper(ball)
    outermost, region = w.faces, w.region_behind(w.faces[~w.is_real][0])
    assert w.includes(region) and w.refine(region) and not w.refine(region) and not w.includes(region)
    assert w.excluded.tolist() == [region] and w.region_behind(0) is None and len(w) > len(outermost)
    assert w.coarsen(region) and np.array_equal(w.faces, outermost)
    w.refine_all()
    assert np.array_equal(w.triangles, ball.triangles) and len(w.excluded) == ball.region_count
    w.reset()
    assert len(w.excluded) == 0 and lrbscope.Wrapper(ball, "unregularised").refine_face(outermost[0])
    sizes = [len(lrbscope.Wrapper.at(ball, t)) for t in (0, 1, 10)]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] == ball.real_face_count > sizes[1]
    kept = lrbscope.Wrapper(Body(*ball_arrays(2)))  # keeps its body
    kept.refine_all()
    assert len(kept) == kept.body.real_face_count
