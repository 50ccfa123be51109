/// Shrinking cases on which methods fail: sizes, that the result still fails, and the folder that is written.

#include "bench/stability/minimise.hpp"

#include <array>
#include <cstdlib>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/cases/families.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/stability/saved_case.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/program.hpp"
#include "tests/support/workers.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

using namespace lrb;
using namespace lrb::stability;
using lrb::test::Folder;
using lrb::test::run;
using lrb::test::slurp;
using lrb::test::worker_method;
using lrb::test::WorkerPrograms;

namespace {

/// The answer of an engine that is right, except that `spoil` changes it.
template <class Spoil>
Replay spoilt_answer(const CaseMeshes& c, const Spoil& spoil) {
  const RightAnswer right = expected_answer(case_of(c));
  Replay out;
  out.expected = right.pairs;
  out.answered = right.pairs;
  out.record.expected = right.pairs.size();
  out.record.relation = out.record.expected_relation = to_string(right.relation);
  spoil(out, right);
  return out;
}

const char* const kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

/// Asks lrbscope's exact query about the files of a folder.
nlohmann::json pairs_of_files(const Folder& folder, const std::string& where) {
  folder.write("identity.txt", kIdentity);
  return nlohmann::json::parse(run(folder, {"-q", "query", where + "/a_world.obj", where + "/b_world.obj",
                                            "--poses", "identity.txt", "--pairs"})
                                   .out)["list"];
}

}  // namespace

TEST_CASE("bits of numbers") {
  CHECK(bits_of(0) == 0);
  CHECK(bits_of(1) == 1);
  CHECK(bits_of(0.5) == 1);
  CHECK(bits_of(-1) == 2);
  CHECK(bits_of(2) == 2);
  CHECK(bits_of(3) == 2);
  CHECK(bits_of(0.75) == 2);
  CHECK(bits_of(1.5) == 2);
  CHECK(bits_of(0x1p53) == 54);
  CHECK(bits_of(0x1p-53) == 53);
  CHECK(bits_of(0.1) == 55);
  CHECK(bits_of(5e-324) == 1074);
}

TEST_CASE("an engine that misses one pair of triangles is shrunk to two triangles, in the same way twice") {
  const cases::Case c = cases::make_case(*cases::find_family("identical"), 1, 10, 0);
  std::set<std::string> results;
  for (int round = 0; round < 2; ++round) {
    std::uint64_t calls = 0;
    const Minimised m = minimise(meshes_of(c), [&](const CaseMeshes& meshes) {
      ++calls;
      return spoilt_answer(meshes, [](Replay& answer, const RightAnswer& right) {
        if (right.pairs.empty()) return;
        answer.answered->erase(answer.answered->begin());
        answer.record.missed = 1;
        answer.record.outcome = Outcome::wrong;
      });
    });
    CHECK(m.before.simplices > 20);
    CHECK(m.after.simplices == 2);
    CHECK(m.after.poses == 0);
    CHECK(m.after.bits <= 12);  // every contact is missed: {0, 1/2, 1} are enough coordinates
    CHECK(m.complete);
    CHECK(m.calls == calls);
    CHECK(m.kind == failure_of(case_of(m.meshes), m.answer));
    for (const Mesh* mesh : {&m.meshes.a, &m.meshes.b})
      CHECK(check_mesh(*mesh, false)[MeshFault::zero_area_face].count == 0);
    std::string text;
    for (const Mesh* mesh : {&m.meshes.a, &m.meshes.b})
      for (const Eigen::Vector3d& v : mesh->vertices)
        for (int k = 0; k < 3; ++k) text += std::to_string(v[k]) + " ";
    results.insert(text);
  }
  CHECK(results.size() == 1);
}

TEST_CASE("an engine that takes a body inside another for separate is shrunk to two tetrahedra") {
  CaseMeshes c{shapes::icosphere(2), shapes::scaled(shapes::icosphere(1), 0.25), {}, {}};
  c.pose_b = Pose::rotation({1, 2, 3}, 0.7, {0.01, 0.02, 0.03});
  const auto ask = [](const CaseMeshes& meshes) {
    return spoilt_answer(meshes, [](Replay& answer, const RightAnswer& right) {
      if (right.relation != Relation::b_inside_a) return;
      answer.record.relation = "separate";
      answer.record.outcome = Outcome::wrong;
    });
  };
  const Minimised m = minimise(c, ask);
  CHECK(m.kind == FailureKind::relation);
  CHECK(m.before.simplices == 400);
  CHECK(m.after.simplices == 8);
  CHECK(m.after.vertices == 8);
  CHECK(m.after.poses == 0);
  CHECK(m.after.bits < 60);
  CHECK(check_mesh(m.meshes.a, false).bounds_solid);
  CHECK(failure_of(case_of(m.meshes), ask(m.meshes)) == FailureKind::relation);
}

