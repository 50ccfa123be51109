#pragma once

#include <string>
#include <string_view>

namespace lrb::cli {

/// The program that has the commands that measure, and the hidden command of both programs that prints their
/// words as JSON.
inline constexpr std::string_view kMeasuringProgram = "lrbscope-measure", kWordsCommand = "words";

/// Returns the path of lrbscope-measure: beside this program.
std::string measuring_program();

}  // namespace lrb::cli
