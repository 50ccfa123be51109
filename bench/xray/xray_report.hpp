#pragma once
/// Writes a page with what two engines did for the same bodies at the same poses.

#include <string>
#include <vector>

#include "bench/xray/foreign_walk.hpp"
#include "scenarios/record/recorded_run.hpp"

namespace lrb::xray {

/// Two recordings of the same bodies and steps.
struct Xray {
  const spec::Scenario& scenario;
  const ForeignWalk& walk;
  const run::Recording &theirs, &ours;
  std::string method;   ///< name of the other engine's folder
  std::string command;  ///< that was given
  std::string why;      ///< the command that explains a pair, but for --pose and --pair
};

/// Writes folder/index.html with folder/heat.png, and each run with its own page, trace and frames in a
/// folder beneath. Returns notes for people.
std::vector<std::string> write_xray(const Xray& xray, const std::string& folder,
                                    const run::ProgressReport& progress);

}  // namespace lrb::xray
