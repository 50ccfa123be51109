#include "bench/speed/series_style.hpp"

#include <algorithm>
#include <array>

namespace lrb::bench {
namespace {

struct Spare {
  const char* colour;
  const char* shape;
};

/// Styles for methods that do not say how they are drawn, taken in turn; none of our methods looks like this.
constexpr std::array<Spare, 8> kSpares = {{
    {"#2f4b7c", "triangle"},
    {"#f95d6a", "rectRot"},
    {"#4f7942", "star"},
    {"#8f5bd9", "cross"},
    {"#c04000", "rectRounded"},
    {"#00798c", "rect"},
    {"#a0522d", "circle"},
    {"#b0006d", "crossRot"},
}};

}  // namespace

SeriesStyles::SeriesStyles(const std::vector<methods::MethodInfo>& methods) {
  std::size_t spares = 0;
  for (const methods::MethodInfo& m : methods) {
    methods::MethodStyle style = m.style;
    if (style.title.empty()) {
      const Spare& spare = kSpares[spares++ % kSpares.size()];
      style = {m.name, spare.colour, spare.shape};
    }
    const auto same = std::find_if(series_.begin(), series_.end(),
                                   [&](const methods::MethodStyle& s) { return s.title == style.title; });
    series_of_[m.name] = static_cast<std::size_t>(same - series_.begin());
    if (same == series_.end()) series_.push_back(std::move(style));
  }
}

std::size_t SeriesStyles::series_of(const std::string& method) const {
  const auto it = series_of_.find(method);
  return it == series_of_.end() ? count() : it->second;
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
