/// Shrinking cases on which methods fail: sizes, and that the result still fails. The command:
/// tests/commands/stability.txt.

#include "bench/stability/minimise.hpp"

#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/cases/families.hpp"
#include "bench/stability/saved_case.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/program.hpp"
#include "tests/support/workers.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

using namespace lrb;
using namespace lrb::stability;
using lrb::test::Folder;
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

TEST_CASE("a minimised case fails again when it is loaded") {
  const WorkerPrograms workers;
  const workers::WorkerMethod plain = worker_method("plain");
  int flat = 0;
  for (const char* family :
       {"plane", "touch", "identical", "hub", "sliver", "zero-area", "scale", "matrix", "mixture"}) {
    CAPTURE(family);
    bool minimised = false;
    for (std::uint64_t i = 0; i < 8 && !minimised; ++i) {
      const cases::Case c = cases::make_case(*cases::find_family(family), 1, 8, i);
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
      minimised = true;
      flat += saved.meshes.a.dim == 2;
    }
    CHECK(minimised);
  }
  CHECK(flat > 0);
}
