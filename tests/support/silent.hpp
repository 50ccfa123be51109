#pragma once

#include "scenarios/run/recorded_run.hpp"

namespace lrb::test {

/// A report of progress that nobody reads.
inline const run::ProgressReport kSilent = [](const std::string&, std::uint64_t, std::uint64_t) {};

}  // namespace lrb::test
