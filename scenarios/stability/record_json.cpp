#include "scenarios/stability/record_json.hpp"

#include <sstream>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::stability {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Outcome outcome_from(const std::string& word) {
  if (const auto outcome = from_name<Outcome>(word)) return *outcome;
  throw InputError("outcome '" + word + "': use " + all_names<Outcome>());
}

}  // namespace

ordered_json to_json(const Record& r) {
  return {{"family", r.family},
          {"method", r.method},
          {"dial", r.dial},
          {"case", r.case_index},
          {"seed", r.seed},
          {"outcome", name_of(r.outcome)},
          {"expected", r.expected},
          {"missed", r.missed},
          {"extra", r.extra},
          {"relation", r.relation},
          {"expected_relation", r.expected_relation},
          {"us", r.microseconds},
          {"message", r.message}};
}

Record record_from(const json& value) {
  try {
    Record r;
    value.at("family").get_to(r.family);
    value.at("method").get_to(r.method);
    value.at("dial").get_to(r.dial);
    value.at("case").get_to(r.case_index);
    value.at("seed").get_to(r.seed);
    r.outcome = outcome_from(value.at("outcome").get<std::string>());
    value.at("expected").get_to(r.expected);
    value.at("missed").get_to(r.missed);
    value.at("extra").get_to(r.extra);
    value.at("relation").get_to(r.relation);
    value.at("expected_relation").get_to(r.expected_relation);
    value.at("us").get_to(r.microseconds);
    value.at("message").get_to(r.message);
    if (r.dial < 0 || r.dial >= kDialSettings)
      throw InputError("dial " + std::to_string(r.dial) + ": use 0 to " + std::to_string(kDialSettings - 1));
    return r;
  } catch (const json::exception& e) {
    throw InputError(std::string("not a record of lrbscope stability: ") + e.what());
  }
}

std::string to_lines(const std::vector<Record>& records) {
  std::string out;
  for (const Record& r : records)
    out += to_json(r).dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  return out;
}

std::vector<Record> read_records(const std::string& path) {
  std::istringstream in(io::read_text(path));
  std::vector<Record> records;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const json value = json::parse(line, nullptr, false);
    try {
      if (value.is_discarded()) throw InputError("not JSON; expected one record to a line");
      records.push_back(record_from(value));
    } catch (const InputError& e) {
      throw InputError(printable_name(path) + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  return records;
}

}  // namespace lrb::stability
