#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// Returns the names NAME of the shipped files "NAME<ending>", in alphabetical order.
std::vector<std::string> shipped_names(std::string_view ending);

/// Returns the "purpose" that the shipped file "NAME<ending>" states.
std::string shipped_purpose(const std::string& name, std::string_view ending);

struct NamedText {
  std::string text, file;  ///< `file` is for messages
};

/// Returns the text of a shipped file "NAME<ending>", or of a file by its path. `what` is the kind of file,
/// for messages. Throws InputError; for a word that is neither, it suggests the closest shipped name.
NamedText open_named(const std::string& name_or_path, std::string_view ending, std::string_view what);

inline constexpr std::string_view kScenarioEnding = ".scenario.json", kCrowdEnding = ".crowd.json",
                                  kExperimentEnding = ".experiment.json";

/// Reads a shipped scenario by name, or a scenario from a file. Throws InputError.
Scenario open_scenario(const std::string& name_or_path);

}  // namespace lrb::spec
