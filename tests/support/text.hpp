#pragma once
/// What tests ask of texts.

#include <cstddef>
#include <string>

#include <lrbscope/error.hpp>

namespace lrb::test {

/// Returns the number of occurrences of `part` in `text`.
inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Returns the message of the InputError with which something is rejected; empty if it is accepted.
template <class Ask>
std::string error_of(const Ask& ask) {
  try {
    static_cast<void>(ask());
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

}  // namespace lrb::test
