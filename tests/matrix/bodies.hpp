#pragma once
/// The matrix of tests: kinds of bodies, and for each what brute force says of it beside others. Every door
/// to the engine is tested with the same cells (README.md).

#include <optional>
#include <string>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::matrix {

/// A kind of body, and its properties known by construction.
struct Kind {
  std::string name;
  Mesh mesh;
  bool solid = true;   ///< bounds a solid, if need be by parity
  bool builds = true;  ///< an LRB-rep can be built
  bool simple =
      true;  ///< neither intersects itself nor has faces without area, so that every clash is decided
  const char* format = "ply";  ///< of its second file; in the plane "obj"
};

/// Properties of two bodies at a pose of B.
struct Step {
  Pose pose;
  BruteForceResult truth;
  double distance = 0;  ///< of the surfaces, but for rounding
};

/// Two bodies and their queries.
struct Cell {
  std::size_t a = 0, b = 0;  ///< kinds
  std::vector<Step> steps;
  Pose start, end;  ///< of a motion of B past or through A
  /// Of some times, one after the other, the first at which B meets A, and the last before it at which it
  /// does not.
  std::optional<double> meets;
  double free = 0;
  double size = 0;  ///< of A
};

struct Matrix {
  std::vector<Kind> kinds;  ///< probes, small bodies that others meet, are the last ones
  std::vector<Cell> cells;  ///< each kind with a probe, and with itself
};

/// Returns the matrix; of noisy polygons, so many.
Matrix make_matrix(int noisy = 4);

/// Returns the bytes of a mesh as a file: "obj", "ply", "off" or "stl".
std::string file_of(const Mesh& mesh, const std::string& format);

}  // namespace lrb::matrix
