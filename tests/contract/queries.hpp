#pragma once
/// The queries of two bodies in one form, so that their common promises are tested once: how each is called
/// alone, on threads, in a workspace and with a probe; its requests, valid and not; and what of its answer
/// stays when the world is moved, scaled or looked at from the other body.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/answer_content.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::contract {

struct Case {
  const LrbRep *a, *b;
  Pose pose_a, pose_b;
};

/// A request that is rejected, and a part of the message.
template <class Request>
struct Rejected {
  Request request;
  const char* reason;
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInfinite = std::numeric_limits<double>::infinity();

template <class Pair>
std::vector<std::tuple<SimplexId, SimplexId, exact::Meet>> transposed(
    const std::vector<Pair>& pairs, bool swapped, const std::vector<exact::Meet>& meets = {}) {
  std::vector<std::tuple<SimplexId, SimplexId, exact::Meet>> out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const exact::Meet meet = [&] {
      if constexpr (requires { pairs[i].meet; })
        return pairs[i].meet;
      else
        return meets[i];
    }();
    out.emplace_back(swapped ? pairs[i].b : pairs[i].a, swapped ? pairs[i].a : pairs[i].b, meet);
  }
  if (swapped) std::sort(out.begin(), out.end());
  return out;
}

/// Keeps all events of a collision query, each as numbers.
class EventList final : public CollideProbe {
 public:
  std::vector<std::array<std::uint32_t, 5>> events;

  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                 std::uint32_t depth_b) override {
    add(0, a, b, static_cast<std::uint32_t>(meet), depth_a + 1000 * depth_b);
  }
  void refine(Side side, RegionId region, std::uint32_t added) override {
    add(1, static_cast<std::uint32_t>(side), region, added);
  }
  void coarsen(Side side, RegionId region, std::uint32_t removed) override {
    add(2, static_cast<std::uint32_t>(side), region, removed);
  }
  void contact(SimplexId a, SimplexId b, exact::Meet meet) override {
    add(3, a, b, static_cast<std::uint32_t>(meet));
  }
  EventLevel level() const override { return EventLevel::all; }
  std::uint32_t node_pair(const NodeVisit& visit) override {
    add(4, visit.a, visit.b, visit.parent, visit.box_tests);
    return static_cast<std::uint32_t>(events.size() - 1);
  }
  void point(Side whose, VertexId v, Where where) override {
    add(5, static_cast<std::uint32_t>(whose), v, static_cast<std::uint32_t>(where));
  }
  void end(Phase phase, std::uint64_t count) override {
    add(6, static_cast<std::uint32_t>(phase), static_cast<std::uint32_t>(count));
  }

 private:
  void add(std::uint32_t kind, std::uint32_t a, std::uint32_t b, std::uint32_t c = 0, std::uint32_t d = 0) {
    events.push_back({kind, a, b, c, d});
  }
};

struct Collide {
  using Request = CollideRequest;
  using Result = CollideResult;
  using Probe = EventList;
  static auto events(const Probe& probe) { return probe.events; }
  static std::vector<Request> requests() {
    return {{},
            {.mode = Mode::first_pair},
            {.contacts = true, .interiors_overlap = true},
            {.tolerance = 0.05},
            {.separation = true},
            {.mode = Mode::any_pair, .max_tests = 3},
            {.recursion = Recursion::paper}};
  }
  static std::vector<Rejected<Request>> rejected() {
    return {{{.tolerance = kInfinite}, "tolerance"},
            {{.contacts = true, .tolerance = 1}, "tolerance"},
            {{.recursion = Recursion::paper, .tolerance = 1}, "tolerance"}};
  }
  static Request limited(std::uint64_t pairs) { return {.max_pairs = pairs}; }
  static Request measured() { return {.contacts = true, .interiors_overlap = true}; }
  static void check(const LrbRep&, const Request& request) { check_request(request); }
  static Result ask(const Case& c, const Request& r, unsigned threads = 1) {
    if (threads == 1) return collide(*c.a, c.pose_a, *c.b, c.pose_b, r);
    Workspace workspace(threads);
    return collide(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace).value();
  }
  static Result ask(const Case& c, const Request& r, Probe& probe) {
    return collide(*c.a, c.pose_a, *c.b, c.pose_b, r, probe);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace,
                               Probe* probe = nullptr) {
    return collide(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace, probe);
  }
  static auto kind(const Result& r, bool swapped = false) {
    return std::tuple(swapped ? mirrored(r.relation) : r.relation, r.interiors_overlap, r.regions.size(),
                      transposed(r.pairs, swapped, r.meets));
  }
  static std::vector<double> lengths(const Result& r) {
    std::vector<double> out;
    for (const ContactRegion& x : r.regions)
      out.insert(out.end(), {x.length, std::sqrt(x.area), x.depth_estimate});
    return out;
  }
};

