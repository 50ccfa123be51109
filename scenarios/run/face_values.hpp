#pragma once
/// Computes the value by which each face is coloured.

#include <array>
#include <span>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"
#include "trace/tree_shape.hpp"

namespace lrb::run {

/// Returns the value of each face (|F|), counted over `events`; empty if `by` does not colour by value.
/// `tree`: the one that was walked of the body, null if pairs of its nodes were not recorded: then there are
/// no box tests.
std::vector<double> face_values(render::FrameSpec::ColourBy by, const LrbRep& rep, Side side,
                                std::span<const trace::Event> events, const trace::TreeShape* tree);

/// Returns {largest / 50, largest} of the values of A's and B's faces: the range of a scale on which smaller
/// values are not told apart. For box tests: nodes near the root hold most faces, so that every face has a
/// small share.
std::array<double, 2> scale_without_the_smallest(std::span<const std::vector<double>> values);

}  // namespace lrb::run
