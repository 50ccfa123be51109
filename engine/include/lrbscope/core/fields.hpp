#pragma once
/// Reflection of records: one table of fields defines how a record is compared, written and read. The header
/// of a record, or one beside it, specialises kFields and verifies with
/// `static_assert(covers_all_fields<Record>)` that no member is missing.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lrb {

/// The condition under which a field is written to files.
enum class Kept : std::uint8_t {
  always,
  if_set,     ///< only if it differs from the default
  if_coarse,  ///< only for coarse queries
};

/// The notation of a number.
enum class Form : std::uint8_t {
  plain,
  id,           ///< at most kMaxId
  hash,         ///< 16 hexadecimal digits
  or_infinite,  ///< infinity is written as null
};

/// One line of a record's table. Files contain the fields in the order of the table.
template <class Record, class Value>
struct Field {
  std::string_view name;  ///< a literal, so that data() is NUL-terminated
  Value Record::*member;
  Kept kept;
  Form form;
};
template <class Record, class Value>
constexpr Field<Record, Value> field(std::string_view name, Value Record::*member, Kept kept = Kept::always,
                                     Form form = Form::plain) {
  return {name, member, kept, form};
}

/// The table of fields of a record.
template <class Record>
inline constexpr auto kFields = std::tuple{};

/// Calls visit(field) for each line of a record's table.
template <class Record, class Visit>
constexpr void for_each_field(const Visit& visit) {
  static_assert(std::tuple_size_v<std::remove_cv_t<decltype(kFields<Record>)>> > 0,
                "no table of fields: include the header that specialises kFields for this record");
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, kFields<Record>);
}

template <class Record>
inline constexpr std::size_t kFieldCount = std::tuple_size_v<std::remove_cv_t<decltype(kFields<Record>)>>;

namespace detail {

/// Converts to any type: the initialiser with which member_count() counts members.
struct AnyValue {
  template <class T>
  operator T() const;
};
template <class Record, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>) {
  return requires {
    Record{(static_cast<void>(I), AnyValue{})...};
  };
}
template <class Record, std::size_t n = 0>
constexpr std::size_t member_count() {
  if constexpr (takes<Record>(std::make_index_sequence<n + 1>()))
    return member_count<Record, n + 1>();
  else
    return n;
}

}  // namespace detail

/// Returns true if a file contains this field of the record. coarse: the query was coarse.
template <class Record, class Value>
bool is_kept(const Field<Record, Value>& field, const Record& record, bool coarse = false) {
  switch (field.kept) {
    case Kept::always:
      return true;
    case Kept::if_set:
      return record.*field.member != Record{}.*field.member;
    case Kept::if_coarse:
      return coarse;
  }
  return true;
}

/// True if the table of a record has as many lines as the record has members.
template <class Record>
inline constexpr bool covers_all_fields = kFieldCount<Record> == detail::member_count<Record>();

}  // namespace lrb
