"""Interference reports: which bodies of a scene are in contact, how, how deep, and by how much volume."""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np

from . import _core

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike

    import numpy.typing as npt

    from ._core import Body, Scene
    from ._picture import Picture

_Interval = Optional["tuple[float, float]"]

# How much an inspector should worry: the first are collisions.
_TOUCHING = ("touching_face", "touching_edge", "touching_point", "within_clearance")
_WORDS = {"a_inside_b": "A is inside B", "b_inside_a": "B is inside A", "equal": "A and B are the same solid"}


class Interference(NamedTuple):
    """A pair of bodies in contact.

    a, b: names of the bodies; keys: in the scene. kind: of the contact, see Clash; for bodies that are not solids the
    relation of their surfaces, see Result. depth, volume: proven intervals, in the world's unit; None: not determined,
    for the reason in `note`. pairs: number of intersecting pairs of triangles. picture: of the contact; None: not
    requested.
    """

    a: str
    b: str
    keys: tuple[int, int]
    kind: str
    depth: _Interval
    volume: _Interval
    pairs: int
    note: str
    picture: Picture | None


class Report:
    """An interference report: its rows, the deepest contact first, and an HTML page of them."""

    def __init__(self, rows: list[Interference], bodies: int) -> None:
        self.rows, self.bodies = rows, bodies

    def __repr__(self) -> str:
        return f"<lrbscope.Report of {self.bodies} bodies: {_counted(len(self.rows), 'pair', 'pairs')} in contact>"

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Interference]:
        return iter(self.rows)

    def html(self) -> str:
        """Return the report as an HTML page, with its pictures."""
        return _PAGE.format(title=html.escape(self._summary()), body=self._repr_html_())

    def save(self, path: str | PathLike[str]) -> None:
        """Write the report as an HTML page."""
        page = self.html()
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)

    def _summary(self) -> str:
        collide = sum(row.kind not in _TOUCHING for row in self.rows)
        return (
            f"{self.bodies} bodies: {_counted(collide, 'pair interferes', 'pairs interfere')}, "
            f"{_counted(len(self.rows) - collide, 'touches', 'touch')}"
        )

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{word}</th>" for word in ("A", "B", "contact", "depth", "volume", "pairs", "picture"))
        rows = "".join(_row_html(row) for row in self.rows)
        table = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>" if rows else ""
        return f'<div class="lrbscope-report"><p>{html.escape(self._summary())}</p>{table}</div>'


def report(
    self: Scene,
    *,
    clearance: float = 0,
    pictures: bool = True,
    size: tuple[int, int] = (480, 360),
    up: npt.ArrayLike | str = "z",
) -> Report:
    """Report all pairs of bodies in contact: who, kind, depth, volume, with pictures.

    clearance: also reports solids at this distance or less; the world's unit. pictures: draws each contact, `size` pixels;
    the first picture takes a second or two, each further one some tenths. up: the upward direction in pictures,
    'x', 'y', 'z' or (3,) float.

    Returns a Report.

    >>> s = Scene()
    >>> for x in (0, 0.75, 9):
    ...     _ = s.add(cube, shifted(x, 0.25, 0.125))
    >>> r = s.report(pictures=False)
    >>> r
    <lrbscope.Report of 3 bodies: 1 pair in contact>
    >>> r.rows[0].kind, r.rows[0].depth[0] <= 0.25 <= r.rows[0].depth[1]
    ('protrudes', True)
    """
    rows = []
    near, _ = self.near(clearance)
    for key_a, key_b in near.tolist():
        a, b, pose_a, pose_b = self.body(key_a), self.body(key_b), self.pose(key_a), self.pose(key_b)
        result = _core.collide(a, b, pose_b, pose_a)
        if result.relation == "separate" and not clearance > 0:
            continue
        kind, depth, volume, note = _measured(a, b, pose_b, pose_a, clearance, result.relation)
        if kind in ("apart", "separate"):
            continue
        picture = None
        if pictures:
            picture = _core.render(a, b, pose_b, pose_a, size=size, up=up, close_up=len(result.pairs) > 0)
        count = len(result.pairs)
        rows.append(Interference(a.name, b.name, (key_a, key_b), kind, depth, volume, count, note, picture))
    rows.sort(key=lambda row: (row.kind in _TOUCHING, -(row.depth[1] if row.depth else np.inf), row.keys))
    return Report(rows, len(self))


def _measured(
    a: Body, b: Body, pose_b: npt.ArrayLike, pose_a: npt.ArrayLike, clearance: float, relation: str
) -> tuple[str, _Interval, _Interval, str]:
    if not (a.is_solid and b.is_solid):
        open_body = b if a.is_solid else a
        return relation, None, None, f"{open_body.name} is not closed: it has no volume"
    clash = _core.clash(a, b, pose_b, pose_a, clearance=clearance)
    return clash.kind, clash.depth, clash.volume, clash.reason or ""


def _counted(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _number(interval: _Interval) -> str:
    """Return the digits in which both ends agree, or the interval."""
    if interval is None:
        return ""
    low, high = interval
    for digits in (6, 5, 4, 3):
        if f"{low:.{digits}g}" == f"{high:.{digits}g}":
            return f"{high:.{digits}g}"
    return f"{low:.3g} to {high:.3g}"


def _row_html(row: Interference) -> str:
    shown = ""
    if row.picture is not None:
        png = base64.b64encode(_core._encode_png(row.picture)).decode()
        shown = f'<img alt="{html.escape(row.a)} and {html.escape(row.b)}" width="360" src="data:image/png;base64,{png}">'
    kind = _WORDS.get(row.kind, row.kind.replace("_", " "))
    note = f"<br><small>{html.escape(row.note)}</small>" if row.note else ""
    names = (f"{html.escape(name)} <small>({key})</small>" for name, key in zip((row.a, row.b), row.keys))
    cells = (
        *names, html.escape(kind) + note, _number(row.depth), _number(row.volume),
        str(row.pairs), shown,
    )  # fmt: skip
    style = ' class="touching"' if row.kind in _TOUCHING else ""
    return f"<tr{style}>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title><style>
:root {{ color-scheme: light dark; }}
body {{ font: 16px/1.45 system-ui, sans-serif; margin: 1.5rem auto; padding: 0 1rem; max-width: 70rem; }}
.lrbscope-report {{ overflow-x: auto; }}
table {{ border-collapse: collapse; width: 100%; }}
th, td {{ text-align: left; padding: .45rem .7rem; border-bottom: 1px solid color-mix(in srgb, currentColor 20%, transparent); }}
td:nth-child(n+4):nth-child(-n+6) {{ font-variant-numeric: tabular-nums; }}
.touching td:nth-child(-n+6) {{ opacity: .7; }}
img {{ display: block; max-width: 100%; height: auto; background: #fff; border-radius: 6px; }}
</style></head><body><h1>Interference report</h1>
{body}
</body></html>
"""
