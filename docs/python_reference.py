#!/usr/bin/env python3
"""python_reference.py TREE: prints the reference of the Python package as Markdown, for docs/site.sh.

Names, signatures and types come from the sources of the package and, for compiled classes and functions, from the stub _core.pyi of
the built package (PYTHONPATH), which has their texts; without it they are left out. Exits with 1 if the package exports a name that
the reference lacks, or a public function lacks its text.
"""

import ast
import os
import re
import sys

tree = sys.argv[1]
folder = os.path.join(tree, "python", "lrbscope")
MODULES = {  # module: its title
    "lrbscope": "lrbscope",
    "lrbscope.many": "lrbscope.many: poses without end, clusters",
    "lrbscope.fcl": "lrbscope.fcl: the interface of python-fcl",
    "lrbscope.capture": "lrbscope.capture: captures of other engines",
}
SPECIAL = ("__len__", "__getitem__", "__iter__", "__bool__", "__float__", "__contains__", "__str__", "__call__")
built = os.path.isdir(os.environ.get("PYTHONPATH", "nowhere"))
missing = []


def parsed(file, folder=folder):
    with open(os.path.join(folder, file), encoding="utf-8") as source:
        return ast.parse(source.read()).body


def exported(nodes):
    for node in nodes:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__" and isinstance(node.value, ast.List):
            return list(ast.literal_eval(node.value))
    if any(isinstance(n, ast.ImportFrom) and n.names[0].name == "*" for n in nodes):
        nodes = nodes + [n for n in core if getattr(n, "name", "") != "EnvironmentError"]
    names = [a.asname for n in nodes if isinstance(n, ast.ImportFrom) for a in n.names]
    names += [n.name for n in nodes if isinstance(n, (ast.ClassDef, ast.FunctionDef))]
    return list(dict.fromkeys(name for name in names if name and not name.startswith("_")))


def docstring(node, *path):
    """Return the text of a name."""
    text = ast.get_docstring(node) or ""
    if isinstance(node, ast.FunctionDef) and len(path) == 2 and not text:
        missing.append(".".join(path))
    if text.startswith(path[-1] + "("):  # a class: its signature, which the stub states with types
        text = text.partition("\n\n")[2]
    return text


def escaped(text):
    parts = text.split("`")  # every second one is code
    return "`".join(p if i % 2 else re.sub(r"([*_<>|\[\]])", r"\\\1", p) for i, p in enumerate(parts))


def markdown(text):
    """Turn a docstring into Markdown: paragraphs, a list of arguments, examples."""
    out, example = [], False
    for line in text.splitlines():
        if line.startswith(">>>") and not example:
            out += ["", "```python"]
            example = True
        if example and not line.strip():
            out.append("```")
            example = False
        if example:
            out.append(line)
            continue
        argument = re.match(r"([a-z_]\w*(?:, [a-z_]\w*)*)( \([^)]*\))?: (.*)", line)
        if argument:
            if not (out and out[-1].startswith(("- ", "    "))):
                out.append("")
            out.append(f"- `{argument[1]}`{escaped(argument[2] or '')}: {escaped(argument[3])}")
        elif line.startswith("    "):
            out.append("    " + escaped(line.strip()))
        else:
            out.append(escaped(line))
    if example:
        out.append("```")
    return "\n".join(out) + "\n"


def plain(annotation):
    """Return a type as readers know it: aliases of the stub spelled out."""
    text = ast.unparse(annotation) if annotation else ""
    for alias, value in ALIASES.items():
        text = re.sub(rf"\b{alias}\b", lambda _, value=value: value, text)
    return text.replace("npt.", "").replace("np.", "")


def signatures(overloads, name, method):
    """Return the signature of a function; of further overloads, only the arguments that differ from the first."""
    parts, result = signature(overloads[0], method)
    line = f"{name}({', '.join(parts)}){result}"
    lines = [line if len(line) <= 100 else f"{name}(\n" + "".join(f"    {p},\n" for p in parts) + f"){result}"]
    for node in overloads[1:]:
        others, result = signature(node, method)
        shown = [o if o not in parts else "..." for o in others]
        shown = [s for i, s in enumerate(shown) if s != "..." or i == 0 or shown[i - 1] != "..."]
        lines.append(f"{name}({', '.join(shown)}){result}")
    return lines


def signature(node, method):
    a = node.args
    plain_args = a.posonlyargs + a.args
    if method and not any(ast.unparse(d) == "staticmethod" for d in node.decorator_list):
        plain_args = plain_args[1:]

    def one(arg, default):
        text = arg.arg + (f": {plain(arg.annotation)}" if arg.annotation else "")
        return text + (f" = {ast.unparse(default)}" if default is not None else "")

    defaults = [None] * (len(plain_args) - len(a.defaults)) + list(a.defaults)
    parts = [one(x, d) for x, d in zip(plain_args, defaults)]
    if a.vararg:
        parts.append("*" + a.vararg.arg)
    elif a.kwonlyargs:
        parts.append("*")
    parts += [one(x, d) for x, d in zip(a.kwonlyargs, a.kw_defaults)]
    if a.kwarg:
        parts.append("**" + a.kwarg.arg)
    result = f" -> {plain(node.returns)}" if node.returns and ast.unparse(node.returns) != "None" else ""
    return parts, result


