#!/usr/bin/env python3
"""doors.py LRBSCOPE MATRIX_BODIES [--all] [--only KIND] [--python PYTHON PACKAGE]: the matrix (README.md) through the
command, scenarios and Python. Prints faults with the commands that show them, and exits with 1; otherwise the number of commands.

Each command ends within SECONDS with exit code 0, 1, 2 or 3; rejections are one line.
"""
import argparse
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys
import tempfile

SECONDS, SANITIZED = 120, 1800


class Wrong(Exception):
    pass


def expect(right, what):
    if not right:
        raise Wrong(what)


# What answers must be. Lines are as the command prints them; Python's answers are put into the same words.


def check_pairs(line, step):
    expect(line["relation"] == step["relation"], f"{line['relation']}, brute force says {step['relation']}")
    expect(line["pairs"] == len(step["pairs"]), f"{line['pairs']} pairs, brute force has {len(step['pairs'])}")
    expect(line["fingerprint"] == step["fingerprint"] and line["list"] == step["pairs"], "other pairs")


def check_one(line, step, exact):
    expect(line["pairs"] == min(1, len(step["pairs"])), f"{line['pairs']} pairs")
    check_some(line, step)
    expect(not exact and step["pairs"] or line["relation"] == step["relation"], line["relation"])


def check_some(line, step):
    expect(all(pair in step["pairs"] for pair in line["list"]), "pairs that do not meet")


def check_coarse(line, step):
    expect(line["relation"] == step["relation"] and line["finished"], line["relation"])
    expect(line["relation"] == "crossing" or line["fingerprint"] == step["fingerprint"], "other pairs")


def check_limited(line, step):
    exact = line["relation"] != "unresolved" and line["error_bound"] == 0
    expect(not exact or line["relation"] == step["relation"], line["relation"])
    expect(not step["pairs"] or line["relation"] in ("crossing", "touching", "unresolved"), "bodies that meet are called apart")


def check_distance(line, step, size):
    low, high = line["distance"] if "distance" in line else (line["lower"], line["upper"])
    right = low <= high and low - step["distance"] <= 1e-7 * size and abs(high - step["distance"]) <= 1e-7 * size
    expect(right, f"from {low} to {high}, brute force has {step['distance']}")
    expect((high == 0) == bool(step["pairs"]), "0 only where they meet")


def check_near(line, step):
    """Pairs at distance 0: those that intersect."""
    expect(line["found"] == len(step["pairs"]), f"{line['found']} pairs at distance 0, brute force has {len(step['pairs'])}")
    expect([pair["triangles"] for pair in line["pairs"]] == step["pairs"], "other pairs at distance 0")


def check_nearest(line, step, size, within):
    """The nearest of the pairs within a distance."""
    found = line["pairs"][:1]
    if found:
        check_distance(found[0], step, size)
    expect(bool(found) or step["distance"] > within * (1 - 1e-7), "no pair, but one is near")


def check_manifold(line, step, size):
    """Every pair is in one manifold, and points are apart along the normal by the depth."""
    pairs = sorted(pair for m in line["manifolds"] for pair in m["list"])
    expect(line["pairs"] == len(pairs) and pairs == step["pairs"], "other pairs in manifolds")
    for m in line["manifolds"]:
        expect(1 <= len(m["points"]) <= 4, f"{len(m['points'])} points")
        for p in m["points"]:
            off = [a - b - p["depth"] * n for a, b, n in zip(p["point_a"], p["point_b"], m["normal"])]
            expect(all(abs(x) <= 1e-7 * size for x in off), "points that are not apart by the depth")


def check_points(lines):
    """The corners of a body are on it."""
    expect(lines, "no points")
    for i, line in enumerate(lines):
        expect(line["point"] == i and line["lower"] == line["upper"] == 0, "a corner of the body is off it")
        expect(line["side"] == "on the surface", line["side"])


def check_self_intersections(lines, kind):
    """Pairs ascend, curves are numbered from 0, and through every door the pairs are the same."""
    pairs = [line["faces"] for line in lines]
    expect(not (pairs and kind["simple"]), f"{len(pairs)} self-intersections of a simple body")
    expect(pairs == sorted(pairs) and all(a < b for a, b in pairs), "order of the pairs")
    curves = {line["curve"] for line in lines}
    expect(curves == set(range(len(curves))), "numbers of curves")
    expect(pairs == kind.setdefault("crossing", pairs), "through another door other pairs")


