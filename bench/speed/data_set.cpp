#include "bench/speed/data_set.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "bench/workers/worker_json.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

template <>
struct lrb::io::JsonOf<lrb::speed::Errors> {
  static nlohmann::ordered_json write(const speed::Errors& errors) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (std::size_t m = 0; m < speed::kMetrics; ++m)
      if (errors[m]) out[speed::kMetricInfos[m].name] = *errors[m];
    return out;
  }
  static speed::Errors read(const nlohmann::json& value) {
    speed::Errors out;
    for (std::size_t m = 0; m < speed::kMetrics; ++m)
      if (const auto it = value.find(speed::kMetricInfos[m].name); it != value.end())
        out[m] = it->get<double>();
    return out;
  }
};

namespace lrb {

template <>
inline constexpr auto kFields<speed::Reply> =
    std::tuple{field("contact", &speed::Reply::contact),
               field("count", &speed::Reply::count),
               field("missed", &speed::Reply::missed),
               field("extra", &speed::Reply::extra),
               field("cold_us", &speed::Reply::cold_us),
               field("hot_us", &speed::Reply::hot_us),
               field("face_tests", &speed::Reply::face_tests),
               field("error_bound", &speed::Reply::error_bound, Kept::if_set),
               field("lower", &speed::Reply::lower, Kept::if_set),
               field("upper", &speed::Reply::upper, Kept::if_set)};

template <>
inline constexpr auto kFields<speed::Record> =
    std::tuple{field("set", &speed::Record::set),
               field("method", &speed::Record::method),
               field("setting", &speed::Record::setting, Kept::if_set),
               field("question", &speed::Record::question),
               field("round", &speed::Record::round, Kept::if_set),
               field("class", &speed::Record::pose_class),
               field("outcome", &speed::Record::outcome),
               field("message", &speed::Record::message, Kept::if_set),
               field("all", &speed::Record::all, Kept::if_set),
               field("first", &speed::Record::first, Kept::if_set),
               field("build_s", &speed::Record::build_seconds, Kept::if_set),
               field("bytes", &speed::Record::bytes, Kept::if_set),
               field("errors", &speed::Record::errors, Kept::if_set)};

static_assert(covers_all_fields<speed::Reply>);
static_assert(covers_all_fields<speed::Record>);

}  // namespace lrb

