#pragma once
/// Turns double into float, here and nowhere else. Everything before is Eigen in double, exact enough to
/// decide by; everything after is glm, as the graphics library and the shaders take it. Each number is
/// rounded once, to nearest.

#include <Eigen/Core>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/colour.hpp"

namespace lrb::render {

using ByteColour = glm::u8vec4;  ///< red, green, blue, alpha; straight

inline float to_float(double x) {
  return static_cast<float>(x);
}
inline glm::vec2 to_float(const Eigen::Vector2d& v) {
  return {to_float(v.x()), to_float(v.y())};
}
inline glm::vec3 to_float(const Eigen::Vector3d& v) {
  return {to_float(v.x()), to_float(v.y()), to_float(v.z())};
}

inline ByteColour to_bytes(Rgba c) {
  return {c.r, c.g, c.b, c.a};
}
inline Rgba to_rgba(const ByteColour& c) {
  return {c.r, c.g, c.b, c.a};
}
/// Returns the colour with channels in [0, 1].
inline glm::vec4 to_unit(Rgba c) {
  return glm::vec4(to_bytes(c)) / 255.0F;
}

}  // namespace lrb::render
