#pragma once
/// Small LRB-reps made by hand, with all regions known.

#include <initializer_list>

#include <lrbscope/lrb_rep.hpp>

namespace lrb::toy {

inline void add_face(LrbData& d, std::initializer_list<VertexId> corners, CellId inner, CellId outer) {
  d.face_vertices.insert(d.face_vertices.end(), corners);
  d.face_offsets.push_back(static_cast<std::uint32_t>(d.face_vertices.size()));
  d.inner_cell.push_back(inner);
  d.outer_cell.push_back(outer);
}

/// A square plate with a notch in its top edge that narrows twice; three nested regions: the notch's bottom
/// (0), the rest of the notch (1), and a gable over the whole top (2). 9 real faces (segments), 4 pseudo
/// faces.
///
///            9                 lids: 9 over region 0, 10 over region 1, 11 and 12 over region 2
///          /   .
///   8 -- 7       3 -- 2
///   |     6 - - 4     |
///   |      `-5-´      |
///   0 --------------- 1
inline LrbData notched_plate() {
  LrbData d;
  d.dim = 2;
  d.name = "notched plate";
  d.closed = true;
  d.vertices = {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {5, 6, 0}, {4, 4, 0},
                {3, 2, 0}, {2, 4, 0}, {1, 6, 0}, {0, 6, 0}, {3, 7, 0}};
  const CellId outers[] = {kOutside, kOutside, 2, 1, 0, 0, 1, 2, kOutside};
  for (VertexId i = 0; i < 9; ++i) add_face(d, {i, VertexId((i + 1) % 9)}, kSolid, outers[i]);
  d.real_face_count = 9;
  add_face(d, {4, 6}, 0, 1);
  add_face(d, {3, 7}, 1, 2);
  add_face(d, {2, 9}, 2, kOutside);
  add_face(d, {9, 8}, 2, kOutside);
  d.region_layer = {0, 1, 2};
  return d;
}

/// A square plate with a notch that narrows once; two nested regions: the notch's bottom (0) and the rest of
/// it (1). 7 real faces, 2 lids: small enough for a tree of one block.
inline LrbData small_plate() {
  LrbData d;
  d.dim = 2;
  d.name = "plate";
  d.closed = true;
  d.vertices = {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {4, 4, 0}, {3, 1, 0}, {2, 4, 0}, {0, 6, 0}};
  const CellId outers[] = {kOutside, kOutside, 1, 0, 0, 1, kOutside};
  for (VertexId i = 0; i < 7; ++i) add_face(d, {i, VertexId((i + 1) % 7)}, kSolid, outers[i]);
  d.real_face_count = 7;
  add_face(d, {3, 5}, 0, 1);
  add_face(d, {2, 6}, 1, kOutside);
  d.region_layer = {0, 1};
  return d;
}

/// A tetrahedron whose slanted side is a pit under a lid: one region, 6 real triangles.
inline LrbData dented_tetrahedron() {
  LrbData d;
  d.name = "pit";
  d.closed = true;
  d.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {0.5, 0.5, 0.5}};
  add_face(d, {0, 2, 1}, kSolid, kOutside);
  add_face(d, {0, 1, 3}, kSolid, kOutside);
  add_face(d, {0, 3, 2}, kSolid, kOutside);
  add_face(d, {1, 2, 4}, kSolid, 0);
  add_face(d, {2, 3, 4}, kSolid, 0);
  add_face(d, {3, 1, 4}, kSolid, 0);
  d.real_face_count = 6;
  add_face(d, {1, 2, 3}, 0, kOutside);
  d.region_layer = {0};
  return d;
}

/// A box of side 4 with a pyramid-shaped dent in its top. Region 0 is the dent under a square lid (face 13);
/// region 1 has no volume: it lies between the whole top (face 14) and the frame and lid under it. Faces: 5
/// real quadrangles (bottom and sides), 4 of the frame, 4 real triangles of the dent, 2 pseudo quadrangles.
inline LrbData dented_box() {
  LrbData d;
  d.name = "dented box";
  d.closed = true;
  d.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 4}, {4, 0, 4}, {4, 4, 4},
                {0, 4, 4}, {1, 1, 4}, {3, 1, 4}, {3, 3, 4}, {1, 3, 4}, {2, 2, 2}};
  add_face(d, {0, 3, 2, 1}, kSolid, kOutside);
  for (VertexId i = 0; i < 4; ++i) {
    const VertexId j((i + 1) % 4);
    add_face(d, {i, j, VertexId(j + 4), VertexId(i + 4)}, kSolid, kOutside);
  }
  for (VertexId i = 0; i < 4; ++i) {
    const VertexId j((i + 1) % 4);
    add_face(d, {VertexId(i + 4), VertexId(j + 4), VertexId(j + 8), VertexId(i + 8)}, kSolid, 1);
  }
  for (VertexId i = 0; i < 4; ++i) add_face(d, {VertexId(i + 8), VertexId((i + 1) % 4 + 8), 12}, kSolid, 0);
  d.real_face_count = 13;
  add_face(d, {8, 9, 10, 11}, 0, 1);
  add_face(d, {4, 5, 6, 7}, 1, kOutside);
  d.region_layer = {0, 1};
  return d;
}

}  // namespace lrb::toy
