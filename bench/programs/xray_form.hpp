#pragma once
/// Input and output of the programs lrbscope-xray-*: they read bodies and poses, and write a capture
/// (<lrbscope_capture.h>). They use no other part of lrbscope, so that each program can have the licence of
/// the engine it records.
///
/// Input, from file descriptor 3, numbers between white space: for each body the numbers of vertices and
/// triangles, the vertices, the corners of the triangles; then the number of poses, and for each the 12
/// numbers (3x4 matrix, row by row) of A and of B. Output: a capture with a query for each pose in the file
/// that the argument names, and a line on stdout when it is complete.

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <vector>

#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>

namespace xray_form {

struct BadInput {};

template <class T>
T next(std::istream& in) {
  T value;
  if (!(in >> value)) throw BadInput();
  return value;
}

template <std::size_t n, class T>
std::array<T, n> next_numbers(std::istream& in) {
  std::array<T, n> out;
  for (T& x : out) x = next<T>(in);
  return out;
}

struct Triangles {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> corners;
};

inline Triangles read_triangles(std::istream& in) {
  Triangles out;
  out.vertices.resize(next<std::size_t>(in));
  out.corners.resize(next<std::size_t>(in));
  for (auto& vertex : out.vertices) vertex = next_numbers<3, double>(in);
  for (auto& triangle : out.corners) {
    triangle = next_numbers<3, std::uint32_t>(in);
    for (const std::uint32_t corner : triangle)
      if (corner >= out.vertices.size()) throw BadInput();
  }
  return out;
}

/// Captures a mesh and returns its number.
inline std::uint32_t capture_mesh(const Triangles& t, const char* name) {
  return LRBCAP_MESH(name, t.vertices.size(), t.vertices.front().data(), t.corners.size(),
                     t.corners.front().data());
}

/// The nodes of a tree, added in order.
class TreeNodes {
 public:
  explicit TreeNodes(std::uint32_t volume) : volume_(volume) {}

  /// Adds a node with children or triangles, and the numbers of its volume.
  template <class Indices, class Numbers>
  void add(const Indices& children, const Indices& triangles, const Numbers& volume) {
    child_.insert(child_.end(), children.begin(), children.end());
    triangle_.insert(triangle_.end(), triangles.begin(), triangles.end());
    first_child_.push_back(static_cast<std::uint32_t>(child_.size()));
    first_triangle_.push_back(static_cast<std::uint32_t>(triangle_.size()));
    volumes_.insert(volumes_.end(), volume.begin(), volume.end());
  }
  /// Captures the tree and returns its number.
  std::uint32_t capture(std::uint32_t mesh) const {
    lrbcap_tree tree = {};
    tree.mesh = mesh;
    tree.nodes = static_cast<std::uint32_t>(first_child_.size() - 1);
    tree.volume = volume_;
    tree.first_child = first_child_.data();
    tree.child = child_.data();
    tree.first_prim = first_triangle_.data();
    tree.prim = triangle_.data();
    tree.volumes = volumes_.data();
    return LRBCAP_TREE(&tree);
  }

 private:
  std::uint32_t volume_;
  std::vector<std::uint32_t> first_child_ = {0}, child_, first_triangle_ = {0}, triangle_;
  std::vector<double> volumes_;
};

/// Calls run(in), which captures an engine's queries between LRBCAP_OPEN and LRBCAP_CLOSE, and returns its
/// exit code. `argument`: the file for the capture.
template <class Run>
int exit_code_of(int argument_count, char** arguments, const Run& run) {
  constexpr int kBadInput = 2;
  if (argument_count != 2) return kBadInput;
  // Settings of the user's own captures must not limit this one.
  for (const char* name : {"LRBCAP_QUERIES", "LRBCAP_SLOWER_US", "LRBCAP_EVENTS"}) unsetenv(name);
  setenv("LRBCAP_MAX_MB", "0", 1);
  try {
    std::ifstream in("/proc/self/fd/3");
    run(in, arguments[1]);
    LRBCAP_CLOSE();
    std::printf("complete\n");
    return 0;
  } catch (const BadInput&) {
    return kBadInput;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}

}  // namespace xray_form
