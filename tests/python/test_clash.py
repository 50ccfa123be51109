"""clash(): kinds of contact, proved depths and volumes."""

import numpy as np
import pytest

from lrbscope import Body, InputError, clash
from shapes import cube_arrays, open_cube_arrays, shifted


@pytest.mark.parametrize(
    ("pose", "kind", "depth", "volume"),
    [
        (shifted(2, 0, 0), "apart", 0, 0),
        (shifted(1, 0, 0), "touching_face", 0, 0),
        (shifted(1, 1, 0), "touching_edge", 0, 0),
        (shifted(1, 1, 1), "touching_point", 0, 0),
        (shifted(0.75, 0.25, 0.125), "protrudes", 0.25, 0.25 * 0.75 * 0.875),
        (shifted(0, 0, 0), "equal", 1, 1),
    ],
)
def test_cubes(cube, pose, kind, depth, volume):
    found = clash(cube, cube, pose)
    assert found.kind == kind and found.interiors_overlap is (volume > 0)
    assert found.depth[0] <= depth * (1 + 1e-12) and depth <= found.depth[1] * (1 + 1e-12)
    assert found.volume[0] <= volume * (1 + 1e-12) and volume <= found.volume[1] * (1 + 1e-12)
    assert np.isclose(np.linalg.norm(found.translation), found.depth[1])
    separated = pose.copy()
    separated[:3, 3] += found.translation * (1 + 1e-12)
    assert clash(cube, cube, separated).interiors_overlap is False


def test_requests(cube):
    near = clash(cube, cube, shifted(1.25, 0, 0), clearance=0.5)
    assert near.kind == "within_clearance" and near.distance[0] <= 0.25 <= near.distance[1]
    deep = clash(cube, cube, shifted(0.75, 0.25, 0.125), along=(0, 2, 0), depth=False, volume=False)
    assert deep.along[0] <= 0.75 <= deep.along[1] and deep.volume is None
    many = clash(cube, cube, [shifted(2, 0, 0), shifted(1, 0, 0)])
    assert [c.kind for c in many] == ["apart", "touching_face"]


def test_what_goes_through(cube):
    rod = Body(*cube_arrays((0.25, 0.25, 4), (0.3, 0.3, -2)))
    assert clash(rod, cube).kind == "pierces" and clash(cube, rod).kind == "cuts_through"


def test_what_is_refused(cube):
    with pytest.raises(InputError, match="clearance: expected a finite number of at least 0"):
        clash(cube, cube, clearance=-1)
    with pytest.raises(InputError):
        clash(cube, cube, along=(0, 0, 0))
    with pytest.raises(InputError, match="along: expected three numbers"):
        clash(cube, cube, along=(0, 0))


def test_reasons(cube):
    at = shifted(0.5, 0.25, 0.125)
    assert clash(cube, Body(*open_cube_arrays()), at).reason == "B bounds no solid"
    assert clash(cube, cube, at).reason is None
