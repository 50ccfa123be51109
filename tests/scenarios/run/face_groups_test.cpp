#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/frames/face_colours.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/trace/counters.hpp>

using namespace lrb;

namespace {

using ColourPer = render::FrameSpec::ColourPer;

spec::Scenario rocks() {
  spec::Scenario s;
  s.name = "rocks";
  s.bodies.resize(2);
  for (spec::BodySpec& body : s.bodies) {
    body.generator = "rock";
    body.parameters = {{"frequency", 6}};
  }
  s.events = EventLevel::nodes;
  s.motion.kind = spec::Motion::Kind::approach;
  s.motion.from = {3, 0.2, 0.1};
  s.motion.steps = 1000;
  s.motion.into = 4;
  return s;
}

run::Recording recorded(const spec::Scenario& s) {
  return run::record(s, run::kSilent);
}

/// Returns the number in a cell, whose digits may be in groups.
std::uint64_t number(const std::string& cell) {
  std::string digits;
  std::copy_if(cell.begin(), cell.end(), std::back_inserter(digits),
               [](char c) { return c >= '0' && c <= '9'; });
  return digits.empty() ? 0 : std::stoull(digits);
}

std::size_t column(const report::Table& t, const std::string& name) {
  return static_cast<std::size_t>(std::find(t.columns.begin(), t.columns.end(), name) - t.columns.begin());
}

}  // namespace

TEST_CASE("sums over regions and levels count every face once") {
  const run::Recording r = recorded(rocks());
  const LrbRep& rep = r.bodies[0].rep;
  const trace::FaceCounts counts = trace::count_faces(rep, Side::a, r.trace.events);
  const std::vector<double> tests(counts.tests.begin(), counts.tests.end());
  const double all = std::accumulate(tests.begin(), tests.end(), 0.0);
  REQUIRE(all > 0);
  CHECK(run::grouped(tests, ColourPer::face, rep) == tests);
  for (const ColourPer per : {ColourPer::region, ColourPer::level}) {
    const std::vector<double> sums = run::grouped(tests, per, rep);
    REQUIRE(sums.size() == tests.size());
    std::map<std::uint32_t, double> once;
    double total = 0;
    for (FaceId f = 0; f < rep.face_count(); ++f) {
      const std::uint32_t group = per == ColourPer::region ? run::region_of(rep, f) : run::level_of(rep, f);
      if (group == kNull) {
        CHECK(sums[f] == tests[f]);
        total += sums[f];
      } else if (once.emplace(group, sums[f]).second) {
        total += sums[f];
      } else {
        CHECK(sums[f] == once[group]);
      }
    }
    CHECK(total == all);
  }
}

TEST_CASE("tables by level and by region add up to the run's totals") {
  const spec::Scenario s = rocks();
  const run::Recording r = recorded(s);
  const trace::Totals totals = trace::count_events(r.trace.events);
  const std::vector<report::Table> tables = run::group_tables(run::recorded_run_of(s, r));
  REQUIRE(tables.size() == 4);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const report::Table& t = tables[i];
    CAPTURE(t.title);
    const auto sum = [&](const std::string& name) {
      std::uint64_t out = 0;
      for (std::size_t row = 0; row + 1 < t.rows.size(); ++row) out += number(t.rows[row][column(t, name)]);
      CHECK(out == number(t.rows.back()[column(t, name)]));
      return out;
    };
    CHECK(sum("tests") == totals.face_tests);
    CHECK(sum("hits") == totals.hits);
    CHECK(sum("misses") == totals.face_tests - totals.hits);
    CHECK(sum("faces") == r.bodies[i % 2].rep.face_count());
    if (i >= 2) CHECK(sum("refined") == totals.refinements[i % 2]);
  }
}

TEST_CASE("a real face belongs to the region that covers it, a pseudo face to the one that it hides") {
  const run::Recording r = recorded(rocks());
  const LrbRep& rep = r.bodies[0].rep;
  for (RegionId region = 0; region < rep.region_count(); ++region) {
    for (const FaceId f : rep.lids(region)) CHECK(run::region_of(rep, f) == region.value());
    for (const FaceId f : rep.floor(region))
      if (rep.is_real(f)) CHECK(run::region_of(rep, f) == region.value());
  }
  for (const FaceId f : rep.outermost_faces()) CHECK(run::level_of(rep, f) == 0);
}
