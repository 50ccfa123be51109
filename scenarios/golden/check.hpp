#pragma once
/// Compares a run with the approved one, on the levels selected in the golden: answers, events and counters
/// exactly; pictures by hash, then within a tolerance for differences between processors.

#include <optional>
#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

struct ImageVerdict {
  std::string file;  ///< the nearest approved picture; for a frame without one, its own name
  bool passed = false;
  bool equal = false;       ///< in every pixel
  std::string text;         ///< one line: the size of the difference, and what moved or changed
  std::string change;       ///< only what moved or changed; may be empty
  std::size_t frame = 0;    ///< index into GoldenRun::frames and Golden::frames
  std::size_t variant = 0;  ///< index into Golden::frames[frame]; meaningless if has_expected is false
  bool has_expected = false, has_actual = false;
};

/// Compares a picture with the approved variants of its frame.
ImageVerdict check_frame(const std::vector<GoldenImage>& variants, const frames::PaintedFrame& actual,
                         std::size_t frame, const GoldenSpec& spec);

struct GoldenVerdict {
  std::string rejection;          ///< why the test could not run; all other fields are then empty
  std::vector<Effect> effects;    ///< differences in answers and counters
  bool answers_differ = false;    ///< and answers are compared
  std::vector<Effect> more_work;  ///< find_more_work(); empty if work is not compared
  std::optional<trace::Divergence> divergence;  ///< nullopt if events are not compared
  std::string diagnosis;  ///< the swapped, lost or added events at the divergence; may be empty
  std::vector<ImageVerdict> images;
  std::vector<std::string> causes;  ///< possible causes of a failure; empty if it passed
  std::string group;                ///< equal for failures with equal causes; empty if it passed
  bool images_passed() const;
  bool passed() const {
    return rejection.empty() && !answers_differ && more_work.empty() && !divergence && images_passed();
  }
};

GoldenVerdict check_golden(const Golden& golden, const GoldenRun& run);

}  // namespace lrb::golden
