#include "bench/engines/costs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/speed/metrics.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/verdicts.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::engines {
namespace {

using methods::Answer;
using nlohmann::ordered_json;
using workers::line_of;

constexpr std::size_t kMaxShown = 8;
const Engine::Progress kSilent = [](std::size_t) {};

/// Adds the tests of an answer, as far as they are known.
void add_tests(ordered_json& line, const Answer& answer) {
  if (answer.tests) line["tests"] = *answer.tests;
  if (!answer.kinds) return;
  line["box_tests"] = answer.kinds->boxes;
  line["face_tests"] = answer.kinds->faces;
}

/// Queries the poses in several rounds, and returns the least times.
std::vector<double> least_times(Engine& engine, std::span<const Pose> poses,
                                const Engine::Progress& progress) {
  std::vector<double> least(poses.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = static_cast<std::size_t>(round) * poses.size();
    const std::vector<Answer> answers =
        engine.ask(poses, {}, [&](std::size_t done) { progress(before + done); });
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (answers[i].answered()) least[i] = std::min(least[i], answers[i].microseconds);
  }
  return least;
}

std::string bytes_of(const capture::Query& q) {
  std::string out;
  const auto add = [&](const auto& x) { out.append(reinterpret_cast<const char*>(&x), sizeof x); };
  for (const std::uint32_t tree : q.trees) add(tree);
  for (const Pose& pose : q.poses)
    for (const double x : io::rows_of(pose)) add(x);
  return out;
}

}  // namespace

// Percentiles.

Samples measure(Engine& engine, std::span<const Pose> poses, const record::ProgressReport& progress) {
  Samples out;
  out.engine = engine.name();
  out.poses.assign(poses.begin(), poses.end());
  out.rounds = kRounds;
  const std::size_t total = (kRounds + 1) * poses.size();
  out.answers =
      engine.ask(poses, {.tests = true}, [&](std::size_t done) { progress(out.engine, done, total); });
  const std::vector<double> least =
      least_times(engine, poses, [&](std::size_t done) { progress(out.engine, poses.size() + done, total); });
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (out.answers[i].answered() && !std::isfinite(least[i]))
      workers::note_failure(out.answers[i], {false, "answered once, but not again"});
    out.answers[i].microseconds = least[i];
  }
  return out;
}

Samples samples_of(const capture::Capture& capture, const std::string& file) {
  Samples out;
  out.engine = capture.engine;
  std::map<std::string, std::size_t> known;
  std::vector<int> rounds;
  for (const capture::Query& q : capture.queries) {
    if (!q.ended) continue;
    out.with_events = out.with_events || !q.events.empty();
    const auto [it, is_new] = known.emplace(bytes_of(q), out.answers.size());
    Answer answer = answer_of(q, capture.names, false);
    if (is_new) {
      rounds.push_back(1);
      out.poses.push_back(methods::relative(q.poses[0], q.poses[1]));
      out.answers.push_back(std::move(answer));
      continue;
    }
    ++rounds[it->second];
    Answer& kept = out.answers[it->second];
    const double least = std::min(kept.microseconds, answer.microseconds);
    if (!kept.tests) kept = std::move(answer);  // the repeat of a query without events may have them
    kept.microseconds = least;
  }
  if (out.answers.empty())
    throw InputError(printable_name(file) + ": expected queries that ended, found none");
  out.rounds = *std::min_element(rounds.begin(), rounds.end());
  return out;
}

