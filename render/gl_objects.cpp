#include "render/gl_objects.hpp"

#include <array>

#include "engine/core/error.hpp"

namespace lrb::render {
namespace {

GLuint compile(const Gl& gl, const std::string& name, GLenum kind, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == 0) {
    std::array<char, 1024> log{};
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    gl.DeleteShader(shader);
    throw EnvironmentError("OpenGL does not compile our shader '" + name + "': " + log.data());
  }
  return shader;
}

}  // namespace

GlProgram make_program(const Gl& gl, const std::string& name, const std::string& vertex,
                       const std::string& fragment) {
  GlProgram program(gl.CreateProgram(), {gl.DeleteProgram});
  for (const GLuint shader : {compile(gl, name + ".vertex", GL_VERTEX_SHADER, vertex),
                              compile(gl, name + ".fragment", GL_FRAGMENT_SHADER, fragment)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // stays until the program is deleted
  }
  gl.LinkProgram(program);
  GLint ok = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == 0) {
    std::array<char, 1024> log{};
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw EnvironmentError("OpenGL does not link our shader '" + name + "': " + log.data());
  }
  return program;
}

}  // namespace lrb::render
