#include "scenarios/run/explanations.hpp"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/report/assets.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

std::string_view to_text(DecidedBy by, int dim) {
  switch (by) {
    case DecidedBy::node_boxes:
      return "boxes of tree nodes, which are disjoint";
    case DecidedBy::node_edges:
      return "a direction across edges of two nodes' boxes, along which the boxes are disjoint";
    case DecidedBy::face_boxes:
      return "the boxes of the two faces, which are disjoint";
    case DecidedBy::planes:
      return "the plane of one face, which has the other face on one side (floating point with error bounds)";
    case DecidedBy::floats:
      return "floating point with error bounds";
    case DecidedBy::exact:
      // In 2D no test in floating point precedes it.
      return dim == 2 ? "exact predicates of the two segments"
                      : "exact predicates, because the faster test by the tree could not decide";
  }
  return {};
}

namespace {

using Json = nlohmann::ordered_json;

Json xyz_json(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

Json box_gap_json(const BoxPair& p) {
  return {{"a", p.node[0]}, {"b", p.node[1]}, {"gap", p.gap}, {"axis", name_of(p.axis)}};
}

template <class T>
Json ordered_pair(const T& of_a, const T& of_b) {
  return {{"A", of_a}, {"B", of_b}};
}

Json hiding_json(const LrbRep& rep, const std::vector<RegionId>& regions) {
  Json out = Json::array();
  for (const RegionId r : regions)
    out.push_back({{"region", r.value()}, {"layer", rep.layer(r)}, {"lids", rep.lids(r).size()}});
  return out;
}

Json plane_sides_json(const PlaneSides& sides, int corners) {
  Json out = Json::array();
  for (int i = 0; i < corners; ++i)
    out.push_back(
        {{"exact", sides.exact[i]}, {"in_double", sides.in_double[i]}, {"distance", sides.distance[i]}});
  return out;
}

Json contact_points_json(const exact::PairContact& contact) {
  Json corners = Json::array();
  for (int i = 0; i < contact.corner_count; ++i) corners.push_back(xyz_json(contact.corners[i].x));
  return {{"coplanar", contact.coplanar}, {"points", corners}};
}

constexpr int kShownDigits = 6;
/// Distances of more units in the last place are printed without them: double arithmetic decides them
/// reliably.
constexpr double kMaxUlps = 1e6;

std::string point_text(const Eigen::Vector3d& x) {
  const auto text = [](double value) { return io::number_text(value, kShownDigits); };
  return "(" + text(x.x()) + ", " + text(x.y()) + ", " + text(x.z()) + ")";
}

/// Returns the corners of a contact as text; equal texts occur once.
std::vector<std::string> contact_points(const exact::PairContact& contact) {
  std::vector<std::string> out;
  for (int i = 0; i < contact.corner_count; ++i) {
    std::string text = point_text(contact.corners[i].x);
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  }
  return out;
}

/// Writes one line for each pair of boxes.
void write_way(std::ostream& out, const PairExplanation& e) {
  constexpr int kNodeColumn = 10, kGapColumn = 14;
  out << "path from the roots; gap: widest separating gap of the two boxes, negative if they overlap\n";
  out << std::setw(kNodeColumn) << "A's node" << std::setw(kNodeColumn) << "B's node" << std::setw(kGapColumn)
      << "gap"
      << "  along\n";
  const auto line = [&](const BoxPair& p, const char* what) {
    out << std::setw(kNodeColumn) << p.node[0] << std::setw(kNodeColumn) << p.node[1] << std::setw(kGapColumn)
        << p.gap << "  " << name_of(p.axis) << what << "\n";
  };
  for (const BoxPair& p : e.nodes) line(p, "");
  if (e.reaches_faces) line(e.face_boxes, ", the boxes of the two faces");
}

void write_regions(std::ostream& out, const LrbRep& rep, const std::vector<RegionId>& regions,
                   const char* whose) {
  out << whose << " face is covered by " << regions.size() << (regions.size() == 1 ? " region" : " regions");
  for (std::size_t i = 0; i < regions.size(); ++i)
    out << (i == 0 ? ", from outside to inside: " : ", ") << regions[i].value() << " (layer "
        << rep.layer(regions[i]) << ")";
  out << "\n";
}

void write_sides(std::ostream& out, const PlaneSides& sides, int corners, const char* whose,
                 const char* other) {
  out << whose << " corners relative to the " << (corners == 3 ? "plane" : "line") << " of " << other
      << " face: ";
  for (int i = 0; i < corners; ++i) {
    const int sign = sides.exact[i];
    out << (i == 0 ? "" : ", ")
        << (sign > 0   ? "in front"
            : sign < 0 ? "behind"
                       : "on it")
        << " (" << sides.distance[i] << ")";
    if (sides.in_double[i] != sign) out << " (double precision gives " << sides.in_double[i] << ")";
  }
  out << "\n";
}

}  // namespace

Json explanation_json(const PairExplanation& e, const LrbRep& a, const LrbRep& b) {
  Json j;
  j["pair"] = {e.pair.a.value(), e.pair.b.value()};
  j["faces"] = {a.face_of_simplex(e.pair.a).value(), b.face_of_simplex(e.pair.b).value()};
  j["meet"] = name_of(e.meet);
  j["decided_by"] = name_of(e.decided_by);
  j["nodes"] = Json::array();
  for (const BoxPair& p : e.nodes) j["nodes"].push_back(box_gap_json(p));
  if (e.reaches_faces) j["face_boxes"] = box_gap_json(e.face_boxes);
  j["hidden_by"] = ordered_pair(hiding_json(a, e.hidden_by[0]), hiding_json(b, e.hidden_by[1]));
  const int corners = a.dim();
  j["corners_by_the_other_plane"] =
      ordered_pair(plane_sides_json(e.sides[0], corners), plane_sides_json(e.sides[1], corners));
  if (e.meet != exact::Meet::disjoint) {
    j["contact"] = contact_points_json(e.contact);
  } else {
    j["distance"] = e.distance;
    j["distance_in_ulps"] = e.distance / e.ulp;
    j["nearest"] = {xyz_json(e.nearest[0]), xyz_json(e.nearest[1])};
  }
  return j;
}

Json explanation_json(const WalkExplanation& e) {
  Json j;
  j["relation"] = name_of(e.result.relation);
  j["pairs"] = e.result.pairs.size();
  j["roots"] = box_gap_json(e.roots);
  j["depths"] = Json::array();
  for (const WalkDepth& d : e.depths)
    j["depths"].push_back({{"node_pairs", d.node_pairs}, {"ended", d.ended}});
  j["leaf_pairs"] = e.leaf_pairs;
  j["face_pairs"] = e.face_pairs;
  j["left_by_planes"] = e.left;
  j["certain"] = e.certain;
  j["nearest_pairs"] = Json::array();
  for (const SimplexPair& p : e.near) j["nearest_pairs"].push_back({p.a.value(), p.b.value()});
  if (e.nearest_boxes) {
    j["nearest_boxes"] = box_gap_json(e.nearest_boxes->pair);
    j["nearest_boxes"]["of_faces"] = e.nearest_boxes->of_faces;
  }
  if (e.plane) j["plane"] = {{"gap", e.plane->gap()}, {"normal", xyz_json(e.plane->normal)}};
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    j["separation"] = {{"refined", {refined[0].size(), refined[1].size()}}, {"faces", {faces[0], faces[1]}}};
  }
  return j;
}

