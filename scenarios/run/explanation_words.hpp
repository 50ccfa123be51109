#pragma once
/// Explanations in words: the same in the program and on pages.

#include <string_view>

#include "engine/query/explain.hpp"

namespace lrb::run {

/// Returns what decided about two faces, so that "decided by" can stand before it.
std::string_view words(DecidedBy by);

}  // namespace lrb::run
