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

/// A mesh and the expected answers: its findings with their counts ("*": any number), whether it can be
/// built, and the relation of it and a speck at `at`.
struct Row {
  const char* kind;
  Mesh mesh;
  std::string findings;
  bool built;
  const char* relation;
  Point3 at = {0, 0, 0};
};

std::vector<Row> rows_3d() {
  constexpr const char *kNone = "undefined", *kInside = "b_inside_a", *kApart = "separate";
  const Mesh ball = icosphere(1);
  const auto n = static_cast<VertexId>(ball.vertices.size());  // 42; 80 faces
  const Mesh twice = several({ball, ball}), crossing = several({ball, translated(ball, {0.7, 0.1, 0.2})});
  const Mesh with_void = several({ball, turned_inside_out(icosphere(1, 0.4))});
  return {
      {"open", without_faces(ball, {7}), "open_edge 3", false, kNone},
      {"open strip, one-sided", moebius(), "open_edge 18, flipped_face 1", false, kNone},
      {"crosses itself",
       turned_inside_out(figure_eight()),
       "self_intersection *",
       true,
       kInside,
       {2.6, 0, 0}},
      {"pieces that cross", crossing, "self_intersection 38", true, kInside, {-0.5, 0, 0}},
      {"pieces that cross, where they do", crossing, "self_intersection 38", true, kApart, {0.35, 0.05, 0.1}},
      {"non-manifold edge between solids",
       welded(several({box(), box({1, 1, 0}, {2, 2, 1})})),
       "non_manifold_edge 1, duplicate_vertex 2, unused_vertex 2",
       false,
       kInside,
       {0.5, 0.5, 0.5}},
      {"non-manifold edge at a fin", with_face(ball, {{2, 0, 0}}, {ball.face(0)[0], ball.face(0)[1], n}),
       "open_edge 2, non_manifold_edge 1, self_intersection *", false, kNone},
      {"non-manifold vertex between solids",
       welded(several({box(), box({1, 1, 1}, {2, 2, 2})})),
       "non_manifold_vertex 1, duplicate_vertex 1, unused_vertex 1",
       true,
       kInside,
       {0.5, 0.5, 0.5}},
      {"vertices merged across the body",
       with_merged(ball, 3, 0),
       "non_manifold_vertex 1, unused_vertex 1",
       true,
       kInside,
       {0, 0, 0.3}},
      {"duplicate face", with_doubled(ball, {3}),
       "duplicate_face 1, non_manifold_edge 3, self_intersection 1", false, kNone},
      {"duplicate face, turned", with_doubled(ball, {3}, true),
       "duplicate_face 1, non_manifold_edge 3, self_intersection 1", false, kNone},
      {"all faces twice", welded(twice),
       "duplicate_face 80, non_manifold_edge 120, self_intersection *, duplicate_vertex 42, unused_vertex 42",
       false, kApart},
      {"two shells in one place", twice, "self_intersection *, duplicate_vertex 42", true, kApart},
      {"two corners in one vertex", with_face(ball, {}, {0, 0, 1}), "repeated_corner 1, zero_area_face 1",
       false, kInside},
      {"edge collapsed", with_merged(ball, ball.face(0)[0], ball.face(0)[1]),
       "repeated_corner 2, zero_area_face 2, unused_vertex 1", false, kInside},
      {"corners on a line",
       with_face(with_face(without_faces(tetrahedron(), {0}), {{0.5, 0, 0}}, {1, 0, 4}), {}, {0, 2, 4}),
       "zero_area_face 1, open_edge 3, self_intersection *",
       false,
       kNone,
       {0.2, 0.2, 0.2}},
      {"duplicate vertices", as_soup(ball), "", true, kInside},
      {"duplicate vertices and a hole", as_soup(without_faces(ball, {7})), "open_edge 3", false, kNone},
      {"unused vertices", with_vertices(ball, {{9, 9, 9}, {8, 8, 8}}), "unused_vertex 2", true, kInside},
      {"inconsistent orientation", with_flipped(ball, {7, 50}), "flipped_face 6", false, kNone},
      {"inside out", turned_inside_out(ball), "inside_out 1", true, kInside},
      {"isolated piece, closed", several({ball, icosphere(0, 0.2, {3, 0, 0})}), "", true, kInside},
      {"isolated piece, open",
       with_face(ball, {{3, 0, 0}, {3, 1, 0}, {3, 0, 1}}, {n, VertexId(n + 1), VertexId(n + 2)}),
       "open_edge 3", false, kNone},
      {"nested, facing out", several({ball, icosphere(1, 0.4)}), "inside_out 1", true, kApart},
      {"nested, a void", with_void, "", true, kApart},
      {"in the wall round a void", with_void, "", true, kInside, {0, 0, 0.6}},
      {"huge", scaled(ball, 1e300), "", true, kInside},
      {"far away", translated(ball, {1e16, 0, 0}),
       "zero_area_face *, self_intersection *, duplicate_vertex *", false, kApart},
      {"concave polygons", hard::cog(40), "non_convex_face 2", true, kInside, {0.1, 0.2, 0.5}},
      {"concave polygon, open",
       with_face(tetrahedron(), {{0.1, 0.1, 2}, {3, 0, 2}, {0, 0, 2}, {0, 3, 2}}, {4, 5, 6, 7}),
       "non_convex_face 1, open_edge 4",
       false,
       kNone,
       {0.2, 0.2, 0.2}},
  };
}

