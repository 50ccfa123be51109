#!/usr/bin/env python3
"""run.py LRBSCOPE [--approve] FILE...: runs transcripts, each in a folder of its own, and compares their output.

    # a comment
    $ a shell command           lines that begin with `> ` continue it
    a line of its output        `...` stands for any text, a line `...` for any lines
    ! a line of its errors
    [1]                         its exit code, if it is not 0, and not 2 with the error `! lrbscope: ...`

--approve writes the output that was found into the files; lines with `...` that still match stay as they are.
"""
import difflib
import os
import re
import sys
import tempfile

sys.dont_write_bytecode = True
import shell


def read(path):
    """Returns the parts of a transcript: comments and blank lines, and commands with their output."""
    parts = []
    with open(path) as f:
        for line in f.read().splitlines():
            if line.startswith("$ "):
                parts.append({"command": [line], "expected": []})
            elif line.startswith("> ") and parts and "command" in parts[-1] and not parts[-1]["expected"]:
                parts[-1]["command"].append(line)
            elif line == "" or line.startswith("# ") or not parts or "text" in parts[-1]:
                parts.append({"text": line})
            else:
                parts[-1]["expected"].append(line)
    return parts


def found_by(command, program):
    """Runs a command. Returns its output in the form of a transcript, without progress, which slow days add."""
    line = "\n".join(part[2:] for part in command)
    tree = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    code, out, err = shell.run(line, program, shell.HELPERS, environment={"TREE": os.path.normpath(tree)})
    errors = [e for e in err.splitlines() if not e.startswith("progress: ")]
    lines = [o or "(empty line)" for o in out.splitlines()] + ["! " + e for e in errors]
    if code != (2 if errors and errors[-1].startswith("lrbscope: ") else 0):
        lines.append("[%d]" % code)
    return lines


def pattern(line):
    if line == "...":
        return r"(?:[^\n]*\n)*"
    return re.escape(line).replace(r"\.\.\.", r"[^\n]*") + "\n"


def matches(expected, found):
    return re.fullmatch("".join(map(pattern, expected)), "".join(f + "\n" for f in found)) is not None


def approved(expected, found):
    """Returns the lines that were found; an expected pattern replaces the next line that it matches."""
    out, rest = [], list(expected)
    for line in found:
        hit = next((i for i, e in enumerate(rest) if e != "..." and matches([e], [line])), None)
        out.append(line if hit is None else rest[hit])
        if hit is not None:
            del rest[: hit + 1]
    return out


def main():
    program, files = os.path.abspath(sys.argv[1]), [os.path.abspath(f) for f in sys.argv[2:] if f != "--approve"]
    bad = 0
    for path in files:
        parts = read(path)
        with tempfile.TemporaryDirectory(prefix="lrbscope cli ") as folder:  # with spaces: they must not hurt
            os.chdir(folder)
            for part in parts:
                if "text" in part:
                    continue
                found = found_by(part["command"], program)
                if matches(part["expected"], found):
                    continue
                bad += 1
                print("%s: %s" % (path, "\n".join(part["command"])))
                print("\n".join(list(difflib.unified_diff(part["expected"], found, lineterm="", n=9))[2:]))
                part["expected"] = approved(part["expected"], found)
            os.chdir("/")
        if "--approve" in sys.argv:
            with open(path, "w") as f:
                for part in parts:
                    lines = [part["text"]] if "text" in part else part["command"] + part["expected"]
                    f.writelines(line + "\n" for line in lines)
    print("%d of the outputs of %d transcripts differ" % (bad, len(files)))
    sys.exit(0 if bad == 0 or "--approve" in sys.argv else 1)


main()
