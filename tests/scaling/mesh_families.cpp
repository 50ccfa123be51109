// From a mesh to a body: the check, with the search for self-intersections; building; the proof.

#include <memory>

#include "scenarios/bodies/shapes.hpp"
#include "tests/scaling/scaling.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::scaling {
namespace {

using namespace hard;

using MakeMesh = std::function<Mesh(std::uint32_t)>;

Task check_task(const Mesh& made) {
  const auto mesh = std::make_shared<Mesh>(made);
  return {static_cast<double>(mesh->face_vertices.size()), [mesh] { check_mesh(*mesh); }};
}

Task build_task(const Mesh& made) {
  const auto mesh = std::make_shared<CheckedMesh>(check(made));
  return {static_cast<double>(made.face_vertices.size()), [mesh] { build_lrb(*mesh); }};
}

Task proof_task(const Mesh& made) {
  const auto rep = std::make_shared<LrbRep>(build_lrb(made));
  return {static_cast<double>(made.face_vertices.size()), [rep] { validate(*rep); }};
}

bool add_check(const std::string& name, const Sizes& share, const Sizes& more, const MakeMesh& make) {
  return add({name, "check", "corners", share, more, [=](std::uint32_t n) { return check_task(make(n)); }});
}
bool add_build(const std::string& name, const Sizes& share, const Sizes& more, const MakeMesh& make) {
  return add({name, "build", "corners", share, more, [=](std::uint32_t n) { return build_task(make(n)); }});
}
bool add_all(const std::string& name, const Sizes& share, const Sizes& more, const MakeMesh& make) {
  add({name, "proof", "corners", share, more, [=](std::uint32_t n) { return proof_task(make(n)); }});
  return add_check(name, share, more, make) && add_build(name, share, more, make);
}

// Two families go without the proof, which counts the pairs of triangles that meet: at the common end of two
// drums, and in the fans of a box whose corners in the middle of sides give triangles without area, n^2 do.

Mesh two_drums(std::uint32_t n) {
  return shapes::several({drum(n), shapes::translated(drum(n), {0, 0, 1})});
}

/// Balls in balls need the tree of turned boxes from about a hundred on, and five times the memory with it: a
/// step, which looks like a power.
bool add_nested() {
  constexpr double kMaxTime = 1.35, kMaxMemory = 1.5;
  const Sizes share = {16, 32, 64}, more = {128, 256};
  const auto task = [](Task (*make)(const Mesh&)) {
    return [make](std::uint32_t depth) { return make(nested(depth)); };
  };
  add({"nested balls", "check", "corners", share, more, task(check_task), kMaxTime, kMaxMemory});
  add({"nested balls", "build", "corners", share, more, task(build_task), kMaxTime, kMaxMemory});
  return add({"nested balls", "proof", "corners", share, more, task(proof_task), kMaxTime, kMaxMemory});
}

/// A concave face is the fan from its first corner, which goes beyond its rim: of n quads at its sides each
/// meets a share of n triangles of the fan, so that what meets grows as n^2. That a pair of faces needs one
/// of them alone leaves n^1.7.
bool add_concave() {
  constexpr double kMaxTime = 1.8;
  return add({"drum with concave ends", "check", "corners", kShare, kMore,
              [](std::uint32_t n) { return check_task(cog(n)); }, kMaxTime});
}

const bool meshes_added =
    add_all("rock", {2, 3, 4}, {5, 6}, rock) && add_all("drum", kShare, kMore, drum) && add_concave() &&
    add_check("box of many corners", kShare, kMore, fine_box) &&
    add_build("box of many corners", kShare, kMore, fine_box) && add_all("cone", kShare, kMore, cone) &&
    add_all("bipyramid", kShare, kMore, bipyramid) && add_all("crown", kShare, kMore, crown) &&
    add_check("fan disk", kShare, kMore, fan_disk) && add_all("frustum", kShare, kMore, frustum) &&
    add_check("two drums, end to end", kShare, kMore, two_drums) &&
    add_build("two drums, end to end", kShare, kMore, two_drums) && add_nested() &&
    add_all("pieces", {3, 6, 12, 24}, {48, 96}, pieces) && add_all("tiles", {16, 32, 64}, {128}, tiles);

}  // namespace
}  // namespace lrb::scaling
