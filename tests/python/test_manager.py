"""CollisionManager: method names, arguments and return values as trimesh has them."""

import inspect
import math
import types

import numpy as np
import pytest

import lrbscope.collision
from lrbscope import CollisionManager, InputError
from shapes import Mesh, cube_arrays, open_cube_arrays, shifted, square_arrays


@pytest.fixture()
def box():
    return Mesh(*cube_arrays())


@pytest.fixture()
def three(box):
    """Two cubes that cross, and one far away."""
    m = CollisionManager()
    m.add_object("b", box)
    m.add_object("a", box, shifted(0.5, 0.25, 0.125))
    m.add_object("far", box, shifted(9, 0, 0))
    return m


def test_signatures_are_those_of_trimesh():
    wanted = {
        "add_object": "name, mesh, transform",
        "remove_object": "name",
        "set_transform": "name, transform",
        "in_collision_single": "mesh, transform, return_names, return_data",
        "in_collision_internal": "return_names, return_data",
        "in_collision_other": "other_manager, return_names, return_data",
        "min_distance_single": "mesh, transform, return_name, return_data",
        "min_distance_internal": "name, return_names, return_data",
        "min_distance_other": "other_manager, return_names, return_data",
    }
    for name, parameters in wanted.items():
        found = list(inspect.signature(getattr(CollisionManager, name)).parameters)[1:]
        assert ", ".join(found) == parameters


def test_the_bodies_of_the_last_meshes_are_kept(box):
    body_of = lrbscope.collision.body_of
    kept = [body_of(Mesh(*cube_arrays(side))) for side in range(1, 6)]
    assert body_of(Mesh(*cube_arrays(2))) is kept[1] and body_of(box) is not kept[0]
    assert len(lrbscope.collision._recent) == 4


def test_collisions(three, box):
    assert three.in_collision_single(box, shifted(9.5, 0.1, 0.1)) is True
    assert three.in_collision_single(box, shifted(50, 0, 0)) is False
    nothing = three.in_collision_single(box, shifted(50, 0, 0), return_names=True, return_data=True)
    assert nothing == (False, set(), [])
    hit, names = three.in_collision_single(box, shifted(0.2, 0.1, 0.05), return_names=True)
    assert hit and names == {"a", "b"}
    hit, data = three.in_collision_single(box, shifted(9.5, 0.1, 0.1), return_data=True)
    assert hit and data and {frozenset(c.names) for c in data} == {frozenset(("far", "__external"))}
    wanted = lrbscope.collide(box, box, shifted(9, 0, 0), shifted(9.5, 0.1, 0.1))
    assert sorted([c.index("__external"), c.index("far")] for c in data) == wanted.pairs.tolist()
    for c in data:
        assert c.point.shape == (3,) and (c.point >= (9.5, 0, 0)).all() and (c.point <= (10, 1.1, 1.1)).all()
        assert np.isclose(np.linalg.norm(c.normal), 1)
    assert np.isclose(min(c.depth for c in data), 0.5) and any(np.allclose(c.normal, (-1, 0, 0)) for c in data)
    hit, names, data = three.in_collision_internal(return_names=True, return_data=True)
    assert hit and names == {("a", "b")} and all(c.names == {"a", "b"} for c in data)
    three.set_transform("a", shifted(3, 0, 0))
    assert three.in_collision_internal() is False
    assert three.in_collision_internal(return_names=True) == (False, set())
    three.set_transform("a", shifted(8.5, 0.1, 0.1))
    assert three.in_collision_internal(return_names=True) == (True, {("a", "far")})
    other = CollisionManager()
    other.add_object("x", box, shifted(9.6, 0.6, 0.1))
    assert three.in_collision_other(other, return_names=True) == (True, {("far", "x")})
    assert other.in_collision_other(three, return_names=True) == (True, {("x", "far")})
    other.set_transform("x", shifted(20, 0, 0))
    assert three.in_collision_other(other) is False


