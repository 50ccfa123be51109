#pragma once
/// Cases that write texts need a font. They are the suite "font", a test of its own, which is skipped without
/// one.

#include <cstdio>
#include <cstdlib>

#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::test {

/// Ends the program with 77, "skipped" for ctest, if there is no font.
inline void need_font() {
  try {
    render::find_font(false);
    render::find_font(true);
  } catch (const EnvironmentError& e) {
    std::printf("skipped: %s\n", e.what());
    std::exit(77);
  }
}

}  // namespace lrb::test
