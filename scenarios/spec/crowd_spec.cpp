#include "scenarios/spec/crowd_spec.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/io/poses.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::spec {
namespace {

std::vector<CrowdKind> read_kinds(const io::JsonNode& node, const std::filesystem::path& folder,
                                  std::uint64_t seed) {
  std::vector<CrowdKind> kinds;
  std::uint32_t bodies = 0;
  for (const io::JsonNode& item : node.items(1)) {
    item.object({"name", "body", "count"});
    CrowdKind kind;
    kind.name = read_name(item.at("name"));
    for (const CrowdKind& other : kinds)
      if (other.name == kind.name)
        item.at("name").fail("other bodies have the name " + kind.name + "; rename one");
    kind.body = read_body(item.at("body"), folder, seed);
    if (const auto n = item.get("count"))
      kind.count = static_cast<std::uint32_t>(n->integer(1, kMaxCrowdBodies));
    bodies += kind.count;
    if (bodies > kMaxCrowdBodies) node.fail("expected at most 10000 bodies in total");
    kinds.push_back(std::move(kind));
  }
  return kinds;
}

/// Reads a number, or [least, most].
std::array<double, 2> read_range(const io::JsonNode& node) {
  if (!node.is_array()) {
    const double x = node.number(0, kFar);
    return {x, x};
  }
  const std::vector<double> x = node.numbers(2);
  if (!(0 <= x[0] && x[0] <= x[1] && x[1] <= kFar)) node.fail("expected 0 <= least <= most");
  return {x[0], x[1]};
}

/// Orders names by their letters and numbers: step_9 before step_10.
bool is_before(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    // Compare numbers of any length: without leading zeros, the longer one is larger.
    const auto number = [&](const std::string& text, std::size_t& at) {
      while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string x = number(a, i), y = number(b, j);
    if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

/// Reads the poses of all bodies at each step: from a folder with a pose file for each step, or from one pose
/// file with the steps one after the other.
std::vector<std::vector<Pose>> read_trajectories(const io::JsonNode& node,
                                                 const std::filesystem::path& folder, std::uint32_t bodies) {
  const std::filesystem::path path = folder / node.string();
  std::error_code error;
  std::vector<std::string> files = {path.string()};
  const bool by_step = std::filesystem::is_directory(path, error);
  if (by_step) {
    files.clear();
    for (const auto& entry : std::filesystem::directory_iterator(path))
      if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end(), is_before);
    if (files.empty()) node.fail("expected a folder with a pose file for each step, found no file");
  }
  std::vector<std::vector<Pose>> steps;
  for (const std::string& file : files) {
    const std::vector<Pose> poses = io::open_poses(file).poses;
    if (by_step ? poses.size() != bodies : poses.size() % bodies != 0)
      throw InputError(printable_name(file) + ": expected " +
                       (by_step ? "a pose for each of the " : "for each step, a pose for each of the ") +
                       std::to_string(bodies) + " bodies, found " + std::to_string(poses.size()) + " poses");
    for (std::size_t i = 0; i < poses.size(); i += bodies)
      steps.emplace_back(poses.begin() + static_cast<std::ptrdiff_t>(i),
                         poses.begin() + static_cast<std::ptrdiff_t>(i + bodies));
    if (steps.size() > kMaxSteps || steps.size() * bodies > kMaxCrowdPoses)
      node.fail("expected at most " + std::to_string(kMaxSteps) + " steps and " +
                std::to_string(kMaxCrowdPoses) + " poses");
  }
  return steps;
}

void read_motion(const io::JsonNode& node, const std::filesystem::path& folder, Crowd& c) {
  node.object({"steps", "speed", "spin", "poses"});
  if (const auto n = node.get("poses")) {
    for (const char* key : {"speed", "spin"})
      if (node.has(key)) node.fail_key(key, "the bodies have given poses; remove it");
    c.poses = read_trajectories(*n, folder, c.body_count());
    if (const auto steps = node.get("steps"))
      c.poses.resize(static_cast<std::size_t>(steps->integer(1, c.poses.size())));
    c.steps = static_cast<std::uint32_t>(c.poses.size());
    return;
  }
  c.steps = static_cast<std::uint32_t>(node.at("steps").integer(1, kMaxSteps));
  if (const auto n = node.get("speed")) c.speed = read_range(*n);
  if (const auto n = node.get("spin")) c.spin = read_range(*n);
}

Eigen::Vector3d read_room(const io::JsonNode& node) {
  Eigen::Vector3d room = node.vector();
  if (!(room.minCoeff() >= 0 && room.maxCoeff() <= kFar)) node.fail("expected three sizes of at least 0");
  return room;
}

/// Returns the keys of a crowd's query: those of a scenario's exact queries.
std::vector<std::string> crowd_query_keys() {
  std::vector<std::string> keys;
  for_each_field<CollideRequest>([&](const auto& field) { keys.emplace_back(field.name); });
  for (const char* key : {"max_time", "tolerance", "max_tests", "separation"}) std::erase(keys, key);
  keys.insert(keys.end(), {"distance", "clash", "near"});
  return keys;
}

}  // namespace

std::uint32_t Crowd::body_count() const {
  std::uint32_t n = 0;
  for (const CrowdKind& kind : kinds) n += kind.count;
  return n;
}

Crowd parse_crowd(const std::string& text, const std::string& file) {
  const io::JsonText json(text, file);
  const io::JsonNode root(json);
  root.object({"$schema", "name", "purpose", "seed", "room", "arrangement", "bodies", "motion", "query",
               "trace", "frames"});
  Crowd c;
  if (const auto n = root.get("$schema")) n->string();
  c.name = read_name(root.at("name"));
  c.purpose = root.at("purpose").string();
  if (const auto n = root.get("seed")) c.seed = n->integer(0, kAnySeed);
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  c.kinds = read_kinds(root.at("bodies"), folder, c.seed);
  read_motion(root.at("motion"), folder, c);
  if (const auto n = root.get("arrangement")) {
    if (!c.poses.empty()) root.fail_key("arrangement", "the bodies have given poses; remove it");
    c.arrangement = n->choice<Crowd::Arrangement>();
  }
  if (c.poses.empty() || root.has("room")) c.room = read_room(root.at("room"));
  if (const auto n = root.get("query")) {
    for (const char* key : {"tolerance", "max_tests", "separation"})
      if (n->has(key)) n->fail_key(key, "queries of a crowd are exact; remove it, or use a scenario");
    for (const char* key : {"manifold", "coherent"})
      if (n->has(key)) n->fail_key(key, "not supported for a crowd; remove it, or use a scenario");
    n->object(crowd_query_keys());
    c.request = read_query(*n, &c.more);
    if (!n->has("contacts")) c.request.contacts = false;  // they take most of the time of a step
  }
  for (const char* key : {"trace", "frames"})
    if (root.has(key))
      c.notes.push_back(printable_name(file) + ": " + key +
                        " has no effect: a crowd is not drawn; --pair draws two of its bodies");
  Fnv64 hash;
  hash.add_bytes(text.data(), text.size());
  for (const std::vector<Pose>& step : c.poses)
    for (const Pose& pose : step) {
      const std::array<double, 12> rows = io::rows_of(pose);
      hash.add_bytes(rows.data(), sizeof rows);
    }
  c.hash = hash.value();
  return c;
}

Crowd open_crowd(const std::string& name_or_path) {
  const NamedText crowd = open_named(name_or_path, kCrowdEnding, "crowd");
  return parse_crowd(crowd.text, crowd.file);
}

}  // namespace lrb::spec
