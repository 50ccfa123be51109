"""lrbscope.fcl: the interface of python-fcl."""

import copy
import pickle

import numpy as np
import pytest

from lrbscope import InputError, fcl
from shapes import ball_arrays, cube_arrays, square_arrays


def model(vertices, faces):
    m = fcl.BVHModel()
    m.beginModel(len(vertices), len(faces))
    m.addSubModel(vertices, faces)
    m.endModel()
    return m


def at(x, y=0.0, z=0.0):
    return fcl.Transform(np.array([x, y, z], dtype=float))


TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def test_transforms():
    q = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])
    t = np.array([1.0, 2, 3])
    for args, r, moved in [
        ((), np.eye(3), np.zeros(3)),
        ((q,), TURN, np.zeros(3)),
        ((TURN,), TURN, np.zeros(3)),
        ((t,), np.eye(3), t),
        ((q, t), TURN, t),
        ((TURN, t), TURN, t),
        ((fcl.Transform(TURN, t),), TURN, t),
    ]:
        tf = fcl.Transform(*args)
        assert np.allclose(tf.getRotation(), r) and np.array_equal(tf.getTranslation(), moved)
    assert np.allclose(fcl.Transform(TURN).getQuatRotation(), q)
    for args in ((np.zeros(5),), (t, t), (q, t, t), (TURN, q)):
        with pytest.raises(ValueError):
            fcl.Transform(*args)


def test_quaternions_of_any_rotation(rng):
    for q in rng.normal(size=(50, 4)):
        q /= np.linalg.norm(q) * np.sign(q[0])
        assert np.allclose(fcl.Transform(q).getQuatRotation(), q)
    for axis in range(3):
        q = np.eye(4)[1 + axis]
        assert np.allclose(abs(fcl.Transform(q).getQuatRotation()), q)


def test_objects_move():
    o = fcl.CollisionObject(fcl.Box(1, 1, 1), at(1, 2, 3))
    o.setTranslation(np.array([4, 5, 6]))
    o.setRotation(TURN)
    assert np.array_equal(o.getTransform().getTranslation(), [4, 5, 6])
    o.setQuatRotation(np.array([1, 0, 0, 0]))
    assert np.allclose(o.getRotation(), np.eye(3))
    o.setTransform(at(9))
    assert o.getTranslation()[0] == 9 and o.getObjectType() == 2 and o.getNodeType() == 9
    for again in (copy.deepcopy(o), pickle.loads(pickle.dumps(o))):
        assert again.getTranslation()[0] == 9


def test_models_are_built_in_order():
    m = fcl.BVHModel()
    with pytest.raises(ValueError, match="correct sequence"):
        m.addSubModel(*cube_arrays())
    m.beginModel(num_tris_=2, num_vertices_=6)
    assert m.addTriangle(np.array([0, 0, 0]), np.array([1, 0, 0]), np.array([0, 1, 0])) is True
    assert m.addSubModel(*cube_arrays()) is True
    assert m.num_tries_() == 13 and m.buildState() == 1
    m.endModel()
    assert m.buildState() == 2 and fcl.CollisionObject(m).body.real_face_count == 13
    with pytest.raises(ValueError, match="triangles: expected integers"):
        bad = fcl.BVHModel()
        bad.beginModel()
        bad.addSubModel(cube_arrays()[0], np.zeros((2, 3)))
    with pytest.raises(InputError, match="expected a vertex index below .*, got 9"):
        model(cube_arrays()[0], [[0, 1, 9]])


