// lrbscope's own methods: its queries, and the simple methods that they are compared with.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include "scenarios/bodies/shapes.hpp"
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

using OurMethod = MethodOf<OurBody, false>;

/// Returns the request put to all methods: all pairs, or one.
CollideRequest request_for(Mode mode) {
  CollideRequest request;
  request.mode = mode == Mode::all_pairs ? mode : Mode::any_pair;
  return request;
}

/// Answers a query with its own memory, whose allocation is part of the measured time.
template <class Posed>
CollideResult result_of(const Posed& a, const Posed& b, const CollideRequest& request, Workspace& workspace) {
  return std::move(collide(a.body.rep, a.pose, b.body.rep, b.pose, request, workspace).value());
}

Answer answer_from(CollideResult result, double microseconds) {
  Answer answer;
  answer.microseconds = microseconds;
  answer.contact = !result.pairs.empty();
  answer.pairs = std::move(result.pairs);
  answer.inside = is_inside(result.relation);
  answer.relation = result.relation;
  answer.face_tests = result.counters.face_tests;
  return answer;
}

class Ours : public OurMethod {
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

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    CollideRequest request = request_for(mode);
    request.recursion = recursion_;
    request.predicates = predicates_;
    const Stopwatch watch;
    CollideResult result = result_of(a, b, request, workspace_);
    Answer answer = answer_from(std::move(result), watch.microseconds());
    if (recursion_ == Recursion::complete && predicates_ == Predicates::exact) answer.error_bound = 0;
    return answer;
  }

  std::optional<TestCounts> tests_of(const Posed& a, const Posed& b) override {
    CollideRequest request;
    request.recursion = recursion_;
    request.predicates = predicates_;
    const Counters counters = result_of(a, b, request, workspace_).counters;
    return TestCounts{counters.box_tests, std::max(counters.prefilter_tests, counters.face_tests)};
  }

 private:
  Recursion recursion_;
  Predicates predicates_;
  Workspace workspace_;
};

/// Returns the poses of a motion that ends at B's: at each B comes nearer to A by 0.1 % of A's unit, and
/// turns by 0.001 radians. Reads no vertices, which would displace the trees from the caches.
template <class Posed>
std::vector<Pose> motion_to(const Posed& a, const Posed& b, int count) {
  constexpr double kStep = 1e-3;
  const auto centre = [](const Posed& x) {
    const TreeNode& root = x.body.rep.tree().nodes()[0];
    return x.pose.apply(x.body.rep.tree().unit() *
                        Eigen::Vector3d(root.origin[0], root.origin[1], root.origin[2]));
  };
  const Eigen::Vector3d at = centre(b),
                        way = kStep * a.body.rep.tree().unit() * (at - centre(a)).stableNormalized();
  std::vector<Pose> poses;
  for (int i = count; i-- > 0;) {
    const Eigen::Matrix3d turn = Pose::rotation(Eigen::Vector3d::UnitZ(), i * kStep).r;
    poses.push_back({turn * b.pose.r, at + turn * (b.pose.t - at) + i * way});
  }
  poses.back() = b.pose;  // not rounded
  return poses;
}

/// Runs the coherent query, which caches results between steps. Only the last one is timed.
class OursCoherent : public OurMethod {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return std::make_unique<OurBody>(rep); }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    CoherentQuery coherent(a.body.rep, b.body.rep, request_for(mode));
    const std::vector<Pose> poses = motion_to(a, b, 9);
    for (const Pose& pose : std::span(poses).first(poses.size() - 1)) coherent.collide(a.pose, pose);
    const Stopwatch watch;
    const CollideResult& result = coherent.collide(a.pose, b.pose);
    const double microseconds = watch.microseconds();
    Answer answer = answer_from(result, microseconds);
    answer.error_bound = 0;
    return answer;
  }
};

/// Queries whether the bodies meet at each pose of a motion. The time is that of one of them.
class OursMotion : public OurMethod {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return std::make_unique<OurBody>(rep); }

  Answer ask(const Posed& a, const Posed& b, Mode) override {
    const std::vector<Pose> poses = motion_to(a, b, 64);
    const Stopwatch watch;
    batch_.collide(a.body.rep, a.pose, b.body.rep, poses, request_for(Mode::any_pair), answers_);
    return answer_from(answers_.back().value(), watch.microseconds() / 64);
  }

 private:
  Batch batch_{1};
  CollideAnswers answers_;
};

