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
  const nlohmann::ordered_json record = io::record_to_json(info);
  nlohmann::ordered_json out;
  const auto add = [&](methods::Trait t) { out[std::string(name_of(t))] = info.has(t); };
  // The first trait comes before "says", the others after it.
  for (const auto& [key, value] : record.items()) {
    if (key == "says") add(methods::Trait::loose);
    out[key] = value;
    if (key != "says") continue;
    for (const auto& entry : kEnumNames<methods::Trait>)
      if (entry.value != methods::Trait::loose) add(entry.value);
  }
  return out;
}

methods::MethodInfo method_info_from(const nlohmann::json& value) {
  auto info = io::record_from_json<methods::MethodInfo>(value);
  for (const auto& entry : kEnumNames<methods::Trait>) {
    const char* key = entry.name.data();
    try {
      info.traits.set(entry.value, value.at(key).get<bool>());
    } catch (const nlohmann::json::exception& e) {
      throw InputError(std::string(key) + ": " + e.what());
    }
  }
  return info;
}

nlohmann::ordered_json pose_json(const Pose& pose) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.push_back(pose.r(i, j));
    out.push_back(pose.t[i]);
  }
  return out;
}

}  // namespace lrb::workers
