import numpy as np
import pytest

import lrbscope
from shapes import ball_arrays, cube_arrays


@pytest.fixture(scope="session")
def cube():
    return lrbscope.Body(*cube_arrays(), name="cube")


@pytest.fixture(scope="session")
def ball():
    return lrbscope.Body(*ball_arrays(3), name="ball")


@pytest.fixture()
def rng():
    return np.random.default_rng(18)
