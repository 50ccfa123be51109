#pragma once
/// Tables of the fields of records that are compared, written and read, one line for each field. From them
/// come first_divergence(), the JSON of traces and summaries in both directions, the keys of a scenario's
/// query and the options of the same names; a test compares them with the published schemas. A member that is
/// missing in its table fails to compile.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/query/collide.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// In which files a field stands.
enum class Kept : std::uint8_t {
  always,
  if_set,     ///< only if it is not the default
  if_coarse,  ///< only if the query was coarse
};

/// How a number is written.
enum class Form : std::uint8_t {
  plain,
  id,           ///< at most kMaxId
  hash,         ///< 16 hexadecimal digits
  or_infinite,  ///< infinity is written as null
};

/// One line of a record's table. Files hold the fields in the order of the table.
template <class Record, class Value>
struct Field {
  std::string_view name;  ///< a literal, so that data() ends with a NUL
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

template <>
inline constexpr auto kFields<CollideRequest> =
    std::tuple{field("mode", &CollideRequest::mode),
               field("recursion", &CollideRequest::recursion),
               field("predicates", &CollideRequest::predicates),
               field("wrapper", &CollideRequest::wrapper),
               field("contacts", &CollideRequest::contacts),
               field("interiors_overlap", &CollideRequest::interiors_overlap),
               field("tolerance", &CollideRequest::tolerance, Kept::if_set),
               field("max_tests", &CollideRequest::max_tests, Kept::if_set),
               field("max_time", &CollideRequest::max_time, Kept::if_set),
               field("separation", &CollideRequest::separation, Kept::if_set),
               field("max_pairs", &CollideRequest::max_pairs, Kept::if_set)};

template <>
inline constexpr auto kFields<Counters> =
    std::tuple{field("face_tests", &Counters::face_tests),
               field("real_tests", &Counters::real_tests),
               field("exact_fallbacks", &Counters::exact_fallbacks),
               field("node_pairs", &Counters::node_pairs),
               field("box_tests", &Counters::box_tests),
               field("prefilter_tests", &Counters::prefilter_tests),
               field("refinements", &Counters::refinements),
               field("regions_opened", &Counters::regions_opened),
               field("face_tests_by_level", &Counters::face_tests_by_level)};

template <>
inline constexpr auto kFields<StepResult> =
    std::tuple{field("relation", &StepResult::relation),
               field("interiors_overlap", &StepResult::interiors_overlap),
               field("pairs", &StepResult::pair_count),
               field("fingerprint", &StepResult::fingerprint, Kept::always, Form::hash),
               field("error_bound", &StepResult::error_bound, Kept::if_coarse, Form::or_infinite),
               field("finished", &StepResult::finished, Kept::if_coarse),
               field("separation", &StepResult::separation, Kept::if_set),
               field("counters", &StepResult::counters)};

template <>
inline constexpr auto kFields<BodyInfo> =
    std::tuple{field("name", &BodyInfo::name),
               field("source", &BodyInfo::source),
               field("hash", &BodyInfo::hash, Kept::always, Form::hash),
               field("dim", &BodyInfo::dim),
               field("closed", &BodyInfo::closed),
               field("real_faces", &BodyInfo::real_faces, Kept::always, Form::id),
               field("total_faces", &BodyInfo::total_faces, Kept::always, Form::id),
               field("outer_faces", &BodyInfo::outer_faces, Kept::always, Form::id),
               field("regions", &BodyInfo::regions, Kept::always, Form::id),
               field("layers", &BodyInfo::layers, Kept::always, Form::id),
               field("real_simplices", &BodyInfo::real_simplices, Kept::always, Form::id),
               field("simplices", &BodyInfo::simplices, Kept::always, Form::id)};

/// Calls visit(field) for each line of a record's table.
template <class Record, class Visit>
constexpr void for_each_field(const Visit& visit) {
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, kFields<Record>);
}

template <class Record>
inline constexpr std::size_t kFieldCount = std::tuple_size_v<std::remove_cv_t<decltype(kFields<Record>)>>;

namespace detail {

/// Converts to any type: the initialiser that member_count() fills a record with.
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

static_assert(kFieldCount<CollideRequest> == detail::member_count<CollideRequest>());
static_assert(kFieldCount<Counters> == detail::member_count<Counters>());
static_assert(kFieldCount<StepResult> == detail::member_count<StepResult>());
static_assert(kFieldCount<BodyInfo> == detail::member_count<BodyInfo>());

/// Returns true if a file has this field of the record. coarse: the query was coarse.
template <class Record, class Value>
bool is_kept(const Field<Record, Value>& field, const Record& record, bool coarse) {
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

}  // namespace lrb::trace
