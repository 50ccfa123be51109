#include "bench/tails/worst.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "bench/speed/data_set.hpp"
#include "bench/tails/tails.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::tails {
namespace {

constexpr double kNoCost = -1;

double cost_of(const EngineAnswer& answer, Goal goal) {
  if (!answer.failure.empty()) return kNoCost;
  if (goal == Goal::time) return answer.us;
  if (goal == Goal::wasted) return static_cast<double>(answer.wasted.value());
  const auto tests = static_cast<double>(answer.tests.value());
  return goal == Goal::tests ? tests : tests / (1 + static_cast<double>(answer.pairs));
}

const char* unit_of(Goal goal) {
  switch (goal) {
    case Goal::tests_per_answer:
      return "tests / (1 + pairs)";
    case Goal::tests:
      return "tests";
    case Goal::wasted:
      return "wasted visits and tests";
    case Goal::time:
      return "\u00b5s";
    case Goal::wrong:
      break;
  }
  return "";
}

/// Answers of an engine to the placements of a search.
class Asker {
 public:
  Asker(Engine& engine, const PoseSpace& space, Goal goal) : engine_(engine), space_(space), goal_(goal) {}

  std::vector<double> costs(std::span<const Placement> placements) {
    std::vector<Pose> poses;
    for (const Placement& at : placements) poses.push_back(space_.pose(at));
    const Engine::Progress silent = [](std::size_t) {};
    std::vector<EngineAnswer> answers =
        engine_.ask(poses, {.tests = true, .waste = goal_ == Goal::wasted}, silent);
    if (goal_ == Goal::time)
      for (int round = 0; round < kRounds; ++round) {
        const std::vector<EngineAnswer> again = engine_.ask(poses, {}, silent);
        for (std::size_t i = 0; i < poses.size(); ++i) {
          if (again[i].failure.empty() && (round == 0 || again[i].us < answers[i].us))
            answers[i].us = again[i].us;
        }
      }
    std::vector<double> out;
    for (EngineAnswer& answer : answers) {
      if (goal_ != Goal::time && answer.failure.empty() && !answer.tests)
        throw InputError(printable_name(engine_.name()) +
                         ": expected an engine that counts its tests, found none counted; use --goal time");
      out.push_back(cost_of(answer, goal_));
      answers_.push_back(std::move(answer));
    }
    return out;
  }

  /// In the order of the trials.
  const std::vector<EngineAnswer>& answers() const { return answers_; }

 private:
  Engine& engine_;
  const PoseSpace& space_;
  Goal goal_;
  std::vector<EngineAnswer> answers_;
};

std::string cost_text(double cost) {
  return cost >= 1000 ? io::fixed_text(cost, 0) : io::number_text(cost, 4);
}

std::string count_or_dash(const std::optional<std::uint64_t>& n) {
  return n ? std::to_string(*n) : "-";
}

}  // namespace

Worst find_worst(Engine& engine, const PoseSpace& space, Goal goal, const SearchOptions& options,
                 bool compare, const run::ProgressReport& progress) {
  Worst out;
  out.engine = engine.name();
  out.goal = goal;
  out.options = options;
  Asker asker(engine, space, goal);
  out.found = search(
      options, [&](std::span<const Placement> at) { return asker.costs(at); },
      [&](std::size_t done) { progress("search", done, options.budget); });
  for (const Trial& t : out.found.worst())
    if (t.cost >= 0) out.poses.push_back({t, asker.answers()[t.number - 1]});
  for (const Trial& t : out.found.trials)
    if (const std::string& why = asker.answers()[t.number - 1].failure; !why.empty())
      out.failures.push_back("query " + std::to_string(t.number) + ": " + why);
  if (compare) {
    Asker other(engine, space, goal);
    out.at_random = random_search(
        options, [&](std::span<const Placement> at) { return other.costs(at); },
        [&](std::size_t done) { progress("random", done, options.budget); });
  }
  return out;
}

std::string table_of(const Worst& worst) {
  const bool time = worst.goal == Goal::time;
  std::vector<std::vector<std::string>> rows = {
      {time ? "us" : "cost", "tests", "box tests", "face tests", "pairs", "query"}};
  for (const QueriedTrial& t : worst.poses) {
    const auto& kinds = t.answer.kinds;
    rows.push_back({cost_text(t.trial.cost), count_or_dash(t.answer.tests),
                    kinds ? std::to_string(kinds->boxes) : "-", kinds ? std::to_string(kinds->faces) : "-",
                    std::to_string(t.answer.pairs), std::to_string(t.trial.number)});
  }
  std::string out = report::in_columns(rows, 0);
  if (worst.at_random)
    out += "At random, " + std::to_string(worst.options.budget) + " queries find " +
           cost_text(worst.at_random->highest(worst.options.budget)) + ".\n";
  return out;
}

