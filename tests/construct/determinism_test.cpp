#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

TEST_CASE("the same seed gives the same complex, another seed another one") {
  const Mesh mesh = bumpy_sphere(3, 4);
  BuildOptions options;
  options.seed = 7;
  const std::uint64_t first = build_lrb(mesh, options).hash();
  CHECK(build_lrb(mesh, options).hash() == first);
  options.seed = 8;
  CHECK(build_lrb(mesh, options).hash() != first);
}

/// Bodies with whole coordinates, so that only the builder's arithmetic counts. If this fails after the
/// builder was changed on purpose, put in the new values and raise kBuilderVersion
/// (engine/scene/build_cache.hpp); if it fails with one compiler or build type only, something depends on the
/// order of evaluation, on fused operations or on uninitialised memory.
TEST_CASE("the same complex with every compiler and build type") {
  CHECK(build_lrb(comb(6)).hash() == 13439352804683972831u);
  CHECK(build_lrb(comb_2d(12)).hash() == 11678506581189530301u);
}

}  // namespace
}  // namespace lrb::test