def test_meshes_collide():
    m = model(*cube_arrays())
    a, b = fcl.CollisionObject(m), fcl.CollisionObject(m, at(0.5, 0.25, 0.125))
    result = fcl.CollisionResult()
    assert fcl.collide(a, b, fcl.CollisionRequest(), result) == 1 and result.is_collision
    assert result.contacts[0].o1 is m and result.contacts[0].o2 is m
    result = fcl.CollisionResult()
    n = fcl.collide(a, b, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result)
    assert n == len(result.contacts) == 12
    for c in result.contacts:
        assert 0 <= c.b1 < 12 and 0 <= c.b2 < 12 and np.isclose(np.linalg.norm(c.normal), 1)
        assert (c.pos >= (0.5, 0.25, 0.125)).all() and (c.pos <= 1).all() and c.penetration_depth > 0
    assert fcl.collide(a, b, fcl.CollisionRequest(num_max_contacts=5)) == 5
    assert fcl.collide(a, fcl.CollisionObject(m, at(5))) == 0
    small = model(*cube_arrays(0.25, 0.3))
    assert fcl.collide(a, fcl.CollisionObject(small)) == 0, "meshes are surfaces"


def test_shapes_are_solids():
    ball = fcl.CollisionObject(fcl.Sphere(4.0))
    inside = fcl.CollisionObject(fcl.Box(1, 1, 1))
    for pair in ((ball, inside), (inside, ball)):
        result = fcl.CollisionResult()
        assert fcl.collide(*pair, fcl.CollisionRequest(enable_contact=True), result) == 1
        assert result.is_collision
        assert fcl.distance(*pair) == -1
    mesh = fcl.CollisionObject(model(*ball_arrays(2)))
    assert fcl.collide(ball, mesh) == 1
    assert fcl.collide(mesh, fcl.CollisionObject(fcl.Box(0.1, 0.1, 0.1))) == 0


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        (fcl.Box(1, 2, 3), 6),
        (fcl.Sphere(2), 32 / 3 * np.pi),
        (fcl.Ellipsoid(1, 2, 3), 8 * np.pi),
        (fcl.Capsule(1, 2), 2 * np.pi + 4 / 3 * np.pi),
        (fcl.Cone(1, 3), np.pi),
        (fcl.Cylinder(1, 3), 3 * np.pi),
        (fcl.Convex(cube_arrays()[0], 12, np.column_stack([np.full(12, 3), cube_arrays()[1]]).ravel()), 1),
    ],
)
def test_shapes_have_their_volume(shape, volume):
    body = fcl.CollisionObject(shape).body
    corners = body.vertices[body.triangles]
    found = np.einsum("ij,ij", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert body.is_solid and not any("inside out" in note for note in body.notes)
    assert volume * 0.995 < found <= volume * 1.0000001
    assert np.allclose(body.vertices.mean(axis=0)[:2], corners.mean(axis=(0, 1))[:2], atol=1e-6)


def test_shapes_in_the_plane():
    def square(side, corner):
        vertices, faces = square_arrays(side, corner)
        return fcl.CollisionObject(fcl.Convex(vertices, 4, np.insert(faces, 0, 2, axis=1).ravel()), at(2))

    result = fcl.CollisionResult()
    assert fcl.collide(square(1, 0), square(0.5, 0.25), fcl.CollisionRequest(), result) == 1
    assert result.contacts[0].pos.tolist() == [2.25, 0.25, 0]


def test_distances():
    a, b = fcl.CollisionObject(fcl.Sphere(1)), fcl.CollisionObject(fcl.Sphere(1), at(5, 1, 2))
    request, result = fcl.DistanceRequest(enable_nearest_points=True), fcl.DistanceResult()
    found = fcl.distance(a, b, request, result)
    assert abs(found - (np.sqrt(30) - 2)) < 0.005 and result.min_distance == found
    assert np.isclose(np.linalg.norm(result.nearest_points[0] - result.nearest_points[1]), found)
    assert result.o1 is a._geom and result.b1 == -1
    further = fcl.CollisionObject(fcl.Sphere(1), at(50))
    assert fcl.distance(a, further, request, result) > found == result.min_distance
    cube = model(*cube_arrays())
    o, p = fcl.CollisionObject(cube), fcl.CollisionObject(cube, at(0.5, 0.25, 0.125))
    assert fcl.distance(o, p) == 0
    result = fcl.DistanceResult()
    fcl.distance(o, fcl.CollisionObject(cube, at(3)), request, result)
    assert 0 <= result.b1 < 12 and result.nearest_points[0][0] == 1


def test_signed_distances():
    box = fcl.CollisionObject(fcl.Box(1, 1, 1))
    near = fcl.CollisionObject(fcl.Box(1, 1, 1), at(0.75, 0.1, 0.2))
    signed = fcl.DistanceRequest(enable_signed_distance=True)
    result = fcl.DistanceResult()
    assert abs(fcl.distance(box, near, signed, result) + 0.25) < 1e-6 and fcl.distance(box, near) == -1
    # The nearest points are where the boxes touch once the second one is moved away, as far apart as the depth.
    one, other = result.nearest_points
    assert abs(one[0] - 0.5) < 1e-6 and np.allclose(one - other, [0.25, 0, 0], atol=1e-6)


def test_continuous_collisions():
    """What python-fcl's example asks of moving objects, and others."""
    box, cylinder = fcl.Box(1, 2, 3), fcl.Cylinder(2, 2)
    request, result = fcl.ContinuousCollisionRequest(), fcl.ContinuousCollisionResult()
    one, other = fcl.CollisionObject(box, fcl.Transform()), fcl.CollisionObject(cylinder, at(5))
    time = fcl.continuousCollide(one, at(5), other, at(0), request, result)
    assert result.is_collide and result.time_of_contact == time
    # Of the gap of 2.5 at the start 10 would be closed; the box's edge meets a facet.
    assert abs(time - 0.25) < 0.001
    assert fcl.continuousCollide(one, at(-5), other, at(9)) == 1.0
    result = fcl.ContinuousCollisionResult()
    inside = fcl.CollisionObject(fcl.Sphere(0.1))
    assert fcl.continuousCollide(one, at(0), inside, at(0), request, result) == 0 and result.is_collide
    turning = fcl.ContinuousCollisionRequest(ccd_motion_type=fcl.CCDMotionType.CCDM_LINEAR)
    beam = fcl.CollisionObject(fcl.Box(6, 0.1, 0.1))
    post = fcl.CollisionObject(fcl.Box(0.1, 0.1, 9), at(0, 2.5))
    quarter = fcl.Transform(TURN)
    assert fcl.continuousCollide(beam, quarter, post, at(0, 2.5), request) == 1.0, "it only moves"
    assert 0.9 < fcl.continuousCollide(beam, quarter, post, at(0, 2.5), turning) < 1
    turning.ccd_motion_type = fcl.CCDMotionType.CCDM_SCREW
    with pytest.raises(fcl.Unsupported, match="CCDM_SCREW"):
        fcl.continuousCollide(beam, quarter, post, at(0, 2.5), turning)


def test_what_is_missing_says_so():
    for make in (
        lambda: fcl.Halfspace(np.array([1.0, 0, 0]), 5.0),
        lambda: fcl.Plane(np.array([1.0, 0, 0]), 5.0),
        lambda: fcl.OcTree(0.1),
        lambda: fcl.CollisionRequest(enable_cost=True),
    ):
        with pytest.raises(fcl.Unsupported, match="lrbscope.fcl (has no|does not support)"):
            make()
    with pytest.raises(ValueError):
        fcl.CollisionObject(fcl.CollisionGeometry()).body
    with pytest.raises(ValueError):
        fcl.CollisionObject()


def manager(*objects):
    m = fcl.DynamicAABBTreeCollisionManager()
    m.registerObjects(objects)
    m.setup()
    return m


def collided(m, *others, **request):
    """Return the CollisionResult of a manager's collide()."""
    data = fcl.CollisionData(request=fcl.CollisionRequest(**request))
    m.collide(*others, data, fcl.defaultCollisionCallback)
    return data.result


def nearest(m, *others, callback=fcl.defaultDistanceCallback):
    """Return the distance that a manager's distance() finds."""
    data = fcl.DistanceData()
    m.distance(*others, data, callback)
    return data.result.min_distance


def test_managers():
    """What python-fcl's example asks of managers."""
    box, sphere, cone = fcl.Box(1, 2, 3), fcl.Sphere(4), fcl.Cone(5, 6)
    mesh = model(np.eye(4)[:, 1:] + 1, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]))
    one = manager(fcl.CollisionObject(box, at(20)), fcl.CollisionObject(sphere))
    two = manager(fcl.CollisionObject(cone), fcl.CollisionObject(mesh))
    three = manager(fcl.CollisionObject(box), fcl.CollisionObject(sphere))
    for m, collides in ((one, False), (two, True)):
        assert collided(m).is_collision is collides
    assert abs(nearest(one) - 15.5) < 0.005 and nearest(two) <= 0
    result = collided(one, fcl.CollisionObject(mesh), num_max_contacts=100, enable_contact=True)
    assert result.is_collision and {c.o1 for c in result.contacts} == {sphere}
    result = collided(three, two, num_max_contacts=100, enable_contact=True)
    assert result.is_collision and {c.o2 for c in result.contacts} == {cone, mesh}


