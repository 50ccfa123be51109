#include "scenarios/profile/check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <set>

#include "render/pictures/answer_picture.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "scenarios/profile/tree_report.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::profile {
namespace {

using render::group_digits;

/// Ratio of the ends of the scale: triangles with less than a hundredth of the maximum are pale.
constexpr double kRange = 100;

pictures::Panel panel_of(const LrbRep& rep, const WasteMap& map, const render::ScaleBar& scale,
                         bool from_behind, const Eigen::Vector3d& up) {
  pictures::Panel panel;
  panel.list.edge_styles[0] = {render::with_alpha(render::kWhite, 110), 0.8F};
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    const double share = render::place_on(scale, map.waste[f]);
    render::DrawTriangle t;
    t.colour = share > 0 ? render::palette::heat(share) : render::palette::kPaleFront;
    t.edges = 7;
    panel.list.add_polygon(pictures::corners_of(rep, f), t);
  }
  render::FitOptions fit;
  const Eigen::Vector3d from = pictures::broadside(pictures::box_of(rep), up);
  fit.view = {from_behind ? Eigen::Vector3d(2 * from.dot(up) * up - from) : from, up};
  panel.camera = pictures::fit_points(pictures::real_corners(rep), rep.dim(), fit);
  const std::string name = std::filesystem::path(map.mesh.name).filename().string();
  panel.title = (name.empty() ? "mesh" : name) + (from_behind ? ", from behind" : "");
  panel.lighting = pictures::kScaleLighting;
  return panel;
}

/// Draws each mesh from two opposite sides, with its triangles coloured by their waste on one logarithmic
/// scale. Throws EnvironmentError if this machine cannot render.
render::Image draw_waste(std::span<const WasteMap> maps, const Eigen::Vector3d& up) {
  double most = 0;
  for (const WasteMap& map : maps) most = std::max(most, *std::ranges::max_element(map.waste));
  const render::ScaleBar scale{"wasted visits per triangle (log scale)", most / kRange, most, true};
  std::vector<pictures::Panel> panels;
  for (const WasteMap& map : maps) {
    const bodies::LoadedBody body = captured_body(map.mesh);
    for (const bool from_behind : {false, true})
      panels.push_back(panel_of(body.rep, map, scale, from_behind, up));
  }
  constexpr int kSheetWidth = 1160, kHeight = 300;  // one row, so that all sides of both engines are compared
  pictures::Look look;
  look.width = kSheetWidth / static_cast<int>(panels.size());
  look.height = kHeight;
  render::MontageOptions options;
  options.columns = static_cast<int>(panels.size());
  render::Overlay overlay;
  overlay.scale = scale;
  return pictures::with_overlay(pictures::draw_sheet(panels, look, options), overlay);
}

render::Image draw_wrong(const ShownPair& wrong, const Eigen::Vector3d& up) {
  const auto body = [](capture::Mesh mesh) {
    mesh.name = std::filesystem::path(mesh.name).stem().string();
    return captured_body(mesh);
  };
  const bodies::LoadedBody a = body(wrong.meshes[0]), b = body(wrong.meshes[1]);
  const pictures::PosedBodies posed{a.rep, wrong.poses[0], b.rep, wrong.poses[1]};
  return pictures::picture_of(explain_pair(a.rep, posed.pose_a, b.rep, posed.pose_b, wrong.pair), posed, true,
                              up);
}

std::uint64_t visits_in(const capture::Capture& capture) {
  std::uint64_t out = 0;
  for (const capture::Query& q : capture.queries)
    out += static_cast<std::uint64_t>(std::ranges::count_if(
        q.events, [](const capture::Event& e) { return e.kind == capture::EventKind::nodes; }));
  return out;
}

void add(std::vector<Cause>& causes, const std::string& words, std::string line) {
  auto at = std::ranges::find(causes, words, &Cause::words);
  if (at == causes.end()) at = causes.insert(at, {words, {}});
  at->lines.push_back(std::move(line));
}

