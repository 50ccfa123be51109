#include "bench/workers/worker_json.hpp"

#include <limits>

namespace lrb {

template <>
inline constexpr auto kFields<methods::MethodStyle> =
    std::tuple{field("title", &methods::MethodStyle::title), field("colour", &methods::MethodStyle::colour),
               field("shape", &methods::MethodStyle::shape)};

template <>
inline constexpr auto kFields<methods::MethodInfo> = std::tuple{
    field("name", &methods::MethodInfo::name),           field("title", &methods::MethodInfo::title),
    field("remark", &methods::MethodInfo::remark),       field("present", &methods::MethodInfo::present),
    field("pairs", &methods::MethodInfo::pairs),         field("says", &methods::MethodInfo::says),
    field("parameter", &methods::MethodInfo::parameter), field("settings", &methods::MethodInfo::settings),
    field("style", &methods::MethodInfo::style),         field("role", &methods::MethodInfo::role),
    field("rank", &methods::MethodInfo::rank),           field("quantity", &methods::MethodInfo::quantity)};

template <>
inline constexpr auto kFields<methods::TestCounts> =
    std::tuple{field("boxes", &methods::TestCounts::boxes), field("faces", &methods::TestCounts::faces)};

template <>
inline constexpr auto kFields<methods::Answer> =
    std::tuple{field("outcome", &methods::Answer::outcome),
               field("message", &methods::Answer::message, Kept::if_set),
               field("contact", &methods::Answer::contact),
               field("pairs", &methods::Answer::pairs, Kept::if_set),
               field("count", &methods::Answer::count, Kept::if_set),
               field("inside", &methods::Answer::inside, Kept::if_set),
               field("relation", &methods::Answer::relation, Kept::if_set),
               field("lower", &methods::Answer::lower, Kept::if_set),
               field("upper", &methods::Answer::upper, Kept::if_set),
               field("us", &methods::Answer::microseconds),
               field("tests", &methods::Answer::tests, Kept::if_set),
               field("kinds", &methods::Answer::kinds, Kept::if_set)};

static_assert(covers_all_fields<methods::MethodStyle>);
static_assert(covers_all_fields<methods::TestCounts>);
// All members except the traits, which have separate keys.
static_assert(kFieldCount<methods::MethodInfo> + 1 == detail::member_count<methods::MethodInfo>());

}  // namespace lrb

namespace lrb::workers {

std::string line_of(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

nlohmann::ordered_json to_json(const methods::MethodInfo& info) {
  nlohmann::ordered_json out = io::record_to_json(info);
  for (const auto& trait : kEnumNames<methods::Trait>) out[std::string(trait.name)] = info.has(trait.value);
  return out;
}

methods::MethodInfo method_info_from(const nlohmann::json& value) {
  auto info = io::record_from_json<methods::MethodInfo>(value);
  for (const auto& trait : kEnumNames<methods::Trait>)
    info.traits.set(trait.value, value.value(std::string(trait.name), false));
  return info;
}

nlohmann::ordered_json to_json(const methods::Answer& answer) {
  nlohmann::ordered_json out = io::record_to_json(answer);
  if (!answer.exchanged.empty()) out["exchanged"] = to_json(answer.exchanged.front());
  return out;
}

methods::Answer answer_from(nlohmann::json value) {
  // JSON has null for a number that is not finite: NaN agrees with no right answer.
  for (const char* end : {"lower", "upper"})
    if (value.contains(end) && value[end].is_null()) value[end] = std::numeric_limits<double>::quiet_NaN();
  auto answer = io::record_from_json<methods::Answer>(value);
  if (value.contains("exchanged")) answer.exchanged = {answer_from(value.at("exchanged"))};
  return answer;
}

methods::Answer answer_of(Worker& worker, const nlohmann::ordered_json& question,
                          std::chrono::duration<double> limit) {
  WorkerFailure failure;
  if (const auto line = worker.ask(question.dump(), limit, failure))
    return answer_from(nlohmann::json::parse(*line));
  methods::Answer out;
  note_failure(out, failure);
  return out;
}

}  // namespace lrb::workers
