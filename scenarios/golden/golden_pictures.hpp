#pragma once
/// Pictures of a test of goldens: approved, found, and their difference.

#include "scenarios/golden/golden_report.hpp"

namespace lrb::golden {

/// Adds pictures of both runs, which differ, at the first differing event; as a whole and in a close-up,
/// through the same cameras. Without pictures, the comparison says why.
void add_divergence(GoldenResult& result, const Golden& golden, const GoldenRun& run);

/// Adds the proof maps of the first differing step, if pairs of nodes are recorded, of the same bodies with
/// the trees that they have now.
void add_maps(GoldenResult& result, const Golden& golden, const GoldenRun& run);

/// Adds a frame of the run. If it failed, a circle marks what differs.
void add_image(GoldenResult& result, const Golden& golden, const GoldenRun& run, const ImageVerdict& v);

}  // namespace lrb::golden
