/// Every kind of body through the doors of the library; doors.py has those of the programs.

#include <algorithm>
#include <limits>
#include <map>

#include <doctest/doctest.h>

#include "tests/matrix/bodies.hpp"
#include "tests/matrix/child.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/self_intersections.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::matrix {
namespace {

constexpr double kSlack = 1e-7;  // of distances that are measured in doubles, as a share of the body's size

const Matrix& matrix() {
  static const Matrix all = make_matrix();
  return all;
}

/// Says what is wrong with the answers about one cell through one door.
class Questions {
 public:
  /// `thorough`: asks also how deep clashes are, which takes as long as all else.
  Questions(Report& report, const Body& a, const Body& b, const Cell& cell, bool thorough)
      : report_(report), a_(a), b_(b), cell_(cell), thorough_(thorough) {
    for (const std::size_t i : {cell.a, cell.b}) {
      simple_ &= matrix().kinds[i].simple;
      solid_ &= matrix().kinds[i].solid;
    }
  }

  /// `kinds`: what clashes were at each step through the doors before; filled in by the first.
  void ask(std::vector<ClashKind>& kinds) {
    CoherentQuery coherent(a_, b_, {}, CoherentQuery::CacheUse::always);
    for (const Step& step : cell_.steps) {
      step_ = &step;
      doing("collide"), collide_all();
      doing("coherent"), is_truth(coherent.collide({}, step.pose));
      doing("modes"), one_pair(Mode::first_pair), one_pair(Mode::any_pair);
      doing("tolerance"), coarse();
      doing("max-tests"), limited();
      doing("separation"), is_truth(answer([](CollideRequest& r) { r.separation = true; }));
      doing("paper"), paper();
      doing("scene"), scene();
      doing("distance"), distances();
      doing("near pairs"), near();
      doing("manifolds"), manifolds();
      doing("points"), points();
      doing("why"), why();
      doing("clash"), a_.dim() == 3 ? clashes(kinds) : no_clash();
    }
    doing("first contact"), sweep();
  }

 private:
  using Pairs = std::vector<SimplexPair>;

  void doing(const std::string& what) {
    report_.doing(what + " at pose " + std::to_string(step_ - cell_.steps.data()));
  }
  void expect(bool right, const std::string& what) {
    if (!right) report_.wrong(what);
  }
  template <class Change>
  CollideResult answer(const Change& change) const {
    CollideRequest request;
    change(request);
    return collide(a_, {}, b_, step_->pose, request);
  }
  bool meet() const { return !step_->truth.pairs.empty(); }

  void is_truth(const CollideResult& found) {
    const BruteForceResult& truth = step_->truth;
    expect(
        found.pairs == truth.pairs && found.meets == truth.meets,
        std::to_string(found.pairs.size()) + " pairs, brute force has " + std::to_string(truth.pairs.size()));
    is_related(found.relation);
  }
  void is_related(Relation found) {
    expect(found == step_->truth.relation,
           std::string(to_string(found)) + ", brute force says " + to_string(step_->truth.relation));
  }
  void are_some(Pairs found) {
    std::sort(found.begin(), found.end());
    const Pairs& all = step_->truth.pairs;
    expect(std::includes(all.begin(), all.end(), found.begin(), found.end()), "pairs that do not meet");
  }

  void collide_all() {
    const CollideResult found = answer([](CollideRequest& r) { r.contacts = r.interiors_overlap = true; });
    is_truth(found);
    std::size_t shared_out = 0;
    for (const ContactRegion& region : found.regions) shared_out += region.pairs.size();
    expect(shared_out == found.pairs.size(), "contact regions do not share out the pairs");
    expect(found.relation != Relation::separate || found.interiors_overlap != Answer::yes,
           "separate, and overlap");
  }

  void one_pair(Mode mode) {
    const CollideResult found = answer([&](CollideRequest& r) { r.mode = mode; });
    expect(found.pairs.size() == (meet() ? 1U : 0U), "not one pair");
    are_some(found.pairs);
    if (mode == Mode::first_pair || !meet()) is_related(found.relation);
  }

  void coarse() {
    const double tolerance = 0.05 * cell_.size;
    const CollideResult found = answer([&](CollideRequest& r) { r.tolerance = tolerance; });
    is_related(found.relation);
    expect(found.finished && found.error_bound >= 0 && found.error_bound <= 2 * tolerance * (1 + kSlack),
           "error bound " + std::to_string(found.error_bound / cell_.size) + " of the body");
    expect(found.relation == Relation::crossing || found.pairs == step_->truth.pairs, "other pairs");
  }

