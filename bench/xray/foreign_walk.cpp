#include "bench/xray/foreign_walk.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "bench/rivals/triangles.hpp"
#include "bench/workers/child.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/recorder.hpp>

namespace lrb::xray {
namespace {

std::vector<std::uint32_t> parents_of(const trace::TreeShape& tree) {
  std::vector<std::uint32_t> out(tree.size(), kNull);
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    for (const std::uint32_t child : tree.children(n)) out[child] = n;
  return out;
}

/// Returns the leaf of each simplex.
std::vector<std::uint32_t> leaves_of(const trace::TreeShape& tree) {
  std::vector<std::uint32_t> out(tree.size() > 0 ? tree.beneath(0) : 0);
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    for (const SimplexId s : tree.simplices(n))
      if (s < out.size()) out[s] = n;
  return out;
}

/// A pair of bounding volumes with its predecessor.
struct Visit {
  std::size_t parent = kNone;  ///< index of a visit; kNone: the first pair
  std::optional<NodeStep> step;
  std::uint8_t children = 0;  ///< number of child pairs visited from it
  static constexpr std::size_t kNone = ~std::size_t{0};
};

/// Finds the predecessor of each pair: the pair of the parents, or of one parent and the other node.
class Descent {
 public:
  explicit Descent(const std::array<trace::TreeShape, 2>& trees)
      : trees_(trees),
        parents_{parents_of(trees[0]), parents_of(trees[1])},
        leaves_{leaves_of(trees[0]), leaves_of(trees[1])} {}

