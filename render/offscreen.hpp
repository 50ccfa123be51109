#pragma once
/// An OpenGL 3.3 core context without a window. Only offscreen.cpp knows that it is Mesa's OSMesa: a context
/// from EGL (surfaceless) can take its place by filling in the same table of functions. (Mesa 25.1 removed
/// OSMesa.)

#include <memory>
#include <string>
#include <vector>

#include "render/gl.hpp"

namespace lrb::render {

class Offscreen {
 public:
  /// Makes a context and makes it current on the calling thread. Throws EnvironmentError saying what is
  /// missing; refuses first the environment settings that are known to crash Mesa.
  Offscreen();
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// The context, on the calling thread.
  void make_current() const;
  const Gl& gl() const { return gl_; }
  /// Throws EnvironmentError if a call since the last check failed; `where` names it.
  void check(const char* where) const;
  int max_size() const { return max_size_; }  ///< largest side of a picture, pixels
  std::string version() const;                ///< version and renderer as the library names them

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  Gl gl_;
  int max_size_ = 0;
};

/// One result of a look at the environment.
struct Finding {
  enum class Level { ok, warning, error } level = Level::ok;
  std::string what;    ///< "off-screen OpenGL", "font", ...
  std::string detail;  ///< a version, a size; or what is wrong and what to do
};

/// Environment variables that make Mesa crash or behave differently. Needs no context.
std::vector<Finding> check_gl_environment();

/// Everything drawing needs: environment, context, sizes, fonts. Never throws for what it finds.
std::vector<Finding> check_rendering();

}  // namespace lrb::render
