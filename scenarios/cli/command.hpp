#pragma once
/// The commands of `lrbscope`, one file each. stdout is data, stderr is for people.
/// Exit codes: 0 ok, 1 mismatch, 2 usage or input, 3 environment.

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace lrb::cli {

inline constexpr int kOk = 0, kMismatch = 1, kBadInput = 2, kEnvironment = 3;

/// What every command obeys.
struct Globals {
  bool quiet = false;        ///< nothing on stderr but errors
  std::string command_line;  ///< as it was given, quoted for a shell
};

struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command add_run(CLI::App& root, const Globals& globals);
Command add_build(CLI::App& root, const Globals& globals);
Command add_inspect(CLI::App& root, const Globals& globals);
Command add_collide(CLI::App& root, const Globals& globals);
Command add_crowd(CLI::App& root, const Globals& globals);
Command add_query(CLI::App& root, const Globals& globals);
Command add_render(CLI::App& root, const Globals& globals);
Command add_paper(CLI::App& root, const Globals& globals);
Command add_golden(CLI::App& root, const Globals& globals);
Command add_doctor(CLI::App& root, const Globals& globals);
Command add_stability(CLI::App& root, const Globals& globals);
Command add_bench(CLI::App& root, const Globals& globals);
Command add_chart(CLI::App& root, const Globals& globals);
Command add_list(CLI::App& root, const Globals& globals);

/// Parses, runs, and turns exceptions into one line on stderr and an exit code.
int main(int argc, char** argv);

/// Lines for people, unless quiet.
void note(const Globals& globals, const std::vector<std::string>& lines);

/// A word as it can stand in a shell's command line.
std::string shell_word(const std::string& word);

/// As JSON on a line. Bytes that are not UTF-8, which a file's name may have, become U+FFFD.
std::string one_line(const nlohmann::ordered_json& value);

/// A value as people read it: numbers that are not whole, with so many significant digits.
std::string for_people(const nlohmann::ordered_json& value, int digits);

/// Writes to stdout and makes sure that it arrived. Throws EnvironmentError.
void print(const std::string& text);

}  // namespace lrb::cli
