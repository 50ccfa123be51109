#include "bench/tails/tails.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "bench/speed/metrics.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::tails {
namespace {

bool answered(const Sample& s) {
  return s.answer.failure.empty();
}

/// Returns the time per test, or nullopt if either is not known.
std::optional<double> us_per_test(const EngineAnswer& a) {
  if (!a.failure.empty() || a.tests.value_or(0) == 0 || a.us <= 0) return std::nullopt;
  return a.us / static_cast<double>(*a.tests);
}

/// Queries the poses with these indices in several rounds, and returns the least times.
std::vector<double> least_times(Engine& engine, std::span<const Pose> poses, int rounds,
                                const std::function<void(std::size_t)>& progress) {
  std::vector<double> least(poses.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round) {
    const std::size_t before = static_cast<std::size_t>(round) * poses.size();
    const std::vector<EngineAnswer> answers =
        engine.ask(poses, {}, [&](std::size_t done) { progress(before + done); });
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (answers[i].failure.empty()) least[i] = std::min(least[i], answers[i].us);
  }
  return least;
}

/// Queries poses with an unusual time per test again, and marks those whose time does not repeat.
void find_noise(Engine& engine, Tail& tail, const run::ProgressReport& progress) {
  std::vector<double> ratios, times;
  for (const Sample& s : tail.samples)
    if (const auto ratio = us_per_test(s.answer)) {
      ratios.push_back(*ratio);
      times.push_back(s.answer.us);
    }
  const double limit = kNoiseFactor * bench::median(ratios), usual = bench::median(times);
  std::vector<std::size_t> unusual;
  std::vector<Pose> poses;  // each after the one before it, so that caches are as they were
  for (std::size_t i = 0; i < tail.samples.size(); ++i)
    if (us_per_test(tail.samples[i].answer).value_or(0) > limit && tail.samples[i].answer.us > usual) {
      unusual.push_back(i);
      poses.push_back(tail.poses[i == 0 ? tail.poses.size() - 1 : i - 1]);
      poses.push_back(tail.poses[i]);
    }
  if (unusual.empty()) return;
  const std::vector<double> again = least_times(engine, poses, kRounds, [&](std::size_t done) {
    progress(tail.engine + ", noise", done, kRounds * poses.size());
  });
  for (std::size_t k = 0; k < unusual.size(); ++k) {
    Sample& s = tail.samples[unusual[k]];
    const double us = again[2 * k + 1];
    constexpr double kRepeats = 0.5;
    s.noise = us < kRepeats * s.answer.us;
    s.answer.us = std::min(s.answer.us, us);
  }
}

std::string bytes_of(const capture::Query& q) {
  std::string out;
  const auto add = [&](const auto& x) { out.append(reinterpret_cast<const char*>(&x), sizeof x); };
  for (const std::uint32_t tree : q.trees) add(tree);
  for (const Pose& pose : q.poses) {
    for (int i = 0; i < 9; ++i) add(pose.r(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) add(pose.t[i]);
  }
  return out;
}

/// Returns a quantity of each answered pose, or an empty list if one of them does not have it.
template <class Value>
std::vector<double> values_of(const Tail& tail, const Value& value) {
  std::vector<double> out;
  for (const Sample& s : tail.samples) {
    if (!answered(s)) continue;
    const std::optional<double> x = value(s.answer);
    if (!x) return {};
    out.push_back(*x);
  }
  return out;
}

/// A quantity with a value for each answered pose.
struct Quantity {
  std::string what;
  std::vector<double> values;
};

std::vector<Quantity> quantities_of(const Tail& tail) {
  using Value = std::optional<double>;
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  std::vector<Quantity> all = {
      {"us", values_of(tail, [](const EngineAnswer& a) { return Value(a.us); })},
      {"tests",
       values_of(tail, [&](const EngineAnswer& a) { return a.tests ? Value(number(*a.tests)) : Value(); })},
      {"box_tests",
       values_of(tail,
                 [&](const EngineAnswer& a) { return a.kinds ? Value(number(a.kinds->boxes)) : Value(); })},
      {"face_tests", values_of(tail, [&](const EngineAnswer& a) {
         return a.kinds ? Value(number(a.kinds->faces)) : Value();
       })}};
  std::set<std::string> phases;
  for (const Sample& s : tail.samples)
    for (const auto& [name, tests] : s.answer.phases) phases.insert(name);
  for (const std::string& phase : phases)
    all.push_back({"tests in phase " + phase, values_of(tail, [&](const EngineAnswer& a) {
                     const auto it = a.phases.find(phase);
                     return Value(it == a.phases.end() ? 0 : number(it->second));
                   })});
  std::erase_if(all, [](const Quantity& q) { return q.values.empty(); });
  return all;
}

/// Returns the indices of answered poses, fastest first.
std::vector<std::size_t> by_time(const Tail& tail) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tail.samples.size(); ++i)
    if (answered(tail.samples[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return tail.samples[i].answer.us < tail.samples[j].answer.us;
  });
  return order;
}

}  // namespace

