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

/// A real simplex and a distance from it.
struct NearFace {
  SimplexId simplex = kNull;
  double distance = std::numeric_limits<double>::infinity();  ///< units; see NearestFace::distance()
};

/// Finds which real simplex is near a point. Works in units. One for each thread.
class NearestFace {
 public:
  /// `vertices`: those of the LRB-rep, in units; must outlive this.
  NearestFace(const LrbRep& rep, const std::vector<Eigen::Vector3d>& vertices) : rep_(rep), x_(vertices) {}

  /// Returns the nearest real simplex but for the rounding of floats, or `known` if nothing is nearer.
  /// Searches the tree.
  NearFace find(const Eigen::Vector3d& p, NearFace known = {});

  /// Returns a real simplex that is no further than `from`: goes from each simplex to a neighbour that is
  /// nearer, as long as there is one. Takes a tenth of find()'s time where `from` is near. `neighbours`:
  /// real_neighbours().
  NearFace walk(const Eigen::Vector3d& p, SimplexId from, const std::vector<Across>& neighbours) const;

  /// Returns the distance from p to a simplex: never less than the true one but for rounding, which
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
