#pragma once

#include <string>

namespace lrb::bench {

/// Returns what /proc/cpuinfo says: "2 cores of an AMD EPYC".
std::string machine();
/// Returns what all our code and others' headers were compiled with: "GCC 12.2, -O3 -march=native".
std::string build_flags();

}  // namespace lrb::bench