/// Adds the lines about a query.
void report(const QueryVerdict& v, const capture::Query& query, CapturedBodies& bodies, Check& out) {
  const std::string head = "query " + std::to_string(v.number) + ": ";
  const std::string of_answer = "verdict, number of pairs or distance";
  if (v.answer == Judgement::wrong) add(out.wrong, of_answer, head + v.remark);
  if (v.answer == Judgement::undecidable) add(out.undecidable, of_answer, head + v.remark);
  if (v.wrong.empty()) return;
  const auto trees = bodies.trees_of(query).value();
  const auto line = [&](const WrongPair& w) {
    return head + sentence(w, bodies.tree(trees[0]), bodies.tree(trees[1]));
  };
  // Those beyond the error bound come first.
  if (const WrongPair& w = v.wrong.front(); !out.first_wrong && !w.undecidable &&
                                            query.probe.shape == capture::ProbeShape::none &&
                                            query.kind != capture::QueryKind::self)
    out.first_wrong = {{bodies.mesh_of(trees[0]), bodies.mesh_of(trees[1])},
                       query.poses,
                       {SimplexId(w.triangles.a), SimplexId(w.triangles.b)},
                       line(w)};
  for (const WrongPair& w : v.wrong) add(w.undecidable ? out.undecidable : out.wrong, cause_of(w), line(w));
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "-";
  const double share = 100 * static_cast<double>(part) / static_cast<double>(whole);
  return part > 0 && share < 0.5 ? "< 1 %" : std::to_string(std::lround(share)) + " %";
}

/// Calls row(engine, kind, sums) for each kind of query of each engine.
template <class Row>
void for_each_kind(std::span<const Check> checks, const Row& row) {
  for (const Check& c : checks)
    for (const auto& [kind, sums] : c.kinds) row(c.engine, io::in_words(name_of(kind)), sums);
}

report::Table advice_table(std::span<const Check> checks) {
  report::Table t{"What to change", {"engine", "about", "finding"}};
  for (const Check& c : checks)
    for (const auto& [about, text] : {std::pair{"poses", c.pose_error},
                                      {"trees", c.tree_faults},
                                      {"sample", c.sample},
                                      {"visits", advice(c.sum().prices)}})
      if (!text.empty()) t.rows.push_back({c.engine, about, text});
  return t;
}

report::Table wrong_table(std::span<const Check> checks) {
  report::Table t{"Wrong and undecidable answers by cause",
                  {"engine", "verdict", "cause", "number", "the first one"}};
  for (const Check& c : checks)
    for (const auto& [word, causes] : {std::pair{"wrong", &c.wrong}, {"undecidable", &c.undecidable}})
      for (const Cause& cause : *causes)
        t.rows.push_back({c.engine, word, cause.words, group_digits(cause.lines.size()), cause.lines[0]});
  if (std::ranges::any_of(checks, [](const Check& c) { return !c.sample.empty(); }))
    t.note = "Of a sample, numbers in this table are of the recorded queries.";
  return t;
}

report::Chart chart_by_query(const Check& c) {
  // The prices of a bar, from the bottom: blue: needed work, orange and red: waste.
  struct Part {
    const char *name, *colour;
    std::uint64_t Prices::*visits;
  };
  static constexpr Part kParts[] = {{"needed", "#0072b2", &Prices::needed},
                                    {"proof", "#56b4e9", &Prices::proof},
                                    {"test", "#b2182b", &Prices::test},
                                    {"volumes", "#d55e00", &Prices::volumes},
                                    {"order", "#f0a830", &Prices::order},
                                    {"not split", "#e08020", &Prices::unsplit},
                                    {"unattributed", "#8c8c8c", &Prices::unattributed}};
  constexpr std::size_t kMaxBars = 400;
  report::Chart out{"Prices by query, " + c.engine, {"query"}, {"visits"}};
  // Longer captures show every n-th query.
  const std::size_t every = 1 + c.queries.size() / kMaxBars;
  if (every > 1) out.note = "One of " + std::to_string(every) + " queries.";
  for (const auto& [name, colour, visits] : kParts) {
    report::Series series{name, {}, {}, {report::Line::bars, colour}};
    for (std::size_t i = 0; i < c.queries.size(); i += every) {
      series.x.push_back(c.queries[i].verdict.number);
      series.y.push_back(static_cast<double>(c.queries[i].prices.*visits));
    }
    if (std::ranges::any_of(series.y, [](double y) { return y != 0; }))
      out.series.push_back(std::move(series));
  }
  return out;
}

}  // namespace

