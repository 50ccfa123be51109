// One query of two bodies from their faces alone, as `query` asks it. What grows is the input (the query's
// tree is made, too) and the answer: time is fitted against the larger of the two.

#include <algorithm>
#include <memory>

#include <Eigen/Geometry>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/scaling/scaling.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::scaling {
namespace {

using namespace hard;

using MakeMesh = std::function<Mesh(std::uint32_t)>;

LrbRep bare(Mesh mesh) {
  const CheckedMesh checked = check(std::move(mesh));
  return LrbRep::without_regions(checked.mesh(), checked.report().bounds_solid, false);
}

/// From meshes to the answer.
Task whole_query(const Mesh& made, const Pose& pose) {
  const auto mesh = std::make_shared<Mesh>(made);
  const auto ask = [mesh, pose] {
    const LrbRep a = bare(*mesh), b = bare(*mesh);
    return collide(a, Pose{}, b, pose, CollideRequest{}).pairs.size();
  };
  return {static_cast<double>(std::max(mesh->face_vertices.size(), ask())), ask};
}

/// The query alone.
Task answer(const Mesh& made, const Pose& pose, bool contacts) {
  const auto body = std::make_shared<LrbRep>(bare(made));
  CollideRequest request;
  request.contacts = contacts;
  const auto ask = [body, pose, request] {
    return collide(*body, Pose{}, *body, pose, request).pairs.size();
  };
  return {static_cast<double>(ask()), ask};
}

/// In contact, a little aslant.
Pose aslant() {
  Pose pose = Pose::translation({0.3, 0.2, 0.4});
  pose.r = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return pose;
}

/// Balls in balls need the tree of turned boxes from about a hundred on, and five times the memory with it: a
/// step, which looks like a power.
constexpr double kMaxOfNested = 1.5;

bool add_query(const std::string& name, const Sizes& share, const Sizes& more, const MakeMesh& make) {
  return add({name, "query", "corners", share, more,
              [=](std::uint32_t n) { return whole_query(make(n), aslant()); }});
}

/// Only the outermost of the balls reach into each other: the answer stays as it is while the depth grows.
bool add_nested_query() {
  return add({"nested balls",
              "query",
              "corners",
              {16, 32, 64},
              {128, 256},
              [](std::uint32_t depth) {
                return whole_query(nested(depth), Pose::translation({1.9, 0, 0}));
              },
              1.35,
              kMaxOfNested});
}

bool add_answer(const std::string& name, const Sizes& share, const Sizes& more, const MakeMesh& make,
                const Pose& pose) {
  add({name, "pairs", "pairs", share, more, [=](std::uint32_t n) { return answer(make(n), pose, false); }});
  return add(
      {name, "contacts", "pairs", share, more, [=](std::uint32_t n) { return answer(make(n), pose, true); }});
}

const bool queries_added =
    add_query("rock", {2, 3, 4}, {5, 6}, rock) && add_query("drum", kShare, kMore, drum) &&
    add_query("drum with concave ends", kShare, {16000}, cog) &&  // beyond, it has more pairs than are kept
    add_query("box of many corners", kShare, kMore, fine_box) && add_query("cone", kShare, kMore, cone) &&
    add_query("bipyramid", kShare, kMore, bipyramid) && add_query("crown", kShare, kMore, crown) &&
    add_query("fan disk", kShare, kMore, fan_disk) && add_query("frustum", kShare, kMore, frustum) &&
    add_nested_query() && add_query("pieces", {3, 6, 12, 24}, {48, 96}, pieces) &&
    add_query("tiles", {16, 32, 64}, {128}, tiles) &&
    add_answer("rock, in one place", {2, 3, 4}, {5}, rock, Pose{}) &&
    add_answer("tiles, on each other", {8, 16, 32}, {64}, tiles, Pose::translation({0, 0, 1})) &&
    add_answer("drum, through its side", kShare, kMore, drum, Pose::translation({0.5, 0, 0.5}));

}  // namespace
}  // namespace lrb::scaling
