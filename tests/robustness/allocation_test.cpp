/// Memory runs out at each allocation in turn: std::bad_alloc comes out, nothing is left behind (ASan's leak
/// check verifies that), and objects in use keep working. A workspace asks for no memory once it has answered
/// such queries before.

#include <filesystem>
#include <new>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/contract/queries.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/counted_new.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/lrb_shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

/// Runs `work`, which says whether its answer is right, with its first allocation failing, then its second,
/// until it needs no more of them. `after` is called after each failure, with memory again. Returns how many
/// allocations there were.
template <class Work, class After>
std::uint64_t fail_each_allocation(const Work& work, const After& after) {
  for (std::uint64_t n = 0;; ++n) {
    fail_allocation_after(n);
    bool right = true;  // or not answered
    try {
      right = work();  // it may make do without: std::stable_sort does
    } catch (const std::bad_alloc&) {
    } catch (...) {
      fail_allocation_after(kNoFailure);
      throw;
    }
    const bool failed = allocation_has_failed();
    fail_allocation_after(kNoFailure);
    CHECK(right);
    if (!failed) return n;
    after();
  }
}

struct Query {
  LrbRep a{toy::dented_box()}, b{toy::dented_box()};
  Pose pose_b = Pose::translation({1.75, 1.25, 2.5});
  CollideRequest request;
  QueryContext context;

  template <class Probe>
  CollideResult answer(Probe& probe) {
    return collide(a, Pose{}, b, pose_b, request, context, probe);
  }
  CollideResult answer() {
    NullProbe probe;
    return answer(probe);
  }
};

bool same(const CollideResult& x, const CollideResult& y) {
  return x.relation == y.relation && x.pairs == y.pairs && x.opened == y.opened &&
         x.regions.size() == y.regions.size() && x.counters.face_tests == y.counters.face_tests;
}

TEST_CASE("a query that runs out of memory leaves its context usable") {
  for (const Recursion recursion :
       {Recursion::complete, Recursion::paper, Recursion::paper_strict, Recursion::paper_wrapper,
        Recursion::paper_boxes, Recursion::paper_wrapper_boxes}) {
    CAPTURE(to_string(recursion));
    Query q;
    q.request.recursion = recursion;
    q.request.contacts = true;
    q.request.interiors_overlap = true;
    const CollideResult expected = q.answer();
    REQUIRE(!expected.pairs.empty());
    // A new context each time, so that everything is allocated; then what the failure left of it is used.
    const std::uint64_t allocations = fail_each_allocation(
        [&] {
          q.context = QueryContext();
          return same(q.answer(), expected);
        },
        [&] { CHECK(same(q.answer(), expected)); });
    CHECK(allocations > 20);
  }
}

TEST_CASE("building a body while memory runs out") {
  for (const Mesh& mesh : {l_shape(), comb_2d(3)}) {
    const std::uint64_t expected = build_lrb(mesh).hash();
    CHECK(fail_each_allocation([&] { return build_lrb(mesh).hash() == expected; }, [] {}) > 100);
  }
}

TEST_CASE("reading and checking a mesh while memory runs out") {
  const Mesh body = box();
  for (const std::string& bytes : {to_ply_ascii(body), to_ply_binary(body, true), to_stl_ascii(body),
                                   to_stl_binary(body), to_off(body)}) {
    const auto read = [&] {
      const Mesh mesh = read_mesh(std::string(bytes), "m");
      return check_mesh(mesh, true).buildable();
    };
    CHECK(fail_each_allocation(read, [] {}) > 5);
  }
}

TEST_CASE("saving a .lrb while memory runs out leaves no file or a complete one") {
  const Folder folder;
  const std::string path = folder / "x.lrb";
  const LrbRep rep(shapes::dented_box());
  const auto save = [&] {
    save_lrb(rep, path);
    return true;
  };
  const auto judge = [&] {
    const auto begin = std::filesystem::directory_iterator(std::filesystem::path(path).parent_path());
    for (const auto& entry : begin) {
      CHECK(entry.path() == path);
      CHECK(load_lrb(path).hash() == rep.hash());
    }
    std::filesystem::remove(path);
  };
  CHECK(fail_each_allocation(save, judge) > 5);
  save();
  CHECK(fail_each_allocation([&] { return load_lrb(path).hash() == rep.hash(); }, [] {}) > 5);
}

