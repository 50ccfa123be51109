#pragma once
/// Converts an LRB-rep to the input of methods, and their results to answers.

#include <array>
#include <chrono>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "bench/methods/method.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::methods {

/// Triangles with shared vertices: the corners of real simplex s are vertices[triangles[s]].
struct Triangles {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<VertexId, 3>> triangles;
};

/// Returns the real triangles of a 3D body. Throws InputError for a 2D one, as methods for 3D bodies do.
Triangles triangles_of(const LrbRep& rep);

/// Throws InputError if a coordinate exceeds the range of float.
void check_fits_float(const Triangles& t);

/// Throws InputError unless the pose is a rotation and a translation, as most engines require.
void check_rigid(const Pose& pose);

/// Returns the pose of B in A's frame.
inline Pose relative(const Pose& a, const Pose& b) {
  return {a.r.transpose() * b.r, a.r.transpose() * (b.t - a.t)};
}

/// Returns the mesh with the faces that `keep` accepts, and without unused vertices. Vertices are numbered in
/// the order of their use.
Mesh part_of(const Mesh& mesh, const std::function<bool(FaceId)>& keep);
/// Returns the real faces in their order, with the vertices that they use.
Mesh real_mesh(const LrbRep& rep);
/// Returns all vertices, and the real simplices as faces of the same numbers.
Mesh simplices_of(const LrbRep& rep);

/// Returns the mesh or the body with its world coordinates as its own. The body has no regions.
Mesh at_pose(Mesh mesh, const Pose& pose);
LrbRep at_pose(const LrbRep& rep, const Pose& pose);

/// Returns one mesh of the real simplices of two posed bodies, A's first.
Mesh joined(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
/// Returns the triangles of both bodies as one body without regions; those of A come first.
LrbRep union_of(const Question& question);

/// Returns the corners of a real triangle in the world.
std::array<Eigen::Vector3d, 3> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s);

/// A triangle of a posed body, as input of the exact predicates.
struct WorldTriangle {
  WorldTriangle(const LrbRep& rep, const Pose& pose, SimplexId s) : x(corners_of(rep, pose, s)) {}
  std::array<const double*, 3> corners() const { return {x[0].data(), x[1].data(), x[2].data()}; }
  std::array<Eigen::Vector3d, 3> x;  ///< world frame
};

/// Sorts pairs and removes duplicates.
void sort_pairs(std::vector<SimplexPair>& pairs);

inline Answer number_answer(double lower, double upper, double microseconds) {
  Answer out;
  out.lower = lower;
  out.upper = upper;
  out.microseconds = microseconds;
  return out;
}
/// Adds a near pair, or sorts all of them by their triangles.
void add_near(Answer& answer, SimplexPair pair, double distance);
void sort_near(Answer& answer);

/// A method whose bodies are of class Body. `kRigid`: it rejects poses that are not rigid.
template <class Body, bool kRigid = true>
class MethodOf : public Method {
 public:
  Answer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
               Mode mode) final {
    return ask(posed(a, pose_a), posed(b, pose_b), mode);
  }
  std::optional<TestCounts> count_tests(const MethodBody& a, const Pose& pose_a, const MethodBody& b,
                                        const Pose& pose_b) final {
    return tests_of(posed(a, pose_a), posed(b, pose_b));
  }

 protected:
  struct Posed {
    const Body& body;
    const Pose& pose;
  };
  virtual Answer ask(const Posed& a, const Posed& b, Mode mode) = 0;
  virtual std::optional<TestCounts> tests_of(const Posed&, const Posed&) { return std::nullopt; }

 private:
  static Posed posed(const MethodBody& body, const Pose& pose) {
    if (kRigid) check_rigid(pose);
    return {static_cast<const Body&>(body), pose};
  }
};

class Stopwatch {
 public:
  double microseconds() const {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

// Textbook tests of two simplices in plain double with an epsilon. The baseline for the exact ones.

/// Plane distances, areas and parameters below this count as 0. The widely copied code of the interval
/// triangle test uses this value, which suits coordinates of about 1. It is absolute on purpose: the
/// comparison measures its effect.
inline constexpr double kUsualEpsilon = 1e-6;

/// Returns true if two triangles intersect. Compares the intervals in which they cut the line common to their
/// planes (T. Moeller, "A Fast Triangle-Triangle Intersection Test", Journal of Graphics Tools 2(2), 1997);
/// coplanar ones are tested by their edges in the plane.
bool plain_triangles_meet(const Eigen::Vector3d a[3], const Eigen::Vector3d b[3]);

/// Returns true if two segments of the plane z = 0 intersect, by the sides of their ends.
bool plain_segments_meet(const Eigen::Vector3d a[2], const Eigen::Vector3d b[2]);

}  // namespace lrb::methods
