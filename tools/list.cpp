#include <algorithm>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"

namespace lrb::tools {
namespace {

struct ListOptions {
  bool json = false, generators = false;
};

/// A kind of shipped file, its file extension, and the command that uses it.
struct ShippedKind {
  std::string_view name, ending, use;
};
constexpr ShippedKind kShipped[] = {{"scenario", spec::kScenarioEnding, "lrbscope run"},
                                    {"crowd", spec::kCrowdEnding, "lrbscope crowd"},
                                    {"experiment", spec::kExperimentEnding, "lrbscope paper --experiment"}};

nlohmann::ordered_json shipped_json() {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ShippedKind& kind : kShipped)
    for (const std::string& name : spec::shipped_names(kind.ending))
      out.push_back(
          {{"kind", kind.name}, {"name", name}, {"purpose", spec::shipped_purpose(name, kind.ending)}});
  return out;
}

nlohmann::ordered_json generators_json() {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const generators::Generator& g : generators::generators()) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const generators::GeneratorParameter& p : g.parameters)
      parameters.push_back({{"name", p.name},
                            {"default", p.fallback},
                            {"least", p.least},
                            {"most", p.most},
                            {"whole", p.whole},
                            {"what", p.what}});
    out.push_back(
        {{"name", g.name}, {"dim", g.dim}, {"purpose", g.purpose}, {"parameters", std::move(parameters)}});
  }
  return out;
}

std::string list_text(const nlohmann::ordered_json& list) {
  std::ostringstream out;
  std::size_t width = 0;
  for (const auto& item : list) width = std::max(width, item["name"].get<std::string>().size() + 2);
  std::string last;
  for (const auto& item : list) {
    const auto name = item["name"].get<std::string>(), kind = item.value("kind", "");
    if (kind != last) {
      for (const ShippedKind& shipped : kShipped)
        if (shipped.name == kind)
          out << (last.empty() ? "" : "\n") << kind << "s, for " << shipped.use << "\n";
      last = kind;
    }
    out << (kind.empty() ? "" : "  ") << name << std::string(width - name.size(), ' ')
        << item["purpose"].get<std::string>() << "\n";
    if (!item.contains("parameters")) continue;
    for (const auto& p : item["parameters"])
      out << "    " << p["name"].get<std::string>() << " = " << p["default"] << " (" << p["least"] << " to "
          << p["most"] << "): " << p["what"].get<std::string>() << "\n";
  }
  return out.str();
}

int run_list(const ListOptions& o) {
  const nlohmann::ordered_json list = o.generators ? generators_json() : shipped_json();
  print(o.json ? list.dump() + "\n" : list_text(list));
  return kOk;
}

}  // namespace

Command add_list(App& root, const Globals&) {
  App* app = root.add_subcommand(
      "list",
      "List the shipped scenarios, crowds and experiments, or the body generators with their parameters");
  const auto o = std::make_shared<ListOptions>();
  app->add_flag("--generators", o->generators, "List the body generators with their parameters");
  app->add_flag("--json", o->json, "Print JSON");
  return {app, [o] { return run_list(*o); }};
}

}  // namespace lrb::tools
