#include "bench/tails/worst.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "bench/speed/data_set.hpp"
#include "bench/tails/tails.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::tails {

// Cost.

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

// Wrong answers.

namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUlp = 0x1p-52;

Corners corners_of(const LrbRep& rep, SimplexId s) {
  VertexId v[3] = {};
  rep.simplex(s, v);
  return {rep.vertices()[v[0]], rep.vertices()[v[1]], rep.vertices()[v[2]]};
}

Corners posed(const Corners& c, const Pose& pose) {
  return {pose.apply(c[0]), pose.apply(c[1]), pose.apply(c[2])};
}

class Maker {
 public:
  Maker(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::uint64_t seed)
      : a_(a), b_(b), space_(space), random_(seed) {}

  /// Returns a pose, and the direction in which it is moved by ulps.
  std::pair<Pose, Vector3d> make(Hard kind) {
    switch (kind) {
      case Hard::first_contact:
        return first_contact_pose();
      case Hard::coplanar_faces:
        return coplanar();
      case Hard::parallel_edges:
        return parallel();
      default:
        return vertex_on_vertex();
    }
  }

 private:
  bool meet(const Pose& pose) {
    CollideRequest request;
    request.mode = Mode::any_pair;
    return !collide(a_, Pose{}, b_, pose, request, workspace_).value().pairs.empty();
  }

  std::pair<Pose, Vector3d> first_contact_pose() {
    while (true) {
      Placement at = random_placement(random_);
      const Vector3d direction = at.offset.normalized();
      // From outside to the centre. The search ends at an interval that contains the first contact. Halving
      // it leads to two neighbouring doubles, with contact at the second.
      at.offset = 1.5 * direction;
      const Pose start = space_.pose(at);
      at.offset = Vector3d::Zero();
      const Pose end = space_.pose(at);
      const Motion motion = Motion::linear(start, end.t);
      FirstContactRequest request;
      request.relation = false;
      const FirstContactResult found = lrb::first_contact(a_, Motion::still(Pose{}), b_, motion, request);
      if (!found.is_contact() || found.at_start || found.passed) continue;
      double apart = found.t0, together = found.t1;
      for (double midpoint; (midpoint = apart + (together - apart) / 2) > apart && midpoint < together;)
        (meet(motion.at(midpoint)) ? together : apart) = midpoint;
      return {motion.at(together), direction};
    }
  }

  Corners random_face(const LrbRep& rep) {
    return corners_of(rep, SimplexId(random_.below(rep.real_simplex_count())));
  }

  /// Returns a rotation that maps a direction to another, followed by a random one about that.
  Matrix3d rotation_to(const Vector3d& from, const Vector3d& to) {
    const Matrix3d aligned = deterministic::turn_between(from, to).toRotationMatrix();
    return deterministic::rotation(to.normalized(), random_.in(0, 6.283185307179586)) * aligned;
  }

  std::pair<Pose, Vector3d> coplanar() {
    while (true) {
      const Corners f = random_face(a_), g = random_face(b_);
      const Vector3d n = (f[1] - f[0]).cross(f[2] - f[0]), m = (g[1] - g[0]).cross(g[2] - g[0]);
      if (!(n.norm() > 0) || !(m.norm() > 0)) continue;
      const Matrix3d r = rotation_to(m, -n);
      return {{r, (f[0] + f[1] + f[2]) / 3 - r * ((g[0] + g[1] + g[2]) / 3)}, n.normalized()};
    }
  }

  std::pair<Pose, Vector3d> parallel() {
    while (true) {
      const Corners f = random_face(a_), g = random_face(b_);
      const Vector3d e = f[1] - f[0], d = g[1] - g[0], n = e.cross(f[2] - f[0]);
      if (!(n.norm() > 0) || !(d.norm() > 0)) continue;
      const Matrix3d r = rotation_to(d, e);
      return {{r, (f[0] + f[1]) / 2 - r * ((g[0] + g[1]) / 2)}, n.normalized()};
    }
  }

