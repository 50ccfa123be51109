#pragma once
/// The numbers of faces that colours mean.

#include <array>
#include <span>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"
#include "trace/tree_shape.hpp"

namespace lrb::run {

/// Returns the number of each face (|F|) in `events`; none for colours that mean no number. `tree`: the one that was
/// walked of the body, null if pairs of its nodes were not recorded: then there are no box tests.
std::vector<double> face_values(spec::FrameSpec::ColourBy by, const LrbRep& rep, Side side,
                                std::span<const trace::Event> events, const trace::TreeShape* tree);

/// Returns the ends of a scale for the numbers of A's and B's faces, of which the smallest are left out: a fiftieth of
/// the largest, and that. For box tests: nodes near the root hold most faces, so that all faces have a small share.
std::array<double, 2> scale_without_the_smallest(std::span<const std::vector<double>> values);

}  // namespace lrb::run
