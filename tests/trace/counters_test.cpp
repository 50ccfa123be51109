#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/trace/runs.hpp"
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using exact::Meet;
using runs::box;
using runs::plate;

namespace {

/// Small enough to count by hand: 4 tests, 3 hits, 1 of them a touch; 3 refinements; 1 contact; 2 steps.
Trace by_hand() {
  Recorder recorder(plate(), plate(), {});
  recorder.begin_step(0, {}, {});
  recorder.face_test(11, 12, Meet::cross, 0, 0);
  recorder.refine(Side::a, 2, 3);
  recorder.refine(Side::b, 2, 3);
  recorder.face_test(10, 0, Meet::touch, 1, 0);
  recorder.refine(Side::a, 1, 3);
  recorder.face_test(3, 0, Meet::cross, 2, 0);
  recorder.contact(3, 0, Meet::cross);
  recorder.end_step({});
  recorder.begin_step(4, {}, {});
  recorder.face_test(0, 0, Meet::disjoint, 0, 0);
  recorder.end_step({});
  return recorder.take();
}

double value_of(const std::vector<Statistic>& all, std::string_view name) {
  const auto it = std::find_if(all.begin(), all.end(), [&](const Statistic& s) { return s.name == name; });
  REQUIRE(it != all.end());
  CHECK_FALSE(it->description.empty());
  return it->value;
}

}  // namespace

TEST_CASE("statistics are the documented ratios") {
  const auto all = statistics(by_hand());
  CHECK(value_of(all, "tests_per_contact") == 4.0);
  CHECK(value_of(all, "hit_rate") == 0.75);
  CHECK(value_of(all, "contact_rate") == 1.0 / 3);
  CHECK(value_of(all, "tests_per_refinement") == 4.0 / 3);
  CHECK(value_of(all, "faces_per_refinement") == 3.0);
  CHECK(value_of(all, "tests_per_step") == 2.0);
  CHECK(value_of(all, "largest_wrapper_share_a") == 8.0 / 9);
  CHECK(value_of(all, "largest_wrapper_share_b") == 6.0 / 9);
  CHECK(value_of(all, "pair_share") == 4.0 / (2 * 9 * 9));
  Recorder nothing(plate(), plate(), {});
  nothing.begin_step(0, {}, {});
  CHECK(std::isnan(value_of(statistics(nothing.take()), "tests_per_contact")));
}

TEST_CASE("counts per face add up to the events, on the events' faces") {
  const Trace t = by_hand();
  const FaceCounts a = count_faces(plate(), Side::a, t.events), b = count_faces(plate(), Side::b, t.events);
  CHECK(a.tests == std::vector<std::uint32_t>{1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0});
  CHECK(a.hits == std::vector<std::uint32_t>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0});
  CHECK(a.contacts == std::vector<std::uint32_t>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  // Region 2: its lids 11, 12 and the real faces under it, 2 and 7; region 1: lid 10, real faces 3 and 6.
  CHECK(a.refinements == std::vector<std::uint32_t>{0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 1});
  CHECK(b.refinements == std::vector<std::uint32_t>{0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1});
  CHECK(b.tests == std::vector<std::uint32_t>{3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1});

  const Trace boxes = runs::record(box(), box(), runs::kBoxPoses).trace;
  const Totals totals = count_events(boxes.events);
  const FaceCounts counts = count_faces(box(), Side::b, boxes.events);
  const auto sum = [](const std::vector<std::uint32_t>& v) {
    return std::accumulate(v.begin(), v.end(), std::uint64_t{0});
  };
  CHECK(sum(counts.tests) == totals.face_tests);
  CHECK(sum(counts.hits) == totals.hits);
  CHECK(sum(counts.contacts) == totals.contacts);
}

TEST_CASE("charts run over events and over steps") {
  const Trace t = by_hand();
  const Chart events = chart_over_events(t);
  REQUIRE(events.x.size() == t.events.size());
  for (const Series& s : events.series) CHECK(s.values.size() == events.x.size());
  CHECK(events.series[0].values == std::vector<double>{5, 5, 6, 6, 6, 8, 8, 8, 8, 5, 5, 5});
  CHECK(events.series[1].values == std::vector<double>{5, 5, 5, 6, 6, 6, 6, 6, 6, 5, 5, 5});
  CHECK(events.series[2].values == std::vector<double>{0, 1, 1, 1, 2, 2, 3, 3, 3, 0, 1, 1});
  const Chart few = chart_over_events(t, 3);
  CHECK(few.x.size() <= 5);
  CHECK(few.x.back() == 11);
  const Chart steps = chart_over_steps(t);
  CHECK(steps.x == std::vector<double>{0, 4});
  CHECK(steps.series[0].values == std::vector<double>{3, 1});
  CHECK(steps.series[4].values == std::vector<double>{8, 5});
  CHECK(steps.series.size() == 6);

  Recorder alone(plate(), RecorderSettings{});
  alone.begin_step(0, {});
  alone.refine(Side::a, 2, 3);
  const Trace one = alone.take();
  for (const Chart& chart : {chart_over_events(one), chart_over_steps(one)})
    for (const Series& s : chart.series) CHECK(s.name.find('B') == std::string_view::npos);
}
