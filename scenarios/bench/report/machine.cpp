#include "scenarios/bench/report/machine.hpp"

#include <fstream>
#include <thread>

namespace lrb::bench {

std::string machine() {
  std::ifstream in("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(in, line);)
    if (const std::size_t colon = line.find(": ");
        colon != std::string::npos && line.rfind("model name", 0) == 0) {
      model = line.substr(colon + 2);
      break;
    }
  const unsigned cores = std::thread::hardware_concurrency();
  return std::to_string(cores) + (cores == 1 ? " core, " : " cores, ") + model;
}

std::string build_flags() {
#ifdef __clang__
  return "clang " __clang_version__ ", " LRB_FLAGS;
#else
  return "gcc " __VERSION__ ", " LRB_FLAGS;
#endif
}

}  // namespace lrb::bench