std::vector<nlohmann::ordered_json> json_of(const Worst& worst, const PoseSpace& space) {
  std::vector<nlohmann::ordered_json> out;
  for (const QueriedTrial& t : worst.poses) {
    nlohmann::ordered_json line = {
        {"engine", worst.engine}, {"goal", name_of(worst.goal)}, {"cost", t.trial.cost}};
    if (t.answer.tests) line["tests"] = *t.answer.tests;
    if (t.answer.kinds) {
      line["box_tests"] = t.answer.kinds->boxes;
      line["face_tests"] = t.answer.kinds->faces;
    }
    line["pairs"] = t.answer.pairs;
    line["query"] = t.trial.number;
    line["b"] = io::rows_of(space.pose(t.trial.at));
    out.push_back(std::move(line));
  }
  return out;
}

std::string purpose_of(const Worst& worst) {
  return "The poses of the highest cost (" + std::string(name_of(worst.goal)) + ") for " + worst.engine +
         ", found by lrbscope worst with " + std::to_string(worst.options.budget) + " queries, seed " +
         std::to_string(worst.options.seed) + ".";
}

std::string scenario_text(const std::string& purpose, std::span<const Pose> poses, const LrbRep& rep_a,
                          const LrbRep& rep_b, const std::string& a, const std::string& b) {
  using nlohmann::ordered_json;
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
    list.push_back(workers::pose_json(pose));
  }
  const ordered_json value = {{"name", "worst"},
                              {"purpose", purpose},
                              {"bodies", {{"a", {{"file", a}}}, {"b", {{"file", b}}}}},
                              {"motion", {{"kind", "poses"}, {"poses", list}}},
                              {"expect", expect}};
  return value.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

namespace {

/// Ranges of the distance between the centres, in units of offsets, with a map each.
constexpr std::array<double, 5> kDistances = {0, 0.25, 0.5, 0.75, std::numeric_limits<double>::infinity()};
constexpr std::size_t kMaps = kDistances.size() - 1, kColumns = 24, kRows = 12;

/// Returns the map, row and column of an offset. Rows are even in z and columns in longitude, so that all
/// cells cover equal areas of the sphere (Archimedes).
std::array<std::size_t, 3> cell_of(const Eigen::Vector3d& offset) {
  const double length = offset.norm();
  std::size_t map = 0;
  while (map + 1 < kMaps && length >= kDistances[map + 1]) ++map;
  if (!(length > 0)) return {map, 0, 0};
  constexpr double kPi = 3.14159265358979323846;
  const double z = offset.z() / length, longitude = std::atan2(offset.y(), offset.x());
  const auto at = [](double share, std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(n)));
  };
  return {map, at((1 - z) / 2, kRows), at((longitude + kPi) / (2 * kPi), kColumns)};
}

}  // namespace

std::string cost_map(const std::vector<Trial>& trials, const std::string& unit) {
  std::vector<double> highest(kMaps * kRows * kColumns, kNoCost);
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Trial& t : trials) {
    if (!(t.cost > 0)) continue;
    const auto [map, row, column] = cell_of(t.at.offset);
    double& cell = highest[(map * kRows + row) * kColumns + column];
    cell = std::max(cell, t.cost);
  }
  for (const double cost : highest)
    if (cost > 0) {
      least = std::min(least, cost);
      most = std::max(most, cost);
    }
  const auto colour = [&](double cost) {
    const double t = most > least ? std::log(cost / least) / std::log(most / least) : 1;
    const render::Rgba c = render::palette::viridis(t);
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", c.r, c.g, c.b);
    return std::string(text);
  };
  constexpr int kCell = 12, kGap = 28, kTop = 22;
  constexpr int kMapWidth = kCell * static_cast<int>(kColumns), kMapHeight = kCell * static_cast<int>(kRows);
  constexpr int kWidth = 2 * kMapWidth + kGap, kHeight = 2 * (kMapHeight + kTop) + 44;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + std::to_string(kWidth) +
                    " " + std::to_string(kHeight) +
                    "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#5a6b75\">\n";
  const auto rect = [&](int x, int y, const std::string& fill, const std::string& tip) {
    out += "<rect x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) +
           "\" width=\"12\" height=\"12\" fill=\"" + fill + "\">" +
           (tip.empty() ? "" : "<title>" + tip + "</title>") + "</rect>\n";
  };
  const auto text = [&](int x, int y, const std::string& words) {
    out += "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\">" + words + "</text>\n";
  };
  for (std::size_t map = 0; map < kMaps; ++map) {
    const int left = static_cast<int>(map % 2) * (kMapWidth + kGap);
    const int top = static_cast<int>(map / 2) * (kMapHeight + kTop) + kTop;
    const std::string from = io::number_text(kDistances[map]);
    text(left, top - 6,
         std::isinf(kDistances[map + 1])
             ? "centres more than " + from + " apart"
             : "centres " + from + " to " + io::number_text(kDistances[map + 1]) + " apart");
    for (std::size_t row = 0; row < kRows; ++row)
      for (std::size_t column = 0; column < kColumns; ++column) {
        const double cost = highest[(map * kRows + row) * kColumns + column];
        rect(left + kCell * static_cast<int>(column), top + kCell * static_cast<int>(row),
             cost > 0 ? colour(cost) : "#d5dce0", cost > 0 ? cost_text(cost) : "no query");
      }
  }
  // The scale, logarithmic.
  const int y = 2 * (kMapHeight + kTop) + 14;
  if (most > 0) {
    for (int i = 0; i < static_cast<int>(kColumns); ++i)
      rect(i * kCell, y, colour(least * std::pow(most / least, i / static_cast<double>(kColumns - 1))), "");
    text(0, y + 26, cost_text(least));
    text(kMapWidth - 36, y + 26, cost_text(most));
    text(kMapWidth + kGap, y + 10, unit);
  }
  return out + "</svg>\n";
}

