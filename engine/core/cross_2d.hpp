#pragma once

namespace lrb {

/// Returns the z of a x b: twice the area of the triangle 0, a, b in the plane, positive if it turns left.
/// What z the vectors have themselves does not count.
template <class A, class B>
double cross_2d(const A& a, const B& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace lrb
