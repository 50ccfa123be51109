#include "bench/workers/worker_json.hpp"

#include "trace/json_read.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<methods::MethodStyle> =
    std::tuple{field("title", &methods::MethodStyle::title), field("colour", &methods::MethodStyle::colour),
               field("shape", &methods::MethodStyle::shape), field("point", &methods::MethodStyle::point)};

template <>
inline constexpr auto kFields<methods::MethodInfo> =
    std::tuple{field("name", &methods::MethodInfo::name),
               field("title", &methods::MethodInfo::title),
               field("remark", &methods::MethodInfo::remark),
               field("present", &methods::MethodInfo::present),
               field("pairs", &methods::MethodInfo::pairs),
               field("loose", &methods::MethodInfo::loose),
               field("says", &methods::MethodInfo::says),
               field("plane", &methods::MethodInfo::plane),
               field("moves_exactly", &methods::MethodInfo::moves_exactly),
               field("hard_cases", &methods::MethodInfo::hard_cases),
               field("approximate", &methods::MethodInfo::approximate),
               field("convex", &methods::MethodInfo::convex),
               field("told_more", &methods::MethodInfo::told_more),
               field("own_rep", &methods::MethodInfo::own_rep),
               field("knob", &methods::MethodInfo::knob),
               field("settings", &methods::MethodInfo::settings),
               field("style", &methods::MethodInfo::style),
               field("role", &methods::MethodInfo::role),
               field("rank", &methods::MethodInfo::rank)};

static_assert(covers_all_fields<methods::MethodStyle>);
static_assert(covers_all_fields<methods::MethodInfo>);

}  // namespace lrb

namespace lrb::workers {

nlohmann::ordered_json to_json(const methods::MethodInfo& info) {
  return io::record_to_json(info);
}

methods::MethodInfo method_info_from(const nlohmann::json& value) {
  return io::record_from_json<methods::MethodInfo>(value);
}

}  // namespace lrb::workers
