#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "engine/lrb/complex.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

/// A real simplex in units (ObbTree::unit()), as the search for close ones needs it: a corner, the edges from
/// there to the others (2D: `ac` is 0), and the adjacent simplices.
struct RealSimplex {
  Eigen::Vector3d a, ab, ac;
  Across across;
};

/// Returns the real simplices of an LRB-rep.
std::vector<RealSimplex> real_simplices(const LrbRep& rep);

/// A real simplex with its distance from a point.
struct NearFace {
  SimplexId simplex = kNull;
  double distance = std::numeric_limits<double>::infinity();  ///< units; see NearestFace::distance()
};

/// Finds real simplices close to points. Works in units. Use one per thread.
class NearestFace {
 public:
  /// `simplices`: real_simplices() of the LRB-rep; must outlive this object.
  NearestFace(const LrbRep& rep, const std::vector<RealSimplex>& simplices)
      : tree_(rep.tree()), simplices_(simplices), is_segment_(rep.dim() == 2) {}

  /// Returns the closest real simplex, up to the rounding of floats, or `known` if none is closer. Searches
  /// the tree.
  NearFace find(const Eigen::Vector3d& p, NearFace known = {});

  /// Returns a real simplex no further than `from`: moves to an adjacent simplex that is closer as long as
  /// there is one. Takes a tenth of the time of find() if `from` is close.
  NearFace walk(const Eigen::Vector3d& p, SimplexId from) const;

  /// Returns the distance from p to a simplex, never below the true one except for rounding, which
  /// kThicknessRounding covers.
  double distance(const Eigen::Vector3d& p, SimplexId s) const;

 private:
  struct Branch {
    std::uint32_t node;
    float distance_sq;
  };

  const ObbTree& tree_;
  const std::vector<RealSimplex>& simplices_;
  bool is_segment_;
  std::vector<Branch> stack_;
};

/// (regions) Returns true for those whose lids consist of exactly the same points as their floors, which are
/// real faces in one plane.
std::vector<bool> regions_on_body(const LrbRep& rep);

}  // namespace lrb
