#include "scenarios/spec/crowd_spec.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::spec {
std::vector<std::string> shipped_crowds() {
  return shipped_names(kCrowdEnding);
}

Crowd open_crowd(const std::string& name_or_path) {
  const NamedText crowd = open_named(name_or_path, kCrowdEnding, "crowd");
  return parse_crowd(crowd.text, crowd.file);
}

}  // namespace lrb::spec
