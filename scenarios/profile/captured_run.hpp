#pragma once
/// Converts the queries of a capture to recorded runs, so that all pictures and statistics of runs apply to
/// another engine's traversals; and a recorded run of lrbscope to a capture, so that it is checked and priced
/// as other engines are.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/trace/capture.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/work.hpp>

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
capture::Capture captured(const record::Recording& recording);

/// Describes the rays, points and boxes of queries by meshes and trees with the number 0, equal ones once.
/// Then they are queries of two trees.
void describe_probes(capture::Capture& capture);

/// The queries of a capture between two trees. A tree that was refitted is another tree.
struct TreePair {
  std::array<std::uint32_t, 2>
      trees{};                       ///< indices in Capture::trees; equal in queries of a tree with itself
  std::vector<std::size_t> queries;  ///< indices in Capture::queries, ascending
};

struct TreePairs {
  std::vector<TreePair> pairs;     ///< in the order of their first queries
  std::uint64_t without_tree = 0;  ///< queries with an undescribed triangle or shape on one side, left out
};
TreePairs tree_pairs(const capture::Capture& capture);

/// Returns the body of a captured mesh, without regions. Its simplices are the mesh's triangles, with the
/// same numbers, whatever the mesh: it may be open, degenerate or self-intersecting. Throws InputError for a
/// mesh without triangles, or with coordinates that are not finite.
bodies::LoadedBody captured_body(const capture::Mesh& mesh);

struct CapturedRunSettings : trace::RecorderSettings {
  bool check = true;  ///< compute the exact answers
};

/// Returns a recording of the queries of a pair of trees, one for each step. `bodies`: of both meshes, with
/// their triangles as first simplices. Steps have the numbers of the queries, and the engine's own answers;
/// the exact ones are computed if the settings say so.
///
/// A test of two bounding volumes becomes a node pair. Its `met` is the number of pairs that the engine
/// descended to from there, and its predecessor is found by visits_of(). The results are the exact ones, so
/// that pictures show the actual intersections; the engine's answer is in the trace.
record::Recording captured_run(const capture::Capture& capture, const TreePair& pair,
                               std::vector<bodies::LoadedBody> bodies, const CapturedRunSettings& settings,
                               const record::ProgressReport& progress);

/// Returns sentences about the pictures of a pair's run: volumes drawn as boxes, queries of one body
/// with itself, queries that were not kept or not compared. Empty if there is nothing to say.
std::string captured_words(const capture::Capture& capture, const TreePair& pair);

/// Returns the name of a tree's mesh; of one that is named after its file, the file's name alone.
std::string mesh_name(const capture::Capture& capture, std::uint32_t tree);

/// Returns the pictures of a captured run: the bodies and the contact, side by side.
pictures::FrameSpec captured_frames();
/// Returns the scenario of a pair's run: its title, its pictures and the hash of what defines it. `file`: of
/// the capture.
spec::Scenario captured_scenario(const capture::Capture& capture, const TreePair& pair,
                                 const std::vector<bodies::LoadedBody>& bodies, const std::string& file);
/// Returns the bodies of a pair of trees.
std::vector<bodies::LoadedBody> captured_bodies(const capture::Capture& capture, const TreePair& pair);
/// Returns the settings of the run of a scenario. `file`: name of the capture in the sources of the bodies.
CapturedRunSettings captured_settings(const spec::Scenario& scenario, const capture::Capture& capture,
                                      const TreePair& pair, const std::string& file);

}  // namespace lrb::profile
