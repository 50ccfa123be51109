#include "scenarios/crowd/crowd.hpp"
#include "scenarios/shipped.hpp"

namespace lrb {

Crowd open_crowd(const std::string& name_or_path) {
  const NamedText crowd = open_named(name_or_path, ".crowd.json", "crowd");
  return parse_crowd(crowd.text, crowd.file);
}

}  // namespace lrb
