#pragma once

#include <string>

namespace lrb::bench {

/// "2 cores of an AMD EPYC": what /proc/cpuinfo says.
std::string machine();
/// "GCC 12.2, -O3 -march=native": what all code of ours, and others' headers, were compiled with.
std::string build_flags();

}  // namespace lrb::bench
