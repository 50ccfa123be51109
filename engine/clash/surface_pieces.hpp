#pragma once
/// The pieces of two surfaces: inside, outside or on the other solid.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/collide/query_context.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::penetration {

// A face that the other surface cuts along disjoint chains from border to border, the usual case.

/// Finds the cells from the order of the chains' ends around the border: between the two ends of a chain
/// there are only the ends of entire chains, nested like brackets. Exact if that order is exact.
class SimpleCut {
 public:
  /// The end of a segment in which the face intersects a face of the other surface: on an edge of the face,
  /// or inside it, where an edge of the other surface pierces it.
  struct End {
    std::pair<std::uint32_t, std::uint32_t> name;  ///< identifier, unique on one edge, or inside the face
    int edge = -1;                                 ///< of the face; -1: inside
    double share = 0;                              ///< approximate parameter along the edge
    double rounding = 0;                           ///< error bound of `share`

    static End inside(VertexId from, VertexId to) { return {{from.value(), to.value()}}; }
    static End on_border(int edge, const Eigen::Vector3d& x, const double* const corners[3], SimplexId by);
  };

  void add(const End& from, const End& to) { segments_.push_back({from, to}); }
  /// Finds the cells. Returns false if the face is not simple: a chain is closed or branches, or the order of
  /// ends on the border is uncertain.
  bool close();

  std::uint32_t cell_count() const { return cell_count_; }
  /// Return the number of parts of an edge, and the cell at one part, counted from the edge's corner.
  std::size_t part_count(int edge) const { return cells_[static_cast<std::size_t>(edge)].size(); }
  std::uint32_t cell_beside(int edge, std::size_t part) const {
    return cells_[static_cast<std::size_t>(edge)][part];
  }
  /// Returns an edge, and a parameter on it, at which the cell is adjacent to it; parameter 0: the edge's
  /// corner.
  std::pair<int, double> place_on_border(std::uint32_t cell) const;

 private:
  using Key = std::pair<int, std::pair<std::uint32_t, std::uint32_t>>;
  struct BorderEnd {
    double share, rounding;
    std::uint32_t point, chain;
  };

  bool follow_chains(std::map<Key, std::uint32_t>& number, std::vector<std::uint32_t>& chain);
  bool sort_border(const std::map<Key, std::uint32_t>& number, const std::vector<std::uint32_t>& chain);
  bool walk_round();

  std::vector<std::array<End, 2>> segments_;
  std::array<std::vector<BorderEnd>, 3> border_;     ///< for each edge: the chain ends on it, in order
  std::array<std::vector<std::uint32_t>, 3> cells_;  ///< for each edge: the cell beside each of its parts
  std::uint32_t cell_count_ = 1;
};

/// Counts the pieces, exactly. Returns nullopt, and sets `reason` unless it is null, if a body is not closed
/// or intersects itself, if a face that intersects the other body is degenerate, or if exact::CutFace fails.
/// `result`: all pairs of intersecting simplices.
///
/// A face that intersects the other surface is cut into cells by it. Each cell is inside, outside or on the
/// other solid. Cells and uncut faces belong to the same piece if they share a part of an edge that is not on
/// the other surface: edges are cut where they intersect it, and one point of each part decides.
/// only_rational: cut all faces in rational arithmetic, and not only non-simple faces; the result is the
/// same.
std::optional<std::array<SurfacePieces, 2>> surface_pieces(QueryContext& context, const CollideResult& result,
                                                           bool only_rational = false,
                                                           ClashReason* reason = nullptr);

}  // namespace lrb::penetration
