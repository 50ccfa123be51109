"""What trimesh and python-fcl document, with nothing changed but the import; and live, beside them."""

import types

import numpy as np
import pytest

import lrbscope.collision
from lrbscope import fcl
from shapes import Mesh, ball_arrays, cube_arrays, random_poses, shifted


def test_shapes_of_python_fcl():
    v1, v2, v3 = np.array([1.0, 2.0, 3.0]), np.array([2.0, 1.0, 3.0]), np.array([3.0, 2.0, 1.0])
    x, y, z = 1, 2, 3
    rad, lz = 1.0, 3.0
    shapes = [
        fcl.TriangleP(v1, v2, v3),
        fcl.Box(x, y, z),
        fcl.Sphere(rad),
        fcl.Ellipsoid(x, y, z),
        fcl.Capsule(rad, lz),
        fcl.Cone(rad, lz),
        fcl.Cylinder(rad, lz),
    ]
    for shape in shapes:
        o = fcl.CollisionObject(shape, fcl.Transform())
        assert fcl.collide(o, fcl.CollisionObject(shape)) > 0 and shape.getNodeType() > 0
        shape.computeLocalAABB()
        assert shape.aabb_center.shape == (3,)


def test_measures_can_be_changed():
    sphere, box, far = fcl.Sphere(1.0), fcl.Box(1, 1, 1), fcl.Transform(np.array([3.0, 0, 0]))
    one, other = fcl.CollisionObject(sphere), fcl.CollisionObject(box, far)
    assert not fcl.collide(one, other)
    sphere.radius = 2.75
    assert fcl.collide(one, other)
    sphere.radius = 1.0
    box.side = [9, 1, 1]
    assert fcl.collide(one, other) and box.side.tolist() == [9, 1, 1]
    with pytest.raises(ValueError):
        box.side[0] = 3  # would not be seen


def test_meshes_and_transforms_of_python_fcl():
    verts = np.array([[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]])
    tris = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
    m = fcl.BVHModel()
    m.beginModel(len(verts), len(tris))
    m.addSubModel(verts, tris)
    m.endModel()
    R = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    T, q = np.array([1.0, 2.0, 3.0]), np.array([0.707, 0.0, 0.0, 0.707])
    for args in ((), (q,), (R,), (T,), (q, T), (R, T)):
        again = fcl.Transform(fcl.Transform(*args))
        assert np.allclose(again.getRotation() @ again.getRotation().T, np.eye(3))
    obj = fcl.CollisionObject(m, fcl.Transform(R, T))
    obj.setTransform(fcl.Transform(q, T))
    obj.setRotation(R)
    obj.setTranslation(2 * T)
    obj.setQuatRotation(q)
    assert np.allclose(obj.getTransform().getTranslation(), 2 * T) and np.allclose(obj.getRotation(), R)


def test_queries_of_python_fcl():
    o1 = fcl.CollisionObject(fcl.Box(1, 2, 3), fcl.Transform())
    o2 = fcl.CollisionObject(fcl.Cone(1, 3), fcl.Transform())
    request, result = fcl.CollisionRequest(), fcl.CollisionResult()
    assert fcl.collide(o1, o2, request, result) >= 1 and result.is_collision
    request, result = fcl.DistanceRequest(), fcl.DistanceResult()
    assert fcl.distance(o1, o2, request, result) < 0, "negative: the objects are in collision"
    t1_final = fcl.Transform(np.array([1.0, 0.0, 0.0]))
    t2_final = fcl.Transform(np.array([-1.0, 0.0, 0.0]))
    request, result = fcl.ContinuousCollisionRequest(), fcl.ContinuousCollisionResult()
    assert 0 <= fcl.continuousCollide(o1, t1_final, o2, t2_final, request, result) < 1 and result.is_collide


def test_managers_have_the_members_of_python_fcl():
    manager = fcl.DynamicAABBTreeCollisionManager()
    for name in (
        "registerObjects registerObject unregisterObject setup update getObjects collide "
        "distance clear empty size max_tree_nonbalanced_level tree_incremental_balance_pass "
        "tree_topdown_balance_threshold tree_topdown_level tree_init_level "
        "octree_as_geometry_collide octree_as_geometry_distance"
    ).split():
        assert hasattr(manager, name)


@pytest.fixture()
def cube():
    """A cube round the origin, as trimesh's tests have it."""
    vertices, faces = cube_arrays()
    return Mesh(vertices - 0.5, faces)


class Graph(dict):
    """The part of trimesh.Scene.graph that managers are made of."""

    @property
    def nodes_geometry(self):
        return list(self)


def test_scenes_of_trimesh(cube):
    graph = Graph(
        here=(np.eye(4), "cube"), there=(shifted(0.5, 0.1, 0), "cube"), far=(shifted(9, 0, 0), "cube")
    )
    scene = types.SimpleNamespace(graph=graph, geometry={"cube": cube})
    manager, objects = lrbscope.collision.scene_to_collision(scene)
    assert manager.in_collision_internal(return_names=True) == (True, {("here", "there")})
    assert list(objects) == ["here", "there", "far"] and isinstance(objects["far"], lrbscope.Body)


def test_beside_trimesh(rng):
    """Names of pairs that collide, and distances, of balls in general position."""
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("fcl")
    vertices, faces = ball_arrays(2, 0.5)
    mesh, theirs, ours = trimesh.Trimesh(vertices, faces), trimesh.collision.CollisionManager(), None
    ours = lrbscope.CollisionManager()
    for i, pose in enumerate(random_poses(rng, 80, 4)):
        theirs.add_object(str(i), mesh, pose)
        ours.add_object(str(i), mesh, pose)
    assert ours.in_collision_internal(return_names=True) == theirs.in_collision_internal(return_names=True)
    for pose in random_poses(rng, 20, 4):
        found, wanted = (m.in_collision_single(mesh, pose, return_names=True) for m in (ours, theirs))
        assert found == wanted
        if not wanted[0]:
            assert np.isclose(
                ours.min_distance_single(mesh, pose), theirs.min_distance_single(mesh, pose), rtol=1e-4
            )


def test_beside_python_fcl(rng):
    """Whether boxes collide, and how far they are apart if they do not."""
    theirs = pytest.importorskip("fcl")
    for pose in random_poses(rng, 50, 2):
        hit, apart = [], []
        for module in (fcl, theirs):
            one = module.CollisionObject(module.Box(1, 2, 3))
            other = module.CollisionObject(module.Box(2, 1, 1), module.Transform(pose[:3, :3], pose[:3, 3]))
            hit.append(module.collide(one, other) > 0)
            apart.append(module.distance(one, other))
        assert hit[0] == hit[1]
        if not hit[0]:
            assert np.isclose(apart[0], apart[1], rtol=1e-3)
