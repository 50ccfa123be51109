#!/usr/bin/env python3
"""doors.py LRBSCOPE MATRIX_BODIES [--all] [--only KIND] [--python PYTHON PACKAGE]: the matrix (README.md) through
the command and Python. Prints what is wrong, with the command that shows it, and exits with 1; else what was asked.

Each command ends within SECONDS with exit code 0, 1, 2 or 3; what it refuses it refuses in one line.
"""
import argparse
import concurrent.futures
import json
import math
import os
import shlex
import subprocess
import sys
import tempfile

SECONDS = 120
SANITIZED = 15  # times as long


class Wrong(Exception):
    pass


def expect(right, what):
    if not right:
        raise Wrong(what)


# What answers must be. Lines are as the command prints them; Python's answers are put into the same words.


def check_pairs(line, step):
    expect(line["relation"] == step["relation"], f"{line['relation']}, brute force says {step['relation']}")
    expect(line["pairs"] == len(step["pairs"]), f"{line['pairs']} pairs, brute force has {len(step['pairs'])}")
    expect(line["fingerprint"] == step["fingerprint"], "other pairs")
    expect("list" not in line or line["list"] == step["pairs"], "another list of pairs")


def check_one(line, step, exact):
    expect(line["pairs"] == min(1, len(step["pairs"])) and line["list"][0:1] == [p for p in step["pairs"] if p in line["list"]],
           "not one of the pairs")
    expect(not exact and step["pairs"] or line["relation"] == step["relation"], line["relation"])


def check_some(line, step):
    expect(all(pair in step["pairs"] for pair in line["list"]), "pairs that do not meet")


def check_coarse(line, step):
    expect(line["relation"] == step["relation"] and line["finished"], line["relation"])
    expect(line["relation"] == "crossing" or line["fingerprint"] == step["fingerprint"], "other pairs")


def check_limited(line, step):
    expect(line["relation"] in (step["relation"], "unresolved") or line["error_bound"] is None or line["error_bound"] > 0,
           line["relation"])
    expect(not step["pairs"] or line["relation"] in ("crossing", "touching", "unresolved"), "bodies that meet are called apart")


def check_distance(line, step, size):
    low, high = line["distance"] if "distance" in line else (line["lower"], line["upper"])
    slack = 1e-7 * size
    expect(low <= high and abs(high - step["distance"]) <= slack and low <= step["distance"] + slack,
           f"from {low} to {high}, brute force has {step['distance']}")
    expect((high == 0) == bool(step["pairs"]), "0 only where they meet")


OVERLAP = ("protrudes", "pierces", "cuts_through")
INSIDE = ("a_inside_b", "b_inside_a")
TOUCH = ("touching_point", "touching_edge", "touching_face", "equal")
KINDS = {"separate": ("apart",), "undefined": ("apart",), "crossing": OVERLAP, "touching": TOUCH + OVERLAP + INSIDE,
         "a_inside_b": OVERLAP + INSIDE, "b_inside_a": OVERLAP + INSIDE}


def check_clash(line, step, cell, plain):
    kinds = KINDS[step["relation"]] if plain or not step["pairs"] else TOUCH + OVERLAP + INSIDE + ("undecided",)
    expect(line["kind"] in kinds, f"{line['kind']}, by the relation one of {' '.join(kinds)}")
    first = cell.setdefault("kinds", {}).setdefault(step["fingerprint"] + str(step["pose"]), line["kind"])
    expect(line["kind"] == first, f"{line['kind']}, through another door {first}")


def check_sweep(line, cell):
    expect(cell["meets"] is None or line["contact"] is not False and line["t0"] <= cell["meets"], "bodies that meet never do")
    expect(line["contact"] is False or line["t0"] <= line["t1"], "no interval")


