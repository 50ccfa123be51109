"""lrbscope.fcl: the interface of python-fcl, and what its README shows."""

import copy
import pickle
from types import SimpleNamespace

import numpy as np
import pytest

from lrbscope import InputError, fcl
from shapes import ball_arrays, bvh_model, cube_arrays, random_poses


def at(x=0.0, y=0.0, z=0.0):
    return fcl.Transform(np.array([x, y, z], dtype=float))


def box(x, *place):
    return fcl.CollisionObject(fcl.Box(x, 1, 1), at(*place))


TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def test_transforms(rng):
    q, t = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]), np.array([1.0, 2, 3])
    for args, r, moved in [
        ((), np.eye(3), np.zeros(3)),
        ((q,), TURN, np.zeros(3)),
        ((TURN,), TURN, np.zeros(3)),
        ((t,), np.eye(3), t),
        ((q, t), TURN, t),
        ((TURN, t), TURN, t),
        ((TURN, t[:, None]), TURN, t),
        ((fcl.Transform(TURN, t),), TURN, t),
    ]:
        tf = fcl.Transform(*args)
        assert np.allclose(tf.getRotation(), r) and np.array_equal(tf.getTranslation(), moved)
    for args in ((np.zeros(5),), (t, t), (q, t, t), (TURN, q), (np.zeros(4),)):
        with pytest.raises(ValueError):
            fcl.Transform(*args)
    for q in [*rng.normal(size=(50, 4)), *np.eye(4)]:
        q /= np.linalg.norm(q) * (np.sign(q[0]) or 1)
        assert np.allclose(fcl.Transform(3 * q).getQuatRotation(), q)


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
    sphere, far = fcl.Sphere(1.0), box(1, 3)
    assert not fcl.collide(fcl.CollisionObject(sphere), far)
    sphere.radius = 2.75  # measures can be changed
    assert fcl.collide(fcl.CollisionObject(sphere), far)
    with pytest.raises(ValueError):
        far._geom.side[0] = 3  # would not be noticed


def test_models_are_built_in_order():
    m = fcl.BVHModel()
    with pytest.raises(ValueError, match="correct sequence"):
        m.addSubModel(*cube_arrays())
    m.beginModel(num_tris_=2, num_vertices_=6)
    assert m.addTriangle(np.array([0, 0, 0]), np.array([1, 0, 0]), np.array([0, 1, 0])) is True
    assert m.addSubModel(*cube_arrays()) is True and m.num_tries_() == 13 and m.buildState() == 1
    m.endModel()
    assert m.buildState() == 2 and fcl.CollisionObject(m).body.real_face_count == 13
    with pytest.raises(InputError, match="expected a vertex index below .*, got 9"):
        bvh_model(cube_arrays()[0], [[0, 1, 9]])


