#include "scenarios/bodies/loaded_body.hpp"

#include <cstddef>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using lrb::test::Folder;

namespace {

const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/// The last face is missing: a note names the open edges.
const std::string kOpen = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

/// Returns the message of the exception, or an empty string if both files can be loaded.
std::string error_of_two(const std::string& a, const std::string& b) {
  return test::error_of([&] { bodies::load_faces_of_two(a, b); });
}

std::string error_of_one(const std::string& path) {
  return test::error_of([&] { bodies::load_faces(path); });
}

}  // namespace

TEST_CASE("two files are loaded in parallel as in sequence") {
  const Folder folder;
  const std::string a = folder.write("a.obj", kTetrahedron), b = folder.write("b.obj", kOpen);
  const auto two = bodies::load_faces_of_two(a, b);
  const bodies::LoadedBody one[2] = {bodies::load_faces(a), bodies::load_faces(b)};
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(two[i].rep.name() == one[i].rep.name());
    CHECK(two[i].rep.hash() == one[i].rep.hash());
    CHECK(two[i].notes == one[i].notes);
  }
  CHECK(two[0].notes.empty());
  CHECK(!two[1].notes.empty());
  const auto same = bodies::load_two_bodies(a, a);
  CHECK(same[0].rep.hash() == same[1].rep.hash());
  CHECK(same[0].rep.serial() != same[1].rep.serial());
}

TEST_CASE("if files cannot be loaded, the error of the first bad one is reported") {
  const Folder folder;
  const std::string good = folder.write("good.obj", kTetrahedron), bad = folder.write("bad.obj", "v 0 0 x\n"),
                    worse = folder.write("worse.obj", "v 0 0 0\nf 1 2 3\n"), missing = folder / "missing.obj";
  for (const std::string& fault : {bad, worse, missing}) {
    REQUIRE(!error_of_one(fault).empty());
    CHECK(error_of_two(good, fault) == error_of_one(fault));
    CHECK(error_of_two(fault, good) == error_of_one(fault));
    CHECK(error_of_two(fault, fault) == error_of_one(fault));
  }
  CHECK(error_of_two(bad, worse) == error_of_one(bad));
  CHECK(error_of_two(worse, bad) == error_of_one(worse));
  CHECK(error_of_two(missing, bad) == error_of_one(missing));
  CHECK(error_of_two(bad, missing) == error_of_one(bad));
}
