"""Arrays of all types and layouts, in every function that takes some: the answer of a plain array, or one line that names the fault."""

import numpy as np
import pytest

import lrbscope
from lrbscope import Body, InputError, fcl
from shapes import Mesh, bvh_model, cube_arrays, shifted

VERTICES, FACES = cube_arrays()
CUBE = Body(VERTICES, FACES, regions=False)
NEAR = shifted(0.5, 0.25, 0.125)


def moved(keys):
    scene = lrbscope.Scene()
    for _ in range(3):
        scene.add(CUBE, shifted(9, 0, 0))
    scene.move(keys, [shifted(1, 0, 0), shifted(2, 0, 0)])
    return [scene.pose(k)[0, 3] for k in range(3)]


def joined(transform):
    manager = lrbscope.CollisionManager()
    manager.add_object("a", CUBE, transform)
    return manager.min_distance_single(CUBE)


TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
# The argument's name in messages, a plain array, what the function returns for one.
USES = {
    "vertices": (VERTICES, lambda a: Body(a, FACES, regions=False).hash),
    "faces": (FACES, lambda a: Body(VERTICES, a, regions=False).hash),
    "vertices of a mesh": (VERTICES, lambda a: lrbscope.collide(Mesh(a, FACES), CUBE, NEAR).fingerprint),
    "faces of a mesh": (FACES, lambda a: lrbscope.collide(Mesh(VERTICES, a), CUBE, NEAR).fingerprint),
    "poses_b": (np.array([NEAR, NEAR[::-1][::-1]]), lambda a: lrbscope.collide(CUBE, CUBE, a).fingerprints.tolist()),
    "pose_a": (NEAR, lambda a: lrbscope.distance(CUBE, CUBE, shifted(3, 0, 0), a).upper),
    "motion_b": (np.array([[shifted(3, 0, 0), NEAR]] * 2), lambda a: lrbscope.first_contact(CUBE, CUBE, a).t0.tolist()),
    "points": (VERTICES + 0.25, lambda a: lrbscope.signed_distance(CUBE, a).upper.tolist()),
    "along": (np.array([0.0, 2, 1]), lambda a: lrbscope.clash(CUBE, CUBE, NEAR, along=a).along),
    "pair": (np.array([3, 4]), lambda a: lrbscope.explain_pair(CUBE, CUBE, a).distance),
    "keys": (np.array([2, 0]), moved),
    "verts": (VERTICES, lambda a: bvh_model(a, FACES)._body().hash),
    "triangles": (FACES, lambda a: bvh_model(VERTICES, a)._body().hash),
    "rotation": (TURN, lambda a: fcl.Transform(a, np.zeros(3)).pose.tolist()),
    "translation": (np.array([1.0, 2, 3]), lambda a: fcl.Transform(TURN, a).pose.tolist()),
    "transform": (shifted(3, 0, 0), joined),
}
each_use = pytest.mark.parametrize("name", USES)


def forms(a):
    """Yield arrays and lists of the same numbers."""
    wide = np.zeros((*a.shape[:-1], 2 * a.shape[-1]), dtype=a.dtype)
    wide[..., ::2] = a
    read_only = a.copy()
    read_only.flags.writeable = False
    masked = np.ma.masked_array(a, mask=np.zeros_like(a, dtype=bool))
    yield from (a.tolist(), tuple(a), [*a], np.asfortranarray(a), wide[..., ::2], a[::-1].copy()[::-1])
    yield from (a.astype(a.dtype.newbyteorder()), read_only, masked, masked.astype(a.dtype.newbyteorder()))
    for type_ in ("i1", "u1", ">u2", "i4", "u8") if a.dtype.kind == "i" else ("f4", "g", ">f4"):
        yield a.astype(type_)
    if a.dtype.kind == "f" and (a == a.round()).all():
        yield from (a.astype("i1"), a.astype(">i8"))


@each_use
def test_forms_of_arrays(name):
    plain, use = USES[name]
    kept = plain.copy()
    wanted = use(plain)
    for form in forms(plain):
        assert use(form) == wanted, (type(form), getattr(form, "dtype", ""), getattr(form, "strides", ""))
    assert np.array_equal(plain, kept)


def faulty(a):
    """Yield arguments that are no array of such numbers, and the text of the error after the name."""
    one = (1,) + (0,) * (a.ndim - 1)
    mask = np.zeros(a.shape, dtype=bool)
    mask[one] = True
    where = ", ".join(map(str, one))
    yield np.ma.masked_array(a, mask), rf"\[{where}\]: expected a value, got a masked one"
    if a.ndim > 1:
        yield list(np.ma.masked_array(a, mask)), rf"\[1\]\[{where[3:]}\]: expected a value, got a masked one"
    for wrong in (a.astype(complex), a.astype(object), a.astype(str), a.astype("M8[s]"), a.astype(bool)):
        yield wrong, f"expected (numbers|integers).*, got an array of {wrong.dtype}".replace("[", r"\[")
    yield a[..., :1], r"(expected .*, got shape \(|corners, expected)"
    yield np.zeros((2, 2, 2, 2, 2), dtype=a.dtype), r"expected .*, got shape \(2, 2, 2, 2, 2\)"
    yield "text", "expected (numbers|integers)"
    if a.dtype.kind == "i":
        yield a.astype(float), "expected integers.*, got an array of float64"
        yield a.astype("u8") + np.uint64(2**63), "expected integers below 2.63, got 9223372036854775"
    else:
        yield np.full(a.shape, 2**53 + 1), "expected integers below 2.53"


@each_use
def test_faulty_arrays(name):
    plain, use = USES[name]
    for wrong, said in faulty(plain):
        with pytest.raises(InputError, match=f"^{name.split()[0]}.*{said}") as error:
            use(wrong)
        assert "\n" not in str(error.value)


def test_numbers_that_no_body_has():
    for wrong, said in (
        (FACES - 1, "face 0: .* below 8, got -1"),
        (FACES + 2**32, "face 0: .*, got 4294967296"),
        (np.array(None), "faces: expected integers"),
    ):
        with pytest.raises(InputError, match=said):
            Body(VERTICES, wrong)
    for value in (np.nan, np.inf):
        bad = VERTICES.copy()
        bad[2, 1] = value
        for use in (USES["vertices"][1], USES["points"][1], USES["verts"][1]):
            with pytest.raises(InputError, match="not finite.*2|2.* not finite"):
                use(bad)
        with pytest.raises(InputError, match="finite numbers"):
            lrbscope.collide(CUBE, CUBE, shifted(value, 0, 0))


def test_empty_arrays():
    for empty in (np.zeros((0, 3)), []):
        with pytest.raises(InputError, match="no faces"):
            Body(VERTICES, empty)
        assert len(lrbscope.signed_distance(CUBE, empty)) == 0
    for none in (np.zeros((0, 4, 4)), np.zeros((0, 3, 4)), []):
        assert len(lrbscope.collide(CUBE, CUBE, none)) == len(lrbscope.distance(CUBE, CUBE, none)) == 0
