/// Every kind of body through the doors of the library; doors.py has those of the programs.

#include <algorithm>
#include <functional>
#include <map>

#include <doctest/doctest.h>
#ifdef LRB_MATRIX_FCL
#include "lrb/fcl.hpp"
#endif

#include "engine/body/body.hpp"
#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/lrb/validate.hpp"
#include "engine/lrb/wrapper_level.hpp"
#include "engine/mesh/checked_mesh.hpp"
#include "engine/query/clash/clash.hpp"
#include "engine/query/coherent/coherent_query.hpp"
#include "engine/query/explain.hpp"
#include "engine/query/motion/first_contact.hpp"
#include "engine/scene/scene.hpp"
#include "tests/matrix/bodies.hpp"
#include "tests/matrix/child.hpp"
#include "tests/support/folder.hpp"

namespace lrb::matrix {
namespace {

using Pairs = std::vector<SimplexPair>;

const Matrix& matrix() {
  static const Matrix all = make_matrix();
  return all;
}

/// Says what is wrong with the answers about one cell through one door.
class Questions {
 public:
  /// `thorough`: asks also how deep clashes are, which takes as long as all else.
  Questions(Report& report, const Body& a, const Body& b, const Cell& cell, bool thorough)
      : report_(report), a_(a), b_(b), cell_(cell), thorough_(thorough), simple_(is_simple(cell.a) && is_simple(cell.b)),
        solid_(kind(cell.a).solid && kind(cell.b).solid) {}

  /// `kinds`: what clashes were at each step through the doors before; filled in by the first.
  void ask(std::vector<ClashKind>& kinds) {
    CoherentQuery coherent(a_, b_, {}, CoherentQuery::CacheUse::always);
    for (const Step& step : cell_.steps) {
      const std::string at = " at " + std::to_string(&step - cell_.steps.data());
      doing("collide" + at, [&] { collide_all(step); });
      doing("mode first and any" + at, [&] { one_pair(step); });
      doing("tolerance" + at, [&] { coarse(step); });
      doing("max-tests" + at, [&] { limited(step); });
      doing("separation" + at, [&] { separation(step); });
      doing("paper" + at, [&] { paper(step); });
      doing("coherent" + at, [&] { is_truth(coherent.collide({}, step.pose), step); });
      doing("scene" + at, [&] { scene(step); });
      doing("distance" + at, [&] { distances(step); });
      doing("why" + at, [&] { why(step); });
      doing("clash" + at, [&] { clashes(step, kinds); });
    }
    doing("first contact", [&] { sweep(); });
  }

 private:
  static const Kind& kind(std::size_t i) { return matrix().kinds[i]; }
  static bool is_simple(std::size_t i) { return kind(i).simple; }

  void doing(const std::string& what, const std::function<void()>& ask) {
    report_.doing(what);
    ask();
  }
  void expect(bool right, const std::string& what) {
    if (!right) report_.wrong(what);
  }
  CollideResult answer(const Step& step, const CollideRequest& request = {}) const {
    return collide(a_, {}, b_, step.pose, request);
  }
  static bool is_among(const Pairs& some, const Step& step) {
    return std::includes(step.truth.pairs.begin(), step.truth.pairs.end(), some.begin(), some.end());
  }

  void is_truth(const CollideResult& found, const Step& step) {
    expect(found.pairs == step.truth.pairs, std::to_string(found.pairs.size()) + " pairs, brute force has " +
                                                std::to_string(step.truth.pairs.size()));
    expect(found.meets == step.truth.meets, "pairs touch that cross, or cross that touch");
    has_relation(found.relation, step);
  }
  void has_relation(Relation found, const Step& step) {
    expect(found == step.truth.relation,
           std::string(to_string(found)) + ", brute force says " + to_string(step.truth.relation));
  }

  void collide_all(const Step& step) {
    CollideRequest request;
    request.contacts = request.interiors_overlap = true;
    const CollideResult found = answer(step, request);
    is_truth(found, step);
    std::size_t shared_out = 0;
    for (const ContactRegion& region : found.regions) shared_out += region.pairs.size();
    expect(shared_out == found.pairs.size(), "contact regions do not share out the pairs");
    const bool apart = found.pairs.empty() && step.truth.relation == Relation::separate;
    expect(!apart || found.interiors_overlap != Answer::yes, "separate, and interiors overlap");
  }

