#pragma once
/// Levels of a body: wrappers that include every region no thicker than a tolerance, ready to be queried like
/// a body.

#include <memory>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

struct WrapperLevel {
  double tolerance = 0;  ///< the tolerance that was asked for, mesh's unit
  /// No point of the wrapper is further than this from a real face; 0: it is the body itself.
  double bound = 0;
  ObbTree tree;  ///< over the simplices of its boundary, numbered as in the LRB-rep
  std::vector<VertexId> component_vertices;  ///< one vertex of each connected piece of the boundary
  std::uint32_t face_count = 0, pseudo_count = 0;
};

/// The levels of one body, each made when it is first asked for. An LRB-rep without regions, or of a body
/// that is not closed or intersects itself, has only one level: itself.
///
/// A region is included only together with everything that it hides, so that the wrapper encloses the body.
/// That it does so rests on the LRB-rep being embedded (validate.hpp), as those that the builders make are.
class WrapperLevels {
 public:
  explicit WrapperLevels(const LrbRep& rep);

  /// Returns the level for a tolerance >= 0 (mesh's unit). The reference is valid until the next call with a
  /// tolerance that was not asked for before.
  const WrapperLevel& at(double tolerance);
  /// Returns the least tolerance that includes all regions that can be included: 0 if none can.
  double largest_thickness() const { return largest_; }
  double smallest_thickness() const { return smallest_; }

 private:
  std::unique_ptr<WrapperLevel> make(double tolerance) const;

  const LrbRep& rep_;
  std::vector<double> needed_;  ///< (|R|): the tolerance from which on a region is included
  double largest_ = 0, smallest_ = 0;
  std::vector<std::unique_ptr<WrapperLevel>> levels_;
};

}  // namespace lrb
