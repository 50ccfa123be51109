#pragma once

#include <string>

namespace lrb::io {

/// Quotes a word, if need be, so that it can stand in a shell's command line.
std::string shell_word(const std::string& word);

}  // namespace lrb::io
