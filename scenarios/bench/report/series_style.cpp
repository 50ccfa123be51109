#include "scenarios/bench/report/series_style.hpp"

#include <algorithm>
#include <array>

namespace lrb::bench {
namespace {

struct Family {
  const char* begins;  ///< the method's name begins with it; the longest wins
  SeriesStyle look;
};

constexpr std::array<Family, 12> kFamilies = {{
    {"ours", {"lrbscope, exact", "#0072b2", "circle", 7}},
    {"ours-", {"lrbscope, variants", "#4aa3dc", "circle", 6}},
    {"plain", {"brute force", "#6b6b6b", "crossRot", 2}},
    {"fcl", {"FCL", "#d55e00", "rect", 5}},
    {"cgal", {"CGAL, yes or no", "#009e73", "triangle", 8}},
    {"cgal-pairs", {"CGAL, pairs", "#009e73", "triangle", 9}},
    {"bullet", {"Bullet", "#cc79a7", "rectRot", 13}},
    {"embree", {"Embree", "#b58900", "rectRounded", 11}},
    {"ode", {"ODE", "#7f3c8d", "cross", 1}},
    {"spheres", {"sphere tree, by level", "#1c1e22", "star", 3}},
    {"fcl-octree", {"octree (FCL), by cells", "#8a5a2b", "rect", 4}},
    {"fcl-gjk", {"convex hulls, GJK (FCL)", "#a3132f", "triangle", 10}},
}};

}  // namespace

std::size_t look_of(const std::string& method) {
  std::size_t best = 0, length = 0;
  for (std::size_t i = 0; i < kFamilies.size(); ++i) {
    const std::string begins = kFamilies[i].begins;
    if (begins.size() >= length && method.rfind(begins, 0) == 0) {
      best = i;
      length = begins.size();
    }
  }
  return best;
}

std::size_t look_count() {
  return kFamilies.size();
}

const SeriesStyle& look(std::size_t i) {
  return kFamilies[i].look;
}

double drawn_time(const Point& p, double slowest) {
  constexpr double kAbove = 3;
  return p.median > 0 ? p.median : kAbove * slowest;
}

double slowest_of(const std::vector<Point>& points, const std::string& set) {
  double slowest = 1;
  for (const Point& p : points)
    if (p.set == set) slowest = std::max(slowest, p.median);
  return slowest;
}

std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c) {
  std::vector<const Point*> out;
  for (const Point& p : points)
    if (p.set == set && p.pose_class == c) out.push_back(&p);
  return out;
}

std::vector<const Point*> frontier(const std::vector<const Point*>& panel) {
  std::vector<const Point*> out;
  for (const Point* p : panel)
    if (p->frontier) out.push_back(p);
  std::sort(out.begin(), out.end(), [](const Point* p, const Point* q) {
    return p->error() != q->error() ? p->error() < q->error() : p->median < q->median;
  });
  return out;
}

}  // namespace lrb::bench