  /// One of the 24 rotations that map axes to axes, exactly.
  std::pair<Pose, Vector3d> vertex_on_vertex() {
    std::array<int, 3> axes = {0, 1, 2};
    random_.shuffle(axes);
    Matrix3d r = Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) r(i, axes[static_cast<std::size_t>(i)]) = random_.below(2) == 0 ? 1 : -1;
    if (r.determinant() < 0) r.row(0) *= -1;
    const Corners f = random_face(a_), g = random_face(b_);
    Vector3d axis = Vector3d::Zero();
    axis[static_cast<int>(random_.below(3))] = 1;
    return {{r, f[0] - r * g[0]}, axis};
  }

  const LrbRep &a_, &b_;
  const PoseSpace& space_;
  Random random_;
  Workspace workspace_;
};

}  // namespace

std::vector<HardPose> hard_poses(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::size_t count,
                                 std::uint64_t seed, const run::ProgressReport& progress) {
  Maker maker(a, b, space, seed);
  std::vector<HardPose> out;
  for (std::size_t group = 0; out.size() < count; ++group) {
    const Hard kind = kEnumNames<Hard>[group % kEnumNames<Hard>.size()].value;
    const auto [pose, direction] = maker.make(kind);
    for (const int ulps : kUlps) {
      if (out.size() == count) break;
      out.push_back({kind, ulps, {pose.r, pose.t + (ulps * kUlp * space.unit()) * direction}});
    }
    progress("hard poses", out.size(), count);
  }
  return out;
}

double signed_gap(const Corners& a, const Corners& b) {
  double best = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vector3d& axis, double scale) {
    // An axis that is short beside the edges that it comes from is rounding.
    constexpr double kNoise = 1e-10;
    const double length = axis.norm();
    if (!(length > kNoise * scale)) return;
    double low[2], high[2];
    const Corners* const triangles[2] = {&a, &b};
    for (int side = 0; side < 2; ++side) {
      low[side] = high[side] = 0;
      for (int k = 0; k < 3; ++k) {
        const double x = axis.dot((*triangles[side])[static_cast<std::size_t>(k)] - a[0]) / length;
        low[side] = k == 0 ? x : std::min(low[side], x);
        high[side] = k == 0 ? x : std::max(high[side], x);
      }
    }
    best = std::max(best, std::max(low[0] - high[1], low[1] - high[0]));
  };
  const auto edge = [](const Corners& t, std::size_t i) -> Vector3d { return t[(i + 1) % 3] - t[i]; };
  for (const Corners* t : {&a, &b}) {
    const Vector3d n = edge(*t, 0).cross(edge(*t, 1));
    const double scale = edge(*t, 0).norm() * edge(*t, 1).norm();
    try_axis(n, scale);
    // In the plane of a triangle, for coplanar ones.
    for (std::size_t i = 0; i < 3; ++i) try_axis(n.cross(edge(*t, i)), scale * edge(*t, i).norm());
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      try_axis(edge(a, i).cross(edge(b, j)), edge(a, i).norm() * edge(b, j).norm());
  return best;
}

std::vector<Judged> WrongSearch::worst(std::size_t most) const {
  std::vector<Judged> out;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(out),
               [](const Judged& j) { return j.wrong_pairs() || j.wrong_contact(); });
  std::stable_sort(out.begin(), out.end(), [](const Judged& p, const Judged& q) {
    return p.wrong_contact() != q.wrong_contact() ? p.wrong_contact() : p.error > q.error;
  });
  if (out.size() > most) out.erase(out.begin() + static_cast<std::ptrdiff_t>(most), out.end());
  return out;
}

WrongSearch find_wrong(Engine& engine, const LrbRep& a, const LrbRep& b, const PoseSpace& space,
                       std::size_t budget, std::uint64_t seed, const run::ProgressReport& progress) {
  WrongSearch out;
  out.engine = engine.name();
  out.seed = seed;
  const std::vector<HardPose> hard = hard_poses(a, b, space, budget, seed, progress);
  std::vector<Pose> poses;
  std::transform(hard.begin(), hard.end(), std::back_inserter(poses),
                 [](const HardPose& h) { return h.pose; });
  std::vector<EngineAnswer> answers =
      engine.ask(poses, {.list = true}, [&](std::size_t done) { progress(out.engine, done, poses.size()); });
  Workspace workspace;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    Judged& judged = out.poses.emplace_back();
    judged.at = hard[i];
    judged.answer = std::move(answers[i]);
    progress("exact answers", i + 1, hard.size());
    const std::vector<SimplexPair> exact =
        std::move(collide(a, Pose{}, b, poses[i], CollideRequest{}, workspace).value().pairs);
    judged.exact_pairs = exact.size();
    if (!judged.answer.failure.empty()) continue;
    std::vector<SimplexPair> missed, extra;
    const std::vector<SimplexPair>& found = judged.answer.list;
    for (const SimplexPair& p : found)
      if (p.a >= a.real_simplex_count() || p.b >= b.real_simplex_count())
        throw InputError(printable_name(out.engine) +
                         ": expected pairs of faces of the two bodies, found one of others; does it read the "
                         "same triangles in the same order?");
    std::set_difference(exact.begin(), exact.end(), found.begin(), found.end(), std::back_inserter(missed));
    std::set_difference(found.begin(), found.end(), exact.begin(), exact.end(), std::back_inserter(extra));
    judged.missed = missed.size();
    judged.extra = extra.size();
    for (const std::vector<SimplexPair>* pairs : {&missed, &extra})
      for (const SimplexPair& p : *pairs)
        judged.error = std::max(
            judged.error,
            std::abs(signed_gap(corners_of(a, p.a), posed(corners_of(b, p.b), poses[i]))) / space.unit());
  }
  return out;
}

