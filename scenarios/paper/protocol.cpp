#include "scenarios/paper/protocol.hpp"

#include <algorithm>
#include <chrono>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/hash.hpp>
#include <lrbscope/observe.hpp>

namespace lrb::paper {
namespace {

RecursionCount count_of(const CollideResult& result, const std::vector<SimplexPair>& all) {
  RecursionCount n;
  n.comparisons = result.counters.face_tests;
  n.refinements = result.counters.refinements;
  n.pairs = result.pairs.size();
  n.missed = static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), [&](const SimplexPair& p) {
    return !std::binary_search(result.pairs.begin(), result.pairs.end(), p);
  }));
  n.box_tests = result.counters.box_tests;
  n.bound_tests = n.box_tests + result.counters.prefilter_tests;
  return n;
}

/// Counts the pairs of triangles of the faces that are compared.
struct TrianglePairs : CollideProbe {
  const LrbRep &a, &x;
  std::uint64_t count = 0;

  TrianglePairs(const LrbRep& of_a, const LrbRep& of_x) : a(of_a), x(of_x) {}
  static std::uint64_t triangles_of(const LrbRep& rep, SimplexId s) {
    return Mesh::simplices_of(rep.face(rep.face_of_simplex(s)).size(), rep.dim());
  }
  void face_test(SimplexId of_a, SimplexId of_x, exact::Meet, std::uint32_t, std::uint32_t) override {
    count += triangles_of(a, of_a) * triangles_of(x, of_x);
  }
};

/// Returns the answer to a query with a fresh workspace.
CollideResult ask(const LrbRep& a, const Pose& pose_a, const LrbRep& x, const Pose& pose_x,
                  const CollideRequest& request, Workspace& workspace, CollideProbe* probe = nullptr) {
  return std::move(collide(a, pose_a, x, pose_x, request, workspace, probe).value());
}

template <class Query>
CollideResult timed(const Query& query, std::uint64_t& nanoseconds) {
  const auto begin = std::chrono::steady_clock::now();
  CollideResult result = query();
  const std::chrono::nanoseconds taken = std::chrono::steady_clock::now() - begin;
  nanoseconds = static_cast<std::uint64_t>(taken.count());
  return result;
}

ContactStep count_step(const LrbRep& a, const Pose& pose_a, const LrbRep& x, const Pose& pose_x,
                       const CollideResult& complete, std::uint64_t nanoseconds, bool scalable_only,
                       Workspace& workspace) {
  ContactStep step;
  step.relation = complete.relation;
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    CollideRequest request;
    request.recursion = kRecursions[i];
    if (scalable_only && std::find(std::begin(kScalable), std::end(kScalable), i) == std::end(kScalable))
      continue;
    if (kRecursions[i] != Recursion::complete) {
      std::uint64_t taken = 0;
      const CollideResult found = timed([&] { return ask(a, pose_a, x, pose_x, request, workspace); }, taken);
      step.counts[i] = count_of(found, complete.pairs);
      if (i == kPaper && a.simplex_count() == a.face_count() && x.simplex_count() == x.face_count()) {
        step.counts[i].triangles = step.counts[i].comparisons;  // every face is a triangle
      } else if (i == kPaper) {  // a second query counts triangles, because a probe takes time
        TrianglePairs triangles(a, x);
        ask(a, pose_a, x, pose_x, request, workspace, &triangles);
        step.counts[i].triangles = triangles.count;
      }
      step.counts[i].nanoseconds = taken;
    } else {
      step.counts[i] = count_of(complete, complete.pairs);
      step.counts[i].nanoseconds = nanoseconds;
    }
  }
  return step;
}

}  // namespace

double diagonal(const LrbRep& rep) {
  return shapes::box_of(rep).diagonal().norm();
}

PaperProtocol first_contacts(PaperProtocol protocol, std::uint32_t most) {
  protocol.steps_after = 0;
  protocol.collisions = std::min(protocol.collisions, most);
  return protocol;
}

LrbRep scaled(const LrbRep& rep, double by) {
  LrbData data = rep.data();
  for (Eigen::Vector3d& v : data.vertices) v *= by;
  return LrbRep(std::move(data));
}

std::vector<ContactStep> run_collision(const LrbRep& a, const LrbRep& x, const std::string& object,
                                       std::uint32_t collision, const PaperProtocol& protocol,
                                       Workspace& workspace, bool scalable_only) {
  Fnv64 seed;
  seed.add_value(protocol.seed);
  seed.add_bytes(object.data(), object.size());
  seed.add_value(collision);
  shapes::RandomEngine random(seed.value());
  const Eigen::AlignedBox3d box_a = shapes::box_of(a), box_x = shapes::box_of(x);
  const double unit = box_a.diagonal().norm();
  Pose pose_a, pose_x;
  pose_a.r = shapes::random_rotation(random);
  pose_a.t = -(pose_a.r * box_a.center());
  pose_x.r = shapes::random_rotation(random);
  const Eigen::Vector3d from = shapes::random_direction(random), centre_x = pose_x.r * box_x.center();
  const double start = 0.5 * (unit + box_x.diagonal().norm());

  std::vector<ContactStep> steps;
  std::uint32_t since_contact = 0;
  bool met = false;
  for (std::uint32_t i = 0; i * protocol.step * unit < 2 * start && since_contact <= protocol.steps_after;
       ++i) {
    pose_x.t = (start - i * protocol.step * unit) * from - centre_x;
    std::uint64_t nanoseconds = 0;
    const CollideResult result = timed([&] { return ask(a, pose_a, x, pose_x, {}, workspace); }, nanoseconds);
    met |= !result.pairs.empty();
    if (!result.pairs.empty()) {
      ContactStep step = count_step(a, pose_a, x, pose_x, result, nanoseconds, scalable_only, workspace);
      step.seed = protocol.seed;
      step.time_step = protocol.step;
      step.object = object;
      step.collision = collision;
      step.step = since_contact;
      step.pose_a = pose_a;
      step.pose_x = pose_x;
      steps.push_back(std::move(step));
    }
    since_contact += met;
  }
  return steps;
}

}  // namespace lrb::paper
