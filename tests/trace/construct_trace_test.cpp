/// Constructions as traces: content, files, schema, summary and divergence.

#include <array>
#include <bit>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;
using runs::build, runs::Built;

namespace {

/// Bodies of one component and of several, crossing, and with voids that leave thin gaps; in the plane.
std::vector<Mesh> meshes() {
  using namespace shapes;
  return {bumpy_sphere(3, 5),
          quad_torus(20, 10),
          comb(12),
          several({bumpy_sphere(3, 5), translated(bumpy_sphere(3, 6), {0.9, 0.1, 0.2})}),
          several({icosphere(4), turned_inside_out(icosphere(4, 1.003)), icosphere(3, 1.5)}),
          gear(40),
          several({circle(40, 3), turned_inside_out(circle(30, 2)), star(5)}),
          ring_2d(40)};
}

const Built& rock() {
  static const Built built = build(shapes::bumpy_sphere(3, 7, 0.3));
  return built;
}

std::string complaint(const Trace& trace) {
  return test::trace_faults(Json::parse(trace_to_json(trace)));
}

/// Checks that each pass begins where the one before ended, and that its numbers add up.
void check_passes(const Built& built) {
  const std::vector<PassSummary> passes = passes_of(built.trace);
  REQUIRE_FALSE(passes.empty());
  std::uint32_t faces = built.rep.real_face_count(), regions = 0, lids = 0;
  for (const PassSummary& p : passes) {
    CHECK(p.faces_before == faces);
    CHECK((p.regions > 0 || p.faces_after == faces));
    faces = p.faces_after;
    std::uint32_t caps = 0;
    for (const std::uint32_t n : p.caps) caps += n;
    CHECK(caps == p.patches);
    CHECK(p.deviation <= p.max_deviation);
    regions += p.regions;
    lids += p.lids;
  }
  CHECK(faces == built.rep.outermost_faces().size());
  CHECK(regions == built.rep.region_count());
  CHECK(lids == built.rep.face_count() - built.rep.real_face_count());
}

}  // namespace

TEST_CASE(
    "a construction begins with the body, falls pass by pass, and ends with the outermost wrapper, on any number of "
    "threads; the body is the same without a probe") {
  std::array<std::uint32_t, kEnumNames<CapVerdict>.size()> caps{};
  std::uint32_t excluded = 0, merged = 0;
  std::vector<Mesh> bodies = meshes();
  bodies.push_back(shapes::comb(12));
  for (const Mesh& mesh : bodies) {
    CAPTURE(mesh.name);
    BuildOptions options;
    options.merge_planes = &mesh == &bodies.back();
    options.threads = 1;
    const Built built = build(mesh, options);
    check_passes(built);
    CHECK((passes_of(built.trace).front().stage == BuildStage::merge) == options.merge_planes);
    CHECK(built.rep.hash() == build_lrb(mesh, options).hash());
    options.threads = 4;
    const Built on_threads = build(mesh, options);
    CHECK(on_threads.rep.hash() == built.rep.hash());
    CHECK((on_threads.trace == built.trace));
    for (const PassSummary& p : passes_of(built.trace)) {
      for (std::size_t v = 0; v < caps.size(); ++v) caps[v] += p.caps[v];
      excluded += p.excluded;
      merged += p.merged;
    }
    const Trace& t = built.trace;
    CHECK(t.events.front().kind == EventKind::step);
    CHECK(t.events.back().kind == EventKind::closed);
    CHECK(t.events.back().a == built.rep.region_count());
    CHECK(t.events.back().b == built.rep.outermost_faces().size());
    Cursor cursor(t, built.rep);
    cursor.seek(0);
    CHECK(cursor.boundary_size(Side::a) == built.rep.real_face_count());
    CHECK(cursor.wrapper(Side::a).boundary().size() == built.rep.real_face_count());
    for (const PassSummary& p : passes_of(t)) {
      cursor.seek(p.last);
      CHECK(cursor.boundary_size(Side::a) == p.faces_after);
      CHECK(cursor.wrapper(Side::a).boundary().size() == p.faces_after);
    }
    cursor.seek(0);  // and backward
    CHECK(cursor.boundary_size(Side::a) == built.rep.real_face_count());
    const Chart chart = chart_over_construction(t);
    CHECK(chart.series[0].values.front() == built.rep.real_face_count());
    CHECK(chart.series[0].values.back() == built.rep.outermost_faces().size());
  }
  CHECK(excluded > 0);
  CHECK(merged > 0);
  using enum CapVerdict;
  for (const CapVerdict v : {accepted, too_thick, too_many_faces, no_place, meets_front, overlaps})
    CHECK_MESSAGE(caps[static_cast<std::size_t>(v)] > 0, name_of(v));
}

TEST_CASE(
    "a construction is read back unchanged and satisfies the schema, on both clocks and truncated anywhere") {
  const Mesh mesh = shapes::bumpy_sphere(3, 7, 0.3);
  const auto events = static_cast<std::uint32_t>(rock().trace.events.size());
  for (const std::uint32_t cap : {0u, 1u, 2u, 3u, 40u, events - 1, events}) {
    CAPTURE(cap);
    for (const Clock clock : {Clock::event, Clock::wall}) {
      RecorderSettings settings;
      settings.event_cap = cap;
      settings.clock = clock;
      settings.scenario = "rock";
      const Trace t = build(mesh, {}, settings).trace;
      CHECK(t.events.size() == cap);
      CHECK(t.events_seen == events);
      CHECK(complaint(t) == "");
      CHECK((trace_from_json(trace_to_json(t), "t.json") == t));
      passes_of(t);
      summary_json(t);
    }
  }
}