def test_meshes_collide():
    m = bvh_model(*cube_arrays())
    a, b = fcl.CollisionObject(m), fcl.CollisionObject(m, at(0.5, 0.25, 0.125))
    result = fcl.CollisionResult()
    assert fcl.collide(a, b, fcl.CollisionRequest(), result) == 1 and result.is_collision
    assert result.contacts[0].o1 is m and result.contacts[0].o2 is m
    result = fcl.CollisionResult()
    n = fcl.collide(a, b, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result)
    assert n == len(result.contacts) == 12
    for c in result.contacts:
        assert 0 <= c.b1 < 12 and 0 <= c.b2 < 12 and (c.pos >= (0.5, 0.25, 0.125)).all() and (c.pos <= 1).all()
    assert fcl.collide(a, b, fcl.CollisionRequest(num_max_contacts=5)) == 5
    assert fcl.collide(a, fcl.CollisionObject(m, at(5))) == 0
    assert fcl.collide(a, fcl.CollisionObject(bvh_model(*cube_arrays(0.25, 0.3)))) == 0, "meshes are surfaces"


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
def test_shapes(shape, volume):
    body = fcl.CollisionObject(shape).body
    corners = body.vertices[body.triangles]
    found = np.einsum("ij,ij", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert body.is_solid and volume * 0.995 < found <= volume * 1.0000001
    shape.computeLocalAABB()
    assert np.allclose(shape.aabb_center, body.box().mean(axis=0)) and shape.getNodeType() > 0


def test_shapes_are_solids():
    ball, inside = fcl.CollisionObject(fcl.Sphere(4.0)), box(1)
    for pair in ((ball, inside), (inside, ball)):
        result = fcl.CollisionResult()
        assert fcl.collide(*pair, fcl.CollisionRequest(enable_contact=True), result) == 1
        assert result.is_collision and fcl.distance(*pair) == -1
    mesh = fcl.CollisionObject(bvh_model(*ball_arrays(2)))
    assert fcl.collide(ball, mesh) == 1 and fcl.collide(mesh, fcl.CollisionObject(fcl.Box(0.1, 0.1, 0.1))) == 0
    triangle = fcl.CollisionObject(fcl.TriangleP(*np.eye(3)))
    assert fcl.collide(triangle, inside) > 0


def contacts(one, other):
    result = fcl.CollisionResult()
    fcl.collide(one, other, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result)
    return result.contacts


def test_contacts_of_shapes_have_the_separation_vector(rng, monkeypatch):
    """Along the normal B leaves A after the depth, and in no direction before."""
    monkeypatch.setattr(fcl, "facets", 16)
    shapes = [fcl.Box(1, 2, 0.5), fcl.Sphere(0.7), fcl.Cone(0.8, 1.5), fcl.Box(0.2, 0.2, 0.2)]
    seen = 0
    for i, pose in enumerate(random_poses(rng, 24, 0.5)):
        place = pose[:3, 3]
        one = fcl.CollisionObject(shapes[i % 4])
        other = fcl.CollisionObject(shapes[i // 4 % 4], fcl.Transform(pose[:3, :3], place))
        found = contacts(one, other)
        seen += len(found)
        for c in found:
            assert (c.b1, c.b2, len(found)) == (-1, -1, 1) and c.penetration_depth > 0
            ways = rng.normal(size=(20, 3))
            ways = np.vstack([c.normal, ways / np.linalg.norm(ways, axis=1)[:, None]])
            for part, directions in ((0.999, ways), (1.001, ways[:1])):
                for direction in directions:
                    other.setTranslation(place + part * c.penetration_depth * direction)
                    assert bool(fcl.collide(one, other)) == (part < 1)
    assert seen > 15
    (touch,) = contacts(box(1), box(1, 1))
    assert touch.penetration_depth == 0 and touch.normal.tolist() == [1, 0, 0]


def test_triangles_of_a_mesh_in_a_shape(rng):
    """Those that cross the shape's surface, and those inside: each once, in either order of the objects."""
    triangle = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]])
    apart = np.array([[0.1, 0.2, 0.3], [0.45, 0, 0], [2, 0, 0], [-0.5, 0, -0.6], [-0.2, 0.1, 0.4]])
    # Both are turned and moved alike.
    pose = random_poses(rng, 1, 5)[0]
    both = fcl.Transform(pose[:3, :3], pose[:3, 3])
    model = bvh_model((apart[:, None] + triangle).reshape(-1, 3), np.arange(15).reshape(-1, 3))
    mesh, one = fcl.CollisionObject(model, both), fcl.CollisionObject(fcl.Box(1, 1, 1), both)
    found = contacts(one, mesh)
    assert sorted(c.b2 for c in found) == sorted(c.b1 for c in contacts(mesh, one)) == [0, 1, 4]
    assert fcl.collide(one, mesh) == fcl.collide(mesh, one) == 1
    inside = {c.b2: c for c in found}[4]
    assert inside.b1 == -1 and np.isclose(inside.penetration_depth, 0.1) and np.isclose(abs(inside.normal @ pose[:3, 2]), 1)


def test_distances():
    a, b = fcl.CollisionObject(fcl.Sphere(1)), fcl.CollisionObject(fcl.Sphere(1), at(5, 1, 2))
    request, result = fcl.DistanceRequest(enable_nearest_points=True), fcl.DistanceResult()
    found = fcl.distance(a, b, request, result)
    assert abs(found - (np.sqrt(30) - 2)) < 0.005 and result.min_distance == found
    assert np.isclose(np.linalg.norm(result.nearest_points[0] - result.nearest_points[1]), found)
    assert result.o1 is a._geom and result.b1 == -1
    assert fcl.distance(a, fcl.CollisionObject(fcl.Sphere(1), at(50)), request, result) > found == result.min_distance
    cube = bvh_model(*cube_arrays())
    o, result = fcl.CollisionObject(cube), fcl.DistanceResult()
    assert fcl.distance(o, fcl.CollisionObject(cube, at(0.5, 0.25, 0.125))) == 0
    fcl.distance(o, fcl.CollisionObject(cube, at(3)), request, result)
    assert 0 <= result.b1 < 12 and result.nearest_points[0][0] == 1
    signed, result = fcl.DistanceRequest(enable_signed_distance=True), fcl.DistanceResult()
    near = box(1, 0.75, 0.1, 0.2)
    assert abs(fcl.distance(box(1), near, signed, result) + 0.25) < 1e-6 and fcl.distance(box(1), near) == -1
    # The nearest points are where the boxes touch once the second one is moved away, as far apart as the depth.
    one, other = result.nearest_points
    assert abs(one[0] - 0.5) < 1e-6 and np.allclose(one - other, [0.25, 0, 0], atol=1e-6)


