#include "bench/methods/method.hpp"

#include <algorithm>

#include <lrbscope/error.hpp>

namespace lrb::methods {

const MethodEntry& find_method(const std::vector<MethodEntry>& methods, const std::string& name) {
  const auto it =
      std::find_if(methods.begin(), methods.end(), [&](const MethodEntry& e) { return e.info.name == name; });
  if (it == methods.end() || !it->info.present)
    throw InputError("unknown method '" + name + "', or not installed here");
  return *it;
}

}  // namespace lrb::methods
