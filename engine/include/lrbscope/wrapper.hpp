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
#include <span>
#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>

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

/// Returns the thickness of each region: an upper bound on the distance from any point of its lids to the
/// nearest real face, in the mesh's unit. Rounded upward. The search ends a hundredth above the largest
/// distance that it came across, or after a limit of steps, which makes the bound larger. Infinite for a
/// region without lids, which nothing hides. Says nothing of points inside the region: under a lid over the
/// neck of a bottle they may be further off.
///
/// The one-sided Hausdorff distance from the lids to the set of all real faces, by branch and bound. Takes
/// `threads` threads (0: as many as the machine runs at once); the result does not depend on them.
std::vector<double> region_thickness(const LrbRep& rep, unsigned threads = 1);

// Levels of a body: wrappers that include every region no thicker than a tolerance, ready to be queried like
// a body.

struct WrapperLevel {
  /// No point of its lids is further than this from a real face; mesh's unit. Every region that is no
  /// thicker, and hides none that is, is included.
  double bound = 0;
  ObbTree tree;  ///< over the simplices of its boundary, numbered as in the LRB-rep
  std::vector<VertexId> component_vertices;  ///< one vertex of each connected piece of the boundary
  std::uint32_t face_count = 0, pseudo_count = 0;
};

/// Returns why a body can have no levels, as a clause, or an empty text if it can. (A body without regions,
/// of few faces, has none either, and needs none.)
std::string why_no_levels(const LrbRep& rep);
/// Returns the same as one line that names the body and the effect on queries; empty if it can have levels.
std::string note_no_levels(const LrbRep& rep);

/// The levels of one body: a row of wrappers from the outermost one inward, up to half the body's faces. Each
/// has about a third more faces than the one before, or a tenth where there are few. LrbRep::levels() makes
/// and keeps them. An LRB-rep without regions, or of a body that is not closed or intersects itself, has
/// none.
///
/// A region is included only together with everything that it hides, so that the wrapper encloses the body.
/// That it does so rests on the LRB-rep being embedded (validate.hpp), as those that the builders make are. A
/// region that nothing hides, such as a void, is never included: it has no lid that could be near the body.
class WrapperLevels {
 public:
  /// The tree of a level, as a file stores it.
  struct StoredLevel {
    double bound;
    std::vector<TreeNode> nodes;
    std::vector<LeafBlock> blocks;
  };

  explicit WrapperLevels(const LrbRep& rep, unsigned threads = 1);
  /// Takes levels as they were stored. Throws InputError unless every wrapper encloses the body as far as the
  /// LRB-rep is embedded, and its tree can be walked safely and holds the faces of the wrapper once each.
  /// That `needed` is not too small, and that the trees' bounds are right, is assumed: validate() tells.
  WrapperLevels(const LrbRep& rep, std::vector<double> needed, std::vector<StoredLevel> stored);

  /// Returns the coarsest level that is off by no more than a tolerance (mesh's unit); null: only the body
  /// is.
  const WrapperLevel* within(double tolerance) const;
  std::span<const WrapperLevel> all() const { return levels_; }  ///< coarsest first; bounds fall, faces rise
  /// Returns, for each region, the tolerance from which on it is included: the largest thickness among the
  /// region and all that it hides. Empty for a body without levels; infinite where it never is.
  std::span<const double> needed() const { return needed_; }
  std::size_t memory_bytes() const;

 private:
  std::vector<double> needed_;
  std::vector<WrapperLevel> levels_;
};

}  // namespace lrb