def test_continuous_collisions():
    """What python-fcl's example asks of moving objects, and others."""
    request, result = fcl.ContinuousCollisionRequest(), fcl.ContinuousCollisionResult()
    one, other = fcl.CollisionObject(fcl.Box(1, 2, 3)), fcl.CollisionObject(fcl.Cylinder(2, 2), at(5))
    time = fcl.continuousCollide(one, at(5), other, at(0), request, result)
    assert result.is_collide and result.time_of_contact == time
    # Of the gap of 2.5 at the start 10 would be closed; the box's edge meets a facet.
    assert abs(time - 0.25) < 0.001 and fcl.continuousCollide(one, at(-5), other, at(9)) == 1.0
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
    for make in (lambda: fcl.CollisionObject(fcl.CollisionGeometry()).body, fcl.CollisionObject):
        with pytest.raises(ValueError):
            make()


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
    sphere, cone = fcl.Sphere(4), fcl.Cone(5, 6)
    mesh = bvh_model(np.eye(4)[:, 1:] + 1, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]))
    one = manager(box(1, 20), fcl.CollisionObject(sphere))
    two = manager(fcl.CollisionObject(cone), fcl.CollisionObject(mesh))
    assert not collided(one).is_collision and collided(two).is_collision
    assert abs(nearest(one) - 15.5) < 0.005 and nearest(two) <= 0
    result = collided(one, fcl.CollisionObject(mesh), num_max_contacts=100, enable_contact=True)
    assert result.is_collision and {c.o1 for c in result.contacts} == {sphere}
    three = manager(fcl.CollisionObject(fcl.Box(1, 2, 3)), fcl.CollisionObject(sphere))
    result = collided(three, two, num_max_contacts=100, enable_contact=True)
    assert result.is_collision and {c.o2 for c in result.contacts} == {cone, mesh}


def test_managers_keep_objects():
    triangles, corners = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]), np.vstack([np.zeros(3), np.eye(3)])
    mesh = bvh_model(corners, triangles)
    a, b = fcl.CollisionObject(mesh), box(1, 0.5)
    m = manager(a, b)
    assert m.size() == 2 and not m.empty() and m.getObjects() == [a, b]
    b.setTranslation(np.array([5, 0, 0]))
    m.update(b)
    assert not collided(m).is_collision
    mesh.beginModel()  # replaces the mesh
    mesh.addSubModel(corners * 9, triangles)
    mesh.endModel()
    assert collided(m).is_collision and m.size() == 2
    m.unregisterObject(b)
    assert m.getObjects() == [a]
    m.clear()
    assert m.empty()
    nearest(m)
    with pytest.raises(ValueError, match="callback"):
        m.collide(fcl.CollisionData())
    like = SimpleNamespace(body=a.body, pose=a.pose)
    for call, *rest in (m.registerObject,), (m.collide, 0, print), (m.distance, 0, print), (fcl.collide, a), (fcl.distance, a):
        with pytest.raises(TypeError, match="expected a CollisionObject, got SimpleNamespace"):
            call(like, *rest)


def test_callbacks(rng):
    """A callback ends the traversal; the distance is the least of all pairs, and few pairs are queried."""
    m, seen = manager(*(box(1, 0.1 * i) for i in range(5))), []
    m.collide(seen, lambda o1, o2, data: data.append(1) or len(data) == 3)
    assert len(seen) == 3
    m.distance(seen, lambda o1, o2, data: (data.append(1) or False, 1.0))
    assert len(seen) == 13, "all boxes are nearer than 1"
    spheres = [fcl.CollisionObject(fcl.Sphere(0.25), fcl.Transform(p)) for p in rng.uniform(-20, 20, (40, 3))]
    m, queried = manager(*spheres), []

    def callback(o1, o2, data):
        queried.append((o1, o2))
        return fcl.defaultDistanceCallback(o1, o2, data)

    least = min(fcl.distance(a, b) for i, a in enumerate(spheres) for b in spheres[:i])
    assert nearest(m, callback=callback) == least and len(queried) < 40
    lone = box(1, 50)
    assert nearest(m, lone) == min(fcl.distance(s, lone) for s in spheres)