TEST_CASE("patches name the vertices that their caps may cover") {
  for (const Mesh& mesh : meshes()) {
    CAPTURE(mesh.name);
    const Built built = build(mesh);
    const Trace& t = built.trace;
    std::size_t named = 0;
    for (const Event& e : t.events) {
      const auto vertices = t.vertices_of(e);
      if (vertices.empty()) continue;
      ++named;
      CHECK(vertices.size() == e.patch().interior);
      CHECK(std::set(vertices.begin(), vertices.end()).size() == vertices.size());
      for (const VertexId v : vertices) CHECK(v < built.rep.vertices().size());
    }
    CHECK(named > 0);
    // Where one cap made one region, that covers vertices of the cap's patch alone.
    for (const Event& e : t.events) {
      if (e.kind != EventKind::region || t.events[e.cause].kind != EventKind::cap) continue;
      const auto vertices = t.vertices_of(t.events[t.events[e.cause].cause]);
      if (vertices.empty()) continue;
      const std::set<VertexId> inside(vertices.begin(), vertices.end());
      std::set<VertexId> kept;
      for (const FaceId f : built.rep.lids(e.region()))
        for (const VertexId v : built.rep.face(f)) kept.insert(v);
      for (const FaceId f : built.rep.floor(e.region()))
        for (const VertexId v : built.rep.face(f)) CHECK((kept.contains(v) || inside.contains(v)));
    }
  }
  Trace other = rock().trace;
  other.patch_vertices.back() = VertexId(other.patch_vertices.back() + 1);
  const auto difference = first_divergence(rock().trace, other);
  REQUIRE(difference);
  CHECK(difference->what == "vertices");
  CHECK_FALSE((rock().trace == other));
  // Traces of before have none.
  std::string old = trace_to_json(rock().trace);
  CHECK(old.find("\"version\": 5") != std::string::npos);
  Json json = Json::parse(old);
  for (Json& e : json["traceEvents"])
    if (e.contains("args")) e["args"].erase("vertices");
  json["metadata"]["version"] = 3;
  const Trace read = trace_from_json(json.dump(), "t.json");
  CHECK(read.patch_vertices.empty());
  CHECK(read.events.size() == rock().trace.events.size());
}

TEST_CASE("a body loaded with regions reports its layers") {
  const LrbRep& rep = rock().rep;
  const Built known{rep, known_construction(rep, {}, {})};
  const std::vector<PassSummary> passes = passes_of(known.trace);
  CHECK(passes.size() == rep.layer_count());
  std::uint32_t faces = rep.real_face_count(), regions = 0;
  for (const PassSummary& p : passes) {
    CHECK(p.stage == BuildStage::known);
    CHECK(p.faces_before == faces);
    faces = p.faces_after;
    regions += p.regions;
  }
  CHECK(faces == rep.outermost_faces().size());
  CHECK(regions == rep.region_count());
  CHECK(complaint(known.trace) == "");
  CHECK((trace_from_json(trace_to_json(known.trace), "t.json") == known.trace));
}

TEST_CASE("summaries contain reasons of rejected caps, and no refinements") {
  const std::string text = summary_json(rock().trace);
  CHECK(text.find("refine") == std::string::npos);
  const Json c = Json::parse(text).at("construction");
  const std::vector<PassSummary> passes = passes_of(rock().trace);
  REQUIRE(c.at("passes").size() == passes.size());
  std::uint64_t rejected = 0;
  for (const auto& [why, n] : c.at("refused").items()) {
    CHECK(from_name<CapVerdict>(why));
    rejected += n.get<std::uint64_t>();
  }
  CHECK(rejected > 0);
  CHECK(c.at("patches") == c.at("accepted").get<std::uint64_t>() + rejected);
  CHECK(c.at("regions") == rock().rep.region_count());
  CHECK(c.at("passes").at(0).at("faces_before") == rock().rep.real_face_count());
  CHECK(c.at("passes").at(0).at("stage") == "fitting");
}

TEST_CASE("damaged constructions are rejected") {
  const auto rejected = [](EventKind kind, auto change) {
    Trace t = rock().trace;
    change(t, t.events[runs::first_of(t, kind)]);
    CHECK_THROWS_AS(check_trace(t, "t.json"), InputError);
  };
  check_trace(rock().trace, "t.json");
  rejected(EventKind::pass, [](Trace& t, Event&) { t.header.construction = false; });
  rejected(EventKind::pass, [](Trace&, Event& e) { e.detail = 200; });
  rejected(EventKind::pass, [](Trace&, Event& e) { e.boundary = std::bit_cast<std::uint32_t>(-1.f); });
  rejected(EventKind::cap, [](Trace&, Event& e) { e.detail = 200; });
  rejected(EventKind::cap, [](Trace&, Event& e) { e.cause = kNull; });
  rejected(EventKind::patch, [](Trace&, Event& e) { e.cause = 0; });
  rejected(EventKind::region, [](Trace&, Event& e) { e.a = 1'000'000; });
  rejected(EventKind::region, [](Trace&, Event& e) { e.cause = 0; });
  rejected(EventKind::region, [](Trace&, Event& e) { e.side = Side::b; });
  rejected(EventKind::pass_end, [](Trace&, Event& e) { e.cause = kNull; });
  Trace two = rock().trace;
  two.header.bodies.push_back(two.header.bodies[0]);
  CHECK_THROWS_AS(check_trace(two, "t.json"), InputError);
}
