#pragma once
/// The commands that measure bodies, methods and the paper's experiment. They make up a program of their own,
/// lrbscope-measure, that lrbscope starts for them: it takes longer to compile than all the rest, and nobody
/// needs it at first.

#include <array>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace lrb::cli {

struct MeasuringWord {
  std::string_view name, purpose;
  int rank;  ///< as in CommandEntry
};

/// The commands, in the order of their names.
inline constexpr std::array kMeasuringWords = {
    MeasuringWord{
        "bench",
        "Compare our query with other engines on the same bodies and poses: how many times as long they take",
        130},
    MeasuringWord{
        "chart", "Chart speed against accuracy: every method at every setting, exact ones and approximations",
        140},
    MeasuringWord{"levels", "How many faces a body needs at a row of tolerances, and the proof", 65},
    MeasuringWord{
        "paper",
        "Repeat the paper's experiment: its tables and figures, close-ups of single collisions, and the same "
        "on meshes",
        80},
    MeasuringWord{"stability",
                  "Put families of hard cases to our query and to other engines: who fails where", 100},
    MeasuringWord{"xray", "Record another engine's walk, and show it beside ours", 68},
};

/// Returns the line of a command in the table; a word that is not there fails to compile.
consteval MeasuringWord measuring_word(std::string_view name) {
  for (const MeasuringWord& word : kMeasuringWords)
    if (word.name == name) return word;
  throw "not in the table";
}

/// Adds the command of such a line to lrbscope-measure.
inline CLI::App* add_measuring(CLI::App& root, const MeasuringWord& word) {
  return root.add_subcommand(std::string(word.name), std::string(word.purpose));
}

}  // namespace lrb::cli