struct Distance {
  using Request = DistanceRequest;
  using Result = DistanceResult;
  using Probe = BoundsHistory;
  static auto events(const Probe& probe) { return probe.history; }
  static std::vector<Request> requests() {
    return {{}, {.within = {}, .relative_tolerance = 0.1}, {.within = 0.1}, {.within = {}, .max_steps = 5}};
  }
  static std::vector<Rejected<Request>> rejected() {
    return {{{.within = -1}, "within"},
            {{.within = kInfinite}, "within"},
            {{.within = 1, .tolerance = kNaN}, "tolerance"},
            {{.within = {}, .relative_tolerance = -1e-9}, "tolerance"}};
  }
  static Request measured() { return {}; }
  static void check(const LrbRep&, const Request& request) { check_request(request); }
  static Result ask(const Case& c, const Request& r, unsigned threads = 1) {
    if (threads == 1) return distance(*c.a, c.pose_a, *c.b, c.pose_b, r);
    return distances(*c.a, c.pose_a, *c.b, std::array{c.pose_b}, r, threads)[0];
  }
  static Result ask(const Case& c, const Request& r, Probe& probe) {
    return distance(*c.a, c.pose_a, *c.b, c.pose_b, r, probe);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace,
                               Probe* probe = nullptr) {
    return distance(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace, probe);
  }
  static auto kind(const Result& r, bool swapped = false) {
    return std::tuple(r.meet, r.meet ? Relation::crossing : swapped ? mirrored(r.relation) : r.relation);
  }
  static std::vector<double> lengths(const Result& r) { return {r.lower, r.upper}; }
};

struct Clash {
  using Request = ClashRequest;
  using Result = ClashResult;
  using Probe = ClashHistory;
  static auto events(const Probe& probe) { return std::pair(probe.of_distance, probe.of_depth); }
  static std::vector<Request> requests() {
    return {{.clearance = 0.1, .along = {}},
            {.clearance = 0.1, .along = Eigen::Vector3d(1, 2, 3)},
            {.along = {}, .max_steps = 40}};
  }
  static std::vector<Rejected<Request>> rejected() {
    return {{{.clearance = -1, .along = {}}, "clearance"},
            {{.along = Eigen::Vector3d(0, 0, 0)}, "direction"}};
  }
  static Request measured() { return {}; }
  static void check(const LrbRep& a, const Request& request) { check_request(a, request); }
  static Result ask(const Case& c, const Request& r, unsigned = 1) {
    return clash(*c.a, c.pose_a, *c.b, c.pose_b, r);
  }
  static Result ask(const Case& c, const Request& r, Probe& probe) {
    return clash(*c.a, c.pose_a, *c.b, c.pose_b, r, probe);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace,
                               Probe* probe = nullptr) {
    return clash(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace, probe);
  }
  static auto kind(const Result& r, bool swapped = false) {
    ClashKind k = r.kind;
    if (swapped && k == ClashKind::a_inside_b)
      k = ClashKind::b_inside_a;
    else if (swapped && k == ClashKind::b_inside_a)
      k = ClashKind::a_inside_b;
    // The roles of the piercing and the divided body depend on the order of the two.
    if (k == ClashKind::pierces || k == ClashKind::cuts_through) k = ClashKind::protrudes;
    return std::tuple(k, r.shares_faces, r.interiors_overlap, r.depth.has_value(), r.volume.has_value());
  }
  static std::vector<double> lengths(const Result& r) {
    const ProvedInterval depth = r.depth.value_or(ProvedInterval{}),
                         volume = r.volume.value_or(ProvedInterval{});
    return {r.distance.lower, r.distance.upper,        depth.lower,
            depth.upper,      std::cbrt(volume.lower), std::cbrt(volume.upper)};
  }
};