namespace lrb::speed {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Pose pose_from(const json& value) {
  return io::pose_of(value.get<std::array<double, 12>>());
}

ordered_json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3d vector_from(const json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

ordered_json question_json(const Question& q, Quantity quantity) {
  ordered_json out = {{"class", name_of(q.pose_class)},
                      {"a", q.a},
                      {"b", q.b},
                      {"pose_a", io::rows_of(q.pose_a)},
                      {"pose_b", io::rows_of(q.pose_b)}};
  if (methods::is_list(quantity)) out["expected"] = workers::PairsJson::write(q.expected);
  if (quantity == Quantity::first_contact) {
    out["from"] = vector_json(q.from);
    out["to"] = vector_json(q.to);
  }
  if (q.number) out["number"] = {q.number->least, q.number->most};
  return out;
}

Question question_from(const json& value, Quantity quantity) {
  Question q;
  q.pose_class = io::JsonOf<PoseClass>::read(value.at("class"));
  value.at("a").get_to(q.a);
  value.at("b").get_to(q.b);
  q.pose_a = pose_from(value.at("pose_a"));
  q.pose_b = pose_from(value.at("pose_b"));
  if (methods::is_list(quantity)) q.expected = workers::PairsJson::read(value.at("expected"));
  if (quantity == Quantity::first_contact) {
    q.from = vector_from(value.at("from"));
    q.to = vector_from(value.at("to"));
  }
  if (value.contains("number"))
    q.number = {value.at("number").at(0).get<double>(), value.at("number").at(1).get<double>()};
  return q;
}

}  // namespace

std::span<const PoseClass> classes_of(Quantity quantity) {
  static const std::vector<PoseClass> kAll = [] {
    std::vector<PoseClass> out;
    for (const auto& entry : kEnumNames<PoseClass>) out.push_back(entry.value);
    return out;
  }();
  const auto from_to = [](PoseClass first, PoseClass last) {
    const auto begin = static_cast<std::size_t>(first);
    return std::span(kAll).subspan(begin, static_cast<std::size_t>(last) - begin + 1);
  };
  if (quantity == Quantity::distance) return from_to(PoseClass::gap_1000th, PoseClass::gap_whole);
  if (quantity == Quantity::first_contact) return from_to(PoseClass::into, PoseClass::past);
  if (quantity == Quantity::depth) return from_to(PoseClass::shallow, PoseClass::deep);
  if (quantity == Quantity::near_pairs) return from_to(PoseClass::near_1000th, PoseClass::near_20th);
  return from_to(PoseClass::apart, PoseClass::small);
}

bool is_complete(const DataSet& set) {
  return methods::is_list(set.quantity) ||
         std::all_of(set.questions.begin(), set.questions.end(), [](const Question& q) { return q.number; });
}

std::string write_data_set(const DataSet& set, const std::string& folder) {
  ordered_json bodies = ordered_json::array(), questions = ordered_json::array();
  for (const BodyFile& b : set.bodies)
    bodies.push_back({{"file", b.file}, {"faces", b.faces}, {"build_s", b.build_seconds}});
  for (const Question& q : set.questions) questions.push_back(question_json(q, set.quantity));
  ordered_json value = {{"name", set.name}, {"what", set.what}};
  if (set.quantity != Quantity::pairs) value["quantity"] = name_of(set.quantity);
  value["diagonal"] = set.diagonal;
  value["bodies"] = bodies;
  value["questions"] = questions;
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
    if (value.contains("quantity")) set.quantity = io::JsonOf<Quantity>::read(value.at("quantity"));
    for (const json& q : value.at("questions")) set.questions.push_back(question_from(q, set.quantity));
    return set;
  } catch (const json::exception& e) {
    throw InputError(printable_name(path) + ": not a data set of lrbscope bench or chart (" +
                     io::plain_reason(e.what()) + "); remove it to create it again");
  }
}

void find_numbers(DataSet& set) {
  constexpr std::chrono::seconds kLimit(120);  // per query; some depths take seconds
  const std::string file = write_data_set(set, set.folder);
  const auto all = workers::find_methods(set.quantity);
  const auto ours = std::find_if(all.begin(), all.end(), [](const workers::WorkerMethod& m) {
    return m.info.role == methods::Role::ours;
  });
  const auto complain = [&](std::uint64_t k, const std::string& why) {
    throw EnvironmentError(set.what + ", question " + std::to_string(k) + ": " + why);
  };
  workers::Worker::Task task;
  task.question = [&](std::uint64_t k) {
    json question = {{"set", file}, {"question", k}};
    if (!ours->info.settings.empty()) question["setting"] = ours->info.settings.back();
    return question.dump();
  };
  task.end = set.questions.size();
  task.limit = kLimit;
  task.on_line = [&](std::uint64_t k, const std::string& line) {
    const Record r = record_from(json::parse(line));
    if (r.outcome == Outcome::rejected)
      throw InputError(set.what + ", question " + std::to_string(k) + ": its " +
                       std::string(name_of(set.quantity)) + " is unknown (" + r.message +
                       "); leave these bodies out, or use another --seed");
    if (r.outcome != Outcome::answered) complain(k, r.message);
    set.questions[k].number = {r.all.lower.value(), r.all.upper.value()};
  };
  task.on_failure = [&](std::uint64_t k, const workers::WorkerFailure& failure) {
    complain(k, failure.message);
  };
  workers::Worker({ours->program, "--method", ours->info.name}).run(std::move(task));
}

// Records.

Record blank_record(const DataSet& set, std::uint64_t question, const std::string& method,
                    std::optional<double> setting) {
  if (question >= set.questions.size())
    throw InputError("question " + std::to_string(question) + ": the data set has only " +
                     std::to_string(set.questions.size()));
  Record r;
  r.set = set.name;
  r.method = method;
  r.setting = setting;
  r.question = question;
  r.pose_class = set.questions[question].pose_class;
  return r;
}

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

}  // namespace lrb::speed
