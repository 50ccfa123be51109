// Off-screen rendering with OpenGL. Steps of a frame: project the draw list on the CPU (ScreenMesh), then
// paint in layers: fills by stencil, opaque faces and lines by depth test, translucent faces in sorted order,
// and primitives on top with their hidden parts ghosted. Finally the supersampled image is averaged in
// integers.

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/gtc/type_ptr.hpp>

#include "render/gl.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {
namespace {

// The shaders. Positions are final device coordinates; colours are straight on input and premultiplied on
// output. Coverage is rounded to sixteenths, so that last-bit differences between processors rarely change a
// pixel.

namespace shaders {

constexpr const char* kFaceVertex = R"(#version 330 core
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

constexpr const char* kFaceCommon = R"(#version 330 core
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

constexpr const char* kFaceFragment = R"(
void main() { colour = face_with_edges(); }
)";

/// Draws faces on top; the ghosted part is fainter (`strength` in 1/256).
constexpr const char* kGhostFragment = R"(
uniform int strength;
void main() { colour = face_with_edges() * (float(strength) * 0.00390625); }
)";

constexpr const char* kIdFragment = R"(#version 330 core
flat in uint v_id;
out uint id;
void main() { id = v_id; }
)";

constexpr const char* kLineVertex = R"(#version 330 core
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

constexpr const char* kLineFragment = R"(#version 330 core
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

}  // namespace shaders

constexpr int kGhostStrength = 96;  ///< of hidden faces on top, in 1/256
constexpr int kFullStrength = 256;

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

/// Averages blocks of n x n premultiplied samples (rows from the bottom) to straight pixels (rows from the
/// top).
Image downsample(const std::vector<std::uint8_t>& samples, int width, int height, int n) {
  Image out(width, height);
  const std::size_t stride = static_cast<std::size_t>(width) * n * 4;
  const int count = n * n;
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* block_row = samples.data() + static_cast<std::size_t>(height - 1 - y) * n * stride;
    for (int x = 0; x < width; ++x) {
      // Sums of premultiplied colours: transparent samples contribute nothing to the colour.
      int r = 0, g = 0, b = 0, a = 0;
      for (int j = 0; j < n; ++j) {
        const std::uint8_t* s = block_row + j * stride + static_cast<std::size_t>(x) * n * 4;
        for (int i = 0; i < n; ++i, s += 4) r += s[0], g += s[1], b += s[2], a += s[3];
      }
      // Divide by the alpha to get straight colours, rounded to nearest.
      if (a == 0) {
        out.at(x, y) = kTransparent;
      } else {
        const auto straight = [a](int c) {
          return static_cast<std::uint8_t>(std::min(255, (c * 255 + a / 2) / a));
        };
        out.at(x, y) = {straight(r), straight(g), straight(b),
                        static_cast<std::uint8_t>((a + count / 2) / count)};
      }
    }
  }
  return out;
}

}  // namespace

struct Rasterizer::State {
  struct Target {
    GlObject colour, depth, framebuffer;
  };
  struct Mesh {
    GlObject array, buffer;
  };

  Offscreen context;
  const Gl& gl = context.gl();
  GlProgram face, ghost, id, line;
  Mesh faces, lines;
  int width = 0, height = 0;
  Target scene;
  std::vector<std::uint8_t> samples;