std::vector<Percentiles> percentiles(const Samples& samples) {
  using Value = std::optional<double>;
  std::vector<Percentiles> out;
  // A quantity that an answered pose does not have has no percentiles.
  const auto add = [&](const std::string& what, const auto& value) {
    std::vector<double> all;
    for (const Answer& a : samples.answers) {
      if (!a.answered()) continue;
      const Value x = value(a);
      if (!x) return;
      all.push_back(*x);
    }
    if (all.empty()) return;
    out.push_back({what, all.size(), speed::quantile(all, 0.5), speed::quantile(all, 0.9),
                   speed::quantile(all, 0.99), speed::quantile(all, 1)});
  };
  const auto number = [](std::uint64_t n) { return Value(static_cast<double>(n)); };
  add("us", [](const Answer& a) { return Value(a.microseconds); });
  add("tests", [&](const Answer& a) { return a.tests ? number(*a.tests) : Value(); });
  add("box_tests", [&](const Answer& a) { return a.kinds ? number(a.kinds->boxes) : Value(); });
  add("face_tests", [&](const Answer& a) { return a.kinds ? number(a.kinds->faces) : Value(); });
  std::set<std::string> phases;
  for (const Answer& a : samples.answers)
    for (const auto& [name, tests] : a.phases) phases.insert(name);
  for (const std::string& phase : phases)
    add("tests in phase " + phase, [&](const Answer& a) {
      const auto it = a.phases.find(phase);
      return number(it == a.phases.end() ? 0 : it->second);
    });
  return out;
}

Rows rows_of(const std::vector<Samples>& engines) {
  Rows out;
  std::vector<std::vector<std::string>> rows = {{"engine", "", "p50", "p90", "p99", "max", "poses"}};
  for (const Samples& samples : engines) {
    const auto failed = std::count_if(samples.answers.begin(), samples.answers.end(),
                                      [](const Answer& a) { return !a.answered(); });
    for (const Percentiles& p : percentiles(samples)) {
      rows.push_back({samples.engine, p.what.ends_with("_tests") ? io::in_words(p.what) : p.what});
      for (const double x : {p.p50, p.p90, p.p99, p.max})
        rows.back().push_back(p.what == "us" ? io::number_text(x, 4) : io::fixed_text(x, 0));
      rows.back().push_back(std::to_string(p.count));
      out.lines.push_back(line_of({{"engine", samples.engine},
                                   {"what", p.what},
                                   {"poses", p.count},
                                   {"p50", p.p50},
                                   {"p90", p.p90},
                                   {"p99", p.p99},
                                   {"max", p.max},
                                   {"failed", failed}}));
    }
  }
  out.table = report::in_columns(rows, 2);
  return out;
}

std::vector<std::string> notes_of(const std::vector<Samples>& engines) {
  std::vector<std::string> out;
  for (const Samples& samples : engines) {
    const auto& all = samples.answers;
    const auto has_failed = [](const Answer& a) { return !a.answered(); };
    const std::string name = printable_name(samples.engine);
    if (const auto first = std::find_if(all.begin(), all.end(), has_failed); first != all.end())
      out.push_back(name + ": no answer at " + std::to_string(std::count_if(first, all.end(), has_failed)) +
                    " of " + std::to_string(all.size()) + " poses; pose " +
                    std::to_string(first - all.begin()) + ": " + first->message);
    if (samples.with_events)
      out.push_back(name +
                    ": events were recorded, which adds to the times; for times, record with "
                    "LRBCAP_EVENTS=0");
  }
  return out;
}

// The highest cost.

namespace {

constexpr double kNoCost = -1;

double cost_of(const Answer& answer, Goal goal) {
  if (!answer.answered()) return kNoCost;
  if (goal == Goal::time) return answer.microseconds;
  if (goal == Goal::wasted) return static_cast<double>(answer.wasted.value());
  const auto tests = static_cast<double>(answer.tests.value());
  return goal == Goal::tests ? tests : tests / (1 + static_cast<double>(answer.count));
}

}  // namespace

