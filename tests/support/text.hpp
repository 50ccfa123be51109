#pragma once
/// What tests ask of texts.

#include <cstddef>
#include <string>

namespace lrb::test {

/// Returns the number of occurrences of `part` in `text`.
inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace lrb::test
