#pragma once
/// Methods that answer with a number: ours, and engines of others.

#include <functional>
#include <optional>
#include <vector>

#include "bench/quantities/truth.hpp"
#include "bench/rivals/method.hpp"
#include "bench/stability/outcome_grid.hpp"

namespace lrb::stability {

struct NumberAnswer {
  double lower = 0, upper = 0;  ///< equal, unless the method gives an interval
  double microseconds = 0;      ///< the time of the query alone
};

/// Of a method's knob; none: as it is asked where methods must be right.
using Setting = std::optional<double>;

/// A method for one quantity.
struct NumberMethod {
  methods::MethodInfo info;
  Quantity quantity = Quantity::distance;
  bool proves = false;  ///< its interval is to hold the number
  /// Throws InputError if it has no answer, which counts as a refusal.
  std::function<NumberAnswer(const Asked&, Setting)> ask;
};

/// Returns a method with a knob, and its settings from coarse to fine.
NumberMethod with_knob(NumberMethod m, const char* knob, std::vector<double> settings);

/// Returns ours, exact queries at equal times, and those of the engines that were there at build time.
std::vector<NumberMethod> number_methods();
std::vector<NumberMethod> own_number_methods();
std::vector<NumberMethod> fcl_number_methods();

/// Puts a case to a method, and fills in outcome, time, message, and both numbers as relations.
void ask_number(const NumberMethod& method, const cases::Case& c, const RightAnswer& expected,
                Record& record);

/// Fills in the outcome of an answer. It is wrong if it says 0 (or never) where that is not so, or something
/// else where it is; if a proved interval does not hold the number; or if the number is further off than a
/// millionth of the bodies' size, or a thousandth of the motion.
void judge_number(Record& record, const NumberMethod& method, const NumberAnswer& answer,
                  const RightAnswer& expected, double size);

}  // namespace lrb::stability