  State() {
    const std::string common = shaders::kFaceCommon;
    face = make_program(gl, "face", shaders::kFaceVertex, common + shaders::kFaceFragment);
    ghost = make_program(gl, "ghost", shaders::kFaceVertex, common + shaders::kGhostFragment);
    id = make_program(gl, "id", shaders::kFaceVertex, shaders::kIdFragment);
    line = make_program(gl, "line", shaders::kLineVertex, shaders::kLineFragment);
    // The layouts must match the attribute locations of the shaders.
    faces = make_mesh();
    using F = FaceVertex;
    const GLsizei f = sizeof(F);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, f, offset(offsetof(F, x)));
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, f, offset(offsetof(F, edge)));
    gl.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, f, offset(offsetof(F, colour)));
    gl.VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, f, offset(offsetof(F, edge_colour)));
    gl.VertexAttribPointer(4, 1, GL_FLOAT, GL_FALSE, f, offset(offsetof(F, half_width)));
    gl.VertexAttribIPointer(5, 1, GL_UNSIGNED_INT, f, offset(offsetof(F, id)));
    for (GLuint i = 0; i < 6; ++i) gl.EnableVertexAttribArray(i);
    lines = make_mesh();
    using L = LineVertex;
    const GLsizei l = sizeof(L);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, l, offset(offsetof(L, x)));
    gl.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, l, offset(offsetof(L, at)));
    gl.VertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, l, offset(offsetof(L, length)));
    gl.VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, l, offset(offsetof(L, colour)));
    for (GLuint i = 0; i < 4; ++i) gl.EnableVertexAttribArray(i);
    context.check("setting up");
    context.release();
  }

  Mesh make_mesh() {
    Mesh m{make_object(gl.GenVertexArrays, gl.DeleteVertexArrays),
           make_object(gl.GenBuffers, gl.DeleteBuffers)};
    gl.BindVertexArray(m.array);
    gl.BindBuffer(GL_ARRAY_BUFFER, m.buffer);
    return m;
  }

  template <class Vertex>
  void upload(const Mesh& mesh, const std::vector<Vertex>& vertices) {
    gl.BindBuffer(GL_ARRAY_BUFFER, mesh.buffer);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                  GL_STREAM_DRAW);
  }

  void draw(const Mesh& mesh, const VertexRange& range) {
    if (range.count == 0) return;
    gl.BindVertexArray(mesh.array);
    gl.DrawArrays(GL_TRIANGLES, static_cast<GLint>(range.first), static_cast<GLsizei>(range.count));
  }

  void set(const GlProgram& program, const char* name, int value) {
    gl.UseProgram(program);
    gl.Uniform1i(gl.GetUniformLocation(program, name), value);
  }

  // ---- targets

  GlObject texture(GLenum internal, GLenum format, GLenum type, int w, int h) {
    // Integer and exact colour textures must not be filtered.
    GlObject t = make_object(gl.GenTextures, gl.DeleteTextures);
    gl.BindTexture(GL_TEXTURE_2D, t);
    gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), w, h, 0, format, type, nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }
    return t;
  }

  Target scene_target(GLenum internal, GLenum format, GLenum type, int w, int h) {
    Target t;
    t.colour = texture(internal, format, type, w, h);
    t.depth = texture(GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, w, h);
    t.framebuffer = make_object(gl.GenFramebuffers, gl.DeleteFramebuffers);
    gl.BindFramebuffer(GL_FRAMEBUFFER, t.framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, t.colour, 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, t.depth, 0);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw EnvironmentError("OpenGL cannot draw a picture of this format and size; draw a smaller one");
    }
    return t;
  }

  void check_size(int w, int h) {
    if (w < 1 || h < 1 || w > context.max_size() || h > context.max_size()) {
      throw InputError("a picture of " + std::to_string(w) + "x" + std::to_string(h) +
                       " samples cannot be drawn: each side must be 1 to " +
                       std::to_string(context.max_size()));
    }
  }

  void resize(int w, int h) {
    // Frames of a series share one target.
    if (w == width && h == height) return;
    scene = scene_target(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, w, h);
    width = w, height = h;
    context.check("allocating the picture");
  }

  // ---- passes

  void begin(const Target& target, int w, int h) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl.Viewport(0, 0, w, h);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_BLEND);
    gl.Disable(GL_CULL_FACE);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.DepthMask(GL_TRUE);
    // Depth 1 is the far plane.
    gl.ClearBufferfi(GL_DEPTH_STENCIL, 0, 1, 0);
  }

  void blend_over() {
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }

  /// Fills by the even-odd rule: the fan flips a stencil bit for every triangle, so that it is set inside;
  /// the cover paints where it is set and clears it.
  void draw_fills(const ScreenMesh& mesh, bool blend) {
    if (mesh.fills.empty()) return;
    // Stencil, then cover. Fills are flat and lie behind everything, in the order of the list.
    gl.Disable(GL_DEPTH_TEST);
    gl.Enable(GL_STENCIL_TEST);
    if (blend) blend_over();
    for (const FillRange& fill : mesh.fills) {
      // Step 1: the fan inverts the stencil; a pixel that it covers an odd number of times is inside.
      gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
      gl.StencilFunc(GL_ALWAYS, 0, 1);
      gl.StencilOp(GL_INVERT, GL_INVERT, GL_INVERT);
      draw(faces, fill.fan);
      // Step 2: paint the bounding rectangle where the stencil is set. This also clears it for the next fill.
      gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
      gl.StencilFunc(GL_NOTEQUAL, 0, 1);
      gl.StencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
      draw(faces, fill.cover);
    }
    gl.Disable(GL_STENCIL_TEST);
    gl.Disable(GL_BLEND);
  }

  void draw_opaque(const ScreenMesh& mesh) {
    const auto layer = static_cast<std::size_t>(Layer::opaque);
    // Faces do not blend here, so their order does not matter. Lines have soft borders and come afterwards.
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    gl.UseProgram(face);
    draw(faces, mesh.face_layers[layer]);
    draw_lines(mesh.line_layers[layer], GL_LEQUAL, true, false);
  }

  void draw_lines(const VertexRange& range, GLenum depth, bool write, bool ghosted) {
    if (range.count == 0) return;
    blend_over();
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(depth);
    // Only opaque lines occlude what is drawn later.
    gl.DepthMask(write ? GL_TRUE : GL_FALSE);
    set(line, "ghost", ghosted ? 1 : 0);
    draw(lines, range);
    gl.DepthMask(GL_TRUE);
    gl.Disable(GL_BLEND);
  }

  /// The faces come in painting order (back_to_front()), so that one pass blends all layers.
  void draw_translucent(const ScreenMesh& mesh) {
    const auto layer = static_cast<std::size_t>(Layer::translucent);
    blend_over();
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    // Test against opaque faces, but do not write: translucent faces must not occlude each other.
    gl.DepthMask(GL_FALSE);
    gl.UseProgram(face);
    draw(faces, mesh.face_layers[layer]);
    gl.DepthMask(GL_TRUE);
    draw_lines(mesh.line_layers[layer], GL_LEQUAL, false, false);
  }

  /// Hidden parts are drawn first, ghosted, then visible ones.
  void draw_on_top(const ScreenMesh& mesh) {
    const auto layer = static_cast<std::size_t>(Layer::on_top);
    blend_over();
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_FALSE);
    // The reversed depth test selects the hidden fragments.
    for (const bool hidden : {true, false}) {
      gl.DepthFunc(hidden ? GL_GREATER : GL_LEQUAL);
      set(ghost, "strength", hidden ? kGhostStrength : kFullStrength);
      draw(faces, mesh.face_layers[layer]);
    }
    for (const bool hidden : {true, false})
      draw_lines(mesh.line_layers[layer], hidden ? GL_GREATER : GL_LEQUAL, false, hidden);
  }

  Image draw_list(const DrawList& list, const Camera& camera, const RasterOptions& options) {
    const int n = options.supersample;
    if (n < 1 || n > 4) throw InputError("supersampling must be 1 to 4 samples per pixel and axis");
    // Step 1: project everything at the resolution of the samples.
    check_size(options.width * n, options.height * n);
    const CurrentContext current(context);
    const Projection projection(camera, options.width * n, options.height * n, bounds(list));
    const ScreenMesh mesh =
        make_screen_mesh(list, projection, n * options.unit, options.lighting, options.even_edges);
    // Step 2: targets and buffers.
    resize(options.width * n, options.height * n);
    upload(faces, mesh.faces);
    upload(lines, mesh.lines);
    begin(scene, width, height);
    // Step 3: the layers, from back to front.
    const Rgba back = options.background ? with_alpha(*options.background, 255) : kTransparent;
    gl.ClearBufferfv(GL_COLOR, 0, glm::value_ptr(to_unit(back)));
    gl.UseProgram(face);
    draw_fills(mesh, true);
    draw_opaque(mesh);
    draw_translucent(mesh);
    draw_on_top(mesh);
    // Step 4: read the samples and average them.
    samples.resize(static_cast<std::size_t>(width) * height * 4);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, samples.data());
    context.check("drawing");
    return downsample(samples, options.width, options.height, n);
  }

  /// Begins a pass in which each pixel belongs to one face, for its id or its depth. The context must be
  /// current. The target must outlive the pass.
  std::pair<ScreenMesh, Target> begin_faces(const DrawList& list, const Camera& camera, int w, int h) {
    check_size(w, h);
    const Projection projection(camera, w, h, bounds(list));
    std::pair<ScreenMesh, Target> out{make_screen_mesh(list, projection, 1),
                                      scene_target(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, w, h)};
    upload(faces, out.first.faces);
    begin(out.second, w, h);
    gl.UseProgram(id);
    gl.DepthFunc(GL_LESS);
    return out;
  }

  /// Returns the pixels row by row from the top. OpenGL's rows begin at the bottom.
  template <class T>
  std::vector<T> read(GLenum format, GLenum type, int w, int h) {
    std::vector<T> rows(static_cast<std::size_t>(w) * h), out;
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, w, h, format, type, rows.data());
    context.check("drawing faces");
    for (auto end = rows.end(); end != rows.begin(); end -= w) out.insert(out.end(), end - w, end);
    return out;
  }

  IdImage draw_ids(const DrawList& list, const Camera& camera, int w, int h, bool translucent) {
    const CurrentContext current(context);
    const auto [mesh, target] = begin_faces(list, camera, w, h);
    gl.ClearBufferuiv(GL_COLOR, 0, glm::value_ptr(glm::uvec4(kNoId, 0, 0, 0)));
    // Ids are integers: no blending, one sample per pixel.
    draw_fills(mesh, false);
    gl.Enable(GL_DEPTH_TEST);
    draw(faces, mesh.face_layers[static_cast<std::size_t>(Layer::opaque)]);
    if (translucent) draw(faces, mesh.face_layers[static_cast<std::size_t>(Layer::translucent)]);
    return {w, h, read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, w, h)};
  }

  DepthImage draw_depths(const DrawList& list, const Camera& camera, int w, int h) {
    const CurrentContext current(context);
    const auto [mesh, target] = begin_faces(list, camera, w, h);
    gl.Enable(GL_DEPTH_TEST);
    draw(faces, mesh.face_layers[static_cast<std::size_t>(Layer::opaque)]);
    DepthImage out{w, h, read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, w, h)};
    // From OpenGL's window depth in [0, 1] to [-1, 1].
    for (float& depth : out.depths) depth = 2 * depth - 1;
    return out;
  }
};

