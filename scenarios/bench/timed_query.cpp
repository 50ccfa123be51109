#include "scenarios/bench/timed_query.hpp"

#include <cstddef>
#include <vector>

namespace lrb::bench {

void sweep_caches() {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kLine = 64;
  static std::vector<unsigned char> junk(kBytes, 1);
  for (std::size_t i = 0; i < junk.size(); i += kLine) ++junk[i];
}

}  // namespace lrb::bench
