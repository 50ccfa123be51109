"""Pictures as arrays that notebooks show."""

import numpy as np

from . import _core


class Picture(np.ndarray):
    """Pixels, (height, width, 3) uint8, or (height, width, 4) with opacity: a numpy array that a notebook shows.

    `caption` says in a sentence what is drawn.
    """

    def __new__(cls, pixels, caption=""):
        out = np.asarray(pixels, dtype=np.uint8).view(cls)
        out.caption = caption
        return out

    def __array_finalize__(self, other):
        self.caption = getattr(other, "caption", "")

    def _repr_png_(self):
        # Parts of a picture, such as one channel, are plain numbers.
        return _core._encode_png(self) if self.ndim == 3 and self.shape[2] in (3, 4) else None

    def save(self, path):
        """Write the picture as PNG."""
        png = _core._encode_png(self)
        with open(path, "wb") as file:
            file.write(png)
