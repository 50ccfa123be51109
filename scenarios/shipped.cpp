#include "scenarios/shipped.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/error.hpp"
#include "scenarios/embedded.hpp"
#include "scenarios/files.hpp"
#include "scenarios/json/suggest.hpp"

namespace lrb {
namespace {

constexpr std::string_view kEnding = ".scenario.json";

}  // namespace

std::vector<ShippedScenario> shipped_scenarios() {
  std::vector<ShippedScenario> out;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(kEnding)) continue;
    const Scenario s = parse_scenario(std::string(file.text), std::string(file.name));
    out.push_back({s.name, s.purpose});
  }
  std::sort(out.begin(), out.end(), [](const auto& x, const auto& y) { return x.name < y.name; });
  return out;
}

Scenario open_scenario(const std::string& name_or_path) {
  std::error_code error;
  const bool is_name = name_or_path.find_first_of("./\\") == std::string::npos;
  if (is_name) {
    for (const EmbeddedFile& file : embedded_files())
      if (file.name == name_or_path + std::string(kEnding))
        return parse_scenario(std::string(file.text), std::string(file.name));
  }
  if (is_name && !std::filesystem::exists(name_or_path, error)) {
    std::vector<std::string> names;
    for (const ShippedScenario& s : shipped_scenarios()) names.push_back(s.name);
    throw InputError(name_or_path + ": neither a shipped scenario nor a file" +
                     suggestion(name_or_path, names));
  }
  return parse_scenario(read_text(name_or_path), name_or_path);
}

}  // namespace lrb
