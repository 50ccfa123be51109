#pragma once
/// Right answers about distances, times of first contact, depths, near pairs and self-intersections, as an
/// interval of doubles or a list of pairs, by rational arithmetic: brute force over all pairs of triangles,
/// or over all candidate separating planes of convex bodies. They share no formula with the engine.

#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::quantities {

/// Returns why a quantity is not queried for a case: 2D bodies, coordinates that are not doubles, too many
/// faces for rational arithmetic. Empty if it is queried.
std::string why_unsupported(stability::Quantity quantity, const cases::Case& c);

/// Returns the question about a case. B approaches from its side of A, starting at a distance at which the
/// bodies are separate; its translation is exactly zero at t = 3/4, though methods may round. Pairs are near
/// within 0, the distance of two corners, a billionth or a tenth of the size, or the size. The choice depends
/// on the bodies.
methods::Question question_of(const cases::Case& c);

/// Returns the pairs of triangles at most `within` apart, and those that intersect themselves: that share a
/// point beyond the corners and edges that they share by index. Triangles without area do not intersect
/// themselves.
std::vector<SimplexPair> true_near_pairs(const LrbRep& a, const LrbRep& b, double within);
std::vector<SimplexPair> true_self_intersections(const LrbRep& body);

stability::RightAnswer true_number(stability::Quantity quantity, const cases::Case& c);

/// Asks a method about a case. A case for which the quantity is not queried is rejected.
methods::Answer ask_number(const methods::MethodEntry& method, const cases::Case& c);

}  // namespace lrb::quantities
