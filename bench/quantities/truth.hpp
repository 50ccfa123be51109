#pragma once
/// The right answer, as an interval of doubles or a list of pairs, by rational arithmetic: brute force over
/// all pairs of triangles, or over all candidate separating planes of convex bodies. Shares no formula with
/// the engine.

#include <string>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
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

}  // namespace lrb::stability