std::string explanation_text(const PairExplanation& e, const LrbRep& a, const LrbRep& b) {
  std::ostringstream out;
  out << std::setprecision(kShownDigits);
  out << "simplex " << e.pair.a << " of A (face " << a.face_of_simplex(e.pair.a) << " of " << a.name()
      << ") and " << e.pair.b << " of B (face " << b.face_of_simplex(e.pair.b) << " of " << b.name()
      << "): " << name_of(e.meet) << "\n";
  out << "decided by " << to_text(e.decided_by, a.dim()) << "\n\n";
  write_way(out, e);
  out << "\n";
  write_regions(out, a, e.hidden_by[0], "A's");
  write_regions(out, b, e.hidden_by[1], "B's");
  const int corners = a.dim();
  write_sides(out, e.sides[0], corners, "A's", "B's");
  write_sides(out, e.sides[1], corners, "B's", "A's");
  if (e.meet == exact::Meet::disjoint) {
    out << "closest points: " << point_text(e.nearest[0]) << " and " << point_text(e.nearest[1])
        << "\ndistance " << e.distance;
    if (const double ulps = e.distance / e.ulp; ulps < kMaxUlps)
      out << ", " << ulps << " units in the last place of the largest coordinate";
    out << "\n";
  } else {
    constexpr const char* kinds[] = {"nothing", "point", "segment"};
    const std::vector<std::string> points = contact_points(e.contact);
    out << "contact: " << (points.size() < 3 ? kinds[points.size()] : "polygon");
    for (std::size_t i = 0; i < points.size(); ++i) out << (i == 0 ? " " : " to ") << points[i];
    out << "\n";
  }
  return out.str();
}

