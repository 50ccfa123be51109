#pragma once
/// Worker programs of other engines, for tests of the commands that start them.

#include <stdexcept>
#include <string>

#include "bench/workers/workers.hpp"
#include "tests/support/program.hpp"

namespace lrb::test {

/// The workers, with methods that misbehave among them.
struct WorkerPrograms {
  Environment where{"LRBSCOPE_METHODS", LRBSCOPE_FOLDER};
  Environment fakes{"LRBSCOPE_FAKE_METHODS", "1"};
};

inline workers::WorkerMethod worker_method(const std::string& name) {
  for (const workers::WorkerMethod& m : workers::find_methods())
    if (m.info.name == name) return m;
  throw std::runtime_error("no method " + name);
}

}  // namespace lrb::test