OVERLAP = ("protrudes", "pierces", "cuts_through")
INSIDE = ("a_inside_b", "b_inside_a")
TOUCH = ("touching_point", "touching_edge", "touching_face", "equal")
KINDS = {"separate": ("apart",), "undefined": ("apart",), "crossing": OVERLAP, "touching": TOUCH + OVERLAP + INSIDE}


def check_clash(line, step, cell):
    kinds = KINDS.get(step["relation"], OVERLAP + INSIDE)
    if kinds != ("apart",) and not cell["simple"]:
        kinds = TOUCH + OVERLAP + INSIDE + ("undecided",)
    expect(line["kind"] in kinds, f"{line['kind']}, by the relation one of {' '.join(kinds)}")
    first = cell.setdefault("kinds", {}).setdefault(str(step["pose"]), line["kind"])
    expect(line["kind"] == first, f"{line['kind']}, through another door {first}")


def check_sweep(line, cell):
    expect(cell["meets"] is None or line["contact"] is not False and line["t0"] <= cell["meets"], "bodies that meet never do")
    expect(line["contact"] is False or line["t0"] <= line["t1"], "no interval")


class Matrix:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        if not options.files:
            subprocess.run([options.matrix_bodies, folder] + (["12"] if options.all else []), check=True)
        with open(os.path.join(folder, "matrix.json"), encoding="utf-8") as f:
            self.data = json.load(f)
        self.kinds = {kind["name"]: kind for kind in self.data["kinds"]}
        for cell in self.data["cells"]:
            cell["simple"] = all(self.kinds[cell[x]]["solid"] and self.kinds[cell[x]]["simple"] for x in "ab")
            cell["dim"] = self.kinds[cell["a"]]["dim"]
        self.count, self.wrong = 0, []

    def start(self, words, codes=(0,)):
        """Runs a command; returns its exit code, output, and faults of its end."""
        self.count += 1
        seconds = SANITIZED if self.options.sanitized else SECONDS
        try:
            done = subprocess.run(words, cwd=self.folder, capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return None, "", f"no end in {seconds} s"
        out, err = (text.decode(errors="replace") for text in (done.stdout, done.stderr))
        trouble = ""
        if done.returncode not in codes:
            trouble = f"exit code {done.returncode}: {(err or out)[-3000:]}"
        elif done.returncode >= 2 and (err.count("\n") != 1 or out):
            trouble = f"a refusal must be one line: {err}{out[:300]}"
        return done.returncode, out, trouble

    def run(self, words, check=None, codes=(0,), made=None):
        """Asks the command. `check` gets its lines of JSON, `codes` are those with which it may end, `made` is a file
        that it must write.
        """
        words = [self.options.lrbscope] + words
        code, out, trouble = self.start(words, codes)
        if code in (0, 1) and not trouble:
            try:
                expect(not made or os.path.getsize(os.path.join(self.folder, made)), "an empty file")
                if check:
                    check([json.loads(line) for line in out.splitlines()])
            except (Wrong, OSError, ValueError, LookupError, TypeError) as e:
                trouble = f"{type(e).__name__}: {e}"
        if trouble:
            self.wrong.append(f"{shlex.join(words)}\n    {trouble.strip()}")

    def doors(self, kind):
        """Saves a kind's body in other forms; returns its files by door."""
        name = kind["name"]
        files = {ending: f"{name}.{ending}" for ending in kind["files"]}
        codes = (0,) if kind["builds"] else (2,)
        build = ["build", f"{name}.obj", "-o", f"{name}.levels.lrb", "--json"]
        self.run(build, lambda lines: expect(lines[0]["valid"], "invalid"), codes)
        save = [self.options.matrix_bodies, "--save", f"{name}.obj", f"{name}.lrb"]
        trouble = self.start(save)[2]
        if trouble:
            self.wrong.append(f"{shlex.join(save)}\n    {trouble}")
        for door in ("lrb", "levels.lrb"):
            if os.path.exists(os.path.join(self.folder, f"{name}.{door}")):
                files[door] = f"{name}.{door}"
        return files if self.options.all else {door: files[door] for door in ("obj", "levels.lrb") if door in files}

    def questions(self, cell, a, b):
        """All questions about the two bodies of a cell, whose files are a and b."""
        name, steps, size, every = cell["name"], cell["steps"], cell["size"], self.options.all

        def each(check, *more):
            def check_lines(lines):
                expect(len(lines) == len(steps), f"{len(lines)} lines")
                for line, step in zip(lines, steps):
                    check(line, step, *more)

            return check_lines

        def check_all(line, step):
            check_pairs(line, step)
            check_distance(line, step, size)

        def check_within(line, step):
            expect(line["within"] == (step["distance"] <= size), "wrong about within")

        poses = [a, b, "--poses", f"{name}.txt"]
        query = ["query"] + poses + ["--pairs"]
        self.run(query + ["--distance"], each(check_all))
        self.run(query + ["--tolerance", repr(size / 20)], each(check_coarse))
        along = ["--along", "1,0.5,0"] if every else []
        self.run(["clash"] + poses + along, each(check_clash, cell), (0,) if cell["dim"] == 3 else (2,))
        self.run(["sweep", a, b, "--motions", f"{name}.motion.txt"], lambda lines: check_sweep(lines[0], cell))
        self.run(["why"] + poses + ["--json"])
        self.run(["near"] + poses + ["--within", "0"], each(check_near))
        nearest = ["--within", repr(size), "--nearest", "1"]
        self.run(["near"] + poses + nearest, each(check_nearest, size, size))
        self.run(["manifold"] + poses + ["--pairs"], each(check_manifold, size))
        self.run(["manifold"] + poses + ["--margin", repr(size / 20)])
        self.run(["points", a, f"{cell['a']}.points.txt"], check_points)
        self.run(["inspect", a, "--self-intersections"], lambda lines: check_self_intersections(lines, self.kinds[cell["a"]]), (0, 1))
        if not every:
            return
        self.run(query + ["--mode", "first"], each(check_one, True))
        self.run(query + ["--mode", "any"], each(check_one, False))
        self.run(query + ["--recursion", "paper"], each(check_some))
        self.run(query + ["--max-tests", "40"], each(check_limited))
        self.run(query + ["--max-time", "0.01"], each(check_limited))
        self.run(query + ["--separation"], each(check_pairs))
        self.run(["distance"] + poses + ["--features"], each(check_distance, size))
        self.run(["distance"] + poses + ["--within", repr(size)], each(check_within))
        for pose, step in enumerate(steps):
            pair = ",".join(str(i) for i in (step["pairs"] or [[0, 0]])[-1])
            self.run(["why"] + poses + ["--json", "--pose", str(pose), "--pair", pair])

    def pages(self, cell, a, b):
        """All pages and pictures of two bodies."""
        name, out = cell["name"], f"out/{cell['name']}-{a}"
        apart = str(next(i for i, step in enumerate(cell["steps"]) if not step["pairs"]))
        in_space = cell["dim"] == 3
        poses = [a, b, "--poses", f"{name}.txt"]
        more = ["--distance", "--events", "all"] + (["--clash"] if in_space else [])
        self.run(["collide", a, b, "-o", f"{out}-1", "--size", "640x480"], made=f"{out}-1/index.html")
        self.run(["collide"] + poses + more + ["-o", f"{out}-2", "--size", "640x480"], made=f"{out}-2/index.html")
        self.run(["figure", f"{out}-2", "-o", f"{out}.pdf", "--dpi", "100"], made=f"{out}.pdf")
        self.run(["export", f"{out}-2", "-o", f"{out}.glb"], made=f"{out}.glb")
        self.run(["distance"] + poses + ["--draw", f"{out}-d.png"], made=f"{out}-d-0.png")
        near = ["near"] + poses + ["--within", repr(cell["size"] / 20)]
        self.run(near + ["--draw", f"{out}-n.png"], made=f"{out}-n-0.png")
        manifold = ["manifold"] + poses + ["--margin", repr(cell["size"] / 20)]
        self.run(manifold + ["--draw", f"{out}-m.png"], made=f"{out}-m-0.png")
        self.run(["clash"] + poses + ["--draw", f"{out}-c.png"], None, (0,) if in_space else (2,), f"{out}-c-0.png")
        self.run(["sweep", a, b, "--motions", f"{name}.motion.txt", "--draw", f"{out}-s.png"], made=f"{out}-s.png")
        self.run(["why"] + poses + ["--pose", apart, "-o", f"{out}-w.png"], made=f"{out}-w.png")
        self.run(["why"] + poses + ["--pose", apart, "--pair", "0,0", "-o", f"{out}-p.png"], made=f"{out}-p.png")

    def body_pages(self, kind, file):
        """All pages and pictures of one body."""
        out, stored = f"out/{file}", file.endswith(".lrb")
        built = (0,) if kind["builds"] else (0, 2)
        self.run(["inspect", file, "--json"], lambda lines: expect(lines, "nothing"))
        self.run(["inspect", file, "--render", "-o", f"{out}-r.png", "--size", "640x480"], made=f"{out}-r.png")
        self.run(["inspect", file, "--draw", f"{out}-f.png"], None, (2,) if stored else (0,))
        self.run(["inspect", file, "--regions"], None, (0, 2))
        crossing = ["inspect", file, "--self-intersections", "--draw", f"{out}-x.png"]
        self.run(crossing, lambda lines: check_self_intersections(lines, kind), (0, 1), f"{out}-x.png")
        points = ["points", file, f"{kind['name']}.points.txt", "--draw", f"{out}-p.png"]
        self.run(points, check_points, made=f"{out}-p.png")
        self.run(["inspect", file, "--validate"], None, (0,) if stored or kind["builds"] else (0, 2))
        self.run(["figure", file, "-o", f"{out}.png", "--dpi", "100"], None, built)
        self.run(["inspect", file, "--levels"], None, built)
        self.run(["export", file, "-o", f"{out}.ply"], made=f"{out}.ply")
        self.run(["close", file, "-o", f"{out}-closed.obj"], None, (0, 1, 2))

    def check_run(self, cell, out):
        """Corners of B in the summary of a run: all are there, and none is nearer to A than B."""
        with open(os.path.join(self.folder, f"{cell['b']}.points.txt"), encoding="utf-8") as file:
            corners = len(file.readlines())
        try:
            with open(os.path.join(self.folder, out, "summary.json"), encoding="utf-8") as file:
                found = [step["points"] for step in json.load(file)["steps"]]
            expect(len(found) == len(cell["steps"]), f"{len(found)} steps")
            for points, step in zip(found, cell["steps"]):
                expect(points["count"] == corners, f"{points['count']} points of {corners}")
                if not step["pairs"]:
                    nearest = min(abs(x) for p in points["smallest"] for x in p[2:4])
                    expect(nearest >= step["distance"] * (1 - 1e-7), "a point of B is nearer than B")
        except (Wrong, OSError, KeyError) as e:
            self.wrong.append(f"{out}\n    {e!r}")

    def python(self, kind):
        """Has the kind asked about from Python, in a process of its own."""
        python, package = self.options.python
        words = [python, os.path.abspath(__file__), "-", "-", "--files", self.folder, "--only", kind["name"]] + ["--all"] * self.options.all
        words = ["env", f"PYTHONPATH={package}", "PYTHONDONTWRITEBYTECODE=1"] + words
        _, out, trouble = self.start(words, (0, 1))
        self.wrong += [f"Python: {line}" for line in out.splitlines()]
        if trouble:
            self.wrong.append(f"{shlex.join(words)}\n    {trouble}")

    def row(self, i, kind):
        """All cells of a kind."""
        cells = [cell for cell in self.data["cells"] if cell["a"] == kind["name"]]
        files = self.doors(kind)
        for k, cell in enumerate(cells):
            for a in files.values() if self.options.all else list(files.values())[k % len(files) :][:1]:
                self.questions(cell, a, a if cell["a"] == cell["b"] else f"{cell['b']}.obj")
            if self.options.all or i == 0:
                self.run(["run", f"{cell['name']}.json", "-o", f"out/{cell['name']}"])
                self.check_run(cell, f"out/{cell['name']}")
        for a in files.values() if self.options.all else [files["obj"]] * (i == 0):
            self.body_pages(kind, a)
            self.pages(cells[0], a, f"{cells[0]['b']}.obj")
        if self.options.python:
            self.python(kind)


def ask_python(matrix, name):
    """The door of Python: arrays, files and python-fcl's interface. Prints what is wrong; returns how much."""
    import numpy as np
    import lrbscope
    from lrbscope import fcl

    def body(door, kind):
        file, saved = (os.path.join(matrix.folder, f"{kind}.{ending}") for ending in ("obj", f"{os.getpid()}.lrb"))
        made = lrbscope.Body.load(file, regions=door != "no regions")
        if door == "arrays" and isinstance(made.faces, np.ndarray):
            return lrbscope.Body(made.vertices, made.faces)
        if door == "lrb with levels":
            made.levels()
        if door.startswith("lrb"):
            made.save(saved)
            return lrbscope.Body.load(saved)
        return made

    def model(body, pose):
        mesh = fcl.BVHModel()
        mesh.beginModel(len(body.triangles), len(body.vertices))
        mesh.addSubModel(body.vertices, body.triangles)
        mesh.endModel()
        return fcl.CollisionObject(mesh, fcl.Transform(pose[:3, :3], pose[:3, 3]))

    def words_of(r):
        return {"relation": r.relation, "pairs": len(r.pairs), "fingerprint": r.fingerprint, "list": r.pairs.tolist(),
                "finished": r.finished, "error_bound": r.error_bound}

    def ask(a, b, cell):
        size, steps = cell["size"], cell["steps"]
        crossing = lrbscope.self_intersections(a)
        lines = [{"faces": pair, "curve": curve} for pair, curve in zip(crossing.faces.tolist(), crossing.curve.tolist())]
        check_self_intersections(lines, matrix.kinds[cell["a"]])
        on = lrbscope.signed_distance(a, a.vertices[np.unique(a.triangles)])
        expect(not on.lower.any() and not on.upper.any() and not (on.side % 2).any(), "corners off the surface")
        poses = np.array([np.vstack([np.reshape(step["pose"], (3, 4)), [0, 0, 0, 1]]) for step in steps])
        coherent = lrbscope.CoherentQuery(a, b)
        batch = lrbscope.collide(a, b, poses)
        for i, (pose, step) in enumerate(zip(poses, steps)):
            check_pairs(words_of(batch[i]), step)
            check_pairs(words_of(coherent.collide(pose)), step)
            check_pairs(words_of(lrbscope.collide(a, b, pose, separation=True)), step)
            check_one(words_of(lrbscope.collide(a, b, pose, mode="first")), step, True)
            check_one(words_of(lrbscope.collide(a, b, pose, mode="any")), step, False)
            check_coarse(words_of(lrbscope.collide(a, b, pose, tolerance=size / 20)), step)
            check_limited(words_of(lrbscope.collide(a, b, pose, max_tests=40)), step)
            check_some(words_of(lrbscope.collide(a, b, pose, recursion="paper")), step)
            near = lrbscope.near_pairs(a, b, pose, within=0)
            expect(near.triangles.tolist() == step["pairs"] and near.found == len(near), "other pairs at distance 0")
            manifolds = lrbscope.contact_manifolds(a, b, pose)
            held = manifolds.triangles[np.concatenate([*manifolds.pairs, np.empty(0, int)]).astype(int)]
            expect(sorted(held.tolist()) == step["pairs"], "manifolds do not share out the pairs")
            d = lrbscope.distance(a, b, pose)
            check_distance({"lower": d.lower, "upper": d.upper}, step, size)
            shared = sum(len(region.pairs) for region in lrbscope.contacts(a, b, pose))
            expect(shared == len(step["pairs"]), "regions do not share out the pairs")
            lrbscope.explain_walk(a, b, pose)
            scene = lrbscope.Scene()
            scene.add(a), scene.add(b, pose)
            expect(len(scene.collide()) == (step["relation"] not in ("separate", "undefined")), "the scene finds others")
            if a.dim == 2:
                continue
            check_clash({"kind": lrbscope.clash(a, b, pose, depth=False, volume=False).kind}, step, cell)
            one, other, found = model(a, np.eye(4)), model(b, pose), fcl.CollisionResult()
            fcl.collide(one, other, fcl.CollisionRequest(num_max_contacts=1 << 20), found)
            expect(sorted([c.b1, c.b2] for c in found.contacts) == step["pairs"], "fcl finds other pairs")
            apart = fcl.distance(one, other, fcl.DistanceRequest(), fcl.DistanceResult())
            expect(abs(apart - step["distance"]) <= 1e-7 * size, f"fcl finds the distance {apart}")

    wrong = 0
    for door in ("arrays", "file", "no regions", "lrb", "lrb with levels") if matrix.options.all else ("arrays", "lrb with levels"):
        for cell in (cell for cell in matrix.data["cells"] if cell["a"] == name):
            try:
                ask(body(door, cell["a"]), body(door, cell["b"]), cell)
            except Exception as e:  # all that Python can say of it
                print(f"{cell['name']}, {door}: {type(e).__name__}: {e}")
                wrong += 1
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("lrbscope", type=os.path.abspath)
    parser.add_argument("matrix_bodies", type=os.path.abspath)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--sanitized", action="store_true")
    parser.add_argument("--only")
    parser.add_argument("--files")
    parser.add_argument("--python", nargs=2)
    options = parser.parse_args()
    if options.files:
        return 1 if ask_python(Matrix(options, options.files), options.only) else 0
    if options.python and not os.path.isdir(os.path.join(options.python[1], "lrbscope")):
        print("Python: not built, left out")
        options.python = None
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        matrix = Matrix(options, folder)
        rows = {cell["a"]: None for cell in matrix.data["cells"]}
        chosen = [(i, name) for i, name in enumerate(rows) if options.only == name or not options.only and (options.all or i % 5 == 0)]
        for row in [pool.submit(matrix.row, i, matrix.kinds[name]) for i, name in chosen]:
            row.result()
    print("\n".join(matrix.wrong + [f"{matrix.count} commands, {len(matrix.wrong)} findings"]))
    return 1 if matrix.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
