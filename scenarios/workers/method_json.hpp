#pragma once
/// What a worker says of its methods, on a line each.

#include <nlohmann/json.hpp>

#include "scenarios/methods/method.hpp"

namespace lrb::workers {

nlohmann::ordered_json to_json(const methods::MethodInfo& info);
/// What is missing is as in a MethodInfo that nobody filled in.
methods::MethodInfo method_info_from(const nlohmann::json& value);

}  // namespace lrb::workers
