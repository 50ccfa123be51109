// On any number of threads the same bytes, and the same report.

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/float_modes.hpp"
#include "tests/support/lrb_files.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::test {
namespace {

using namespace shapes;

LrbRep build_on(const Mesh& mesh, unsigned threads) {
  BuildOptions options;
  options.threads = threads;
  return build_lrb(mesh, options);
}

/// Two crossing balls, and one apart with a void in it.
Mesh crossing_balls() {
  return several({bumpy_sphere(3, 5), translated(bumpy_sphere(3, 6), {0.9, 0.1, 0.2}),
                  translated(icosphere(3), {4, 0, 0}),
                  translated(turned_inside_out(icosphere(2, 0.5)), {4, 0, 0})});
}

/// A ball in a void that it nearly fills: caps on both sides of the gap get into each other's way, though
/// their patches share no vertex.
Mesh ball_in_tight_void() {
  return several({icosphere(5), turned_inside_out(icosphere(5, 1.006)), icosphere(3, 1.5)});
}

void check_threads(const Mesh& mesh) {
  CAPTURE(mesh.name);
  CAPTURE(mesh.face_count());
  const std::string one = lrb_bytes(build_on(mesh, 1));
  for (const unsigned threads : {2u, 5u}) {
    const test::InMode mode(static_cast<int>(threads));
    CHECK((lrb_bytes(build_on(mesh, threads)) == one));
  }
}

TEST_CASE("any number of threads, in any floating-point mode, builds the same LRB-rep, byte for byte") {
  for (const Mesh& mesh : {bumpy_sphere(4, 3), comb(20), crossing_balls(), gear(200)}) check_threads(mesh);
}

TEST_CASE("any number of threads builds the same large LRB-rep" * doctest::test_suite("long")) {
  for (const Mesh& mesh :
       {bumpy_sphere(5, 3), torus(80, 40), quad_torus(40, 20), bowl(40, 20), ball_in_tight_void()})
    check_threads(mesh);
}

TEST_CASE("the validation report does not depend on the number of threads, for valid and invalid LRB-reps") {
  LrbData broken = build_lrb(torus(60, 30)).data();
  for (std::size_t v = 0; v < broken.vertices.size(); v += 50) broken.vertices[v] *= 1.3;
  const LrbRep reps[] = {build_lrb(bumpy_sphere(4, 3)), build_lrb(crossing_balls()), LrbRep(broken)};
  for (const LrbRep& rep : reps) {
    ValidateOptions options;
    const ValidateReport one = validate(rep, options);
    for (const unsigned threads : {2u, 5u}) {
      options.threads = threads;
      const ValidateReport many = validate(rep, options);
      CHECK(many.valid == one.valid);
      CHECK(many.violations == one.violations);
      CHECK(many.violation_count == one.violation_count);
      CHECK(many.real_pairs_meeting == one.real_pairs_meeting);
      CHECK(many.flat_pairs == one.flat_pairs);
      CHECK(many.embedding_pairs == one.embedding_pairs);
      CHECK(many.states == one.states);
      CHECK(many.volume_regions == one.volume_regions);
    }
  }
  CHECK(validate(reps[0]).valid);
  CHECK_FALSE(validate(reps[2]).valid);
}

TEST_CASE("an exception from a probe ends the build") {
  struct Thrower final : ConstructProbe {
    void region(RegionId) override { throw InputError("enough"); }
  } thrower;
  BuildOptions options;
  options.probe = &thrower;
  CHECK_THROWS_WITH_AS(build_lrb(bumpy_sphere(3, 3), options), "enough", InputError);
}

TEST_CASE("workers run every task once, rethrow the exception of the lowest task, and can be reused") {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Workers workers(threads);
    CHECK(workers.count() == threads);
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<int> done(count, 0);
      std::vector<int> busy(threads, 0);
      workers.for_each(count, [&](std::size_t i, unsigned worker) {
        ++busy[worker];
        ++done[i];
        --busy[worker];
      });
      CHECK(done == std::vector<int>(count, 1));
      CHECK(busy == std::vector<int>(threads, 0));
    }
    for (int round = 0; round < 20; ++round) {
      std::vector<int> done(100, 0);
      std::atomic<int> later{0}, failed{0};
      const auto failing = [&] {
        workers.for_each(done.size(), [&](std::size_t i, unsigned) {
          if (i % 10 != 7) return void(++done[i]);
          // The lowest waits for another, if one runs at the same time, which then fails after it.
          if (i > 7) ++later;
          for (int wait = 0; threads > 1 && wait < 50 && (i > 7 ? failed : later) == 0; ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          if (i > 7) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          ++failed;
          throw std::runtime_error(std::to_string(i));
        });
      };
      CHECK_THROWS_WITH_AS(failing(), "7", std::runtime_error);
      for (std::size_t i = 0; i < 7; ++i) CHECK(done[i] == 1);
    }
  }
  CHECK(Workers(0).count() >= 1);
}

}  // namespace
}  // namespace lrb::test