Rasterizer::Rasterizer() : state_(std::make_unique<State>()) {}
Rasterizer::~Rasterizer() {
  state_->context.make_current();
}

Image Rasterizer::draw(const DrawList& list, const Camera& camera, const RasterOptions& options) {
  Image image = state_->draw_list(list, camera, options);
  if (options.labels && !list.labels.empty()) draw_labels(image, list, camera);
  return image;
}

IdImage Rasterizer::ids(const DrawList& list, const Camera& camera, int width, int height, bool translucent) {
  return state_->draw_ids(list, camera, width, height, translucent);
}

bool DepthImage::shows(const Projection& projection, const Eigen::Vector3d& point, double heights) const {
  const Eigen::Vector3d at = projection.to_screen(projection.to_eye(point));
  const int x = std::clamp(static_cast<int>(at.x()), 0, width - 1),
            y = std::clamp(static_cast<int>(height - at.y()), 0, height - 1);
  return projection.nearer(at.z(), heights) <= this->at(x, y);
}

DepthImage Rasterizer::depths(const DrawList& list, const Camera& camera, int width, int height) {
  return state_->draw_depths(list, camera, width, height);
}

void draw_labels(Image& image, const DrawList& list, const Camera& camera) {
  const Projection projection(camera, image.width(), image.height(), bounds(list));
  for (const DrawLabel& label : list.labels) {
    const std::optional<Eigen::Vector2d> at = projection.to_pixel(label.x);
    if (!at || !(at->cwiseAbs().maxCoeff() < Image::kMaxSide)) continue;
    TextStyle style;
    style.height = label.height;
    style.colour = label.colour;
    style.halo = label.halo;
    style.halo_width = 0.14F * label.height;
    style.align = Align::centre;
    const TextSize size = default_font().measure(label.text, style);
    const int x = static_cast<int>(std::lround(at->x() + label.dx));
    const int y = static_cast<int>(std::lround(at->y() + label.dy)) - size.height / 2;
    default_font().draw(image, label.text, x, y, style);
  }
}

}  // namespace lrb::render
