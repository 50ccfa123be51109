#pragma once
/// Groups of a body's faces, and sums over them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::run {

/// Returns the region that a face belongs to, one that covers a real face or that a pseudo face hides; kNull:
/// none.
std::uint32_t region_of(const LrbRep& rep, FaceId face);

/// Returns a face's level, the number of regions between it and the outside.
std::uint32_t level_of(const LrbRep& rep, FaceId face);

/// Returns, for each face (|F|), the sum of the values over its region or its level; a face without a region
/// keeps its own.
std::vector<double> grouped(std::vector<double> values, render::FrameSpec::ColourPer per, const LrbRep& rep);

// Computes the value by which each face is coloured.

/// Returns the value of each face (|F|), counted over `events`; empty if `by` does not colour by value.
/// `tree`: the one that was walked of the body, null if pairs of its nodes were not recorded: then there are
/// no box tests.
std::vector<double> face_values(render::FrameSpec::ColourBy by, const LrbRep& rep, Side side,
                                std::span<const trace::Event> events, const trace::TreeShape* tree);

/// Returns {largest / 50, largest} of the values of A's and B's faces: the range of a scale on which smaller
/// values are not told apart. For box tests: nodes near the root hold most faces, so that every face has a
/// small share.
std::array<double, 2> scale_without_the_smallest(std::span<const std::vector<double>> values);

/// Adds the boxes of the nodes of one depth of a body's tree that the walk came to in `events`: those that
/// met another node's, and those that parted from all of them.
void add_node_boxes(render::Scene& scene, const trace::TreeShape& tree, Side side, const Pose& pose,
                    std::uint32_t depth, std::span<const trace::Event> events, const render::Style& style);

}  // namespace lrb::run
