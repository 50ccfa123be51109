#pragma once
/// Proves or refutes what an LRB-rep promises. Slow and exact; for tests, `inspect --validate` and builders.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>

namespace lrb {

struct ValidateOptions {
  bool embedding = true;  ///< test every pair of faces of the complex exactly
  /// Random wrapper states to check for closedness, volume and enclosure.
  std::uint32_t wrapper_states = 100;
  std::uint64_t seed = 1;
  std::uint32_t max_messages = 20;
  unsigned threads = 1;  ///< 0: as many as the machine runs at once. The report does not depend on it
};

struct ValidateReport {
  bool valid = true;  ///< there are no violations; faults of the input are not violations
  /// One line each, naming region and faces; at most max_messages lines.
  std::vector<std::string> violations;
  std::uint64_t violation_count = 0;
  std::uint64_t real_pairs_meeting =
      0;  ///< pairs of real simplices that meet outside their shared edges and corners: faults of the input
  std::uint64_t flat_pairs =
      0;  ///< faces that touch, but do not pass through, a lid that hides them: zero volume, allowed
  std::uint64_t embedding_pairs = 0;                              ///< pairs of simplices tested exactly
  std::uint32_t states = 0;                                       ///< wrapper states checked
  double volume_solid = 0, volume_regions = 0, volume_outer = 0;  ///< unit cubed (2D: squared)
  double volume_error = 0;  ///< |solid + regions - outer| / outer; only rounding, because the sum telescopes
};

/// Checks the invariants of an LRB-rep, weakest first: every region and the solid are closed, with volume >=
/// 0 (to rounding); the volumes of solid and regions add up to the outermost wrapper's; no two faces of the
/// complex meet except in shared vertices and edges (this is the proof of embedding; a face that touches a
/// lid which hides it, and stays behind it, is counted separately); every random wrapper state is closed, has
/// the volume of its cells, and holds strictly inside the real vertices that it does not touch. Also checks
/// what a file stores to save time: the hash, the bounds of the query's tree, and of the levels, if there are
/// any, the trees' bounds and how thick regions are said to be.
ValidateReport validate(const LrbRep& rep, const ValidateOptions& options = {});

/// Checks the first two of these invariants only: closed cells, and volumes that add up. Takes less than
/// 1 % of the time to build the LRB-rep (measured in docs/meshes.md); Body runs it on every LRB-rep that it
/// takes.
ValidateReport validate_cells(const LrbRep& rep);

/// Returns the signed volume (2D: area) behind a closed set of faces: those of `outward` taken with their
/// normal outward, those of `inward` seen from their other side; unit cubed (2D: squared).
double enclosed_volume(const LrbRep& rep, std::span<const FaceId> outward,
                       std::span<const FaceId> inward = {});
/// Returns the volume of a region: behind its lids and in front of its floor.
double region_volume(const LrbRep& rep, RegionId r);
/// Returns how tightly lids lie: their mean height above what they hide, which is the volume of all regions
/// over the area (2D: length) of all lids; mesh's unit, 0 without regions.
double lid_height(const LrbRep& rep);

}  // namespace lrb