TEST_CASE("a coherent query that runs out of memory answers the next pose correctly") {
  const LrbRep a = LrbRep::without_regions(bumpy_sphere(2, 1), true, false),
               b = LrbRep::without_regions(bumpy_sphere(2, 2), true, false);
  // In and out again, deeper each time: lists become longer, and B comes back to where the one before was
  // good.
  constexpr int kSteps = 100;
  const auto pose = [](int step) {
    const double depth = 0.001 * (10 - std::abs(step % 20 - 10)) * (1 + step / 20);
    return Pose::translation({1.9 - depth, 0.2, 0});
  };
  std::vector<CollideResult> expected;
  for (int step = 0; step < kSteps; ++step) expected.push_back(collide(a, Pose{}, b, pose(step), {}));
  std::uint64_t failures = 0;
  for (bool failed = true; failed; failures += failed) {
    CoherentQuery coherent(a, b, {}, CoherentQuery::CacheUse::always);
    failed = false;
    fail_allocation_after(failures);
    for (int step = 0; step < kSteps; ++step) {
      bool right = true;  // or not answered
      try {
        const CollideResult& now = coherent.collide(Pose{}, pose(step));
        right = now.pairs == expected[step].pairs && now.relation == expected[step].relation;
      } catch (const std::bad_alloc&) {
        failed = true;
        fail_allocation_after(kNoFailure);
      }
      REQUIRE(right);
    }
    fail_allocation_after(kNoFailure);
  }
  CHECK(failures > 30);
}

TEST_CASE("a warm coherent query allocates no memory") {
  const LrbRep a = build_lrb(bumpy_sphere(3, 1)), b = build_lrb(bumpy_sphere(3, 2));
  CoherentQuery coherent(a, b);
  const auto step = [&](int i) {
    coherent.collide(Pose{}, Pose::translation({1.7 + 1e-4 * (i % 4), 0.2, 0}));
  };
  for (int i = 0; i < 100; ++i) step(i);
  const std::uint64_t before = allocations(), lists = coherent.statistics().from_cache;
  for (int i = 0; i < 100 && allocations() == before; ++i) step(i);
  CHECK(coherent.statistics().from_cache > lists);
  CHECK(allocations() == before);
}

TEST_CASE("queries in a workspace allocate no memory after the first ones") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 4)), b = build_lrb(shapes::torus(40, 20)),
               flat = build_lrb(shapes::ring_2d(40));
  shapes::RandomEngine random(1);
  std::vector<Pose> poses, poses_flat;
  for (int i = 0; i < 100; ++i) {
    poses.push_back(shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1.2)));
    poses_flat.push_back(shapes::random_pose(random, flat, flat, shapes::uniform(random, 0, 1.2)));
  }
  poses.push_back(Pose{});
  for (const Mode mode : {Mode::all_pairs, Mode::first_pair, Mode::any_pair}) {
    CollideRequest request;
    request.mode = mode;
    Workspace workspace, flat_workspace;
    std::size_t met = 0;
    for (int round = 0; round < 2; ++round) {
      const std::uint64_t before = allocations();
      for (const Pose& pose : poses) met += !collide(a, Pose{}, b, pose, request, workspace)->pairs.empty();
      for (const Pose& pose : poses_flat) (void)collide(flat, Pose{}, flat, pose, request, flat_workspace);
      CHECK((round == 0) == (allocations() > before));
    }
    CHECK(met >= 80);
  }
}

TEST_CASE_TEMPLATE("a workspace does not grow while queries repeat", Q, contract::Collide, contract::Distance,
                   contract::Clash, contract::FirstContact, contract::Near, contract::Manifold) {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(2, 4)), b = build_lrb(shapes::torus(16, 8));
  Workspace workspace;
  std::int64_t before = 0;
  for (int round = 0; round < 3; ++round) {
    shapes::RandomEngine random(1);
    for (int i = 0; i < 20; ++i) {
      const contract::Case c{&a, &b, {}, shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1.2))};
      for (const auto& request : Q::requests()) (void)Q::ask(c, request, workspace);
    }
    // Buffers reach their size in the first round.
    if (round == 1) before = bytes_in_use();
  }
  CHECK(bytes_in_use() == before);
}

// Not the reading of traces: the destructors of nlohmann-json 3.11 allocate, and end the process if they
// cannot (lrbscope then says what it says for std::bad_alloc, see tools/terminal.cpp).
TEST_CASE("recording a run while memory runs out") {
  Query q;
  const auto record = [&] {
    trace::Recorder recorder(q.a, q.b, {});
    recorder.begin_step(0, Pose{}, q.pose_b);
    recorder.end_step(q.answer(recorder));
    return trace::trace_to_json(recorder.take());
  };
  const std::string expected = record();
  CHECK(fail_each_allocation([&] { return record() == expected; }, [&] { CHECK(record() == expected); }) >
        20);
}

}  // namespace
}  // namespace lrb::test
