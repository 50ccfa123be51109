#!/usr/bin/env python3
"""commands.py TREE LRBSCOPE [PAGE...]: runs the `lrbscope` lines of the shell blocks of README and docs/.

Those of a page run one after the other in a folder with files of the names that they mention. README's JSON
lines show values of the output. Lines that are not run are in NOT_RUN with a reason, also those of other
programs: a new line is run or needs a reason.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "commands"))
import shell

# (pages, pattern of lines, why they are not run here)
NOT_RUN = [
    (
        "",
        r"^(cd examples/data$|\./run|\.ci/run|\./check|cmake |cmake/release|pip |ctest |export PYTHONPATH|\(cd build/release && cpack\)|apt-get )",
        "builds; tests/fresh_install, ./check",
    ),
    ("", r"^((\w+=\S+ )?build/|tests/guard/)", "programs of tests and benchmarks, named by their tests"),
    ("", r"^lrbscope (stability|bench|chart)\b(?!.*(--percentiles|--search))", "measures for minutes; measure_tests, stability_tests"),
    ("", r"^lrbscope (paper|crowd)$", "takes minutes at its full size; cli tests have smaller ones"),
    (
        "docs/paper.md",
        r"^(lrbscope paper|seq 0 3)",
        "takes minutes; tests/commands/paper.txt runs it in parts, spec and paper tests its experiments",
    ),
    ("docs/tails_and_worst.md", r"fcl|command:|run\.lrbcap", "needs another engine or its capture; engines_tests"),
    ("", r"--method ours,fcl", "needs another engine; engines_tests"),
    ("docs/profiling.md", r"out/fcl", "needs FCL; tests/examples/capture.sh"),
    ("docs/profile_your_engine.md", r"", "tests/examples/capture.sh, in order, with their output"),
    ("", r"\.lrbcap\b", "needs another engine's program; profile_tests"),
    (
        "docs/scenarios.md",
        r"--dpi 300|--format svg|--frames refinement|--events nodes",
        "draws for a minute or more; tests of cli and render",
    ),
    ("docs/golden.md", r"\b(bolt|hinge|lid|valve)\b", "tests/docs/goldens.sh, with their output"),
    ("docs/figures.md", r"out/mine", "tests/docs/figures.sh, with their widths"),
    (
        "CONTRIBUTING.md",
        r"golden (report|approve) --goldens tests/golden",
        "the approved pictures: golden tests; not to be rewritten",
    ),
]
# Lines that may end with exit code 1: a finding about the mesh, or runs that differ.
FINDS = [r"^lrbscope inspect .*--draw", r"^lrbscope compare "]
SECONDS = 300


def stand_ins(tree, page, run):
    """Makes the files that a page's commands speak of, in the working folder."""
    fine = 5 if page == "docs/queries.md" else 3  # pair 1340,4539
    for name, scale in (
        ("a.obj", 1.0),
        ("b.obj", 0.8),
        ("cow.obj", 1.0),
        ("mesh.obj", 1.0),
        ("part.obj", 1.0),
        ("twin.obj", 1.0),
    ):
        shell.ball(name, fine, scale, hole=name == "mesh.obj" and page == "docs/debugging.md")
    for name in ("man.stl", "b.off"):
        shell.ball(name, 3, 0.8)
    os.mkdir("meshes")
    shell.ball("meshes/a.obj", 2)
    shell.ball("meshes/b.obj", 2, 0.5)
    with open("poses.txt", "w") as f:
        f.writelines(shell.pose(2.2 - 0.15 * i, 0.1 * i) + "\n" for i in range(9))
    with open("motions.txt", "w") as f:
        f.write(shell.pose(4) + " " + shell.pose(0, 0.5) + "\n" + shell.pose(4) + " " + shell.pose(5) + "\n")
    with open("points.csv", "w") as f:
        f.writelines("0.1,%r,2\n" % (0.25 * i) for i in range(9))
    run("lrbscope export poses.txt --what poses -o poses.csv")
    if page == "README.md":
        for name in os.listdir(tree + "/examples/data"):
            shutil.copy(tree + "/examples/data/" + name, name)
        run("lrbscope export a.obj -o a.ply")
        run("lrbscope golden approve --goldens goldens my.scenario.json")
    if page == "docs/formats.md":
        run("lrbscope build cow.obj -o cow.lrb")
        run("lrbscope collide cow.obj man.stl --poses poses.csv -o out/cow")
    if page in ("docs/profiling.md", "docs/queries.md"):
        run("lrbscope run collision --frames none -o out/collision")
    if page == "docs/profiling.md":
        for name in ("before", "after"):
            run("lrbscope collide a.obj b.obj --poses poses.csv -o out/" + name)
    if page == "docs/scenarios.md":
        run("lrbscope run figure2 -o out/figure2")


