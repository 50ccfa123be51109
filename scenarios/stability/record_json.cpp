#include "scenarios/stability/record_json.hpp"

#include <sstream>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/json/record_json.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<stability::Record> =
    std::tuple{field("family", &stability::Record::family),
               field("method", &stability::Record::method),
               field("dial", &stability::Record::dial),
               field("case", &stability::Record::case_index),
               field("seed", &stability::Record::seed),
               field("outcome", &stability::Record::outcome),
               field("expected", &stability::Record::expected),
               field("missed", &stability::Record::missed),
               field("extra", &stability::Record::extra),
               field("relation", &stability::Record::relation),
               field("expected_relation", &stability::Record::expected_relation),
               field("us", &stability::Record::microseconds),
               field("message", &stability::Record::message)};
static_assert(covers_all_fields<stability::Record>);

}  // namespace lrb

namespace lrb::stability {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json to_json(const Record& r) {
  return io::record_to_json(r);
}

Record record_from(const json& value) {
  try {
    const auto r = io::record_from_json<Record>(value);
    if (r.dial < 0 || r.dial >= kDialSettings)
      throw InputError("dial " + std::to_string(r.dial) + ": use 0 to " + std::to_string(kDialSettings - 1));
    return r;
  } catch (const InputError& e) {
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
