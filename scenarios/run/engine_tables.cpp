/// The page of a run of another engine that reported its answers: key figures and a table of queries.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenarios/io/files.hpp"
#include "scenarios/record/engine_run.hpp"
#include "scenarios/run/run_charts.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::run {
namespace {

record::EngineTotals totals_of(const frames::RecordedRun& p) {
  return record::totals_of(*p.trace, p.results, p.wrong);
}

record::AnswerScore score_at(const frames::RecordedRun& p, std::size_t step) {
  return record::score_of(p.trace->steps[step].result, (*p.wrong)[step], (*p.results)[step]);
}

}  // namespace

std::string engine_sentence(const frames::RecordedRun& p) {
  return totals_of(p).words() + ".";
}

void add_engine_answer(report::Document& doc, const frames::RecordedRun& p) {
  using render::group_digits;
  const record::EngineTotals t = totals_of(p);
  if (!t.checked)
    doc.verdict("answers not checked");
  else if (t.wrong_queries == 0)
    doc.verdict("no wrong answer");
  else
    doc.verdict("wrong in " + group_digits(t.wrong_queries) + " of " + group_digits(t.queries), false);
  // Errors come first, and right verdicts are no comfort beside them.
  if (t.checked && t.has_pairs)
    doc.number({"Missed pairs", group_digits(t.missed),
                "not found, of " + group_digits(t.right + t.missed) + " that intersect"})
        .number({"False pairs", group_digits(t.false_pairs), "found, but disjoint"});
  if (t.verdicts > 0)
    doc.number({"Wrong verdicts", group_digits(t.wrong_verdicts), "of " + group_digits(t.verdicts)});
  if (t.distances > 0)
    doc.number({"Wrong distances", group_digits(t.wrong_distances), "of " + group_digits(t.distances)});
  doc.number({"Volume tests", group_digits(t.box_tests),
              t.node_pairs == t.box_tests ? "" : "in " + group_digits(t.node_pairs) + " pairs of nodes"})
      .number({"Triangle tests", group_digits(t.face_tests),
               "brute force: " + group_digits(std::uint64_t{p.reps[0]->real_simplex_count()} *
                                              p.reps[1]->real_simplex_count() * t.queries)});
}

std::vector<report::Chart> engine_charts(const frames::RecordedRun& p) {
  const std::vector<trace::Step>& steps = p.trace->steps;
  if (steps.size() < 2) return {};
  const auto series = [&](const char* name, const auto& value) {
    report::Series out{name, {}, {}};
    for (std::size_t i = 0; i < steps.size(); ++i) {
      out.x.push_back(steps[i].index);
      out.y.push_back(static_cast<double>(value(i)));
    }
    return out;
  };
  const auto counter = [&](std::uint64_t Counters::*which) {
    return [&steps, which](std::size_t i) {
      return std::max<std::uint64_t>(steps[i].result.counters.*which, 1);
    };
  };
  report::Chart tests{"Tests by query",   {"query"},           {"tests", true}, {},
                      "0 is drawn as 1.", report::Cursor::step};
  tests.series = {series("volumes", counter(&Counters::box_tests)),
                  series("triangles", counter(&Counters::face_tests))};
  report::Chart pairs{"Pairs of triangles by query", {"query"}, {"pairs"}, {}, {}, report::Cursor::step};
  pairs.series = {series("found by the engine", [&](std::size_t i) {
    const trace::StepResult& r = steps[i].result;
    return r.engine && !r.engine->complete ? r.engine->pairs : r.pair_count;
  })};
  if (totals_of(p).checked) {
    const auto add_unless_zero = [&](const char* name, std::uint64_t record::AnswerScore::*which) {
      report::Series s = series(name, [&](std::size_t i) { return score_at(p, i).*which; });
      if (std::ranges::any_of(s.y, [](double y) { return y > 0; })) pairs.series.push_back(std::move(s));
    };
    add_unless_zero("missed", &record::AnswerScore::missed);
    add_unless_zero("false", &record::AnswerScore::false_pairs);
  }
  const auto is_above = [](const report::Chart& chart, double least) {
    return std::ranges::any_of(chart.series, [&](const report::Series& s) {
      return std::ranges::any_of(s.y, [&](double y) { return y > least; });
    });
  };
  std::vector<report::Chart> out;
  if (is_above(tests, 1)) out.push_back(std::move(tests));
  if (is_above(pairs, 0)) out.push_back(std::move(pairs));
  report::Chart times{"Time by query",
                      {"query"},
                      {"microseconds", true},
                      {},
                      "The engine's own times; they include the recording.",
                      report::Cursor::step};
  times.series = {series("time", [&](std::size_t i) {
    const auto& r = steps[i].result.engine;
    return r ? std::max(1e-3 * static_cast<double>(r->duration_ns), 1e-3) : 1e-3;
  })};
  if (is_above(times, 1e-3)) out.push_back(std::move(times));
  return out;
}

