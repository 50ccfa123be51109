#include "scenarios/record/engine_run.hpp"

#include <algorithm>
#include <iterator>

#include <nlohmann/json.hpp>

#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::record {
namespace {

using nlohmann::json;
constexpr const char* kFormat = "lrbscope trees";

json tree_json(const trace::TreeShape& tree) {
  json children = json::array(), simplices = json::array(), boxes = json::array();
  for (std::uint32_t n = 0; n < tree.size(); ++n) {
    children.push_back(tree.children(n));
    json of_leaf = json::array();
    for (const SimplexId s : tree.simplices(n)) of_leaf.push_back(s.value());
    simplices.push_back(std::move(of_leaf));
    json box = json::array();
    const trace::ShapeBox& shape = tree.box(n);
    for (int k = 0; k < 3; ++k) box.push_back(shape.centre[k]);
    for (const Eigen::Vector3d& half : shape.half)
      for (int k = 0; k < 3; ++k) box.push_back(half[k]);
    boxes.push_back(std::move(box));
  }
  return {
      {"children", std::move(children)}, {"simplices", std::move(simplices)}, {"boxes", std::move(boxes)}};
}

trace::TreeShape tree_of(const json& node, std::uint32_t simplex_count) {
  const json &children = node.at("children"), &simplices = node.at("simplices"), &boxes = node.at("boxes");
  const std::size_t count = children.size();
  if (simplices.size() != count || boxes.size() != count) throw InputError("lists of different lengths");
  trace::TreeShape out;
  for (std::size_t n = 0; n < count; ++n) {
    const auto below = children.at(n).get<std::vector<std::uint32_t>>();
    if (std::any_of(below.begin(), below.end(), [&](std::uint32_t child) { return child >= count; }))
      throw InputError("node " + std::to_string(n) + " has a child that does not exist");
    std::vector<SimplexId> of_leaf;
    for (const json& s : simplices.at(n)) {
      const auto number = s.get<std::uint32_t>();
      if (number >= simplex_count)
        throw InputError("node " + std::to_string(n) + " has a simplex that does not exist");
      of_leaf.emplace_back(number);
    }
    const auto box = boxes.at(n).get<std::array<double, 12>>();
    trace::ShapeBox shape{Eigen::Vector3d(box[0], box[1], box[2]), {}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      shape.half[axis] = {box[3 + 3 * axis], box[4 + 3 * axis], box[5 + 3 * axis]};
    out.add(below, of_leaf, shape);
  }
  out.finish();
  return out;
}

}  // namespace

std::string trees_text(std::span<const trace::TreeShape> trees) {
  json all = json::array();
  for (const trace::TreeShape& tree : trees) all.push_back(tree_json(tree));
  return json{{"format", kFormat}, {"version", 1}, {"trees", std::move(all)}}.dump() + "\n";
}

std::vector<trace::TreeShape> read_trees(const std::string& text, const std::string& name,
                                         const std::array<std::uint32_t, 2>& simplices) {
  const auto fail = [&](const std::string& what) -> InputError {
    return InputError(name + ": expected the trees of a run, found " + what + "; record the run again");
  };
  try {
    const json document = json::parse(text);
    if (document.at("format") != kFormat || document.at("version") != 1)
      throw fail("another format or version");
    const json& trees = document.at("trees");
    if (trees.size() != simplices.size()) throw fail(std::to_string(trees.size()) + " trees");
    std::vector<trace::TreeShape> out;
    for (std::size_t i = 0; i < simplices.size(); ++i) {
      try {
        out.push_back(tree_of(trees.at(i), simplices[i]));
      } catch (const InputError& e) {
        throw fail(std::string("in tree ") + (i == 0 ? "A: " : "B: ") + e.what());
      }
    }
    return out;
  } catch (const json::exception&) {
    throw fail("other JSON, or a damaged file");
  }
}

bool is_compared(const std::optional<trace::EngineReport>& report) {
  return !report ||
         (report->query != trace::EngineQuery::first_contact && report->query != trace::EngineQuery::shape);
}

CollideResult exact_answer(const pictures::PosedBodies& bodies, const CollideRequest& request,
                           const std::optional<trace::EngineReport>& report,
                           std::span<const SimplexPair> found) {
  const auto& [a, pose_a, b, pose_b] = bodies;
  if (report && report->query == trace::EngineQuery::self) {
    CollideResult out;
    PairExplainer pairs(a, b);
    pairs.place(pose_a, pose_b);
    for (const SimplexPair& pair : found)
      if (pairs.explain(pair).meet != exact::Meet::disjoint) out.pairs.push_back(pair);
    out.relation = out.pairs.empty() ? Relation::separate : Relation::crossing;
    return out;
  }
  CollideRequest exact = request;
  exact.contacts = true;
  exact.separation = false;  // it is stored in the trace
  return collide(a, pose_a, b, pose_b, exact);
}

std::vector<SimplexPair> pairs_found(std::span<const trace::Event> events) {
  std::vector<SimplexPair> out;
  for (const trace::Event& e : events)
    if (e.kind == EventKind::contact) out.push_back({e.simplex(Side::a), e.simplex(Side::b)});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<pictures::WrongPair> wrong_pairs(std::span<const SimplexPair> found,
                                             std::span<const SimplexPair> exact,
                                             const std::optional<trace::EngineReport>& report) {
  using trace::EngineQuery, trace::EngineVerdict;
  std::vector<pictures::WrongPair> out;
  if (!is_compared(report)) return out;
  std::vector<SimplexPair> pairs;
  std::set_difference(found.begin(), found.end(), exact.begin(), exact.end(), std::back_inserter(pairs));
  for (const SimplexPair& pair : pairs) out.push_back({pair, false});
  pairs.clear();
  const bool lists_all = !report || (report->query == EngineQuery::all_pairs && report->complete);
  const bool is_separate = report && (report->verdict == EngineVerdict::separate ||
                                      (report->verdict == EngineVerdict::unreported && report->complete));
  if (lists_all || (is_separate && found.empty() && report->query != EngineQuery::self))
    std::set_difference(exact.begin(), exact.end(), found.begin(), found.end(), std::back_inserter(pairs));
  for (const SimplexPair& pair : pairs) out.push_back({pair, true});
  return out;
}

AnswerScore score_of(const trace::StepResult& answer, const WrongAnswer& wrong, const CollideResult& exact) {
  using trace::EngineQuery, trace::EngineVerdict;
  AnswerScore out;
  out.is_wrong = wrong.has_wrong_distance();
  if (!is_compared(answer.engine)) return out;
  out.missed = static_cast<std::uint64_t>(std::ranges::count_if(wrong.pairs, &pictures::WrongPair::missed));
  out.false_pairs = wrong.pairs.size() - out.missed;
  out.undecidable = wrong.undecidable_missed + wrong.undecidable_false;
  out.right = answer.pair_count - out.false_pairs - wrong.undecidable_false;
  // Whether a body intersects itself is not computed.
  if (answer.engine && answer.engine->verdict != EngineVerdict::unreported &&
      answer.engine->query != EngineQuery::self && !wrong.is_verdict_undecidable)
    out.verdict = (answer.engine->verdict == EngineVerdict::intersecting) == !exact.pairs.empty();
  out.is_wrong = out.is_wrong || !wrong.pairs.empty() || out.verdict == false;
  return out;
}

std::string EngineTotals::words() const {
  using render::counted, render::group_digits;
  if (!checked) return counted(queries, "query", "queries") + ", answers not checked";
  std::string out;
  const auto add = [&](bool is_said, const std::string& text) {
    if (is_said) out += (out.empty() ? ": " : ", ") + text;
  };
  const auto of = [](std::uint64_t part, std::uint64_t all) {
    return group_digits(part) + " of " + group_digits(all) + " ";
  };
  const std::string too_close = undecidable == 0 ? ""
                                                 : "; " + counted(undecidable, "pair", "pairs") +
                                                       " too close for the engine's precision";
  if (wrong_queries == 0) {
    add(has_pairs, counted(right, "pair", "pairs"));
    add(verdicts > 0, counted(verdicts, "verdict", "verdicts"));
    add(distances > 0, counted(distances, "distance", "distances"));
    return "no wrong answer in " + counted(queries, "query", "queries") + out + too_close;
  }
  add(missed > 0, of(missed, right + missed) + "intersecting pairs missed");
  add(false_pairs > 0, counted(false_pairs, "false pair", "false pairs"));
  add(wrong_verdicts > 0, of(wrong_verdicts, verdicts) + "verdicts wrong");
  add(wrong_distances > 0, of(wrong_distances, distances) + "distances wrong");
  return "wrong answers in " + of(wrong_queries, queries) + "queries" + out + too_close;
}

EngineTotals totals_of(const trace::Trace& trace, const std::vector<CollideResult>* results,
                       const std::vector<WrongAnswer>* wrongs) {
  EngineTotals out;
  out.queries = trace.steps.size();
  out.checked =
      results != nullptr && wrongs != nullptr && !results->empty() && wrongs->size() == results->size();
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const trace::StepResult& r = trace.steps[i].result;
    out.has_pairs |= !r.engine || r.engine->complete;
    out.intersecting += r.relation == Relation::crossing;
    out.node_pairs += r.counters.node_pairs;
    out.box_tests += r.counters.box_tests;
    out.face_tests += r.counters.face_tests;
    if (!out.checked) continue;
    const AnswerScore s = score_of(r, (*wrongs)[i], (*results)[i]);
    out.right += s.right, out.missed += s.missed, out.false_pairs += s.false_pairs;
    out.undecidable += s.undecidable;
    out.verdicts += s.verdict.has_value(), out.wrong_verdicts += s.verdict == false;
    out.distances += (*wrongs)[i].distance.has_value();
    out.wrong_distances += (*wrongs)[i].has_wrong_distance();
    out.wrong_queries += s.is_wrong;
  }
  return out;
}

EngineTotals& EngineTotals::operator+=(const EngineTotals& other) {
  using T = EngineTotals;
  for (const auto count : {&T::queries, &T::intersecting, &T::node_pairs, &T::box_tests, &T::face_tests,
                           &T::right, &T::missed, &T::false_pairs, &T::undecidable, &T::verdicts,
                           &T::wrong_verdicts, &T::distances, &T::wrong_distances, &T::wrong_queries})
    this->*count += other.*count;
  has_pairs |= other.has_pairs, checked |= other.checked;
  return *this;
}

EngineTotals totals_of(const Recording& run) {
  return totals_of(run.trace, &run.results, &run.wrong);
}

std::string axis_words(std::uint32_t axis) {
  constexpr std::uint32_t kEdges = 6, kEnd = 15, kDirections = 32;
  if (axis < kEdges) return std::string(name_of(static_cast<BoxAxis>(axis)));
  if (axis < kEnd)
    return "edges " + std::to_string((axis - kEdges) / 3 + 1) + " of A and " +
           std::to_string((axis - kEdges) % 3 + 1) + " of B";
  return axis < kDirections ? "axis " + std::to_string(axis)
                            : "direction " + std::to_string(axis - kDirections);
}

}  // namespace lrb::record