namespace {

const std::vector<std::string> kKindColumns = {"poses",        "number",      "no answer",    "wrong contact",
                                               "missed pairs", "false pairs", "largest error"};

/// Returns a row for each kind of poses.
std::vector<std::vector<std::string>> rows_of(const WrongSearch& search) {
  std::vector<std::vector<std::string>> out;
  for (const EnumName<Hard>& kind : kEnumNames<Hard>) {
    std::uint64_t number = 0, failed = 0, contacts = 0, missed = 0, extra = 0;
    double error = 0;
    for (const Judged& j : search.poses) {
      if (j.at.kind != kind.value) continue;
      ++number;
      failed += j.answer.failure.empty() ? 0 : 1;
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

std::string table_of(const WrongSearch& search) {
  std::vector<std::vector<std::string>> rows = rows_of(search);
  rows.insert(rows.begin(), kKindColumns);
  return report::in_columns(rows);
}

std::vector<nlohmann::ordered_json> json_of(const WrongSearch& search) {
  std::vector<nlohmann::ordered_json> out;
  for (const Judged& j : search.worst())
    out.push_back({{"engine", search.engine},
                   {"goal", "wrong"},
                   {"poses", name_of(j.at.kind)},
                   {"ulps", j.at.ulps},
                   {"pairs", j.answer.pairs},
                   {"exact_pairs", j.exact_pairs},
                   {"missed", j.missed},
                   {"false", j.extra},
                   {"error", j.error},
                   {"b", io::rows_of(j.at.pose)}});
  return out;
}

std::vector<std::string> write_wrong_page(const WrongSearch& search, const std::string& title,
                                          const std::string& command, const std::string& scenario,
                                          const std::vector<std::string>& recorders,
                                          const std::string& folder) {
  report::Document document(
      title,
      "An engine's pairs of intersecting faces at poses that are hard in floating point, compared with the "
      "exact ones: at first contact, with coplanar faces, with parallel edges, with vertices on vertices, "
      "and beside them, from one unit in the last place of doubles up to the rounding of single precision.");
  document.table(
      {"Kinds of poses", kKindColumns, rows_of(search),
       "Error: the gap of triangles that were reported but do not intersect, or the depth of those that "
       "were missed, over the mean of both bodies' diagonals. An error near the engine's rounding "
       "(1e-16 of the coordinates in double, 6e-8 in single precision) is unavoidable."});
  report::Table worst{"The worst poses",
                      {"poses", "ulps", "pairs", "exact pairs", "missed", "false", "error", "recorded by"}};
  const std::vector<Judged> judged = search.worst();
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const Judged& j = judged[i];
    worst.rows.push_back({io::in_words(name_of(j.at.kind)), std::to_string(j.at.ulps),
                          std::to_string(j.answer.pairs), std::to_string(j.exact_pairs),
                          std::to_string(j.missed), std::to_string(j.extra), io::number_text(j.error, 3),
                          recorders[i]});
  }
  if (judged.empty()) worst.note = "No pair was missed or reported falsely.";
  document.table(worst);
  if (!scenario.empty())
    document.file("worst.scenario.json", scenario, "the poses with the exact answers, for regression tests");
  document.command(command);
  document.write(report::Folder(folder));
  return document.notes();
}

}  // namespace lrb::tails
