#include "scenarios/bodies/shapes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <string>
#include <utility>

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

namespace {

constexpr double kPi = std::numbers::pi;

VertexId id(std::size_t i) {
  return static_cast<VertexId>(i);
}

void add(Mesh& mesh, std::initializer_list<VertexId> corners) {
  mesh.add_face(std::span<const VertexId>(corners.begin(), corners.size()));
}

void add_quad(Mesh& mesh, VertexId a, VertexId b, VertexId c, VertexId d, bool as_quad) {
  if (as_quad) return add(mesh, {a, b, c, d});
  add(mesh, {a, b, c});
  add(mesh, {a, c, d});
}

Mesh unit_cell(const Point3& low, const Point3& high, bool quads) {
  Mesh mesh = voxels(
      1, 1, 1, [](int, int, int) { return true; }, quads);
  for (Point3& v : mesh.vertices) v = (v.array() == 0).select(low, high);
  mesh.name = "box";
  return mesh;
}

Point3 on_torus(int i, int j, int n, int m, double major, double minor) {
  const double u = 2 * kPi * i / n, v = 2 * kPi * j / m;
  const double r = major + minor * deterministic::cos(v);
  return {r * deterministic::cos(u), r * deterministic::sin(u), minor * deterministic::sin(v)};
}

Mesh make_torus(int n, int m, double major, double minor, bool quads) {
  Mesh mesh;
  mesh.name = "torus";
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) mesh.vertices.push_back(on_torus(i, j, n, m, major, minor));
  const auto at = [&](int i, int j) { return id(static_cast<std::size_t>((i % n) * m + j % m)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), quads);
  return mesh;
}

Mesh unit_icosphere(int level) {
  Mesh mesh = icosahedron();
  for (int i = 0; i < level; ++i) mesh = subdivided(mesh);
  for (Point3& v : mesh.vertices) v.normalize();
  mesh.name = "icosphere";
  return mesh;
}

/// Returns a quarter circle from the pole (0, -radius) to the equator (radius, 0); the pole lies exactly on
/// the axis.
std::vector<Point2> quarter(int stacks, double radius) {
  std::vector<Point2> arc;
  for (int i = 0; i <= stacks; ++i) {
    const double angle = kPi / 2 * i / stacks;
    arc.emplace_back(radius * deterministic::sin(angle), -radius * deterministic::cos(angle));
  }
  arc.back() = {radius, 0};
  return arc;
}

Mesh radial(int corners, const std::function<double(int)>& radius) {
  std::vector<Point2> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * kPi * i / corners;
    points.emplace_back(radius(i) * deterministic::cos(angle), radius(i) * deterministic::sin(angle));
  }
  return polygon(points);
}

}  // namespace

Mesh subdivided(const Mesh& in) {
  Mesh out;
  out.vertices = in.vertices;
  std::map<std::pair<VertexId, VertexId>, VertexId> midpoints;
  const auto midpoint = [&](VertexId a, VertexId b) {
    const auto [it, fresh] = midpoints.try_emplace(std::minmax(a, b), id(out.vertices.size()));
    if (fresh) out.vertices.push_back((in.vertices[a] + in.vertices[b]) / 2);
    return it->second;
  };
  for (FaceId f = 0; f < in.face_count(); ++f) {
    const auto c = in.face(f);
    const VertexId ab = midpoint(c[0], c[1]), bc = midpoint(c[1], c[2]), ca = midpoint(c[2], c[0]);
    add(out, {c[0], ab, ca});
    add(out, {c[1], bc, ab});
    add(out, {c[2], ca, bc});
    add(out, {ab, bc, ca});
  }
  return out;
}

Mesh icosahedron() {
  const double g = std::numbers::phi;
  Mesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  static constexpr VertexId kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (const auto& f : kFaces) mesh.add_face(f);
  return mesh;
}

Mesh tetrahedron(double size) {
  Mesh mesh;
  mesh.name = "tetrahedron";
  mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  add(mesh, {0, 2, 1});
  add(mesh, {0, 1, 3});
  add(mesh, {0, 3, 2});
  add(mesh, {1, 2, 3});
  return mesh;
}

