#pragma once

#include <string>

#include "scenarios/cli/words/words.hpp"

namespace lrb::words {

/// Returns the manual page (roff, section 1) of a program: its commands, its options, exit codes and
/// environment.
std::string program_page(const Command& program, const std::string& version);

/// Returns that of one of its commands, with the options of the commands below it.
std::string command_page(const Command& program, const Command& command, const std::string& version);

}  // namespace lrb::words