TEST_CASE("a polygon whose fan has triangles without area is shrunk") {
  Mesh square = shapes::quad_box();  // with a corner more in the middle of an edge
  square.vertices.emplace_back(
      (square.vertices[square.face(FaceId(0))[0]] + square.vertices[square.face(FaceId(0))[1]]) / 2);
  Mesh mesh;
  mesh.vertices = square.vertices;
  for (FaceId f = 0; f < square.face_count(); ++f) {
    std::vector<VertexId> corners(square.face(f).begin(), square.face(f).end());
    if (f == FaceId(0)) corners.insert(corners.begin() + 1, VertexId(square.vertices.size() - 1));
    mesh.add_face(corners);
  }
  REQUIRE(check_mesh(mesh, false)[MeshFault::zero_area_face].count == 0);
  const Minimised m =
      minimise({mesh, mesh, {}, Pose::translation({0.5, 0.25, 0.125})}, [](const CaseMeshes& meshes) {
        return spoilt_answer(meshes, [](Replay& answer, const RightAnswer& right) {
          answer.answered->clear();
          answer.record.missed = right.pairs.size();
          if (!right.pairs.empty()) answer.record.outcome = Outcome::wrong;
        });
      });
  CHECK(m.before.simplices == 26);
  CHECK(m.after.simplices == 2);
}

TEST_CASE("the kind of a failure is kept, and calls are bounded") {
  const cases::Case c = cases::make_case(*cases::find_family("lattice"), 1, 10, 1);
  REQUIRE(expected_answer(c).pairs.size() > 4);
  // Crosses and touches are missed; only the first kind may remain.
  const auto missing_all = [](const CaseMeshes& meshes) {
    return spoilt_answer(meshes, [](Replay& answer, const RightAnswer& right) {
      answer.answered->clear();
      answer.record.missed = right.pairs.size();
      if (!right.pairs.empty()) answer.record.outcome = Outcome::wrong;
    });
  };
  const Minimised m = minimise(meshes_of(c), missing_all);
  CHECK(m.kind == failure_of(c, missing_all(meshes_of(c))));
  CHECK(failure_of(case_of(m.meshes), m.answer) == m.kind);
  CHECK(m.after.simplices == 2);
  // A method that never answers.
  std::uint64_t calls = 0;
  MinimiseOptions few;
  few.max_calls = 20 * kCallsOfTimeout;
  const Minimised late = minimise(
      meshes_of(c),
      [&](const CaseMeshes&) {
        ++calls;
        Replay answer;
        answer.record.outcome = Outcome::timed_out;
        return answer;
      },
      few);
  CHECK(late.kind == FailureKind::times_out);
  CHECK(calls <= 20);
  CHECK(!late.complete);
  CHECK(late.after.simplices < late.before.simplices);
  // An engine whose answer depends on the case before: none is taken that fails only then.
  MinimiseOptions confirming;
  confirming.confirm = [&](const CaseMeshes& meshes) {
    return meshes.a.face_count() + meshes.b.face_count() > 9
               ? missing_all(meshes)
               : spoilt_answer(meshes, [](Replay&, const RightAnswer&) {});
  };
  CHECK(minimise(meshes_of(c), missing_all, confirming).after.simplices == 10);
  // A right answer.
  CHECK_THROWS_AS(minimise(meshes_of(c),
                           [](const CaseMeshes& meshes) {
                             return spoilt_answer(meshes, [](Replay&, const RightAnswer&) {});
                           }),
                  InputError);
}

TEST_CASE("a minimised case of every family fails again when it is loaded") {
  const WorkerPrograms workers;
  const workers::WorkerMethod plain = worker_method("plain");
  int minimised = 0, flat = 0;
  for (const cases::Family& f : cases::all_families()) {
    CAPTURE(f.name);
    if (f.both_ways) continue;
    for (std::uint64_t i = 0; i < 8; ++i) {
      const cases::Case c = cases::make_case(f, 1, 8, i);
      CaseWorker worker(plain, 20);
      Replay first;
      try {
        first = worker.ask(meshes_of(c));
      } catch (const InputError&) {
        continue;  // coordinates that are not finite
      }
      if (failure_of(c, first) == FailureKind::none) continue;
      const Minimised m =
          minimise(meshes_of(c), [&](const CaseMeshes& meshes) { return worker.ask(meshes); });
      CHECK(m.after <= m.before);
      CHECK(m.after.simplices == 2);
      const Folder folder;
      const std::vector<std::string> files = save_counterexample({m, plain, "a command"}, folder / "case");
      CHECK(files.size() == 7);
      for (const std::string& file : files) CHECK(std::filesystem::exists(folder / ("case/" + file)));
      const SavedCase saved = load_case(folder / "case");
      const Replay again = CaseWorker(plain, 20).ask(saved.meshes);
      CHECK(again.record.outcome == Outcome::wrong);
      CHECK(failure_of(case_of(saved.meshes), again) == m.kind);
      CHECK(size_of(saved.meshes) == m.after);
      ++minimised;
      flat += saved.meshes.a.dim == 2;
      break;
    }
  }
  CHECK(minimised > 15);
  CHECK(flat > 0);
}