  void one_pair(const Step& step) {
    for (const Mode mode : {Mode::first_pair, Mode::any_pair}) {
      CollideRequest request;
      request.mode = mode;
      const CollideResult found = answer(step, request);
      expect(found.pairs.size() == std::min<std::size_t>(1, step.truth.pairs.size()) && is_among(found.pairs, step),
             "not one of the pairs");
      if (mode == Mode::first_pair || found.pairs.empty()) has_relation(found.relation, step);
    }
  }

  void coarse(const Step& step) {
    CollideRequest request;
    request.tolerance = 0.05 * cell_.size;
    const CollideResult found = answer(step, request);
    has_relation(found.relation, step);
    expect(found.finished && found.error_bound >= 0 && found.error_bound <= 2 * request.tolerance * (1 + 1e-9),
           "error bound " + std::to_string(found.error_bound / cell_.size) + " of the body");
    if (step.truth.relation != Relation::crossing) expect(found.pairs == step.truth.pairs, "other pairs");
  }

  void limited(const Step& step) {
    CollideRequest request;
    request.max_tests = 40;
    const CollideResult found = answer(step, request);
    const bool open = found.relation == Relation::unresolved || found.error_bound > 0;
    if (!open) has_relation(found.relation, step);
    const bool met = found.relation == Relation::crossing || found.relation == Relation::touching;
    expect(step.truth.pairs.empty() || met || found.relation == Relation::unresolved,
           "bodies that meet are called apart");
  }

  void separation(const Step& step) {
    CollideRequest request;
    request.separation = true;
    const CollideResult found = answer(step, request);
    is_truth(found, step);
    expect(!found.separation || found.relation == Relation::separate, "a separation of bodies that are not separate");
  }

  void paper(const Step& step) {
    CollideRequest request;
    request.recursion = Recursion::paper;
    Pairs found = answer(step, request).pairs;
    std::sort(found.begin(), found.end());
    expect(is_among(found, step), "pairs that do not meet");
  }

  void scene(const Step& step) {
    Scene scene(1);
    scene.add(a_);
    scene.add(b_, step.pose);
    const auto found = scene.collide();
    const bool told = !step.truth.pairs.empty() || step.truth.relation == Relation::a_inside_b ||
                      step.truth.relation == Relation::b_inside_a;
    expect(found.size() == (told ? 1U : 0U), "other bodies meet");
    if (told && !found.empty()) is_truth(found[0].result.value(), step);
    const auto nearest = scene.nearest();
    expect(nearest && is_near(nearest->result.value(), step), "not the nearest");
  }

  bool is_near(const DistanceResult& found, const Step& step) const {
    const double slack = 1e-7 * cell_.size;
    return found.lower <= found.upper && found.lower <= step.distance + slack && found.upper >= step.distance - slack &&
           found.upper <= step.distance + slack && found.meet == !step.truth.pairs.empty();
  }

  void distances(const Step& step) {
    const DistanceResult found = distance(a_, {}, b_, step.pose);
    expect(is_near(found, step), "from " + std::to_string(found.lower / cell_.size) + " to " +
                                     std::to_string(found.upper / cell_.size) + ", brute force has " +
                                     std::to_string(step.distance / cell_.size));
    if (!found.meet) has_relation(found.relation, step);
    for (const double share : {0.5, 2.0}) {
      DistanceRequest request;
      request.within = share * step.distance;
      const bool within = step.distance == 0 ? !step.truth.pairs.empty() : share > 1;
      expect(distance(a_, {}, b_, step.pose, request).within == within, "wrong about within");
    }
  }

  void why(const Step& step) {
    const WalkExplanation walk = explain_walk(a_, {}, b_, step.pose);
    is_truth(walk.result, step);
    for (const SimplexPair pair : {SimplexPair{0, 0}, step.truth.pairs.empty() ? SimplexPair{0, 0} : step.truth.pairs.back()}) {
      const auto found = std::lower_bound(step.truth.pairs.begin(), step.truth.pairs.end(), pair);
      const bool meets = found != step.truth.pairs.end() && *found == pair;
      const PairExplanation told = explain_pair(a_, {}, b_, step.pose, pair);
      expect(told.meet == (meets ? step.truth.meets[static_cast<std::size_t>(found - step.truth.pairs.begin())]
                                 : exact::Meet::disjoint),
             "why says otherwise of a pair");
    }
  }

