#pragma once
/// The traversal of another engine for the collision query of two bodies, recorded inside that engine by a
/// separate program (bench/programs/xray_*.cpp).

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::xray {

/// A test of two bounding volumes, or of two triangles.
struct ForeignEvent {
  bool is_leaf_test;
  std::uint32_t a, b;  ///< nodes of the engine's trees, or simplices
  bool meet;           ///< they overlap, or the triangles intersect, according to the engine
};

struct ForeignStep {
  std::vector<ForeignEvent> events;             ///< in the engine's order
  std::uint64_t box_tests = 0, leaf_tests = 0;  ///< the engine's own counts
};

struct ForeignWalk {
  std::string title;  ///< "FCL 0.7.0, BVHModel<OBBRSS>"
  std::array<trace::TreeShape, 2> trees;
  std::vector<ForeignStep> steps;
};

/// The poses of A and B at one time, body to world.
struct PosePair {
  Pose a, b;
};

/// Runs an engine ("fcl", "cgal") on the real triangles of two 3D bodies. Throws InputError for bodies and
/// poses that it does not support, and EnvironmentError if its program is missing or fails.
ForeignWalk walk_of(const std::string& engine, const LrbRep& a, const LrbRep& b,
                    std::span<const PosePair> poses);

// Another engine's traversal as a recorded run, so that all pictures and statistics apply to it.

/// Returns a recording of the traversal at the steps of `ours`, with its bodies. The results are those of
/// `ours`, so that pictures show the actual intersections; the other engine's answer is in the trace. A pair
/// of bounding volumes is a node pair with one test; `met` is the number of pairs that the engine continues
/// with.
run::Recording recording_of(const ForeignWalk& walk, const run::Recording& ours,
                            const spec::Scenario& scenario);

/// Pairs that an engine reported but that do not intersect, and intersecting pairs that it missed.
struct WrongPairs {
  std::vector<SimplexPair> too_many, missing;  ///< ascending
};
/// Compares the pairs of a step with the exact ones, which must be ascending.
WrongPairs wrong_pairs(const ForeignStep& step, const std::vector<SimplexPair>& exact);

// Writes a page that compares the traversals of two engines for the same bodies at the same poses.

/// Two recordings of the same bodies and steps.
struct Xray {
  const spec::Scenario& scenario;
  const ForeignWalk& walk;
  const run::Recording &theirs, &ours;
  std::string method;   ///< name of the other engine's folder
  std::string command;  ///< the command line
  std::string why;      ///< the command that explains a pair, without --pose and --pair
};

/// Writes folder/index.html with folder/heat.png, and each run with its own page, trace and frames in a
/// subfolder. Returns notes as text.
std::vector<std::string> write_xray(const Xray& xray, const std::string& folder,
                                    const run::ProgressReport& progress);

}  // namespace lrb::xray
