#pragma once
/// Methods that return a number, near pairs or self-intersections: lrbscope and other engines.

#include <functional>
#include <optional>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/quantities/truth.hpp"
#include "bench/stability/outcome_grid.hpp"

namespace lrb::stability {

struct NumberAnswer {
  double lower = 0, upper = 0;          ///< equal, unless the method gives an interval
  double microseconds = 0;              ///< the time of the query alone
  std::vector<SimplexPair> pairs = {};  ///< ascending; if the quantity is a list
  std::vector<double> distances = {};   ///< of near pairs, if reported; of an interval the upper end
};

/// The value of a method's parameter. nullopt: the setting for tests of correctness.
using Setting = std::optional<double>;

/// A method for one quantity.
struct NumberMethod {
  methods::MethodInfo info;
  Quantity quantity = Quantity::distance;
  bool proves = false;  ///< its interval must contain the number
  /// Throws InputError if it has no answer, which counts as a rejection.
  std::function<NumberAnswer(const NumberQuery&, Setting)> ask;
};

/// Returns a method with a parameter named `parameter`, and its settings from coarse to fine.
NumberMethod with_parameter(NumberMethod m, const char* parameter, std::vector<double> settings);

/// Returns lrbscope's methods, including exact queries at equally spaced times, and the methods of the
/// engines found at build time.
std::vector<NumberMethod> number_methods();
std::vector<NumberMethod> own_number_methods();
std::vector<NumberMethod> fcl_number_methods();
std::vector<NumberMethod> cgal_number_methods();
/// Adds a near pair, or sorts all of them by their triangles.
void add_near(NumberAnswer& answer, SimplexPair pair, double distance);
void sort_near(NumberAnswer& answer);

/// Runs a method on a case. Sets outcome, time and message of the record, and both numbers as relations; for
/// lists the counts of pairs. Returns the answer, or nullopt if there is none.
std::optional<NumberAnswer> ask_number(const NumberMethod& method, const cases::Case& c,
                                       const RightAnswer& expected, Record& record);

/// Sets the outcome of an answer. It is wrong if it is 0 (or never) and the true value is not, or the
/// reverse; if a proven interval does not contain the number; or if the error exceeds a millionth of the
/// bodies' size, or a thousandth of the motion.
void judge_number(Record& record, const NumberMethod& method, const NumberAnswer& answer,
                  const RightAnswer& expected, double size);
/// The same for a list: wrong if pairs are missed or in excess.
void judge_list(Record& record, const NumberAnswer& answer, const RightAnswer& expected);

}  // namespace lrb::stability
