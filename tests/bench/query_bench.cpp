// The complete query against FCL on the same bodies and poses, both compiled here with the same flags (FCL's
// headers are instantiated in this file), one core. Times are the best of a few repeats of one warm query;
// what to believe is the ratio. Also, with --verify: against brute force.
//
//   query_bench A.obj B.obj [--scale-b S] [--poses N] [--verify]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/bench/approaches.hpp"
#include "tests/bench/timing.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>

#ifdef LRB_WITH_FCL
#include "bench/rivals/fcl_instantiated.hpp"
#include "tests/bench/fcl_model.hpp"
#endif

using namespace lrb;
using bench::best_microseconds;
using bench::median;

namespace {

struct PoseClass {
  const char* name;
  double depth;  ///< how far B goes beyond first contact, in diagonals of the larger body; negative: apart
};
constexpr PoseClass kClasses[] = {
    {"shallow 1 %", 0.01}, {"deep 10 %", 0.1}, {"0.1 % apart", -0.001}, {"0.5 % apart", -0.005}};

#ifdef LRB_WITH_FCL
class Fcl {
 public:
  explicit Fcl(const LrbRep& rep) : model_(bench::fcl_model<fcl::OBBRSSd>(rep)) {}
  static std::size_t pairs(const Fcl& a, const Fcl& b, const Pose& p, bool all) {
    const fcl::Transform3d t = bench::fcl_pose(p);
    fcl::CollisionResultd result;
    fcl::collide(a.model_.get(), fcl::Transform3d::Identity(), b.model_.get(), t,
                 fcl::CollisionRequestd(all ? 100000000 : 1, false), result);
    return result.numContacts();
  }

 private:
  std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_;
};
#endif

int verify(const LrbRep& a, const LrbRep& b, const Pose& p, const CollideResult& result) {
  const BruteForceResult expected = brute_force(a, Pose{}, b, p);
  return expected.pairs != result.pairs || expected.meets != result.meets ||
         expected.relation != result.relation;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: query_bench A B [--scale-b S] [--poses N] [--verify]\n");
    return 2;
  }
  double scale = 1;
  int count = 50;
  bool with_verify = false;
  for (int i = 3; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--scale-b") && i + 1 < argc) scale = std::atof(argv[++i]);
    if (!std::strcmp(argv[i], "--poses") && i + 1 < argc) count = std::atoi(argv[++i]);
    if (!std::strcmp(argv[i], "--verify")) with_verify = true;
  }
  Mesh mesh_b = read_mesh(argv[2]);
  for (auto& v : mesh_b.vertices) v *= scale;
  const LrbRep a = build_lrb(read_mesh(argv[1])), b = build_lrb(mesh_b);
  const double diagonal = std::max(shapes::box_of(a).diagonal().norm(), shapes::box_of(b).diagonal().norm());
  std::printf("%u x %u faces, %.0f and %.0f bytes a real face, %d poses a class\n", a.real_face_count(),
              b.real_face_count(), static_cast<double>(a.memory_bytes()) / a.real_face_count(),
              static_cast<double>(b.memory_bytes()) / b.real_face_count(), count);
#ifdef LRB_WITH_FCL
  const Fcl fcl_a(a), fcl_b(b);
#endif
  QueryContext context;
  NullProbe probe;
  int differences = 0;
  for (const PoseClass& c : kClasses)
    for (const Mode mode : {Mode::all_pairs, Mode::first_pair}) {
      std::vector<double> ours, theirs, ratios;
      double pairs = 0, node_pairs = 0, tests = 0;
      for (const bench::Approach& approach : bench::approaches(a, b, diagonal, count)) {
        const Pose p = approach.beyond(c.depth * diagonal);
        CollideRequest request;
        request.mode = mode;
        CollideResult result;
        ours.push_back(
            best_microseconds(5, [&] { result = collide(a, Pose{}, b, p, request, context, probe); }));
        pairs += static_cast<double>(result.pairs.size());
        node_pairs += static_cast<double>(result.counters.node_pairs);
        tests += static_cast<double>(result.counters.face_tests);
        if (with_verify && mode == Mode::all_pairs) differences += verify(a, b, p, result);
#ifdef LRB_WITH_FCL
        theirs.push_back(best_microseconds(3, [&] { Fcl::pairs(fcl_a, fcl_b, p, mode == Mode::all_pairs); }));
        ratios.push_back(theirs.back() / ours.back());
#endif
      }
      std::printf("%-11s %-5s  %9.2f us  %7.0f pairs %8.0f node pairs %7.0f face tests", c.name,
                  mode == Mode::all_pairs ? "all" : "first", median(ours), pairs / count, node_pairs / count,
                  tests / count);
      if (!ratios.empty()) std::printf("   FCL %9.2f us, %5.2fx", median(theirs), median(ratios));
      std::printf("\n");
    }
  if (with_verify) std::printf("%d differences from brute force\n", differences);
  return differences == 0 ? 0 : 1;
}
