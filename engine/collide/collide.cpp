/// The query: its result, the check of its input, and its entry points.

#include <cmath>
#include <limits>
#include <string>

#include "engine/collide/collide_into.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/fields.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/observe.hpp>

namespace lrb {

const char* to_string(Relation r) {
  return name_of(r).data();
}
const char* to_string(Answer a) {
  return name_of(a).data();
}
const char* to_string(Recursion r) {
  return name_of(r).data();
}

// clear() needs a line for each new member.
static_assert(detail::member_count<Counters>() == 9 && detail::member_count<CollideResult>() == 13);

void clear(Counters& counters) {
  // Each member by name, because clear() takes a quarter of a query that ends at the roots. The vector keeps
  // its memory.
  counters.face_tests = counters.real_tests = counters.exact_fallbacks = 0;
  counters.node_pairs = counters.box_tests = counters.prefilter_tests = 0;
  counters.refinements = counters.regions_opened = 0;
  counters.face_tests_by_level.clear();
}

void clear(CollideResult& result) {
  // All members, in the order of their declaration. The vectors keep their memory.
  result.relation = Relation::separate;
  result.interiors_overlap = Answer::unknown;
  result.recursion = Recursion::complete;
  result.mode = Mode::all_pairs;
  result.pairs.clear();
  result.meets.clear();
  result.contacts.clear();
  result.regions.clear();
  for (std::vector<RegionId>& opened : result.opened) opened.clear();
  result.error_bound = 0;
  result.finished = true;
  result.separation.reset();
  clear(result.counters);
}

void reject_pairs(std::uint64_t limit) {
  throw InputError("more than " + std::to_string(limit) +
                   " pairs of triangles intersect, the limit set by max_pairs; raise it (--max-pairs) if "
                   "memory allows (about 25 bytes per pair, 650 with contacts), or use mode any or first");
}

std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs) {
  Fnv64 h;
  for (const SimplexPair& p : pairs) {
    h.add_value(p.a);
    h.add_value(p.b);
  }
  return h.value();
}

namespace {

/// Throws InputError if a vertex of the body has a world coordinate that is not finite. Only poses near
/// overflow need this check of all vertices.
void check_world(const LrbRep& rep, const Pose& pose, char name) {
  if (world_size(pose, rep.tree()) <= 0.5 * std::numeric_limits<double>::max()) return;
  // Find a vertex to name in the message.
  const auto vertices = rep.vertices();
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Eigen::Vector3d x = pose.apply(vertices[v]);
    for (int axis = 0; axis < 3; ++axis)
      if (!std::isfinite(x[axis]))
        throw InputError("body " + std::string(1, name) + ", vertex " + std::to_string(v) + ": its world " +
                         "xyz"[axis] + " exceeds 1.8e308; scale down the bodies and the pose");
  }
}

/// Returns true if all entries are finite. inf - inf and NaN - NaN are NaN, which a sum propagates, so one
/// comparison checks twelve numbers.
bool is_finite(const Pose& p) {
  return (p.r - p.r).sum() + (p.t - p.t).sum() == 0;
}

bool is_flat(const Pose& p) {
  return p.r(0, 2) == 0 && p.r(1, 2) == 0 && p.r(2, 0) == 0 && p.r(2, 1) == 0 && p.t.z() == 0;
}

}  // namespace

void check_query(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  const FloatMode float_mode;
  if (a.dim() != b.dim())
    throw InputError("expected two bodies of the same dimension, found a " + std::to_string(a.dim()) +
                     "D and a " + std::to_string(b.dim()) + "D body");
  for (const Pose* p : {&pose_a, &pose_b}) {
    if (!is_finite(*p)) throw InputError("expected a pose of 12 finite numbers, found a NaN or an infinity");
    if (a.dim() == 2 && !is_flat(*p))
      throw InputError(
          "the pose of a 2D body leaves the plane z = 0; rotate about z and translate along x and y only");
  }
  check_world(a, pose_a, 'A');
  check_world(b, pose_b, 'B');
}

void collide_watched(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const CollideRequest& request, QueryContext& context, CollideProbe* probe,
                     CollideResult& result) {
  if (probe != nullptr) {
    ProbeAdapter adapter(*probe);
    collide_into(a, pose_a, b, pose_b, request, context, adapter, result);
  } else {
    NullProbe unwatched;
    collide_into(a, pose_a, b, pose_b, request, context, unwatched, result);
  }
}

CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request) {
  QueryContext context;
  CollideResult result;
  collide_watched(a, pose_a, b, pose_b, request, context, nullptr, result);
  return result;
}

void CollideProbe::face_test(SimplexId, SimplexId, exact::Meet, std::uint32_t, std::uint32_t) {}
void CollideProbe::refine(Side, RegionId, std::uint32_t) {}
void CollideProbe::coarsen(Side, RegionId, std::uint32_t) {}
void CollideProbe::contact(SimplexId, SimplexId, exact::Meet) {}
EventLevel CollideProbe::level() const {
  return EventLevel::faces;
}
std::uint32_t CollideProbe::node_pair(const NodeVisit&) {
  return kNull;
}
void CollideProbe::plane_test(SimplexId, SimplexId, Side) {}
void CollideProbe::tested_by(TestedBy) {}
void CollideProbe::point(Side, VertexId, Where) {}
void CollideProbe::begin(Phase, std::uint32_t, std::uint32_t) {}
void CollideProbe::end(Phase, std::uint64_t) {}

CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe) {
  QueryContext context;
  CollideResult result;
  collide_watched(a, pose_a, b, pose_b, request, context, &probe, result);
  return result;
}

}  // namespace lrb
