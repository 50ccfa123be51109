#pragma once
/// Methods that misbehave, to test what becomes of them. The list has them only if the environment has
/// LRBSCOPE_FAKE_METHODS.

#include <vector>

#include "bench/rivals/method.hpp"

namespace lrb::worker_programs {

/// Returns the fake methods. All answer rightly where there is no contact. Where there is, "fake-crash"
/// aborts, "fake-hang" never returns, "fake-refuse" refuses, "fake-throw" throws, and "fake-miss" forgets the
/// first pair. "fake-absent" is absent. Returns none if "ours", which they pretend to be, is not among the
/// program's methods.
std::vector<methods::MethodEntry> fake_methods(const std::vector<methods::MethodEntry>& methods);

}  // namespace lrb::worker_programs
