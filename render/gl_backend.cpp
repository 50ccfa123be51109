#include "render/gl_backend.hpp"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <string_view>

// The functions are loaded at run time; no type of a window system is needed.
#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <dlfcn.h>

#include <lrbscope/error.hpp>

// For builds with the leak sanitizer: Mesa never frees about a kilobyte per process.
#ifdef LRB_ADDRESS_SANITIZER
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the sanitizer's name
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\nleak:libEGL\n";
}
extern "C" const char* __lsan_default_options();  // NOLINT: the sanitizer's name
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";  // keep stderr for the program's own output
}
#endif

namespace lrb::render {
namespace {

using Address = GlContext::Address;

/// A library, loaded for the rest of the process.
class Library {
 public:
  /// Throws EnvironmentError with the loader's message.
  explicit Library(const char* file) : file_(file), handle_(dlopen(file, RTLD_LAZY | RTLD_LOCAL)) {
    if (handle_ != nullptr) return;
    const char* const why = dlerror();
    throw EnvironmentError(why == nullptr ? std::string(file) + ": cannot be loaded" : why);
  }

  /// Sets a pointer to a function. Throws EnvironmentError if the library does not have it.
  template <class Function>
  void get(Function& function, const char* name) const {
    set(function, name, dlsym(handle_, name));
  }
  /// Does so with an address that an extension's loader returned.
  template <class Function>
  void set(Function& function, const char* name, void* address) const {
    function = reinterpret_cast<Function>(address);
    if (function == nullptr)
      throw EnvironmentError(std::string(file_) + ": has no function " + name +
                             ", so its version is too old");
  }

 private:
  const char* file_;
  void* handle_;
};

// ---- OSMesa

constexpr const char* kOsmesaFile = "libOSMesa.so.8";

/// The part of <GL/osmesa.h> that is used here: distributions without OSMesa lack this header.
struct Osmesa {
  using Context = struct Opaque*;
  static constexpr int kFormat = 0x22, kDepthBits = 0x30, kStencilBits = 0x31, kProfile = 0x33,
                       kCoreProfile = 0x34, kMajorVersion = 0x36, kMinorVersion = 0x37;

  Context (*create)(const int* attributes, Context sharing) = nullptr;
  void (*destroy)(Context) = nullptr;
  GLboolean (*make_current)(Context, void* buffer, GLenum type, GLsizei width, GLsizei height) = nullptr;
  Address (*address)(const char* function) = nullptr;

