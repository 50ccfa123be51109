#pragma once
/// Methods that misbehave, so that what becomes of them can be tested. In the list only if the environment
/// has LRBSCOPE_FAKE_METHODS.

#include <vector>

#include "scenarios/methods/method.hpp"

namespace lrb::worker_programs {

/// All answer rightly where there is no contact. Where there is, "fake-crash" aborts, "fake-hang" never
/// returns, "fake-refuse" refuses, "fake-throw" throws, and "fake-miss" forgets the first pair. "fake-absent"
/// is not there. None if "ours", which they pretend to be, is not among the program's methods.
std::vector<methods::MethodEntry> fake_methods(const std::vector<methods::MethodEntry>& methods);

}  // namespace lrb::worker_programs
