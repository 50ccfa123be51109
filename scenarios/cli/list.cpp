#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/cli/command.hpp"
#include "scenarios/generators/generators.hpp"
#include "scenarios/shipped.hpp"

namespace lrb::cli {
namespace {

struct ListOptions {
  bool json = false, generators = false;
};

nlohmann::ordered_json scenarios_json() {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ShippedScenario& s : shipped_scenarios())
    out.push_back({{"name", s.name}, {"purpose", s.purpose}});
  return out;
}

nlohmann::ordered_json generators_json() {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Generator& g : generators()) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const GeneratorParameter& p : g.parameters)
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

std::string as_text(const nlohmann::ordered_json& list) {
  std::ostringstream out;
  for (const auto& item : list) {
    const auto name = item["name"].get<std::string>();
    out << name << std::string(name.size() < 14 ? 14 - name.size() : 1, ' ')
        << item["purpose"].get<std::string>() << "\n";
    if (!item.contains("parameters")) continue;
    for (const auto& p : item["parameters"])
      out << "    " << p["name"].get<std::string>() << " = " << p["default"] << " (" << p["least"] << " to "
          << p["most"] << "): " << p["what"].get<std::string>() << "\n";
  }
  return out.str();
}

int run_list(const ListOptions& o) {
  const nlohmann::ordered_json list = o.generators ? generators_json() : scenarios_json();
  print(o.json ? list.dump() + "\n" : as_text(list));
  return kOk;
}

}  // namespace

Command add_list(CLI::App& root, const Globals&) {
  CLI::App* app =
      root.add_subcommand("list", "The shipped scenarios, or the generators and their parameters");
  const auto o = std::make_shared<ListOptions>();
  app->add_flag("--generators", o->generators, "The generators of bodies instead");
  app->add_flag("--json", o->json, "As JSON");
  return {app, [o] { return run_list(*o); }};
}

}  // namespace lrb::cli
