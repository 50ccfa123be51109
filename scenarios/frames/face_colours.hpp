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

namespace lrb::frames {

/// Returns the region of a face: the one that covers a real face or is behind a pseudo face. Returns kNull if
/// there is none.
std::uint32_t region_of(const LrbRep& rep, FaceId face);

/// Returns the region depth of a face: the number of regions between it and the outside.
std::uint32_t level_of(const LrbRep& rep, FaceId face);

/// Returns, for each face (|F|), the sum of the values over its region or its region depth; a face without a
/// region keeps its own value.
std::vector<double> grouped(std::vector<double> values, pictures::FrameSpec::ColourPer per,
                            const LrbRep& rep);

// Computes the value by which each face is coloured.

/// Returns the value of each face (|F|), counted over `events`; empty if `by` does not colour by value.
/// `tree`: the tree traversed for the body, null if pairs of its nodes were not recorded; there are no box
/// tests then.
std::vector<double> face_values(pictures::FrameSpec::ColourBy by, const LrbRep& rep, Side side,
                                std::span<const trace::Event> events, const trace::TreeShape* tree);

/// Returns {maximum / 50, maximum} of the values of A's and B's faces: a scale on which smaller values look
/// alike. For box tests: nodes near the root contain most faces, so that every face has a small share.
std::array<double, 2> scale_without_the_smallest(std::span<const std::vector<double>> values);

/// Adds the boxes of the nodes of one depth of a body's tree that the traversal visited in `events`: those
/// that overlapped another node's, and those separated from all of them.
void add_node_boxes(render::Scene& scene, const trace::TreeShape& tree, Side side, const Pose& pose,
                    std::uint32_t depth, std::span<const trace::Event> events, const render::Style& style);

}  // namespace lrb::frames
