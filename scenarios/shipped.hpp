#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.hpp"

namespace lrb {

struct ShippedScenario {
  std::string name, purpose;
};

/// The scenarios that are compiled in, by name.
std::vector<ShippedScenario> shipped_scenarios();

/// A scenario by the name of a shipped one, or from a file. Throws InputError; for a word that is neither,
/// with the nearest name.
Scenario open_scenario(const std::string& name_or_path);

}  // namespace lrb
