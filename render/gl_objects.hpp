#pragma once
/// OpenGL objects that free themselves, and the few things we do with them.

#include <cstddef>
#include <string>
#include <utility>

#include "render/gl.hpp"

namespace lrb::render {

/// The number by which OpenGL knows an object, with the function that deletes it.
template <class Delete>
class GlName {
 public:
  GlName() = default;
  GlName(GLuint name, Delete remove) : name_(name), remove_(std::move(remove)) {}
  GlName(GlName&& o) noexcept : name_(std::exchange(o.name_, 0)), remove_(o.remove_) {}
  GlName& operator=(GlName&& o) noexcept {
    if (this != &o) {
      clear();
      name_ = std::exchange(o.name_, 0);
      remove_ = o.remove_;
    }
    return *this;
  }
  ~GlName() { clear(); }
  operator GLuint() const { return name_; }  // NOLINT: it stands for the number in every call

 private:
  void clear() {
    if (name_ != 0) remove_(name_);
    name_ = 0;
  }
  GLuint name_ = 0;
  Delete remove_{};
};

struct DeleteProgram {
  PFNGLDELETEPROGRAMPROC f = nullptr;
  void operator()(GLuint name) const { f(name); }
};
/// Calls glDelete*(1, &name), for all kinds whose function has this type.
struct DeleteOne {
  PFNGLDELETETEXTURESPROC f = nullptr;
  void operator()(GLuint name) const { f(1, &name); }
};

using GlProgram = GlName<DeleteProgram>;
using GlObject = GlName<DeleteOne>;

inline GlObject make_texture(const Gl& gl) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  return {name, {gl.DeleteTextures}};
}
inline GlObject make_framebuffer(const Gl& gl) {
  GLuint name = 0;
  gl.GenFramebuffers(1, &name);
  return {name, {gl.DeleteFramebuffers}};
}
inline GlObject make_buffer(const Gl& gl) {
  GLuint name = 0;
  gl.GenBuffers(1, &name);
  return {name, {gl.DeleteBuffers}};
}
inline GlObject make_vertex_array(const Gl& gl) {
  GLuint name = 0;
  gl.GenVertexArrays(1, &name);
  return {name, {gl.DeleteVertexArrays}};
}
/// Compiles and links a program; throws EnvironmentError with the library's log.
GlProgram make_program(const Gl& gl, const std::string& name, const std::string& vertex,
                       const std::string& fragment);

}  // namespace lrb::render