  void limited() {
    const CollideResult found = answer([](CollideRequest& r) { r.max_tests = 40; });
    if (found.relation == Relation::unresolved) return;
    if (found.error_bound == 0) is_related(found.relation);
    expect(!meet() || found.relation == Relation::crossing || found.relation == Relation::touching,
           "bodies that meet are called apart");
  }

  void paper() {
    are_some(answer([](CollideRequest& r) { r.recursion = Recursion::paper; }).pairs);
  }

  void scene() {
    Scene scene(1);
    scene.add(a_);
    scene.add(b_, step_->pose);
    const auto found = scene.collide();
    const bool reported =
        step_->truth.relation != Relation::separate && step_->truth.relation != Relation::undefined;
    expect(found.size() == (reported ? 1U : 0U), "other bodies meet");
    if (reported && !found.empty()) is_truth(found[0].result.value());
    is_near(scene.nearest().value().result.value());
  }

  void is_near(const DistanceResult& found) {
    const double truth = step_->distance, slack = kSlack * cell_.size;
    expect(found.lower <= found.upper && found.lower <= truth + slack &&
               std::abs(found.upper - truth) <= slack && found.meet == meet(),
           "from " + std::to_string(found.lower / cell_.size) + " to " +
               std::to_string(found.upper / cell_.size) + " of the body, brute force has " +
               std::to_string(truth / cell_.size));
  }

  void distances() {
    const DistanceResult found = distance(a_, {}, b_, step_->pose);
    is_near(found);
    if (!meet()) is_related(found.relation);
    for (const double share : {0.5, 2.0}) {
      DistanceRequest request;
      request.within = share * step_->distance;
      expect(distance(a_, {}, b_, step_->pose, request).within == (meet() || share > 1),
             "wrong about within");
    }
  }

  void near() {
    const auto pairs_within = [&](double within) {
      NearPairsRequest request;
      request.within = within;
      return near_pairs(a_, {}, b_, step_->pose, request);
    };
    Pairs pairs;
    for (const NearPair& pair : pairs_within(0).pairs) pairs.push_back({pair.a, pair.b});
    expect(pairs == step_->truth.pairs, "other pairs at distance 0");
    const double slack = kSlack * cell_.size, least = step_->distance;
    double nearest = std::numeric_limits<double>::infinity();
    for (const NearPair& pair : pairs_within(least + slack).pairs) nearest = std::min(nearest, pair.upper);
    expect(std::abs(nearest - least) <= slack, "the nearest pair is not listed");
    if (least > 2 * slack) expect(pairs_within(least - slack).pairs.empty(), "pairs nearer than the bodies");
  }

  /// Corners of B have a side if A has an inside, and are not nearer to A than B is. Those of A are on it.
  void points() {
    for (const Body* of : {&a_, &b_}) {
      const Pose pose = of == &a_ ? Pose() : step_->pose;
      std::vector<Eigen::Vector3d> corners;
      for (FaceId f = 0; f < of->rep().real_face_count(); ++f)
        for (const VertexId v : of->rep().face(f)) corners.push_back(pose.apply(of->rep().vertices()[v]));
      const double least = of == &a_ ? 0 : step_->distance;
      for (const PointDistance& d : point_distances(a_.rep(), {}, corners)) {
        expect(d.lower <= d.upper && d.upper >= least - kSlack * cell_.size, "a point is nearer than B");
        expect(d.side == Where::on_surface ? d.upper == 0 : d.side.has_value() == a_.rep().closed(), "side");
        expect(of == &b_ || d.upper == 0, "a corner of A is off A");
      }
    }
  }

  void manifolds() {
    for (const double margin : {0.0, 0.05 * cell_.size}) {
      ManifoldRequest request;
      request.margin = margin;
      const ManifoldResult found = contact_manifolds(a_, {}, b_, step_->pose, request);
      Pairs pairs;
      std::size_t shared_out = 0;
      for (const NearPair& pair : found.pairs)
        if (pair.meet != exact::Meet::disjoint) pairs.push_back({pair.a, pair.b});
      expect(pairs == step_->truth.pairs, "manifolds of other pairs");
      for (const ContactManifold& manifold : found.manifolds) {
        shared_out += manifold.pairs.size();
        expect(!manifold.points.empty() && manifold.points.size() <= 4, "not 1 to 4 points");
        for (const ManifoldPoint& p : manifold.points) {
          const Eigen::Vector3d off = p.point[0] - p.point[1] - p.depth * manifold.normal;
          expect(off.cwiseAbs().maxCoeff() <= kSlack * cell_.size, "points that are not apart by the depth");
          expect(p.depth >= -margin - kSlack * cell_.size, "a gap beyond the margin");
        }
      }
      expect(shared_out == found.pairs.size(), "manifolds do not share out the pairs");
    }
  }