  /// Returns a visit for each event; visits of leaf tests are unused.
  std::vector<Visit> visits_of(const std::vector<ForeignEvent>& events) {
    std::vector<Visit> out(events.size());
    visited_.clear();
    for (std::size_t i = 0; i < events.size(); ++i) {
      const ForeignEvent& e = events[i];
      if (e.is_leaf_test) {  // without a test of the leaves' boxes, if the engine has none
        const std::uint32_t a = leaves_[0][e.a], b = leaves_[1][e.b];
        if (!visited_.count(key(a, b))) lead(a, b, i, out);
        continue;
      }
      visited_[key(e.a, e.b)] = i;
      if (trees_[0].is_leaf(e.a) && trees_[1].is_leaf(e.b)) out[i].step = NodeStep::leaves;
      lead(e.a, e.b, i, out);
    }
    return out;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

  /// Links visit i, of nodes a and b, to its predecessor.
  void lead(std::uint32_t a, std::uint32_t b, std::size_t i, std::vector<Visit>& out) const {
    const std::uint32_t up_a = parents_[0][a], up_b = parents_[1][b];
    const struct {
      std::uint32_t a, b;
      NodeStep step;
    } above[] = {
        {up_a, b, NodeStep::descend_a}, {a, up_b, NodeStep::descend_b}, {up_a, up_b, NodeStep::descend_both}};
    for (const auto& pair : above) {
      if (pair.a == kNull || pair.b == kNull) continue;
      const auto found = visited_.find(key(pair.a, pair.b));
      if (found == visited_.end() || (out[found->second].step && *out[found->second].step != pair.step))
        continue;
      out[i].parent = found->second;
      out[found->second].step = pair.step;
      ++out[found->second].children;
      return;
    }
  }

  const std::array<trace::TreeShape, 2>& trees_;
  std::array<std::vector<std::uint32_t>, 2> parents_;
  std::array<std::vector<std::uint32_t>, 2> leaves_;  ///< of simplices
  std::unordered_map<std::uint64_t, std::size_t> visited_;
};

std::vector<SimplexPair> pairs_of(const ForeignStep& step) {
  std::vector<SimplexPair> out;
  for (const ForeignEvent& e : step.events)
    if (e.is_leaf_test && e.meet) out.push_back({SimplexId(e.a), SimplexId(e.b)});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Reports the engine's events to the recorder, and returns its answer.
CollideResult replay(const ForeignStep& step, Descent& descent, trace::Recorder& recorder) {
  const std::vector<Visit> visits = descent.visits_of(step.events);
  std::vector<std::uint32_t> reported(visits.size(), kNull);
  CollideResult result;
  recorder.begin(Phase::walk, 0, 0);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const ForeignEvent& e = step.events[i];
    const exact::Meet meet = e.meet ? exact::Meet::cross : exact::Meet::disjoint;
    if (e.is_leaf_test) {
      recorder.face_test(SimplexId(e.a), SimplexId(e.b), meet, 0, 0);
      if (e.meet) recorder.contact(SimplexId(e.a), SimplexId(e.b), meet);
      continue;
    }
    const Visit& v = visits[i];
    const bool leaves = v.step == NodeStep::leaves;
    const auto met = static_cast<std::uint8_t>(leaves ? e.meet : v.children);
    reported[i] = recorder.node_pair({.a = e.a,
                                      .b = e.b,
                                      .parent = v.parent == Visit::kNone ? kNull.kValue : reported[v.parent],
                                      .step = v.step.value_or(NodeStep::descend_both),
                                      .box_tests = 1,
                                      .met = met});
  }
  recorder.end(Phase::walk, step.box_tests);
  result.pairs = pairs_of(step);
  result.relation = result.pairs.empty() ? Relation::separate : Relation::crossing;
  result.counters.node_pairs = result.counters.box_tests = step.box_tests;
  result.counters.face_tests = result.counters.real_tests = step.leaf_tests;
  return result;
}

}  // namespace

run::Recording recording_of(const ForeignWalk& walk, const run::Recording& ours,
                            const spec::Scenario& scenario) {
  run::Recording out;
  out.bodies = ours.bodies;
  out.results = ours.results;
  out.trees = {walk.trees[0], walk.trees[1]};
  trace::RecorderSettings settings;
  settings.scenario = scenario.name;
  settings.scenario_hash = scenario.hash;
  settings.sources = {ours.trace.header.bodies[0].source, ours.trace.header.bodies[1].source};
  settings.event_cap = scenario.event_cap;
  settings.level = EventLevel::nodes;
  settings.engine = walk.title;
  trace::Recorder recorder(ours.bodies[0].rep, ours.bodies[1].rep, settings);
  Descent descent(walk.trees);
  for (std::size_t i = 0; i < walk.steps.size(); ++i) {
    const trace::Step& step = ours.trace.steps[i];
    recorder.begin_step(step.index, step.pose_a, step.pose_b);
    recorder.end_step(replay(walk.steps[i], descent, recorder));
    const WrongPairs wrong = wrong_pairs(walk.steps[i], ours.results[i].pairs);
    std::vector<run::WrongPair>& here = out.wrong.emplace_back();
    for (const SimplexPair& pair : wrong.too_many) here.push_back({pair, false});
    for (const SimplexPair& pair : wrong.missing) here.push_back({pair, true});
  }
  out.trace = recorder.take();
  if (out.trace.truncated())
    out.notes.push_back(walk.title + ": the trace contains only the first " +
                        std::to_string(out.trace.events.size()) + " of " +
                        std::to_string(out.trace.events_seen) + " events");
  return out;
}

WrongPairs wrong_pairs(const ForeignStep& step, const std::vector<SimplexPair>& exact) {
  const std::vector<SimplexPair> found = pairs_of(step);
  WrongPairs out;
  std::set_difference(found.begin(), found.end(), exact.begin(), exact.end(),
                      std::back_inserter(out.too_many));
  std::set_difference(exact.begin(), exact.end(), found.begin(), found.end(),
                      std::back_inserter(out.missing));
  return out;
}

namespace {

void append(std::string& text, double x) {
  constexpr int kAllDigits = 17;
  text += io::number_text(x, kAllDigits);
  text += ' ';
}

void append(std::string& text, const LrbRep& rep) {
  const methods::Triangles t = methods::triangles_of(rep);
  text += std::to_string(t.vertices.size()) + " " + std::to_string(t.triangles.size()) + "\n";
  for (const Eigen::Vector3d& v : t.vertices)
    for (int i = 0; i < 3; ++i) append(text, v[i]);
  for (const auto& corners : t.triangles)
    for (const VertexId v : corners) text += std::to_string(v) + " ";
}

void append(std::string& text, const Pose& pose) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) append(text, column < 3 ? pose.r(row, column) : pose.t[row]);
}

/// Parses the words of a line one by one.
class Words {
 public:
  Words(std::string_view line, const std::string& engine) : rest_(line), engine_(engine) {}

  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(' ');
    if (begin == std::string_view::npos) fail();
    const std::size_t end = std::min(rest_.find(' ', begin), rest_.size());
    const std::string_view out = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return out;
  }
  template <class Number>
  Number number() {
    const std::string_view text = word();
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail();
    return value;
  }
  bool is_at_end() const { return rest_.find_first_not_of(' ') == std::string_view::npos; }
  std::string_view rest() const { return rest_; }
  [[noreturn]] void fail() const {
    throw EnvironmentError("lrbscope-xray-" + engine_ + " printed an unknown line; rebuild it");
  }

 private:
  std::string_view rest_;
  const std::string& engine_;
};

/// Parses the output of a program.
class Reader {
 public:
  Reader(const std::vector<std::string>& lines, const std::string& engine) : lines_(lines), engine_(engine) {}