def test_distances(three, box):
    assert np.isclose(three.min_distance_single(box, shifted(12, 0, 0)), 2)
    at = shifted(12, 0, 0)
    distance, name, data = three.min_distance_single(box, at, return_name=True, return_data=True)
    assert name == "far" and data.names == {"far", "__external"} and data.distance == distance
    assert data.point("far")[0] == 10 and data.point("__external")[0] == 12
    assert box.vertices[box.faces[data.index("far")]][:, 0].max() == 1
    assert three.min_distance_internal() == 0
    three.remove_object("b")
    distance, names, data = three.min_distance_internal(return_names=True, return_data=True)
    assert np.isclose(distance, 7.5) and names == ("a", "far")
    assert three.min_distance_internal("far", return_names=True) == (distance, names)
    three.add_object("near", box, shifted(1.6, 0.25, 0.125))
    assert np.isclose(three.min_distance_internal(), 0.1) and np.isclose(three.min_distance_internal("far"), 6.4)
    three.remove_object("near")
    assert np.isclose(np.linalg.norm(data.point("a") - data.point("far")), distance)
    other = CollisionManager()
    assert three.min_distance_other(other) == math.inf
    other.add_object("x", box, shifted(12, 0, 0))
    distance, names = three.min_distance_other(other, return_names=True)
    assert np.isclose(distance, 2) and names == ("far", "x")
    assert other.min_distance_other(three, return_names=True)[1] == ("x", "far")


def test_one_in_another_collides():
    m = CollisionManager()
    m.add_object("outer", Mesh(*cube_arrays()))
    inner = Mesh(*cube_arrays(0.25, 0.3))
    assert m.in_collision_single(inner, return_names=True, return_data=True) == (True, {"outer"}, [])
    assert m.min_distance_single(inner) == 0
    m.add_object("outer", Mesh(*open_cube_arrays()))  # open: no solid
    assert m.in_collision_single(inner) is False and m.min_distance_single(inner) > 0.2


def test_objects_in_the_plane():
    m = CollisionManager()
    square = m.add_object("square", Mesh(*square_arrays()))
    hit, data = m.in_collision_single(square, shifted(0.75, 0.5, 0), return_data=True)
    assert square.dim == 2 and hit and len(data) == 2
    assert all(np.allclose(c.normal, (-1, 0, 0)) and np.isclose(c.depth, 0.25) for c in data)
    hit, data = m.in_collision_single(square, shifted(1, 0.25, 0), return_data=True)
    assert hit and {c.point[0] for c in data} == {1.0} and {c.depth for c in data} == {0.0}
    assert np.isclose(m.min_distance_single(square, shifted(3, 0, 0)), 2)


def test_objects_come_and_go(box, three):
    m = CollisionManager()
    assert m.in_collision_internal(return_names=True, return_data=True) == (False, set(), [])
    assert m.min_distance_internal(return_names=True) == (math.inf, (None, None))
    body = m.add_object("x", box)
    assert isinstance(body, lrbscope.Body) and m.add_object("y", body) is body
    assert m.add_object("x", box, shifted(5, 0, 0)) is body, "the same mesh is taken in once"
    assert not m.in_collision_internal()
    for action in (m.remove_object, lambda name: m.set_transform(name, np.eye(4))):
        with pytest.raises(ValueError, match="nobody not in collision manager!"):  # language: keep
            action("nobody")
    with pytest.raises(TypeError, match="expected something with vertices and faces, got int"):
        m.add_object("z", 3)
    with pytest.raises(InputError, match=r"transform: expected numbers of shape \(4, 4\)"):
        m.add_object("z", box, np.eye(3))
    with pytest.raises(ValueError, match="z not in collision manager!"):
        m.remove_object("z")
    assert m.add_object("x", Mesh(box.vertices * 2, box.faces)) is not body
    m.add_object(1, box, shifted(0.5, 0.25, 0.125))
    assert (1, "x") in m.in_collision_internal(return_names=True)[1]
    three.remove_object("b")
    three.add_object("b", box)  # with another key
    names, data = three.in_collision_other(three, return_names=True, return_data=True)[1:]
    assert names == {(n, n) for n in ("a", "b", "far")} | {("a", "b"), ("b", "a")} and data
    assert three.min_distance_other(three) == 0


class Graph(dict):
    """The part of trimesh.Scene.graph that managers are made of."""

    nodes_geometry = property(list)


def test_scenes_of_trimesh(box):
    graph = Graph(here=(np.eye(4), "cube"), there=(shifted(0.5, 0.1, 0), "cube"), far=(shifted(9, 0, 0), "cube"))
    scene = types.SimpleNamespace(graph=graph, geometry={"cube": box})
    manager, objects = lrbscope.collision.scene_to_collision(scene)
    assert manager.in_collision_internal(return_names=True) == (True, {("here", "there")})
    assert list(objects) == ["here", "there", "far"] and isinstance(objects["far"], lrbscope.Body)