/// Stopping criterion of a coarse query.
enum class Content : std::uint8_t { one_pair, tolerance, tests };

/// Stops early: after one pair of faces, within a tolerance, or after a number of face tests. Its pairs may
/// be faces of wrappers; it answers with the points of their intersection.
class OursCoarse : public OurMethod {
 public:
  explicit OursCoarse(Content content) : content_(content) {}
  void set(double setting) override { setting_ = setting; }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    rep.levels();
    return std::make_unique<OurBody>(rep);
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    CollideRequest request = request_for(mode);
    if (content_ == Content::one_pair) request.mode = Mode::first_pair;
    if (content_ == Content::tolerance)
      request.tolerance = setting_ * shapes::box_of(a.body.rep).diagonal().norm();
    if (content_ == Content::tests) request.max_tests = static_cast<std::uint64_t>(setting_);
    const Stopwatch watch;
    const CollideResult result = result_of(a, b, request, workspace_);
    Answer answer;
    answer.microseconds = watch.microseconds();
    answer.contact = !result.pairs.empty();
    answer.face_tests = result.counters.face_tests;
    if (std::isfinite(result.error_bound)) answer.error_bound = result.error_bound;
    if (mode == Mode::all_pairs)
      for (const SimplexPair& p : result.pairs) add_points(a, b, p, answer.points);
    return answer;
  }

 private:
  /// Returns corners of the intersection; for faces within rounding of each other, the midpoint.
  static void add_points(const Posed& a, const Posed& b, const SimplexPair& pair,
                         std::vector<Eigen::Vector3d>& points) {
    const WorldTriangle p(a.body.rep, a.pose, pair.a), q(b.body.rep, b.pose, pair.b);
    const exact::PairContact c = exact::contact_of_triangles(p.corners().data(), q.corners().data());
    for (std::uint8_t i = 0; i < c.corner_count; ++i) points.push_back(c.corners[i].x);
    if (c.corner_count == 0) points.push_back((p.x[0] + p.x[1] + p.x[2] + q.x[0] + q.x[1] + q.x[2]) / 6);
  }

  Content content_;
  double setting_ = 0;
  Workspace workspace_;
};

constexpr Traits kOurHardCases = {Trait::takes_2d, Trait::moves_exactly, Trait::own_rep, Trait::hard_cases};
constexpr Traits kCoarse = {Trait::takes_2d, Trait::moves_exactly, Trait::own_rep, Trait::approximate};
const MethodStyle kVariant = {"lrbscope, variants", "#4aa3dc", "circle"};

}  // namespace