std::string explanation_text(const WalkExplanation& e) {
  constexpr int kColumn = 12;
  std::ostringstream out;
  out << std::setprecision(kShownDigits);
  out << name_of(e.result.relation) << ", " << e.result.pairs.size() << " pairs\n";
  out << "boxes of the bodies: "
      << (e.roots.gap > 0 ? "gap >= " + io::lower_text(e.roots.gap, kShownDigits)
                          : "overlap by " + io::number_text(-e.roots.gap, kShownDigits))
      << " along " << name_of(e.roots.axis) << "\n\n";
  out << std::setw(kColumn) << "depth" << std::setw(kColumn) << "node pairs" << std::setw(kColumn)
      << "disjoint"
      << "\n";
  for (std::size_t i = 0; i < e.depths.size(); ++i)
    out << std::setw(kColumn) << i << std::setw(kColumn) << e.depths[i].node_pairs << std::setw(kColumn)
        << e.depths[i].ended << "\n";
  out << "\npairs of leaves " << e.leaf_pairs << ", pairs of faces with overlapping boxes " << e.face_pairs
      << "; not separated by planes: " << e.left << ", about " << e.certain
      << " of them decided in floating point\n";
  if (!e.near.empty()) {
    out << "closest of these, for --pair:";
    for (const SimplexPair& p : e.near) out << " " << p.a << "," << p.b;
    out << "\n";
  }
  if (e.result.pairs.empty() && e.left == 0) out << "no two faces need an individual test\n";
  if (const auto& boxes = e.nearest_boxes)
    out << "closest disjoint boxes: " << (boxes->of_faces ? "faces in the leaves " : "nodes ")
        << boxes->pair.node[0] << " of A and " << boxes->pair.node[1] << " of B, gap " << boxes->pair.gap
        << " along " << name_of(boxes->pair.axis) << "\n";
  if (e.plane)
    out << "separating plane with normal (" << e.plane->normal.x() << ", " << e.plane->normal.y() << ", "
        << e.plane->normal.z() << "), gap >= " << io::lower_text(e.plane->gap(), kShownDigits) << "\n";
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    out << "wrappers of " << faces[0] << " and " << faces[1] << " faces, with " << refined[0].size()
        << " and " << refined[1].size()
        << " regions refined, also prove it (draw them with `query --draw-separation`)\n";
  }
  return out.str();
}

namespace {

using nlohmann::json;
using report::packed;
using Numbers = std::vector<std::uint32_t>;

/// A pair of faces that an event compares. `step`: index into the trace's steps.
struct ComparedPair {
  std::uint32_t step;
  SimplexPair pair;
  bool meets;

