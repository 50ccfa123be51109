// Distances against FCL's on the same bodies and poses, in one run on one core, both compiled here with the
// same flags. Each body against itself, B turned at random and moved until it is as far from A as the row
// says. What to believe is the ratios: the geometric mean over the poses of (FCL's time / ours), each the
// best of a few repeats, warm.
//
//   distance_bench [--poses N] [--steps N] [MESH...]     without meshes: spot, rocker-arm and nefertiti of
//   LRB_MESHES
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "engine/distance/distance_context.hpp"
#include "tests/bench/approaches.hpp"
#include "tests/bench/timing.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

#ifdef LRB_WITH_FCL
#include "bench/rivals/fcl_instantiated.hpp"
#include "tests/bench/fcl_model.hpp"
#define extern
#include <fcl/narrowphase/distance.h>
#undef extern
#endif

using namespace lrb;
using bench::best_microseconds;

namespace {

constexpr double kGaps[] = {0.001, 0.01, 0.1, 1};  // of the diagonal

/// Geometric means.
struct Mean {
  double logarithms = 0;
  int count = 0;
  void add(double x) {
    logarithms += std::log(x);
    ++count;
  }
  double value() const { return count > 0 ? std::exp(logarithms / count) : 0; }
};

#ifdef LRB_WITH_FCL
template <class Volume>
class Fcl {
 public:
  explicit Fcl(const LrbRep& rep) : model_(bench::fcl_model<Volume>(rep)) {}
  double distance(const Pose& p) const {
    const fcl::Transform3d t = bench::fcl_pose(p);
    fcl::DistanceResultd result;
    return fcl::distance(model_.get(), fcl::Transform3d::Identity(), model_.get(), t, fcl::DistanceRequestd(),
                         result);
  }

 private:
  std::shared_ptr<fcl::BVHModel<Volume>> model_;
};
#endif

/// Returns poses of the body whose distance from itself is `gap`, nearly.
std::vector<Pose> poses_at(const LrbRep& rep, double diagonal, double gap, int count) {
  DistanceContext context;
  std::vector<Pose> poses;
  for (const bench::Approach& approach : bench::approaches(rep, rep, diagonal, count)) {
    double way = gap;
    for (int i = 0; i < 30; ++i)
      way += gap - distance(rep, Pose{}, rep, approach.beyond(-way), {}, context).upper;
    poses.push_back(approach.beyond(-way));
  }
  return poses;
}

struct Ratios {
  Mean to_rss, to_obbrss, within;
  double worst = 1e300;  // the least of the two, as the row's mean
};

class Row {
 public:
  explicit Row(const LrbRep& rep) : rep_(rep) {
#ifdef LRB_WITH_FCL
    rss_ = std::make_unique<Fcl<fcl::RSSd>>(rep);
    obbrss_ = std::make_unique<Fcl<fcl::OBBRSSd>>(rep);
#endif
  }

  void run(const std::vector<Pose>& poses, double gap, const char* name, double share,
           [[maybe_unused]] Ratios& all) {
    Mean ours, rss, obbrss, within;
    DistanceCounters work;
    for (const Pose& pose : poses) {
      DistanceResult result;
      const double us =
          best_microseconds(5, [&] { result = distance(rep_, Pose{}, rep_, pose, {}, context_); });
      ours.add(us);
      work.steps += result.counters.steps;
      work.pairs_in_floats += result.counters.pairs_in_floats;
      work.pairs_in_doubles += result.counters.pairs_in_doubles;
      work.pairs_exact += result.counters.pairs_exact;
      // Half asked for a little more than there is, half for a little less.
      [[maybe_unused]] const double upper = result.upper;
      DistanceRequest is_near;
      is_near.within = gap * (ours.count % 2 == 0 ? 1.05 : 0.95);
      const double within_us =
          best_microseconds(5, [&] { result = distance(rep_, Pose{}, rep_, pose, is_near, context_); });
#ifdef LRB_WITH_FCL
      const double rss_us = best_microseconds(2, [&] { check(rss_->distance(pose), upper); });
      const double obbrss_us = best_microseconds(2, [&] { check(obbrss_->distance(pose), upper); });
      rss.add(rss_us / us);
      obbrss.add(obbrss_us / us);
      within.add(std::min(rss_us, obbrss_us) / within_us);
      all.to_rss.add(rss_us / us);
      all.to_obbrss.add(obbrss_us / us);
      all.within.add(std::min(rss_us, obbrss_us) / within_us);
#else
      within.add(us / within_us);
#endif
    }
    const double n = static_cast<double>(poses.size());
    std::printf("%-12s %6.1f %% %9.2f us %8.0f steps %7.0f floats %5.1f doubles %5.2f exact", name,
                100 * share, ours.value(), static_cast<double>(work.steps) / n,
                static_cast<double>(work.pairs_in_floats) / n, static_cast<double>(work.pairs_in_doubles) / n,
                static_cast<double>(work.pairs_exact) / n);
#ifdef LRB_WITH_FCL
    all.worst = std::min({all.worst, rss.value(), obbrss.value()});
    std::printf("   RSS %6.2fx  OBBRSS %6.2fx  within %6.2fx\n", rss.value(), obbrss.value(), within.value());
#else
    std::printf("   within, against ours: %5.2fx\n", within.value());
#endif
  }

