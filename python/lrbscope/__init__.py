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
from ._core import *
from ._core import __version__ as __version__
from ._picture import Picture as Picture
from .collision import CollisionManager as CollisionManager
from .collision import ContactData as ContactData
from .collision import DistanceData as DistanceData
from .report import Interference as Interference
from .report import Report as Report
from .report import report as _report

# Classes report, and pickle, the module that users import them from.
for _name in dir(_core):
    _object = getattr(_core, _name)
    if isinstance(_object, type):
        _object.__module__ = __name__
del _name, _object

_core.Scene.report = _report  # type: ignore[method-assign]

# EnvironmentError is not exported: it would hide Python's own.
__all__ = sorted(name for name in dir() if name[0].isupper() and name != "EnvironmentError")
__all__ += [name for name in dir(_core) if name[0].islower()]