Tail measure(Engine& engine, std::span<const Pose> poses, const run::ProgressReport& progress) {
  Tail out;
  out.engine = engine.name();
  out.poses.assign(poses.begin(), poses.end());
  out.rounds = kRounds;
  const std::size_t total = (kRounds + 1) * poses.size();
  // Tests are counted in a round of their own, because counting may take time.
  std::vector<EngineAnswer> counted =
      engine.ask(poses, {.tests = true}, [&](std::size_t done) { progress(out.engine, done, total); });
  const std::vector<double> least = least_times(
      engine, poses, kRounds, [&](std::size_t done) { progress(out.engine, poses.size() + done, total); });
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Sample& s = out.samples.emplace_back();
    s.answer = std::move(counted[i]);
    if (s.answer.failure.empty() && !std::isfinite(least[i]))
      s.answer.failure = "answered once, but not again";
    s.answer.us = least[i];
  }
  find_noise(engine, out, progress);
  return out;
}

Tail tail_of(const capture::Capture& capture, const std::string& file) {
  Tail out;
  out.engine = capture.engine;
  std::map<std::string, std::size_t> known;
  std::vector<int> rounds;
  for (const capture::Query& q : capture.queries) {
    if (!q.ended) continue;
    out.with_events = out.with_events || !q.events.empty();
    const auto [it, is_new] = known.emplace(bytes_of(q), out.samples.size());
    if (!is_new) {
      ++rounds[it->second];
      Sample& s = out.samples[it->second];
      const double before = s.answer.us, us = q.duration_ns / 1e3;
      // The repeat of a query without events may have them.
      if (!s.answer.tests) s.answer = answer_of(q, capture.names, false);
      if (us < before) out.queries[it->second] = q.number;
      s.answer.us = std::min(before, us);
      continue;
    }
    rounds.push_back(1);
    const Eigen::Matrix3d back = q.poses[0].r.transpose();
    out.poses.push_back({back * q.poses[1].r, back * (q.poses[1].t - q.poses[0].t)});
    out.samples.push_back({answer_of(q, capture.names, false)});
    out.queries.push_back(q.number);
  }
  if (out.samples.empty())
    throw InputError(printable_name(file) + ": expected queries that ended, found none");
  out.rounds = *std::min_element(rounds.begin(), rounds.end());
  return out;
}

std::vector<Percentiles> percentiles(const Tail& tail) {
  std::vector<Percentiles> out;
  for (const Quantity& q : quantities_of(tail))
    out.push_back({q.what, q.values.size(), bench::quantile(q.values, 0.5), bench::quantile(q.values, 0.9),
                   bench::quantile(q.values, 0.99), bench::quantile(q.values, 1)});
  return out;
}

double percentile_share(const std::string& word) {
  if (word == "max") return 1;
  const bool is_number = word.size() > 1 && word[0] == 'p' && word[1] >= '0' && word[1] <= '9';
  char* end = nullptr;
  const double share = is_number ? std::strtod(word.c_str() + 1, &end) / 100 : 0;
  if (!is_number || *end != '\0' || !(share > 0 && share <= 1))
    throw InputError("--record: expected max or a percentile such as p99, found " + in_quotes(word));
  return share;
}

