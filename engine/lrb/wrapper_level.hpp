#pragma once
/// Levels of a body: wrappers that include every region no thicker than a tolerance, ready to be queried like
/// a body.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

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
