#pragma once
/// Tests that write need a font; without one they are left out, and say so.

#include <string>

#include <doctest/doctest.h>

#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::test {

inline bool have_font() {
  try {
    render::find_font(false);
    render::find_font(true);
    return true;
  } catch (const EnvironmentError& e) {
    MESSAGE("left out: " << std::string(e.what()));
    return false;
  }
}

}  // namespace lrb::test
