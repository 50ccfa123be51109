"""The engine as a Conan 2 package, of the tree that this file stands in: conan create cmake/recipes/conan"""
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir

required_conan_version = ">=2.0"


class LrbscopeConan(ConanFile):
    name = "lrbscope"
    version = "2.0.0"
    package_type = "static-library"
    description = "An exact two-body collision engine that can be watched: the engine, as a library"
    license = "MIT"
    topics = ("collision-detection", "geometry", "exact", "mesh")
    settings = "os", "arch", "compiler", "build_type"
    options = {"fPIC": [True, False]}
    default_options = {"fPIC": True}

    def export_sources(self):
        tree = os.path.join(self.recipe_folder, "..", "..", "..")
        for part in ("CMakeLists.txt", "LICENSE", "cmake/*", "docs/Doxyfile.in", "engine/*"):
            copy(self, part, src=tree, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("eigen/[>=3.4 <4]", transitive_headers=True)
        self.requires("boost/[>=1.74 <2]", options={"header_only": True})
        self.requires("onetbb/[>=2021.8]")

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["LRB_BUILD_PROGRAM"] = False
        toolchain.cache_variables["LRB_COMPONENTS"] = "engine"
        toolchain.cache_variables["LRB_BUILD_TESTS"] = False
        toolchain.cache_variables["LRB_WARNINGS_AS_ERRORS"] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))  # CMakeDeps writes what consumers find

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "lrbscope")
        self.cpp_info.set_property("cmake_target_name", "lrb::engine")
        self.cpp_info.libs = ["lrb_engine"]
        self.cpp_info.includedirs = ["include"]
        self.cpp_info.cxxflags = ["-ffp-contract=off"]  # answers are defined for operations that are rounded one by one
        self.cpp_info.requires = ["eigen::eigen", "boost::headers", "onetbb::libtbb"]
