"""The engine of the tree around this file as a Conan 2 package: conan create cmake/recipes"""
import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain
from conan.tools.files import copy, rmdir


class LrbscopeConan(ConanFile):
    name = "lrbscope"
    version = "2.0.0"
    package_type = "static-library"
    license = "MIT"
    settings = "os", "arch", "compiler", "build_type"

    def export_sources(self):
        for part in ("CHANGELOG.md", "CMakeLists.txt", "LICENSE", "cmake/*", "docs/Doxyfile.in", "engine/*", "tools/*.cmake"):
            copy(self, part, os.path.join(self.recipe_folder, "..", ".."), self.export_sources_folder)

    def requirements(self):
        self.requires("eigen/[>=3.4 <4]", transitive_headers=True)
        self.requires("boost/[>=1.74 <2]", options={"header_only": True})
        self.requires("onetbb/[>=2021.8]")

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update(LRB_BUILD_PROGRAM="OFF", LRB_COMPONENTS="engine", LRB_BUILD_TESTS="OFF")
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))  # CMakeDeps writes what consumers find

    def package_info(self):
        self.cpp_info.set_property("cmake_target_name", "lrb::engine")
        self.cpp_info.libs = ["lrb_engine"]
        is_arm = str(self.settings.arch).startswith("armv8")
        self.cpp_info.cxxflags = ["-ffp-contract=off"] + (["-U__ARM_FEATURE_FMA"] if is_arm else [])
