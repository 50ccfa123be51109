#include "scenarios/io/json/pose_list.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/json/json_node.hpp"
#include "scenarios/io/number_text.hpp"
#include "scenarios/io/pose_file.hpp"

namespace lrb::io {
namespace {

bool ends_like(const std::string& path, std::string_view ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char x, char y) { return x == std::tolower(static_cast<unsigned char>(y)); });
}

/// Returns the numbers of a pose, which may stand in rows.
std::vector<double> numbers_of(const JsonNode& node) {
  constexpr double kMost = std::numeric_limits<double>::max();
  std::vector<double> out;
  for (const JsonNode& item : node.items(1)) {
    if (!item.is_array()) {
      out.push_back(item.number(-kMost, kMost));
      continue;
    }
    const std::vector<double> row = item.numbers(4);
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

Pose read_pose_matrix(const JsonNode& node) {
  const std::vector<double> x = numbers_of(node);
  if (x.size() != 12 && x.size() != 16)
    node.fail("expected a pose of 12 numbers (3x4, row by row) or 16 (4x4), found " +
              std::to_string(x.size()));
  constexpr std::array<double, 4> kLast = {0, 0, 0, 1};
  if (x.size() == 16 && !std::equal(kLast.begin(), kLast.end(), x.begin() + 12))
    node.fail("the last row of the 4x4 pose is not 0, 0, 0, 1");
  return pose_of(std::span<const double, 12>(x.data(), 12));
}

std::string row_text(const Pose& pose, std::string_view between, bool json) {
  std::string out;
  for (const double x : rows_of(pose)) {
    if (!out.empty()) out += between;
    out += exact_text(x);
    if (json && x == 0 && std::signbit(x)) out += ".0";  // "-0" would be an integer, and lose its sign
  }
  return out;
}

std::string pose_table(std::span<const Pose> poses) {
  std::string out;
  for (const std::string_view name : kPoseColumns) out.append(out.empty() ? "" : ",").append(name);
  for (const Pose& pose : poses) out += "\n" + row_text(pose, ",", false);
  return out + "\n";
}

std::string pose_json(std::span<const Pose> poses) {
  std::string out = "[";
  for (std::size_t i = 0; i < poses.size(); ++i)
    out += (i == 0 ? "\n  [" : ",\n  [") + row_text(poses[i], ", ", true) + "]";
  return out + "\n]\n";
}

}  // namespace

PoseList open_poses(const std::string& path) {
  const std::string name = printable_name(path);
  if (ends_like(path, ".json")) return parse_pose_json(read_text(path), name);
  PoseList out;
  std::vector<std::size_t> lines;
  out.poses = ends_like(path, ".csv") ? parse_pose_table(read_text(path), name, &lines)
                                      : parse_poses(read_text(path), name, &lines);
  for (const std::size_t line : lines) out.places.push_back(name + ":" + std::to_string(line));
  return out;
}

PoseList parse_pose_json(std::string text, const std::string& name) {
  const JsonText json(std::move(text), name);
  const JsonNode root(json);
  if (!root.is_array() && !root.has("poses"))
    root.fail("expected an array of poses, or an object with such an array as \"poses\"");
  PoseList out;
  for (const JsonNode& item : (root.is_array() ? root : root.at("poses")).items(1)) {
    out.poses.push_back(read_pose_matrix(item));
    out.places.push_back(json.where(item.pointer()));
  }
  return out;
}

void save_poses(const std::string& path, std::span<const Pose> poses) {
  std::string text;
  if (ends_like(path, ".json")) {
    text = pose_json(poses);
  } else if (ends_like(path, ".csv")) {
    text = pose_table(poses);
  } else {
    for (const Pose& pose : poses) text += row_text(pose, " ", false) + "\n";
  }
  write_text(path, text);
}

}  // namespace lrb::io
