#!/usr/bin/env python3
"""language.py [TREE]: finds retired words of terms.txt in identifiers, comments, texts and Markdown.

Prints "file:line: word; write ..." for each, and exits with 1 if there is one. A line that contains "language: keep"
is skipped. language.py --self-test: fails unless each rule finds its example, and none of the correct sentences.
"""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
TOPS = ("engine", "trace", "render", "scenarios", "bench", "tools", "python", "examples", "tests", "docs", "cmake")
CODE = (".cpp", ".hpp", ".inl", ".h", ".c", ".js")
SCRIPTS = (".py", ".pyi", ".sh", ".cmake", ".txt", ".yml")
SKIPPED = re.compile(r"(^|/)(third_party|golden|corpus|__pycache__)(/|$)|\.min\.js$|tests/language/")
STRING = re.compile(r'"(?:[^"\\]|\\.)*"|`(?:[^`\\]|\\.)*`')
CHARACTER = re.compile(r"'(?:[^'\\]|\\.)'")
WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")

CORRECT = """\
// Returns the separation vector of B, or nullopt if the bodies are disjoint.
// The order of tests is that of the paper, in which wrappers are refined one by one.
const double max_deviation = front.radial_distance(dialog);  // a radial distance, in mesh units
throw InputError("file ends in the middle of a number");
"""


class Rule:
    def __init__(self, number, line):
        parts = line.rstrip("\n").split("\t")
        if len(parts) != 5 or parts[0] not in ("identifier", "prose", "text"):
            sys.exit(f"terms.txt:{number}: expected kind, words, pattern, replacement and example, found {line!r}; separate them by tabs")
        self.kind, words, pattern, self.use, self.example = parts
        self.words = words.split()
        if self.kind == "identifier":
            pattern = rf"(?:^|_)(?:{'|'.join(self.words)})(?:_|$)"
        elif pattern == "-":
            pattern = rf"\b(?:{'|'.join(self.words)})\b"
        self.regex = re.compile(pattern, re.I)


def load_rules():
    with open(os.path.join(HERE, "terms.txt"), encoding="utf-8") as lines:
        return [Rule(n, line) for n, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]


def in_code(text):
    """Yields (line number, identifiers, comment, texts) for C-like code."""
    for number, line in enumerate(text.split("\n"), 1):
        if line.lstrip().startswith(("* ", "/*", "*/")):
            yield number, "", line, []
            continue
        texts = []
        if '"' in line or "`" in line:
            texts = [t[0][1:-1] for t in STRING.finditer(line)]
            line = STRING.sub(lambda t: '"' + " " * (len(t[0]) - 2) + '"', line)
        at = line.find("//")
        comment = line[at + 2:].lstrip("/< ") if at >= 0 else ""
        names = "" if line.startswith("#include") else line[:at] if at >= 0 else line
        yield number, CHARACTER.sub("", names), comment, [t for t in texts if " " in t]


def in_script(text):
    """The same for Python, shell and CMake; docstrings count as comments."""
    inside = False
    for number, line in enumerate(text.split("\n"), 1):
        quotes = line.count('"""')
        if inside or quotes:
            inside ^= quotes % 2 == 1
            yield number, "", line, []
            continue
        at = re.search(r"(?:^|\s)#(?!!)", line)
        comment = line[at.end():] if at else ""
        code = line[:at.start()] if at else line
        texts = [t[0][1:-1] for t in STRING.finditer(code)]
        yield number, STRING.sub("", code), comment, [t for t in texts if " " in t]


def in_markdown(text):
    """The same for Markdown, without code."""
    fenced = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, "", "", [re.sub(r"`[^`]*`|\]\([^)]*\)", "", line)]


def in_html(text):
    for number, line in enumerate(text.split("\n"), 1):
        yield number, "", "", [re.sub(r"<[^>]*>", " ", line)] + re.findall(r'(?:title|aria-label)="([^"]*)"', line)


