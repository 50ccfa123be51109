#include "engine/mesh/self_intersections.hpp"

#include <array>
#include <atomic>

#include "engine/exact/orient_axes.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/simplex_test.hpp"
#include "engine/mesh/box_pairs.hpp"
#include "engine/mesh/polygon_shape.hpp"

namespace lrb {
namespace {

using Triangle = std::array<VertexId, 3>;

/// Returns true if two triangles lie in one plane, face the same way and share more than points and lines.
bool cover_each_other(const double* const a[3], const double* const b[3]) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    const int turn = exact::orient_axes(a[0], a[1], a[2], x, y);
    if (turn == 0) continue;
    if (exact::orient_axes(b[0], b[1], b[2], x, y) != turn) return false;
    // If two convex figures have nothing in common but their rims, a side of one has the other beyond it.
    const auto parted = [&](const double* const p[3], const double* const q[3]) {
      for (int i = 0; i < 3; ++i) {
        bool beyond = true;
        for (int k = 0; k < 3; ++k)
          beyond &= exact::orient_axes(p[i], p[(i + 1) % 3], q[k], x, y) * turn <= 0;
        if (beyond) return true;
      }
      return false;
    };
    return !parted(a, b) && !parted(b, a);
  }
  return false;
}

bool overlap_3d(const double* const a[3], const double* const b[3]) {
  for (int k = 0; k < 3; ++k)
    if (exact::orient3d(a[0], a[1], a[2], b[k]) != 0)
      return exact::meet_triangles(a, b) == exact::Meet::cross;
  return cover_each_other(a, b);
}

/// Returns true if two segments, which have the solid on their left, cross, or overlap on one line and run
/// the same way.
bool overlap_2d(const double* const a[2], const double* const b[2]) {
  if (exact::orient2d(a[0], a[1], b[0]) != 0 || exact::orient2d(a[0], a[1], b[1]) != 0)
    return exact::meet_segments(a, b) == exact::Meet::cross;
  const int k = a[0][0] != a[1][0] ? 0 : 1;
  const bool forward = a[0][k] < a[1][k];
  if (forward != (b[0][k] < b[1][k])) return false;
  return forward ? a[0][k] < b[1][k] && b[0][k] < a[1][k] : a[0][k] > b[1][k] && b[0][k] > a[1][k];
}