Mesh box(const Point3& low, const Point3& high) {
  return unit_cell(low, high, false);
}
Mesh quad_box(const Point3& low, const Point3& high) {
  return unit_cell(low, high, true);
}

Mesh voxels(int nx, int ny, int nz, const std::function<bool(int, int, int)>& solid, bool quads) {
  const auto holds = [&](std::array<int, 3> c) {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < nx && c[1] < ny && c[2] < nz &&
           solid(c[0], c[1], c[2]);
  };
  Mesh mesh;
  mesh.name = "voxels";
  std::map<std::array<int, 3>, VertexId> known;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [it, fresh] = known.try_emplace(p, id(mesh.vertices.size()));
    if (fresh) mesh.vertices.emplace_back(p[0], p[1], p[2]);
    return it->second;
  };
  const auto side = [&](std::array<int, 3> cell, int axis, int direction) {
    std::array<int, 3> next = cell;
    next[axis] += direction;
    if (!holds(cell) || holds(next)) return;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<VertexId, 4> corner;
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> p = cell;
      if (direction > 0) ++p[axis];
      if (i == 1 || i == 2) ++p[u];
      if (i >= 2) ++p[v];
      corner[i] = vertex(p);
    }
    if (direction < 0) std::swap(corner[1], corner[3]);
    add_quad(mesh, corner[0], corner[1], corner[2], corner[3], quads);
  };
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        for (int axis = 0; axis < 3; ++axis)
          for (const int direction : {-1, 1}) side({i, j, k}, axis, direction);
  return mesh;
}

Mesh l_shape() {
  return voxels(2, 2, 1, [](int i, int j, int) { return i == 0 || j == 0; });
}

Mesh comb(int teeth, int length) {
  return voxels(2 * teeth - 1, length + 1, 1, [](int i, int j, int) { return j == 0 || i % 2 == 0; });
}

Mesh box_with_void() {
  return voxels(3, 3, 3, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
}

Mesh icosphere(int level, double radius, const Point3& centre) {
  return translated(scaled(unit_icosphere(level), radius), centre);
}

Mesh bumpy_sphere(int level, std::uint64_t seed, double amplitude) {
  std::mt19937_64 random(seed);
  // The same on every platform.
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<std::pair<Point3, double>> waves;
  for (int i = 0; i < 6; ++i) {
    const double x = 8 * unit() - 4, y = 8 * unit() - 4, z = 8 * unit() - 4;
    waves.push_back({Point3(x, y, z), 2 * kPi * unit()});
  }
  Mesh mesh = unit_icosphere(level);
  for (Point3& v : mesh.vertices) {
    double height = 0;
    for (const auto& [k, phase] : waves) height += deterministic::sin(k.dot(v) + phase);
    v *= 1 + amplitude * height / static_cast<double>(waves.size());
  }
  mesh.name = "bumpy sphere " + std::to_string(seed);
  return mesh;
}

Mesh revolve(const std::vector<Point2>& profile, int slices) {
  Mesh mesh;
  mesh.name = "revolved";
  const int rings = static_cast<int>(profile.size()) - 2;
  mesh.vertices.emplace_back(0, 0, profile.front().y());
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < slices; ++j) {
      const double angle = 2 * kPi * j / slices;
      mesh.vertices.emplace_back(profile[i].x() * deterministic::cos(angle),
                                 profile[i].x() * deterministic::sin(angle), profile[i].y());
    }
  mesh.vertices.emplace_back(0, 0, profile.back().y());
  const VertexId last = id(mesh.vertices.size() - 1);
  const auto at = [&](int ring, int j) {
    return id(static_cast<std::size_t>(1 + ring * slices + j % slices));
  };
  for (int j = 0; j < slices; ++j) add(mesh, {0, at(0, j + 1), at(0, j)});
  for (int i = 0; i + 1 < rings; ++i)
    for (int j = 0; j < slices; ++j)
      add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j), false);
  for (int j = 0; j < slices; ++j) add(mesh, {at(rings - 1, j), at(rings - 1, j + 1), last});
  return mesh;
}

