#include "scenarios/pose_file.hpp"
#include "scenarios/scenario.hpp"
#include "scenarios/scenario_motion.hpp"
#include "tests/fuzz/feed.hpp"

namespace lrb::fuzz {

bool feed_poses(std::string_view bytes) {
  return accepted("p.txt", [&] {
    for (const Pose& pose : parse_poses(std::string(bytes), "p.txt"))
      if (!pose.r.allFinite() || !pose.t.allFinite()) throw std::logic_error("a pose is not finite");
  });
}

bool feed_scenario(std::string_view bytes) {
  return accepted("s.json", [&] {
    const Scenario s = parse_scenario(std::string(bytes), "s.json");
    if (s.name.empty() || s.name.find_first_of("/.\\") != std::string::npos)
      throw std::logic_error("the scenario's name could lead out of the output folder: " + s.name);
    if (s.show == Show::collision) static_cast<void>(poses_of(s.motion, s.bodies.at(1).pose));
  });
}

}  // namespace lrb::fuzz
