#include "render/hairs.hpp"

#include <algorithm>

namespace lrb::render {
namespace {

using Eigen::Vector2d;

/// The part [from, to] of a segment, as shares of its length, along which another one is within the width.
struct Cover {
  double from, to;
  int way;  ///< 1: the other has the same direction, -1: the opposite one
};

/// Returns the distance of a point from the line through p in direction `along` (of length 1).
double off_line(const Vector2d& x, const Vector2d& p, const Vector2d& along) {
  const Vector2d d = x - p;
  return std::abs(along.x() * d.y() - along.y() * d.x());
}

/// Appends the part of segment s that t covers.
void add_cover(const Segment2d& s, const Segment2d& t, double width, std::vector<Cover>& covers) {
  const Vector2d p = s[0].head<2>(), q = s[1].head<2>(), u = t[0].head<2>(), v = t[1].head<2>();
  const double length = (q - p).norm();
  if (!(length > 0)) return;
  const Vector2d along = (q - p) / length;
  const double a = along.dot(u - p) / length, b = along.dot(v - p) / length;
  const double from = std::max(0.0, std::min(a, b)), to = std::min(1.0, std::max(a, b));
  if (!(from < to)) return;
  // Both ends of the common part must be near the line, so that all of it is.
  for (const double share : {from, to})
    if (off_line(u + (v - u) * ((share - a) / (b - a)), p, along) > width) return;
  covers.push_back({from, to, a < b ? 1 : -1});
}

/// Appends the parts of a segment that its covers do not cancel, unless they are shorter than the width.
void add_rest(const Segment2d& s, const std::vector<Cover>& covers, double width,
              std::vector<Segment2d>& out) {
  const auto at = [&](double share) -> Eigen::Vector3d {
    return share <= 0 ? s[0] : share >= 1 ? s[1] : s[0] + share * (s[1] - s[0]);
  };
  std::vector<double> cuts = {0, 1};
  for (const Cover& c : covers) cuts.insert(cuts.end(), {c.from, c.to});
  std::sort(cuts.begin(), cuts.end());
  double begin = -1;  // of the part that is being extended; negative: none
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double centre = (cuts[i] + cuts[i + 1]) / 2;
    int net = 1;
    for (const Cover& c : covers) net += c.from < centre && centre < c.to ? c.way : 0;
    const bool kept = net != 0 && cuts[i] < cuts[i + 1];
    if (kept && begin < 0) begin = cuts[i];
    if (begin >= 0 && (net == 0 || i + 2 == cuts.size())) {
      const double end = net == 0 ? cuts[i] : cuts[i + 1];
      if ((end - begin) * (s[1] - s[0]).norm() > width) out.push_back({at(begin), at(end)});
      begin = -1;
    }
  }
}

}  // namespace

std::vector<Segment2d> without_hairs(const std::vector<Segment2d>& segments, double width) {
  std::vector<Segment2d> out;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::vector<Cover> covers;
    for (std::size_t j = 0; j < segments.size(); ++j)
      if (j != i) add_cover(segments[i], segments[j], width, covers);
    const bool any_opposite =
        std::any_of(covers.begin(), covers.end(), [](const Cover& c) { return c.way < 0; });
    if (any_opposite)
      add_rest(segments[i], covers, width, out);
    else
      out.push_back(segments[i]);
  }
  return out;
}

}  // namespace lrb::render