  void clashes(const Step& step, std::vector<ClashKind>& kinds) {
    if (a_.dim() == 2) {
      try {
        clash(a_, {}, b_, step.pose);
        report_.wrong("bodies in the plane are not refused");
      } catch (const InputError& e) {
        expect(std::string(e.what()).find('\n') == std::string::npos, "more than one line");
      }
      return;
    }
    ClashRequest request;
    request.depth = request.volume = thorough_;
    const ClashResult found = clash(a_, {}, b_, step.pose, request);
    expect(is_possible(found.kind, step), to_string(found.kind));
    expect(!found.depth || found.depth->lower <= found.depth->upper, "no interval of depth");
    expect(!found.volume || found.volume->lower <= found.volume->upper, "no interval of volume");
    const auto i = static_cast<std::size_t>(&step - cell_.steps.data());
    if (i == kinds.size()) kinds.push_back(found.kind);
    expect(found.kind == kinds[i], std::string(to_string(found.kind)) + ", through the first door " + to_string(kinds[i]));
  }

  /// Whether this can be the kind of a clash, by the relation.
  bool is_possible(ClashKind found, const Step& step) const {
    using enum ClashKind;
    const bool parted = found == apart || found == within_clearance;
    const bool overlap = found == protrudes || found == pierces || found == cuts_through;
    const bool inside = found == a_inside_b || found == b_inside_a;
    if (!step.truth.pairs.empty() && (!solid_ || !simple_) && found == undecided) return true;
    switch (step.truth.relation) {
      case Relation::separate:
      case Relation::undefined:
        return parted;
      case Relation::crossing:
        return simple_ ? overlap : !parted;  // faces of one and the same place may cross others of it
      case Relation::touching:
        return !parted && found != undecided;
      default:
        return overlap || inside;
    }
  }

