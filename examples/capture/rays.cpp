// rays A.obj RAYS: the first hit of each ray with a mesh, by a tree of boxes, recorded by lrbscope_capture.h.
// RAYS: a line of six numbers for each ray, its origin and direction. Prints the multiple of the direction at
// the hit, or inf.
#include <cmath>
#include <valarray>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

using Vec = std::valarray<double>;
static Triangles mesh;
static std::vector<Node> nodes;
static std::vector<double> boxes;  // least and greatest x, y, z of each node
static double ray[8];              // origin, direction, least and greatest multiple of it

static const auto corner = [](std::size_t i) { return Vec(&mesh.vertices[3 * mesh.corners[i]], 3); };
static const auto cross = [](Vec a, Vec b) { return Vec((a * b.cshift(1) - a.cshift(1) * b).cshift(1)); };

static std::uint32_t build(std::uint32_t first, std::uint32_t last) {  // halves of the mesh's own order
  const auto node = std::uint32_t(nodes.size()), half = (first + last) / 2;
  nodes.emplace_back(), boxes.resize(6 * nodes.size());
  for (int k = 0; k < 3; ++k) {
    Vec all(3 * (last - first));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = corner(3 * first + i)[k];
    boxes[6 * node + k] = all.min(), boxes[6 * node + 3 + k] = all.max();
  }
  for (auto t = first; t < last && last - first <= 2; ++t) nodes[node].triangles.push_back(t);
  if (last - first > 2) nodes[node].children = {node + 1, 0}, build(first, half);
  if (last - first > 2) nodes[node].children[1] = build(half, last);
  return node;
}

static void visit(std::uint32_t node) {
  const Vec origin(ray, 3), direction(ray + 3, 3);
  const Vec s = (Vec(&boxes[6 * node], 3) - origin) / direction,
            t = (Vec(&boxes[6 * node + 3], 3) - origin) / direction;
  double from = ray[6], to = ray[7];
  for (int k = 0; k < 3; ++k)
    from = fmax(from, fmin(s[k], t[k])), to = fmin(to, fmax(s[k], t[k]) * (1 + 1e-15));
  LRBCAP_NODE(node, 0, from <= to, LRBCAP_NO_AXIS);
  if (!(from <= to)) return;
  for (const std::uint32_t f : nodes[node].triangles) {
    const Vec a = corner(3 * f), u = corner(3 * f + 1) - a, v = corner(3 * f + 2) - a, n = cross(u, v);
    const double at = (n * (a - origin)).sum() / (n * direction).sum();
    const Vec x = origin + at * direction - a;
    const double p = (cross(x, v) * n).sum(), q = (cross(u, x) * n).sum();
    const bool hit = at >= ray[6] && at <= ray[7] && p >= 0 && q >= 0 && p + q <= (n * n).sum();
    LRBCAP_PRIM(f, 0, hit);
    if (hit) ray[7] = at;  // the ray ends there
  }
  for (const std::uint32_t child : nodes[node].children) visit(child);
}

int main(int, char** argv) {
  LRBCAP_OPEN("rays in C++", nullptr);
  mesh = read_obj(argv[1]);
  build(0, std::uint32_t(mesh.corners.size() / 3));
  const std::uint32_t tree = describe(mesh, argv[1], LRBCAP_AABB, nodes, boxes);
  std::ifstream in(argv[2]);
  while (in >> ray[0] >> ray[1] >> ray[2] >> ray[3] >> ray[4] >> ray[5]) {
    ray[6] = 0, ray[7] = HUGE_VAL;
    LRBCAP_RAY(LRBCAP_DISTANCE, tree, nullptr, ray);
    visit(0);
    if (ray[7] < HUGE_VAL) LRBCAP_VALUE(ray[7], ray[7]);
    LRBCAP_END(ray[7] < HUGE_VAL ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
    std::cout << ray[7] << "\n";
  }
  LRBCAP_CLOSE();
}