  void why() {
    is_truth(explain_walk(a_, {}, b_, step_->pose).result);
    const BruteForceResult& truth = step_->truth;
    for (const SimplexPair pair : {SimplexPair{0, 0}, meet() ? truth.pairs.back() : SimplexPair{0, 0}}) {
      const auto at = std::lower_bound(truth.pairs.begin(), truth.pairs.end(), pair);
      const bool meets = at != truth.pairs.end() && *at == pair;
      const exact::Meet how =
          meets ? truth.meets[static_cast<std::size_t>(at - truth.pairs.begin())] : exact::Meet::disjoint;
      expect(explain_pair(a_, {}, b_, step_->pose, pair).meet == how, "says otherwise of a pair");
    }
  }

  void no_clash() {
    try {
      clash(a_, {}, b_, step_->pose);
      report_.wrong("bodies in the plane are not refused");
    } catch (const InputError& e) {
      expect(std::string(e.what()).find('\n') == std::string::npos, "more than one line");
    }
  }

  void clashes(std::vector<ClashKind>& kinds) {
    ClashRequest request;
    request.depth = request.volume = thorough_;
    const ClashResult found = clash(a_, {}, b_, step_->pose, request);
    expect(is_possible(found.kind), to_string(found.kind));
    for (const auto& interval : {found.depth, found.volume})
      expect(!interval || interval->lower <= interval->upper, "no interval");
    const auto i = static_cast<std::size_t>(step_ - cell_.steps.data());
    if (i == kinds.size()) kinds.push_back(found.kind);
    expect(found.kind == kinds[i], std::string(to_string(found.kind)) + ", elsewhere " + to_string(kinds[i]));
  }

  /// Returns whether this can be the kind of a clash, by the relation.
  bool is_possible(ClashKind found) const {
    using enum ClashKind;
    const bool overlap = found == protrudes || found == pierces || found == cuts_through;
    const bool rejected = found == apart || found == within_clearance;
    switch (step_->truth.relation) {
      case Relation::separate:
      case Relation::undefined:
        return rejected;
      case Relation::crossing:
      case Relation::touching:
        if (!solid_ || !simple_)
          return !rejected;  // perhaps undecided; equal bodies that cross themselves cross
        return step_->truth.relation == Relation::crossing ? overlap : !rejected && found != undecided;
      default:
        if (!simple_ && found == undecided) return true;
        return overlap || found == a_inside_b || found == b_inside_a;
    }
  }

  void sweep() {
    const Motion motion = Motion::screw(cell_.start, cell_.end);
    const FirstContactResult found = first_contact(a_, Motion::still({}), b_, motion);
    expect(found.t0 <= found.t1, "no interval");
    if (cell_.meets)
      expect(found.outcome != MotionOutcome::never && found.t0 <= *cell_.meets, "bodies that meet never do");
    if (found.is_contact() && !found.passed)
      expect(!collide(a_, {}, b_, motion.at(found.t1)).pairs.empty(), "no contact at t1");
    if (found.is_contact() && !found.at_start)
      expect(distance(a_, {}, b_, motion.at(found.t0 / 2)).lower > 0, "contact before t0");
  }

