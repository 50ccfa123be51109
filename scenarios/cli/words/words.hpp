#pragma once
/// The commands and options of a program as data, taken from the definitions by which it parses them: for
/// manual pages and for the completions of shells.

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lrb::words {

/// What completes a value.
enum class Value : std::uint8_t { none, choice, file, folder, scenario, crowd, experiment };

struct Option {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional one its name alone
  std::string type;                ///< as --help has it: "DIR", "N", "a|b"; empty: a flag
  std::string help;
  std::string fallback;  ///< the value without it; empty: none to tell
  bool positional = false, required = false;
  bool many = false;  ///< takes several values
  Value value = Value::none;
  std::vector<std::string> choices;

  bool flag() const { return !positional && type.empty(); }
};

struct Command {
  std::string name, purpose;
  std::vector<Option> options;
  std::vector<Command> commands;
};

/// Returns the words of a program or command, without what it hides.
Command words_of(const CLI::App& app);

}  // namespace lrb::words
