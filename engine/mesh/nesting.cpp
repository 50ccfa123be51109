// Orientation of closed components by nesting depth:
// 1. Candidates: component A is in B if a vertex of A is inside B (ray parity, all components in one
//    traversal).
// 2. Candidates whose surfaces cross are dropped, because neither is then entirely inside the other.
// 3. A component inside an even number of others must have positive volume, at odd depth negative.
#include "engine/mesh/nesting.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "engine/mesh/box_pairs.hpp"
#include "engine/mesh/point_inside.hpp"
#include "engine/mesh/self_intersections.hpp"
#include "engine/mesh/volume_sign.hpp"

namespace lrb {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< (inner component, outer component)

class Nesting {
 public:
  Nesting(const Mesh& mesh, const std::vector<FaceUse>& use, const SurfaceTopology& topology)
      : mesh_(mesh),
        use_(use),
        topology_(topology),
        faces_(topology.components),
        boxes_(topology.components),
        usable_(topology.component_closed),
        depth_(topology.components, 0) {
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      const std::uint32_t c = topology.component_of_face[f];
      if (c == kNull) continue;
      // A coordinate that is not finite: exact tests cannot use the component.
      if (use[f] < FaceUse::points) usable_[c] = false;
      faces_[c].push_back(f);
      for (const VertexId v : mesh.face(f)) boxes_[c].extend(mesh.vertices[v]);
    }
  }

  std::vector<std::vector<FaceId>> wrongly_facing() {
    // Depth is the number of components around. The sign of the volume is exact.
    std::vector<Pair> nested = find_nested();
    drop_crossing(nested);
    for (const Pair& p : nested) ++depth_[p.first];
    std::vector<std::vector<FaceId>> wrong;
    for (std::uint32_t c = 0; c < faces_.size(); ++c)
      if (usable_[c] && volume_sign(mesh_, faces_[c]) == (depth_[c] % 2 == 0 ? -1 : 1))
        wrong.push_back(faces_[c]);
    return wrong;
  }

 private:
  /// Finds which components lie in which others. One lies in another if one of its vertices does. A vertex on
  /// the other's surface does not decide, so the next one is tried. If all tried vertices are on it, the two
  /// count as sharing their surface, and neither is a void of the other.
  std::vector<Pair> find_nested() const {
    std::vector<Pair> nested;
    // Nesting takes two components.
    if (std::count(usable_.begin(), usable_.end(), true) < 2) return nested;
    // Only usable components take part in the search.
    std::vector<std::uint32_t> surface = topology_.component_of_face;
    for (std::uint32_t& c : surface)
      if (c != kNull && !usable_[c]) c = kNull;
    const SideFinder finder(mesh_, std::move(surface));
    for (std::uint32_t inner = 0; inner < faces_.size(); ++inner) {
      if (!usable_[inner]) continue;
      // A bounded number of vertices is tried, so the cost per component is bounded.
      const std::vector<VertexId> tried = first_corners(inner);
      const auto point = [&](std::size_t i) {
        return i < tried.size() ? &mesh_.vertices[tried[i]] : nullptr;
      };
      for (const std::uint32_t outer : finder.around(inner, point))
        // Necessary for nesting, and cheap: discards components that only reach into each other.
        if (boxes_[outer].contains(boxes_[inner])) nested.emplace_back(inner, outer);
    }
    return nested;
  }

  /// Corners of a component's first faces, a few of each.
  std::vector<VertexId> first_corners(std::uint32_t component) const {
    static constexpr std::size_t kFaces = 16, kOfEach = 8;
    std::vector<VertexId> corners;
    for (std::size_t i = 0; i < std::min(kFaces, faces_[component].size()); ++i) {
      const auto face = mesh_.face(faces_[component][i]);
      const auto few = face.first(std::min(kOfEach, face.size()));
      corners.insert(corners.end(), few.begin(), few.end());
    }
    return corners;
  }

  void drop_crossing(std::vector<Pair>& nested) const {
    if (nested.empty()) return;
    // Sorted for binary search: the filter below runs for every pair of faces with overlapping boxes.
    std::sort(nested.begin(), nested.end());
    const auto is_candidate = [&](std::uint32_t a, std::uint32_t b) {
      return std::binary_search(nested.begin(), nested.end(), Pair(a, b));
    };
    std::set<Pair> crossing;
    const auto components = [&](FaceId f, FaceId g) {
      return Pair(topology_.component_of_face[f], topology_.component_of_face[g]);
    };
    const auto wanted = [&](FaceId f, FaceId g) {
      const auto [a, b] = components(f, g);
      // Exact tests only for candidates that are not refuted yet.
      return a != b && (is_candidate(a, b) || is_candidate(b, a)) && !crossing.contains({a, b});
    };
    find_crossings(mesh_, use_, wanted, [&](FaceId f, FaceId g) {
      const auto [a, b] = components(f, g);
      crossing.insert({a, b});
      crossing.insert({b, a});
    });
    std::erase_if(nested, [&](const Pair& p) { return crossing.contains(p); });
  }

  const Mesh& mesh_;
  const std::vector<FaceUse>& use_;
  const SurfaceTopology& topology_;
  std::vector<std::vector<FaceId>> faces_;  ///< (components)
  std::vector<Box> boxes_;                  ///< (components)
  std::vector<bool> usable_;                ///< closed, all coordinates finite
  std::vector<std::uint32_t> depth_;        ///< number of components around each
};

}  // namespace

std::vector<std::vector<FaceId>> wrongly_facing_components(const Mesh& mesh, const std::vector<FaceUse>& use,
                                                           const SurfaceTopology& topology) {
  return Nesting(mesh, use, topology).wrongly_facing();
}

}  // namespace lrb
