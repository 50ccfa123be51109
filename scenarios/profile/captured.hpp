#pragma once
/// A recorded run of lrbscope as a capture, so that it is checked and priced as other engines are.

#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// Returns a recording of two 3D bodies at EventLevel::nodes or above as a capture, a query for each step.
///
/// - Meshes: the real faces as triangles, under the numbers of their simplices.
/// - Volumes: the nodes' own OBBs. A query first compares the boxes of children in their parents'
///   frames, which are other boxes; where it did, the comparison is taken as recorded.
/// - Events: a visit of two wide nodes is one test of nodes, with its number of compared boxes. It was
///   visited because the boxes of both in their parents overlap. At a pair of leaves the boxes of triangles
///   are compared. Pairs of triangles that a plane separates are not among the tests of triangles.
/// - Only the traversal of the bodies themselves is converted; traversals of levels of detail are not.
///
/// Throws InputError for a recording of one body, of 2D bodies, or without pairs of nodes.
capture::Capture captured(const run::Recording& recording);

}  // namespace lrb::profile
