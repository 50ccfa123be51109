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
  std::vector<std::uint32_t> children, triangles;  // or instances
};

/// A tree of boxes, which are numbered as its nodes: least and greatest x, y, z.
struct Tree {
  std::vector<Node> nodes;
  std::vector<double> boxes;

  /// Adds a tree of things with these boxes, in halves of their own order. Returns its root.
  std::uint32_t add(const std::vector<double>& things, std::size_t first, std::size_t last) {
    const auto node = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back(), boxes.resize(6 * nodes.size());
    for (std::size_t k = 0; k < 3; ++k) {
      double &least = boxes[6 * node + k] = HUGE_VAL, &most = boxes[6 * node + 3 + k] = -HUGE_VAL;
      for (std::size_t i = first; i < last; ++i)
        least = std::fmin(least, things[6 * i + k]), most = std::fmax(most, things[6 * i + 3 + k]);
    }
    const std::size_t half = (first + last) / 2;
    if (last - first > 2) {
      const std::uint32_t left = add(things, first, half), right = add(things, half, last);
      nodes[node].children = {left, right};
    } else {
      for (std::size_t i = first; i < last; ++i) nodes[node].triangles.push_back(std::uint32_t(i));
    }
    return node;
  }
};

/// A tree as a capture describes it, and the arrays to which it refers.
struct Description {
  std::vector<std::uint32_t> first_child{0}, child, first_prim{0}, prim;
  lrbcap_tree tree = {};

  Description(std::uint32_t volume, const std::vector<Node>& nodes, const std::vector<double>& volumes) {
    for (const Node& node : nodes) {
      child.insert(child.end(), node.children.begin(), node.children.end());
      prim.insert(prim.end(), node.triangles.begin(), node.triangles.end());
      first_child.push_back(static_cast<std::uint32_t>(child.size()));
      first_prim.push_back(static_cast<std::uint32_t>(prim.size()));
    }
    tree.nodes = static_cast<std::uint32_t>(nodes.size());
    tree.volume = volume;
    tree.first_child = first_child.data();
    tree.child = child.data();
    tree.first_prim = first_prim.data();
    tree.prim = prim.data();
    tree.volumes = volumes.data();
  }
};

/// Describes a mesh and its tree. Returns the number of the tree in the capture.
inline std::uint32_t describe(const Triangles& mesh, const std::string& name, std::uint32_t volume,
                              const std::vector<Node>& nodes, const std::vector<double>& volumes) {
  Description of(volume, nodes, volumes);
  of.tree.mesh = LRBCAP_MESH(name.c_str(), mesh.vertices.size() / 3, mesh.vertices.data(),
                             mesh.corners.size() / 3, mesh.corners.data());
  return LRBCAP_TREE(&of.tree);
}

/// Traces rays to their first hits with triangles, or with other things in the leaves of a tree, and records
/// it.
class RayTracer {
 protected:
  using Vec = std::valarray<double>;
  const Tree& tree;

  bool meets(const double* box) const {
    const Vec origin(ray, 3), direction(ray + 3, 3);
    const Vec s = (Vec(box, 3) - origin) / direction, t = (Vec(box + 3, 3) - origin) / direction;
    double from = ray[6], to = ray[7];
    for (std::size_t k = 0; k < 3; ++k)
      from = std::fmax(from, std::fmin(s[k], t[k])), to = std::fmin(to, std::fmax(s[k], t[k]) * (1 + 1e-15));
    return from <= to;
  }

 public:
  double ray[8] = {};  // origin, direction, least and greatest multiple of it
  explicit RayTracer(const Tree& boxes) : tree(boxes) {}
  virtual ~RayTracer() = default;

  /// Describes the tree. Returns its number in the capture.
  virtual std::uint32_t describe_tree(const char* name) = 0;
  /// Ends the ray where it hits a triangle, or what else is in a leaf.
  virtual void test(std::uint32_t thing) = 0;
  void visit(std::uint32_t node) {
    const bool met = meets(&tree.boxes[6 * node]);
    LRBCAP_NODE(node, 0, met, LRBCAP_NO_AXIS);
    if (!met) return;
    for (const std::uint32_t thing : tree.nodes[node].triangles) test(thing);
    for (const std::uint32_t child : tree.nodes[node].children) visit(child);
  }

  /// Traces a ray for each line of six numbers of a file, origin and direction. Prints the multiple of the
  /// direction at each hit, or inf.
  int run(const char* engine, const char* name, const char* rays) {
    LRBCAP_OPEN(engine, nullptr);
    const std::uint32_t number = describe_tree(name);
    std::ifstream in(rays);
    while (in >> ray[0] >> ray[1] >> ray[2] >> ray[3] >> ray[4] >> ray[5]) {
      ray[6] = 0, ray[7] = HUGE_VAL;
      LRBCAP_RAY(LRBCAP_DISTANCE, number, nullptr, ray);
      visit(0);
      if (ray[7] < HUGE_VAL) LRBCAP_VALUE(ray[7], ray[7]);
      LRBCAP_END(ray[7] < HUGE_VAL ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
      std::cout << ray[7] << "\n";
    }
    LRBCAP_CLOSE();
    return 0;
  }
};

/// Traces rays to a mesh.
class MeshTracer final : public RayTracer {
  const Triangles& mesh;

 public:
  MeshTracer(const Triangles& triangles, const Tree& boxes) : RayTracer(boxes), mesh(triangles) {}
  std::uint32_t describe_tree(const char* name) override {
    return describe(mesh, name, LRBCAP_AABB, tree.nodes, tree.boxes);
  }
  void test(std::uint32_t f) override {
    const auto corner = [&](std::size_t i) { return Vec(&mesh.vertices[3 * mesh.corners[3 * f + i]], 3); };
    const auto cross = [](Vec a, Vec b) { return Vec((a * b.cshift(1) - a.cshift(1) * b).cshift(1)); };
    const Vec origin(ray, 3), direction(ray + 3, 3), a = corner(0), u = corner(1) - a, v = corner(2) - a;
    const Vec n = cross(u, v);
    const double at = (n * (a - origin)).sum() / (n * direction).sum();
    const Vec x = origin + at * direction - a;
    const double p = (cross(x, v) * n).sum(), q = (cross(u, x) * n).sum();
    const bool hit = at >= ray[6] && at <= ray[7] && p >= 0 && q >= 0 && p + q <= (n * n).sum();
    LRBCAP_PRIM(f, 0, hit);
    if (hit) ray[7] = at;
  }
};

/// Returns the boxes of the triangles of a mesh.
inline std::vector<double> boxes_of(const Triangles& mesh) {
  std::vector<double> out;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    for (const double limit : {HUGE_VAL, -HUGE_VAL})
      for (std::size_t k = 0; k < 3; ++k) {
        out.push_back(limit);
        for (std::size_t c = i; c < i + 3; ++c) {
          const double x = mesh.vertices[3 * mesh.corners[c] + k];
          out.back() = limit > 0 ? std::fmin(out.back(), x) : std::fmax(out.back(), x);
        }
      }
  return out;
}

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