  void sweep() {
    const Motion still = Motion::still({}), motion = Motion::screw(cell_.start, cell_.end);
    const FirstContactResult found = first_contact(a_, still, b_, motion);
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
  bool thorough_, simple_, solid_;
};

/// A way to a body.
struct Door {
  std::string name;
  std::function<Body(const Kind&, const test::Folder&)> open;
};

BodyOptions alone() {
  BodyOptions options;
  options.regions = false;
  return options;
}

Body of_arrays(const Kind& kind) {
  const Mesh& m = kind.mesh;
  const auto each = m.face(FaceId(0)).size();
  Eigen::MatrixXd vertices(m.vertices.size(), m.dim);
  for (std::size_t i = 0; i < m.vertices.size(); ++i)
    vertices.row(static_cast<Eigen::Index>(i)) = m.vertices[i].head(m.dim).transpose();
  Eigen::MatrixXi faces(m.face_count(), each);
  for (FaceId f = 0; f < m.face_count(); ++f) {
    if (m.face(f).size() != each) return Body::from(m).value();  // no matrix: faces of several sizes
    for (std::size_t k = 0; k < each; ++k)
      faces(f.value(), static_cast<Eigen::Index>(k)) = static_cast<int>(m.face(f)[k].value());
  }
  return Body::from(vertices, faces).value();
}

Body saved(const Kind& kind, const test::Folder& folder, bool levels) {
  const Body body = Body::from(kind.mesh).value();
  if (levels) body.rep().levels();
  save_lrb(body, folder / "body.lrb");
  return Body::load(folder / "body.lrb").value();
}

Body of_file(const Kind& kind, const test::Folder& folder, const std::string& format) {
  return Body::load(folder.write("body." + format, file_of(kind.mesh, format))).value();
}

const std::vector<Door>& doors() {
  static const std::vector<Door> all = {
      {"faces", [](const Kind& k, const auto&) { return Body::from(k.mesh, alone()).value(); }},
      {"mesh", [](const Kind& k, const auto&) { return Body::from(k.mesh).value(); }},
      {"arrays", [](const Kind& k, const auto&) { return of_arrays(k); }},
      {"OBJ", [](const Kind& k, const auto& folder) { return of_file(k, folder, "obj"); }},
      {"other file", [](const Kind& k, const auto& folder) { return of_file(k, folder, k.mesh.dim == 2 ? "obj" : k.format); }},
      {"lrb", [](const Kind& k, const auto& folder) { return saved(k, folder, false); }},
      {"lrb with levels", [](const Kind& k, const auto& folder) { return saved(k, folder, true); }}};
  return all;
}

/// What building it says, and its proof.
void check_build(Report& report, const Kind& kind) {
  report.doing("check");
  CheckedMesh mesh = check(kind.mesh);
  mesh.find_self_intersections();
  if (kind.builds && mesh.report().when_turned().buildable() != *kind.builds) report.wrong("buildable, or not");
  if (mesh.report().bounds_solid != kind.solid) report.wrong("a solid, or none");
  if (kind.simple && mesh.report()[MeshFault::self_intersection].count > 0) report.wrong("intersects itself");
  report.doing("validate");
  const Body body = Body::from(kind.mesh).value();
  ValidateOptions options;
  options.wrapper_states = 5;
  const ValidateReport proof = validate(body, options);
  if (body.has_regions() && !proof.valid) report.wrong("invalid: " + proof.violations.at(0));
  report.doing("build");
  try {
    mesh.turn_outward();
    if (!validate(build_lrb(mesh), options).valid && kind.builds) report.wrong("build_lrb() makes what is invalid");
  } catch (const InputError& e) {
    if (kind.builds.value_or(false)) report.wrong(e.what());
  }
}

#ifdef LRB_MATRIX_FCL
void check_fcl(Report& report, const Cell& cell) {
  using Model = ::fcl::BVHModel<::fcl::OBBRSSd>;
  report.doing("FCL's interface");
  Model models[2];
  for (const int side : {0, 1}) {
    const Mesh& m = matrix().kinds[side ? cell.b : cell.a].mesh;
    std::vector<::fcl::Triangle> triangles;
    for (FaceId f = 0; f < m.face_count(); ++f)
      for (std::size_t k = 2; k < m.face(f).size(); ++k)
        triangles.emplace_back(m.face(f)[0], m.face(f)[k - 1], m.face(f)[k]);
    models[side].beginModel();
    models[side].addSubModel(m.vertices, triangles);
    models[side].endModel();
  }
  for (const Step& step : cell.steps) {
    ::fcl::Transform3d place = ::fcl::Transform3d::Identity();
    place.linear() = step.pose.r;
    place.translation() = step.pose.t;
    ::fcl::CollisionResultd found;
    lrb::fcl::collide<double>(&models[0], ::fcl::Transform3d::Identity(), &models[1], place,
                              ::fcl::CollisionRequestd(std::size_t{1} << 20), found);
    if (found.numContacts() != step.truth.pairs.size()) report.wrong("other pairs");
    ::fcl::DistanceResultd apart;
    const double d = lrb::fcl::distance<double>(&models[0], ::fcl::Transform3d::Identity(), &models[1], place, {}, apart);
    if (std::abs(d - step.distance) > 1e-7 * cell.size) report.wrong("another distance");
  }
}
#endif

/// All cells of one kind, through all doors, or only the first and the last one.
void check_kind(std::size_t index, bool all, Report& report) {
  const test::Folder folder;
  const Kind& kind = matrix().kinds[index];
  check_build(report, kind);
  std::map<std::size_t, std::vector<ClashKind>> clashes;
  for (const Door& door : doors()) {
    if (!all && &door != &doors().front() && &door != &doors().back()) continue;
    report.through(door.name);
    try {
      report.doing("open");
      const Body body = door.open(kind, folder);
      for (const Cell& cell : matrix().cells) {
        if (cell.a != index) continue;
        const Body other = cell.b == index ? body : Body::from(matrix().kinds[cell.b].mesh).value();
        Questions(report, body, other, cell, all || &door == &doors().front()).ask(clashes[cell.b]);
      }
    } catch (const std::exception& e) {
      report.wrong(std::string("exception: ") + e.what());
    }
  }
#ifdef LRB_MATRIX_FCL
  report.through("FCL");
  for (const Cell& cell : matrix().cells)
    if (cell.a == index && kind.mesh.dim == 3) check_fcl(report, cell);
#endif
}

void check_matrix(bool all) {
  for (std::size_t i = 0; i <= matrix().cells.back().a; ++i) {
    CAPTURE(matrix().kinds[i].name);
    CHECK(in_child([&](Report& report) { check_kind(i, all, report); }) == "");
  }
}

}  // namespace

TEST_CASE("kinds of bodies through two doors answer as brute force does") {
  check_matrix(false);
}

TEST_CASE("kinds of bodies through all doors answer as brute force does" * doctest::test_suite("long")) {
  check_matrix(true);
}

}  // namespace lrb::matrix
