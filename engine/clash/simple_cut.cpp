#include "engine/clash/simple_cut.hpp"

#include <algorithm>
#include <set>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/core/geometry.hpp"
#include <lrbscope/core/disjoint_sets.hpp>

namespace lrb {

/// The point is within 1e-13 of the extent of the edge that is cut, plus two roundings, of the exact point
/// (pair_contact.cpp). That edge is the face's own: at this end an edge of the face pierces the other
/// triangle.
SimpleCut::End SimpleCut::End::on_border(int edge, const Eigen::Vector3d& x, const double* const corners[3],
                                         SimplexId by) {
  const Eigen::Map<const Eigen::Vector3d> from(corners[edge]), to(corners[(edge + 1) % 3]);
  const Eigen::Vector3d direction = to - from;
  const double length = stable_norm3(direction);
  End end{{by.value(), 0}, edge};
  // Divide before the product, so that squares cannot overflow.
  end.share = (x - from).dot(direction / length) / length;
  // If coordinates are larger than the edge, their rounding dominates.
  const double size = std::max({from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff(), 0x1p-1000});
  end.rounding = kShareRounding * (1 + size / length * 0x1p-8);
  return end;
}

bool SimpleCut::close() {
  std::map<Key, std::uint32_t> number;
  std::vector<std::uint32_t> chain;
  if (!follow_chains(number, chain) || !sort_border(number, chain)) return false;
  return walk_round();
}

/// Numbers the points, and labels all points of a chain with one number. Points inside the face must have two
/// segments, points on the border one; a chain then has an end on the border unless it is closed.
bool SimpleCut::follow_chains(std::map<Key, std::uint32_t>& number, std::vector<std::uint32_t>& chain) {
  std::vector<std::array<std::uint32_t, 2>> links;
  std::vector<std::uint32_t> uses;
  // Ends with the same name are the same point.
  for (const auto& segment : segments_) {
    std::array<std::uint32_t, 2> link;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [it, is_new] = number.try_emplace(Key{segment[k].edge, segment[k].name},
                                                   static_cast<std::uint32_t>(number.size()));
      if (is_new) uses.push_back(0);
      ++uses[it->second];
      link[k] = it->second;
    }
    // Both ends at one point: degenerate.
    if (link[0] == link[1]) return false;
    links.push_back(link);
  }
  // Degree 2 inside, degree 1 on the border: no chain branches or ends inside.
  for (const auto& [key, i] : number)
    if (uses[i] != (key.first < 0 ? 2u : 1u)) return false;
  chain.resize(number.size());
  DisjointSets chains(number.size());
  for (const auto& link : links) chains.join(link[0], link[1]);
  // A chain without an end on the border is closed: it would bound a cell that does not reach the border.
  std::set<std::uint32_t> open;
  for (const auto& [key, i] : number) {
    chain[i] = chains.leader(i);
    if (key.first >= 0) open.insert(chain[i]);
  }
  return std::all_of(chain.begin(), chain.end(), [&](std::uint32_t c) { return open.contains(c); });
}

/// Sorts the ends on each edge. Returns false if rounding could have changed their order.
bool SimpleCut::sort_border(const std::map<Key, std::uint32_t>& number,
                            const std::vector<std::uint32_t>& chain) {
  // Collect the ends by edge.
  for (const auto& segment : segments_)
    for (const End& end : segment) {
      if (end.edge < 0) continue;
      const std::uint32_t point = number.at(Key{end.edge, end.name});
      border_[static_cast<std::size_t>(end.edge)].push_back({end.share, end.rounding, point, chain[point]});
    }
  for (auto& ends : border_) {
    std::sort(ends.begin(), ends.end(),
              [](const BorderEnd& a, const BorderEnd& b) { return a.share < b.share; });
    // The order is certain if the intervals of possible positions are disjoint and inside the edge.
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const double before = i > 0 ? ends[i - 1].share + ends[i - 1].rounding : 0;
      // NaN is rejected as well.
      if (!(ends[i].share - ends[i].rounding > before) || !(ends[i].share + ends[i].rounding < 1))
        return false;
    }
  }
  return true;
}

/// Assigns cells to the parts of the border, starting at the face's first corner.
bool SimpleCut::walk_round() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;  // chains, with the cells outside them
  std::uint32_t cell = 0;
  cell_count_ = 1;
  // The part between the corner and the first end belongs to the current cell.
  for (std::size_t edge = 0; edge < 3; ++edge) {
    cells_[edge].push_back(cell);
    for (const BorderEnd& end : border_[edge]) {
      if (!open.empty() && open.back().first == end.chain) {
        // Second end of the innermost open chain: return to the cell outside it.
        cell = open.back().second;
        open.pop_back();
      } else {
        // First end of a chain: a new cell begins behind it.
        open.emplace_back(end.chain, cell);
        cell = cell_count_++;
      }
      cells_[edge].push_back(cell);
    }
  }
  return open.empty();  // otherwise chains would cross
}

std::pair<int, double> SimpleCut::place_on_border(std::uint32_t cell) const {
  // A corner of the face needs no rounding.
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (cells_[edge].front() == cell) return {static_cast<int>(edge), 0};
  // Otherwise the midpoint of a part between two ends, or between an end and the corner.
  for (std::size_t edge = 0; edge < 3; ++edge)
    for (std::size_t part = 1; part < cells_[edge].size(); ++part)
      if (cells_[edge][part] == cell) {
        const double from = border_[edge][part - 1].share;
        const double to = part < border_[edge].size() ? border_[edge][part].share : 1;
        return {static_cast<int>(edge), 0.5 * (from + to)};
      }
  return {0, 0};  // every cell has a part of the border
}

}  // namespace lrb
