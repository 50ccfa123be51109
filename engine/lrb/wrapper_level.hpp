#pragma once
/// A body under its lids: the wrapper that includes every region no thicker than a tolerance, ready to be
/// queried like a body.

#include <memory>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

struct WrapperLevel {
  double tolerance = 0;  ///< that was asked for, the mesh's unit
  double bound = 0;      ///< no point of it is further from a real face; 0: it is the body itself
  ObbTree tree;          ///< over the simplices of its boundary, numbered as in the LRB-rep
  std::vector<VertexId> component_vertices;  ///< one of each connected piece of the boundary
  std::uint32_t face_count = 0, pseudo_count = 0;
};

/// The levels of one body, each made when it is first asked for. An LRB-rep without regions, of a body that
/// is not closed or that intersects itself has only one: itself.
///
/// A region is included only with all that it hides, so that the wrapper encloses the body; that it does
/// rests on the LRB-rep being embedded (validate.hpp), which what the builders make is.
class WrapperLevels {
 public:
  explicit WrapperLevels(const LrbRep& rep);

  /// The level for a tolerance >= 0 (mesh's unit). The reference is good until the next call with a tolerance
  /// not asked for before.
  const WrapperLevel& at(double tolerance);
  /// The least tolerance that includes all regions which can be: 0 if none can.
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