  bool same_pair(const ComparedPair& o) const { return step == o.step && pair == o.pair; }
};

bool is_answered(const frames::RecordedRun& p) {
  const CollideRequest& request = p.trace->header.request;
  return p.reps.size() == 2 && request.recursion == Recursion::complete && !request.is_coarse();
}

/// Returns the distinct pairs of real faces that events compare, and those with a wrong result of another
/// engine, by step.
std::vector<ComparedPair> pairs_of(const frames::RecordedRun& p, const Explained& what) {
  std::vector<ComparedPair> out;
  std::size_t step = 0;
  for (const trace::EventId id : what.events) {
    const trace::Event& e = p.trace->events[id];
    while (step + 1 < p.trace->steps.size() && p.trace->steps[step + 1].first_event <= id) ++step;
    if (e.kind != EventKind::face_test && e.kind != EventKind::contact) continue;
    if (e.a >= p.reps[0]->real_simplex_count() || e.b >= p.reps[1]->real_simplex_count()) continue;
    out.push_back({static_cast<std::uint32_t>(step),
                   {SimplexId(e.a), SimplexId(e.b)},
                   e.kind == EventKind::contact || e.meet != exact::Meet::disjoint});
  }
  if (p.wrong != nullptr && !p.wrong->empty())
    for (const std::uint32_t s : what.steps)
      for (const pictures::WrongPair& w : (*p.wrong)[s].pairs) out.push_back({s, w.pair, w.missed});
  std::sort(out.begin(), out.end(), [](const ComparedPair& x, const ComparedPair& y) {
    if (!x.same_pair(y)) return x.step != y.step ? x.step < y.step : x.pair < y.pair;
    return x.meets > y.meets;
  });
  out.erase(std::unique(out.begin(), out.end(),
                        [](const ComparedPair& x, const ComparedPair& y) { return x.same_pair(y); }),
            out.end());
  return out;
}

/// Keeps at most `most` pairs; intersecting pairs come first.
void choose(std::vector<ComparedPair>& pairs, std::size_t most) {
  if (pairs.size() <= most) return;
  std::stable_partition(pairs.begin(), pairs.end(), [](const ComparedPair& x) { return x.meets; });
  const auto meeting = static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](const ComparedPair& x) { return x.meets; }));
  std::vector<ComparedPair> out;
  for (const std::size_t i : pictures::evenly(meeting, most)) out.push_back(pairs[i]);
  for (const std::size_t i : pictures::evenly(pairs.size() - meeting, most - out.size()))
    out.push_back(pairs[meeting + i]);
  std::stable_sort(out.begin(), out.end(),
                   [](const ComparedPair& x, const ComparedPair& y) { return x.step < y.step; });
  pairs = std::move(out);
}

/// Collects explanations of pairs in columns.
class PairColumns {
 public:
  explicit PairColumns(const SceneFrame& frame) : frame_(frame) {}

  /// `step`: index among those of the page.
  void add(std::uint32_t step, const PairExplanation& e) {
    step_.push_back(step);
    a_.push_back(e.pair.a.value());
    b_.push_back(e.pair.b.value());
    meet_.push_back(static_cast<std::uint32_t>(e.meet));
    by_.push_back(static_cast<std::uint32_t>(e.decided_by));
    reaches_faces_.push_back(e.reaches_faces ? 1 : 0);
    for (const BoxPair& boxes : e.nodes) add(boxes);
    if (e.reaches_faces) add(e.face_boxes);
    way_end_.push_back(static_cast<std::uint32_t>(gap_.size()));
    if (e.meet == exact::Meet::disjoint)
      for (const Eigen::Vector3d& x : e.nearest) frame_.add_point(points_, x);
    else
      for (int i = 0; i < e.contact.corner_count; ++i) frame_.add_point(points_, e.contact.corners[i].x);
    points_end_.push_back(static_cast<std::uint32_t>(points_.size() / 3));
    distance_.push_back(static_cast<float>(e.distance));
    ulps_.push_back(static_cast<float>(e.distance / e.ulp));
    for (const PlaneSides& sides : e.sides)
      for (std::size_t i = 0; i < 3; ++i) {
        corner_.push_back(static_cast<float>(sides.distance[i]));
        // Signs coded as 0 to 2: exact, then in double.
        signs_.push_back(static_cast<std::uint32_t>(3 * (sides.exact[i] + 1) + sides.in_double[i] + 1));
      }
  }

