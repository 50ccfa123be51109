#include "bench/workers/worker_json.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<methods::MethodStyle> =
    std::tuple{field("title", &methods::MethodStyle::title), field("colour", &methods::MethodStyle::colour),
               field("shape", &methods::MethodStyle::shape)};

template <>
inline constexpr auto kFields<methods::MethodInfo> =
    std::tuple{field("name", &methods::MethodInfo::name),
               field("title", &methods::MethodInfo::title),
               field("remark", &methods::MethodInfo::remark),
               field("present", &methods::MethodInfo::present),
               field("pairs", &methods::MethodInfo::pairs),
               field("says", &methods::MethodInfo::says),
               field("parameter", &methods::MethodInfo::parameter),
               field("settings", &methods::MethodInfo::settings),
               field("style", &methods::MethodInfo::style),
               field("role", &methods::MethodInfo::role),
               field("rank", &methods::MethodInfo::rank)};

static_assert(covers_all_fields<methods::MethodStyle>);
// All members except the traits, which have separate keys.
static_assert(kFieldCount<methods::MethodInfo> + 1 == detail::member_count<methods::MethodInfo>());

}  // namespace lrb

namespace lrb::workers {

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

}  // namespace lrb::workers
