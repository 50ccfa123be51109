#pragma once
/// Compares a run with what was approved, on two levels: events and counters exactly; pictures by hash and,
/// if that differs, within what processors differ by (ImageTolerance).

#include <optional>
#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include "trace/divergence.hpp"

namespace lrb::golden {

struct ImageVerdict {
  std::string file;  ///< the approved picture that comes nearest; for a frame that has none, its own name
  bool passed = false;
  bool equal = false;       ///< in every pixel
  std::string text;         ///< one line: by how much it differs, and what moved or changed
  std::size_t frame = 0;    ///< index into GoldenRun::frames and Golden::frames
  std::size_t variant = 0;  ///< index into Golden::frames[frame]; meaningless if has_expected is false
  bool has_expected = false, has_actual = false;
};

struct GoldenVerdict {
  std::string refusal;  ///< why it could not be tested at all; everything else is empty then
  std::optional<trace::Divergence> divergence;
  std::string diagnosis;  ///< what was swapped, lost or added at the divergence; may be empty
  std::vector<ImageVerdict> images;
  bool scenario_changed = false;  ///< the scenario's file is not the one that was approved: a hint, not a
                                  ///< failure
  bool images_passed() const;
  bool passed() const { return refusal.empty() && !divergence && images_passed(); }
};

GoldenVerdict check_golden(const Golden& golden, const GoldenRun& run);

}  // namespace lrb::golden
