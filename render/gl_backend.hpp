#pragma once
/// OpenGL contexts without a window, from libraries that are loaded when the first context is created: OSMesa
/// (Mesa up to 25.0), or EGL with Mesa's software renderer.

#include <memory>
#include <string>
#include <vector>

namespace lrb::render {

/// An OpenGL 3.3 core context. Pixels are drawn into framebuffer objects: a context has no surface that
/// matters.
class GlContext {
 public:
  using Address = void (*)();

  virtual ~GlContext() = default;
  /// Makes the context current on the calling thread. Returns false if it is current on another one.
  virtual bool make_current() = 0;
  /// Leaves the calling thread without a current context, so that another thread may use this one.
  virtual void release() = 0;
  /// Returns the address of a function, or nullptr.
  virtual Address address(const char* function) const = 0;
};

/// Creates a context of the back end that $LRB_GL names, osmesa or egl, by default of the first of them that
/// works, and makes it current. The first success selects the back end for the process, as two copies of Mesa
/// would share state. Throws EnvironmentError, which names the missing libraries and the packages that
/// contain them.
std::unique_ptr<GlContext> create_gl_context();

struct GlBackendState {
  std::string name;     ///< "OSMesa", "EGL"
  std::string setting;  ///< the value of $LRB_GL that selects it
  std::string package;  ///< Debian's packages that contain it
  std::string problem;  ///< the reason why its library cannot be loaded; empty: none
  bool used = false;    ///< selected by create_gl_context()
};

/// Returns all back ends. Loads their libraries, but draws nothing.
std::vector<GlBackendState> gl_backends();

}  // namespace lrb::render
