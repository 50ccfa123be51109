#pragma once
/// Puts a data set's questions to methods that answer with a number, and measures the time.

#include <optional>

#include "scenarios/bench/record.hpp"
#include "scenarios/stability/quantities/number_method.hpp"

namespace lrb::worker_programs {

/// Puts a question to a method at a setting of its knob. A refusal is an outcome, too. Throws InputError if
/// there is no such question.
bench::Record bench_record(const stability::NumberMethod& method, std::optional<double> setting,
                           const bench::DataSet& set, std::uint64_t question);

/// Returns what a method says at its finest setting, as {"least": .., "most": ..}, or {"refusal": "why"}.
nlohmann::ordered_json known_number(const stability::NumberMethod& method, const bench::DataSet& set,
                                    std::uint64_t question);

}  // namespace lrb::worker_programs
