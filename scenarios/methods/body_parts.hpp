#pragma once
/// Makes from an LRB-rep what methods build their bodies from.

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/query/collide.hpp"

namespace lrb::methods {

/// Triangles with shared vertices: the corners of real simplex s are vertices[triangles[s]].
struct Triangles {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<VertexId, 3>> triangles;
};

/// Returns the real triangles of a 3D body. Throws InputError for a 2D one, as methods for 3D bodies do.
Triangles triangles_of(const LrbRep& rep);

/// Throws InputError if a coordinate is too large for a float, however it is rounded.
void check_fits_float(const Triangles& t);

/// Throws InputError unless the pose is a rotation and a translation, as most engines expect.
void check_rigid(const Pose& pose);

/// Returns the real faces in their order, with the vertices that they use.
Mesh real_mesh(const LrbRep& rep);

/// Returns the body moved: its world coordinates as its own. It has no regions.
LrbRep at_pose(const LrbRep& rep, const Pose& pose);

/// Puts pairs in order, each once.
void sort_pairs(std::vector<SimplexPair>& pairs);

class Stopwatch {
 public:
  double microseconds() const {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace lrb::methods
