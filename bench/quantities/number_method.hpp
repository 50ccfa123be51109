#pragma once
/// Methods that return a number, near pairs or self-intersections: lrbscope and other engines. And the right
/// answers, as an interval of doubles or a list of pairs, by rational arithmetic: brute force over all pairs
/// of triangles, or over all candidate separating planes of convex bodies. They share no formula with the
/// engine.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::stability {

// A case as input of methods that return a number: both bodies in world coordinates, so that all methods get
// the same doubles.

using methods::Quantity;

struct NumberQuery {
  LrbRep a, b;
  /// Translation of B at t = 0 and t = 1. Exactly zero at t = 3/4; methods may round.
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  double size = 0;  ///< diagonal of the larger body's box
  /// For pairs within a distance: 0, the distance of two corners, a billionth or a tenth of the size, or the
  /// size. The choice depends on the bodies.
  double within = 0;
};

/// Returns why a quantity is not queried for a case: 2D bodies, coordinates that are not doubles, too many
/// faces for rational arithmetic. Empty if it is queried.
std::string why_unsupported(Quantity quantity, const cases::Case& c);

/// Returns the query. B approaches from its side of A, starting at a distance at which the bodies are
/// separate.
NumberQuery query_of(const cases::Case& c);

/// Returns the triangles of both bodies as one body without regions; those of A come first.
LrbRep union_of(const NumberQuery& query);

/// Returns the pairs of triangles at most `within` apart, and those that intersect themselves: that share a
/// point beyond the corners and edges that they share by index. Triangles without area do not intersect
/// themselves.
std::vector<SimplexPair> true_near_pairs(const LrbRep& a, const LrbRep& b, double within);
std::vector<SimplexPair> true_self_intersections(const LrbRep& body);

using methods::kNever;

RightAnswer true_number(Quantity quantity, const cases::Case& c);

// Methods.

struct NumberAnswer {
  double lower = 0, upper = 0;          ///< equal, unless the method gives an interval
  double microseconds = 0;              ///< the time of the query alone
  std::vector<SimplexPair> pairs = {};  ///< ascending; if the quantity is a list
  std::vector<double> distances = {};   ///< of near pairs, if reported; of an interval the upper end
};

/// The value of a method's parameter. nullopt: the setting for tests of correctness.
using Setting = std::optional<double>;

/// Throws InputError if it has no answer, which counts as a rejection.
using Ask = std::function<NumberAnswer(const NumberQuery&, Setting)>;

/// A method for one quantity.
struct NumberMethod {
  methods::MethodInfo info;
  Quantity quantity = Quantity::distance;
  bool proves = false;  ///< its interval must contain the number
  Ask ask;
};

/// Returns a method without a parameter.
NumberMethod number_method(const std::string& name, const std::string& title, const char* remark,
                           Quantity quantity, Ask ask, methods::MethodStyle style);
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