report::Table engine_table(const frames::RecordedRun& p) {
  using render::group_digits;
  constexpr std::size_t kMaxRows = 200;
  const trace::Trace& trace = *p.trace;
  const auto any = [&](const auto& test) {
    return std::ranges::any_of(
        trace.steps, [&](const trace::Step& s) { return s.result.engine && test(*s.result.engine); });
  };
  const auto first = [&]() -> const trace::EngineReport* {
    for (const trace::Step& s : trace.steps)
      if (s.result.engine) return &*s.result.engine;
    return nullptr;
  }();
  const bool has_kinds = any([&](const auto& r) { return r.query != first->query; });
  const bool has_threads = any([&](const auto& r) { return r.thread != first->thread; });
  const bool has_times = any([](const auto& r) { return r.duration_ns > 0; });
  const record::EngineTotals totals = totals_of(p);
  const bool checked = totals.checked;
  report::Table t{"Every query", {"query"}};
  // With many queries, the wrong ones are shown, then those with the most tests.
  std::vector<std::size_t> order(trace.steps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() > kMaxRows) {
    const auto key = [&](std::size_t i) {
      const Counters& c = trace.steps[i].result.counters;
      return std::pair(checked && score_at(p, i).is_wrong, c.box_tests + c.face_tests);
    };
    std::ranges::stable_sort(order, [&](std::size_t x, std::size_t y) { return key(x) > key(y); });
    order.resize(kMaxRows);
  }
  for (const std::size_t i : order) {
    const trace::StepResult& r = trace.steps[i].result;
    const trace::EngineReport report = r.engine.value_or(trace::EngineReport());
    std::vector<std::string>& row = t.rows.emplace_back();
    row.push_back(std::to_string(trace.steps[i].index));
    t.targets.push_back("step " + row.back());
    const auto cell = [&](bool is_shown, const char* column, std::string text) {
      if (is_shown && t.rows.size() == 1) t.columns.emplace_back(column);
      if (is_shown) row.push_back(std::move(text));
    };
    const record::AnswerScore score = checked ? score_at(p, i) : record::AnswerScore();
    const bool is_compared = record::is_compared(report);
    const auto number = [&](std::uint64_t n) { return is_compared ? group_digits(n) : std::string(); };
    cell(has_kinds, "kind", io::in_words(name_of(report.query)));
    cell(true, "engine's verdict",
         std::string(name_of(report.verdict)) + (score.verdict == false ? ", wrong" : ""));
    cell(checked, "exact",
         checked && is_compared ? (*p.results)[i].pairs.empty()
                                      ? "no pairs"
                                      : group_digits((*p.results)[i].pairs.size()) + " pairs"
                                : "");
    cell(true, "engine's pairs", group_digits(report.pairs));
    const std::string error = checked ? (*p.wrong)[i].distance.value_or("-") : "";
    cell(totals.distances > 0, "engine's distance", error.empty() ? "right" : error);
    cell(checked, "right", number(score.right));
    cell(checked, "missed", number(score.missed));
    cell(checked, "false", number(score.false_pairs));
    cell(totals.undecidable > 0, "undecidable", number(score.undecidable));
    cell(true, "tests of volumes",
         group_digits(r.counters.box_tests) + (report.complete ? "" : ", incomplete"));
    cell(true, "tests of triangles", group_digits(r.counters.face_tests));
    const double micros = 1e-3 * static_cast<double>(report.duration_ns);
    cell(has_times, "microseconds",
         micros < 1000 ? render::short_number(micros)
                       : group_digits(static_cast<std::uint64_t>(std::llround(micros))));
    cell(has_threads, "thread", std::to_string(report.thread));
  }
  t.note = "A click on a row shows the query.";
  if (checked)
    t.note +=
        " Right, missed and false pairs of triangles are those of the tests that the engine reported, compared with "
        "exact answers.";
  if (totals.undecidable > 0)
    t.note += " Undecidable: wrong pairs that are too close for arithmetic of the engine's precision.";
  if (has_times) t.note += " Times are the engine's own and include the recording.";
  if (order.size() < trace.steps.size())
    t.note += " Of " + group_digits(trace.steps.size()) +
              " queries, those with wrong answers and then those with the most tests.";
  return t;
}

std::vector<report::Table> engine_counter_tables(const frames::RecordedRun& p) {
  using render::group_digits;
  struct Sum {
    std::uint64_t times = 0, all = 0, least = 0, most = 0;
  };
  const std::vector<std::string>& names = p.trace->header.names;
  std::vector<Sum> counts(names.size());
  for (const trace::Step& s : p.trace->steps) {
    if (!s.result.engine) continue;
    for (const trace::EngineReport::Mark& mark : s.result.engine->counts) {
      Sum& sum = counts[mark.name];
      sum.least = sum.times == 0 ? mark.value : std::min<std::uint64_t>(sum.least, mark.value);
      sum.most = std::max<std::uint64_t>(sum.most, mark.value);
      sum.all += mark.value;
      ++sum.times;
    }
  }
  report::Table t{"Counters of the engine", {"counter", "values", "least", "mean", "greatest", "sum"}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const Sum& s = counts[i]; s.times > 0)
      t.rows.push_back({names[i], group_digits(s.times), group_digits(s.least),
                        render::short_number(static_cast<double>(s.all) / static_cast<double>(s.times)),
                        group_digits(s.most), group_digits(s.all)});
  t.note =
      "As the engine reported them, over all queries. The trace has each value at its place among the tests.";
  return t.rows.empty() ? std::vector<report::Table>() : std::vector<report::Table>{t};
}

}  // namespace lrb::run
