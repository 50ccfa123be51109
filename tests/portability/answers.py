#!/usr/bin/env python3
"""answers.py write MATRIX OUT NTH PROGRAM...: the answers of lrbscope, started by the words PROGRAM (an emulator first, if any), to every
NTH cell of the matrix that matrix_bodies wrote to the folder MATRIX: LRB-reps of all bodies, queries at 112 poses of each cell, and all
other queries that draw nothing at some of them.
answers.py compare EXPECTED FOUND: prints a table of the answers in two such folders; exit code 1 if they differ."""

import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

POSES = 112  # of a cell: 10,080 of 90 cells
SOME = 4  # of them, for queries that take longer
SUBJECTS = {  # options after the two bodies; the file of poses or motions follows. LENGTH: a twentieth of the cell's size
    "query": ["--pairs", "--poses"],
    "query_paper": ["--recursion", "paper", "--poses"],
    "query_tolerance": ["--tolerance", "LENGTH", "--poses"],
    "distance": ["--poses"],
    "near": ["--within", "LENGTH", "--poses"],
    "clash": ["--poses"],
    "manifold": ["--poses"],
    "sweep": ["--motions"],
}


def pose(rng, dim, size):
    """A random rotation, and a translation of up to half the size of the cell along each axis: 12 numbers, row by row."""
    if dim == 2:
        angle = rng.uniform(0, 2 * math.pi)
        c, s = math.cos(angle), math.sin(angle)
        rows = [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    else:
        q = [rng.gauss(0, 1) for _ in range(4)]
        norm = math.sqrt(sum(x * x for x in q))
        w, x, y, z = (component / norm for component in q)
        rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    shift = [rng.uniform(-size / 2, size / 2) if k < dim else 0 for k in range(3)]
    return " ".join(repr(float(x)) for row, t in zip(rows, shift) for x in [*row, t])


class Answers:
    def __init__(self, out, program):
        self.out = out
        self.program = program

    def ask(self, subject, name, arguments):
        """Runs the program in the folder; keeps what it prints and its exit code."""
        run = subprocess.run(self.program + arguments, cwd=self.out, stdin=subprocess.DEVNULL, capture_output=True)
        os.makedirs(os.path.join(self.out, subject), exist_ok=True)
        text = run.stdout + run.stderr + b"exit code %d\n" % run.returncode
        text = re.sub(rb"progress: .*\n|peak of the process .*|built in .*", b"", text)  # memory and time
        with open(os.path.join(self.out, subject, name), "wb") as file:
            file.write(text.replace(b"\r\n", b"\n"))  # of Windows
        return run.returncode


def write(matrix_folder, out, nth, program):
    with open(os.path.join(matrix_folder, "matrix.json")) as file:
        matrix = json.load(file)
    answers = Answers(out, program)
    os.makedirs(out)
    cells = matrix["cells"][::nth]
    used = {cell[side] for cell in cells for side in "ab"}
    kinds = {kind["name"]: kind["dim"] for kind in matrix["kinds"] if kind["name"] in used}

    def build(name):
        """The file that queries load: many bodies have no LRB-rep; queries answer all the same."""
        shutil.copy(os.path.join(matrix_folder, name + ".obj"), out)
        built = answers.ask("build", name, ["--quiet", "build", name + ".obj", "-o", name + ".lrb", "--no-validate"]) == 0
        answers.ask("inspect", name, ["inspect", name + ".obj", "--json"])
        return name + (".lrb" if built else ".obj")

    def ask(cell):
        rng = random.Random(cell["name"])
        lines = [pose(rng, kinds[cell["a"]], cell["size"]) for _ in range(POSES)]
        files = {"many": lines, "some": lines[:SOME], "motions": [a + " " + b for a, b in zip(lines[:SOME], lines[SOME:])]}
        for file_name, content in files.items():
            with open(os.path.join(out, f"{cell['name']}-{file_name}.txt"), "w", newline="\n") as file:
                file.write("\n".join(content) + "\n")
        for subject, options in SUBJECTS.items():
            poses = {"query": "many", "sweep": "motions"}.get(subject, "some")
            if subject == "clash" and cell["a"] == cell["b"]:
                continue  # takes minutes
            arguments = [subject.split("_")[0], body[cell["a"]], body[cell["b"]], *options, f"{cell['name']}-{poses}.txt"]
            answers.ask(subject, cell["name"], [repr(cell["size"] / 20) if a == "LENGTH" else a for a in arguments])

    with ThreadPoolExecutor(os.cpu_count()) as pool:  # each thread waits for one program
        body = dict(zip(kinds, pool.map(build, kinds)))
        list(pool.map(ask, cells))


def contents(folder):
    """The files of the folder, by subject and name."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            subject = os.path.relpath(place, folder)
            if subject == ".":
                subject = os.path.splitext(name)[1]
            if subject in (".obj", ".txt"):
                continue  # the inputs
            with open(os.path.join(place, name), "rb") as file:
                found[subject, name] = file.read()
    return found


def compare(expected_folder, found_folder):
    expected, found = contents(expected_folder), contents(found_folder)
    if set(expected) != set(found):
        print("not in both folders:", *sorted("/".join(key) for key in set(expected) ^ set(found)))
    differ = len(set(expected) ^ set(found))
    print(f"{'subject':<16} {'files':>6} {'lines':>7} {'equal files':>12}")
    for subject in sorted({subject for subject, _ in expected}):
        keys = sorted(key for key in expected if key[0] == subject)
        unequal = [key for key in keys if expected[key] != found.get(key)]
        lines = sum(expected[key].count(b"\n") for key in keys) if subject[0] != "." else 0
        print(f"{subject:<16} {len(keys):>6} {lines or '':>7} {len(keys) - len(unequal):>12}")
        for key in unequal[:5]:
            print("  differs:", "/".join(key))
        differ += len(unequal)
    return 1 if differ or not expected else 0


if __name__ == "__main__":
    if len(sys.argv) > 5 and sys.argv[1] == "write":
        write(sys.argv[2], os.path.abspath(sys.argv[3]), int(sys.argv[4]), sys.argv[5:])
    elif len(sys.argv) == 4 and sys.argv[1] == "compare":
        sys.exit(compare(*sys.argv[2:]))
    else:
        sys.exit(__doc__)
