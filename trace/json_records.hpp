#pragma once
/// Writes records as JSON objects and reads them, by their tables of fields (lrbscope/core/fields.hpp).

#include <optional>
#include <string>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "trace/json_read.hpp"
#include <lrbscope/core/fields.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {

template <class Record>
nlohmann::ordered_json record_to_json(const Record& record);
template <class Record>
Record record_from_json(const nlohmann::json& value);

/// JSON form of a field's value: numbers, strings and lists of them directly, enumerators by name, records as
/// objects. Specialise it for other types.
template <class Value>
struct JsonOf {
  static nlohmann::ordered_json write(const Value& value) {
    if constexpr (std::is_enum_v<Value>)
      return name_of(value);
    else if constexpr (kFieldCount<Value> > 0)
      return record_to_json(value);
    else
      return value;
  }
  static Value read(const nlohmann::json& value) {
    if constexpr (std::is_enum_v<Value>) {
      const auto word = value.get<std::string>();
      if (const auto found = from_name<Value>(word)) return *found;
      throw InputError("'" + word + "': expected " + all_names<Value>());
    } else if constexpr (kFieldCount<Value> > 0) {
      return record_from_json<Value>(value);
    } else {
      return value.get<Value>();
    }
  }
};
/// Only for fields that are written if set.
template <class Value>
struct JsonOf<std::optional<Value>> {
  static nlohmann::ordered_json write(const std::optional<Value>& value) {
    return JsonOf<Value>::write(value.value());
  }
  static std::optional<Value> read(const nlohmann::json& value) { return JsonOf<Value>::read(value); }
};

/// Returns the record as an object, with its members in the order of the table.
template <class Record>
nlohmann::ordered_json record_to_json(const Record& record) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for_each_field<Record>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(record.*field.member)>;
    if (is_kept(field, record)) out[field.name.data()] = JsonOf<Value>::write(record.*field.member);
  });
  return out;
}

/// Reads a record. Throws InputError that states what is wrong with the value. Keys that are not fields are
/// ignored.
template <class Record>
Record record_from_json(const nlohmann::json& value) {
  Record record;
  for_each_field<Record>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(record.*field.member)>;
    const char* key = field.name.data();
    if (field.kept != Kept::always && !value.contains(key)) return;
    try {
      record.*field.member = JsonOf<Value>::read(value.at(key));
    } catch (const nlohmann::json::exception& e) {
      throw InputError(std::string(key) + ": " + plain_reason(e.what()));
    }
  });
  return record;
}

}  // namespace lrb::io
