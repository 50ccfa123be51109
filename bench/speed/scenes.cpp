#include "bench/speed/scenes.hpp"

#include <algorithm>
#include <filesystem>

#include "bench/speed/series_style.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::bench {
namespace {

using nlohmann::ordered_json;

/// Returns the question that most points call their worst; the first of the class if none has an error.
std::uint64_t question_of(const DataSet& set, const std::vector<const Point*>& panel, PoseClass c) {
  std::map<std::uint64_t, std::size_t> votes;
  for (const Point* p : panel)
    if (p->error() > 0) ++votes[p->worst_question];
  std::uint64_t best = 0;
  while (best < set.questions.size() && set.questions[best].pose_class != c) ++best;
  std::size_t most = 0;
  for (const auto& [question, count] : votes)
    if (count > most) {
      best = question;
      most = count;
    }
  return best;
}

/// Returns the poses of B that a scene shows: that of the question, or some on its way, up to first contact
/// or its end.
std::vector<Pose> poses_of(const DataSet& set, const Question& q) {
  if (set.quantity != Quantity::first_contact) return {q.pose_b};
  const double last = std::min(1.0, q.number ? q.number->most : 1);
  std::vector<Pose> poses;
  for (const double share : {0.0, 0.5, 0.75, 0.9, 0.99, 1.0}) {
    Pose p = q.pose_b;
    p.t += q.from + share * last * (q.to - q.from);
    poses.push_back(p);
  }
  return poses;
}

std::string scenario_text(const DataSet& set, std::uint64_t k, const std::string& name) {
  const Question& q = set.questions[k];
  const ordered_json views = {{{"camera", "scene"}, {"title", "Whole, with wrappers"}},
                              {{"camera", "contact"}, {"draw", "body"}, {"title", "Contact, bodies alone"}}};
  ordered_json poses = ordered_json::array();
  for (const Pose& pose : poses_of(set, q)) poses.push_back(pose_json(pose));
  ordered_json value = {
      {"name", name},
      {"purpose", set.what + ": " + title(q.pose_class) + ", question " + std::to_string(k) + "."},
      {"bodies",
       {{"a", {{"file", "../" + set.bodies[q.a].file}, {"pose", pose_json(q.pose_a)}}},
        {"b", {{"file", "../" + set.bodies[q.b].file}}}}},
      {"motion", {{"kind", "poses"}, {"poses", poses}}},
      {"trace", {{"gzip", true}}},
      {"frames", {{"at", "step"}, {"size", {960, 540}}, {"views", views}}}};
  if (set.quantity == Quantity::pairs) value["expect"] = {{{"step", 0}, {"pairs", q.expected.size()}}};
  if (set.quantity == Quantity::depth) value["query"] = {{"clash", true}};
  if (set.quantity == Quantity::distance || set.quantity == Quantity::first_contact)
    value["query"] = {{"distance", true}};
  return value.dump(2) + "\n";
}

}  // namespace

std::map<SceneKey, std::string> write_scenes(const std::vector<DataSet>& sets,
                                             const std::vector<Point>& points, const std::string& folder,
                                             const run::ProgressReport& progress) {
  std::map<SceneKey, std::string> pages;
  std::uint64_t done = 0;
  for (const DataSet& set : sets)
    for (const PoseClass c : classes_of(set.quantity)) {
      progress("scenes", done++, sets.size() * classes_of(set.quantity).size());
      const std::uint64_t k = question_of(set, panel(points, set.name, c), c);
      if (k >= set.questions.size()) continue;
      const std::string name = set.name + "-" + std::string(name_of(c));
      const std::string file = folder + "/scenes/" + name + ".scenario.json";
      const std::string text = scenario_text(set, k, name), page = "scenes/" + name + "/index.html";
      pages[{set.name, c}] = page;
      namespace fs = std::filesystem;
      if (fs::exists(folder + "/" + page) && fs::exists(file) && io::read_text(file) == text) continue;
      io::write_text(file, text);
      run::run_scenario(spec::parse_scenario(text, file), folder + "/scenes/" + name, "lrbscope run " + file,
                        run::kSilent);
    }
  return pages;
}

}  // namespace lrb::bench
