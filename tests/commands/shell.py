"""Shell lines with the program `lrbscope`, and files that they need: for transcripts and for the commands of the docs."""
import gzip
import json
import math
import os
import signal
import struct
import subprocess
import sys

# `lrbscope` is the program under test; if it rejects its input (exit code 2), it must not have written a file.
PRELUDE = r"""
lrbscope() {
  local before after code=0
  before=$(find .)
  "$PROGRAM" "$@" || code=$?
  if [ $code = 2 ]; then
    after=$(find .)
    [ "$before" = "$after" ] || echo "files were written or removed, although the input was rejected" >&2
  fi
  return $code
}
"""
# For transcripts: bad FILE BYTES ARGUMENT..., within MB ARGUMENT..., bomb FILE BEGIN AGAIN MB (see below), box FILE X0 Y0 Z0 X1 Y1 Z1, poses of translations, a ball,
# an expression for each JSON line, and facts of a PNG.
HELPERS = r"""
box() {
  printf 'v %s %s %s\n' $2 $3 $4 $5 $3 $4 $5 $6 $4 $2 $6 $4 $2 $3 $7 $5 $3 $7 $5 $6 $7 $2 $6 $7 >"$1"
  printf 'f %s %s %s %s\n' 1 4 3 2 5 6 7 8 1 2 6 5 2 3 7 6 3 4 8 7 4 1 5 8 >>"$1"
}
at() { for t; do set -- $t; echo "1 0 0 $1 0 1 0 $2 0 0 1 $3"; done; }
ball() { python3 "$SHELL_PY" ball "$@"; }
pick() { python3 "$SHELL_PY" pick "$1"; }
bad() { printf "$2" >"$1"; lrbscope "${@:3}"; }
png() { python3 "$SHELL_PY" png "$1"; }
within() { python3 "$SHELL_PY" within "$@"; }
bomb() { python3 "$SHELL_PY" bomb "$@"; }
"""


def run(line, program, helpers="", seconds=300, environment=None):
    """Runs a line in the working folder. Returns its exit code, output and errors."""
    build = os.path.dirname(os.path.dirname(program))  # whose examples and test programs may be called
    path = os.pathsep.join([os.path.join(build, "examples"), os.path.join(build, "tests"), os.environ["PATH"]])
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", PRELUDE + helpers + line],
        env={**os.environ, "PATH": path, "PROGRAM": program, "SHELL_PY": os.path.abspath(__file__), **(environment or {})},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="backslashreplace",
        timeout=seconds,
    )
    return done.returncode, done.stdout, done.stderr


def ball(path, splits, scale=1.0, hole=False):
    """Writes an octahedron that was split and blown up, as OBJ, OFF or STL; 8 * 4 ** splits triangles."""
    n = 2**splits
    index, vertices, faces = {}, [], []

    def vertex(p):
        if p not in index:
            index[p] = len(vertices)
            length = math.sqrt(sum(x * x for x in p)) / scale
            vertices.append(tuple(x / length for x in p))
        return index[p]

    for sx in (1, -1):
        for sy in (1, -1):
            for sz in (1, -1):

                def corner(i, j):
                    return vertex((sx * i, sy * j, sz * (n - i - j)))

                for i in range(n):
                    for j in range(n - i):
                        up = [(i, j), (i + 1, j), (i, j + 1)]
                        down = [(i + 1, j), (i + 1, j + 1), (i, j + 1)] if i + j + 2 <= n else None
                        for t in (up, down):
                            if t:
                                t = t if sx * sy * sz > 0 else t[::-1]
                                faces.append([corner(*c) for c in t])
    if hole:
        faces.pop()
    with open(path, "w") as f:
        if path.endswith(".off"):
            f.write("OFF\n%d %d 0\n" % (len(vertices), len(faces)))
            f.writelines("%r %r %r\n" % v for v in vertices)
            f.writelines("3 %d %d %d\n" % tuple(t) for t in faces)
        elif path.endswith(".stl"):
            f.write("solid ball\n")
            for t in faces:
                f.write("facet normal 0 0 0\nouter loop\n")
                f.writelines("vertex %r %r %r\n" % vertices[v] for v in t)
                f.write("endloop\nendfacet\n")
            f.write("endsolid ball\n")
        else:
            f.writelines("v %r %r %r\n" % v for v in vertices)
            f.writelines("f %d %d %d\n" % tuple(v + 1 for v in t) for t in faces)


def pose(x, turn=0.0):
    c, s = math.cos(turn), math.sin(turn)
    return "%r %r 0 %r %r %r 0 0.1 0 0 1 0.05" % (c, -s, x, s, c)


def pick(expression):
    """Prints an expression of a JSON document, or of each of its lines; keys are variables, `_` is everything."""
    text = sys.stdin.read()
    try:
        documents = [json.loads(text)]
    except json.JSONDecodeError:
        documents = map(json.loads, text.splitlines())
    for document in documents:
        keys = document if isinstance(document, dict) else {}
        found = eval(expression, {"math": math, "_": document, **keys})
        print(found if isinstance(found, str) else json.dumps(found))


def png(path):
    """Prints size, kind of colours and resolution of a picture."""
    with open(path, "rb") as f:
        data = f.read()
    width, height, _, colours = struct.unpack(">IIBB", data[16:26])
    at = data.find(b"pHYs")
    dpi = ", %.0f dpi" % (struct.unpack(">I", data[at + 4 : at + 8])[0] * 0.0254) if at > 0 else ""
    print("%s %dx%d %s%s" % (data[1:4].decode(), width, height, {2: "RGB", 6: "RGBA"}[colours], dpi))


def within(megabytes, words):
    """Runs the program for a minute at most; its memory, beyond that of doing nothing, must stay below a limit."""

    def peak(arguments, **pipes):
        child = subprocess.Popen([os.environ["PROGRAM"], *arguments], **pipes)
        signal.signal(signal.SIGALRM, lambda *_: child.kill())
        signal.alarm(60)
        _, status, usage = os.wait4(child.pid, 0)
        signal.alarm(0)
        return usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status)

    idle, _ = peak(["--version"], stdout=subprocess.DEVNULL)
    used, code = peak(words)
    if used - idle > megabytes and "LRB_SANITIZED" not in os.environ:  # whose shadow memory counts as well
        print("uses %.0f MB, expected at most %d" % (used - idle, megabytes))
    sys.exit(code)


def bomb(path, begin, again, megabytes):
    """Writes a text over and over until it has a size; compressed if the name ends in .gz."""
    with (gzip.open if path.endswith(".gz") else open)(path, "wb") as f:
        f.write(begin.encode())
        chunk = again.encode() * (65536 // len(again) + 1)
        for _ in range(int(megabytes) * 10**6 // len(chunk) + 1):
            f.write(chunk)


if __name__ == "__main__":
    command, *words = sys.argv[1:]
    if command == "ball":
        ball(words[0], int(words[1]), *map(float, words[2:3]), hole="hole" in words[3:])
    elif command == "pick":
        pick(words[0])
    elif command == "png":
        png(words[0])
    elif command == "within":
        within(int(words[0]), words[1:])
    elif command == "bomb":
        bomb(*words)