  json take() const {
    return {{"count", step_.size()},
            {"step", packed(step_)},
            {"a", packed(a_)},
            {"b", packed(b_)},
            {"meet", packed(meet_)},
            {"by", packed(by_)},
            {"reachesFaces", packed(reaches_faces_)},
            {"wayEnd", packed(way_end_)},
            {"nodeA", packed(node_a_)},
            {"nodeB", packed(node_b_)},
            {"gap", packed(gap_)},
            {"axis", packed(axis_)},
            {"pointsEnd", packed(points_end_)},
            {"points", packed(points_)},
            {"distance", packed(distance_)},
            {"ulps", packed(ulps_)},
            {"corner", packed(corner_)},
            {"signs", packed(signs_)}};
  }

 private:
  void add(const BoxPair& boxes) {
    node_a_.push_back(boxes.node[0]);
    node_b_.push_back(boxes.node[1]);
    gap_.push_back(static_cast<float>(boxes.gap));
    axis_.push_back(static_cast<std::uint32_t>(boxes.axis));
  }

  const SceneFrame& frame_;
  Numbers step_, a_, b_, meet_, by_, reaches_faces_, way_end_, points_end_;
  Numbers node_a_, node_b_, axis_, signs_;
  std::vector<float> gap_, points_, distance_, ulps_, corner_;
};

/// Rounds a number to the displayed number of digits.
double rounded(double x) {
  const std::string text = io::number_text(x);
  double out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

json gap_json(const BoxPair& boxes) {
  return {
      {"a", boxes.node[0]}, {"b", boxes.node[1]}, {"gap", rounded(boxes.gap)}, {"axis", name_of(boxes.axis)}};
}

std::string packed_square(const pictures::Square& corners, const SceneFrame& frame) {
  std::vector<float> out;
  for (const Eigen::Vector3d& x : corners) frame.add_point(out, x);
  return packed(out);
}

json boxes_json(const SeparatingBoxes& boxes, int dim, const SceneFrame& frame) {
  std::vector<float> places;
  for (const WorldBox& box : boxes.boxes) {
    frame.add_point(places, box.centre);
    for (const Eigen::Vector3d& half : box.half) frame.add_vector(places, half);
  }
  json out = gap_json(boxes.pair);
  out["ofFaces"] = boxes.of_faces;
  out["places"] = packed(places);
  out["square"] = packed_square(pictures::separating_square(boxes, dim), frame);
  return out;
}

json plane_json(const SeparatingPlane& plane, const frames::RecordedRun& p, const trace::Step& step,
                const SceneFrame& frame) {
  const pictures::Square square =
      pictures::separating_square(plane, {*p.reps[0], step.pose_a, *p.reps[1], step.pose_b});
  const Eigen::Vector3d& n = plane.normal;
  return {{"gap", rounded(plane.gap())},
          {"normal", {rounded(n.x()), rounded(n.y()), rounded(n.z())}},
          {"square", packed_square(square, frame)}};
}

json walk_json(const frames::RecordedRun& p, const trace::Step& step, const SceneFrame& frame) {
  const WalkExplanation e = explain_walk(*p.reps[0], step.pose_a, *p.reps[1], step.pose_b);
  json depths = json::array();
  for (const WalkDepth& d : e.depths) depths.push_back({d.node_pairs, d.ended});
  json out = {{"relation", name_of(e.result.relation)},
              {"roots", gap_json(e.roots)},
              {"depths", std::move(depths)},
              {"facePairs", e.face_pairs},
              {"left", e.left},
              {"certain", e.certain},
              {"plane", nullptr},
              {"boxes", nullptr},
              {"near", nullptr}};
  if (e.plane) out["plane"] = plane_json(*e.plane, p, step, frame);
  if (e.nearest_boxes) out["boxes"] = boxes_json(*e.nearest_boxes, p.reps[0]->dim(), frame);
  if (!e.near.empty()) out["near"] = {e.near[0].a.value(), e.near[0].b.value()};
  return out;
}

/// Returns true for queries of a tree with a shape, whose triangles are not those of a test.
bool is_of_shape(const trace::Step& step) {
  return step.result.engine && step.result.engine->query == trace::EngineQuery::shape;
}

/// Explains the steps without pairs; evenly spaced ones if there are too many.
json steps_json(const frames::RecordedRun& p, const Explained& what, const SceneFrame& frame,
                std::size_t most) {
  Numbers empty;
  for (std::uint32_t i = 0; i < what.steps.size(); ++i) {
    const trace::Step& step = p.trace->steps[what.steps[i]];
    if (is_of_shape(step)) continue;
    const CollideResult* exact =
        p.results != nullptr && what.steps[i] < p.results->size() ? &(*p.results)[what.steps[i]] : nullptr;
    // Another engine's answer may be wrong; the results are lrbscope's.
    if (step.finished && (exact != nullptr ? exact->pairs.empty() : step.result.pair_count == 0))
      empty.push_back(i);
  }
  json out = json::array();
  for (const std::size_t i : pictures::evenly(empty.size(), most)) {
    out.push_back(walk_json(p, p.trace->steps[what.steps[empty[i]]], frame));
    out.back()["step"] = empty[i];
  }
  return out;
}

/// Returns true if the exact answer names a solid box by its first face, of which an explanation would speak.
bool names_a_solid(const frames::RecordedRun& p, std::uint32_t step, PairExplainer& placed) {
  if (p.wrong == nullptr || p.wrong->empty()) return false;  // lrbscope's own run
  const std::vector<SimplexPair>& exact = (*p.results)[step].pairs;
  return std::ranges::all_of(exact, [](const SimplexPair& pair) { return pair.b == 0; }) &&
         std::ranges::any_of(exact, [&](const SimplexPair& pair) {
           return placed.explain(pair).meet == exact::Meet::disjoint;
         });
}

}  // namespace

