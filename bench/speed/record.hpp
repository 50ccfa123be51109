#pragma once
/// Raw records: the answer of a method to a query, and its time. A file contains one JSON object per line.
/// All other results are computed from these.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/speed/data_set.hpp"
#include "bench/speed/errors.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::bench {

enum class Outcome : std::uint8_t { answered, rejected, crashed, timed_out };
constexpr auto enum_names(Outcome) {
  return std::to_array<EnumName<Outcome>>({{Outcome::answered, "answered"},
                                           {Outcome::rejected, "refused"},
                                           {Outcome::crashed, "crashed"},
                                           {Outcome::timed_out, "timed_out"}});
}

/// The answer in one mode.
struct Reply {
  bool contact = false;
  std::uint64_t count = 0;              ///< number of pairs
  std::uint64_t missed = 0, extra = 0;  ///< compared with the exact list
  double cold_us = 0;  ///< time of the first query, after the processor's caches were flushed
  double hot_us = 0;   ///< minimum time of some repetitions
  std::uint64_t face_tests = 0;
  std::optional<double> error_bound;   ///< as in methods::MethodAnswer; of a number: width of its interval
  std::optional<double> lower, upper;  ///< the number, if that is the quantity; equal: no interval
  friend bool operator==(const Reply&, const Reply&) = default;
};

struct Record {
  std::string set, method;
  std::optional<double> setting;
  std::uint64_t question = 0;
  std::uint64_t round = 0;  ///< of timing; the answer is judged in round 0
  PoseClass pose_class = PoseClass::apart;
  Outcome outcome = Outcome::answered;
  std::string message;  ///< reason if there is no answer
  Reply all, first;
  double build_seconds = 0;  ///< for both bodies
  double bytes = 0;          ///< growth of the heap by both bodies
  /// Errors of the answer with all pairs, if it was judged. Pairs and points themselves are not stored: those
  /// of some meshes at one pose take 100 MB.
  std::optional<Errors> errors;
};

nlohmann::ordered_json to_json(const Record& r);
/// Reads a record. Throws InputError, which describes the error in the value, if it is invalid.
Record record_from(const nlohmann::json& value);
/// Reads a file of records. Returns an empty list if the file does not exist. Skips incomplete lines, which
/// interrupted runs leave.
std::vector<Record> read_records(const std::string& path);

/// Returns the method's name with its setting: "fcl", "spheres 4".
std::string name_of(const Record& r);
std::string name_of(const std::string& method, std::optional<double> setting);

}  // namespace lrb::bench