def scenario(tree):
    """Writes my.scenario.json and my.crowd.json: shipped ones, the crowd made small."""
    with open(tree + "/scenarios/shipped/ball_in_bowl.scenario.json") as f:
        given = json.load(f)
    given["name"] = "my"
    with open("my.scenario.json", "w") as f:
        json.dump(given, f)
    with open(tree + "/scenarios/shipped/crowd.crowd.json") as f:
        given = json.load(f)
    given["name"] = "my"
    given["motion"]["steps"] = 3
    for body in given["bodies"]:
        body["count"] = 2  # of each kind: the page records "knot 1" and "gear 2"
    with open("my.crowd.json", "w") as f:
        json.dump(given, f)


def lines_of(tree, page):
    """Yields (number, line) of the shell blocks of a page, without comments and prompts.

    A here document belongs to its line."""
    on = False
    with open(os.path.join(tree, page)) as f:
        numbered = enumerate(f, 1)
        for number, line in numbered:
            if on and line.endswith("<<'END'\n"):
                while not line.endswith("\nEND\n"):
                    line += next(numbered)[1]
                yield number, line
                continue
            if line.startswith("```"):
                on = line.strip() == "```sh" and not on
                continue
            line = line.strip()
            if on and line and not line.startswith("#"):
                # A comment begins after two spaces, as all pages write it.
                yield number, re.sub(r"\s+#.*$", "", line.removeprefix("$ "))


def reason_of(page, line):
    for pages, pattern, why in NOT_RUN:
        if pages in ("", page) and re.search(pattern, line):
            return why
    return None


def ffmpeg(folder):
    """A program in the place of ffmpeg, where that is missing: it writes a file of the last word's name."""
    if shutil.which("ffmpeg"):
        return {}
    path = folder + "/.ffmpeg"
    if not os.path.exists(path):
        with open(path, "w") as out:
            out.write('#!/bin/sh\nfor last; do :; done\n: >"$last"\n')
        os.chmod(path, 0o755)
    return {"LRB_FFMPEG": path}


def main():
    tree, program = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    pages = sys.argv[3:] or ["README.md", "CONTRIBUTING.md"] + sorted(
        "docs/" + n for n in os.listdir(tree + "/docs") if n.endswith(".md")
    )
    ran, left, bad, used = 0, 0, 0, set()
    for page in pages:
        lines, shown = [], {}  # shown: the values below each command
        for number, line in lines_of(tree, page):
            if line.startswith("{") and page == "README.md":
                shown[lines[-1]] = shown.get(lines[-1], []) + re.findall(r'"\w+":(?:\[[^]]*\]|[^,}]+)', line)
            elif not line.startswith("{"):
                lines.append((number, line))
        to_run = [(n, line) for n, line in lines if reason_of(page, line) is None]
        left += len(lines) - len(to_run)
        used |= {reason_of(page, line) for _, line in lines}
        if not to_run:
            continue
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)

            def run(line, codes=(0,), values=()):
                try:
                    code, out, errors = shell.run(line, program, seconds=SECONDS, environment=ffmpeg(folder))
                except subprocess.TimeoutExpired:
                    return "takes more than %d s" % SECONDS
                if code not in codes:
                    return "exit code %d: %s" % (code, errors.strip())
                missing = [v for v in values if v not in out]
                return "does not print " + ", ".join(missing) if missing else None

            scenario(tree)
            stand_ins(tree, page, run)
            for number, line in to_run:
                if not line.startswith(("lrbscope ", "cat >")):
                    wrong = "is neither run nor has a reason in tests/docs/commands.py"
                else:
                    finds = any(re.search(p, line) for p in FINDS)
                    wrong = run(line, (0, 1) if finds else (0,), shown.get((number, line), ()))
                ran += 1
                print("%s:%d: %s" % (page, number, line), flush=True)
                if wrong:
                    bad += 1
                    print("  " + wrong)
            os.chdir("/")
    if not sys.argv[3:]:
        for _, _, why in NOT_RUN:
            if why not in used:
                bad += 1
                print('commands.py: no line is left out because it "%s"' % why)
    print("%d commands run, %d left to other tests or to people" % (ran, left))
    sys.exit(1 if bad or ran == 0 else 0)


main()
