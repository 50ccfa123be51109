#pragma once
/// Two recorded runs side by side: their answers and work step by step, or how their bodies were built.
///
/// The regions of two LRB-reps of one body are matched by place. Regions of different builds have no numbers
/// in common. A region is where the real faces below it are: those that its removal, and that of all regions
/// beneath it, exposes (along parents; a region without any is above those of the regions that it touches).
/// Two regions are at the same place if at least half of the real faces below either are below both.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/compare/side_by_side.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::compare {

/// Least share of the real faces below either of two regions that is below both, for the same place.
inline constexpr double kSamePlace = 0.5;

struct MatchedRegions {
  std::array<RegionId, 2> of;            ///< of the first and the second LRB-rep
  std::uint32_t common = 0;              ///< real faces below both
  std::array<std::uint32_t, 2> below{};  ///< real faces below each

  /// Returns the share of the real faces below either that is below both.
  double overlap() const { return static_cast<double>(common) / either(); }
  /// Returns the number of real faces below either.
  std::uint32_t either() const { return below[0] + below[1] - common; }
};

struct RegionMatching {
  std::vector<MatchedRegions> pairs;               ///< by the numbers of the first
  std::array<std::vector<RegionId>, 2> unmatched;  ///< ascending
};

/// Matches regions one to one, those with the largest overlap first; among equals those whose depths differ
/// least, then those of lower numbers. Both must have the same real faces.
RegionMatching match_regions(const LrbRep& x, const LrbRep& y);

/// Returns true if the real faces of both, with the positions of their vertices, are the same.
bool same_real_faces(const LrbRep& x, const LrbRep& y);

struct Difference {
  /// Where the runs begin to differ: their bodies and requests, and the first differing event or answer;
  /// nullopt if they are equal.
  std::optional<std::string> first;
  std::string regions;  ///< of runs of one body: a line on their regions; else empty
};

/// Writes folder/index.html and folder/compare.png: the first difference, answers and work step by step, and
/// the distribution of the work in each run. For runs of one body: the changes of the front or the wrapper,
/// and the regions of both, matched by place. Throws InputError if one run is of one body and
/// the other of two.
Difference write_comparison(const Runs& runs, const std::string& command, const std::string& folder,
                            const record::ProgressReport& progress);

}  // namespace lrb::compare