std::vector<Row> rows_2d() {
  constexpr const char *kNone = "undefined", *kInside = "b_inside_a", *kApart = "separate";
  const Mesh round = circle(12);
  Mesh star;
  star.dim = 2;
  star.vertices = circle(5).vertices;
  for (int i = 0; i < 5; ++i) star.add_face(std::array{VertexId(2 * i % 5), VertexId(2 * (i + 1) % 5)});
  return {
      {"2D, open", without_faces(round, {0}), "open_edge 2", false, kNone},
      {"2D, crosses itself", star, "self_intersection 5", true, kInside, {0.7, 0, 0}},
      {"2D, crosses itself, where it does", star, "self_intersection 5", true, kApart},
      {"2D, branch", with_face(round, {{2, 0, 0}}, {0, 12}), "open_edge 1, non_manifold_edge 1", false,
       kNone},
      {"2D, duplicate segment", with_doubled(round, {3}),
       "duplicate_face 1, non_manifold_edge 2, self_intersection *", false, kNone},
      {"2D, no length", with_face(round, {}, {2, 2}), "repeated_corner 1, zero_area_face 1", false, kInside},
      {"2D, inconsistent orientation", with_flipped(round, {4}), "flipped_face 2", false, kNone},
      {"2D, inside out", turned_inside_out(round), "inside_out 1", true, kInside},
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

/// Returns the findings as in a row's, with "*" for the counts that it does not state.
std::string findings_of(const json& report, const std::string& expected) {
  std::string out;
  for (const json& finding : report["findings"]) {
    const std::string kind = finding["kind"].get<std::string>() + " ";
    const bool any = expected.find(kind + "*") != std::string::npos;
    out += (out.empty() ? "" : ", ") + kind + (any ? "*" : finding["count"].dump());
  }
  return out;
}

void check_inspect(const Folder& folder, const Row& row) {
  const Outcome o = run(folder, {"inspect", "m.obj", "--json"});
  REQUIRE(o.code == 0);
  CHECK(o.err.starts_with(is_joined(row) ? "note: m.obj: merged coincident vertices: " : ""));
  CHECK(o.error_lines() == is_joined(row));
  const json j = json::parse(o.out);
  CHECK(findings_of(j, row.findings) == row.findings);
  CHECK(j["buildable"] == row.built);
  CHECK(j["queryable"] == true);
  CHECK(j["bounds_solid"] == (std::string(row.relation) != "undefined"));
}

void check_build(const Folder& folder, const Row& row) {
  const Outcome o = run(folder, {"build", "m.obj", "-o", "m.lrb", "--json"});
  CAPTURE(o.err);
  if (!row.built) {
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
  CHECK((notes.find("queries will not use regions") != std::string::npos) == !row.built);
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

TEST_CASE("real models: few outer faces, little overhead, proven" * doctest::test_suite("shared meshes")) {
  const Folder folder;
  for (const char* name : {"spot", "homer", "fandisk", "cheburashka", "rocker-arm"}) {
    CAPTURE(std::string(name));
    const auto file = std::filesystem::absolute(shared_meshes() / (std::string(name) + ".obj")).string();
    const json j = json::parse(run(folder, {"build", file, "--json"}).out);
    CHECK(j["valid"] == true);
    CHECK(j["outer_faces"].get<int>() <= 20);
    CHECK(j["total_faces"].get<double>() <= 2.0 * j["real_faces"].get<double>());
    CHECK(j["volume_outer"].get<double>() <= 1.4 * j["volume_hull"].get<double>());
    CHECK(j["bytes_per_real_face"].get<double>() <= 300);
  }
}

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
