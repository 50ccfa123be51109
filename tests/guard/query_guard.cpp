// Queries and builds whose instructions guard.sh counts under callgrind, to which this program reports
// where each begins and ends. Alone it runs them and counts nothing. Prints the compiler first: counts depend
// on it.
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <valgrind/callgrind.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;

namespace {

struct Guarded {
  const char* name;
  double share;  ///< of the distance at which round bodies just miss each other; 0: the same pose
  Mode mode;
  Predicates predicates;
  bool watched = false;  ///< with a probe that receives all reports and ignores them
  double tolerance = 0;
};

/// The cost of the events themselves: 0 if the query computes no value for them alone.
struct IdleProbe : NullProbe {
  static constexpr bool kEnabled = true;
};

constexpr Guarded kGuarded[] = {
    {"apart", 1.05, Mode::all_pairs, Predicates::exact},
    {"shallow", 0.85, Mode::all_pairs, Predicates::exact},
    {"shallow_first", 0.85, Mode::first_pair, Predicates::exact},
    {"shallow_any", 0.85, Mode::any_pair, Predicates::exact},
    {"shallow_floating", 0.85, Mode::all_pairs, Predicates::floating},
    {"shallow_watched", 0.85, Mode::all_pairs, Predicates::exact, true},
    {"deep", 0.4, Mode::all_pairs, Predicates::exact},
    {"identical", 0, Mode::all_pairs, Predicates::exact},
    {"apart_coarse", 1.05, Mode::all_pairs, Predicates::exact, false, 0.03},
    {"shallow_coarse", 0.85, Mode::all_pairs, Predicates::exact, false, 0.03},
    {"deep_coarse", 0.4, Mode::all_pairs, Predicates::exact, false, 0.03},
};

constexpr int kPoses = 5;

template <class Probe>
void ask(const Guarded& g, const LrbRep& a, const LrbRep& b) {
  CollideRequest request;
  request.mode = g.mode;
  request.predicates = g.predicates;
  request.tolerance = g.tolerance;
  QueryContext context;
  Probe probe;
  shapes::RandomEngine random(1);
  std::size_t pairs = 0;
  CALLGRIND_ZERO_STATS;
  for (int i = 0; i < kPoses; ++i) {
    const Pose pose = g.share > 0 ? shapes::random_pose(random, a, b, 0.55 * g.share) : Pose{};
    const LrbRep& other = g.share > 0 ? b : a;
    collide(a, Pose{}, other, pose, request, context, probe);  // warm: no memory is taken in what is counted
    CALLGRIND_START_INSTRUMENTATION;
    pairs += collide(a, Pose{}, other, pose, request, context, probe).pairs.size();
    CALLGRIND_STOP_INSTRUMENTATION;
  }
  CALLGRIND_DUMP_STATS_AT(g.name);
  std::printf("%s %zu\n", g.name, pairs);
}

/// Reports a query to callgrind. query(i): asks at pose i and returns a number of its answer.
template <class Query>
void count_query(const char* name, const Query& query) {
  std::size_t sum = 0;
  CALLGRIND_ZERO_STATS;
  for (int i = 0; i < kPoses; ++i) {
    query(i);
    CALLGRIND_START_INSTRUMENTATION;
    sum += query(i);
    CALLGRIND_STOP_INSTRUMENTATION;
  }
  CALLGRIND_DUMP_STATS_AT(name);
  std::printf("%s %zu\n", name, sum);
}

/// Near pairs of shallow poses within about 1 % of the diagonal; distances of linked rings.
void ask_distances(const LrbRep& a, const LrbRep& b) {
  NearPairsRequest request;
  request.within = 0.03;
  Workspace workspace;
  shapes::RandomEngine random(1);
  std::vector<Pose> shallow, linked;
  const LrbRep ring = LrbRep::without_regions(shapes::torus(96, 32, 1, 0.3), true, false);
  for (int i = 0; i < kPoses; ++i) {
    shallow.push_back(shapes::random_pose(random, a, b, 0.55 * 0.85));
    linked.push_back(
        {deterministic::rotation(Eigen::Vector3d::UnitX(), 1.67 + 0.1 * i), {1 - 0.05 * i, 0.03, 0.02}});
  }
  count_query("near", [&](int i) {
    return near_pairs(a, Pose{}, b, shallow[i], request, workspace).value().pairs.size();
  });
  count_query("distance_linked", [&](int i) {
    return distance(ring, Pose{}, ring, linked[i], {}, workspace).value().counters.steps;
  });
}

/// Reports a build to callgrind. The builds before it have filled the caches of the allocator.
template <class Build>
void count_build(const char* name, const Build& build) {
  build();
  CALLGRIND_ZERO_STATS;
  CALLGRIND_START_INSTRUMENTATION;
  const std::size_t faces = build();
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name);
  std::printf("%s %zu\n", name, faces);
}

