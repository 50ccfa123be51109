#pragma once
/// The wrapper: which regions of an LRB-rep currently count as part of the body (the paper's section 3).
///
/// Its boundary is the approximation that a query works on. With all regions included it is the outermost
/// wrapper, a handful of faces; with all excluded, exactly the real faces. Refining a region excludes it;
/// nothing in the LRB-rep changes. The state is one stamp per region, so that reset() costs O(1) and a query
/// O(regions it opened).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// The two ways to read the paper's "if desired, a regularized approximation".
enum class WrapperMode : std::uint8_t {
  regularised,    ///< the boundary of the union of solid and included regions: always closed
  unregularised,  ///< refining a face discards that face alone and adds its region's floor; the region's
                  ///< other lids stay until they are refined themselves
};
constexpr auto words_of(WrapperMode) {
  return std::to_array<EnumWord<WrapperMode>>(
      {{WrapperMode::regularised, "regularised"}, {WrapperMode::unregularised, "unregularised"}});
}

class Wrapper {
 public:
  explicit Wrapper(const LrbRep& rep, WrapperMode mode = WrapperMode::regularised);

  const LrbRep& rep() const { return *rep_; }
  WrapperMode mode() const { return mode_; }

  /// Goes back to the outermost wrapper, in O(1).
  void reset();
  bool included(CellId cell) const {  ///< the solid always is, the outside never
    return is_region(cell) ? region_stamp_[cell] != epoch_ : cell == kSolid;
  }
  /// Excludes a region. Returns false if it was excluded already.
  bool refine(RegionId r) {
    if (!included(r)) return false;
    order_.push_back(r);  // first: it may throw
    region_stamp_[r] = epoch_;
    ++excluded_count_;
    if (mode_ == WrapperMode::unregularised) discard_lids(r);
    return true;
  }
  /// Excludes a cell if it is a region, and those between it and the outside along parents, up to the first
  /// that is excluded already. Counts as if the outermost had been refined first. Returns how many there
  /// were.
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
  /// Takes a region back in: the reverse of refine(). Returns false if it is included already. In
  /// unregularised mode its lids come back and its floor goes.
  bool coarsen(RegionId r);
  void refine_all();

  bool on_boundary(FaceId f) const;
  /// Returns the faces of the boundary, ascending. O(n log n) in the number of outermost faces and of faces
  /// of the excluded regions.
  std::vector<FaceId> boundary() const;
  /// Returns the number of faces of the boundary. Counts them anew at each call: this keeps refine() at O(1),
  /// which is what a query needs.
  std::size_t boundary_size() const { return boundary().size(); }
  /// Returns the excluded regions in the order in which they were refined.
  const std::vector<RegionId>& excluded() const { return order_; }
  std::uint32_t excluded_count() const { return excluded_count_; }

 private:
  void discard_lids(RegionId r);

  const LrbRep* rep_;
  WrapperMode mode_;
  std::uint32_t epoch_ = 1;
  std::uint32_t excluded_count_ = 0;
  std::vector<std::uint32_t> region_stamp_;  ///< (|R|) == epoch_: excluded
  std::vector<std::uint32_t>
      discarded_stamp_;          ///< (|F|) unregularised only; == epoch_: this lid was discarded
  std::vector<RegionId> order_;  ///< the excluded regions, as they were refined
};

}  // namespace lrb
