#pragma once

#include <stdexcept>
#include <string>

#include <lrbscope/error.hpp>

namespace lrb::fuzz {

inline void judge_message(std::string_view message, std::string_view name) {
  const bool named = message.starts_with(std::string(name) + ":");
  bool one_line = true;
  for (const char c : message) one_line = one_line && static_cast<unsigned char>(c) >= ' ';
  if (!named || !one_line)
    throw std::logic_error("a message is not one line that begins with " + std::string(name) + ": " +
                           std::string(message));
}

template <class Read>
bool accepted(std::string_view name, const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& e) {
    judge_message(e.what(), name);
    return false;
  }
}

}  // namespace lrb::fuzz
