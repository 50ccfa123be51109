#include "scenarios/run/explanations.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include <nlohmann/json.hpp>

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/explanation_text.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {
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

bool is_answered(const RecordedRun& p) {
  const CollideRequest& request = p.trace->header.request;
  return p.reps.size() == 2 && request.recursion == Recursion::complete && !request.is_coarse();
}

/// Returns the distinct pairs of real faces that events compare, and those with a wrong result of another
/// engine, by step.
std::vector<ComparedPair> pairs_of(const RecordedRun& p, const Explained& what) {
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
      for (const WrongPair& w : (*p.wrong)[s]) out.push_back({s, w.pair, w.missed});
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
  for (const std::size_t i : evenly(meeting, most)) out.push_back(pairs[i]);
  for (const std::size_t i : evenly(pairs.size() - meeting, most - out.size()))
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

std::string packed_square(const Square& corners, const SceneFrame& frame) {
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
  out["square"] = packed_square(separating_square(boxes, dim), frame);
  return out;
}

json plane_json(const SeparatingPlane& plane, const RecordedRun& p, const trace::Step& step,
                const SceneFrame& frame) {
  const Square square = separating_square(plane, {*p.reps[0], step.pose_a, *p.reps[1], step.pose_b});
  const Eigen::Vector3d& n = plane.normal;
  return {{"gap", rounded(plane.gap())},
          {"normal", {rounded(n.x()), rounded(n.y()), rounded(n.z())}},
          {"square", packed_square(square, frame)}};
}

json walk_json(const RecordedRun& p, const trace::Step& step, const SceneFrame& frame) {
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
json steps_json(const RecordedRun& p, const Explained& what, const SceneFrame& frame, std::size_t most) {
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
  for (const std::size_t i : evenly(empty.size(), most)) {
    out.push_back(walk_json(p, p.trace->steps[what.steps[empty[i]]], frame));
    out.back()["step"] = empty[i];
  }
  return out;
}

}  // namespace

json explanations_json(const RecordedRun& p, const Explained& what, const SceneFrame& frame,
                       const std::string& command, const ExplainLimits& limits) {
  if (!is_answered(p)) return nullptr;
  std::vector<ComparedPair> pairs = pairs_of(p, what);
  std::erase_if(pairs, [&](const ComparedPair& pair) { return is_of_shape(p.trace->steps[pair.step]); });
  const std::size_t all = pairs.size();
  choose(pairs, limits.pairs);
  PairExplainer explainer(*p.reps[0], *p.reps[1]);
  PairColumns columns(frame);
  std::uint32_t placed = kNull;
  for (const ComparedPair& compared : pairs) {
    const trace::Step& step = p.trace->steps[compared.step];
    if (placed != compared.step) explainer.place(step.pose_a, step.pose_b);
    placed = compared.step;
    const auto here = std::lower_bound(what.steps.begin(), what.steps.end(), compared.step);
    columns.add(static_cast<std::uint32_t>(here - what.steps.begin()), explainer.explain(compared.pair));
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
