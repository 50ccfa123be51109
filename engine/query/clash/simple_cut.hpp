#pragma once
/// A face that the other surface cuts from border to border along disjoint chains, the usual case.

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/core/ids.hpp"

namespace lrb::parting {

/// Finds the cells from the order of the chains' ends around the border: between the two ends of a chain
/// there are the ends of entire chains only, nested like brackets. Exact if that order is.
class SimpleCut {
 public:
  /// The end of a segment that the face shares with one of the other surface: on an edge of the face, or
  /// inside, where an edge of the other surface passes through it.
  struct End {
    std::pair<std::uint32_t, std::uint32_t> name;  ///< unique among those on one edge, or inside
    int edge = -1;                                 ///< of the face; -1: inside
    double share = 0;                              ///< of the edge's way, about
    double rounding = 0;                           ///< what the share may be off

    static End inside(VertexId from, VertexId to) { return {{from.value(), to.value()}}; }
    static End on_border(int edge, const Eigen::Vector3d& x, const double* const corners[3], SimplexId by);
  };

  void add(const End& from, const End& to) { segments_.push_back({from, to}); }
  /// Finds the cells. Returns false if the face is not simple: a chain is closed or branches, or the order of
  /// ends on the border is uncertain.
  bool close();

  std::uint32_t cell_count() const { return cell_count_; }
  /// Return the number of parts of an edge, and the cell at one, counted from the edge's corner.
  std::size_t part_count(int edge) const { return cells_[static_cast<std::size_t>(edge)].size(); }
  std::uint32_t cell_beside(int edge, std::size_t part) const {
    return cells_[static_cast<std::size_t>(edge)][part];
  }
  /// Returns an edge, and a share of it, at which a cell borders on it; share 0: the edge's corner.
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
  std::array<std::vector<BorderEnd>, 3> border_;     ///< for each edge of the face: what ends on it, in order
  std::array<std::vector<std::uint32_t>, 3> cells_;  ///< for each edge: the cell beside each of its parts
  std::uint32_t cell_count_ = 1;
};

}  // namespace lrb::parting