std::size_t pose_at(const Tail& tail, const std::string& word) {
  const double share = percentile_share(word);
  const std::vector<std::size_t> order = by_time(tail);
  if (order.empty()) throw InputError(printable_name(tail.engine) + ": expected an answer, found none");
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(order.size())));
  return order[std::max<std::size_t>(rank, 1) - 1];
}

std::vector<std::size_t> costliest(const Tail& tail, std::size_t most) {
  std::vector<std::size_t> order = by_time(tail);
  std::reverse(order.begin(), order.end());
  order.resize(std::min(order.size(), most));
  return order;
}

std::string table_of(const std::vector<Tail>& tails) {
  std::vector<std::vector<std::string>> rows = {{"engine", "", "p50", "p90", "p99", "max", "poses"}};
  for (const Tail& tail : tails)
    for (const Percentiles& p : percentiles(tail)) {
      rows.push_back(
          {tail.engine, p.what == "box_tests" || p.what == "face_tests" ? io::in_words(p.what) : p.what});
      for (const double x : {p.p50, p.p90, p.p99, p.max})
        rows.back().push_back(p.what == "us" ? io::number_text(x, 4) : io::fixed_text(x, 0));
      rows.back().push_back(std::to_string(p.count));
    }
  return report::in_columns(rows, 2);
}

std::vector<nlohmann::ordered_json> json_of(const std::vector<Tail>& tails) {
  std::vector<nlohmann::ordered_json> out;
  for (const Tail& tail : tails) {
    const auto noisy =
        std::count_if(tail.samples.begin(), tail.samples.end(), [](const Sample& s) { return s.noise; });
    const auto failed =
        std::count_if(tail.samples.begin(), tail.samples.end(), [](const Sample& s) { return !answered(s); });
    for (const Percentiles& p : percentiles(tail))
      out.push_back({{"engine", tail.engine},
                     {"what", p.what},
                     {"poses", p.count},
                     {"p50", p.p50},
                     {"p90", p.p90},
                     {"p99", p.p99},
                     {"max", p.max},
                     {"failed", failed},
                     {"noise", noisy}});
  }
  return out;
}

std::vector<std::string> notes_of(const std::vector<Tail>& tails) {
  std::vector<std::string> out;
  for (const Tail& tail : tails) {
    std::size_t failed = 0, noisy = 0;
    std::string first;
    for (std::size_t i = 0; i < tail.samples.size(); ++i) {
      const Sample& s = tail.samples[i];
      noisy += s.noise ? 1 : 0;
      if (!answered(s) && failed++ == 0) first = "pose " + std::to_string(i) + ": " + s.answer.failure;
    }
    const std::string name = printable_name(tail.engine);
    if (failed > 0)
      out.push_back(name + ": no answer at " + std::to_string(failed) + " of " +
                    std::to_string(tail.samples.size()) + " poses; " + first);
    if (noisy > 0)
      out.push_back(name + ": noise at " + std::to_string(noisy) +
                    " poses, whose times did not repeat; the shorter time counts");
    if (tail.with_events)
      out.push_back(name +
                    ": events were recorded, which adds to the times; for times, record with "
                    "LRBCAP_EVENTS=0");
  }
  return out;
}

