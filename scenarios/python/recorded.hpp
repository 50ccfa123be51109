#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/python/body.hpp"
#include "scenarios/run/frame_job.hpp"
#include "scenarios/run/recorded_run.hpp"

namespace lrb::python {

/// A recorded run as Python has it: what the pictures and pages of scenarios/run are made of, with bodies
/// that it shares.
class Recorded {
 public:
  std::vector<std::shared_ptr<const LrbRep>> bodies;  ///< A and B, or A alone
  trace::Trace trace;
  std::shared_ptr<std::vector<CollideResult>> results = std::make_shared<std::vector<CollideResult>>();
  std::vector<trace::TreeShape> trees;
  std::vector<std::string> notes;
  std::string title, purpose;

  /// Returns what frames are drawn from; this object must outlive it.
  run::RecordedRun shown() const;
};

/// Takes a recording over.
std::shared_ptr<Recorded> recorded_of(run::Recording recording, const spec::Scenario& scenario);

void bind_recorded(py::module_& m);

}  // namespace lrb::python
