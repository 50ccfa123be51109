#include "scenarios/bench/data_set.hpp"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/bench/record.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/workers/pairs_json.hpp"

namespace lrb::bench {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Pose pose_from(const json& value) {
  Pose p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p.r(i, j) = value.at(static_cast<std::size_t>(4 * i + j)).get<double>();
    p.t[i] = value.at(static_cast<std::size_t>(4 * i + 3)).get<double>();
  }
  return p;
}

PoseClass pose_class_from(const std::string& word) {
  if (const auto c = from_name<PoseClass>(word)) return *c;
  throw InputError("'" + word + "' is not a class of poses");
}

}  // namespace

nlohmann::ordered_json pose_json(const Pose& p) {
  ordered_json out = ordered_json::array();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.push_back(p.r(i, j));
    out.push_back(p.t[i]);
  }
  return out;
}

const char* title(PoseClass c) {
  static constexpr const char* kTitles[] = {"0.5 % apart", "shallow, 1 %", "deep, 10 %", "identical pose",
                                            "one body small"};
  return kTitles[static_cast<std::size_t>(c)];
}

std::string write_data_set(const DataSet& set, const std::string& folder) {
  ordered_json bodies = ordered_json::array(), questions = ordered_json::array();
  for (const BodyFile& b : set.bodies)
    bodies.push_back({{"file", b.file}, {"faces", b.faces}, {"build_s", b.build_seconds}});
  for (const Question& q : set.questions)
    questions.push_back({{"class", name_of(q.pose_class)},
                         {"a", q.a},
                         {"b", q.b},
                         {"pose_a", pose_json(q.pose_a)},
                         {"pose_b", pose_json(q.pose_b)},
                         {"expected", workers::PairsJson::write(q.expected)}});
  const ordered_json value = {{"name", set.name},
                              {"what", set.what},
                              {"diagonal", set.diagonal},
                              {"bodies", bodies},
                              {"questions", questions}};
  const std::string path = folder + "/" + set.name + ".set.json";
  io::write_text(path, value.dump() + "\n");
  return path;
}

DataSet read_data_set(const std::string& path) {
  try {
    const json value = json::parse(io::read_text(path));
    DataSet set;
    set.folder = std::filesystem::path(path).parent_path().string();
    value.at("name").get_to(set.name);
    value.at("what").get_to(set.what);
    value.at("diagonal").get_to(set.diagonal);
    for (const json& b : value.at("bodies"))
      set.bodies.push_back({b.at("file").get<std::string>(), b.at("faces").get<std::uint32_t>(),
                            b.at("build_s").get<double>()});
    for (const json& q : value.at("questions"))
      set.questions.push_back({pose_class_from(q.at("class").get<std::string>()),
                               q.at("a").get<std::size_t>(), q.at("b").get<std::size_t>(),
                               pose_from(q.at("pose_a")), pose_from(q.at("pose_b")),
                               workers::PairsJson::read(q.at("expected"))});
    return set;
  } catch (const json::exception& e) {
    throw InputError(printable_name(path) + ": not a data set of lrbscope bench or chart (" + e.what() +
                     "); remove it to have it made again");
  }
}

}  // namespace lrb::bench
