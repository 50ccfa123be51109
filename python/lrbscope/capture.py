"""Captures of other engines: read, iterate, check, write. A capture is a list of chunks. FIELDS names their fields, which
docs/capture.md describes. This file alone needs only NumPy.

>>> made = begin("my engine 1.2")
>>> made.append(chunk("MESH", number=1, name="triangle", vertices=np.eye(3), faces=[[0, 1, 2]]))
>>> leaf = dict(first_child=[0, 0], child=[], first_prim=[0, 1], prim=[0])
>>> made.append(chunk("TREE", number=1, mesh=1, volume=1, volumes=[[0, 0, 0, 1, 1, 1]], **leaf))
>>> made.append(chunk("QRYB", query=1, kind=1, tree_a=1, tree_b=1, thread=1))
>>> made.append(chunk("EVTS", query=1, thread=1, events=[(0, 0, 0, 1, 255, 1), (1, 0, 0, 1, 255, 1)]))
>>> made.append(chunk("QRYE", query=1, verdict=1, pairs=1, n_events=2))
>>> write("run.lrbcap", made)
>>> for query in queries(read("run.lrbcap")):
...     print(query.kind, query.verdict, query.pairs, query.events["kind"].tolist())
1 1 1 [0, 1]
"""

from __future__ import annotations

import json
import struct
import subprocess
import time
from collections.abc import Iterable, Iterator
from os import PathLike
from types import SimpleNamespace
from typing import Any, NamedTuple, Union

import numpy as np

__all__ = ["EVENT", "FIELDS", "Chunk", "begin", "check", "chunk", "queries", "read", "write"]

EVENT = np.dtype([("kind", "u1"), ("a", "<u4"), ("b", "<u4"), ("met", "u1"), ("axis", "u1"), ("tests", "u1")])
"""dtype: events. kind: 0 nodes, 1 triangles, 2 counter, 3 phase; axis: 255 for none."""

_Path = Union[str, PathLike[str]]
_MAGIC = b"LRBCAP\r\n\x01\0\0\0\x04\x03\x02\x01"
_SIZE = "(0,6,4,12,10,2*n_directions)[volume%6]"
FIELDS = {
    "HEAD": "name:text",
    "SYNC": "wall_ns:u8",
    "STOP": "wall_ns:u8",
    "RATE": "every:u8",
    "NAME": "number:u4 name:text",
    "MESH": "number:u4 n_vertices:u4 n_faces:u4 n_name:u4 name:text:n_name vertices:f8:n_vertices,3 faces:u4:n_faces,3",
    "TREE": "number:u4 mesh:u4 replaces:u4 nodes:u4 volume:u4 n_directions:u4 options:u4 n_name:u4 ids:u4:nodes*(options&1) "
    "first_child:u4:nodes+1 child:u4:first_child[-1] first_prim:u4:nodes+1 prim:u4:first_prim[-1] "
    f"volumes:f8:nodes*(~options>>1&1),{_SIZE} float_volumes:f4:nodes*(options>>1&1),{_SIZE} directions:f8:n_directions,3 "
    "bodies:u4:mesh*(options>>3&1) poses:f8:mesh*(options>>3&1),3,4 name:text:n_name",
    "QRYB": "zero:u8 query:u4 kind:u4 tree_a:u4 tree_b:u4 zero:u8 thread:u4 probe:u4 pose_a:f8:3,4 pose_b:f8:3,4",
    "EVTS": "query:u4 thread:u4 before:u8 n_events:u4 part:u4 events:event:n_events",
    "VALU": "query:u8 lower:f8 upper:f8",
    "QRYE": "ticks:u8 query:u4 verdict:u4 pairs:u8 n_events:u8 zero:u8",
}
"""dict: for each chunk the fields: name, type, and the shape by the fields before; without one: a number, or the rest as text.
In TREE of instances, mesh is their number. In EVTS, an event of kind 0 without tests enters instances. In QRYB, probe is 1 for a ray, 2 for a point and 3 for a box, whose 8, 3 or 6 numbers are then in pose_b, followed by zeros."""


def _layout(letters: str) -> list[list[str]]:
    if letters not in FIELDS:
        raise ValueError(f"{letters}: expected a chunk of {', '.join(FIELDS)}")
    return [(field + "::").split(":")[:3] for field in FIELDS[letters].split()]


class Chunk(NamedTuple):
    """A chunk. letters: its name; time: when it was written, ticks; content: its bytes."""

    letters: str
    time: int
    content: bytes

    def fields(self) -> SimpleNamespace:
        """Return the fields of the content."""
        values: dict[str, Any] = {}
        at = 0
        for name, type_, shape in _layout(self.letters):
            size = eval(f"({shape or ()},)", {}, values) if shape else ()  # of the expressions above
            if type_ == "event":
                values[name], at = _decoded(self.content, at, *size)
            elif type_ == "text":
                end = at + size[0] if size else len(self.content)
                values[name], at = self.content[at:end].decode(errors="replace"), end
            else:
                array = np.frombuffer(self.content, "<" + type_, int(np.prod(size)), at).reshape(size)
                at += array.nbytes
                values[name] = array if size else array.item()
        if at != len(self.content):
            raise ValueError(f"{self.letters}: expected {at} bytes, found {len(self.content)}")
        return SimpleNamespace(**values)


