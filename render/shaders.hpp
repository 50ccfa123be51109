#pragma once
/// The shaders. Positions are final device coordinates; colours are straight on input and premultiplied on
/// output. Coverage is rounded to sixteenths, so that last-bit differences between processors rarely change a
/// pixel.

namespace lrb::render::shaders {

inline constexpr const char* kFaceVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 edge_distance;
layout(location = 2) in vec4 face_colour;
layout(location = 3) in vec4 edge_colour;
layout(location = 4) in float half_width;
layout(location = 5) in uint id;
out vec3 v_edge;
flat out vec4 v_face_colour;
flat out vec4 v_edge_colour;
flat out float v_half_width;
flat out uint v_id;
void main() {
  gl_Position = vec4(position, 1.0);
  v_edge = edge_distance;
  v_face_colour = face_colour;
  v_edge_colour = edge_colour;
  v_half_width = half_width;
  v_id = id;
}
)";

inline constexpr const char* kFaceCommon = R"(#version 330 core
in vec3 v_edge;
flat in vec4 v_face_colour;
flat in vec4 v_edge_colour;
flat in float v_half_width;
out vec4 colour;
vec4 face_with_edges() {
  float distance = min(v_edge.x, min(v_edge.y, v_edge.z));
  float covered = floor(clamp(v_half_width - distance + 0.5, 0.0, 1.0) * 16.0 + 0.5) * 0.0625;
  vec4 face = vec4(v_face_colour.rgb * v_face_colour.a, v_face_colour.a);
  vec4 edge = vec4(v_edge_colour.rgb * v_edge_colour.a, v_edge_colour.a);
  return edge * covered + face * (1.0 - edge.a * covered);
}
)";

inline constexpr const char* kFaceFragment = R"(
void main() { colour = face_with_edges(); }
)";

/// Draws faces on top; the ghosted part is fainter (`strength` in 1/256).
inline constexpr const char* kGhostFragment = R"(
uniform int strength;
void main() { colour = face_with_edges() * (float(strength) * 0.00390625); }
)";

inline constexpr const char* kIdFragment = R"(#version 330 core
flat in uint v_id;
out uint id;
void main() { id = v_id; }
)";

inline constexpr const char* kLineVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 along_across;
layout(location = 2) in vec4 shape;  // length, half width, dash, dash start
layout(location = 3) in vec4 line_colour;
out vec2 v_at;
flat out vec4 v_shape;
flat out vec4 v_colour;
void main() {
  gl_Position = vec4(position, 1.0);
  v_at = along_across;
  v_shape = shape;
  v_colour = line_colour;
}
)";

inline constexpr const char* kLineFragment = R"(#version 330 core
in vec2 v_at;
flat in vec4 v_shape;
flat in vec4 v_colour;
uniform int ghost;  // the hidden part of overlays: lines thinner and dashed, points as rings
out vec4 colour;
void main() {
  float length_ = v_shape.x;
  float half_width = v_shape.y;
  float dash = v_shape.z;
  vec2 beyond = vec2(max(max(-v_at.x, v_at.x - length_), 0.0), v_at.y);
  float distance = sqrt(dot(beyond, beyond));
  if (ghost != 0) {
    if (length_ == 0.0) {
      distance = abs(distance - half_width * 0.8);
      half_width *= 0.2;
    } else {
      if (dash == 0.0) dash = 5.0 * half_width;
      half_width *= 0.6;
    }
  }
  float covered = clamp(half_width - distance + 0.5, 0.0, 1.0);
  if (dash > 0.0 && length_ > 0.0) {
    float at = v_shape.w + clamp(v_at.x, 0.0, length_);
    float phase = at - floor(at / (2.0 * dash)) * 2.0 * dash;  // 0 .. dash: drawn
    covered *= clamp(min(phase, dash - phase) + 0.5, 0.0, 1.0);
  }
  covered = floor(covered * 16.0 + 0.5) * 0.0625;
  if (covered <= 0.0) discard;
  colour = vec4(v_colour.rgb, 1.0) * (v_colour.a * covered);
}
)";

}  // namespace lrb::render::shaders
