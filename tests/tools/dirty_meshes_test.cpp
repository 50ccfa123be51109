/// Meshes that are not clean, given to the program: what inspect says, what build does, what query answers.

#include <algorithm>
#include <numbers>
#include <random>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/figure_eight.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/json_lines.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using nlohmann::json;

Mesh moebius() {
  constexpr int kSteps = 9;
  Mesh m;
  for (int i = 0; i < kSteps; ++i) {
    const double u = 2 * std::numbers::pi * i / kSteps;
    for (const double w : {-0.3, 0.3})
      m.vertices.emplace_back((1 + w * std::cos(u / 2)) * std::cos(u),
                              (1 + w * std::cos(u / 2)) * std::sin(u), w * std::sin(u / 2));
    const bool last = i + 1 == kSteps;  // half a turn: the two sides change places
    const VertexId a(2 * i), b(a + 1), c(last ? 1 : a + 2), d(last ? 0 : a + 3);
    m.add_face(std::array{a, c, b});
    m.add_face(std::array{b, c, d});
  }
  return m;
}

enum class Build { rejected, done };

struct Row {
  const char* kind;
  Mesh mesh;
  std::vector<std::string> findings;  ///< each finding from its first word on, in their order
  Build build;
  const char* relation;  ///< of the mesh and a speck at `at`
  Point3 at = {0, 0, 0};
};