std::vector<MethodEntry> ours_methods() {
  return {
      entry_of<Ours, Recursion::complete, Predicates::exact>(
          {.name = "ours",
           .title = "lrbscope, complete",
           .remark = "All pairs and the relation; given the bodies and their poses.",
           .says = Says::relation,
           .traits = kOurHardCases,
           .style = {"lrbscope, exact", "#0072b2", "circle"},
           .role = Role::ours,
           .rank = 10}),
      entry_of<Ours, Recursion::complete, Predicates::floating>(
          {.name = "ours-floating",
           .title = "lrbscope without the exact fallback",
           .remark =
               "As ours, but the sign of a predicate that double precision cannot decide is guessed from its "
               "rounded value.",
           .says = Says::relation,
           .traits = kOurHardCases,
           .style = kVariant,
           .role = Role::ours_other,
           .rank = 11}),
      entry_of<Ours, Recursion::paper, Predicates::exact>(
          {.name = "ours-paper",
           .title = "lrbscope, the paper's recursion",
           .remark =
               "Section 4 of the paper, unchanged, with exact predicates, on an LRB-rep built from the body; if none "
               "can be built (open, not manifold), on the body's own regions. Misses contacts under lids that are "
               "not touched.",
           .says = Says::relation,
           .traits = kOurHardCases,
           .style = kVariant,
           .role = Role::no_peer,
           .rank = 12}),
      entry_of<OursCoherent>(
          {.name = "ours-coherent",
           .title = "lrbscope, coherent",
           .remark = "As ours, at the last of nine poses that are 0.1 % of A's unit (a power of two) and "
                     "0.001 radians apart; the others are not timed.",
           .says = Says::relation,
           .traits = {Trait::takes_2d, Trait::moves_exactly, Trait::own_rep, Trait::knows_poses_in_advance},
           .style = kVariant,
           .role = Role::ours_other,
           .rank = 13}),
      entry_of<OursMotion>(
          {.name = "ours-motion",
           .title = "lrbscope, a pose of a motion",
           .remark = "Whether they intersect at each of 64 poses, 0.1 % of A's unit (a power of two) and "
                     "0.001 radians apart, that end at the given one; the mean time of all.",
           .pairs = false,
           .says = Says::relation,
           .traits = {Trait::takes_2d, Trait::moves_exactly, Trait::own_rep, Trait::knows_poses_in_advance},
           .style = kVariant,
           .role = Role::ours_other,
           .rank = 17}),
      entry_of<OursCoarse, Content::one_pair>(
          {.name = "ours-one-pair",
           .title = "lrbscope, one pair",
           .remark = "Whether they intersect, exactly, and the contact of one crossing pair of faces.",
           .pairs = false,
           .traits = kCoarse,
           .style = {"lrbscope, one pair", "#0072b2", "rectOpen"},
           .role = Role::ours_other,
           .rank = 14}),
      entry_of<OursCoarse, Content::tolerance>(
          {.name = "ours-tolerance",
           .title = "lrbscope, to a tolerance",
           .remark =
               "Whether they intersect, exactly, and the contact of their wrappers, in which regions no thicker than "
               "the tolerance are not refined. Setting: tolerance relative to A's diagonal.",
           .pairs = false,
           .traits = kCoarse,
           .parameter = "tolerance",
           .settings = {0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001},
           .style = {"lrbscope, to a tolerance", "#0072b2", "rectRot"},
           .role = Role::ours_other,
           .rank = 15}),
      entry_of<OursCoarse, Content::tests>(
          {.name = "ours-budget",
           .title = "lrbscope, within a number of face tests",
           .remark =
               "A result within a limit: contact, and the intersection of the wrappers reached so far. Setting: "
               "number of face tests. Never reports intersecting bodies as separate.",
           .pairs = false,
           .traits = kCoarse,
           .parameter = "tests",
           .settings = {16, 32, 64, 128, 256, 1024},
           .style = {"lrbscope, within a budget", "#56b4e9", "rect"},
           .role = Role::ours_other,
           .rank = 16})};
}

// All pairs in doubles, without a hierarchy and without exact tests.

namespace {

struct PlainBody : MethodBody {
  explicit PlainBody(const LrbRep& rep) : mesh(simplices_of(rep)) {}
  Mesh mesh;
};

/// Returns the corners in world coordinates, simplex by simplex.
std::vector<Eigen::Vector3d> in_world(const PlainBody& body, const Pose& pose) {
  std::vector<Eigen::Vector3d> moved, out;
  for (const Eigen::Vector3d& v : body.mesh.vertices) moved.push_back(pose.apply(v));
  for (const VertexId v : body.mesh.face_vertices) out.push_back(moved[v]);
  return out;
}

class PlainDouble : public MethodOf<PlainBody, false> {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return std::make_unique<PlainBody>(rep); }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    const std::size_t n = static_cast<std::size_t>(a.body.mesh.dim);
    Answer answer;
    const Stopwatch watch;
    const std::vector<Eigen::Vector3d> p = in_world(a.body, a.pose), q = in_world(b.body, b.pose);
    for (std::size_t i = 0; i < p.size() && !(mode == Mode::first_pair && answer.contact); i += n)
      for (std::size_t j = 0; j < q.size(); j += n) {
        const bool meet = n == 3 ? plain_triangles_meet(&p[i], &q[j]) : plain_segments_meet(&p[i], &q[j]);
        if (!meet) continue;
        answer.contact = true;
        answer.pairs.push_back({static_cast<SimplexId>(i / n), static_cast<SimplexId>(j / n)});
        if (mode == Mode::first_pair) break;
      }
    answer.microseconds = watch.microseconds();
    return answer;
  }
};

}  // namespace

std::vector<MethodEntry> plain_double_methods() {
  return {entry_of<PlainDouble>(
      {.name = "plain",
       .title = "brute force, double, epsilon 1e-6",
       .remark =
           "Every pair of triangles by Moeller's interval test (1997) with its usual epsilon; 2D: by sides. No "
           "boxes, no relation.",
       .traits = {Trait::hard_cases, Trait::takes_2d, Trait::moves_exactly},
       .style = {"brute force", "#6b6b6b", "crossRot"},
       .role = Role::no_peer,  // takes minutes
       .rank = 20})};
}

}  // namespace lrb::methods
