// Reads bodies and poses and describes trees, for the recorded engines in C++.
#pragma once
#include <array>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
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
