#include "scenarios/workers/method_json.hpp"

namespace lrb::workers {

nlohmann::ordered_json to_json(const methods::MethodInfo& info) {
  return {{"name", info.name},
          {"title", info.title},
          {"remark", info.remark},
          {"present", info.present},
          {"pairs", info.pairs},
          {"loose", info.loose},
          {"hard_cases", info.hard_cases},
          {"approximate", info.approximate},
          {"convex", info.convex},
          {"told_more", info.told_more},
          {"own_rep", info.own_rep},
          {"knob", info.knob},
          {"settings", info.settings},
          {"style",
           {{"title", info.style.title},
            {"colour", info.style.colour},
            {"shape", info.style.shape},
            {"point", info.style.point}}}};
}

methods::MethodInfo method_info_from(const nlohmann::json& value) {
  methods::MethodInfo info;
  info.name = value.value("name", "");
  info.title = value.value("title", "");
  info.remark = value.value("remark", "");
  info.present = value.value("present", false);
  info.pairs = value.value("pairs", info.pairs);
  info.loose = value.value("loose", info.loose);
  info.hard_cases = value.value("hard_cases", info.hard_cases);
  info.approximate = value.value("approximate", info.approximate);
  info.convex = value.value("convex", info.convex);
  info.told_more = value.value("told_more", info.told_more);
  info.own_rep = value.value("own_rep", info.own_rep);
  info.knob = value.value("knob", "");
  info.settings = value.value("settings", std::vector<double>());
  const nlohmann::json style = value.value("style", nlohmann::json::object());
  info.style.title = style.value("title", "");
  info.style.colour = style.value("colour", "");
  info.style.shape = style.value("shape", "");
  info.style.point = style.value("point", 0);
  return info;
}

}  // namespace lrb::workers
