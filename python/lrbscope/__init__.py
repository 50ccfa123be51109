"""Exact collision queries on meshes, with pictures of the search.

>>> import numpy as np
>>> import lrbscope
>>> v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
>>> f = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
>>> body = lrbscope.Body(v, f)
>>> pose = np.eye(4)
>>> pose[:3, 3] = 0.2, 0.1, 0.05
>>> lrbscope.collide(body, body, pose).relation
'crossing'

Array shapes follow the usual conventions: vertices (n, 3) float, faces (m, 3) int, poses (4, 4) or
(k, 4, 4) float that map body to world coordinates, pairs (p, 2). Lengths are in the meshes' unit, times in
seconds. Answers are exact for the vertices' world coordinates, and do not depend on the number of threads.
"""

from . import _core
from ._core import (
    Body,
    Clash,
    CoherentQuery,
    ContactRegion,
    Distance,
    Distances,
    EnvironmentError,
    FirstContact,
    FirstContacts,
    InputError,
    Manifolds,
    Meetings,
    NearPairs,
    Outcome,
    PairExplanation,
    PointDistances,
    Result,
    Results,
    Scenario,
    Scene,
    SelfIntersections,
    SweepAndPrune,
    Trace,
    WalkExplanation,
    Wrapper,
    __version__,
    clash,
    collide,
    collide_pairs,
    contact_manifolds,
    contacts,
    distance,
    explain_pair,
    explain_walk,
    first_contact,
    near_pairs,
    render,
    scenarios,
    self_intersections,
    signed_distance,
    trace,
)
from ._picture import Picture
from .collision import CollisionManager, ContactData, DistanceData
from .report import Interference, Report
from .report import report as _report

# Classes report, and pickle, the module that users import them from.
for _name in dir(_core):
    _object = getattr(_core, _name)
    if isinstance(_object, type):
        _object.__module__ = __name__
del _name, _object

Scene.report = _report  # type: ignore[method-assign]

# EnvironmentError is not exported: it would hide Python's own.
__all__ = [
    "Body",
    "Clash",
    "CoherentQuery",
    "CollisionManager",
    "ContactData",
    "ContactRegion",
    "Distance",
    "DistanceData",
    "Distances",
    "FirstContact",
    "FirstContacts",
    "InputError",
    "Interference",
    "Manifolds",
    "Meetings",
    "NearPairs",
    "Outcome",
    "PairExplanation",
    "Picture",
    "PointDistances",
    "Report",
    "Result",
    "Results",
    "Scenario",
    "Scene",
    "SelfIntersections",
    "SweepAndPrune",
    "Trace",
    "WalkExplanation",
    "Wrapper",
    "clash",
    "collide",
    "collide_pairs",
    "contact_manifolds",
    "contacts",
    "distance",
    "explain_pair",
    "explain_walk",
    "first_contact",
    "near_pairs",
    "render",
    "scenarios",
    "self_intersections",
    "signed_distance",
    "trace",
]
