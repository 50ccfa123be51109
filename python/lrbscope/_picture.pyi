from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

class Picture(np.ndarray[Any, np.dtype[np.uint8]]):
    caption: str
    def __new__(cls, pixels: npt.ArrayLike, caption: str = "") -> Picture: ...
    def __array_finalize__(self, other: Any) -> None: ...
    def save(self, path: str | PathLike[str]) -> None: ...
