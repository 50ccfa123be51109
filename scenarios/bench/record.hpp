#pragma once
/// Raw records: what a method answered to a question, and how long it took. One JSON object to a line;
/// everything else is computed from these.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/query/collide.hpp"
#include "scenarios/bench/data_set.hpp"

namespace lrb::bench {

enum class Outcome : std::uint8_t { answered, refused, crashed, timed_out };
constexpr auto words_of(Outcome) {
  return std::to_array<EnumWord<Outcome>>({{Outcome::answered, "answered"},
                                           {Outcome::refused, "refused"},
                                           {Outcome::crashed, "crashed"},
                                           {Outcome::timed_out, "timed_out"}});
}

/// The answer in one mode.
struct Reply {
  bool contact = false;
  std::uint64_t count = 0;              ///< pairs
  std::uint64_t missed = 0, extra = 0;  ///< against the exact list
  double cold_us = 0;                   ///< the first time, caches swept
  double hot_us = 0;                    ///< the best of a few repeats
  std::uint64_t face_tests = 0;
  std::vector<SimplexPair> pairs;       ///< if they are kept
  std::vector<Eigen::Vector3d> points;  ///< if they are kept, and the method gives them
};

struct Record {
  std::string set, method;
  std::optional<double> setting;
  std::uint64_t question = 0;
  PoseClass pose_class = PoseClass::apart;
  Outcome outcome = Outcome::answered;
  std::string message;  ///< of what is no answer
  Reply all, first;
  double build_seconds = 0;  ///< both bodies
  double bytes = 0;          ///< that the heap grew by for them
};

nlohmann::ordered_json to_json(const Record& r);
/// Throws InputError saying what is wrong with the value.
Record record_from(const nlohmann::json& value);
/// Lines that are not whole, left by a run that was interrupted, are passed over. None if there is no file.
std::vector<Record> read_records(const std::string& path);

/// Pairs as one array of numbers.
nlohmann::ordered_json flat(const std::vector<SimplexPair>& pairs);
std::vector<SimplexPair> pairs_from(const nlohmann::json& flat);

/// "fcl", "spheres 4".
std::string name_of(const Record& r);
std::string name_of(const std::string& method, std::optional<double> setting);

}  // namespace lrb::bench
