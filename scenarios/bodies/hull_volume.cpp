#include "scenarios/bodies/hull_volume.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "engine/exact/predicates.hpp"

namespace lrb::bodies {
namespace {

using Points = std::span<const Eigen::Vector3d>;
constexpr std::uint32_t kNone = 0xffffffffu;

struct HullFace {
  std::array<std::uint32_t, 3> corner;
  std::array<std::uint32_t, 3> across{kNone, kNone,
                                      kNone};  ///< the face over the edge from corner i to i + 1
  std::vector<std::uint32_t> above{};          ///< points in front of it that no other face took
  bool alive = true;
};

class QuickHull {
 public:
  explicit QuickHull(Points points) : p_(points) {}

  double volume() {
    if (!start()) return 0;
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      while (faces_[f].alive && !faces_[f].above.empty()) add(farthest(f), f);
    const Eigen::Vector3d o = p_[faces_[0].corner[0]];
    double six = 0;
    for (const HullFace& f : faces_)
      if (f.alive) six += (p_[f.corner[0]] - o).dot((p_[f.corner[1]] - o).cross(p_[f.corner[2]] - o));
    return six / 6;
  }

 private:
  int side(const HullFace& f, std::uint32_t point) const {
    return exact::orient3d(p_[f.corner[0]].data(), p_[f.corner[1]].data(), p_[f.corner[2]].data(),
                           p_[point].data());
  }

  /// Four points that span space; false if there are none.
  bool start() {
    const auto n = static_cast<std::uint32_t>(p_.size());
    if (n < 4) return false;
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    for (std::uint32_t i = 0; i < n; ++i) a = p_[i].x() < p_[a].x() ? i : a;
    for (std::uint32_t i = 0; i < n; ++i)
      b = (p_[i] - p_[a]).squaredNorm() > (p_[b] - p_[a]).squaredNorm() ? i : b;
    const auto from_line = [&](std::uint32_t i) {
      return (p_[b] - p_[a]).cross(p_[i] - p_[a]).squaredNorm();
    };
    c = a;
    for (std::uint32_t i = 0; i < n; ++i) c = from_line(i) > from_line(c) ? i : c;
    if (exact::collinear3d(p_[a].data(), p_[b].data(), p_[c].data())) return false;
    const HullFace base{{a, b, c}};
    const Eigen::Vector3d normal = (p_[b] - p_[a]).cross(p_[c] - p_[a]);
    const auto from_plane = [&](std::uint32_t i) { return std::abs(normal.dot(p_[i] - p_[a])); };
    d = a;
    for (std::uint32_t i = 0; i < n; ++i)
      if (side(base, i) != 0 && (d == a || from_plane(i) > from_plane(d))) d = i;
    if (d == a) return false;
    if (side(base, d) > 0) std::swap(b, c);  // the fourth point lies behind the first face
    faces_ = {HullFace{{a, b, c}}, HullFace{{a, d, b}}, HullFace{{b, d, c}}, HullFace{{c, d, a}}};
    std::vector<std::uint32_t> all(n);
    for (std::uint32_t i = 0; i < n; ++i) all[i] = i;
    link(0);
    hand_out(all, 0);
    return true;
  }

  std::uint32_t farthest(std::uint32_t face) const {
    const HullFace& f = faces_[face];
    const Eigen::Vector3d o = p_[f.corner[0]], normal = (p_[f.corner[1]] - o).cross(p_[f.corner[2]] - o);
    return *std::max_element(f.above.begin(), f.above.end(), [&](std::uint32_t i, std::uint32_t j) {
      return normal.dot(p_[i] - o) < normal.dot(p_[j] - o);
    });
  }

  /// Replaces all faces that a point sees by a fan from it.
  void add(std::uint32_t point, std::uint32_t from) {
    std::vector<std::uint32_t> seen = {from}, orphans;
    faces_[from].alive = false;
    struct Edge {
      std::uint32_t a, b, beyond;
    };
    std::vector<Edge> horizon;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const HullFace& f = faces_[seen[i]];
      orphans.insert(orphans.end(), f.above.begin(), f.above.end());
      for (std::size_t e = 0; e < 3; ++e) {
        HullFace& g = faces_[f.across[e]];
        if (!g.alive) continue;
        if (side(g, point) > 0) {
          g.alive = false;
          seen.push_back(f.across[e]);
        } else {
          horizon.push_back({f.corner[e], f.corner[(e + 1) % 3], f.across[e]});
        }
      }
    }
    const auto first = static_cast<std::uint32_t>(faces_.size());
    for (const Edge& e : horizon) {
      HullFace& g = faces_[e.beyond];
      for (std::size_t i = 0; i < 3; ++i)
        if (g.corner[i] == e.b && g.corner[(i + 1) % 3] == e.a)
          g.across[i] = static_cast<std::uint32_t>(faces_.size());
      HullFace fan{{e.a, e.b, point}};
      fan.across[0] = e.beyond;
      faces_.push_back(std::move(fan));
    }
    for (const std::uint32_t f : seen) faces_[f].above = {};
    link(first);
    hand_out(orphans, first);
  }

  /// Joins the faces from `first` on over the edges that they share.
  void link(std::uint32_t first) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::size_t>> open;
    for (std::uint32_t f = first; f < faces_.size(); ++f) {
      for (std::size_t e = 0; e < 3; ++e) {
        if (faces_[f].across[e] != kNone) continue;
        const std::uint32_t a = faces_[f].corner[e], b = faces_[f].corner[(e + 1) % 3];
        const auto it = open.find({b, a});
        if (it == open.end()) {
          open[{a, b}] = {f, e};
          continue;
        }
        faces_[f].across[e] = it->second.first;
        faces_[it->second.first].across[it->second.second] = f;
        open.erase(it);
      }
    }
  }

  void hand_out(const std::vector<std::uint32_t>& points, std::uint32_t first) {
    for (const std::uint32_t i : points) {
      for (std::uint32_t f = first; f < faces_.size(); ++f) {
        if (side(faces_[f], i) <= 0) continue;
        faces_[f].above.push_back(i);
        break;
      }
    }
  }

  Points p_;
  std::vector<HullFace> faces_;
};

}  // namespace

double hull_volume(Points points) {
  return QuickHull(points).volume();
}

double hull_area(Points points) {
  std::vector<Eigen::Vector3d> p(points.begin(), points.end());
  std::sort(p.begin(), p.end(),
            [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  double twice = 0;
  for (int half = 0; half < 2; ++half) {  // Andrew's monotone chain: the lower half, then the upper one
    std::vector<Eigen::Vector3d> chain;
    for (const Eigen::Vector3d& x : p) {
      while (chain.size() > 1 &&
             exact::orient2d(chain[chain.size() - 2].data(), chain.back().data(), x.data()) <= 0)
        chain.pop_back();
      chain.push_back(x);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      twice += chain[i].x() * chain[i + 1].y() - chain[i].y() * chain[i + 1].x();
    std::reverse(p.begin(), p.end());
  }
  return twice / 2;
}

}  // namespace lrb::bodies