CheckSums sums_of(const CheckedQuery& q) {
  CheckSums out;
  out.queries = 1;
  ++out.outcomes[static_cast<std::size_t>(q.verdict.outcome)];
  out.exact_pairs = q.verdict.exact_pairs;
  out.right = q.verdict.right;
  out.missed = q.verdict.missed;
  out.extra = q.verdict.extra;
  out.undecidable = q.verdict.undecidable;
  out.prices = q.prices;
  return out;
}

CheckSums& CheckSums::operator+=(const CheckSums& other) {
  queries += other.queries;
  for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += other.outcomes[i];
  exact_pairs += other.exact_pairs;
  right += other.right;
  missed += other.missed;
  extra += other.extra;
  undecidable += other.undecidable;
  prices += other.prices;
  return *this;
}

CheckSums& CheckSums::operator*=(std::uint64_t factor) {
  for (std::uint64_t* count : {&queries, &exact_pairs, &right, &missed, &extra, &undecidable})
    *count *= factor;
  for (std::uint64_t& count : outcomes) count *= factor;
  for (const auto& [name, count] : kPriceCounts) prices.*count *= factor;
  for (std::int64_t& saved : prices.saved_by_leaves) saved *= static_cast<std::int64_t>(factor);
  return *this;
}

CheckSums Check::sum() const {
  CheckSums out;
  for (const auto& [kind, sums] : kinds) out += sums;
  return out;
}