/// The faces as triangles with area (2D: as segments), and their boxes.
class Pieces {
 public:
  Pieces(const Mesh& mesh, const std::vector<FaceUse>& use) : mesh_(mesh), boxes_(mesh.face_count()) {
    offsets_.reserve(mesh.face_count() + 1);
    triangles_.reserve(mesh.face_count());
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      offsets_.push_back(static_cast<std::uint32_t>(triangles_.size()));
      if (use[f] < FaceUse::area) continue;
      for (const VertexId v : mesh.face(f)) boxes_[f].extend(mesh.vertices[v]);
      if (mesh.dim == 3) add_triangles(f, use[f]);
    }
    offsets_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  }

  const std::vector<Box>& boxes() const { return boxes_; }

  bool meet_outside_shared(FaceId f, FaceId g) const {
    if (mesh_.dim == 2) {
      const auto a = mesh_.face(f), b = mesh_.face(g);
      const double* const pa[2] = {point(a[0]), point(a[1])};
      const double* const pb[2] = {point(b[0]), point(b[1])};
      return !exact::meet_only_in_shared_2d(pa, a.data(), pb, b.data());
    }
    return any_pair(
        f, g, [](const double* const a[3], const Triangle& ia, const double* const b[3], const Triangle& ib) {
          return !exact::meet_only_in_shared(a, ia.data(), b, ib.data());
        });
  }

  bool overlap(FaceId f, FaceId g) const {
    if (mesh_.dim == 2) {
      const auto a = mesh_.face(f), b = mesh_.face(g);
      const double* const pa[2] = {point(a[0]), point(a[1])};
      const double* const pb[2] = {point(b[0]), point(b[1])};
      return overlap_2d(pa, pb);
    }
    return any_pair(f, g,
                    [](const double* const a[3], const Triangle&, const double* const b[3], const Triangle&) {
                      return overlap_3d(a, b);
                    });
  }

  bool cross(FaceId f, FaceId g) const {
    if (mesh_.dim == 2) {
      const auto a = mesh_.face(f), b = mesh_.face(g);
      const double* const pa[2] = {point(a[0]), point(a[1])};
      const double* const pb[2] = {point(b[0]), point(b[1])};
      return exact::meet_segments(pa, pb) == exact::Meet::cross;
    }
    return any_pair(f, g,
                    [](const double* const a[3], const Triangle&, const double* const b[3], const Triangle&) {
                      return exact::meet_triangles(a, b) == exact::Meet::cross;
                    });
  }

 private:
  const double* point(VertexId v) const { return mesh_.vertices[v].data(); }

  void add_triangles(FaceId f, FaceUse use) {
    const auto corners = mesh_.face(f);
    if (use == FaceUse::convex) {
      triangulate_convex(mesh_, corners, scratch_);
      triangles_.insert(triangles_.end(), scratch_.begin(), scratch_.end());
      return;
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)  // a polygon that is not flat is its fan
      if (!exact::collinear3d(point(corners[0]), point(corners[i]), point(corners[i + 1])))
        triangles_.push_back({corners[0], corners[i], corners[i + 1]});
  }

  template <class Test>
  bool any_pair(FaceId f, FaceId g, Test test) const {
    for (std::uint32_t i = offsets_[f]; i < offsets_[f + 1]; ++i) {
      const Triangle& ia = triangles_[i];
      const double* const a[3] = {point(ia[0]), point(ia[1]), point(ia[2])};
      for (std::uint32_t j = offsets_[g]; j < offsets_[g + 1]; ++j) {
        const Triangle& ib = triangles_[j];
        const double* const b[3] = {point(ib[0]), point(ib[1]), point(ib[2])};
        if (test(a, ia, b, ib)) return true;
      }
    }
    return false;
  }

  const Mesh& mesh_;
  std::vector<Box> boxes_;              ///< (|F|), empty for faces left out
  std::vector<std::uint32_t> offsets_;  ///< (|F| + 1), into triangles_
  std::vector<Triangle> triangles_;
  std::vector<Triangle> scratch_;
};

}  // namespace

void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<void(FaceId, FaceId)>& found) {
  const Pieces pieces(mesh, use);
  BoxTree(pieces.boxes()).for_each_pair([&](FaceId f, FaceId g) {
    if (pieces.meet_outside_shared(f, g)) found(f, g);
  });
}

std::vector<FaceId> self_intersecting_faces(const Mesh& mesh, const std::vector<FaceUse>& use,
                                            Workers& workers) {
  const Pieces pieces(mesh, use);
  std::vector<std::atomic<bool>> meets(mesh.face_count());
  BoxTree(pieces.boxes())
      .for_each_pair(
          [&](FaceId f, FaceId g) {
            if (!(meets[f] && meets[g]) && pieces.meet_outside_shared(f, g)) meets[f] = meets[g] = true;
          },
          workers);
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < meets.size(); ++f)
    if (meets[f]) faces.push_back(f);
  return faces;
}

void find_crossings(const Mesh& mesh, const std::vector<FaceUse>& use,
                    const std::function<bool(FaceId, FaceId)>& wanted,
                    const std::function<void(FaceId, FaceId)>& found) {
  const Pieces pieces(mesh, use);
  BoxTree(pieces.boxes()).for_each_pair([&](FaceId f, FaceId g) {
    if (wanted(f, g) && pieces.cross(f, g)) found(f, g);
  });
}

void find_overlaps(const Mesh& mesh, const std::vector<FaceUse>& use,
                   const std::function<bool(FaceId, FaceId)>& wanted,
                   const std::function<void(FaceId, FaceId)>& found) {
  const Pieces pieces(mesh, use);
  BoxTree(pieces.boxes()).for_each_pair([&](FaceId f, FaceId g) {
    if (wanted(f, g) && pieces.overlap(f, g)) found(f, g);
  });
}

}  // namespace lrb
