#pragma once
/// Proof, or refutation, of what an LRB-rep promises. Slow and exact; for tests, `inspect --validate` and
/// builders.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

struct ValidateOptions {
  bool embedding = true;               ///< test every pair of faces of the complex exactly
  std::uint32_t wrapper_states = 100;  ///< random wrapper states checked for closedness and enclosure
  std::uint64_t seed = 1;
  std::uint32_t max_messages = 20;
};

struct ValidateReport {
  bool valid = false;                   ///< no violation below; faults of the input are not violations
  std::vector<std::string> violations;  ///< one line each, naming region and faces; at most max_messages
  std::uint64_t violation_count = 0;
  std::uint64_t real_pairs_crossing =
      0;  ///< pairs of real faces that meet outside shared parts: the input's fault
  std::uint64_t embedding_pairs = 0;                              ///< pairs tested exactly
  double volume_solid = 0, volume_regions = 0, volume_outer = 0;  ///< unit cubed (2D: squared)
  double volume_error = 0;                                        ///< |solid + regions - outer| / outer
  std::uint32_t negative_regions = 0;  ///< regions with volume below rounding's reach of zero
};

ValidateReport validate(const LrbRep& rep, const ValidateOptions& options = {});

/// Signed volume (2D: area) behind a set of faces, each taken with its normal outward.
double enclosed_volume(const LrbRep& rep, const std::vector<FaceId>& faces);

}  // namespace lrb
