#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::methods {
namespace {

struct OurBody : MethodBody {
  explicit OurBody(LrbRep r) : rep(std::move(r)) {}
  LrbRep rep;
};

const LrbRep& rep_of(const MethodBody& body) {
  return static_cast<const OurBody&>(body).rep;
}

/// Returns the request put to all methods: all pairs, or one.
CollideRequest request_for(Mode mode) {
  CollideRequest request;
  request.mode = mode == Mode::all_pairs ? mode : Mode::any_pair;
  return request;
}

/// Answers a query with its own memory, whose allocation is part of the measured time.
CollideResult ask(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const CollideRequest& request, Workspace& workspace) {
  return std::move(collide(a, pose_a, b, pose_b, request, workspace).value());
}

MethodAnswer answer_from(CollideResult result, double microseconds) {
  MethodAnswer answer;
  answer.microseconds = microseconds;
  answer.contact = !result.pairs.empty();
  answer.pairs = std::move(result.pairs);
  answer.inside = result.relation == Relation::a_inside_b || result.relation == Relation::b_inside_a;
  answer.relation = result.relation;
  answer.face_tests = result.counters.face_tests;
  return answer;
}

class Ours : public Method {
 public:
  Ours(Recursion recursion, Predicates predicates) : recursion_(recursion), predicates_(predicates) {}

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    if (recursion_ != Recursion::complete) {
      try {
        return std::make_unique<OurBody>(build_lrb(real_mesh(rep)));
      } catch (const InputError&) {
        // Not closed or not manifold: the body keeps the regions that it has.
      }
    }
    return std::make_unique<OurBody>(rep);
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    CollideRequest request = request_for(mode);
    request.recursion = recursion_;
    request.predicates = predicates_;
    const Stopwatch watch;
    CollideResult result = ask(rep_of(a), pose_a, rep_of(b), pose_b, request, workspace_);
    MethodAnswer answer = answer_from(std::move(result), watch.microseconds());
    if (recursion_ == Recursion::complete && predicates_ == Predicates::exact) answer.error_bound = 0;
    return answer;
  }

  std::optional<TestCounts> count_tests(const MethodBody& a, const Pose& pose_a, const MethodBody& b,
                                        const Pose& pose_b) override {
    CollideRequest request;
    request.recursion = recursion_;
    request.predicates = predicates_;
    const Counters counters = ask(rep_of(a), pose_a, rep_of(b), pose_b, request, workspace_).counters;
    return TestCounts{counters.box_tests, std::max(counters.prefilter_tests, counters.face_tests)};
  }

 private:
  Recursion recursion_;
  Predicates predicates_;
  Workspace workspace_;
};

double diagonal_of(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : rep.vertices()) box.extend(v);
  return box.diagonal().norm();
}

/// Runs the coherent query, which caches results between steps: the pose is the last of a few small steps.
/// Only that one is timed.
class OursCoherent : public Method {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return std::make_unique<OurBody>(rep); }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    CoherentQuery coherent(rep_of(a), rep_of(b), request_for(mode));
    constexpr int kSteps = 8;
    constexpr double kStep = 1e-3;  // as a share of A's diagonal
    const Eigen::Vector3d step = kStep * diagonal_of(rep_of(a)) * Eigen::Vector3d(1, 2, 2) / 3;
    for (int i = kSteps; i > 0; --i) coherent.collide(pose_a, {pose_b.r, pose_b.t + i * step});
    const Stopwatch watch;
    const CollideResult& result = coherent.collide(pose_a, pose_b);
    const double microseconds = watch.microseconds();
    MethodAnswer answer = answer_from(result, microseconds);
    answer.error_bound = 0;
    return answer;
  }
};

/// Stopping criterion of a coarse query.
enum class Content : std::uint8_t { one_pair, tolerance, tests };

/// Stops early: after one pair of faces, within a tolerance, or after a number of face tests. Its pairs may
/// be faces of wrappers; it answers with the points of their intersection.
class OursCoarse : public Method {
 public:
  explicit OursCoarse(Content content) : content_(content) {}
  void set(double setting) override { setting_ = setting; }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    rep.levels();
    return std::make_unique<OurBody>(rep);
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    const LrbRep &rep_a = rep_of(a), &rep_b = rep_of(b);
    CollideRequest request = request_for(mode);
    if (content_ == Content::one_pair) request.mode = Mode::first_pair;
    if (content_ == Content::tolerance) request.tolerance = setting_ * diagonal_of(rep_a);
    if (content_ == Content::tests) request.max_tests = static_cast<std::uint64_t>(setting_);
    const Stopwatch watch;
    const CollideResult result = ask(rep_a, pose_a, rep_b, pose_b, request, workspace_);
    MethodAnswer answer;
    answer.microseconds = watch.microseconds();
    answer.contact = !result.pairs.empty();
    answer.face_tests = result.counters.face_tests;
    if (std::isfinite(result.error_bound)) answer.error_bound = result.error_bound;
    if (mode == Mode::all_pairs)
      for (const SimplexPair& p : result.pairs) add_points(rep_a, pose_a, rep_b, pose_b, p, answer.points);
    return answer;
  }

 private:
  /// Returns corners of the intersection; for faces within rounding of each other, the midpoint.
  static void add_points(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                         const SimplexPair& pair, std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d p[3], q[3];
    VertexId v[3] = {};
    a.simplex(pair.a, v);
    for (int k = 0; k < 3; ++k) p[k] = pose_a.apply(a.vertices()[v[k]]);
    b.simplex(pair.b, v);
    for (int k = 0; k < 3; ++k) q[k] = pose_b.apply(b.vertices()[v[k]]);
    const double* const pp[3] = {p[0].data(), p[1].data(), p[2].data()};
    const double* const qq[3] = {q[0].data(), q[1].data(), q[2].data()};
    const exact::PairContact c = exact::contact_of_triangles(pp, qq);
    for (std::uint8_t i = 0; i < c.corner_count; ++i) points.push_back(c.corners[i].x);
    if (c.corner_count == 0) points.push_back((p[0] + p[1] + p[2] + q[0] + q[1] + q[2]) / 6);
  }

  Content content_;
  double setting_ = 0;
  Workspace workspace_;
};