std::vector<Row> rows_3d() {
  const Mesh ball = icosphere(1);
  const auto n = static_cast<VertexId>(ball.vertices.size());  // 42; 80 faces
  const Mesh twice = several({ball, ball});
  const std::string meet = "two faces intersect outside their shared edges and corners (";
  return {
      {.kind = "open",
       .mesh = without_faces(ball, {7}),
       .findings = {"an edge has only one face (3 times): edge (by its vertices) "},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "open strip, one-sided",
       .mesh = moebius(),
       .findings = {"an edge has only one face (18 times)",
                    "two adjacent faces are inconsistently oriented (1 time): face 0 and 17"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "crosses itself",
       .mesh = turned_inside_out(figure_eight()),
       .findings = {meet},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {2.6, 0, 0}},
      {.kind = "pieces that cross",
       .mesh = several({ball, translated(ball, {0.7, 0.1, 0.2})}),
       .findings = {meet + "38 times): face "},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {-0.5, 0, 0}},
      {.kind = "pieces that cross, where they do",
       .mesh = several({ball, translated(ball, {0.7, 0.1, 0.2})}),
       .findings = {meet},
       .build = Build::done,
       .relation = "separate",
       .at = {0.35, 0.05, 0.1}},
      {.kind = "non-manifold edge between solids",
       .mesh = welded(several({box(), box({1, 1, 0}, {2, 2, 1})})),
       .findings = {"an edge has more than two faces (1 time): edge (by its vertices) ",
                    "two vertices coincide (2 times): vertex 5 and 8, 6 and 11",
                    "a vertex is not used by any face (2 times)"},
       .build = Build::rejected,
       .relation = "b_inside_a",
       .at = {0.5, 0.5, 0.5}},
      {.kind = "non-manifold edge at a fin",
       .mesh = with_face(ball, {{2, 0, 0}}, {ball.face(0)[0], ball.face(0)[1], n}),
       .findings = {"an edge has only one face (2 times)", "an edge has more than two faces (1 time)", meet},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "non-manifold vertex between solids",
       .mesh = welded(several({box(), box({1, 1, 1}, {2, 2, 2})})),
       .findings = {"a vertex joins two separate fans of faces (1 time): vertex 6",
                    "two vertices coincide (1 time): vertex 6 and 8",
                    "a vertex is not used by any face (1 time)"},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {0.5, 0.5, 0.5}},
      {.kind = "vertices merged across the body",
       .mesh = with_merged(ball, 3, 0),
       .findings = {"a vertex joins two separate fans of faces (1 time): vertex 0",
                    "a vertex is not used by any face (1 time): vertex 3"},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {0, 0, 0.3}},
      {.kind = "duplicate face",
       .mesh = with_doubled(ball, {3}),
       .findings = {"two faces have the same corners (1 time): face 3 and 80",
                    "an edge has more than two faces (3 times)", meet + "1 time): face 3 and 80"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "duplicate face, turned",
       .mesh = with_doubled(ball, {3}, true),
       .findings = {"two faces have the same corners (1 time): face 3 and 80",
                    "an edge has more than two faces (3 times)", meet + "1 time): face 3 and 80"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "all faces twice",
       .mesh = welded(twice),
       .findings = {"two faces have the same corners (80 times): face 0 and 80, 1 and 81, 2 and 82",
                    "an edge has more than two faces (120 times)", meet,
                    "two vertices coincide (42 times): vertex 0",
                    "a vertex is not used by any face (42 times): vertex 42"},
       .build = Build::rejected,
       .relation = "separate"},
      {.kind = "two shells in one place",
       .mesh = twice,
       .findings = {meet, "two vertices coincide (42 times): vertex 0 and 42, 1"},
       .build = Build::done,
       .relation = "separate"},
      {.kind = "two corners in one vertex",
       .mesh = with_face(ball, {}, {0, 0, 1}),
       .findings = {"a face uses a vertex twice (1 time): face 80 (vertex 0)",
                    "a face has no area (1 time): face 80"},
       .build = Build::rejected,
       .relation = "b_inside_a"},
      {.kind = "edge collapsed",
       .mesh = with_merged(ball, ball.face(0)[0], ball.face(0)[1]),
       .findings = {"a face uses a vertex twice (2 times): face 0", "a face has no area (2 times): face 0",
                    "a vertex is not used by any face (1 time)"},
       .build = Build::rejected,
       .relation = "b_inside_a"},
      {.kind = "corners on a line",
       .mesh =
           with_face(with_face(without_faces(tetrahedron(), {0}), {{0.5, 0, 0}}, {1, 0, 4}), {}, {0, 2, 4}),
       .findings = {"a face has no area (1 time): face 3", "an edge has only one face (3 times)", meet},
       .build = Build::rejected,
       .relation = "undefined",
       .at = {0.2, 0.2, 0.2}},
      {.kind = "duplicate vertices",
       .mesh = as_soup(ball),
       .findings = {},
       .build = Build::done,
       .relation = "b_inside_a"},
      {.kind = "duplicate vertices and a hole",
       .mesh = as_soup(without_faces(ball, {7})),
       .findings = {"an edge has only one face (3 times): edge (by its vertices) "},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "unused vertices",
       .mesh = with_vertices(ball, {{9, 9, 9}, {8, 8, 8}}),
       .findings = {"a vertex is not used by any face (2 times): vertex 42, 43"},
       .build = Build::done,
       .relation = "b_inside_a"},
      {.kind = "inconsistent orientation",
       .mesh = with_flipped(ball, {7, 50}),
       .findings = {"two adjacent faces are inconsistently oriented (6 times): face "},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "inside out",
       .mesh = turned_inside_out(ball),
       .findings = {"a component is inside out (1 time): component (by its first face) 0"},
       .build = Build::done,
       .relation = "b_inside_a"},
      {.kind = "isolated piece, closed",
       .mesh = several({ball, icosphere(0, 0.2, {3, 0, 0})}),
       .findings = {},
       .build = Build::done,
       .relation = "b_inside_a"},
      {.kind = "isolated piece, open",
       .mesh = with_face(ball, {{3, 0, 0}, {3, 1, 0}, {3, 0, 1}}, {n, VertexId(n + 1), VertexId(n + 2)}),
       .findings = {"an edge has only one face (3 times): edge (by its vertices) 42-43, 42-44, 43-44"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "nested, facing out",
       .mesh = several({ball, icosphere(1, 0.4)}),
       .findings = {"a component is inside out (1 time): component (by its first face) 80"},
       .build = Build::done,
       .relation = "separate"},
      {.kind = "nested, a void",
       .mesh = several({ball, turned_inside_out(icosphere(1, 0.4))}),
       .findings = {},
       .build = Build::done,
       .relation = "separate"},
      {.kind = "in the wall round a void",
       .mesh = several({ball, turned_inside_out(icosphere(1, 0.4))}),
       .findings = {},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {0, 0, 0.6}},
      {.kind = "huge",
       .mesh = scaled(ball, 1e300),
       .findings = {},
       .build = Build::done,
       .relation = "b_inside_a"},
      {.kind = "far away",
       .mesh = translated(ball, {1e16, 0, 0}),
       .findings = {"a face has no area (", meet, "two vertices coincide ("},
       .build = Build::rejected,
       .relation = "separate"},
      {.kind = "concave polygons",
       .mesh = hard::cog(40),
       .findings = {"a polygon is not convex (2 times): face ", meet},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {0.1, 0.2, 0.5}},
      {.kind = "concave polygon, open",
       .mesh = with_face(tetrahedron(), {{0.1, 0.1, 2}, {3, 0, 2}, {0, 0, 2}, {0, 3, 2}}, {4, 5, 6, 7}),
       .findings = {"a polygon is not convex (1 time): face 4", "an edge has only one face (4 times)"},
       .build = Build::rejected,
       .relation = "undefined",
       .at = {0.2, 0.2, 0.2}},
  };
}

std::vector<Row> rows_2d() {
  const Mesh round = circle(12);
  Mesh star;
  star.dim = 2;
  star.vertices = circle(5).vertices;
  for (int i = 0; i < 5; ++i) star.add_face(std::array{VertexId(2 * i % 5), VertexId(2 * (i + 1) % 5)});
  return {
      {.kind = "2D, open",
       .mesh = without_faces(round, {0}),
       .findings = {"a vertex has only one segment (2 times): vertex 0, 1"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "2D, crosses itself",
       .mesh = star,
       .findings = {"two segments intersect outside their shared ends (5 times): segment 0 and 2"},
       .build = Build::done,
       .relation = "b_inside_a",
       .at = {0.7, 0, 0}},
      {.kind = "2D, crosses itself, where it does",
       .mesh = star,
       .findings = {"two segments intersect"},
       .build = Build::done,
       .relation = "separate"},
      {.kind = "2D, branch",
       .mesh = with_face(round, {{2, 0, 0}}, {0, 12}),
       .findings = {"a vertex has only one segment (1 time): vertex 12",
                    "a vertex has more than two segments (1 time): vertex 0"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "2D, duplicate segment",
       .mesh = with_doubled(round, {3}),
       .findings = {"two segments have the same ends (1 time): segment 3 and 12",
                    "a vertex has more than two segments (2 times)", "two segments intersect"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "2D, no length",
       .mesh = with_face(round, {}, {2, 2}),
       .findings = {"a segment uses a vertex twice (1 time): segment 12",
                    "a segment has no length (1 time): segment 12"},
       .build = Build::rejected,
       .relation = "b_inside_a"},
      {.kind = "2D, inconsistent orientation",
       .mesh = with_flipped(round, {4}),
       .findings = {"two adjacent segments are inconsistently oriented (2 times): segment 3 and 4, 4 and 5"},
       .build = Build::rejected,
       .relation = "undefined"},
      {.kind = "2D, inside out",
       .mesh = turned_inside_out(round),
       .findings = {"a component is inside out (1 time)"},
       .build = Build::done,
       .relation = "b_inside_a"},
  };
}

std::string pose_line(const Pose& p) {
  std::ostringstream out;
  out.precision(17);
  for (int i = 0; i < 3; ++i)
    out << p.r(i, 0) << " " << p.r(i, 1) << " " << p.r(i, 2) << " " << p.t[i] << (i < 2 ? " " : "\n");
  return out.str();
}

std::vector<json> answers(const Folder& folder, const std::string& a, const std::string& b,
                          const std::vector<Pose>& poses, std::string& notes) {
  std::string text;
  for (const Pose& p : poses) text += pose_line(p);
  folder.write("poses.txt", text);
  const Outcome o = run(folder, {"query", a, b, "--poses", "poses.txt"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  notes = o.err;
  std::vector<json> out = json_lines(o.out);
  REQUIRE(out.size() == poses.size());
  return out;
}

/// The pairs of an answer are those of brute force over the faces as they are in the file.
void check_pairs(const json& answer, const Mesh& a, const Mesh& b, const Pose& pose) {
  const BruteForceResult slow = brute_force(LrbRep::without_regions(a, false, true), Pose{},
                                            LrbRep::without_regions(b, false, true), pose);
  CHECK(answer["pairs"] == slow.pairs.size());
  CHECK(answer["fingerprint"] == trace::to_hex(fingerprint(slow.pairs)));
}

bool is_joined(const Row& row) {
  Mesh m = row.mesh;
  return join_corners(m).any();
}

void check_inspect(const Folder& folder, const Row& row) {
  const Outcome o = run(folder, {"inspect", "m.obj", "--json"});
  REQUIRE(o.code == 0);
  CHECK(o.err.starts_with(is_joined(row) ? "note: m.obj: merged coincident vertices: " : ""));
  CHECK(o.error_lines() == is_joined(row));
  const json j = json::parse(o.out);
  CAPTURE(j["findings"].dump(1));
  CHECK(j["findings"].size() == row.findings.size());
  for (std::size_t i = 0; i < std::min(row.findings.size(), j["findings"].size()); ++i)
    CHECK(j["findings"][i]["text"].get<std::string>().starts_with("m.obj: " + row.findings[i]));
  CHECK(j["buildable"] == (row.build == Build::done));
  CHECK(j["queryable"] == true);
  CHECK(j["bounds_solid"] == (std::string(row.relation) != "undefined"));
}

void check_build(const Folder& folder, const Row& row) {
  const Outcome o = run(folder, {"build", "m.obj", "-o", "m.lrb", "--json"});
  CAPTURE(o.err);
  if (row.build == Build::rejected) {
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(o.error_lines() == 1);
    CHECK(o.err.starts_with("lrbscope: m.obj: cannot build an LRB-rep: "));
    CHECK_FALSE(std::filesystem::exists(folder / "m.lrb"));
    return;
  }
  REQUIRE(o.code == 0);
  const json j = json::parse(o.out);
  CHECK(j["valid"] == true);
  CHECK(j["real_faces"] == row.mesh.face_count());
  const bool turned = std::any_of(row.findings.begin(), row.findings.end(), [](const std::string& f) {
    return f.starts_with("a component is inside out");
  });
  const auto of_the_mesh = std::count_if(j["notes"].begin(), j["notes"].end(), [](const json& note) {
    const auto text = note.get<std::string>();
    return text.find(": merged ") != std::string::npos || text.find(": flipped ") != std::string::npos;
  });
  CHECK(of_the_mesh == int{turned} + int{is_joined(row)});
  std::filesystem::remove(folder / "m.lrb");
}

void check_query(const Folder& folder, const Row& row, const Mesh& speck) {
  const double size = row.mesh.vertices[0].lpNorm<Eigen::Infinity>();
  Pose held = Pose::translation(row.at), across = Pose::translation(row.mesh.vertices[row.mesh.face(0)[0]]),
       away;
  away.t = Point3(5, 7, 0) * std::max(1.0, size);
  std::string notes;
  const std::vector<json> got = answers(folder, "m.obj", "speck.obj", {held, across, away}, notes);
  CHECK(got[0]["relation"] == row.relation);
  CHECK(got[0]["pairs"] == 0);
  CHECK(got[2]["relation"] == "separate");  // far away: the boxes in the world are disjoint
  CHECK(got[1]["pairs"] > 0);
  check_pairs(got[1], row.mesh, speck, across);
  const std::vector<json> swapped = answers(folder, "speck.obj", "m.obj", {Pose{}}, notes);
  check_pairs(swapped[0], speck, row.mesh, Pose{});
  CHECK((notes.find("queries will not use regions") != std::string::npos) == (row.build == Build::rejected));
}

void check_row(const Row& row) {
  CAPTURE(std::string(row.kind));
  const Folder folder;
  write_mesh(row.mesh, folder / "m.obj");
  const std::string bytes = slurp(folder / "m.obj");
  const Mesh speck = row.mesh.dim == 2 ? circle(5, 0.05) : icosphere(0, 0.05);
  write_mesh(speck, folder / "speck.obj");
  check_inspect(folder, row);
  check_build(folder, row);
  check_query(folder, row, speck);
  CHECK(slurp(folder / "m.obj") == bytes);
}

}  // namespace

TEST_CASE("faults, kind by kind: inspect, build, query") {
  for (const Row& row : rows_3d()) check_row(row);
}

TEST_CASE("coincident vertices stay separate on request") {
  const Folder folder;
  write_mesh(as_soup(icosphere(1)), folder / "m.obj");
  const Outcome o = run(folder, {"inspect", "m.obj", "--json", "--no-join"});
  CHECK(o.err.empty());
  const json findings = json::parse(o.out)["findings"];
  REQUIRE(findings.size() == 3);
  CHECK(findings[0]["text"].get<std::string>().starts_with("m.obj: an edge has only one face (240 times)"));
  CHECK(findings[2]["text"].get<std::string>().starts_with("m.obj: two vertices coincide (198 times)"));
  CHECK(findings[0]["kind"] == "open_edge");
  CHECK(findings[0]["count"] == 240);
  CHECK(findings[0]["elements"].size() == 240);  // all, not the few that the text names
  CHECK(findings[0]["elements"][239][1] == 239);
  CHECK(std::is_sorted(findings[0]["elements"].begin(), findings[0]["elements"].end()));
  CHECK(findings[2]["kind"] == "duplicate_vertex");
  CHECK(findings[2]["elements"].size() == 198);
  check_rejected(folder, {"build", "m.obj", "--no-join"});
  std::string notes;
  folder.write("pose.txt", pose_line(Pose::translation({0, 0, 0.4})));
  for (const bool apart : {false, true}) {
    std::vector<std::string> words = {"query", "m.obj", "m.obj", "--poses", "pose.txt"};
    if (apart) words.emplace_back("--no-join");
    const Outcome q = run(folder, words);
    CHECK((q.err.find("merged coincident vertices") == std::string::npos) == apart);
    const json answer = json::parse(q.out);
    check_pairs(answer, as_soup(icosphere(1)), as_soup(icosphere(1)), Pose::translation({0, 0, 0.4}));
    CHECK(answer["relation"] == "crossing");
  }
}

TEST_CASE("faults of 2D meshes, kind by kind: inspect, build, query") {
  for (const Row& row : rows_2d()) check_row(row);
}

namespace {

struct Spoiled {
  const char* how;
  Mesh mesh;
};

/// A real model, spoiled as scans and their tools do it.
std::vector<Spoiled> spoil(const Mesh& m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::set<FaceId> some;
  while (some.size() < 9) some.insert(static_cast<FaceId>(random() % m.face_count()));
  const FaceId f = *some.begin();
  const auto any = static_cast<VertexId>(random() % m.vertices.size());
  Mesh noisy = m;
  for (Point3& x : noisy.vertices)
    for (int axis = 0; axis < 3; ++axis)
      x[axis] += 0.02 * (static_cast<double>(random() % 1000) / 1000 - 0.5);
  return {{"faces deleted", without_faces(m, some)},
          {"faces flipped", with_flipped(m, some)},
          {"faces doubled", with_doubled(m, some)},
          {"vertices merged", with_merged(m, any, m.face(f)[0])},
          {"edge collapsed", with_merged(m, m.face(f)[1], m.face(f)[0])},
          {"vertices shaken until it crosses itself", std::move(noisy)}};
}

}  // namespace

TEST_CASE("damaged real models: exact pairs, built or rejected in one line" *
          doctest::test_suite("shared meshes")) {
  const auto meshes = shared_meshes();
  const Mesh speck = icosphere(0, 1);
  for (const char* name : {"spot", "cheburashka"}) {
    const Mesh model = read_mesh((meshes / (std::string(name) + ".obj")).string());
    for (const auto& spoiled : spoil(model, 5)) {
      const auto& [name_of_fault, mesh] = spoiled;
      const auto& how = name_of_fault;  // clang 14 captures no structured binding
      CAPTURE(std::string(name));
      CAPTURE(std::string(how));
      const Folder folder;
      write_mesh(mesh, folder / "m.obj");
      write_mesh(speck, folder / "speck.obj");
      const json report = json::parse(run(folder, {"inspect", "m.obj", "--json"}).out);
      CHECK_FALSE(report["findings"].empty());
      const Outcome built = run(folder, {"build", "m.obj", "--json"});
      CAPTURE(built.err);
      CHECK(built.code == (report["buildable"] == true ? 0 : 2));
      CHECK((built.code == 0 || built.error_lines() == 1));
      if (built.code == 0) CHECK(json::parse(built.out)["valid"] == true);
      const Point3 x = mesh.vertices[mesh.face(0)[0]], y = mesh.vertices[mesh.face(99)[1]];
      Pose near, inside;
      near.r *= 0.1 * x.norm();
      near.t = x;
      inside.r *= 0.2 * y.norm();
      inside.t = 0.9 * y;
      std::string notes;
      const std::vector<json> got = answers(folder, "m.obj", "speck.obj", {near, inside}, notes);
      check_pairs(got[0], mesh, speck, near);
      check_pairs(got[1], mesh, speck, inside);
    }
  }
}

}  // namespace lrb::test