 private:
  static void check(double theirs, double ours) {
    if (!(std::abs(theirs - ours) < 1e-6 * ours)) std::printf("FCL finds %.9g, not %.9g\n", theirs, ours);
  }

  const LrbRep& rep_;
  DistanceContext context_;
#ifdef LRB_WITH_FCL
  std::unique_ptr<Fcl<fcl::RSSd>> rss_;
  std::unique_ptr<Fcl<fcl::OBBRSSd>> obbrss_;
#endif
};

/// Moves B by 0.1 % of the diagonal a step, and turns it by as much, and compares with from scratch.
void coherent(const LrbRep& rep, const std::vector<Pose>& starts, double diagonal, double share,
              const char* name, int steps, Mean& all) {
  shapes::RandomEngine random(3);
  Mean ratio;
  std::uint64_t steps_from_scratch = 0, steps_coherent = 0;
  for (const Pose& start : starts) {
    const Eigen::Vector3d way = shapes::random_direction(random), axis = shapes::random_direction(random);
    std::vector<Pose> path;
    for (int i = 0; i < steps; ++i) {
      const Eigen::Matrix3d turn = steady::rotation(axis, 0.001 * i);
      path.push_back({turn * start.r, start.t + 0.001 * diagonal * i * way});
    }
    DistanceContext context;
    std::vector<DistanceResult> one(path.size()), other(path.size());
    const double scratch_us = best_microseconds(3, [&] {
      for (std::size_t i = 0; i < path.size(); ++i) one[i] = distance(rep, Pose{}, rep, path[i], {}, context);
    });
    const double coherent_us = best_microseconds(3, [&] {
      CoherentDistance follows(rep, rep);  // a new one: it must not know the path
      for (std::size_t i = 0; i < path.size(); ++i) other[i] = follows.distance(Pose{}, path[i]);
    });
    for (std::size_t i = 0; i < path.size(); ++i) {
      steps_from_scratch += one[i].counters.steps;
      steps_coherent += other[i].counters.steps;
      if (one[i].meet != other[i].meet || one[i].lower > other[i].upper || other[i].lower > one[i].upper)
        std::printf("coherent: [%.17g, %.17g], not [%.17g, %.17g]\n", other[i].lower, other[i].upper,
                    one[i].lower, one[i].upper);
    }
    ratio.add(scratch_us / coherent_us);
    all.add(scratch_us / coherent_us);
  }
  std::printf("%-12s %6.1f %%  coherent %6.2fx of from scratch, with %.0f %% of its steps\n", name,
              100 * share, ratio.value(),
              100 * static_cast<double>(steps_coherent) / static_cast<double>(steps_from_scratch));
}

}  // namespace

int main(int argc, char** argv) {
  int count = 100, steps = 100;
  std::vector<std::string> meshes;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--poses") && i + 1 < argc)
      count = std::atoi(argv[++i]);
    else if (!std::strcmp(argv[i], "--steps") && i + 1 < argc)
      steps = std::atoi(argv[++i]);
    else
      meshes.emplace_back(argv[i]);
  }
  if (meshes.empty())
    for (const char* name : {"spot", "rocker-arm", "nefertiti"})
      meshes.push_back((test::shared_meshes() / (std::string(name) + ".obj")).string());
  Ratios all;
  Mean coherently;
  for (const std::string& path : meshes) {
    const std::string name = std::filesystem::path(path).stem().string();
    const LrbRep rep = build_lrb(read_mesh(path));
    const double diagonal = shapes::box_of(rep).diagonal().norm();
    Row row(rep);
    for (const double share : kGaps) {
      const std::vector<Pose> poses = poses_at(rep, diagonal, share * diagonal, count);
      row.run(poses, share * diagonal, name.c_str(), share, all);
      if (steps > 0)
        coherent(rep, {poses.begin(), poses.begin() + std::min<std::ptrdiff_t>(10, std::ssize(poses))},
                 diagonal, share, name.c_str(), steps, coherently);
    }
  }
  std::printf(
      "geometric means: RSS %.2fx, OBBRSS %.2fx, least of any cell %.2fx, within %.2fx, coherent %.2fx\n",
      all.to_rss.value(), all.to_obbrss.value(), all.worst, all.within.value(), coherently.value());
}
