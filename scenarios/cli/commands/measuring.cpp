/// In lrbscope, the commands that measure: each becomes lrbscope-measure, which has them.
#include <utility>

#include <unistd.h>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/measuring_program.hpp"
#include "scenarios/cli/measuring_words.hpp"

namespace lrb::cli {
namespace {

[[noreturn]] void become_measuring_program(char** arguments) {
  const std::string program = measuring_program();
  execv(program.c_str(), arguments);
  throw EnvironmentError(printable_name(program) + ": cannot be started, and has the command \"" +
                         printable_name(arguments[1]) +
                         "\"; build it: cmake --build --preset release --target lrbscope-measure");
}

template <std::size_t Word>
Command add_word(CLI::App& root, const Globals& globals) {
  CLI::App* app = add_measuring(root, kMeasuringWords[Word]);
  return {app, [&globals]() -> int { become_measuring_program(globals.arguments); }, true};
}

template <std::size_t... Words>
std::vector<CommandEntry> entries(std::index_sequence<Words...>) {
  return {{add_word<Words>, kMeasuringWords[Words].rank}...};
}

}  // namespace

std::vector<CommandEntry> measuring_commands() {
  return entries(std::make_index_sequence<kMeasuringWords.size()>());
}

}  // namespace lrb::cli
