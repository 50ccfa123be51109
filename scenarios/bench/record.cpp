#include "scenarios/bench/record.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "engine/core/error.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::bench {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json reply_json(const Reply& r) {
  ordered_json out = {{"contact", r.contact},      {"count", r.count},     {"missed", r.missed},
                      {"extra", r.extra},          {"cold_us", r.cold_us}, {"hot_us", r.hot_us},
                      {"face_tests", r.face_tests}};
  if (r.error_bound) out["error_bound"] = *r.error_bound;
  if (!r.pairs.empty()) out["pairs"] = flat(r.pairs);
  for (const Eigen::Vector3d& p : r.points) out["points"].push_back({p.x(), p.y(), p.z()});
  return out;
}

Reply reply_from(const json& value) {
  Reply r;
  value.at("contact").get_to(r.contact);
  value.at("count").get_to(r.count);
  value.at("missed").get_to(r.missed);
  value.at("extra").get_to(r.extra);
  value.at("cold_us").get_to(r.cold_us);
  value.at("hot_us").get_to(r.hot_us);
  value.at("face_tests").get_to(r.face_tests);
  if (value.contains("error_bound")) r.error_bound = value.at("error_bound").get<double>();
  if (value.contains("pairs")) r.pairs = pairs_from(value.at("pairs"));
  if (value.contains("points"))
    for (const json& p : value.at("points"))
      r.points.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>());
  return r;
}

template <class T>
T value_of(const std::string& word, const char* what) {
  if (const auto value = from_name<T>(word)) return *value;
  throw InputError("'" + word + "' is no " + what);
}

}  // namespace

ordered_json flat(const std::vector<SimplexPair>& pairs) {
  ordered_json out = ordered_json::array();
  for (const SimplexPair& p : pairs) {
    out.push_back(p.a.value());
    out.push_back(p.b.value());
  }
  return out;
}

std::vector<SimplexPair> pairs_from(const json& flat) {
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2)
    out.push_back({SimplexId(flat[i].get<std::uint32_t>()), SimplexId(flat[i + 1].get<std::uint32_t>())});
  return out;
}

ordered_json to_json(const Record& r) {
  ordered_json out = {{"set", r.set}, {"method", r.method}};
  if (r.setting) out["setting"] = *r.setting;
  out["question"] = r.question;
  out["class"] = name_of(r.pose_class);
  out["outcome"] = name_of(r.outcome);
  if (!r.message.empty()) out["message"] = r.message;
  if (r.outcome != Outcome::answered) return out;
  out["all"] = reply_json(r.all);
  out["first"] = reply_json(r.first);
  out["build_s"] = r.build_seconds;
  out["bytes"] = r.bytes;
  return out;
}

Record record_from(const json& value) {
  try {
    Record r;
    value.at("set").get_to(r.set);
    value.at("method").get_to(r.method);
    if (value.contains("setting")) r.setting = value.at("setting").get<double>();
    value.at("question").get_to(r.question);
    r.pose_class = value_of<PoseClass>(value.at("class").get<std::string>(), "class of poses");
    r.outcome = value_of<Outcome>(value.at("outcome").get<std::string>(), "outcome");
    r.message = value.value("message", "");
    if (r.outcome != Outcome::answered) return r;
    r.all = reply_from(value.at("all"));
    r.first = reply_from(value.at("first"));
    value.at("build_s").get_to(r.build_seconds);
    value.at("bytes").get_to(r.bytes);
    return r;
  } catch (const json::exception& e) {
    throw InputError(std::string("not a record of lrbscope bench or chart: ") + e.what());
  }
}

std::vector<Record> read_records(const std::string& path) {
  std::vector<Record> records;
  if (!std::filesystem::exists(path)) return records;
  std::istringstream in(io::read_text(path));
  for (std::string line; std::getline(in, line);) {
    const json value = json::parse(line, nullptr, false);
    if (!value.is_discarded()) records.push_back(record_from(value));
  }
  return records;
}

std::string name_of(const std::string& method, std::optional<double> setting) {
  if (!setting) return method;
  char text[32];
  std::snprintf(text, sizeof text, " %g", *setting);
  return method + text;
}

std::string name_of(const Record& r) {
  return name_of(r.method, r.setting);
}

}  // namespace lrb::bench