class Matrix:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        if not options.files:
            subprocess.run([options.matrix_bodies, folder] + (["12"] if options.all else []), check=True)
        with open(os.path.join(folder, "matrix.json")) as f:
            self.data = json.load(f)
        self.kinds = {kind["name"]: kind for kind in self.data["kinds"]}
        self.asked, self.wrong = 0, []
        self.seconds = SECONDS * (SANITIZED if options.sanitized else 1)

    def start(self, words):
        """Runs a command; returns its exit code, output and what is wrong with the way it ended."""
        self.asked += 1
        try:
            done = subprocess.run(words, cwd=self.folder, capture_output=True, timeout=self.seconds, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return None, "", f"no end in {self.seconds} s"
        out, err = (text.decode(errors="replace") for text in (done.stdout, done.stderr))
        if done.returncode not in (0, 1, 2, 3):
            return done.returncode, out, f"exit code {done.returncode} {err[-3000:]}"
        if done.returncode >= 2 and (err.count("\n") != 1 or not err.strip() or out):
            return done.returncode, out, f"a refusal must be one line: {err}{out[:300]}"
        return done.returncode, out, "" if done.returncode == 0 else f"exit code {done.returncode}: {err or out[-300:]}"

    def run(self, words, check=None, codes=(0,), made=None):
        """Asks the command; `check` gets the lines of JSON. `codes`: with which it may end; `made`: a file that it writes."""
        words = [self.options.lrbscope] + words
        code, out, trouble = self.start(words)
        if code in codes and not trouble.startswith(("a refusal", "no end")):
            trouble = ""
        if code == 0 and not trouble:
            if 0 not in codes:
                trouble = "is not refused"
            elif made and not os.path.getsize(os.path.join(self.folder, made)):
                trouble = "wrote nothing"
            elif check:
                try:
                    check([json.loads(line) for line in out.splitlines()])
                except (Wrong, ValueError, KeyError, TypeError) as e:
                    trouble = f"{type(e).__name__}: {e}"
        if trouble:
            self.wrong.append(f"{shlex.join(words)}\n    {trouble.strip()}")

    def bodies(self, kind):
        """Saves a kind's body in other forms; returns its files by door."""
        name, builds = kind["name"], kind["builds"]
        files = {ending: f"{name}.{ending}" for ending in kind["files"]}
        codes = {True: (0,), False: (2,), None: (0, 2)}[builds]
        self.run(["build", f"{name}.obj", "-o", f"{name}.levels.lrb", "--json"], lambda lines: expect(lines[0]["valid"], lines[0]), codes)
        self.run(["inspect", f"{name}.obj", "--validate"], None, codes)
        if self.start([self.options.matrix_bodies, "--save", f"{name}.obj", f"{name}.lrb"])[2]:
            self.wrong.append(f"matrix_bodies --save {name}.obj {name}.lrb\n    crash or hang")
        for door, file in (("lrb", f"{name}.lrb"), ("lrb with levels", f"{name}.levels.lrb")):
            if os.path.exists(os.path.join(self.folder, file)):
                files[door] = file
        return files

    def questions(self, cell, door, a, b):
        """All questions about the two bodies of a cell, whose files are a and b."""
        name, steps, size = cell["name"], cell["steps"], cell["size"]
        kinds = self.kinds[cell["a"]], self.kinds[cell["b"]]
        plain = all(kind["solid"] and kind["simple"] for kind in kinds)
        in_space = kinds[0]["dim"] == 3

        def each(check):
            def check_lines(lines):
                expect(len(lines) == len(steps), f"{len(lines)} lines")
                for line, step in zip(lines, steps):
                    check(line, step)
            return check_lines

        query = ["query", a, b, "--poses", f"{name}.txt", "--pairs"]
        self.run(query + ["--distance"], each(lambda line, step: (check_pairs(line, step), check_distance(line, step, size))))
        if not self.options.all and (door != "lrb with levels" and door != "obj"):
            return
        self.run(query + ["--mode", "first"], each(lambda line, step: check_one(line, step, True)))
        self.run(query + ["--mode", "any"], each(lambda line, step: check_one(line, step, False)))
        self.run(query + ["--recursion", "paper"], each(check_some))
        self.run(query + ["--tolerance", repr(size / 20)], each(check_coarse))
        self.run(query + ["--max-tests", "40"], each(check_limited))
        self.run(query + ["--max-time", "0.01"], each(check_limited))
        self.run(query + ["--separation"], each(check_pairs))
        poses = [a, b, "--poses", f"{name}.txt"]
        self.run(["distance"] + poses + ["--features"], each(lambda line, step: check_distance(line, step, size)))
        self.run(["distance"] + poses + ["--within", repr(size)],
                 each(lambda line, step: expect(line["within"] == (step["distance"] <= size), "wrong about within")))
        self.run(["clash"] + poses + ["--along", "1,0.5,0", "--clearance", "0"],
                 each(lambda line, step: check_clash(line, step, cell, plain)), (0,) if in_space else (2,))
        self.run(["sweep", a, b, "--motions", f"{name}.motion.txt"], lambda lines: check_sweep(lines[0], cell))
        for pose in range(len(steps)):
            why = ["why"] + poses + ["--json", "--pose", str(pose)]
            self.run(why)
            self.run(why + ["--pair", "{},{}".format(*(steps[pose]["pairs"] or [[0, 0]])[-1])])

    def pages(self, cell, door, a, b):
        """All pages and pictures of two bodies."""
        name, out = cell["name"], f"{cell['name']}-{door.replace(' ', '-')}"
        apart = next(i for i, step in enumerate(cell["steps"]) if not step["pairs"])
        in_space = self.kinds[cell["a"]]["dim"] == 3
        size = ["--size", "320x240"]
        poses = [a, b, "--poses", f"{name}.txt"]
        self.run(["collide", a, b, "-o", f"{out}-approach"] + size, made=f"{out}-approach/index.html")
        self.run(["collide"] + poses + ["-o", f"{out}-poses", "--distance", "--events", "all"] + (["--clash"] if in_space else []) + size,
                 made=f"{out}-poses/index.html")
        self.run(["figure", f"{out}-poses", "-o", f"{out}.pdf", "--dpi", "100"], made=f"{out}.pdf")
        self.run(["export", f"{out}-poses", "-o", f"{out}.glb"], made=f"{out}.glb")
        self.run(["distance"] + poses + ["--draw", f"{out}-d.png"], made=f"{out}-d-0.png")
        self.run(["clash"] + poses + ["--draw", f"{out}-c.png"], None, (0,) if in_space else (2,), f"{out}-c-0.png")
        self.run(["sweep", a, b, "--motions", f"{name}.motion.txt", "--draw", f"{out}-s.png"], made=f"{out}-s.png")
        self.run(["why"] + poses + ["--pose", str(apart), "-o", f"{out}-w.png"], made=f"{out}-w.png")
        self.run(["why"] + poses + ["--pose", str(apart), "--pair", "0,0", "-o", f"{out}-p.png"], made=f"{out}-p.png")

    def body_pages(self, kind, door, file):
        """All pages and pictures of one body."""
        out = f"{kind['name']}-{door.replace(' ', '-')}"
        stored = file.endswith(".lrb")
        built = kind["builds"]
        self.run(["inspect", file, "--json"], lambda lines: expect(lines, "nothing"))
        self.run(["inspect", file, "--render", "-o", f"{out}-r.png", "--size", "640x480"], made=f"{out}-r.png")
        self.run(["inspect", file, "--draw", f"{out}-f.png"], None, (2,) if stored else (0,))
        self.run(["inspect", file, "--regions"], None, (0, 2))
        if stored:
            self.run(["inspect", file, "--validate"])
        self.run(["figure", file, "-o", f"{out}.png", "--dpi", "100"], None, (0,) if built else (0, 2))
        self.run(["levels", file], None, (0,) if built else (0, 2))
        self.run(["export", file, "-o", f"{out}.ply"], made=f"{out}.ply")
        if not stored:
            self.run(["close", file, "-o", f"{out}-closed.obj"], None, (0, 1, 2))

    def scenario(self, cell):
        self.run(["run", f"{cell['name']}.json", "-o", f"{cell['name']}-run"], made=f"{cell['name']}-run/index.html")

    def python(self, kind):
        """Has the kind asked about from Python, in a process of its own."""
        words = [self.options.python[0], __file__, "-", "-", "--files", self.folder, "--only", kind["name"]]
        code, out, trouble = self.start(["env", f"PYTHONPATH={self.options.python[1]}", "PYTHONDONTWRITEBYTECODE=1"] + words)
        self.wrong += [f"Python: {line}" for line in out.splitlines() if not line.startswith("asked ")]
        if code != 0 and (code != 1 or not out):
            self.wrong.append(f"{shlex.join(words)}\n    {trouble}")

    def row(self, i, kind):
        """All cells of a kind."""
        cells = [cell for cell in self.data["cells"] if cell["a"] == kind["name"]]
        if not cells:
            return
        files = self.bodies(kind)
        for cell in cells:
            other = self.kinds[cell["b"]]["files"]
            for door, a in files.items():
                self.questions(cell, door, a, a if cell["a"] == cell["b"] else f"{cell['b']}.{other[0]}")
        if self.options.all or i % 12 == 0:
            for door, file in files.items():
                self.body_pages(kind, door, file)
                self.pages(cells[0], door, file, f"{cells[0]['b']}.obj")
        if self.options.all or i % 6 == 3:
            for cell in cells:
                self.scenario(cell)
        if self.options.python:
            self.python(kind)


def ask_python(matrix, name):
    """The door of Python: arrays, files and python-fcl's interface."""
    import numpy as np
    import lrbscope
    from lrbscope import fcl

    def model(body):
        m = fcl.BVHModel()
        m.beginModel(len(body.triangles), len(body.vertices))
        m.addSubModel(body.vertices, body.triangles)
        m.endModel()
        return m

    def body(door, kind):
        of_file = lrbscope.Body.load(os.path.join(matrix.folder, f"{kind}.obj"))
        path = os.path.join(matrix.folder, f"{kind}.{os.getpid()}.lrb")
        if door == "arrays" and isinstance(of_file.faces, np.ndarray):
            # The mesh's own faces: what is inside out is turned in both.
            return lrbscope.Body(of_file.vertices, of_file.faces)
        if door == "no regions":
            return lrbscope.Body.load(os.path.join(matrix.folder, f"{kind}.obj"), regions=False)
        if door == "lrb with levels":
            of_file.levels()
        if door.startswith("lrb"):
            of_file.save(path)
            return lrbscope.Body.load(path)
        return of_file

    def words_of(r):
        return {"relation": r.relation, "pairs": len(r.pairs), "fingerprint": r.fingerprint, "list": r.pairs.tolist(),
                "finished": r.finished, "error_bound": r.error_bound}

    def ask(a, b, cell, plain):
        steps = cell["steps"]
        poses = np.array([np.vstack([np.reshape(step["pose"], (3, 4)), [0, 0, 0, 1]]) for step in steps])
        for mode, check in (("all", check_pairs), ("first", lambda r, s: check_one(r, s, True)), ("any", lambda r, s: check_one(r, s, False))):
            for r, step in zip(lrbscope.collide(a, b, poses, mode=mode), steps):
                check(words_of(r), step)
        coherent = lrbscope.CoherentQuery(a, b)
        for pose, step in zip(poses, steps):
            check_pairs(words_of(coherent.collide(pose)), step)
            check_coarse(words_of(lrbscope.collide(a, b, pose, tolerance=cell["size"] / 20)), step)
            check_limited(words_of(lrbscope.collide(a, b, pose, max_tests=40)), step)
            check_pairs(words_of(lrbscope.collide(a, b, pose, separation=True)), step)
            check_some(words_of(lrbscope.collide(a, b, pose, recursion="paper")), step)
            d = lrbscope.distance(a, b, pose)
            check_distance({"distance": [d.lower, d.upper]}, step, cell["size"])
            expect(sum(len(r.pairs) for r in lrbscope.contacts(a, b, pose)) == len(step["pairs"]), "regions do not share out the pairs")
            lrbscope.explain_walk(a, b, pose)
            if a.dim == 3:
                check_clash({"kind": lrbscope.clash(a, b, pose).kind}, step, cell, plain)
            scene = lrbscope.Scene()
            scene.add(a), scene.add(b, pose)
            expect(len(scene.collide()) == (step["relation"] not in ("separate", "undefined")), "the scene finds others")
            if a.dim == 3:
                one, other = fcl.CollisionObject(model(a)), fcl.CollisionObject(model(b), fcl.Transform(pose[:3, :3], pose[:3, 3]))
                result = fcl.CollisionResult()
                fcl.collide(one, other, fcl.CollisionRequest(num_max_contacts=1 << 20), result)
                expect(sorted([c.b1, c.b2] for c in result.contacts) == step["pairs"], "fcl finds other pairs")
                expect(abs(fcl.distance(one, other, fcl.DistanceRequest(), fcl.DistanceResult()) - step["distance"]) <= 1e-7 * cell["size"],
                       "fcl finds another distance")

    wrong = 0
    for door in ("arrays", "file", "no regions", "lrb", "lrb with levels"):
        for cell in matrix.data["cells"]:
            if cell["a"] != name:
                continue
            plain = all(matrix.kinds[k]["solid"] and matrix.kinds[k]["simple"] for k in (cell["a"], cell["b"]))
            try:
                ask(body(door, cell["a"]), body(door, cell["b"]), cell, plain)
            except (Wrong, lrbscope.InputError, ValueError, TypeError) as e:
                print(f"{cell['name']}, {door}: {type(e).__name__}: {e}")
                wrong += 1
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("lrbscope")
    parser.add_argument("matrix_bodies")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--sanitized", action="store_true")
    parser.add_argument("--only")
    parser.add_argument("--files")
    parser.add_argument("--python", nargs=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        matrix = Matrix(options, options.files or folder)
        if options.files:
            return 1 if ask_python(matrix, options.only) else 0
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            rows = [(i, kind) for i, kind in enumerate(matrix.data["kinds"]) if options.only in (None, kind["name"])]
            for row in [pool.submit(matrix.row, i, kind) for i, kind in rows]:
                row.result()
    for finding in matrix.wrong:
        print(finding)
    print(f"{matrix.asked} commands, {len(matrix.wrong)} wrong")
    return 1 if matrix.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
