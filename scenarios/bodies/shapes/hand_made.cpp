#include "scenarios/bodies/shapes/hand_made.hpp"

namespace lrb::shapes {
namespace {

void add(LrbData& d, std::initializer_list<VertexId> corners, CellId inner, CellId outer) {
  d.face_vertices.insert(d.face_vertices.end(), corners);
  d.face_offsets.push_back(static_cast<std::uint32_t>(d.face_vertices.size()));
  d.inner_cell.push_back(inner);
  d.outer_cell.push_back(outer);
  if (inner == kSolid) ++d.real_face_count;
}

void add_quad(LrbData& d, VertexId p, VertexId q, VertexId r, VertexId s, CellId inner, CellId outer) {
  add(d, {p, q, r}, inner, outer);
  add(d, {p, r, s}, inner, outer);
}

}  // namespace

LrbRep dented_box() {
  LrbData d;
  d.name = "dented box";
  d.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 2}, {4, 0, 2}, {4, 4, 2}, {0, 4, 2},
                {1, 1, 2}, {3, 1, 2}, {3, 3, 2}, {1, 3, 2}, {1, 1, 1}, {3, 1, 1}, {3, 3, 1}, {1, 3, 1}};
  d.region_layer = {0};
  d.closed = true;
  add_quad(d, 0, 3, 2, 1, kSolid, kOutside);  // bottom
  add_quad(d, 0, 1, 5, 4, kSolid, kOutside);
  add_quad(d, 1, 2, 6, 5, kSolid, kOutside);
  add_quad(d, 2, 3, 7, 6, kSolid, kOutside);
  add_quad(d, 3, 0, 4, 7, kSolid, kOutside);
  add_quad(d, 4, 5, 9, 8, kSolid, kOutside);  // rim
  add_quad(d, 5, 6, 10, 9, kSolid, kOutside);
  add_quad(d, 6, 7, 11, 10, kSolid, kOutside);
  add_quad(d, 7, 4, 8, 11, kSolid, kOutside);
  add_quad(d, 8, 9, 13, 12, kSolid, 0);  // dent
  add_quad(d, 9, 10, 14, 13, kSolid, 0);
  add_quad(d, 10, 11, 15, 14, kSolid, 0);
  add_quad(d, 11, 8, 12, 15, kSolid, 0);
  add_quad(d, 12, 13, 14, 15, kSolid, 0);
  add_quad(d, 8, 9, 10, 11, 0, kOutside);  // lid
  return LrbRep(std::move(d));
}

LrbRep stairs_2d() {
  LrbData d;
  d.dim = 2;
  d.name = "stairs";
  d.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}, {3, 2, 0}, {2, 2, 0},
                {2, 3, 0}, {1, 3, 0}, {1, 4, 0}, {0, 4, 0}, {4, 4, 0}};
  d.region_layer = {0, 1};
  d.closed = true;
  add(d, {0, 1}, kSolid, kOutside);
  add(d, {1, 2}, kSolid, kOutside);
  add(d, {2, 3}, kSolid, 1);
  add(d, {3, 4}, kSolid, 1);
  add(d, {4, 5}, kSolid, 0);
  add(d, {5, 6}, kSolid, 0);
  add(d, {6, 7}, kSolid, 1);
  add(d, {7, 8}, kSolid, 1);
  add(d, {8, 9}, kSolid, kOutside);
  add(d, {9, 0}, kSolid, kOutside);
  add(d, {4, 6}, 0, 1);          // lid of region 0
  add(d, {2, 10}, 1, kOutside);  // lids of region 1
  add(d, {10, 8}, 1, kOutside);
  return LrbRep(std::move(d));
}

}  // namespace lrb::shapes