Found find_costly(Engine& engine, const PoseSpace& space, Goal goal, const SearchOptions& options,
                  const record::ProgressReport& progress) {
  std::vector<Answer> all;  // in the order of the trials
  const auto costs = [&](std::span<const Placement> placements) {
    std::vector<Pose> poses;
    for (const Placement& at : placements) poses.push_back(space.pose(at));
    std::vector<Answer> answers = engine.ask(poses, {.tests = true, .waste = goal == Goal::wasted}, kSilent);
    if (goal == Goal::time) {
      const std::vector<double> least = least_times(engine, poses, kSilent);
      for (std::size_t i = 0; i < poses.size(); ++i)
        if (std::isfinite(least[i])) answers[i].microseconds = least[i];
    }
    std::vector<double> out;
    for (Answer& answer : answers) {
      const bool counted = goal == Goal::wasted ? answer.wasted.has_value() : answer.tests.has_value();
      if (goal != Goal::time && answer.answered() && !counted)
        throw InputError(
            printable_name(engine.name()) + ": expected an engine that " +
            (goal == Goal::wasted ? "records its traversal (command:PROGRAM)" : "counts its tests") +
            ", found none counted; use --goal time");
      out.push_back(cost_of(answer, goal));
      all.push_back(std::move(answer));
    }
    return out;
  };
  const Search search =
      engines::search(options, costs, [&](std::size_t done) { progress("search", done, options.budget); });
  Found out;
  std::vector<std::vector<std::string>> rows = {
      {goal == Goal::time ? "us" : "cost", "tests", "box tests", "face tests", "pairs", "query"}};
  for (const Trial& t : search.worst(kMaxShown)) {
    if (t.cost < 0) continue;
    const Answer& answer = all[t.number - 1];
    const Pose pose = space.pose(t.at);
    out.poses.push_back(pose);
    ordered_json line = {{"engine", engine.name()}, {"goal", name_of(goal)}, {"cost", t.cost}};
    add_tests(line, answer);
    line["pairs"] = answer.count;
    line["query"] = t.number;
    line["b"] = io::rows_of(pose);
    rows.push_back({t.cost >= 1000 ? io::fixed_text(t.cost, 0) : io::number_text(t.cost, 4)});
    for (const char* key : {"tests", "box_tests", "face_tests", "pairs", "query"})
      rows.back().push_back(line.contains(key) ? line[key].dump() : "-");
    out.rows.lines.push_back(line_of(line));
  }
  out.rows.table = report::in_columns(rows, 0);
  for (const Trial& t : search.trials)
    if (const Answer& answer = all[t.number - 1]; !answer.answered())
      out.failures.push_back("query " + std::to_string(t.number) + ": " + answer.message);
  return out;
}