Mesh uv_sphere(int slices, int stacks, double radius) {
  std::vector<Point2> profile = quarter(stacks, radius);
  for (std::size_t i = profile.size() - 1; i-- > 0;) profile.push_back({profile[i].x(), -profile[i].y()});
  return revolve(profile, slices);
}

Mesh bowl(int slices, int stacks, double thickness) {
  std::vector<Point2> profile = quarter(stacks, 1);
  std::vector<Point2> inner = quarter(stacks, 1 - thickness);
  profile.insert(profile.end(), inner.rbegin(), inner.rend());
  Mesh mesh = revolve(profile, slices);
  mesh.name = "bowl";
  return mesh;
}

Mesh torus(int n, int m, double major, double minor) {
  return make_torus(n, m, major, minor, false);
}
Mesh quad_torus(int n, int m, double major, double minor) {
  return make_torus(n, m, major, minor, true);
}

Mesh open_cylinder(int slices) {
  Mesh mesh;
  mesh.name = "open cylinder";
  for (const double z : {0.0, 1.0})
    for (int j = 0; j < slices; ++j)
      mesh.vertices.emplace_back(deterministic::cos(2 * kPi * j / slices),
                                 deterministic::sin(2 * kPi * j / slices), z);
  const auto at = [&](int ring, int j) { return id(static_cast<std::size_t>(ring * slices + j % slices)); };
  for (int j = 0; j < slices; ++j) add_quad(mesh, at(0, j), at(0, j + 1), at(1, j + 1), at(1, j), false);
  return mesh;
}

Mesh polygon(const std::vector<Point2>& corners) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.name = "polygon";
  for (const Point2& p : corners) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  for (std::size_t i = 0; i < corners.size(); ++i) add(mesh, {id(i), id((i + 1) % corners.size())});
  return mesh;
}

Mesh circle(int corners, double radius) {
  return radial(corners, [=](int) { return radius; });
}

Mesh star(int points, double outer, double inner) {
  return radial(2 * points, [=](int i) { return i % 2 == 0 ? outer : inner; });
}

Mesh gear(int teeth, double outer, double inner) {
  return radial(4 * teeth, [=](int i) { return i % 4 < 2 ? outer : inner; });
}

Mesh comb_2d(int teeth, double length) {
  const double width = 2 * teeth - 1;
  std::vector<Point2> points = {{0, 0}, {width, 0}};
  for (int i = teeth - 1; i >= 0; --i) {
    points.emplace_back(2 * i + 1, length + 1);
    points.emplace_back(2 * i, length + 1);
    if (i == 0) break;
    points.emplace_back(2 * i, 1);
    points.emplace_back(2 * i - 1, 1);
  }
  return polygon(points);
}

Mesh l_shape_2d() {
  return polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
}

Mesh ring_2d(int corners) {
  return several({circle(corners, 1), turned_inside_out(circle(corners, 0.5))});
}

Mesh several(const std::vector<Mesh>& meshes) {
  Mesh all;
  all.name = "several";
  for (const Mesh& mesh : meshes) {
    const VertexId base = id(all.vertices.size());
    all.dim = mesh.dim;
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      std::vector<VertexId> corners(mesh.face(f).begin(), mesh.face(f).end());
      for (VertexId& v : corners) v = VertexId(v + base);
      all.add_face(corners);
    }
  }
  return all;
}

Mesh turned_inside_out(Mesh mesh) {
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    std::reverse(mesh.face_vertices.begin() + mesh.face_offsets[f],
                 mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
  return mesh;
}

Mesh translated(Mesh mesh, const Point3& by) {
  for (Point3& v : mesh.vertices) v += by;
  return mesh;
}

Mesh scaled(Mesh mesh, double by) {
  for (Point3& v : mesh.vertices) v *= by;
  return mesh;
}

}  // namespace lrb::shapes
