#pragma once
/// The contents of a RationalPoint. Private to engine/exact, because it includes Boost.

#include "engine/exact/locate.hpp"
#include "engine/exact/rational.hpp"

namespace lrb::exact {

struct RationalPoint::Coordinates {
  RationalVec x;
  std::array<double, 3> low, high;  ///< doubles that enclose x; equal if x is a double

  explicit Coordinates(RationalVec coordinates);
};

inline RationalPoint make_point(RationalVec x) {
  return RationalPoint(std::make_shared<const RationalPoint::Coordinates>(std::move(x)));
}

}  // namespace lrb::exact
