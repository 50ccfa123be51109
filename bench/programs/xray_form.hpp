#pragma once
/// Input and output format of the programs lrbscope-xray-*. It uses no part of lrbscope, so that each program
/// can have the licence of the engine it records.
///
/// Input, from file descriptor 3, numbers between white space: for each body the numbers of vertices and
/// triangles, the vertices, the corners of the triangles; then the number of poses, and for each the 12
/// numbers (3x4 matrix, row by row) of A and of B. Output, a line each: `title`; for each body `tree N`, then
/// for each node `node N CHILD...` or `leaf N TRIANGLE...`, followed by its box in the body's frame: centre,
/// then three half axes; for each pose `pose`, then in the engine's order `b I J M` (bounding volumes of
/// nodes I and J, M = 1: they overlap) and `t I J M` (triangles I and J), and `end B T`, the numbers of both.

#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <vector>

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
  std::vector<std::array<std::size_t, 3>> corners;
};

inline Triangles read_triangles(std::istream& in) {
  Triangles out;
  out.vertices.resize(next<std::size_t>(in));
  out.corners.resize(next<std::size_t>(in));
  for (auto& vertex : out.vertices) vertex = next_numbers<3, double>(in);
  for (auto& triangle : out.corners) {
    triangle = next_numbers<3, std::size_t>(in);
    for (const std::size_t corner : triangle)
      if (corner >= out.vertices.size()) throw BadInput();
  }
  return out;
}

/// Prints the rest of a node's line. half(axis, k): coordinate k of a half axis.
template <class Centre, class Half>
void print_box(const Centre& centre, const Half& half) {
  for (int k = 0; k < 3; ++k) std::printf(" %.17g", centre(k));
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 3; ++k) std::printf(" %.17g", half(axis, k));
  std::printf("\n");
}

/// Calls run(in) and returns its exit code.
template <class Run>
int exit_code_of(const Run& run) {
  constexpr int kBadInput = 2;
  try {
    std::ifstream in("/proc/self/fd/3");
    return run(in);
  } catch (const BadInput&) {
    return kBadInput;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}

}  // namespace xray_form
