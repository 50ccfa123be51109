"""Pictures as arrays that notebooks show."""

import numpy as np

from . import _core


class Picture(np.ndarray):
    """Pixels that a notebook shows: an array (height, width, 3) of uint8, or with opacity (height, width, 4).

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
