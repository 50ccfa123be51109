#include <algorithm>

#include "engine/error.hpp"
#include "scenarios/json/suggest.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/shipped.hpp"

namespace lrb {
namespace {

constexpr std::string_view kEnding = ".experiment.json";

}  // namespace

std::vector<std::string> shipped_experiments() {
  return shipped_names(kEnding);
}

std::string shipped_experiment(const std::string& name) {
  const std::vector<std::string> names = shipped_experiments();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("no experiment is called \"" + name + "\"" + suggestion(name, names));
  return open_named(name, kEnding, "experiment").text;
}

PaperExperiment open_experiment(const std::string& name_or_path) {
  const NamedText experiment = open_named(name_or_path, kEnding, "experiment");
  return parse_experiment(experiment.text, experiment.file);
}

}  // namespace lrb