  ForeignWalk run(std::span<const LrbRep* const> reps, std::size_t poses) {
    ForeignWalk out;
    Words title = next("title");
    out.title = title.rest().substr(1);
    for (std::size_t side = 0; side < 2; ++side) out.trees[side] = tree(*reps[side]);
    while (out.steps.size() < poses) out.steps.push_back(step(out.trees, reps));
    return out;
  }

 private:
  /// Returns the words of the next line after its first one, which must be `first`.
  Words next(std::string_view first) {
    Words words = next();
    if (words.word() != first) words.fail();
    return words;
  }
  Words next() {
    if (at_ == lines_.size()) Words("", engine_).fail();
    return {lines_[at_++], engine_};
  }

  trace::TreeShape tree(const LrbRep& rep) {
    const auto count = next("tree").number<std::uint32_t>();
    trace::TreeShape out;
    for (std::uint32_t i = 0; i < count; ++i) {
      Words words = next();
      std::vector<std::uint32_t> children;
      std::vector<SimplexId> simplices;
      const std::string_view kind = words.word();
      const auto number = words.number<std::uint32_t>();  // of children or simplices
      for (std::uint32_t k = 0; k < number; ++k) {
        const auto n = words.number<std::uint32_t>();
        if (kind == "node" ? n >= count : n >= rep.real_simplex_count()) words.fail();
        if (kind == "node")
          children.push_back(n);
        else
          simplices.emplace_back(n);
      }
      trace::ShapeBox box;
      for (int k = 0; k < 3; ++k) box.centre[k] = words.number<double>();
      for (Eigen::Vector3d& half : box.half)
        for (int k = 0; k < 3; ++k) half[k] = words.number<double>();
      out.add(children, simplices, box);
    }
    out.finish();
    if (out.size() == 0 || out.beneath(0) != rep.real_simplex_count()) next().fail();
    return out;
  }

  ForeignStep step(const std::array<trace::TreeShape, 2>& trees, std::span<const LrbRep* const> reps) {
    next("pose");
    ForeignStep out;
    for (;;) {
      Words words = next();
      const std::string_view kind = words.word();
      if (kind == "end") {
        out.box_tests = words.number<std::uint64_t>();
        out.leaf_tests = words.number<std::uint64_t>();
        return out;
      }
      ForeignEvent e{kind == "t", 0, 0, false};
      e.a = words.number<std::uint32_t>();
      e.b = words.number<std::uint32_t>();
      e.meet = words.number<int>() != 0;
      const bool known = e.is_leaf_test
                             ? e.a < reps[0]->real_simplex_count() && e.b < reps[1]->real_simplex_count()
                             : kind == "b" && e.a < trees[0].size() && e.b < trees[1].size();
      if (!known) words.fail();
      out.events.push_back(e);
    }
  }

  const std::vector<std::string>& lines_;
  const std::string& engine_;
  std::size_t at_ = 0;
};

}  // namespace

ForeignWalk walk_of(const std::string& engine, const LrbRep& a, const LrbRep& b,
                    std::span<const PosePair> poses) {
  constexpr std::chrono::seconds kLimit(600);
  const std::string program = workers::program_beside("lrbscope-xray-" + engine);
  if (program.empty())
    throw EnvironmentError("--method " + engine + ": cannot find the program lrbscope-xray-" + engine +
                           " next to lrbscope; install lib" + engine +
                           "-dev and build it: cmake --build --preset release --target lrbscope-workers");
  for (const LrbRep* rep : {&a, &b})
    if (rep->real_simplex_count() < 2)
      throw InputError(printable_name(rep->name()) +
                       ": expected a body of at least two triangles, found one");
  std::string text;
  append(text, a);
  append(text, b);
  text += std::to_string(poses.size()) + "\n";
  for (const PosePair& p : poses)
    for (const Pose* pose : {&p.a, &p.b}) {
      methods::check_rigid(*pose);
      append(text, *pose);
    }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  if (!file || std::fputs(text.c_str(), file.get()) < 0 || std::fflush(file.get()) != 0)
    throw EnvironmentError("cannot write a temporary file; check the free disk space");
  std::rewind(file.get());
  const std::vector<std::string> lines = workers::lines_of({program}, kLimit, fileno(file.get()));
  if (lines.empty())
    throw EnvironmentError("--method " + engine + ": " + program + " failed, or took longer than " +
                           std::to_string(kLimit.count()) + " s");
  const LrbRep* const reps[] = {&a, &b};
  return Reader(lines, engine).run(reps, poses.size());
}

