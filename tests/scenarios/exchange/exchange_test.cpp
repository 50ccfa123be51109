// Models of bodies, wrappers and contacts, and the files that they are written to.
#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/exchange/model.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::exchange {
namespace {

const LrbRep& ball() {
  static const LrbRep rep = bodies::body_of_mesh(generators::generate("ball", {}, 1)).rep;
  return rep;
}

Moment moment_of(const LrbRep& rep, const Wrapper* wrapper, const Pose& pose = {}) {
  Moment m;
  m.title = "test";
  m.bodies = {{&rep, wrapper, pose, nullptr}};
  return m;
}

std::vector<double> column(const Model& model, const Part& part, const char* name) {
  return part.values[model.column(name)];
}

/// The mesh of a part, for the checks that meshes have.
Mesh mesh_of(const Part& part) {
  Mesh mesh;
  mesh.vertices = part.vertices;
  for (std::size_t c = 0; c < part.cell_count(); ++c) {
    std::vector<VertexId> corners;
    for (const std::uint32_t v : part.cell(c)) corners.emplace_back(v);
    mesh.add_face(corners);
  }
  return mesh;
}

/// The run of a shipped scenario at its end, as a model.
struct ShippedRun {
  record::Recording run;
  Model model;
  trace::Totals totals;
  explicit ShippedRun(const char* name, const Wanted& wanted)
      : run(record::record(spec::open_scenario(name), record::kSilent)) {
    const std::size_t step = run.trace.steps.size() - 1;
    const trace::EventId last = record::last_event(run.trace, step),
                         first = run.trace.steps[step].first_event;
    const bool two = run.bodies.size() == 2;
    trace::Cursor cursor = two ? trace::Cursor(run.trace, run.bodies[0].rep, run.bodies[1].rep)
                               : trace::Cursor(run.trace, run.bodies[0].rep);
    cursor.seek(last);
    Moment m;
    m.title = name;
    for (std::size_t i = 0; i < run.bodies.size(); ++i) {
      const Side side = static_cast<Side>(i);
      m.bodies.push_back({&run.bodies[i].rep, &cursor.wrapper(side), cursor.pose(side), nullptr});
    }
    m.events = std::span(run.trace.events).subspan(first, last + 1 - first);
    totals = trace::count_events(*m.events);
    CollideRequest request;
    request.contacts = true;
    CollideResult result;
    if (two)
      result =
          collide(run.bodies[0].rep, cursor.pose(Side::a), run.bodies[1].rep, cursor.pose(Side::b), request);
    m.contacts = result.regions;
    model = make_model(m, wanted);
  }
};

TEST_CASE("models: the body's faces keep their numbers, the wrapper's are its boundary") {
  Wrapper wrapper(ball());
  wrapper.refine(ball().lids(RegionId(0)).empty() ? RegionId(1) : RegionId(0));
  const Model model = make_model(moment_of(ball(), &wrapper), {true, true, false, {true, true}});
  REQUIRE(model.parts.size() == 2);
  const Part &body = model.parts[0], &lids = model.parts[1];
  CHECK(body.name == "A");
  CHECK(lids.name == "A_wrapper");
  REQUIRE(body.cell_count() == ball().real_face_count());
  for (std::size_t f = 0; f < body.cell_count(); ++f) {
    CHECK(column(model, body, "face")[f] == static_cast<double>(f));
    CHECK(column(model, body, "kind")[f] == 1);
    CHECK(column(model, body, "distance")[f] == 0);
    const auto corners = ball().face(FaceId(static_cast<std::uint32_t>(f)));
    const auto cell = body.cell(f);
    REQUIRE(cell.size() == corners.size());
    for (std::size_t i = 0; i < cell.size(); ++i)
      CHECK(body.vertices[cell[i]] == ball().vertices()[corners[i]]);
  }
  const std::vector<FaceId> boundary = wrapper.boundary();
  REQUIRE(lids.cell_count() == boundary.size());
  for (std::size_t i = 0; i < boundary.size(); ++i)
    CHECK(column(model, lids, "face")[i] == boundary[i].value());
  CHECK(check_mesh(mesh_of(lids)).bounds_solid);
}

TEST_CASE("models: a mirrored body is outward-oriented") {
  Pose mirror;
  mirror.r(0, 0) = -1;
  const Model model = make_model(moment_of(ball(), nullptr, mirror), {true, false, false, {true, true}});
  const MeshReport report = check_mesh(mesh_of(model.parts.at(0)));
  CHECK(report.bounds_solid);
  CHECK(check(mesh_of(model.parts[0])).turn_outward() == 0);
}

TEST_CASE("wrappers by number of faces: at most the requested number, ever closer, the body at the end") {
  std::size_t before = 0;
  double off_before = 1e300;
  for (const std::uint32_t most : {30U, 60U, 120U, 10'000'000U}) {
    CAPTURE(most);
    const Wrapper wrapper = resolutions::wrapper_of_faces(ball(), most);
    const std::size_t faces = wrapper.boundary_size();
    CHECK(faces <= most);
    CHECK(faces >= before);
    const Model model = make_model(moment_of(ball(), &wrapper), {false, true, false, {true, true}});
    const std::vector<double> off = column(model, model.parts.at(0), "distance");
    const double largest = *std::max_element(off.begin(), off.end());
    CHECK(largest <= off_before);
    CHECK(check_mesh(mesh_of(model.parts[0])).bounds_solid);
    before = faces;
    off_before = largest;
  }
  CHECK(before == ball().real_face_count());
  CHECK(off_before == 0);
  CHECK_THROWS_AS(resolutions::wrapper_of_faces(ball(), 3), InputError);
}

TEST_CASE("wrappers by layer: the body, and layer by layer the outermost one") {
  CHECK(wrapper_of_layers(ball(), 0).boundary_size() == ball().real_face_count());
  CHECK(wrapper_of_layers(ball(), ball().layer_count()).boundary_size() == ball().outermost_faces().size());
  REQUIRE(ball().layer_count() > 1);
  const Wrapper one = wrapper_of_layers(ball(), 1);
  for (RegionId r = 0; r < ball().region_count(); ++r) CHECK(one.included(r) == (ball().layer(r) == 0));
}

TEST_CASE("runs: counters of faces add up to the step's events, curves to the contact's length") {
  const ShippedRun r("stick_through_wall", {true, true, true, {true, true}});
  REQUIRE(r.model.parts.size() == 5);
  CHECK(r.model.parts[4].name == "contact_curves");
  REQUIRE(r.totals.face_tests > 0);
  // Tested pseudo faces may have been refined: the others are real.
  for (const std::size_t body : {0U, 2U}) {
    const Part& part = r.model.parts[body];
    const auto sum = [&](const char* name) {
      const std::vector<double> values = column(r.model, part, name);
      return std::accumulate(values.begin(), values.end(), 0.0);
    };
    CHECK(sum("contacts") == static_cast<double>(r.totals.contacts));
    CHECK(sum("tests") == sum("hits") + sum("misses"));
    CHECK(sum("tests") <= static_cast<double>(r.totals.face_tests));
    CHECK(sum("hits") >= sum("contacts"));
  }
  const Part& curves = r.model.parts[4];
  double length = 0, reported = 0;
  std::set<double> regions;
  for (std::size_t c = 0; c < curves.cell_count(); ++c) {
    const auto cell = curves.cell(c);
    for (std::size_t i = 0; i + 1 < cell.size(); ++i)
      length += (curves.vertices[cell[i]] - curves.vertices[cell[i + 1]]).norm();
    if (regions.insert(column(r.model, curves, "contact")[c]).second)
      reported += column(r.model, curves, "length")[c];
  }
  CHECK(length > 0);
  CHECK(length == doctest::Approx(reported).epsilon(1e-9));
}

TEST_CASE("PLY: lrbscope's reader finds the same mesh, to the last bit") {
  const Model model = make_model(moment_of(ball(), nullptr), {true, false, false, {true, true}});
  const Mesh expected = mesh_of(model.parts.at(0));
  const test::Folder folder;
  save_model(model, folder / "b.PLY");
  const Mesh read = read_mesh(folder / "b.PLY");
  CHECK(read.vertices == expected.vertices);
  CHECK(read.face_offsets == expected.face_offsets);
  CHECK(read.face_vertices == expected.face_vertices);
}

/// The JSON of a GLB's first chunk, and the bytes of its second.
std::pair<nlohmann::json, std::string> open_glb(const std::string& bytes) {
  const auto word = [&](std::size_t at) {
    std::uint32_t out = 0;
    std::memcpy(&out, bytes.data() + at, sizeof out);
    return out;
  };
  REQUIRE(bytes.substr(0, 4) == "glTF");
  REQUIRE(word(8) == bytes.size());
  const std::uint32_t json = word(12), bin = word(20 + json);
  REQUIRE(20 + json + 8 + bin == bytes.size());
  return {nlohmann::json::parse(bytes.substr(20, json)), bytes.substr(28 + json)};
}

TEST_CASE("GLB: a node per part, triangles of all fans, positions around a centre that nodes restore") {
  const LrbRep box = LrbRep::without_regions(shapes::quad_box({1e6, 0, 0}, {1e6 + 1, 2, 3}), true, false);
  const Model model = make_model(moment_of(box, nullptr), {true, false, false, {true, true}});
  const auto [json, bin] = open_glb(glb_bytes(model, 2));
  CHECK(json["asset"]["version"] == "2.0");
  CHECK(json["nodes"].size() == 2);
  CHECK(json["nodes"][0]["translation"] == nlohmann::json({1e6 + 0.5, 1.5, -1.0}));  // z is up
  CHECK(json["nodes"][1]["name"] == "A");
  const nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
  CHECK(json["accessors"][primitive["indices"].get<int>()]["count"] == 6 * 2 * 3);
  const nlohmann::json& position = json["accessors"][primitive["attributes"]["POSITION"].get<int>()];
  CHECK(position["count"] == 6 * 4);
  CHECK(position["min"] == nlohmann::json({-0.5, -1.0, -1.5}));
  CHECK(position["max"] == nlohmann::json({0.5, 1.0, 1.5}));
  CHECK(json["buffers"][0]["byteLength"] == bin.size());
}

TEST_CASE("2D bodies are exported as lines") {
  const ShippedRun r("figure1", {false, true, false, {true, true}});
  REQUIRE(!r.model.parts.empty());
  for (const Part& part : r.model.parts) CHECK(part.shape == Shape::lines);
  const std::string ply = ply_bytes(r.model);
  const std::string lines = std::to_string(r.model.parts[0].cell_count()) + "\n";
  CHECK(ply.find("element edge " + lines + "property int vertex1\nproperty int vertex2\nelement edge_value " +
                 lines) != std::string::npos);  // trimesh reads no other properties
  CHECK(ply.find("element face 0\n") != std::string::npos);
}

}  // namespace
}  // namespace lrb::exchange
