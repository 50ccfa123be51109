"""Pictures as arrays with notebook display."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

if TYPE_CHECKING:
    from os import PathLike

    import numpy.typing as npt

    _Pixels = np.ndarray[Any, np.dtype[np.uint8]]
else:
    _Pixels = np.ndarray


class Picture(_Pixels):
    """Pixels with notebook display: an array (height, width, 3) of uint8, or with alpha (height, width, 4).

    `caption` describes the picture in a sentence.
    """

    caption: str

    def __new__(cls, pixels: npt.ArrayLike, caption: str = "") -> Picture:
        out = np.asarray(pixels, dtype=np.uint8).view(cls)
        out.caption = caption
        return out

    def __array_finalize__(self, other: Any) -> None:
        self.caption = getattr(other, "caption", "")

    def __repr__(self) -> str:
        if self.ndim != 3 or self.shape[2] not in (3, 4):  # a part of a picture, such as one channel
            return super().__repr__()
        return f"<lrbscope.Picture {self.shape[1]}x{self.shape[0]}>"

    def _repr_png_(self) -> bytes | None:
        # Parts of a picture, such as one channel, are plain arrays.
        return _core._encode_png(self) if self.ndim == 3 and self.shape[2] in (3, 4) else None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the picture as PNG."""
        png = _core._encode_png(self)
        with open(path, "wb") as file:
            file.write(png)