def reader_of(name):
    if name.endswith(CODE):
        return in_code
    if name.endswith(".md"):
        return in_markdown
    if name.endswith(".html"):
        return in_html
    return in_script if name.endswith(SCRIPTS) else None


def files_of(tree):
    """Yields paths relative to the tree, sorted."""
    top = sorted(f for f in os.listdir(tree) if f.endswith(".md") or f == "CMakeLists.txt")
    yield from top
    for folder in TOPS:
        for place, folders, names in os.walk(os.path.join(tree, folder)):
            folders.sort()
            for name in sorted(names):
                path = os.path.relpath(os.path.join(place, name), tree)
                if not SKIPPED.search(path):
                    yield path


class Checker:
    def __init__(self, rules):
        self.names = [r for r in rules if r.kind == "identifier"]
        self.rules_of = {}  # retired word of a phrase: rules
        for rule in rules:
            for word in rule.words if rule.kind != "identifier" else []:
                self.rules_of.setdefault(word, []).append(rule)
        self.known = {}  # identifier: rules that it violates

    def rules_of_name(self, name):
        if name not in self.known:
            snake = HUMP.sub("_", name).lower()
            self.known[name] = [r for r in self.names if r.regex.search(snake)]
        return self.known[name]

    def findings(self, text, reader):
        """Returns (line number, word, replacement) for each retired word."""
        # Most files have no retired word, and need not be split into lines.
        words = set(WORD.findall(text))
        names = {w for w in words if self.rules_of_name(w)}
        phrases = {w for w in map(str.lower, words) if w in self.rules_of}
        if not names and not phrases:
            return []
        out = []
        lines = text.split("\n")
        for number, code, comment, texts in reader(text):
            found = [(n, r.use) for n in WORD.findall(code) if n in names for r in self.rules_of_name(n)]
            for prose, is_text in [(comment, False)] + [(t, True) for t in texts]:
                rules = {r for w in WORD.findall(prose.lower()) if w in phrases for r in self.rules_of[w]}
                found += [
                    (hit[0].strip(), r.use)
                    for r in rules
                    if is_text or r.kind == "prose"
                    for hit in r.regex.finditer(prose)
                ]
            if found and "language: keep" not in lines[number - 1]:
                out += [(number, word, use) for word, use in found]
        return out


def check(tree, checker):
    count = 0
    for path in files_of(tree):
        reader = reader_of(path)
        if reader is None:
            continue
        try:
            with open(os.path.join(tree, path), encoding="utf-8") as file:
                text = file.read()
        except UnicodeDecodeError:
            continue
        for number, word, use in checker.findings(text, reader):
            print(f'{path}:{number}: "{word}"; write {use}')
            count += 1
    return count


def self_test(rules):
    """Each rule must find its own example, and nothing in correct sentences."""
    faults = [r for r in rules if not Checker([r]).findings(planted(r), in_code) or Checker([r]).findings(CORRECT, in_code)]
    for rule in faults:
        print(f"self-test: {rule.regex.pattern}: does not find its example, or finds a correct sentence")
    print(f"self-test: {len(rules)} rules, {len(faults)} faults")
    return len(faults)


def planted(rule):
    return {"identifier": rule.example, "text": f'  print("{rule.example}");'}.get(rule.kind, f"  // {rule.example}") + "\n"


def main():
    rules = load_rules()
    if sys.argv[1:] == ["--self-test"]:
        return int(self_test(rules) > 0)
    if len(sys.argv) > 2:
        print(__doc__, file=sys.stderr)
        return 2
    count = check(sys.argv[1] if len(sys.argv) == 2 else os.path.join(HERE, "..", ".."), Checker(rules))
    if count:
        print(f"language: {count} retired words; tests/language/terms.txt lists the words to use", file=sys.stderr)
    return int(count > 0)


if __name__ == "__main__":
    sys.exit(main())
