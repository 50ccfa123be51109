#include <algorithm>

#include "engine/core/error.hpp"
#include "scenarios/io/json/suggest.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::paper {
std::vector<std::string> shipped_experiments() {
  return spec::shipped_names(spec::kExperimentEnding);
}

std::string shipped_experiment(const std::string& name) {
  const std::vector<std::string> names = shipped_experiments();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("no experiment is called \"" + name + "\"" + io::suggestion(name, names));
  return spec::open_named(name, spec::kExperimentEnding, "experiment").text;
}

PaperExperiment open_experiment(const std::string& name_or_path) {
  const spec::NamedText experiment = spec::open_named(name_or_path, spec::kExperimentEnding, "experiment");
  return parse_experiment(experiment.text, experiment.file);
}

}  // namespace lrb::paper