json explanations_json(const frames::RecordedRun& p, const Explained& what, const SceneFrame& frame,
                       const std::string& command, const ExplainLimits& limits) {
  if (!is_answered(p)) return nullptr;
  std::vector<ComparedPair> pairs = pairs_of(p, what);
  std::erase_if(pairs, [&](const ComparedPair& pair) { return is_of_shape(p.trace->steps[pair.step]); });
  const std::size_t all = pairs.size();
  choose(pairs, limits.pairs);
  PairExplainer explainer(*p.reps[0], *p.reps[1]);
  PairColumns columns(frame);
  std::uint32_t placed = kNull;
  bool of_solid = false;
  for (const ComparedPair& compared : pairs) {
    const trace::Step& step = p.trace->steps[compared.step];
    if (placed != compared.step) {
      explainer.place(step.pose_a, step.pose_b);
      of_solid = names_a_solid(p, compared.step, explainer);
    }
    placed = compared.step;
    if (of_solid) continue;
    const auto current = std::lower_bound(what.steps.begin(), what.steps.end(), compared.step);
    columns.add(static_cast<std::uint32_t>(current - what.steps.begin()), explainer.explain(compared.pair));
  }
  json by = json::array(), meets = json::array(), axes = json::array();
  for (const auto& entry : kEnumNames<DecidedBy>) by.push_back(to_text(entry.value, p.reps[0]->dim()));
  for (const auto& entry : kEnumNames<exact::Meet>) meets.push_back(entry.name);
  for (const auto& entry : kEnumNames<BoxAxis>) axes.push_back(entry.name);
  std::string cut;
  if (pairs.size() < all)
    cut = "This page explains " + render::group_digits(pairs.size()) + " of the " +
          render::group_digits(all) + " pairs tested by its events, contacts first.";
  return {{"by", std::move(by)},
          {"meets", std::move(meets)},
          {"axes", std::move(axes)},
          {"cut", cut},
          {"command", command},
          {"pairs", columns.take()},
          {"steps", steps_json(p, what, frame, limits.steps)}};
}

}  // namespace lrb::run
