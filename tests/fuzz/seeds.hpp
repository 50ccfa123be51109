#pragma once
/// Valid inputs of every format, to be mutated.

#include <string>
#include <vector>

namespace lrb::fuzz {

struct Format {
  std::string name;
  bool (*feed)(std::string_view);
  std::vector<std::string> seeds;  ///< each accepted by `feed`
};

std::vector<Format> formats();

/// Recorded by lrbscope_capture.h.
std::vector<std::string> captures();

}  // namespace lrb::fuzz
