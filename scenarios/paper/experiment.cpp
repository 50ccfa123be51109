#include "scenarios/paper/experiment.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/record/recorded_run.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/error.hpp>

namespace lrb::paper {
namespace {

PaperProtocol read_protocol(const io::JsonNode& node) {
  node.object({"collisions", "steps_after", "step", "seed", "seeds"});
  PaperProtocol p;
  if (const auto n = node.get("collisions"))
    p.collisions = static_cast<std::uint32_t>(n->integer(1, kMaxCollisions));
  if (const auto n = node.get("steps_after"))
    p.steps_after = static_cast<std::uint32_t>(n->integer(0, kMaxStepsAfter));
  if (const auto n = node.get("step")) p.step = n->number(kMinStep, kMaxStep);
  if (const auto n = node.get("seed")) p.seed = n->integer(0, spec::kAnySeed);
  if (const auto n = node.get("seeds")) p.seeds = static_cast<std::uint32_t>(n->integer(1, kMaxSeeds));
  return p;
}

std::vector<PaperPart> read_report(const io::JsonNode& node) {
  std::vector<PaperPart> parts;
  for (const io::JsonNode& item : node.items(1)) {
    const auto part = item.choice<PaperPart>();
    if (std::find(parts.begin(), parts.end(), part) != parts.end()) item.fail("occurs twice; remove one");
    parts.push_back(part);
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// Reads a name that is safe in records, in charts' data blocks and in file names.
std::string read_object_name(const io::JsonNode& node) {
  const std::string name = spec::read_name(node);
  if (name.find('-') != std::string::npos) node.fail("expected letters, digits and _ only");
  return name;
}

std::vector<PaperExperiment::Object> read_objects(const io::JsonNode& node,
                                                  const std::filesystem::path& folder) {
  constexpr std::size_t kMaxObjects = 100;
  std::vector<PaperExperiment::Object> objects;
  for (const io::JsonNode& item : node.items(1)) {
    item.object({"name", "body"});
    PaperExperiment::Object o;
    o.name = read_object_name(item.at("name"));
    for (const auto& other : objects)
      if (other.name == o.name)
        item.at("name").fail("another object has the name " + o.name + "; rename one");
    const io::JsonNode body = item.at("body");
    o.body = spec::read_body(body, folder, 1);
    if (body.has("pose")) body.fail_key("pose", "the protocol places the bodies; remove it");
    objects.push_back(std::move(o));
  }
  if (objects.size() > kMaxObjects) node.fail("expected at most 100 objects");
  return objects;
}

/// Returns the object of the close-up: the named one, or the last.
std::string read_close_up(const io::JsonNode& root, const std::vector<PaperExperiment::Object>& objects) {
  const auto n = root.get("close_up");
  if (!n) return objects.back().name;
  std::vector<std::pair<std::string, std::string>> known;
  for (std::size_t i = 1; i < objects.size(); ++i) known.emplace_back(objects[i].name, objects[i].name);
  return n->choice(known);
}

}  // namespace

bool PaperExperiment::reports(PaperPart part) const {
  return std::find(report.begin(), report.end(), part) != report.end();
}

bool PaperExperiment::collides() const {
  return std::any_of(report.begin(), report.end(), [](PaperPart p) { return p != PaperPart::table1; });
}

PaperExperiment parse_experiment(const std::string& text, const std::string& file) {
  const io::JsonText json(text, file);
  const io::JsonNode root(json);
  root.object({"$schema", "name", "purpose", "report", "protocol", "close_up", "objects"});
  PaperExperiment e;
  if (const auto n = root.get("$schema")) n->string();
  e.name = spec::read_name(root.at("name"));
  e.purpose = root.at("purpose").string();
  if (const auto n = root.get("report"))
    e.report = read_report(*n);
  else
    for (const EnumName<PaperPart>& part : kEnumNames<PaperPart>) e.report.push_back(part.value);
  if (const auto n = root.get("protocol")) e.protocol = read_protocol(*n);
  e.objects = read_objects(root.at("objects"), std::filesystem::path(file).parent_path());
  e.close_up = read_close_up(root, e.objects);
  if (e.collides() && e.objects.size() < 2)
    root.at("objects").fail(
        "expected a second object to collide with the first, or \"report\": [\"table1\"]");
  return e;
}

std::vector<PaperObject> make_objects(const PaperExperiment& experiment, std::vector<std::string>& notes) {
  std::vector<PaperObject> objects;
  for (const PaperExperiment::Object& o : experiment.objects) {
    bodies::LoadedBody body = record::make_body(o.body);
    notes.insert(notes.end(), body.notes.begin(), body.notes.end());
    if (body.rep.dim() != 3)
      throw InputError("experiment " + experiment.name + ": object " + o.name +
                       ": expected a 3D body, found a 2D body");
    const double by = objects.empty() ? 1 : diagonal(objects[0].rep) / diagonal(body.rep);
    objects.push_back({o.name, by == 1 ? std::move(body.rep) : scaled(body.rep, by)});
  }
  return objects;
}

std::vector<std::string> shipped_experiments() {
  return spec::shipped_names(spec::kExperimentEnding);
}

std::string shipped_experiment(const std::string& name) {
  const std::vector<std::string> names = shipped_experiments();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("unknown experiment \"" + name + "\"" + io::suggestion(name, names));
  return spec::open_named(name, spec::kExperimentEnding, "experiment").text;
}

PaperExperiment open_experiment(const std::string& name_or_path) {
  const spec::NamedText experiment = spec::open_named(name_or_path, spec::kExperimentEnding, "experiment");
  return parse_experiment(experiment.text, experiment.file);
}

}  // namespace lrb::paper