namespace {

/// Returns the highest cost so far over the number of queries, at its increases.
report::Series progress_of(const std::string& label, const Search& search) {
  report::Series out{label, {}, {}, {report::Line::steps, "", "none"}};
  double highest = 0;
  for (const Trial& t : search.trials) {
    if (t.cost <= highest && t.number != search.trials.size()) continue;
    highest = std::max(highest, t.cost);
    out.x.push_back(static_cast<double>(t.number));
    out.y.push_back(highest);
  }
  return out;
}

}  // namespace

std::vector<std::string> write_worst_page(const Worst& worst, const WorstPage& page,
                                          const std::string& folder) {
  report::Document document(page.title, page.purpose);
  const std::string unit = unit_of(worst.goal);
  if (!worst.poses.empty()) document.number({"Worst pose", cost_text(worst.poses.front().trial.cost), unit});
  if (worst.at_random)
    document.number({"At random", cost_text(worst.at_random->highest(worst.options.budget)),
                     "the highest of " + std::to_string(worst.options.budget) + " queries"});
  if (!page.machine.empty()) document.number({"Machine", page.machine});
  report::Table table{"The worst poses",
                      {unit, "tests", "box tests", "face tests", "pairs", "query", "recorded by"}};
  for (std::size_t i = 0; i < worst.poses.size(); ++i) {
    const QueriedTrial& t = worst.poses[i];
    const auto& kinds = t.answer.kinds;
    table.rows.push_back({cost_text(t.trial.cost), count_or_dash(t.answer.tests),
                          kinds ? std::to_string(kinds->boxes) : "-",
                          kinds ? std::to_string(kinds->faces) : "-", std::to_string(t.answer.pairs),
                          std::to_string(t.trial.number), page.recorders[i]});
  }
  table.note = "Poses that differ by less than 0.01 radians and 1 % of the diagonal count as one.";
  for (const std::string& failure : worst.failures) table.note += " No answer: " + failure + ".";
  document.table(table);
  report::Chart chart{"Progress of the search", {"queries"}, {"highest " + unit, true}};
  chart.series.push_back(progress_of("search", worst.found));
  if (worst.at_random) chart.series.push_back(progress_of("at random", *worst.at_random));
  chart.note = "The first " + std::to_string(worst.found.random) + " queries of the search are random.";
  document.chart(chart);
  std::vector<Trial> trials = worst.found.trials;
  if (worst.at_random)
    trials.insert(trials.end(), worst.at_random->trials.begin(), worst.at_random->trials.end());
  document.picture(
      "map.svg", cost_map(trials, unit), "Cost over direction and distance",
      "Direction from the centre of A's box to that of B's: longitude to the right, z upward, in "
      "cells of equal area; distance in means of both boxes' diagonals. Colours: the highest cost in a cell; grey: "
      "no query.",
      true);
  if (!page.scenario.empty())
    document.file("worst.scenario.json", page.scenario,
                  "the poses with the exact answers, for regression tests");
  document.command(page.command);
  document.write(report::Folder(folder));
  return document.notes();
}

}  // namespace lrb::tails
