#include "scenarios/record/engine_run.hpp"

#include <algorithm>
#include <iterator>

#include <nlohmann/json.hpp>

#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>

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

AnswerScore score_of(const trace::StepResult& answer, std::span<const pictures::WrongPair> wrong,
                     const CollideResult& exact) {
  using trace::EngineQuery, trace::EngineVerdict;
  AnswerScore out;
  if (!is_compared(answer.engine)) return out;
  out.missed = static_cast<std::uint64_t>(
      std::count_if(wrong.begin(), wrong.end(), [](const pictures::WrongPair& w) { return w.missed; }));
  out.false_pairs = wrong.size() - out.missed;
  out.right = answer.pair_count - out.false_pairs;
  // Whether a body intersects itself is not computed.
  if (answer.engine && answer.engine->verdict != EngineVerdict::unreported &&
      answer.engine->query != EngineQuery::self)
    out.verdict = (answer.engine->verdict == EngineVerdict::intersecting) == !exact.pairs.empty();
  return out;
}

}  // namespace lrb::record
