"""A bar for progress=True, by tqdm."""

from __future__ import annotations

from typing import Any


class Bar:
    def __init__(self) -> None:
        try:
            from tqdm.auto import tqdm
        except ModuleNotFoundError:
            raise ModuleNotFoundError(
                "progress=True: tqdm is not installed; install it, or pass a function of (what, done, total)"
            ) from None
        self._tqdm: Any = tqdm
        self._bar: Any = None

    def __call__(self, what: str, done: int, total: int) -> None:
        if self._bar is None:
            self._bar = self._tqdm(leave=False)
        self._bar.set_description_str(what, refresh=False)
        self._bar.total = total or None
        self._bar.n = done
        self._bar.refresh()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
