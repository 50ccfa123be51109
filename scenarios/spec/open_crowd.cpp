#include "scenarios/spec/crowd_spec.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::spec {
namespace {

constexpr std::string_view kEnding = ".crowd.json";

}  // namespace

std::vector<std::string> shipped_crowds() {
  return shipped_names(kEnding);
}

Crowd open_crowd(const std::string& name_or_path) {
  const NamedText crowd = open_named(name_or_path, kEnding, "crowd");
  return parse_crowd(crowd.text, crowd.file);
}

}  // namespace lrb::spec
