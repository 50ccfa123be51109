/// libFuzzer's entry; LRB_FUZZ_FEED is one of the functions of feed.hpp.

#include <cstdint>

#include "tests/fuzz/feed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lrb::fuzz::LRB_FUZZ_FEED({reinterpret_cast<const char*>(data), size});
  return 0;
}
