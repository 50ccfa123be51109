#pragma once
/// Verification of the invariants of an LRB-rep. Slow and exact; for tests, `inspect --validate` and
/// builders.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>

namespace lrb {

struct ValidateOptions {
  bool embedding = true;  ///< test all pairs of faces of the complex exactly
  /// Number of random wrapper states to check for closedness, volume and enclosure.
  std::uint32_t wrapper_states = 100;
  std::uint64_t seed = 1;
  std::uint32_t max_messages = 20;
  unsigned threads = 1;  ///< 0: number of hardware threads. The report does not depend on it
  bool levels = true;    ///< check stored levels of detail, if there are any
};

struct ValidateReport {
  bool valid = true;  ///< no violations; faults of the input do not count as violations
  /// One line for each, naming region and faces; at most max_messages lines.
  std::vector<std::string> violations;
  std::uint64_t violation_count = 0;
  /// Pairs of real simplices that intersect beyond shared corners and edges: faults of the input.
  std::uint64_t real_pairs_meeting = 0;
  /// Pairs of a face and a lid that hides it which touch without crossing: zero volume, allowed.
  std::uint64_t flat_pairs = 0;
  std::uint64_t embedding_pairs = 0;                              ///< pairs of simplices tested exactly
  std::uint32_t states = 0;                                       ///< wrapper states checked
  double volume_solid = 0, volume_regions = 0, volume_outer = 0;  ///< unit cubed (2D: squared)
  double volume_error = 0;  ///< |solid + regions - outer| / outer; only rounding, because the sum telescopes
};

/// Checks the invariants of an LRB-rep, weakest first:
/// 1. Each region and the solid are closed, with volume >= 0 (up to rounding).
/// 2. The volumes of solid and regions add up to the outermost wrapper's volume.
/// 3. No two faces of the complex intersect except in shared vertices and edges (the proof of embedding). A
///    face that touches a lid which hides it, from behind, is allowed and counted separately.
/// 4. Each random wrapper state is closed, has the volume of its cells, and strictly contains the real
///    vertices that are not on it.
/// Also checks the results stored in files: the hash, the bounds of the OBB tree, and, if there are levels of
/// detail, their trees' bounds and the thicknesses of regions.
ValidateReport validate(const LrbRep& rep, const ValidateOptions& options = {});

/// Checks invariants 1 and 2 only. Takes less than 1 % of the time to build the LRB-rep (measured in
/// docs/meshes.md). Body runs it on every LRB-rep.
ValidateReport validate_cells(const LrbRep& rep);

/// Returns the signed volume (2D: area) behind a closed set of faces: those of `outward` with their own
/// orientation, those of `inward` reversed. Mesh units cubed (2D: squared).
double enclosed_volume(const LrbRep& rep, std::span<const FaceId> outward,
                       std::span<const FaceId> inward = {});
/// Returns the volume of a region: behind its lids and in front of its floor.
double region_volume(const LrbRep& rep, RegionId r);
/// Returns the mean height of lids above the faces they hide: the volume of all regions divided by the area
/// (2D: length) of all lids. Mesh units; 0 without regions.
double lid_height(const LrbRep& rep);

}  // namespace lrb
