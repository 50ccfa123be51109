#!/usr/bin/env python3
"""recipes.py TREE OPTIONS: checks cmake/recipes; OPTIONS is the file with what vcpkg's port tells CMake."""
import glob
import importlib.util
import json
import os
import re
import sys
import types


def need(condition, message):
    if not condition:
        sys.exit("recipes.py: " + message)


def cmake_options(texts):
    return set(re.findall(r"-D(LRB_\w+)", " ".join(texts)))


class Recorder:
    """Stands for whatever a recipe gets from its tool, and notes what is done to it."""

    def __init__(self, log, name):
        self.__dict__.update(log=log, name=name, cache_variables={})

    def __call__(self, *args, **kwargs):
        self.log.append((self.name, args, kwargs))
        return Recorder(self.log, self.name)

    def __getattr__(self, name):
        return Recorder(self.log, self.name + "." + name)


def check_vcpkg(tree, version):
    port = json.load(open(tree + "/cmake/recipes/vcpkg/lrbscope/vcpkg.json"))
    need(port["version-semver"] == version, "vcpkg.json is of another version")
    known = {"$schema", "name", "version-semver", "description", "license", "supports", "dependencies", "features"}
    need(set(port) <= known, "vcpkg.json has keys that vcpkg does not know: %s" % (set(port) - known))
    names = [d if isinstance(d, str) else d["name"] for d in port["dependencies"]]
    need(names == sorted(names), "vcpkg wants dependencies in alphabetical order")
    for name in names + [port["name"]]:
        need(re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", name), name + " is no name of a port")
    need({"eigen3", "tbb", "boost-multiprecision"} <= set(names), "vcpkg.json leaves out a dependency")


def check_conan(tree, version):
    log, written = [], {}
    modules = {
        "conan": {"ConanFile": type("ConanFile", (), {})},
        "conan.tools": {},
        "conan.tools.build": {"check_min_cppstd": lambda recipe, std: log.append(("std", std))},
        "conan.tools.cmake": {n: Recorder(log, n) for n in ("CMake", "CMakeDeps", "cmake_layout")},
        "conan.tools.files": {n: Recorder(log, n) for n in ("copy", "rmdir")},
    }

    class Toolchain:
        def __init__(self, recipe):
            self.cache_variables = written

        def generate(self):
            log.append(("toolchain",))

    modules["conan.tools.cmake"]["CMakeToolchain"] = Toolchain
    for name, members in modules.items():
        sys.modules[name] = types.ModuleType(name)
        sys.modules[name].__dict__.update(members)
    path = tree + "/cmake/recipes/conan/conanfile.py"
    spec = importlib.util.spec_from_file_location("conanfile", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    recipe = module.LrbscopeConan()
    need(recipe.version == version, "conanfile.py is of another version")
    need(set(recipe.default_options) == set(recipe.options), "conanfile.py: options without a default")
    recipe.recipe_folder = os.path.dirname(path)
    recipe.export_sources_folder = recipe.source_folder = recipe.package_folder = "/nowhere"
    recipe.requires, recipe.cpp_info = Recorder(log, "requires"), types.SimpleNamespace(
        set_property=lambda *a: log.append(("property",) + a))
    for step in ("export_sources", "layout", "requirements", "validate", "generate", "build", "package", "package_info"):
        getattr(recipe, step)()
    copied = [(a[1], k["src"]) for n, a, k in (e for e in log if len(e) == 3 and e[0] == "copy") if "dst" in k]
    for pattern, source in copied:
        need(source == "/nowhere" or glob.glob(os.path.join(source, pattern)), "conanfile.py copies no " + pattern)
    needs = {a[0].split("/")[0] for n, a, k in (e for e in log if e[0] == "requires")}
    linked = {r.split("::")[0] for r in recipe.cpp_info.requires}
    need(needs == linked == {"eigen", "boost", "onetbb"}, "conanfile.py requires %s, and links %s" % (needs, linked))
    need(("std", 20) in log and ("toolchain",) in log, "conanfile.py leaves out a step")
    return set(written)


def check_conda(tree, version):
    try:
        import yaml
    except ImportError:
        print("PyYAML is not here (Debian's python3-yaml): conda's recipe was not parsed")
        return set()
    recipe = yaml.safe_load(open(tree + "/cmake/recipes/conda/recipe.yaml"))
    need(recipe["context"]["version"] == version, "recipe.yaml is of another version")
    need(set(recipe) <= {"schema_version", "context", "package", "source", "build", "requirements", "tests", "about"},
         "recipe.yaml has keys that conda's recipes do not have")
    source = os.path.join(tree, "cmake/recipes/conda", recipe["source"]["path"])
    need(os.path.exists(os.path.join(source, recipe["about"]["license_file"])), "recipe.yaml: no licence")
    for file in recipe["tests"][0]["package_contents"]["files"]:
        if file.startswith("include/"):
            need(os.path.exists(os.path.join(tree, "engine", file)), file + " is not installed")
    return cmake_options(recipe["build"]["script"])


def check_pyproject(tree, version):
    """pip's: pyproject.toml takes the version from CMakeLists.txt, and names a target and a component that there are."""
    try:
        import tomllib
    except ImportError:
        print("tomllib is not here (Python 3.11): pyproject.toml was not parsed")
        return
    with open(tree + "/pyproject.toml", "rb") as file:
        project = tomllib.load(file)
    settings = project["tool"]["scikit-build"]
    found = settings["metadata"]["version"]
    text = open(os.path.join(tree, found["input"])).read()
    need(re.search(found["regex"], text).group("value") == version, "pyproject.toml finds another version")
    need("version" in project["project"]["dynamic"], "pyproject.toml has a version of its own")
    for key in ("readme", "license"):
        file = project["project"][key]
        need(os.path.exists(os.path.join(tree, file if key == "readme" else file["file"])), "pyproject.toml: no " + key)
    cmake = open(tree + "/python/CMakeLists.txt").read()
    for target in settings["build"]["targets"]:
        need("add_custom_target(%s " % target in cmake, "pyproject.toml builds %s, which is no target" % target)
    for component in settings["install"]["components"]:
        need("COMPONENT " + component in cmake, "pyproject.toml installs %s, which is no component" % component)
    need(settings["cmake"]["build-type"] == "Release", "pyproject.toml builds what is slow")


def main():
    tree, options = sys.argv[1:]
    cmake = open(tree + "/CMakeLists.txt").read()
    version = re.search(r"project\(lrbscope VERSION ([0-9.]+)", cmake).group(1)
    known = set(re.findall(r"option\((LRB_\w+)|set\((LRB_\w+)[^)]*\bCACHE\b", cmake))
    known = {a or b for a, b in known}
    check_vcpkg(tree, version)
    check_pyproject(tree, version)
    of_vcpkg = cmake_options([open(options).read()])
    of_conan, of_conda = check_conan(tree, version), check_conda(tree, version)
    for who, found in (("vcpkg", of_vcpkg), ("Conan", of_conan), ("conda", of_conda or of_vcpkg)):
        need(found and found <= known, "%s sets options that CMakeLists.txt does not have: %s" % (who, found - known))
        need(found == of_vcpkg, who + " asks for another build than vcpkg")
    print("vcpkg, Conan and conda: version %s, %s" % (version, ", ".join(sorted(of_vcpkg))))


main()