/// A body of which some work once grew with the square of its size: a large face, a vertex with many faces,
/// many parts; and the works that are counted, for a query with a pose of a second body.
struct Hard {
  Mesh mesh;
  std::string works = "check build proof query";
  Pose pose = Pose::rotation({1, 2, 3}, 0.3, {0.3, 0.2, 0.4});  // in contact, a little aslant
};

/// The query of the bare faces of a body with themselves.
std::size_t pairs_of(const Mesh& mesh, const Pose& a, const Pose& b) {
  const LrbRep rep = LrbRep::without_regions(mesh, true, false);
  return collide(rep, a, rep, b, CollideRequest{}).pairs.size();
}

std::size_t work(const std::string& kind, const Hard& x) {
  if (kind == "check") return check_mesh(x.mesh).components;
  if (kind == "build") return build_lrb(x.mesh).face_count();
  if (kind == "proof") return validate(build_lrb(x.mesh), {.wrapper_states = 10}).embedding_pairs;
  return pairs_of(x.mesh, {}, x.pose);
}

void count_growth() {
  using namespace hard;
  const Hard inputs[] = {
      {drum(1000)},
      {cog(500), "check query"},
      {fine_box(1000), "check build query"},
      {shapes::several({drum(500), shapes::translated(drum(500), {0, 0, 1})}), "check build"},
      {cone(1000)},
      {bipyramid(1000)},
      {crown(1000)},
      {fan_disk(1000), "check query"},
      {frustum(1000)},
      {nested(128), "check query", Pose::translation({1.9, 0, 0})},
      {nested(16), "build proof"},
      {pieces(24)},
      {tiles(48)},
      {tiles(48), "query", Pose::translation({0, 0, 1})},
      {drum(1000), "query", Pose::translation({0.5, 0, 0.5})}};
  for (const std::string kind : {"check", "build", "proof", "query"})
    count_build((kind + "_hard").c_str(), [&] {
      std::size_t sum = 0;
      for (const Hard& x : inputs)
        if (x.works.find(kind) != std::string::npos) sum += work(kind, x);
      return sum;
    });
  // Under some maps boxes could cull nothing: the query would compare all faces with all.
  const auto diagonal = [](double x, double y, double z) {
    return Eigen::Matrix3d(Eigen::Vector3d(x, y, z).asDiagonal());
  };
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), shear{{1, 0.5, 0}, {0, 1, 0}, {0, 0, 1}},
                        turn = deterministic::rotation(Eigen::Vector3d(1, 2, 3).normalized(), 0.3);
  const std::array<Eigen::Matrix3d, 2> maps[] = {
      {one, 1.01 * one}, {one, 1.5 * one},          {1e-150 * one, 1e-150 * one}, {one, diagonal(1, 2, 0.5)},
      {shear, one},      {diagonal(-1, 1, 1), one}, {diagonal(1, 1, 0.001), one}, {one, diagonal(1, 1, 0)}};
  const Mesh ball = shapes::uv_sphere(44, 45);
  count_build("query_maps", [&] {
    std::size_t sum = 0;
    for (const auto& [a, b] : maps)
      sum += pairs_of(ball, {a, {0, 0, 0}}, {b * turn, b * Eigen::Vector3d(0.5, 0.4, 0.3)});
    return sum;
  });
}

}  // namespace

int main() {
#ifdef __clang__
  std::printf("compiler clang-%d %s\n", __clang_major__, LRB_FLAGS);
#else
  std::printf("compiler gcc-%d %s\n", __GNUC__, LRB_FLAGS);
#endif
  const LrbRep a = build_lrb(shapes::bumpy_sphere(4, 1)), b = build_lrb(shapes::bumpy_sphere(4, 2));
  for (const Guarded& g : kGuarded) g.watched ? ask<IdleProbe>(g, a, b) : ask<NullProbe>(g, a, b);
  ask_distances(a, b);
  const Mesh small = shapes::bumpy_sphere(3, 1);
  count_build("build_tree", [&]() -> std::size_t { return ObbTree(a.simplices(), 1).height(); });
  count_build("build_lrb", [&]() -> std::size_t { return build_lrb(small).face_count(); });
  count_growth();
}
