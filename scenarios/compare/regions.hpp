#pragma once
/// The regions of two LRB-reps of one body, matched by place.
///
/// Regions of different builds have no numbers in common. A region is where the real faces below it are:
/// those that its removal, and that of all regions beneath it, exposes (along parents; a region without any
/// is above those of the regions that it touches). Two regions are at the same place if at least half of the
/// real faces below either are below both.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/record/attempts.hpp"
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

/// Compared properties of a region.
struct RegionFacts {
  std::uint32_t lids = 0, floor = 0;
  double bound = 0;   ///< proven maximum deviation of its lids from the body, mesh units
  double volume = 0;  ///< 2D: area
  std::uint32_t attempts = 0;
  run::VerdictCounts verdicts{};  ///< of the attempts

  bool operator==(const RegionFacts&) const = default;
};

/// Two LRB-reps of one body compared by region.
struct RegionComparison {
  RegionMatching matching;
  std::array<std::vector<RegionFacts>, 2> facts;  ///< by region
  std::vector<std::size_t> different;      ///< pairs whose facts differ, by descending real faces in common
  std::array<std::uint32_t, 2> refused{};  ///< caps in all
  bool has_attempts = false;               ///< both runs are constructions by the builder
};

/// Compares the regions of two runs of one body; nullopt if the bodies have different real faces, or none of
/// them has a region.
std::optional<RegionComparison> compare_regions(const Runs& runs);

/// Returns the comparison in numbers.
std::string regions_sentence(const RegionComparison& c, const Runs& runs);

/// Returns the comparison in a few lines of text: counts, then the largest differences.
std::string regions_text(const RegionComparison& c, const Runs& runs);

/// Returns the comparison as tables: places where both have a region and those differ, and regions without a
/// counterpart. A row's target selects the regions in both views.
std::vector<report::Table> region_tables(const RegionComparison& c, const Runs& runs);

}  // namespace lrb::compare
