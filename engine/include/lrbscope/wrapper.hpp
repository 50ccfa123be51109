#pragma once
/// The wrapper: the set of regions of an LRB-rep that currently count as part of the body (the paper's
/// section 3).
///
/// Its boundary is the approximation of the body that a query works on. If all regions are included it is the
/// outermost wrapper, a handful of faces. If all are excluded it consists of exactly the real faces. Refining
/// a region excludes it; the LRB-rep does not change. The state is one epoch stamp per region, so that
/// reset() takes O(1) and a query O(number of refined regions).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>

namespace lrb {

/// The two interpretations of the paper's "if desired, a regularized approximation".
enum class WrapperMode : std::uint8_t {
  regularised,    ///< the boundary of the union of solid and included regions: always closed
  unregularised,  ///< refining a face discards that face alone and adds its region's floor; other lids of the
                  ///< region stay until they are refined themselves
};
constexpr auto enum_names(WrapperMode) {
  return std::to_array<EnumName<WrapperMode>>(
      {{WrapperMode::regularised, "regularised"}, {WrapperMode::unregularised, "unregularised"}});
}

class Wrapper {
 public:
  explicit Wrapper(const LrbRep& rep, WrapperMode mode = WrapperMode::regularised);

  const LrbRep& rep() const { return *rep_; }
  WrapperMode mode() const { return mode_; }

  /// Returns to the outermost wrapper, in O(1).
  void reset();
  bool included(CellId cell) const {  ///< always true for the solid, false for the outside
    return is_region(cell) ? region_stamp_[cell] != epoch_ : cell == kSolid;
  }
  /// Excludes a region. Returns false if it was excluded already.
  bool refine(RegionId r) {
    if (!included(r)) return false;
    order_.push_back(r);  // first, because it may throw
    region_stamp_[r] = epoch_;
    ++excluded_count_;
    if (mode_ == WrapperMode::unregularised) discard_lids(r);
    return true;
  }
  /// Excludes a cell, if it is a region, and its ancestors along parents, up to the first that is excluded
  /// already. They are recorded in order from the outermost inward. Returns the number of excluded regions.
  std::size_t refine_path(CellId innermost) {
    const std::size_t before = order_.size();
    for (CellId c = innermost; is_region(c) && included(c); c = rep_->parent(c.as_region()))
      refine(c.as_region());
    std::reverse(order_.begin() + static_cast<std::ptrdiff_t>(before), order_.end());
    return order_.size() - before;
  }
  /// Refines the region behind a face. regularised: refine(inner_cell(f)). unregularised: discards f, and
  /// adds the floor if f is the first of the region's lids to be refined. Returns false if f is real or not
  /// on the boundary.
  bool refine_face(FaceId f);
  /// Includes a region again: the inverse of refine(). Returns false if it is included already. In
  /// unregularised mode its lids are restored and its floor is removed.
  bool coarsen(RegionId r);
  /// Excludes all regions.
  void refine_all();

  bool on_boundary(FaceId f) const;
  /// Returns the faces of the boundary, ascending. O(n log n), n: number of outermost faces and of faces of
  /// the excluded regions.
  std::vector<FaceId> boundary() const;
  /// Returns the number of faces of the boundary. Each call recomputes it, which keeps refine() at O(1) as
  /// queries need.
  std::size_t boundary_size() const { return boundary().size(); }
  /// Returns the excluded regions in the order of refinement.
  const std::vector<RegionId>& excluded() const { return order_; }
  std::uint32_t excluded_count() const { return excluded_count_; }

 private:
  void discard_lids(RegionId r);

  const LrbRep* rep_;
  WrapperMode mode_;
  std::uint32_t epoch_ = 1;
  std::uint32_t excluded_count_ = 0;
  std::vector<std::uint32_t> region_stamp_;  ///< (|R|) == epoch_: excluded
  /// (|F|) unregularised only; == epoch_: this lid was discarded
  std::vector<std::uint32_t> discarded_stamp_;
  std::vector<RegionId> order_;  ///< the excluded regions in the order of refinement
};

/// Returns the thickness of each region (|R|): an upper bound on the distance from any point of its lids to
/// the nearest real face. Mesh units, rounded up. Infinite for a region without lids. The bound does not
/// apply to points inside the region, which may be further from the body (under a lid over the neck of a
/// bottle).
///
/// Computes the one-sided Hausdorff distance from the lids to all real faces by branch and bound. The search
/// stops at 1.01 times the largest distance found, or after a limit of steps, which makes the bound larger.
/// `threads` (0: number of hardware threads) does not affect the result.
std::vector<double> region_thickness(const LrbRep& rep, unsigned threads = 1);

// Levels of detail: wrappers that include every region up to a given thickness, with trees for queries.

struct WrapperLevel {
  /// Maximum distance of any point of the lids to the nearest real face; mesh units. A region is included if
  /// neither it nor any region that it hides is thicker than this.
  double bound = 0;
  ObbTree tree;  ///< over the simplices of its boundary, numbered as in the LRB-rep
  std::vector<VertexId> component_vertices;  ///< one vertex of each connected component of the boundary
  std::uint32_t face_count = 0, pseudo_count = 0;
};

/// Returns the reason why a body can have no levels of detail, as a clause, or an empty string if it can. (A
/// small body without regions does not need levels.)
std::string why_no_levels(const LrbRep& rep);
/// Returns the reason as one line that names the body and the effect on queries, or an empty string.
std::string note_no_levels(const LrbRep& rep);

/// The levels of detail of one body: a sequence of wrappers from the outermost one inward, up to half the
/// body's faces. Each has about a third more faces than the previous one (a tenth for small numbers of
/// faces). LrbRep::levels() creates and owns them. An LRB-rep has no levels if it has no regions, is not
/// closed or intersects itself.
///
/// A region is included only together with all regions that it hides, so that the wrapper encloses the body.
/// Enclosure requires that the LRB-rep is embedded (validate.hpp), as the builders make it. A region
/// without lids, such as a void, is never included.
class WrapperLevels {
 public:
  /// The tree of a level as stored in a file.
  struct StoredLevel {
    double bound;
    std::vector<TreeNode> nodes;
    std::vector<LeafBlock> blocks;
  };

  explicit WrapperLevels(const LrbRep& rep, unsigned threads = 1);
  /// Restores stored levels. Throws InputError unless every wrapper encloses the body, given that the LRB-rep
  /// is embedded, and its tree can be traversed safely and contains each face of the wrapper once. The bounds
  /// of the trees, and that `needed` is not too small, are assumed here and checked by validate().
  WrapperLevels(const LrbRep& rep, std::vector<double> needed, std::vector<StoredLevel> stored);

  /// Returns the coarsest level whose deviation is at most `tolerance` (mesh units), or null if only the body
  /// itself is within it.
  const WrapperLevel* within(double tolerance) const;
  /// Returns the levels, coarsest first: bounds decrease, face counts increase.
  std::span<const WrapperLevel> all() const { return levels_; }
  /// Returns, for each region (|R|), the tolerance from which on it is included: the largest thickness of the
  /// region and of all regions that it hides; infinite if it is never included. Empty for a body without
  /// levels.
  std::span<const double> needed() const { return needed_; }
  std::size_t memory_bytes() const;

 private:
  std::vector<double> needed_;
  std::vector<WrapperLevel> levels_;
};

}  // namespace lrb
