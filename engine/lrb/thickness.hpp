#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "engine/lrb/complex.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

/// Returns the vertices of an LRB-rep in units (ObbTree::unit()).
std::vector<Eigen::Vector3d> vertices_in_units(const LrbRep& rep);

/// A real simplex with its distance from a point.
struct NearFace {
  SimplexId simplex = kNull;
  double distance = std::numeric_limits<double>::infinity();  ///< units; see NearestFace::distance()
};

/// Finds real simplices close to points. Works in units. Use one per thread.
class NearestFace {
 public:
  /// `vertices`: those of the LRB-rep, in units; must outlive this object.
  NearestFace(const LrbRep& rep, const std::vector<Eigen::Vector3d>& vertices) : rep_(rep), x_(vertices) {}

  /// Returns the closest real simplex, up to the rounding of floats, or `known` if none is closer. Searches
  /// the tree.
  NearFace find(const Eigen::Vector3d& p, NearFace known = {});

  /// Returns a real simplex no further than `from`: moves to an adjacent simplex that is closer as long as
  /// there is one. Takes a tenth of the time of find() if `from` is close. `neighbours`: real_neighbours().
  NearFace walk(const Eigen::Vector3d& p, SimplexId from, const std::vector<Across>& neighbours) const;

  /// Returns the distance from p to a simplex, never below the true one except for rounding, which
  /// kThicknessRounding covers.
  double distance(const Eigen::Vector3d& p, SimplexId s) const;

 private:
  struct Branch {
    std::uint32_t node;
    float distance_sq;
  };

  SimplexPoint nearest_point(const Eigen::Vector3d& p, SimplexId s) const;

  const LrbRep& rep_;
  const std::vector<Eigen::Vector3d>& x_;  ///< (|V|)
  std::vector<Branch> stack_;
};

}  // namespace lrb