namespace {

using render::group_digits;

constexpr const char* kHeatFile = "heat.png";

report::Table wrong_table(const Xray& x, std::uint64_t& wrong) {
  constexpr std::size_t kMaxRows = 30;
  report::Table t{"Wrong pairs of " + x.walk.title,
                  {"step", "triangle of A", "triangle of B", "error", "explanation"}};
  wrong = 0;
  for (std::size_t i = 0; i < x.walk.steps.size(); ++i) {
    const WrongPairs w = wrong_pairs(x.walk.steps[i], x.ours.results[i].pairs);
    wrong += w.too_many.size() + w.missing.size();
    for (const auto& [list, words] :
         {std::pair{&w.too_many, "reported, but disjoint"}, {&w.missing, "intersecting, but not reported"}})
      for (const SimplexPair& p : *list)
        if (t.rows.size() < kMaxRows)
          t.rows.push_back({std::to_string(x.ours.trace.steps[i].index), std::to_string(p.a),
                            std::to_string(p.b), words,
                            x.why + " --pose " + std::to_string(i) + " --pair " + std::to_string(p.a) + "," +
                                std::to_string(p.b)});
  }
  t.note = "Compared with exact results. " + group_digits(wrong);
  t.note += wrong == 1 ? " pair is wrong." : " pairs are wrong.";
  if (x.method == "cgal")
    t.note +=
        " CGAL is called as in its manual, with A's triangles transformed to B's frame: its predicates are exact, but their "
        "corners were rounded by the transformation.";
  return t;
}

}  // namespace

std::vector<std::string> write_xray(const Xray& x, const std::string& folder,
                                    const run::ProgressReport& progress) {
  const compare::Runs runs{{&x.theirs, &x.ours}, {x.walk.title, "lrbscope"}, {&x.scenario, &x.scenario}};
  const std::size_t step = compare::busiest_step(runs);
  std::vector<std::string> notes;
  compare::reject_folder_of_run(folder);
  const report::Folder locked(folder);
  for (const auto& [recording, name] : {std::pair{&x.theirs, x.method}, {&x.ours, std::string("ours")}}) {
    spec::Scenario scenario = x.scenario;
    scenario.purpose = recording == &x.theirs
                           ? "Recorded in " + x.walk.title +
                                 ". It has no wrappers, so none is refined; contact curves are exact."
                           : "Recorded in lrbscope.";
    const run::RunOutcome outcome = run::write_run(
        scenario, *recording, (std::filesystem::path(folder) / name).string(), x.command, progress);
    notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  }
  report::Document doc(x.scenario.name, "The traversal of " + x.walk.title + " for two bodies at " +
                                            render::counted(x.walk.steps.size(), "pose", "poses") +
                                            ", beside that of lrbscope.");
  if (const std::string cut = compare::cut_words(runs); !cut.empty()) doc.purpose(cut);
  doc.command(x.command).version(x.ours.trace.header.lrbscope);
  std::uint64_t wrong = 0;
  const report::Table wrong_pairs = wrong_table(x, wrong);
  const auto number = [&](const char* label, const auto& count) {
    doc.number({label, group_digits(count(x.theirs)), "lrbscope: " + group_digits(count(x.ours))});
  };
  number("Box tests", [](const run::Recording& r) { return compare::sum_of(r, &Counters::box_tests); });
  number("Triangle pairs tested",
         [](const run::Recording& r) { return compare::sum_of(r, &Counters::face_tests); });
  number("Pairs found", compare::pairs_of);
  doc.number({"Wrong pairs", group_digits(wrong), "compared with exact answers"});
  doc.views({{x.walk.title, x.method + "/index.html"}, {"lrbscope", "ours/index.html"}});
  compare::add_work_charts(doc, runs);
  if (!wrong_pairs.rows.empty()) doc.table(wrong_pairs);
  report::Table totals = compare::totals_of(runs);
  totals.note =
      "A pair of nodes of " + x.walk.title +
      " is one test of two bounding volumes; of lrbscope's it is two nodes with up to eight boxes each, compared eight at a "
      "time. Faces that planes separate, eight at a time, are not among lrbscope's face tests.";
  doc.table(totals).picture(
      kHeatFile, compare::draw(runs, step, progress),
      "Box tests by face, step " + std::to_string(x.ours.trace.steps[step].index),
      "The tests of each node, shared evenly by the faces below it; both engines on one scale, and their difference. Pale: less "
      "than a fiftieth of the maximum.");
  doc.link({x.method + "/index.html", "the run of " + x.walk.title + ", with its trace"});
  doc.link({"ours/index.html", "the run of lrbscope, with its trace"}).write(locked);
  return notes;
}

}  // namespace lrb::xray