  Report& report_;
  const Body &a_, &b_;
  const Cell& cell_;
  const Step* step_ = nullptr;
  bool thorough_, simple_ = true, solid_ = true;
};

Body of_mesh(const Kind& kind, bool regions, bool merge_planes = false) {
  BodyOptions options;
  options.regions = regions;
  options.build.merge_planes = merge_planes && kind.mesh.dim == 3;
  return Body::from(kind.mesh, options).value();
}

Body of_arrays(const Kind& kind) {
  const Mesh& m = kind.mesh;
  if (m.dim == 2 || m.face_vertices.size() != 3 * m.face_count()) return of_mesh(kind, true);  // no triangles
  std::vector<double> coordinates;
  for (const Eigen::Vector3d& v : m.vertices) coordinates.insert(coordinates.end(), v.begin(), v.end());
  const std::vector<std::uint32_t> corners(m.face_vertices.begin(), m.face_vertices.end());
  return Body::from(coordinates, std::span<const std::uint32_t>(corners)).value();
}

Body of_file(const Kind& kind, const test::Folder& folder, const std::string& format) {
  return Body::load(folder.write("body." + format, file_of(kind.mesh, format))).value();
}

/// With levels, and with faces in a plane merged.
Body saved(const Kind& kind, const test::Folder& folder, bool levels) {
  const Body body = of_mesh(kind, true, levels);
  if (levels) body.rep().levels();
  save_lrb(body, folder / "body.lrb");
  return Body::load(folder / "body.lrb").value();
}

/// As a program in C++ makes one, which states the properties of its mesh.
Body of_rep(const Kind& kind) {
  const bool crosses = !self_intersections(check(kind.mesh)).pairs.empty();
  return Body::from(LrbRep::without_regions(kind.mesh, kind.solid, crosses));
}

/// A way to a body.
struct Door {
  const char* name;
  Body (*open)(const Kind&, const test::Folder&);
};

constexpr Door kDoors[] = {
    {"faces", [](const Kind& k, const test::Folder&) { return of_mesh(k, false); }},
    {"mesh", [](const Kind& k, const test::Folder&) { return of_mesh(k, true); }},
    {"LRB-rep", [](const Kind& k, const test::Folder&) { return of_rep(k); }},
    {"arrays", [](const Kind& k, const test::Folder&) { return of_arrays(k); }},
    {"OBJ", [](const Kind& k, const test::Folder& folder) { return of_file(k, folder, "obj"); }},
    {"other file", [](const Kind& k, const test::Folder& folder) { return of_file(k, folder, k.format); }},
    {"lrb", [](const Kind& k, const test::Folder& folder) { return saved(k, folder, false); }},
    {"lrb with levels", [](const Kind& k, const test::Folder& folder) { return saved(k, folder, true); }}};

/// The pairs of a body, whatever it was made from, are those of the mesh, with the same segments.
void check_self_intersections(Report& report, const Kind& kind, const Body& body) {
  const SelfIntersections truth = self_intersections(check(kind.mesh)),
                          found = self_intersections(body.rep());
  const bool same = std::equal(found.pairs.begin(), found.pairs.end(), truth.pairs.begin(), truth.pairs.end(),
                               [](const SelfIntersection& x, const SelfIntersection& y) {
                                 return x.a == y.a && x.b == y.b && x.kind == y.kind && x.curve == y.curve;
                               });
  if (!same)
    report.wrong(std::to_string(found.pairs.size()) + " pairs of faces, the mesh has " +
                 std::to_string(truth.pairs.size()));
  if (kind.simple && !found.pairs.empty()) report.wrong("intersects itself");
}

/// The report on the mesh, and the body built from it.
void check_build(Report& report, const Kind& kind) {
  report.doing("check");
  CheckedMesh mesh = check(kind.mesh);
  mesh.find_self_intersections();
  if (mesh.report().when_turned().buildable() != kind.builds) report.wrong("buildable, or not");
  if (mesh.report().bounds_solid != kind.solid) report.wrong("a solid, or none");
  if (kind.simple && mesh.report()[MeshFault::self_intersection].count > 0) report.wrong("intersects itself");
  for (const bool merge_planes : {false, true}) {
    report.doing(merge_planes ? "validate, with planes merged" : "validate");
    ValidateOptions options;
    options.wrapper_states = 5;
    const ValidateReport proof = validate(of_mesh(kind, true, merge_planes), options);
    if (!proof.valid) report.wrong("invalid: " + proof.violations.at(0));
  }
  report.doing("build");
  try {
    mesh.turn_outward();
    build_lrb(mesh);
    if (!kind.builds) report.wrong("is not refused");
  } catch (const InputError& e) {
    if (kind.builds) report.wrong(e.what());
  }
}

/// All cells of one kind, through all doors, or only the first and the last one.
void check_kind(std::size_t index, bool all, Report& report) {
  const test::Folder folder;
  const Kind& kind = matrix().kinds[index];
  check_build(report, kind);
  std::map<std::size_t, std::vector<ClashKind>> clashes;  // by B
  for (const Door& door : kDoors) {
    if (!all && &door != std::begin(kDoors) && &door + 1 != std::end(kDoors)) continue;
    report.through(door.name);
    report.doing("open");
    const Body body = door.open(kind, folder);
    report.doing("self-intersections");
    check_self_intersections(report, kind, body);
    for (const Cell& cell : matrix().cells) {
      if (cell.a != index) continue;
      const Body other = cell.b == index ? body : of_mesh(matrix().kinds[cell.b], true);
      Questions(report, body, other, cell, all).ask(clashes[cell.b]);
    }
  }
}

void check_matrix(bool all) {
  for (std::size_t i = 0; i <= matrix().cells.back().a; ++i) {
    CAPTURE(matrix().kinds[i].name);
    CHECK(in_child([&](Report& report) { check_kind(i, all, report); }) == "");
  }
}

}  // namespace

TEST_CASE("kinds of bodies through two interfaces agree with brute force") {
  check_matrix(false);
}

TEST_CASE("kinds of bodies through all interfaces agree with brute force" * doctest::test_suite("long")) {
  check_matrix(true);
}

}  // namespace lrb::matrix
