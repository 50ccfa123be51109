#pragma once
/// What real scans suffer from, done to clean meshes.

#include <algorithm>
#include <set>
#include <vector>

#include "tests/support/bodies.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {

/// The mesh with other faces: `change` gets each face's number and corners and adds what becomes of it.
template <class Change>
Mesh with_faces(const Mesh& m, Change change) {
  Mesh out;
  out.dim = m.dim;
  out.vertices = m.vertices;
  for (FaceId f = 0; f < m.face_count(); ++f) {
    const auto face = m.face(f);
    change(out, f, std::vector<VertexId>(face.begin(), face.end()));
  }
  return out;
}

inline Mesh without_faces(const Mesh& m, const std::set<FaceId>& gone) {
  return with_faces(m, [&](Mesh& out, FaceId f, const std::vector<VertexId>& corners) {
    if (!gone.contains(f)) out.add_face(corners);
  });
}

/// Without the faces all of whose corners satisfy `where`.
template <class Where>
Mesh without_faces_at(const Mesh& m, Where where) {
  return with_faces(m, [&](Mesh& out, FaceId, const std::vector<VertexId>& corners) {
    const auto is_there = [&](VertexId v) { return where(m.vertices[v]); };
    if (!std::all_of(corners.begin(), corners.end(), is_there)) out.add_face(corners);
  });
}

inline Mesh with_flipped(const Mesh& m, const std::set<FaceId>& flipped) {
  return with_faces(m, [&](Mesh& out, FaceId f, std::vector<VertexId> corners) {
    if (flipped.contains(f)) std::reverse(corners.begin(), corners.end());
    out.add_face(corners);
  });
}

/// Those faces once more, at the end; turned round if asked.
inline Mesh with_doubled(Mesh m, const std::set<FaceId>& doubled, bool turned = false) {
  for (const FaceId f : doubled) {
    std::vector<VertexId> corners(m.face(f).begin(), m.face(f).end());
    if (turned) std::reverse(corners.begin(), corners.end());
    m.add_face(corners);
  }
  return m;
}

/// Faces name `into` wherever they named `v`: merges two vertices, or collapses the edge between them.
inline Mesh with_merged(const Mesh& m, VertexId v, VertexId into) {
  return with_faces(m, [&](Mesh& out, FaceId, std::vector<VertexId> corners) {
    std::replace(corners.begin(), corners.end(), v, into);
    out.add_face(corners);
  });
}

/// Each face with vertices of its own, as STL files and the seams of textures have them.
inline Mesh as_soup(const Mesh& m) {
  Mesh out;
  out.dim = m.dim;
  for (FaceId f = 0; f < m.face_count(); ++f) {
    std::vector<Eigen::Vector3d> corners;
    for (const VertexId v : m.face(f)) corners.push_back(m.vertices[v]);
    add_loose(out, corners);
  }
  return out;
}

inline Mesh with_vertices(Mesh m, const std::vector<Eigen::Vector3d>& vertices) {
  m.vertices.insert(m.vertices.end(), vertices.begin(), vertices.end());
  return m;
}

/// A face and the vertices it needs, added at the end.
inline Mesh with_face(Mesh m, const std::vector<Eigen::Vector3d>& vertices, std::vector<VertexId> corners) {
  m = with_vertices(std::move(m), vertices);
  m.add_face(corners);
  return m;
}

}  // namespace lrb::test