  Osmesa() {
    const Library library(kOsmesaFile);
    library.get(create, "OSMesaCreateContextAttribs");
    library.get(destroy, "OSMesaDestroyContext");
    library.get(make_current, "OSMesaMakeCurrent");
    library.get(address, "OSMesaGetProcAddress");
  }
  static const Osmesa& get() {
    static const Osmesa loaded;
    return loaded;
  }
};

class OsmesaContext : public GlContext {
 public:
  OsmesaContext() {
    const int attributes[] = {Osmesa::kFormat,
                              GL_RGBA,
                              Osmesa::kDepthBits,
                              0,
                              Osmesa::kStencilBits,
                              0,
                              Osmesa::kProfile,
                              Osmesa::kCoreProfile,
                              Osmesa::kMajorVersion,
                              3,
                              Osmesa::kMinorVersion,
                              3,
                              0};
    handle_ = library_.create(attributes, nullptr);
    if (handle_ == nullptr)
      throw EnvironmentError(std::string(kOsmesaFile) + ": cannot create a context of OpenGL 3.3");
  }
  ~OsmesaContext() override {
    OsmesaContext::release();
    library_.destroy(handle_);
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  bool make_current() override {
    return library_.make_current(handle_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_TRUE;
  }
  void release() override { library_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  Address address(const char* function) const override { return library_.address(function); }

 private:
  /// OSMesa needs a buffer of pixels to make a context current.
  static constexpr int kSide = 16;

  const Osmesa& library_ = Osmesa::get();
  Osmesa::Context handle_ = nullptr;
  std::array<std::uint8_t, kSide * kSide * 4> buffer_{};
};

// ---- EGL

constexpr const char* kEglFile = "libEGL.so.1";

/// The functions of EGL, and Mesa's software renderer as a display. Graphics cards are not used: pictures
/// would depend on their drivers.
struct Egl {
  PFNEGLGETPROCADDRESSPROC address = nullptr;
  PFNEGLGETERRORPROC error = nullptr;
  PFNEGLBINDAPIPROC bind_api = nullptr;
  PFNEGLCREATECONTEXTPROC create = nullptr;
  PFNEGLDESTROYCONTEXTPROC destroy = nullptr;
  PFNEGLMAKECURRENTPROC make_current = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;

  Egl() {
    const Library library(kEglFile);
    library.get(address, "eglGetProcAddress");
    library.get(error, "eglGetError");
    library.get(bind_api, "eglBindAPI");
    library.get(create, "eglCreateContext");
    library.get(destroy, "eglDestroyContext");
    library.get(make_current, "eglMakeCurrent");
    PFNEGLINITIALIZEPROC initialize = nullptr;
    library.get(initialize, "eglInitialize");
    // EGL_EXT_device_enumeration, EGL_EXT_device_query, EGL_EXT_platform_base.
    const auto get_extension = [&](auto& function, const char* name) {
      library.set(function, name, reinterpret_cast<void*>(address(name)));
    };
    PFNEGLQUERYDEVICESEXTPROC devices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC device_string = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display = nullptr;
    get_extension(devices, "eglQueryDevicesEXT");
    get_extension(device_string, "eglQueryDeviceStringEXT");
    get_extension(platform_display, "eglGetPlatformDisplayEXT");
    // The display of the device that renders in software.
    std::array<EGLDeviceEXT, 64> found{};
    EGLint count = 0;
    if (devices(static_cast<EGLint>(found.size()), found.data(), &count) != EGL_TRUE) count = 0;
    for (EGLint i = 0; i < count && display == EGL_NO_DISPLAY; ++i) {
      EGLDeviceEXT const device = found.at(static_cast<std::size_t>(i));
      const char* const extensions = device_string(device, EGL_EXTENSIONS);
      if (extensions != nullptr &&
          std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos)
        display = platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    }
    if (display == EGL_NO_DISPLAY)
      throw EnvironmentError(std::string(kEglFile) + ": has no software renderer of Mesa");
    if (initialize(display, nullptr, nullptr) != EGL_TRUE) fail("cannot start Mesa's software renderer");
  }
  static const Egl& get() {
    static const Egl loaded;
    return loaded;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw EnvironmentError(std::string(kEglFile) + ": " + what + " (EGL error " + std::to_string(error()) +
                           ")");
  }
};

class EglContext : public GlContext {
 public:
  EglContext() {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    library_.bind_api(EGL_OPENGL_API);  // a state of the thread
    handle_ = library_.create(library_.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (handle_ == EGL_NO_CONTEXT) library_.fail("cannot create a context of OpenGL 3.3");
  }
  ~EglContext() override {
    EglContext::release();
    library_.destroy(library_.display, handle_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  bool make_current() override {
    return library_.make_current(library_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, handle_) == EGL_TRUE;
  }
  void release() override {
    library_.bind_api(EGL_OPENGL_API);
    library_.make_current(library_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  Address address(const char* function) const override { return library_.address(function); }

 private:
  const Egl& library_ = Egl::get();
  EGLContext handle_ = EGL_NO_CONTEXT;
};

// ---- selection

struct Backend {
  const char* name;
  const char* setting;
  const char* file;
  const char* package;
  std::unique_ptr<GlContext> (*create)();
};

template <class Context>
std::unique_ptr<GlContext> create() {
  return std::make_unique<Context>();
}

/// In the order in which they are tried.
constexpr std::array kBackends = {
    Backend{"OSMesa", "osmesa", kOsmesaFile, "libosmesa6", create<OsmesaContext>},
    Backend{"EGL", "egl", kEglFile, "libegl1 and libgl1-mesa-dri", create<EglContext>}};

std::mutex selecting;
const Backend* selected = nullptr;  ///< guarded by `selecting`

}  // namespace

std::unique_ptr<GlContext> create_gl_context() {
  const std::lock_guard lock(selecting);
  const char* const given = std::getenv("LRB_GL");
  const std::string wish = given == nullptr ? "" : given;
  std::string problems, packages;
  for (const Backend& b : kBackends) {
    if (selected != nullptr ? &b != selected : !wish.empty() && wish != b.setting) continue;
    try {
      std::unique_ptr<GlContext> context = b.create();
      if (!context->make_current())
        throw EnvironmentError(std::string(b.file) + ": its context cannot be used");
      selected = &b;
      return context;
    } catch (const EnvironmentError& e) {
      problems += (problems.empty() ? "" : "; ") + std::string(e.what());
      packages += (packages.empty() ? "" : ", or ") + std::string(b.package);
    }
  }
  if (problems.empty()) throw EnvironmentError("LRB_GL: expected osmesa or egl, found '" + wish + "'");
  throw EnvironmentError("drawing needs " + (wish.empty() ? "OSMesa or EGL" : "LRB_GL=" + wish) +
                         ", found none that works (" + problems + "); install Debian's " + packages +
                         (wish.empty() ? "" : ", or unset LRB_GL"));
}

std::vector<GlBackendState> gl_backends() {
  const std::lock_guard lock(selecting);
  std::vector<GlBackendState> out;
  for (const Backend& b : kBackends) {
    out.push_back({b.name, b.setting, b.package, "", &b == selected});
    try {
      Library{b.file};
    } catch (const EnvironmentError& e) {
      out.back().problem = e.what();
    }
  }
  return out;
}

}  // namespace lrb::render
