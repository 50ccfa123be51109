"""lrbscope.capture: what lrbscope_capture.h records is read, and written again byte for byte."""

import os
import shutil
import subprocess

import numpy as np
import pytest

import lrbscope
from lrbscope import capture

HERE = os.path.dirname(os.path.abspath(__file__))
HEADERS = os.path.join(HERE, "..", "..", "trace", "include")
PROGRAM = os.path.join(os.path.dirname(lrbscope.__file__), "..", "..", "bin", "lrbscope")
needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Return a capture by lrbscope_capture.h."""
    folder = tmp_path_factory.mktemp("recorded")
    source = os.path.join(HERE, "..", "examples", "record.c")
    subprocess.run(["cc", "-std=c99", "-I", HEADERS, source, "-o", folder / "record"], check=True)
    plain = {name: value for name, value in os.environ.items() if not name.startswith("LRBCAP_")}
    subprocess.run([folder / "record"], cwd=folder, env=plain, check=True)
    return folder / "c.lrbcap"


@needs_compiler
def test_what_a_program_recorded(recorded):
    chunks = capture.read(recorded)
    fields = {c.letters: c.fields() for c in reversed(chunks)}  # the first of each kind
    assert fields["HEAD"].name == "engine é" and fields["MESH"].name == "knöt"
    assert fields["MESH"].vertices[3].tolist() == [0.1, 0.2, 1] and fields["MESH"].faces.tolist() == [[0, 2, 1], [0, 1, 3]]
    tree = fields["TREE"]
    assert (tree.mesh, tree.nodes, tree.child.tolist(), tree.prim.tolist()) == (1, 3, [1, 2], [1, 0])
    assert tree.volumes[2].tolist() == [0, 0.25, 0, 1, 1, 1] and tree.float_volumes.shape == (0, 6)
    one, two, three = capture.queries(chunks)
    assert (one.query, one.kind, one.tree_a, one.tree_b, one.verdict, one.pairs, one.n_events) == (1, 1, 1, 2, 1, 1, 4)
    assert one.pose_a[:, 3].tolist() == [4, 5, 6] and np.array_equal(one.pose_b, np.eye(3, 4)) and one.ticks > 0
    assert one.events.tolist() == [(0, 0, 0, 1, 255, 1), (0, 2, 0, 0, 255, 1), (0, 1, 0, 1, 255, 1), (1, 1, 0, 1, 255, 1)]
    assert (three.probe, three.lower, three.pose_b.ravel()[5]) == (1, 0.5, 1)
    assert two.events[["a", "b", "met"]].tolist() == [(4000000000, 300, 0), (1, 0, 1)] and two.verdict == 0


@needs_compiler
def test_chunks_are_written_as_they_were_read(recorded, tmp_path, rng):
    made = [capture.chunk(c.letters, **vars(c.fields()))._replace(time=c.time) for c in capture.read(recorded)]
    capture.write(tmp_path / "again", made)
    assert (tmp_path / "again").read_bytes() == recorded.read_bytes()
    events = np.zeros(3000, capture.EVENT)
    for name, limit in (("kind", 4), ("a", 2**32), ("b", 2**32), ("met", 3), ("axis", 256), ("tests", 256)):
        events[name] = rng.integers(0, limit, 3000) >> rng.integers(0, limit.bit_length(), 3000)
    assert np.array_equal(capture.chunk("EVTS", query=1, events=events).fields().events, events)
    floats = capture.chunk("TREE", volume=2, first_child=[0, 0], first_prim=[0, 0], ids=[7], float_volumes=[[1, 2, 3, 4]]).fields()
    assert (floats.options, floats.ids.tolist(), floats.float_volumes.tolist(), len(floats.volumes)) == (3, [7], [[1, 2, 3, 4]], 0)


@needs_compiler
def test_files_that_are_cut_off_or_none(recorded, tmp_path):
    whole, cut, events = recorded.read_bytes(), tmp_path / "cut", capture.chunk("EVTS", events=[(0, 1, 200, 1, 255, 1)])
    cut.write_bytes(whole[:-33])
    assert [c.letters for c in capture.read(cut)] == [c.letters for c in capture.read(recorded)][:-2]
    cut.write_bytes(b"solid")
    for call, said in (
        (lambda: capture.read(cut), "cut: expected a capture of version 1"),
        (lambda: capture.chunk("VALU", query=1, least=0), "VALU: expected .*, got least"),
        (lambda: capture.Chunk("VALU", 0, bytes(25)).fields(), "VALU: expected 24 bytes, found 25"),
        (lambda: events._replace(content=events.content[:-1]).fields(), "EVTS: expected [0-9]+ bytes, found"),
    ):
        with pytest.raises(ValueError, match=said):
            call()


@pytest.mark.skipif(not os.path.exists(PROGRAM), reason="the program was not built")
def test_answers_are_checked(tmp_path):
    """The ray hits the triangle at 2/3 of its direction, a point is its corner, one box is around it, the other and a second triangle are not."""
    far = np.eye(3, 4) + np.diag([9, 0, 0, 0])[:3, [3, 1, 2, 0]]
    leaf = {"first_child": [0, 0], "first_prim": [0, 1], "prim": [0], "volumes": [[0, 0, 0, 1, 1, 1]]}
    made = [*capture.begin("python"), capture.chunk("MESH", number=1, vertices=np.eye(3), faces=[[0, 1, 2]])]
    made.append(capture.chunk("TREE", number=1, mesh=1, volume=1, **leaf))
    ray = [-1 / 3, -1 / 3, -1 / 3, 1, 1, 1, 0, np.inf]
    probes = (1, ray, 1), (2, [1, 0, 0], 1), (3, [-1, -1, -1, 2, 2, 2], 1), (3, [2, 2, 2, 3, 3, 3], 1)
    for n, (probe, numbers, verdict) in enumerate((*probes, (0, far, 0), (0, far, 1)), 1):
        made.append(capture.chunk("QRYB", query=n, kind=(2, 3, 1, 1)[probe], tree_a=1, tree_b=probe == 0, thread=1, probe=probe, pose_b=numbers))
        if probe:
            made.append(capture.chunk("EVTS", query=n, thread=1, events=[(0, 0, 0, 1, 255, 1), (1, 0, 0, 1, 255, 1)]))
        if probe == 1:
            made.append(capture.chunk("VALU", query=n, lower=2 / 3, upper=2 / 3))
        made.append(capture.chunk("QRYE", query=n, verdict=verdict, pairs=verdict, n_events=2 * (probe > 0)))
    capture.write(tmp_path / "made.lrbcap", made)
    first = next(capture.queries(capture.read(tmp_path / "made.lrbcap")))
    assert first.probe == 1 and first.pose_b.ravel()[:8].tolist() == ray
    *queries, sums = capture.check(tmp_path / "made.lrbcap", program=PROGRAM)
    assert [q["verdict"] for q in queries] == ["right", "right", "right", "wrong", "right", "wrong"] and sums["verdicts"]["wrong"] == 2
    assert [q["exact_pairs"] for q in queries] == [1, 1, 1, 0, 0, 0] and queries[3]["remark"].endswith("intersecting; nothing is hit")
    with pytest.raises(ValueError, match="nothing.lrbcap: no such file"):
        capture.check(tmp_path / "nothing.lrbcap", program=PROGRAM)


@pytest.mark.skipif(not os.path.exists(PROGRAM), reason="the program was not built")
def test_two_levels(tmp_path):
    """A row of three squares that share a tree, the last one turned: a ray, the row with another one, and planted faults."""
    top = 2**32 - 1
    square = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], "faces": [[0, 1, 2], [3, 1, 2]]}
    nodes = {"first_child": [0, 2, 2, 2], "child": [1, 2], "volume": 1}
    places = [np.eye(3, 4), np.eye(3, 4), np.array([[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0]])]
    places[1][0, 3] = 2
    row = {"first_prim": [0, 0, 2, 3], "prim": [0, 1, 2], "bodies": [1, 1, 1], "poses": places}
    boxes = [[0, 0, 0, 5, 1, 0], [0, 0, 0, 3, 1, 0], [4, 0, 0, 5, 1, 0]]
    standing = np.array([[1, 0, 0, 0.25], [0, 0, -1, 0.5], [0, 1, 0, -0.5]])
    parts = [(i, t, x, x + 0.5) for i, pair in enumerate(([0, 0.5], [2, 2.5], [4.5, 4])) for t, x in enumerate(pair)]  # on y = 0.5, z = 0

    def recorded(forgets=(), flat_box=(0, 0, 0, 1, 1, 0), body=1):
        made = [*capture.begin("two levels"), capture.chunk("MESH", number=1, **square)]
        leaves = {"first_prim": [0, 0, 1, 2], "prim": [0, 1], "volumes": [[0, 0, 0, 1, 1, 0], [0, 0, 0, 1, 1, 0], flat_box]}
        made.append(capture.chunk("TREE", number=1, mesh=1, **nodes, **leaves))
        made.append(capture.chunk("TREE", number=2, name="row", volumes=boxes, **nodes, **{**row, "bodies": [1, 1, body]}))
        hit = [(0, n, 0, m, 255, 1) for n, m in ((0, 1), (1, 0), (2, 1))] + [(0, 2, top, 0, 255, 0)]
        hit += [e for e in [(0, 0, 0, 1, 255, 1), (0, 1, 0, 1, 255, 1), (1, 0, 0, 0, 255, 1), (0, 2, 0, 1, 255, 1), (1, 1, 0, 1, 255, 1)] if e not in forgets]
        meets = [(0, 0, 0, 1, 255, 1)]
        for i, f, low, high in parts:
            for j, g, least, most in parts:
                met = low <= most + 0.25 and least + 0.25 <= high
                meets += [(0, i, j, 0, 255, 0), (0, 0, 0, 1, 255, 1), (0, 1 + f, 1 + g, 1, 255, 1), (1, f, g, met, 255, 1)]
        pairs = sum(met for kind, *_, met, _, _ in meets if kind == 1)
        for n, (events, begin, count) in enumerate(
            ((hit, {"probe": 1, "pose_b": [4.3, 0.9, 3, 0, 0, -1, 0, np.inf]}, 1), (meets, {"tree_b": 2, "pose_b": standing}, pairs)), 1
        ):
            made.append(capture.chunk("QRYB", query=n, kind=1, tree_a=2, thread=1, **begin))
            made.append(capture.chunk("EVTS", query=n, thread=1, events=events))
            made.append(capture.chunk("QRYE", query=n, verdict=1, pairs=count, n_events=len(events)))
        capture.write(tmp_path / "made.lrbcap", made)
        return capture.check(tmp_path / "made.lrbcap", program=PROGRAM)

    def said(command):
        return subprocess.run([PROGRAM, command, tmp_path / "made.lrbcap"], capture_output=True, text=True).stdout

    *queries, sums = recorded()
    assert [q["verdict"] for q in queries] == ["right", "right"] and [q["exact_pairs"] for q in queries][0] == 1
    assert queries[1]["exact_pairs"] == queries[1]["right"] > 3 and "tree_faults" not in sums
    assert [q["prices"]["unattributed"] for q in queries] == [0, 0]
    recorded(forgets=[(0, 2, 0, 1, 255, 1), (1, 1, 0, 1, 255, 1)])
    assert "missed 1 of instance 2: node 0 of instance 2, which contains it, and the probe overlap, but" in said("check")
    recorded(flat_box=(0, 0, 0, 0.5, 1, 0))
    assert "triangle 1 of instance 1, corner" in said("tree") and "lies outside node 2 of instance 1 (depth 3) by 0.5" in said("tree")
    with pytest.raises(ValueError, match="instance 2: expected the tree of a mesh, found tree 2 of instances"):
        recorded(body=2)
