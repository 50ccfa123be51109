#include "engine/build/region_split.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "engine/mesh/disjoint_sets.hpp"

namespace lrb {
namespace {

using Vector3 = Eigen::Vector3d;

class Splitter {
 public:
  Splitter(const HullMesh& hull, const Patch& patch, const CapSurface& cap)
      : hull_(hull), patch_(patch), cap_(cap), old_count_(static_cast<std::uint32_t>(patch.slots.size())),
        sets_(patch.slots.size() + cap.faces().size()) {
    out_.of_old.assign(patch.slots.size(), 0);
    out_.of_new.assign(cap.faces().size(), kNull);
    for (std::uint32_t f = 0; f < cap.faces().size(); ++f) {
      const auto& face = cap.faces()[f];
      if (!face.alive) continue;
      if (face.kept >= 0)
        out_.of_old[face.kept] = kNull;
      else
        out_.of_new[f] = 0;
    }
  }

  RegionPieces run() {
    join_new();
    join_old();
    number();
    merge_shells();
    return std::move(out_);
  }

 private:
  struct Edge {
    std::uint64_t key;
    std::uint32_t face;
    bool operator<(const Edge& other) const { return key < other.key; }
  };

  /// Vertices of both surfaces in one numbering.
  std::uint64_t name(int v) const { return v < cap_.first_new() ? cap_.corner(v) : hull_.point_count() + static_cast<std::uint32_t>(v); }
  static std::uint64_t key(std::uint64_t a, std::uint64_t b) { return a << 32 | b; }

  void join_new() {
    for (std::uint32_t f = 0; f < out_.of_new.size(); ++f) {
      if (out_.of_new[f] == kNull) continue;
      for (int i = 0; i < 3; ++i)
        edges_.push_back({key(name(cap_.faces()[f].v[i]), name(cap_.faces()[f].v[(i + 1) % 3])), f});
    }
    std::sort(edges_.begin(), edges_.end());
    met_.assign(edges_.size(), false);
  }

  void join_old() {
    for (std::uint32_t i = 0; i < old_count_; ++i) {
      if (out_.of_old[i] == kNull) continue;
      const auto& t = hull_[patch_.slots[i]];
      for (int j = 0; j < 3; ++j) {
        const Edge wanted{key(t.v[j], t.v[(j + 1) % 3]), 0};
        const auto e = std::lower_bound(edges_.begin(), edges_.end(), wanted);
        if (e != edges_.end() && e->key == wanted.key) {
          sets_.join(i, old_count_ + e->face);
          met_[static_cast<std::size_t>(e - edges_.begin())] = true;
        } else if (const int other = cap_.local_face(patch_, t.across[j]); other >= 0) {
          sets_.join(i, static_cast<std::uint32_t>(other));
        }
      }
      if (hull_.has_polygons()) {
        const auto unit = hull_.unit(patch_.slots[i]);
        for (HullMesh::Slot s = unit.first; s < unit.last; ++s)
          if (const int other = cap_.local_face(patch_, s); other >= 0 && out_.of_old[other] != kNull)
            sets_.join(i, static_cast<std::uint32_t>(other));
      }
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (met_[e]) continue;  // its triangle goes on in the patch there
      const auto& face = cap_.faces()[edges_[e].face];
      for (int j = 0; j < 3; ++j)
        if (key(name(face.v[j]), name(face.v[(j + 1) % 3])) == edges_[e].key && face.across[j] >= 0)
          sets_.join(old_count_ + edges_[e].face, old_count_ + static_cast<std::uint32_t>(face.across[j]));
    }
  }

  void number() {
    std::vector<std::uint32_t> number(old_count_ + out_.of_new.size(), kNull);
    const auto assign = [&](std::uint32_t& piece, std::uint32_t node) {
      if (piece == kNull) return;
      std::uint32_t& n = number[sets_.leader(node)];
      if (n == kNull) n = out_.count++;
      piece = n;
    };
    for (std::uint32_t i = 0; i < old_count_; ++i) assign(out_.of_old[i], i);
    for (std::uint32_t f = 0; f < out_.of_new.size(); ++f) assign(out_.of_new[f], old_count_ + f);
  }

  void merge_shells() {
    if (out_.count <= 1) return;
    const Vector3 origin = hull_.x(hull_[patch_.slots[0]].v[0]);
    const auto volume = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
      return (a - origin).dot((b - origin).cross(c - origin));
    };
    std::vector<double> volumes(out_.count, 0);
    for (std::uint32_t f = 0; f < out_.of_new.size(); ++f) {
      const auto& v = cap_.faces()[f].v;
      if (out_.of_new[f] != kNull) volumes[out_.of_new[f]] += volume(cap_.x(v[0]), cap_.x(v[1]), cap_.x(v[2]));
    }
    for (std::uint32_t i = 0; i < old_count_; ++i) {
      const auto& v = hull_[patch_.slots[i]].v;
      if (out_.of_old[i] != kNull) volumes[out_.of_old[i]] -= volume(hull_.x(v[0]), hull_.x(v[1]), hull_.x(v[2]));
    }
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
    std::vector<std::uint32_t> renumbered(out_.count);
    std::uint32_t next = 0;
    for (std::uint32_t p = 0; p < out_.count; ++p)
      if (volumes[p] > 0 || p == largest) renumbered[p] = next++;
    for (std::uint32_t p = 0; p < out_.count; ++p)
      if (!(volumes[p] > 0) && p != largest) renumbered[p] = renumbered[largest];
    out_.count = next;
    for (auto* pieces : {&out_.of_old, &out_.of_new})
      for (std::uint32_t& p : *pieces)
        if (p != kNull) p = renumbered[p];
  }

  const HullMesh& hull_;
  const Patch& patch_;
  const CapSurface& cap_;
  const std::uint32_t old_count_;
  DisjointSets sets_;  ///< the patch's triangles, then the cap's
  std::vector<Edge> edges_;
  std::vector<bool> met_;
  RegionPieces out_;
};

}  // namespace

RegionPieces split_region(const HullMesh& hull, const Patch& patch, const CapSurface& cap) {
  return Splitter(hull, patch, cap).run();
}

}  // namespace lrb
