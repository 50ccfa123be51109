// From a mesh to a body and to an answer: the check, with the search for self-intersections; building; the
// proof; one query of two bodies from their faces alone, as `query` asks it. What grows is the input (the
// query's tree is made, too) and the answer: time is fitted against the larger of the two.

#include <algorithm>
#include <memory>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/scaling/scaling.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::scaling {
namespace {

using namespace hard;

LrbRep bare(const Mesh& mesh) {
  const CheckedMesh checked = check(mesh);
  return LrbRep::without_regions(checked.mesh(), checked.report().bounds_solid, false);
}

/// In contact, a little aslant.
Pose aslant() {
  return Pose::rotation({1, 2, 3}, 0.3, {0.3, 0.2, 0.4});
}

/// Does some work with a mesh of that size: of the input's corners, or of the answer's pairs if there are
/// more.
Task task_of(const std::string& work, const Mesh& made, const Pose& pose) {
  const auto mesh = std::make_shared<Mesh>(made);
  const auto corners = static_cast<double>(made.face_vertices.size());
  if (work == "check") return {corners, [=] { check_mesh(*mesh); }};
  if (work == "build") {
    const auto checked = std::make_shared<CheckedMesh>(check(made));
    return {corners, [=] { build_lrb(*checked); }};
  }
  if (work == "proof") {
    const auto rep = std::make_shared<LrbRep>(build_lrb(made));
    return {corners, [=] { validate(*rep); }};
  }
  if (work == "query") {
    const auto ask = [=] {
      const LrbRep a = bare(*mesh), b = bare(*mesh);
      return collide(a, Pose{}, b, pose, CollideRequest{}).pairs.size();
    };
    return {std::max(corners, static_cast<double>(ask())), ask};
  }
  const auto body = std::make_shared<LrbRep>(bare(made));
  const CollideRequest request{.contacts = work == "contacts"};
  const auto ask = [=] { return collide(*body, Pose{}, *body, pose, request).pairs.size(); };
  return {static_cast<double>(ask()), ask};
}

struct Input {
  std::string name;
  std::function<Mesh(std::uint32_t)> make;
  std::vector<const char*> works = {"check", "build", "proof", "query"};
  Sizes share = kShare, more = kMore;
  Pose pose = aslant();
  double max_time = 1.35, max_memory = 1.2;
};

Mesh two_drums(std::uint32_t n) {
  return shapes::several({drum(n), shapes::translated(drum(n), {0, 0, 1})});
}

const std::vector<Input> kInputs = {
    {"rock", rock, {"check", "build", "proof", "query"}, {2, 3, 4}, {5, 6}},
    {"drum", drum},
    // A concave face is the fan from its first corner, which goes beyond its rim: of n quads at its sides
    // each meets a share of n triangles of the fan, so that what meets grows as n^2. That a pair of faces
    // needs one of them alone leaves n^1.7. Beyond 16,000 corners the query has more pairs than are kept.
    {"drum with concave ends", cog, {"check"}, kShare, kMore, aslant(), 1.8},
    {"drum with concave ends", cog, {"query"}, kShare, {16000}},
    // Without the proof, which counts the pairs of triangles that meet: in the fans of a box whose corners in
    // the middle of sides give triangles without area, and at the common end of two drums, n^2 do.
    {"box of many corners", fine_box, {"check", "build", "query"}},
    {"two drums, end to end", two_drums, {"check", "build"}},
    {"cone", cone},
    {"bipyramid", bipyramid},
    {"crown", crown},
    {"fan disk", fan_disk, {"check", "query"}},
    {"frustum", frustum},
    // Balls in balls need the tree of turned boxes from about a hundred on, and five times the memory with
    // it: a step, which looks like a power. Only the outermost reach into each other.
    {"nested balls",
     nested,
     {"check", "build", "proof", "query"},
     {16, 32, 64},
     {128, 256},
     Pose::translation({1.9, 0, 0}),
     1.35,
     1.5},
    {"pieces", pieces, {"check", "build", "proof", "query"}, {3, 6, 12, 24}, {48, 96}},
    {"tiles", tiles, {"check", "build", "proof", "query"}, {16, 32, 64}, {128}},
    {"rock, in one place", rock, {"pairs", "contacts"}, {2, 3, 4}, {5}, Pose{}},
    {"tiles, on each other", tiles, {"pairs", "contacts"}, {8, 16, 32}, {64}, Pose::translation({0, 0, 1})},
    {"drum, through its side", drum, {"pairs", "contacts"}, kShare, kMore, Pose::translation({0.5, 0, 0.5})}};

const bool bodies_added = [] {
  for (const Input& x : kInputs)
    for (const std::string work : x.works)
      add({x.name, work, work == "pairs" || work == "contacts" ? "pairs" : "corners", x.share, x.more,
           [make = x.make, pose = x.pose, work](std::uint32_t n) { return task_of(work, make(n), pose); },
           x.max_time, x.max_memory});
  return true;
}();

}  // namespace
}  // namespace lrb::scaling
