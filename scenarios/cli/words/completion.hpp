#pragma once
/// Scripts by which shells complete the words of a program.

#include <string>
#include <vector>

#include "scenarios/cli/words/words.hpp"

namespace lrb::words {

/// Names that stand in the place of files.
struct ShippedNames {
  std::vector<std::string> scenarios, crowds, experiments;
  const std::vector<std::string>& of(Value value) const;  ///< none for values that are no such names
};

/// Return the script of a shell.
std::string bash_completion(const Command& program, const ShippedNames& names);
std::string zsh_completion(const Command& program, const ShippedNames& names);
std::string fish_completion(const Command& program, const ShippedNames& names);

/// Returns the words with a blank between them.
std::string joined(const std::vector<std::string>& words);

}  // namespace lrb::words