MethodInfo our_info(const char* name, const char* title, const char* remark, int rank) {
  MethodInfo info;
  info.name = name;
  info.title = title;
  info.remark = remark;
  info.says = Says::relation;
  info.traits.set(Trait::takes_2d);
  info.traits.set(Trait::moves_exactly);
  info.traits.set(Trait::own_rep);
  info.rank = rank;
  info.role = Role::ours_other;
  info.style = {"lrbscope, variants", "#4aa3dc", "circle"};
  return info;
}

void coarse(MethodInfo& info) {
  info.pairs = false;
  info.traits.set(Trait::hard_cases, false);
  info.traits.set(Trait::approximate);
  info.says = Says::nothing;
}

MethodEntry ours() {
  MethodInfo info = our_info("ours", "lrbscope, complete",
                             "All pairs and the relation; given the bodies and their poses.", 10);
  info.style = {"lrbscope, exact", "#0072b2", "circle"};
  info.role = Role::ours;
  return {info, []() -> std::unique_ptr<Method> {
            return std::make_unique<Ours>(Recursion::complete, Predicates::exact);
          }};
}

MethodEntry ours_floating() {
  MethodInfo info =
      our_info("ours-floating", "lrbscope without the exact fallback",
               "As ours, but the sign of a predicate that double precision cannot decide is guessed from "
               "its rounded value.",
               11);
  info.role = Role::ours_double;
  return {info, []() -> std::unique_ptr<Method> {
            return std::make_unique<Ours>(Recursion::complete, Predicates::floating);
          }};
}

MethodEntry ours_paper() {
  MethodInfo info =
      our_info("ours-paper", "lrbscope, the paper's recursion",
               "Section 4 of the paper, unchanged, with exact predicates, on an LRB-rep built from the body; "
               "if none can be built (open, not manifold), on the body's own regions. Misses contacts under "
               "lids that are not touched.",
               12);
  info.role = Role::no_peer;
  return {info, []() -> std::unique_ptr<Method> {
            return std::make_unique<Ours>(Recursion::paper, Predicates::exact);
          }};
}

MethodEntry ours_coherent() {
  MethodInfo info = our_info(
      "ours-coherent", "lrbscope, coherent",
      "As ours, at the last of nine poses that are 0.1 % of A's diagonal apart; the others are not timed.",
      13);
  info.traits.set(Trait::hard_cases, false);
  info.traits.set(Trait::knows_poses_in_advance);
  return {info, []() -> std::unique_ptr<Method> { return std::make_unique<OursCoherent>(); }};
}

MethodEntry ours_one_pair() {
  MethodInfo info =
      our_info("ours-one-pair", "lrbscope, one pair",
               "Whether they intersect, exactly, and the contact of one crossing pair of faces.", 14);
  coarse(info);
  info.style = {"lrbscope, one pair", "#0072b2", "rectRounded"};
  return {info, []() -> std::unique_ptr<Method> { return std::make_unique<OursCoarse>(Content::one_pair); }};
}

MethodEntry ours_tolerance() {
  MethodInfo info =
      our_info("ours-tolerance", "lrbscope, to a tolerance",
               "Whether they intersect, exactly, and the contact of their wrappers, in which regions no "
               "thicker than the tolerance are not refined. Setting: tolerance relative to A's diagonal.",
               15);
  coarse(info);
  info.parameter = "tolerance";
  info.settings = {0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001};
  info.style = {"lrbscope, to a tolerance", "#0072b2", "rectRot"};
  return {info, []() -> std::unique_ptr<Method> { return std::make_unique<OursCoarse>(Content::tolerance); }};
}

MethodEntry ours_budget() {
  MethodInfo info =
      our_info("ours-budget", "lrbscope, within a number of face tests",
               "A result within a limit: contact, and the intersection of the wrappers reached so far. "
               "Setting: number of face tests. Never reports intersecting bodies as separate.",
               16);
  coarse(info);
  info.parameter = "tests";
  info.settings = {16, 32, 64, 128, 256, 1024};
  info.style = {"lrbscope, within a budget", "#56b4e9", "rect"};
  return {info, []() -> std::unique_ptr<Method> { return std::make_unique<OursCoarse>(Content::tests); }};
}

}  // namespace

std::vector<MethodEntry> ours_methods() {
  return {ours(),          ours_floating(),  ours_paper(), ours_coherent(),
          ours_one_pair(), ours_tolerance(), ours_budget()};
}

}  // namespace lrb::methods
