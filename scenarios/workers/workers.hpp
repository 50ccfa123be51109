#pragma once
/// Finds the worker programs beside lrbscope, and the methods that they have.

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/quantity.hpp"

namespace lrb::workers {

struct MethodColumn {
  std::string name;     ///< for the command line: "ours", "fcl"
  std::string title;    ///< for people: "FCL 0.7.0, OBBRSS, double"
  std::string remark;   ///< what it answers, and how it was asked
  bool present = true;  ///< false: not installed when this was built
};

struct WorkerMethod {
  MethodColumn column;
  std::string program;       ///< path of the worker that has it
  methods::MethodInfo info;  ///< what the worker says about it, including what the column shows
};

/// Asks the workers in the folder of this very program, or in the one that the environment's LRBSCOPE_METHODS
/// names. Throws EnvironmentError if there is none, or if one does not answer.
std::vector<WorkerMethod> find_all_methods();
/// Returns those that take part in the stability experiment.
std::vector<WorkerMethod> find_methods();

/// Returns those that answer with a number. Throws EnvironmentError if their worker is not there.
std::vector<WorkerMethod> find_number_methods(methods::Quantity quantity);
/// Returns the path of that worker. Throws EnvironmentError if it is not there.
std::string number_worker();

/// Returns the methods of one program, in its order, which may be asked for some of them with options. Throws
/// EnvironmentError if it does not answer.
std::vector<WorkerMethod> methods_of(const std::string& program,
                                     const std::vector<std::string>& options = {});

/// Returns the path of another program in that folder; empty if it is not there.
std::string program_beside(const std::string& name);

}  // namespace lrb::workers