def fenced(lines):
    return ["```python", *lines, "```", ""]


def function(node, overloads, module, name):
    out = [f"### {name}", "", *fenced(signatures(overloads, name, False)), markdown(docstring(node, module, name))]
    return out


def class_page(node, module, name):
    out = [f"### {name}", ""]
    bases = [ast.unparse(b) for b in node.bases if ast.unparse(b) != "object"]
    methods, properties = {}, []
    for n in node.body:
        if isinstance(n, ast.FunctionDef):
            if any(ast.unparse(d) == "property" for d in n.decorator_list):
                properties.append((n.name, plain(n.returns), n))
            elif not n.name.startswith("_") or n.name in SPECIAL or n.name == "__init__":
                methods.setdefault(n.name, []).append(n)
        elif isinstance(n, ast.AnnAssign) and not ast.unparse(n.target).startswith("_"):
            properties.append((ast.unparse(n.target), plain(n.annotation), None))
        elif isinstance(n, ast.Assign) and not ast.unparse(n.targets[0]).startswith("_"):
            properties.append((ast.unparse(n.targets[0]), "", None))
    if bases:
        out += [f"A subclass of {', '.join(f'`{b}`' for b in bases)}.", ""]
    made = methods.pop("__init__", None)
    if made:
        out += fenced(signatures(made, name, True))
    text = docstring(node, module, name)
    if text:
        out.append(markdown(text))
    if made:
        of_init = docstring(made[0], module, name, "__init__")
        if of_init and of_init.split("\n")[0] not in text and not of_init.startswith("Initialize self"):
            out.append(markdown(of_init))
    if properties:
        out += ["", "| property | type | |", "| --- | --- | --- |"]
        for prop, type_, n in properties:
            of_it = " ".join((docstring(n, module, name, prop) if n else "").split())
            cell = type_.replace("|", "\\|")
            out.append(f"| `{prop}` | {f'`{cell}`' if cell else ''} | {escaped(of_it)} |")
        out.append("")
    for method, overloads in methods.items():
        if method in SPECIAL and method != "__call__":
            continue
        of_it = docstring(overloads[0], module, name, method)
        out += [f"#### {name}.{method}", "", *fenced(signatures(overloads, method, True)), markdown(of_it)]
    special = [m for m in methods if m in SPECIAL and m != "__call__"]
    if special:
        out += ["Also: " + ", ".join(f"`{m}`" for m in special) + ".", ""]
    return out


core = parsed("_core.pyi", os.path.join(os.environ["PYTHONPATH"], "lrbscope")) if built else []
ALIASES = {
    n.targets[0].id: ast.unparse(n.value)
    for n in core
    if isinstance(n, ast.Assign) and isinstance(n.targets[0], ast.Name) and n.targets[0].id.startswith("_")
}
for _ in range(2):  # aliases of aliases
    ALIASES = {a: re.sub(r"\b_[A-Z]\w*", lambda m: ALIASES.get(m[0], m[0]), v) for a, v in ALIASES.items()}

page = ["# Python reference", ""]
page += ["All classes and functions of the Python package, as its stubs declare them. [How to use it](python.md).", ""]
count = 0
for module, title in MODULES.items():
    nodes = parsed(f"{module.partition('.')[2]}.py" if "." in module else "__init__.py")
    names = exported(nodes)
    if module == "lrbscope":
        nodes = core + parsed("_picture.py") + parsed("collision.py") + parsed("report.py")
    found = {}
    for node in nodes:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            found.setdefault(node.name, []).append(node)
    missing += [f"{module}.{name}" for name in names if name not in found and not name.isupper()]
    page += [f"## {title}", ""]
    intro = ast.get_docstring(ast.Module(parsed(f"{module.partition('.')[2] or '__init__'}.py"), []))
    page += [markdown(intro), ""]
    listed = sorted((n for n in names if n in found), key=lambda n: (isinstance(found[n][0], ast.ClassDef), n.lower()))
    for name in listed:
        count += 1
        if isinstance(found[name][0], ast.ClassDef):
            page += class_page(found[name][0], module, name)
        else:
            page += function(found[name][0], found[name], module, name)
print("\n".join(page))
print(f"Python reference: {count} classes and functions{'' if built else ', without texts: the module is not built'}", file=sys.stderr)
if missing:
    sys.exit("python_reference.py: without text: " + ", ".join(missing))
