// A few queries and builds whose instructions guard.sh counts under callgrind, to which this program reports
// where each begins and ends. Alone it runs them and counts nothing. Prints the compiler first: counts depend
// on it.
#include <cstdio>
#include <string>
#include <vector>

#include <valgrind/callgrind.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/near_pairs.hpp>
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
}
