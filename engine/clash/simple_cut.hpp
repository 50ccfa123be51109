#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// A face that the other surface cuts along disjoint chains from border to border, the usual case. Steps:
/// 1. Link the segments to chains, by the identifiers of their ends.
/// 2. Sort the ends of chains on each edge of the face, with error bounds.
/// 3. Traverse the border with a stack: between the two ends of a chain there are only the ends of entire
///    chains, nested like brackets. Exact if the order of ends is exact.
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

}  // namespace lrb
