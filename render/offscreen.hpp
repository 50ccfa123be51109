#pragma once
/// An OpenGL 3.3 core context without a window. Only offscreen.cpp knows that it is Mesa's OSMesa: a context
/// from EGL (surfaceless) could replace it by filling in the same table of functions. (Mesa 25.1 removed
/// OSMesa.)

#include <memory>
#include <string>
#include <vector>

#include "render/gl.hpp"

namespace lrb::render {

class Offscreen {
 public:
  /// Makes a context and makes it current on the calling thread. Throws EnvironmentError that says what is
  /// missing; first refuses settings in the environment that are known to crash Mesa.
  Offscreen();
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// Makes the context current on the calling thread.
  void make_current() const;
  const Gl& gl() const { return gl_; }
  /// Throws EnvironmentError if a call failed since the last check; `where` names the place in the message.
  void check(const char* where) const;
  int max_size() const { return max_size_; }  ///< largest side of a picture, pixels
  std::string version() const;                ///< version and renderer as the library names them

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  Gl gl_;
  int max_size_ = 0;
};

/// One result of checking the environment.
struct Finding {
  enum class Level { ok, warning, error } level = Level::ok;
  std::string what;    ///< "off-screen OpenGL", "font", ...
  std::string detail;  ///< a version, a size; or what is wrong and what to do
};

/// Checks for environment variables that make Mesa crash or behave differently. Needs no context.
std::vector<Finding> check_gl_environment();

/// Checks everything that drawing needs: environment, context, sizes, fonts. Reports what it finds and does
/// not throw for it.
std::vector<Finding> check_rendering();

}  // namespace lrb::render
