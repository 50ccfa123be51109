#pragma once
/// The commands of `lrbscope`, one file each in this folder, listed in commands.cpp. stdout is for data,
/// stderr for messages. Exit codes: 0 ok, 1 mismatch, 2 usage or input, 3 environment.

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/command_line.hpp"
#include <lrbscope/core/strings.hpp>

namespace lrb::tools {

inline constexpr int kOk = 0, kMismatch = 1, kBadInput = 2, kEnvironment = 3;

/// Settings common to all commands.
struct Globals {
  bool quiet = false;        ///< only errors on stderr
  std::string command_line;  ///< as given, quoted for a shell
};

struct Command {
  App* app;
  std::function<int()> run;
};

/// Adds all commands to the program, in their order in --help. They are listed in commands.cpp.
std::vector<Command> add_commands(App& root, const Globals& globals);

/// Prints completions of the last of these words of a command line, for the scripts of `completion`: "words",
/// "files" or "folders" (names of files or folders are completions, too), then on each line a word, a tab and
/// its help.
int print_completions(const App& root, const std::vector<std::string>& words);

/// Parses the command line and runs the command. Turns exceptions into one line on stderr and an exit code.
int main(int argc, char** argv);

/// Prints message lines to stderr, unless quiet.
void note(const Globals& globals, const std::vector<std::string>& lines);

using io::shell_word;
/// Returns the command line of lrbscope with these words, quoted for a shell.
std::string shell_line(const std::vector<std::string>& words);

/// Returns JSON on one line. Bytes that are not UTF-8, which file names may contain, become U+FFFD.
std::string one_line(const nlohmann::ordered_json& value);

/// Returns a value as display text: numbers that are not integers have `digits` significant digits.
std::string for_people(const nlohmann::ordered_json& value, int digits);

/// Writes to stdout and checks that it was written. Throws EnvironmentError.
void print(const std::string& text);

}  // namespace lrb::tools
