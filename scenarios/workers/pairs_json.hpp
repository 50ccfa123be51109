#pragma once
/// Pairs of simplices in JSON: one array of numbers, A's and B's of the first pair, of the second, and so on.

#include <vector>

#include "engine/query/walk/result.hpp"
#include "scenarios/io/json/record_json.hpp"

template <>
struct lrb::io::JsonOf<std::vector<lrb::SimplexPair>> {
  static nlohmann::ordered_json write(const std::vector<SimplexPair>& pairs) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const SimplexPair& p : pairs) {
      out.push_back(p.a.value());
      out.push_back(p.b.value());
    }
    return out;
  }
  static std::vector<SimplexPair> read(const nlohmann::json& flat) {
    std::vector<SimplexPair> out;
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2)
      out.push_back({SimplexId(flat[i].get<std::uint32_t>()), SimplexId(flat[i + 1].get<std::uint32_t>())});
    return out;
  }
};

namespace lrb::workers {
using PairsJson = io::JsonOf<std::vector<SimplexPair>>;
}  // namespace lrb::workers
