#pragma once
/// Writes and reads what a worker says about its methods, one line for each.

#include <nlohmann/json.hpp>

#include "scenarios/methods/method.hpp"

namespace lrb::workers {

nlohmann::ordered_json to_json(const methods::MethodInfo& info);
/// Reads a line. Throws InputError that says what is wrong with it.
methods::MethodInfo method_info_from(const nlohmann::json& value);

}  // namespace lrb::workers
