#pragma once
/// The traversal of another engine for the collision query of two bodies, recorded inside that engine by a
/// separate program (bench/programs/xray_*.cpp).

#include <span>
#include <string>
#include <vector>

#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::xray {

/// The poses of A and B at one time, body to world.
struct PosePair {
  Pose a, b;
};

/// Runs an engine ("fcl", "cgal") on the real triangles of two 3D bodies, and returns a capture with a query
/// for each pose. Throws InputError for bodies and poses that it does not support, and EnvironmentError if
/// its program is missing or fails.
capture::Capture walk_of(const std::string& engine, const LrbRep& a, const LrbRep& b,
                         std::span<const PosePair> poses);

/// Returns a recording of the traversals at the steps of `ours`, with its bodies and results
/// (profile::captured_run).
run::Recording recording_of(const capture::Capture& walk, const run::Recording& ours,
                            const spec::Scenario& scenario);

// Writes a page that compares the traversals of two engines for the same bodies at the same poses.

/// Two recordings of the same bodies and steps.
struct Xray {
  const spec::Scenario& scenario;
  const run::Recording &theirs, &ours;
  std::string method;   ///< name of the other engine's folder
  std::string command;  ///< the command line
  std::string why;      ///< the command that explains a pair, without --pose and --pair

  const std::string& title() const { return theirs.trace.header.engine; }  ///< "FCL 0.7.0, BVHModel<OBBRSS>"
};

/// Writes folder/index.html with folder/heat.png, and each run with its own page, trace and frames in a
/// subfolder. Returns notes as text.
std::vector<std::string> write_xray(const Xray& xray, const std::string& folder,
                                    const run::ProgressReport& progress);

}  // namespace lrb::xray
