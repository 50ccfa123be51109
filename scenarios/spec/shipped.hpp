#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// The shipped files "NAME<ending>", by NAME, in the order of the alphabet.
std::vector<std::string> shipped_names(std::string_view ending);

/// The "purpose" that the shipped file "NAME<ending>" states.
std::string shipped_purpose(const std::string& name, std::string_view ending);

struct NamedText {
  std::string text, file;  ///< `file` is for messages
};

/// The text of a shipped file "NAME<ending>", or of a file by its path. `what` such a file holds, for messages.
/// Throws InputError; for a word that is neither, with the nearest name.
NamedText open_named(const std::string& name_or_path, std::string_view ending, std::string_view what);

inline constexpr std::string_view kScenarioEnding = ".scenario.json", kCrowdEnding = ".crowd.json",
                                  kExperimentEnding = ".experiment.json";

/// A scenario by the name of a shipped one, or from a file. Throws InputError.
Scenario open_scenario(const std::string& name_or_path);

}  // namespace lrb::spec