/// B comes from afar and turns on its way to its pose.
struct FirstContact {
  using Request = FirstContactRequest;
  using Result = FirstContactResult;
  using Probe = FirstContactHistory;
  static auto events(const Probe& probe) { return probe.history; }
  static std::vector<Request> requests() {
    return {{.history = true}, {.tolerance = 1e-3}, {.max_steps = 20}};
  }
  static std::vector<Rejected<Request>> rejected() {
    return {{{.tolerance = 0}, "tolerance"},
            {{.tolerance = -1}, "tolerance"},
            {{.tolerance = 2}, "tolerance"},
            {{.tolerance = kNaN}, "tolerance"}};
  }
  static Request measured() { return {.tolerance = 1e-9}; }
  static void check(const LrbRep&, const Request& request) { check_request(request); }
  static Motion still(const Case& c) { return Motion::still(c.pose_a); }
  static Motion motion(const Case& c) {
    const FloatMode float_mode;
    const double far =
        4 * (c.a->tree().extent() * c.pose_a.r.norm() + c.b->tree().extent() * c.pose_b.r.norm());
    const bool rigid = (c.pose_b.r.transpose() * c.pose_b.r - Eigen::Matrix3d::Identity()).norm() < 1e-9;
    const Pose start{rigid ? Pose::rotation({0, 0, 1}, 0.5).r * c.pose_b.r : c.pose_b.r,
                     c.pose_b.t + Eigen::Vector3d(far, 0.1 * far, 0)};
    return rigid ? Motion::screw(start, c.pose_b) : Motion::linear(start, c.pose_b.t);
  }
  static Result ask(const Case& c, const Request& r, unsigned threads = 1) {
    if (threads == 1) return first_contact(*c.a, still(c), *c.b, motion(c), r);
    return first_contacts(*c.a, still(c), *c.b, std::array{motion(c)}, r, threads)[0];
  }
  static Result ask(const Case& c, const Request& r, Probe& probe) {
    return first_contact(*c.a, still(c), *c.b, motion(c), r, probe);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace,
                               Probe* probe = nullptr) {
    return first_contact(*c.a, still(c), *c.b, motion(c), r, workspace, probe);
  }
  static auto kind(const Result& r, bool = false) { return std::tuple(r.outcome, r.at_start); }
  static std::vector<double> lengths(const Result&) { return {}; }  // times have none
};

struct Near {
  using Request = NearPairsRequest;
  using Result = NearPairsResult;
  static std::vector<Request> requests() { return {{.within = 0.3}, {.within = 0.3, .nearest = 5}, {}}; }
  static std::vector<Rejected<Request>> rejected() {
    return {
        {{.within = -1}, "distance"}, {{.within = kInfinite}, "distance"}, {{.within = kNaN}, "distance"}};
  }
  static Request limited(std::uint64_t pairs) { return {.within = 0, .max_pairs = pairs}; }
  static Request measured() { return {.within = 0.25}; }
  static void check(const LrbRep&, const Request& request) { check_request(request); }
  static Result ask(const Case& c, const Request& r, unsigned threads = 1) {
    return near_pairs(*c.a, c.pose_a, *c.b, c.pose_b, r, threads);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace) {
    return near_pairs(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace);
  }
  static auto kind(const Result& r, bool swapped = false) {
    return std::tuple(r.found, transposed(r.pairs, swapped));
  }
  static std::vector<double> lengths(const Result& r) {
    std::vector<double> out;
    for (const NearPair& pair : r.pairs) out.push_back(pair.upper);
    return out;
  }
};

struct Manifold {
  using Request = ManifoldRequest;
  using Result = ManifoldResult;
  static std::vector<Request> requests() { return {{}, {.margin = 0.05}}; }
  static std::vector<Rejected<Request>> rejected() {
    return {{{.margin = -1}, "margin"}, {{.margin = kInfinite}, "margin"}, {{.margin = kNaN}, "margin"}};
  }
  static Request limited(std::uint64_t pairs) { return {.max_pairs = pairs}; }
  static void check(const LrbRep&, const Request& request) { check_request(request); }
  static Result ask(const Case& c, const Request& r, unsigned threads = 1) {
    return contact_manifolds(*c.a, c.pose_a, *c.b, c.pose_b, r, nullptr, threads);
  }
  static Expected<Result&> ask(const Case& c, const Request& r, Workspace& workspace) {
    return contact_manifolds(*c.a, c.pose_a, *c.b, c.pose_b, r, workspace);
  }
};

/// Whether a query takes a probe, as its Probe.
template <class Q>
concept Watched = requires {
  typename Q::Probe;
};

}  // namespace lrb::contract