namespace {

/// Returns the waste on the meshes of the two trees with most of it.
std::vector<WasteMap> most_wasted(const capture::Capture& capture, PriceBook& book) {
  constexpr std::size_t kMaps = 2;
  std::vector<std::pair<double, WasteMap>> all;
  for (std::uint32_t tree = 0; tree < capture.trees.size(); ++tree) {
    std::vector<double> waste = book.waste_by_triangle(tree);
    const double sum = std::accumulate(waste.begin(), waste.end(), 0.0);
    if (sum > 0) all.push_back({sum, {capture.meshes[capture.trees[tree].mesh], std::move(waste)}});
  }
  std::ranges::stable_sort(all, [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<WasteMap> out;
  for (std::size_t i = 0; i < std::min(kMaps, all.size()); ++i) out.push_back(std::move(all[i].second));
  return out;
}

/// Finds an error of the recorded poses, or of the numbers of triangles, that explains wrong answers.
class PoseErrors {
 public:
  void add(const CheckedQuery& checked, const capture::Query& query, const QueryWalk* walk,
           Checker& checker) {
    const bool has_pairs = query.kind == capture::QueryKind::all_pairs && checked.verdict.found > 0 &&
                           query.probe.shape == capture::ProbeShape::none;
    if (walk == nullptr || !has_pairs) return;
    // A few wrong pairs have another cause.
    const bool mostly_wrong = checked.verdict.extra > checked.verdict.found / 2;
    ++(mostly_wrong ? wrong_ : right_);
    as_many_ += mostly_wrong && checked.verdict.found == checked.verdict.exact_pairs;
    if (!mostly_wrong || tried_ == kTries) return;
    ++tried_;
    const auto explains = checker.explaining_errors(query, *walk);
    for (std::size_t i = 0; i < kPoseErrors; ++i) possible_[i] = possible_[i] && explains[i];
  }
  std::string sentence() const {
    if (tried_ == 0 || wrong_ < right_) return {};
    std::string out;
    for (std::size_t i = 0; i < kPoseErrors; ++i)
      if (possible_[i]) out += (out.empty() ? "" : "; or ") + std::string(words(static_cast<PoseError>(i)));
    if (out.empty() && as_many_ == wrong_)
      return "Each query finds as many pairs as there are, but others: the engine probably numbers the triangles in "
             "another way than the recorded mesh.";
    return out.empty()
               ? out
               : "The poses are probably recorded wrongly, because then the pairs are right: " + out + ".";
  }

 private:
  static constexpr int kTries = 8;
  std::array<bool, kPoseErrors> possible_{true, true, true, true};
  int tried_ = 0;
  std::uint64_t wrong_ = 0, right_ = 0, as_many_ = 0;
};

/// Returns a sentence about the faults of the trees that have visits, with the first one.
std::string sentence_of_faults(const std::set<std::uint32_t>& trees, CapturedBodies& bodies) {
  std::uint64_t count = 0;
  std::string first;
  for (const std::uint32_t t : trees) {
    const TreeFaults faults = faults_of(bodies.volumes(t), bodies.mesh_of(t), bodies.index(t));
    count += faults.total();
    if (first.empty() && count > 0) first = text_of(faults.first.front(), bodies.tree(t), bodies.mesh_of(t));
  }
  if (count == 0) return {};
  return "The trees have " + render::counted(count, "fault", "faults") +
         ", which `lrbscope tree` lists, so prices and causes may be wrong: " + first + ".";
}

/// Returns a sentence with the standard error of the sum of visits, from their variance among the queries of
/// the sample (Cochran 1977, section 2.6).
std::string sentence_of_sample(const Check& c, std::uint64_t every) {
  const auto n = static_cast<double>(c.queries.size()), share = 1 / static_cast<double>(every);
  double sum = 0, squares = 0;
  for (const CheckedQuery& q : c.queries) sum += static_cast<double>(q.prices.visits);
  for (const CheckedQuery& q : c.queries)
    squares += std::pow(static_cast<double>(q.prices.visits) - sum / n, 2);
  const double error = sum > 0 && n > 1 ? std::sqrt(squares * n / (n - 1) * (1 - share)) / sum : 1;
  return "One of " + std::to_string(every) +
         " queries was recorded. Sums are scaled to all; that of visits has a standard error of " +
         std::to_string(std::lround(std::ceil(100 * error))) + " %.";
}

}  // namespace

Check check(const capture::Capture& capture, const CheckSettings& settings,
            const record::ProgressReport& progress) {
  Check out;
  out.engine = capture.engine;
  out.precision = settings.precision.value_or(precision_of(capture));
  const bool split = settings.split.value_or(visits_in(capture) <= kMaxVisitsToSplit);
  CapturedBodies bodies(capture);
  Checker checker(bodies, out.precision);
  PriceBook book(bodies);
  PoseErrors pose_errors;
  std::set<std::uint32_t> visited;
  for (const capture::Query& query : capture.queries) {
    const auto trees = bodies.trees_of(query);
    const auto walk = trees ? std::make_unique<QueryWalk>(bodies, query, *trees) : nullptr;
    CheckedQuery checked{checker.check(query, walk.get()), {}};
    checked.prices = book.add(query, walk.get(), checked.verdict.exact, split);
    checked.verdict.exact = {};
    if (walk != nullptr && walk->visits() > 0) visited.insert(trees->begin(), trees->end());
    pose_errors.add(checked, query, walk.get(), checker);
    report(checked.verdict, query, bodies, out);
    out.kinds[query.kind] += sums_of(checked);
    out.queries.push_back(std::move(checked));
    progress("check", out.queries.size(), capture.queries.size());
  }
  for (auto& [kind, sums] : out.kinds) sums *= capture.every;
  if (capture.every > 1) out.sample = sentence_of_sample(out, capture.every);
  for (std::vector<Cause>* causes : {&out.wrong, &out.undecidable})
    std::ranges::stable_sort(*causes, std::greater(), [](const Cause& c) { return c.lines.size(); });
  out.waste = most_wasted(capture, book);
  out.pose_error = pose_errors.sentence();
  visited.erase(CapturedBodies::kProbe);
  out.tree_faults = sentence_of_faults(visited, bodies);
  for (WasteMap& map : out.waste)
    for (double& visits : map.waste) visits *= static_cast<double>(capture.every);
  return out;
}

report::Table price_table(std::span<const Check> checks) {
  report::Table t{"Benefit of the visits",
                  {"engine", "queries", "visits", "needed", "proof", "test", "volumes", "order"}};
  const bool unsplit = std::ranges::any_of(checks, [](const Check& c) { return c.sum().prices.unsplit > 0; });
  const bool unattributed =
      std::ranges::any_of(checks, [](const Check& c) { return c.sum().prices.unattributed > 0; });
  if (unsplit) t.columns.emplace_back("volumes or order");
  if (unattributed) t.columns.emplace_back("unattributed");
  for (const char* column : {"volume tests", "triangle tests", "for nothing"}) t.columns.emplace_back(column);
  for_each_kind(checks, [&](const std::string& engine, const std::string& kind, const CheckSums& sums) {
    const Prices& p = sums.prices;
    std::vector<std::string> row{engine, group_digits(sums.queries) + " " + kind, group_digits(p.visits)};
    for (const std::uint64_t part : {p.needed, p.proof, p.test, p.volumes, p.order})
      row.push_back(percent(part, p.visits));
    if (unsplit) row.push_back(percent(p.unsplit, p.visits));
    if (unattributed) row.push_back(percent(p.unattributed, p.visits));
    row.push_back(group_digits(p.volume_tests));
    row.push_back(group_digits(p.triangle_tests));
    row.push_back(percent(p.triangle_tests_for_nothing, p.triangle_tests));
    t.rows.push_back(std::move(row));
  });
  t.note =
      "Needed: triangles intersect beneath. Proof: the first pair of nodes beneath which none do. Test: "
      "visits beneath disjoint volumes that the engine's test did not separate. Volumes: "
      "visits beneath such pairs that no order of descent avoids with these volumes. Order: the rest.";
  return t;
}

report::Table verdict_table(std::span<const Check> checks) {
  report::Table t{"Verdicts",
                  {"engine", "queries", "right", "undecidable", "wrong", "unchecked", "pairs of triangles",
                   "found", "undecidable pairs", "missed", "false"}};
  for_each_kind(checks, [&](const std::string& engine, const std::string& kind, const CheckSums& s) {
    const auto queries = [&](Judgement o) { return group_digits(s.outcomes[static_cast<std::size_t>(o)]); };
    t.rows.push_back({engine, group_digits(s.queries) + " " + kind, queries(Judgement::right),
                      queries(Judgement::undecidable), queries(Judgement::wrong),
                      queries(Judgement::unchecked), group_digits(s.exact_pairs), group_digits(s.right),
                      group_digits(s.undecidable), group_digits(s.missed), group_digits(s.extra)});
  });
  t.note =
      "Compared with the exact query on the captured meshes. Undecidable: the triangles are closer to contact "
      "than the error of a test in floating point.";
  return t;
}

std::vector<std::string> add_checks(report::Document& page, std::span<const Check> checks,
                                    const Eigen::Vector3d& up) {
  std::vector<std::string> notes;
  const auto draw = [&](const char* kind, const Check& c, const auto& image, const std::string& title,
                        const std::string& caption) {
    try {
      page.picture(kind + std::to_string(&c - checks.data() + 1) + ".png", image(), title, caption);
    } catch (const EnvironmentError& e) {
      notes.push_back("not drawn: " + title + ": " + e.what());
    }
  };
  for (const Check& c : checks)
    if (c.first_wrong)
      draw(
          "wrong_", c, [&] { return draw_wrong(*c.first_wrong, up); }, "Wrong answer of " + c.engine,
          c.first_wrong->sentence);
  if (const report::Table t = wrong_table(checks); !t.rows.empty()) page.table(t);
  page.table(verdict_table(checks)).table(price_table(checks)).table(advice_table(checks));
  for (const Check& c : checks)
    if (!c.waste.empty())
      draw(
          "waste_", c, [&] { return draw_waste(c.waste, up); }, "Where visits are wasted, " + c.engine,
          "Wasted visits, by volumes or order, shared evenly by the triangles beneath both nodes.");
  for (const Check& c : checks) page.chart(chart_by_query(c));
  return notes;
}

}  // namespace lrb::profile
