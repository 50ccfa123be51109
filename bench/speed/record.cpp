#include "bench/speed/record.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "bench/workers/worker_json.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/error.hpp>

template <>
struct lrb::io::JsonOf<lrb::bench::Errors> {
  static nlohmann::ordered_json write(const bench::Errors& errors) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (std::size_t m = 0; m < bench::kMetrics; ++m)
      if (errors[m]) out[bench::kMetricInfos[m].name] = *errors[m];
    return out;
  }
  static bench::Errors read(const nlohmann::json& value) {
    bench::Errors out;
    for (std::size_t m = 0; m < bench::kMetrics; ++m)
      if (const auto it = value.find(bench::kMetricInfos[m].name); it != value.end())
        out[m] = it->get<double>();
    return out;
  }
};

namespace lrb {

template <>
inline constexpr auto kFields<bench::Reply> =
    std::tuple{field("contact", &bench::Reply::contact),
               field("count", &bench::Reply::count),
               field("missed", &bench::Reply::missed),
               field("extra", &bench::Reply::extra),
               field("cold_us", &bench::Reply::cold_us),
               field("hot_us", &bench::Reply::hot_us),
               field("face_tests", &bench::Reply::face_tests),
               field("error_bound", &bench::Reply::error_bound, Kept::if_set),
               field("lower", &bench::Reply::lower, Kept::if_set),
               field("upper", &bench::Reply::upper, Kept::if_set)};

template <>
inline constexpr auto kFields<bench::Record> =
    std::tuple{field("set", &bench::Record::set),
               field("method", &bench::Record::method),
               field("setting", &bench::Record::setting, Kept::if_set),
               field("question", &bench::Record::question),
               field("round", &bench::Record::round, Kept::if_set),
               field("class", &bench::Record::pose_class),
               field("outcome", &bench::Record::outcome),
               field("message", &bench::Record::message, Kept::if_set),
               field("all", &bench::Record::all, Kept::if_set),
               field("first", &bench::Record::first, Kept::if_set),
               field("build_s", &bench::Record::build_seconds, Kept::if_set),
               field("bytes", &bench::Record::bytes, Kept::if_set),
               field("errors", &bench::Record::errors, Kept::if_set)};

static_assert(covers_all_fields<bench::Reply>);
static_assert(covers_all_fields<bench::Record>);

}  // namespace lrb

namespace lrb::bench {

using nlohmann::json;

nlohmann::ordered_json to_json(const Record& r) {
  return io::record_to_json(r);
}

Record record_from(const json& value) {
  try {
    return io::record_from_json<Record>(value);
  } catch (const InputError& e) {
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
