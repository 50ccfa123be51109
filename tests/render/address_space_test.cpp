// Drawing where a limit leaves little address space, in which LLVM crashes.
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "render/gl.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;

TEST_CASE("too little address space for Mesa is an EnvironmentError") {
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  constexpr std::size_t kRoom = std::size_t{64} << 20;
  rlimit tight = before;
  tight.rlim_cur = pages * static_cast<std::size_t>(getpagesize()) + kRoom;
  REQUIRE(setrlimit(RLIMIT_AS, &tight) == 0);
  std::string message;
  try {
    const render::Offscreen context;
  } catch (const EnvironmentError& e) {
    message = e.what();
  }
  REQUIRE(setrlimit(RLIMIT_AS, &before) == 0);
  CHECK(message.find("MiB of address space") != std::string::npos);
}
