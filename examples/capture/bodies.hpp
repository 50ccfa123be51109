// Reads bodies and poses, describes trees and traces rays, for the recorded engines in C++.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <valarray>
#include <vector>

#include <lrbscope_capture.h>

struct Triangles {
  std::vector<double> vertices;
  std::vector<std::uint32_t> corners;
};

using Pose = std::array<double, 12>;  // 3x4, row by row

/// Reads vertices and faces of an OBJ; a polygon becomes a fan.
inline Triangles read_obj(const std::string& path) {
  Triangles body;
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + ": cannot open the file");
  for (std::string line, word; std::getline(in, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "v") {
      for (int k = 0; k < 3; ++k) words >> body.vertices.emplace_back();
    } else if (word == "f") {
      std::vector<std::uint32_t> face;
      while (words >> word) face.push_back(static_cast<std::uint32_t>(std::stoul(word) - 1));
      for (std::size_t i = 2; i < face.size(); ++i)
        for (const std::uint32_t v : {face[0], face[i - 1], face[i]}) body.corners.push_back(v);
    }
  }
  return body;
}

/// Reads a pose from each line with 12 numbers.
inline std::vector<Pose> read_poses(const std::string& path) {
  std::vector<Pose> poses;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream numbers(line);
    Pose pose;
    for (double& x : pose) numbers >> x;
    if (numbers) poses.push_back(pose);
  }
  return poses;
}

struct Node {
  std::vector<std::uint32_t> children, triangles;
};

/// Describes a mesh and its tree. Returns the number of the tree in the capture.
inline std::uint32_t describe(const Triangles& mesh, const std::string& name, std::uint32_t volume,
                              const std::vector<Node>& nodes, const std::vector<double>& volumes) {
  std::vector<std::uint32_t> first_child{0}, child, first_prim{0}, prim;
  for (const Node& node : nodes) {
    child.insert(child.end(), node.children.begin(), node.children.end());
    prim.insert(prim.end(), node.triangles.begin(), node.triangles.end());
    first_child.push_back(static_cast<std::uint32_t>(child.size()));
    first_prim.push_back(static_cast<std::uint32_t>(prim.size()));
  }
  lrbcap_tree tree = {};
  tree.mesh = LRBCAP_MESH(name.c_str(), mesh.vertices.size() / 3, mesh.vertices.data(),
                          mesh.corners.size() / 3, mesh.corners.data());
  tree.nodes = static_cast<std::uint32_t>(nodes.size());
  tree.volume = volume;
  tree.first_child = first_child.data();
  tree.child = child.data();
  tree.first_prim = first_prim.data();
  tree.prim = prim.data();
  tree.volumes = volumes.data();
  return LRBCAP_TREE(&tree);
}

/// Traces rays to their first hits with a mesh, by a tree of boxes (least and greatest x, y, z), and records
/// it.
class RayTracer {
  using Vec = std::valarray<double>;
  const Triangles& mesh;
  const std::vector<Node>& nodes;
  const std::vector<double>& boxes;
  double ray[8] = {};  // origin, direction, least and greatest multiple of it

  bool meets(const double* box) const {
    const Vec origin(ray, 3), direction(ray + 3, 3);
    const Vec s = (Vec(box, 3) - origin) / direction, t = (Vec(box + 3, 3) - origin) / direction;
    double from = ray[6], to = ray[7];
    for (std::size_t k = 0; k < 3; ++k)
      from = std::fmax(from, std::fmin(s[k], t[k])), to = std::fmin(to, std::fmax(s[k], t[k]) * (1 + 1e-15));
    return from <= to;
  }
  double hit(std::uint32_t f) const {  // the multiple of the direction there, or HUGE_VAL
    const auto corner = [&](std::size_t i) { return Vec(&mesh.vertices[3 * mesh.corners[3 * f + i]], 3); };
    const auto cross = [](Vec a, Vec b) { return Vec((a * b.cshift(1) - a.cshift(1) * b).cshift(1)); };
    const Vec origin(ray, 3), direction(ray + 3, 3), a = corner(0), u = corner(1) - a, v = corner(2) - a;
    const Vec n = cross(u, v);
    const double at = (n * (a - origin)).sum() / (n * direction).sum();
    const Vec x = origin + at * direction - a;
    const double p = (cross(x, v) * n).sum(), q = (cross(u, x) * n).sum();
    return at >= ray[6] && at <= ray[7] && p >= 0 && q >= 0 && p + q <= (n * n).sum() ? at : HUGE_VAL;
  }
  void visit(std::uint32_t node) {
    const bool met = meets(&boxes[6 * node]);
    LRBCAP_NODE(node, 0, met, LRBCAP_NO_AXIS);
    if (!met) return;
    for (const std::uint32_t f : nodes[node].triangles) {
      const double at = hit(f);
      LRBCAP_PRIM(f, 0, at < HUGE_VAL);
      ray[7] = std::fmin(ray[7], at);  // the ray ends there
    }
    for (const std::uint32_t child : nodes[node].children) visit(child);
  }

 public:
  RayTracer(const Triangles& m, const std::vector<Node>& n, const std::vector<double>& b)
      : mesh(m), nodes(n), boxes(b) {}

  /// Traces a ray for each line of six numbers of a file, origin and direction. Prints the multiple of the
  /// direction at each hit, or inf.
  int run(const char* engine, const char* name, const char* rays) {
    LRBCAP_OPEN(engine, nullptr);
    const std::uint32_t tree = describe(mesh, name, LRBCAP_AABB, nodes, boxes);
    std::ifstream in(rays);
    while (in >> ray[0] >> ray[1] >> ray[2] >> ray[3] >> ray[4] >> ray[5]) {
      ray[6] = 0, ray[7] = HUGE_VAL;
      LRBCAP_RAY(LRBCAP_DISTANCE, tree, nullptr, ray);
      visit(0);
      if (ray[7] < HUGE_VAL) LRBCAP_VALUE(ray[7], ray[7]);
      LRBCAP_END(ray[7] < HUGE_VAL ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
      std::cout << ray[7] << "\n";
    }
    LRBCAP_CLOSE();
    return 0;
  }
};

/// Records the queries of an engine: two bodies from files, the second one at each pose. Prints what each
/// returns.
template <class Body, class Query>
int run(const char* engine, int argc, char** argv, Query query) try {
  if (argc != 4) throw std::runtime_error(std::string("usage: ") + argv[0] + " A.obj B.obj POSES");
  LRBCAP_OPEN(engine, nullptr);
  const Body a(argv[1]), b(argv[2]);
  for (const Pose& pose : read_poses(argv[3])) std::cout << query(a, b, pose) << "\n";
  LRBCAP_CLOSE();
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
