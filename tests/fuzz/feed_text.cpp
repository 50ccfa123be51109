#include "scenarios/io/poses.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/spec/crowd_spec.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/fuzz/feed.hpp"

namespace lrb::fuzz {
namespace {

/// Names become names of files and folders.
void judge_name(const std::string& name) {
  if (name.empty() || name.find_first_of("/.\\") != std::string::npos)
    throw std::logic_error("a name could lead out of the output folder: " + name);
}

}  // namespace

bool feed_poses(std::string_view bytes) {
  const auto judge = [](const std::vector<Pose>& poses) {
    for (const Pose& pose : poses)
      if (!pose.r.allFinite() || !pose.t.allFinite()) throw std::logic_error("a pose is not finite");
  };
  const std::string text(bytes);
  const bool lines = accepted("p.txt", [&] { judge(io::parse_poses(text, "p.txt")); });
  const bool table = accepted("p.csv", [&] { judge(io::parse_pose_table(text, "p.csv")); });
  const bool json = accepted("p.json", [&] { judge(io::parse_pose_json(text, "p.json").poses); });
  return lines || table || json;
}

bool feed_scenario(std::string_view bytes) {
  return accepted("s.json", [&] {
    const spec::Scenario s = spec::parse_scenario(std::string(bytes), "s.json");
    judge_name(s.name);
    if (s.show == spec::Show::collision) static_cast<void>(spec::poses_of(s.motion, s.bodies.at(1).pose));
  });
}

bool feed_crowd(std::string_view bytes) {
  return accepted("c.json", [&] {
    const spec::Crowd c = spec::parse_crowd(std::string(bytes), "c.json");
    judge_name(c.name);
    for (const spec::CrowdKind& kind : c.kinds) judge_name(kind.name);
    if (!c.room.allFinite() || c.body_count() == 0) throw std::logic_error("a crowd that cannot be");
  });
}

bool feed_experiment(std::string_view bytes) {
  return accepted("e.json", [&] {
    const paper::PaperExperiment e = paper::parse_experiment(std::string(bytes), "e.json");
    judge_name(e.name);
    for (const paper::PaperExperiment::Object& object : e.objects) judge_name(object.name);
    if (e.collides() && e.objects.size() < 2) throw std::logic_error("an experiment that cannot be");
  });
}

}  // namespace lrb::fuzz
