#define DOCTEST_CONFIG_IMPLEMENT
#include <cstdio>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/shared_meshes.hpp"

/// Runs the cases. Without the shared meshes the suite "shared meshes" is excluded; if it was requested,
/// returns 77: skipped, for ctest.
int main(int argc, char** argv) {
  constexpr const char* kSuite = "shared meshes";
  doctest::Context context(argc, argv);
  if (lrb::test::shared_meshes().empty()) {
    for (int i = 1; i < argc; ++i) {
      if (argv[i] != std::string("--test-suite=") + kSuite) continue;
      std::puts("skipped: no shared meshes (set LRB_MESHES to their folder)");
      return 77;
    }
    context.addFilter("test-suite-exclude", kSuite);
  }
  return context.run();
}
