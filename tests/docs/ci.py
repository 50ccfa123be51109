#!/usr/bin/env python3
"""ci.py TREE LRBSCOPE: runs the commands of the CI templates in examples/ci on a small project with a golden: once as approved, once
with a changed scenario, whose results are then approved on "another machine" from the artifact, a copy of out/golden.

Installing and downloading are left out: they need the server. Everything else is run as written.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

tree, program = sys.argv[1], os.path.abspath(sys.argv[2])
SCENARIO = {
    "name": "balls",
    "purpose": "Two balls meet.",
    "bodies": {name: {"generator": "ball", "parameters": {"frequency": 2}} for name in ("a", "b")},
    "motion": {"kind": "sweep", "from": [3, 0.1, 0.2], "to": [1.5, 0.1, 0.2], "steps": 3},
    "frames": {"size": [480, 360]},
}
LISTS = """cmake_minimum_required(VERSION 3.18)
project(collision NONE)
enable_testing()
add_test(NAME nothing COMMAND ${CMAKE_COMMAND} -E true)
"""
SERVER = ("apt-get", "curl")  # commands that need the server


def github(text):
    """Return the steps' commands: of each `run:`, in order, and whether it runs after a failure."""
    steps = re.split(r"\n      - ", text)[1:]
    out = []
    for step in steps:
        run = re.search(r"run: \|\n((?:          .*\n)+)|run: (.*)\n", step + "\n")
        if run:
            out.append((run[1] and re.sub(r"^ {10}", "", run[1], flags=re.M) or run[2], "always()" in step))
    return out


def gitlab(text):
    """Return the lines of the script; each ends the job if it fails."""
    script = re.search(r"\n  script:\n((?:    - .*\n)+)", text)[1]
    return [(line[len("    - ") :], False) for line in script.splitlines()]


def run_job(steps, env):
    """Run steps as a server does. Return whether all succeeded."""
    failed = False
    for command, always in steps:
        if any(word in command for word in SERVER) or (failed and not always):
            continue
        done = subprocess.run(["bash", "-ec", command], env=env, capture_output=True, text=True)
        if done.returncode != 0:
            failed = True
            if "lrbscope" not in command:
                sys.exit(f"failed: {command}\n{done.stdout}{done.stderr}")
    return not failed


def expect(condition, what):
    if not condition:
        sys.exit(f"ci.py: {what}")


def lrbscope(*words):
    return subprocess.run([program, "-q", *words], capture_output=True, text=True)


def test(name, steps):
    expect(any("lrbscope golden test" in command for command, _ in steps), f"{name}: found no golden test")
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        os.mkdir("path")
        os.symlink(program, "path/lrbscope")
        env = {**os.environ, "PATH": f"{work}/path:{os.environ['PATH']}", "GITHUB_STEP_SUMMARY": f"{work}/summary.md"}
        env |= {"CI_JOB_URL": "https://gitlab.example.org/job/7"}
        with open("CMakeLists.txt", "w") as file:
            file.write(LISTS)
        with open("balls.scenario.json", "w") as file:
            json.dump(SCENARIO, file)
        expect(lrbscope("golden", "approve", "--goldens", "goldens", "balls.scenario.json").returncode == 0, "approve")
        expect(run_job(steps, env), f"{name}: fails as approved")
        with open("golden.md") as file:
            expect(file.read().startswith("### Goldens: 0 of 1 failed"), f"{name}: no summary")
        moved = {**SCENARIO, "motion": {**SCENARIO["motion"], "to": [1.2, 0.1, 0.2]}}
        with open("balls.scenario.json", "w") as file:
            json.dump(moved, file)
        expect(not run_job(steps, env), f"{name}: passes a changed run")
        with open("golden.md") as file:
            summary = file.read()
        expect("motion.to: [1.5,0.1,0.2] -> [1.2,0.1,0.2]" in summary, f"{name}: the summary lacks the cause")
        with open("golden.xml") as file:
            expect('failures="1"' in file.read(), f"{name}: golden.xml has no failure")
        if name == "github.yml":
            with open("summary.md") as file:
                expect(summary in file.read(), "the summary of the job lacks the table")
        else:
            expect('src="https://gitlab.example.org/job/7/artifacts/raw/out/golden/balls/' in summary, "no thumbnails")
        shutil.copytree("out/golden", "results")  # the unpacked artifact
        done = lrbscope("golden", "approve", "--goldens", "goldens", "--from", "results")
        expect(done.returncode == 0, f"approve --from: {done.stderr}")
        expect(run_job(steps, env), f"{name}: fails after approval")
        os.chdir("/")
    print(f"{name}: passes as approved, fails when changed, and is approved from its artifact")


for name, steps_of in (("github.yml", github), ("gitlab.yml", gitlab)):
    with open(os.path.join(tree, "examples", "ci", name)) as file:
        steps = steps_of(file.read())
    test(name, steps)
