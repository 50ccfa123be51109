#pragma once
/// The worker programs beside lrbscope, and the methods that they have.

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/stability/grid.hpp"

namespace lrb::stability {

struct WorkerMethod {
  MethodColumn column;
  std::string program;       ///< path of the worker that has it
  methods::MethodInfo info;  ///< the column's, and what else the worker says of it
};

/// Asks the workers in the folder of this very program, or in the one that the environment's LRBSCOPE_METHODS
/// names. Throws EnvironmentError if there is none, or one does not answer.
std::vector<WorkerMethod> find_all_methods();
/// Those that take part in the stability experiment.
std::vector<WorkerMethod> find_methods();

/// The families of all_families(), in their order.
std::vector<FamilyRow> family_rows();

}  // namespace lrb::stability