std::string scenario_text(const std::string& purpose, std::span<const Pose> poses, const LrbRep& rep_a,
                          const LrbRep& rep_b, const std::string& a, const std::string& b) {
  ordered_json list = ordered_json::array(), expect = ordered_json::array();
  Workspace workspace;
  for (const Pose& pose : poses) {
    const CollideResult exact =
        std::move(collide(rep_a, Pose{}, rep_b, pose, CollideRequest{}, workspace).value());
    expect.push_back({{"step", list.size()},
                      {"relation", name_of(exact.relation)},
                      {"pairs", exact.pairs.size()},
                      {"fingerprint", trace::to_hex(fingerprint(exact.pairs))},
                      {"max_tests", exact.counters.box_tests + exact.counters.face_tests}});
    list.push_back(io::rows_of(pose));
  }
  const ordered_json value = {{"name", "worst"},
                              {"purpose", purpose},
                              {"bodies", {{"a", {{"file", a}}}, {"b", {{"file", b}}}}},
                              {"motion", {{"kind", "poses"}, {"poses", list}}},
                              {"expect", expect}};
  return value.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

// Wrong answers.

namespace {

/// An answer beside the exact one.
struct Judged {
  HardPose at;
  Answer answer;
  std::uint64_t exact_pairs = 0, missed = 0, extra = 0;
  double error = 0;  ///< the gap of a false pair, or the depth of a missed one; the largest

  bool wrong_contact() const { return answer.answered() && (answer.count > 0) != (exact_pairs > 0); }
};

void judge(Judged& judged, const LrbRep& a, const LrbRep& b, const std::vector<SimplexPair>& exact,
           double unit) {
  const std::vector<SimplexPair> missed = methods::without(exact, judged.answer.pairs),
                                 extra = methods::without(judged.answer.pairs, exact);
  judged.missed = missed.size();
  judged.extra = extra.size();
  const auto corners = [&](const SimplexPair& p) {
    return std::pair(methods::corners_of(a, Pose{}, p.a), methods::corners_of(b, judged.at.pose, p.b));
  };
  for (const SimplexPair& p : missed) {
    const auto [f, g] = corners(p);
    judged.error = std::max(judged.error, profile::overlap_depth(f, g) / unit);
  }
  for (const SimplexPair& p : extra) {
    const auto [f, g] = corners(p);
    judged.error = std::max(judged.error, profile::gap_of(f, g) / unit);
  }
}

std::vector<std::vector<std::string>> rows_by_kind(const std::vector<Judged>& all) {
  std::vector<std::vector<std::string>> out = {
      {"poses", "number", "no answer", "wrong contact", "missed pairs", "false pairs", "largest error"}};
  for (const EnumName<Hard>& kind : kEnumNames<Hard>) {
    std::uint64_t number = 0, failed = 0, contacts = 0, missed = 0, extra = 0;
    double error = 0;
    for (const Judged& j : all) {
      if (j.at.kind != kind.value) continue;
      ++number;
      failed += j.answer.answered() ? 0 : 1;
      contacts += j.wrong_contact() ? 1 : 0;
      missed += j.missed;
      extra += j.extra;
      error = std::max(error, j.error);
    }
    out.push_back({io::in_words(kind.name), std::to_string(number), std::to_string(failed),
                   std::to_string(contacts), std::to_string(missed), std::to_string(extra),
                   io::number_text(error, 3)});
  }
  return out;
}

}  // namespace

Found find_wrong(Engine& engine, const LrbRep& a, const LrbRep& b, const PoseSpace& space,
                 const SearchOptions& options, const record::ProgressReport& progress) {
  const std::vector<HardPose> hard = hard_poses(a, b, space, options.budget, options.seed);
  std::vector<Pose> poses;
  for (const HardPose& h : hard) poses.push_back(h.pose);
  std::vector<Answer> answers = engine.ask(
      poses, {.list = true}, [&](std::size_t done) { progress(engine.name(), done, poses.size()); });
  std::vector<Judged> all(hard.size());
  Found out;
  Workspace workspace;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    Judged& judged = all[i];
    judged.at = hard[i];
    judged.answer = std::move(answers[i]);
    progress("exact answers", i + 1, hard.size());
    const std::vector<SimplexPair> exact =
        std::move(collide(a, Pose{}, b, poses[i], CollideRequest{}, workspace).value().pairs);
    judged.exact_pairs = exact.size();
    if (!judged.answer.answered()) {
      out.failures.push_back("query " + std::to_string(i + 1) + ": " + judged.answer.message);
      continue;
    }
    for (const SimplexPair& p : judged.answer.pairs)
      if (p.a >= a.real_simplex_count() || p.b >= b.real_simplex_count())
        throw InputError(printable_name(engine.name()) +
                         ": expected pairs of faces of the two bodies, found one of others; does it read the "
                         "same triangles in the same order?");
    judge(judged, a, b, exact, space.unit());
  }
  out.rows.table = report::in_columns(rows_by_kind(all));
  std::erase_if(all, [](const Judged& j) { return j.missed + j.extra == 0 && !j.wrong_contact(); });
  std::stable_sort(all.begin(), all.end(), [](const Judged& p, const Judged& q) {
    return p.wrong_contact() != q.wrong_contact() ? p.wrong_contact() : p.error > q.error;
  });
  if (all.size() > kMaxShown) all.resize(kMaxShown);
  for (const Judged& j : all) {
    out.poses.push_back(j.at.pose);
    out.rows.lines.push_back(line_of({{"engine", engine.name()},
                                      {"goal", "wrong"},
                                      {"poses", name_of(j.at.kind)},
                                      {"ulps", j.at.ulps},
                                      {"pairs", j.answer.count},
                                      {"exact_pairs", j.exact_pairs},
                                      {"missed", j.missed},
                                      {"false", j.extra},
                                      {"error", j.error},
                                      {"b", io::rows_of(j.at.pose)}}));
  }
  return out;
}

}  // namespace lrb::engines