namespace {

using render::short_number;

/// Returns the share of poses that cost more, over the cost: a few hundred points, evenly spaced by rank on
/// the logarithmic axis.
report::Series exceedance(const std::string& label, std::vector<double> values) {
  report::Series out{label, {}, {}, {report::Line::straight, "", "none"}};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  constexpr double kPoints = 300;
  std::size_t last = n;
  for (double k = 0; k <= kPoints; ++k) {
    // Number of poses that cost at least as much: from all down to one.
    const auto above = static_cast<std::size_t>(std::pow(static_cast<double>(n), 1 - k / kPoints));
    const std::size_t i = n - std::clamp<std::size_t>(above, 1, n);
    if (i == last) continue;
    last = i;
    if (values[i] <= 0) continue;
    out.x.push_back(values[i]);
    out.y.push_back(static_cast<double>(n - i) / static_cast<double>(n));
  }
  return out;
}

report::Chart distribution(const std::vector<Tail>& tails, const std::string& what, const std::string& title,
                           const std::string& label) {
  report::Chart chart{title, {label, true}, {"share of poses", true}};
  for (const Tail& tail : tails)
    for (Quantity& q : quantities_of(tail))
      if (q.what == what) chart.series.push_back(exceedance(tail.engine, std::move(q.values)));
  return chart;
}

std::string count_text(const std::optional<std::uint64_t>& n) {
  return n ? std::to_string(*n) : "\u2013";
}

report::Table costliest_table(const Tail& tail, const TailsPage& page) {
  constexpr std::size_t kMaxRows = 10;
  const bool captured = !tail.queries.empty();
  report::Table t{tail.engine + ": the costliest poses",
                  {captured ? "query" : "pose", "\u00b5s", "tests", "box tests", "face tests", "pairs", "",
                   "recorded by"}};
  for (const std::size_t i : costliest(tail, kMaxRows)) {
    const Sample& s = tail.samples[i];
    const auto kind = [&](std::uint64_t methods::TestCounts::*member) {
      return s.answer.kinds ? std::to_string((*s.answer.kinds).*member) : std::string("\u2013");
    };
    t.rows.push_back({std::to_string(captured ? tail.queries[i] : i), short_number(s.answer.us),
                      count_text(s.answer.tests), kind(&methods::TestCounts::boxes),
                      kind(&methods::TestCounts::faces), std::to_string(s.answer.pairs),
                      s.noise ? "noise" : "", page.record_command(tail, i)});
  }
  t.note =
      "By time. Noise: the time was above the median, and per test over five times the median, and did not repeat.";
  return t;
}

std::string lines_of(const std::vector<Tail>& tails) {
  std::string out;
  for (const Tail& tail : tails)
    for (std::size_t i = 0; i < tail.samples.size(); ++i) {
      const Sample& s = tail.samples[i];
      nlohmann::ordered_json line = {{"engine", tail.engine}, {"pose", i}};
      if (!tail.queries.empty()) line["query"] = tail.queries[i];
      if (!answered(s)) {
        line["failure"] = s.answer.failure;
      } else {
        line["us"] = s.answer.us;
        if (s.answer.tests) line["tests"] = *s.answer.tests;
        if (s.answer.kinds) {
          line["box_tests"] = s.answer.kinds->boxes;
          line["face_tests"] = s.answer.kinds->faces;
        }
        line["pairs"] = s.answer.pairs;
        if (s.noise) line["noise"] = true;
      }
      line["b"] = io::rows_of(tail.poses[i]);
      out += line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    }
  return out;
}

}  // namespace

std::vector<std::string> write_tails_page(const std::vector<Tail>& tails, const TailsPage& page,
                                          const std::string& folder) {
  report::Document document(page.title, page.purpose);
  if (!page.machine.empty()) document.number({"Machine", page.machine});
  for (const Tail& tail : tails)
    for (const Percentiles& p : percentiles(tail))
      if (p.what == "us")
        document.number({tail.engine, short_number(p.p50) + " \u00b5s",
                         "p50; p99 " + short_number(p.p99) + ", max " + short_number(p.max)});
  report::Chart times = distribution(tails, "us", "Time of a query", "\u00b5s");
  times.note =
      "The share of poses that cost as much or more: a tail is where the curve goes on to the right below 1 %.";
  document.chart(times);
  if (const report::Chart tests = distribution(tails, "tests", "Tests of a query", "tests");
      !tests.series.empty())
    document.chart(tests);
  report::Table table{"Percentiles", {"engine", "", "p50", "p90", "p99", "max", "poses"}};
  for (const Tail& tail : tails)
    for (const Percentiles& p : percentiles(tail))
      table.rows.push_back({tail.engine, p.what == "us" ? "\u00b5s" : io::in_words(p.what),
                            short_number(p.p50), short_number(p.p90), short_number(p.p99),
                            short_number(p.max), std::to_string(p.count)});
  const std::vector<std::string> notes = notes_of(tails);
  for (const std::string& note : notes) table.note += note + ". ";
  document.table(table);
  for (const Tail& tail : tails) document.table(costliest_table(tail, page));
  document.file("tails.jsonl", lines_of(tails), "every pose with its time, tests and pairs");
  document.command(page.command);
  document.write(report::Folder(folder));
  return document.notes();
}

}  // namespace lrb::tails