def test_managers_keep_objects():
    a, b = fcl.CollisionObject(fcl.Box(1, 1, 1)), fcl.CollisionObject(fcl.Box(1, 1, 1), at(0.5))
    m = manager(a, b)
    assert m.size() == 2 and not m.empty() and m.getObjects() == [a, b]
    b.setTranslation(np.array([5, 0, 0]))
    m.update(b)
    assert not collided(m).is_collision
    m.unregisterObject(b)
    assert m.getObjects() == [a]
    m.clear()
    assert m.empty()
    nearest(m)
    with pytest.raises(ValueError, match="callback"):
        m.collide(fcl.CollisionData())
    with pytest.raises(TypeError, match="CollisionObject"):
        m.registerObject(3)


def test_a_callback_ends_the_walk():
    m = manager(*(fcl.CollisionObject(fcl.Box(1, 1, 1), at(0.1 * i)) for i in range(5)))
    seen = []

    def callback(o1, o2, data):
        seen.append((o1, o2))
        return len(seen) == 3

    m.collide(None, callback)
    assert len(seen) == 3
    found = []
    m.distance(found, lambda o1, o2, data: (data.append(1) or False, 1.0))
    assert len(found) == 10, "all boxes are nearer than 1"


def test_a_rebuilt_mesh_is_not_served_from_the_cache():
    triangles = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
    corners = np.vstack([np.zeros(3), np.eye(3)])
    mesh = model(corners, triangles)
    m = manager(fcl.CollisionObject(mesh), fcl.CollisionObject(fcl.Box(1, 1, 1), at(5)))
    assert not collided(m).is_collision
    mesh.beginModel()
    mesh.addSubModel(corners * 9, triangles)
    mesh.endModel()
    assert collided(m).is_collision and m.size() == 2


def test_the_nearest_of_many(rng):
    """A manager's distance is the least of all pairs, and few pairs are queried."""
    places = rng.uniform(-20, 20, (40, 3))
    spheres = [fcl.CollisionObject(fcl.Sphere(0.25), fcl.Transform(p)) for p in places]
    m, queried = manager(*spheres), []

    def callback(o1, o2, data):
        queried.append((o1, o2))
        return fcl.defaultDistanceCallback(o1, o2, data)

    least = min(fcl.distance(a, b) for i, a in enumerate(spheres) for b in spheres[:i])
    assert nearest(m, callback=callback) == least and len(queried) < 40
    lone = fcl.CollisionObject(fcl.Box(1, 1, 1), at(50))
    assert nearest(m, lone) == min(fcl.distance(s, lone) for s in spheres)
