#include "scenarios/spec/shipped.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/io/files.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/error.hpp>

namespace lrb::spec {
std::vector<std::string> shipped_names(std::string_view ending) {
  std::vector<std::string> names;
  for (const io::EmbeddedFile& file : io::embedded_files())
    if (file.name.ends_with(ending))
      names.emplace_back(file.name.substr(0, file.name.size() - ending.size()));
  std::sort(names.begin(), names.end());
  return names;
}

NamedText open_named(const std::string& name_or_path, std::string_view ending, std::string_view what) {
  const bool is_name = name_or_path.find_first_of("./\\") == std::string::npos;
  if (is_name) {
    const std::string shipped = name_or_path + std::string(ending);
    for (const io::EmbeddedFile& file : io::embedded_files())
      if (file.name == shipped) return {std::string(file.text), shipped};
    std::error_code error;
    if (!std::filesystem::exists(name_or_path, error))
      throw InputError(name_or_path + ": neither a shipped " + std::string(what) + " nor a file" +
                       io::suggestion(name_or_path, shipped_names(ending)));
  }
  return {io::read_small_text(name_or_path), name_or_path};
}

std::string shipped_purpose(const std::string& name, std::string_view ending) {
  const NamedText named = open_named(name, ending, "file");
  return io::JsonNode(io::JsonText(named.text, named.file)).at("purpose").string();
}

Scenario open_scenario(const std::string& name_or_path) {
  const NamedText scenario = open_named(name_or_path, kScenarioEnding, "scenario");
  return parse_scenario(scenario.text, scenario.file);
}

}  // namespace lrb::spec