TEST_CASE("lrbscope stability --minimise: the folder, its proof, the same bytes twice, and the case again") {
  const WorkerPrograms workers;
  const bool has_fcl = worker_method("fcl").column.present;
  for (const auto& [name, family, difficulty, index] : {std::array{"plain", "touch", "8", "4"},
                                                        {"fake-miss", "identical", "10", "0"},
                                                        {"fake-crash", "identical", "10", "0"},
                                                        {"fcl", "identical", "10", "9"}}) {
    const std::string method = name;
    CAPTURE(method);
    if (method == "fcl" && !has_fcl) continue;
    const Folder one, two;
    const std::vector<std::string> command = {"-q",         "stability",    "--family", family,   "--method",
                                              name,         "--difficulty", difficulty, "--only", index,
                                              "--minimise", "--save",       "small"};
    const test::Outcome o = run(one, command);
    CAPTURE(o.err);
    REQUIRE(o.code == 1);
    CHECK(o.out.find("\n  after: 2 triangles, 6 vertices, ") != std::string::npos);
    CHECK(o.out.find("\nsmall/report.md\n") != std::string::npos);
    REQUIRE(run(two, command).code == 1);
    REQUIRE(one.tree() == two.tree());
    for (const char* file : {"a.obj", "b.obj", "case.json", "report.md", "picture.png"}) {
      CAPTURE(file);
      CHECK(!slurp(one / (std::string("small/") + file)).empty());
      CHECK(slurp(one / (std::string("small/") + file)) == slurp(two / (std::string("small/") + file)));
    }
    const auto saved = nlohmann::json::parse(slurp(one / "small/case.json"));
    CHECK(saved["family"] == family);
    CHECK(std::filesystem::exists(one.path / "small/fcl.cpp") == (name == std::string("fcl")));
    CHECK(saved["minimised"]["after"]["simplices"] == 2);
    CHECK(pairs_of_files(one, "small") == saved["expected"]["pairs"]);
    CHECK(saved["proof"]["intersect"] == !saved["expected"]["pairs"].empty());
    const std::string report = slurp(one / "small/report.md");
    for (const char* part : {"## Meshes", "\nv ", "\nf 1 2 3\n", "## Called", "## Expected", "exactly",
                             "## Found", "## Versions", "--minimise"})
      CHECK(report.find(part) != std::string::npos);
    const test::Outcome again = run(one, {"stability", "--saved", "small", "--method", name});
    CHECK(again.code == 1);
    CHECK(again.out.find(std::string(name) + ": " +
                         (name == std::string("fake-crash") ? "crashed" : "wrong")) != std::string::npos);
    const test::Outcome ours = run(one, {"stability", "--saved", "small", "--method", "ours", "--pairs"});
    CHECK(ours.code == 0);
    CHECK(ours.out.find("ours: right") != std::string::npos);
  }
}

TEST_CASE("lrbscope stability --minimise, --saved: invalid arguments and folders") {
  const WorkerPrograms workers;
  const Folder folder;
  std::filesystem::create_directories(folder.path / "broken");
  folder.write("broken/case.json", "{\"pose_a\":[1,2]}");
  std::filesystem::create_directories(folder.path / "text");
  folder.write("text/case.json", "poses");
  const std::vector<std::string> one = {"--family", "touch", "--difficulty", "8", "--only", "4"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"stability"};
    all.insert(all.end(), one.begin(), one.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::pair<std::vector<std::string>, std::string> wrong[] = {
      {{"stability", "--method", "plain", "--minimise"},
       "--minimise: expected --only CASE or --saved DIR with it"},
      {with({"--method", "plain", "--minimise"}), "--minimise: expected --save DIR with it"},
      {with({"--method", "plain", "--method", "ours", "--minimise", "--save", "x"}),
       "--minimise: expected exactly one --method, found 2"},
      {with({"--method", "ours", "--minimise", "--save", "x"}), "the method does not fail on this case"},
      {with({"--method", "ours", "--saved", "x"}), "--saved: expected no --only with it"},
      {{"stability", "--saved", "none", "--method", "ours"}, "none/case.json"},
      {{"stability", "--saved", "broken", "--method", "ours"}, "no 12 numbers under \"pose_a\""},
      {{"stability", "--saved", "text", "--method", "ours"}, "found no JSON object"},
      {{"stability", "--saved", "x", "--quantity", "distance", "--method", "ours"},
       "--saved: expected --quantity pairs, found distance"}};
  for (const auto& [command, message] : wrong) {
    const std::string expected = message;
    CAPTURE(expected);
    const test::Outcome o = test::check_rejected(folder, command);
    CHECK(o.err.find(expected) != std::string::npos);
  }
}