def chunk(letters: str, /, **given: Any) -> Chunk:
    """Return a chunk of these fields. Others are 0, empty, the identity or, if called n_X, the length of X."""
    given = {name: value.encode() if isinstance(value, str) else value for name, value in given.items()}
    if letters == "TREE":
        given.setdefault("options", ("ids" in given) + 2 * ("float_volumes" in given) + 8 * ("bodies" in given))
        given.setdefault("mesh", len(given.get("bodies", ())))
        given.setdefault("nodes", len(given.get("first_child", (0,))) - 1)
    content, known = b"", []
    for name, type_, shape in _layout(letters):
        known.append(name)
        default: Any = b"" if type_ == "text" else np.eye(3, 4) if shape == "3,4" else () if shape else 0
        if name == "pose_b" and given.get("probe"):
            sizes = {1: (8,), 2: (3,), 3: (6,)}.get(given["probe"], (12,))
            if np.size(given.get(name, ())) not in (*sizes, 12):
                raise ValueError(f"{letters}: pose_b: expected {sizes[0]} numbers of a probe, got {np.size(given.get(name, ()))}")
            given[name] = np.pad(np.ravel(given[name]), (0, 12 - np.size(given[name])))
        value = given.get(name, len(given.get(name[2:], ())) if name[:2] == "n_" else default)
        if type_ == "event":
            value = _encoded(value)
        content += value if isinstance(value, bytes) else np.asarray(value, "<" + type_).tobytes()
    if unknown := set(given) - set(known):
        raise ValueError(f"{letters}: expected {', '.join(known)}, got {unknown.pop()}")
    made = Chunk(letters, time.perf_counter_ns(), content)
    made.fields()  # raises ValueError if shapes do not fit
    return made


def _decoded(content: bytes, at: int, count: int) -> tuple[Any, int]:
    """Return `count` events from the byte `at` on, and the byte behind them."""
    rows, last = [], [[0, 0] for _ in range(4)]
    count = min(count, len(content))
    content += bytes(14 * count)  # in which events that are cut off end
    for _ in range(count):
        flags, at = content[at], at + 1
        tests, met, axis, ends = 1, flags >> 2 & 1, 255, last[flags & 3]
        if flags & 8:
            tests, met, at = content[at], content[at + 1], at + 2
        if flags & 16:
            axis, at = content[at], at + 1
        for side in (0, 1):  # the difference from the event of this kind before, in groups of seven bits
            z, shift = content[at] & 127, 7
            while content[at] >= 128:
                at += 1
                z |= (content[at] & 127) << shift
                shift += 7
            at += 1
            ends[side] = ends[side] + (z >> 1 ^ -(z & 1)) & 0xFFFFFFFF
        rows.append((flags & 3, *ends, met, axis, tests))
    return np.array(rows, EVENT), at


def _encoded(events: Any) -> bytes:
    out, last = bytearray(), [(0, 0)] * 4
    for kind, a, b, met, axis, tests in np.asarray(events, EVENT).tolist():
        counted = tests != 1 or met > 1
        out += bytes([kind | (8 if counted else 4 * met) | 16 * (axis != 255)])
        out += bytes([tests, met] * counted + [axis] * (axis != 255))
        for now, before in zip((a, b), last[kind]):
            d = now - before & 0xFFFFFFFF
            z = (d << 1 ^ -(d >> 31)) & 0xFFFFFFFF
            while z >= 128:
                out.append(z & 127 | 128)
                z >>= 7
            out.append(z)
        last[kind] = a, b
    return bytes(out)


def begin(engine: str) -> list[Chunk]:
    """Return the first chunks of a capture."""
    chunks = [chunk("HEAD", name=engine), chunk("SYNC", wall_ns=time.time_ns())]
    time.sleep(0.001)  # two readings of the clock give the length of a tick
    return [*chunks, chunk("SYNC", wall_ns=time.time_ns())]


def read(path: _Path) -> list[Chunk]:
    """Return the chunks of a capture; of one that was cut off, the complete ones."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:16] != _MAGIC:
        raise ValueError(f"{path}: expected a capture of version 1")
    chunks, at = [], 16
    while len(data) >= at + 24:
        letters, _, size, ticks = struct.unpack_from("<4sIQQ", data, at)
        at += 24 + size
        if at <= len(data):
            chunks.append(Chunk(letters.decode("latin-1"), ticks, data[at - size : at]))
    return chunks


def write(path: _Path, chunks: Iterable[Chunk]) -> None:
    """Write a capture. Its last chunk should be STOP."""
    with open(path, "wb") as file:
        file.write(_MAGIC)
        for letters, ticks, content in chunks:
            # Of a probe, of instances.
            version = 1 + (letters == "QRYB" and any(content[36:40]) or letters == "TREE" and content[24] >> 3 & 1)
            file.write(struct.pack("<4sIQQ", letters.encode("latin-1"), version, len(content), ticks) + content)


def queries(chunks: Iterable[Chunk]) -> Iterator[SimpleNamespace]:
    """Yield the queries in the order of their ends: the fields of QRYB, QRYE and VALU, and the events of all threads, one after the other.
    """
    found: dict[int, Any] = {}
    ended = []
    for c in chunks:
        if c.letters in ("QRYB", "EVTS", "VALU", "QRYE"):
            fields = c.fields()
            query = found.setdefault(fields.query, SimpleNamespace(events=[]))
            if c.letters == "EVTS":
                query.events.append((fields.thread, fields.events))
            else:
                vars(query).update(vars(fields))
            if c.letters == "QRYE":
                ended.append(query)
    for query in ended:
        parts = sorted(query.events, key=lambda part: part[0])  # each thread's in the order of the file
        query.events = np.concatenate([np.empty(0, EVENT), *(events for _, events in parts)])
        yield query


def check(path: _Path, *options: str, program: str = "lrbscope") -> list[dict[str, Any]]:
    """Return what `lrbscope check --json` prints: a dict for each query, and one of the sums."""
    done = subprocess.run([program, "check", path, "--json", *options], capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: an answer is wrong
        raise ValueError(done.stderr.strip())
    return [json.loads(line) for line in done.stdout.splitlines()]
