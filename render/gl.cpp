#include "render/gl.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <thread>
// The functions are loaded at run time; no type of a window system is needed.
#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <sys/mman.h>

#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

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

// OpenGL contexts without a window, from libraries that are loaded when the first context is created: OSMesa
// (Mesa up to 25.0), or EGL with Mesa's software renderer.

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

/// Creates a context of the back end that $LRB_GL names, osmesa or egl, by default of the first of them that
/// works, and makes it current. The first success selects the back end for the process, as two copies of Mesa
/// would share state. Throws EnvironmentError, which names the missing libraries and the packages that
/// contain them.
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

struct GlBackendState {
  std::string name;     ///< "OSMesa", "EGL"
  std::string setting;  ///< the value of $LRB_GL that selects it
  std::string package;  ///< Debian's packages that contain it
  std::string problem;  ///< the reason why its library cannot be loaded; empty: none
  bool used = false;    ///< selected by create_gl_context()
};

/// Returns all back ends. Loads their libraries, but draws nothing.
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

// Functions, shaders and pictures of a context.

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
    throw EnvironmentError("OpenGL cannot compile the shader '" + name + "': " + log.data());
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
    gl.DeleteShader(shader);  // is kept until the program is deleted
  }
  gl.LinkProgram(program);
  GLint ok = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == 0) {
    std::array<char, 1024> log{};
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw EnvironmentError("OpenGL cannot link the shader '" + name + "': " + log.data());
  }
  return program;
}

namespace {

/// Returns the address space, in bytes, that Mesa takes until it has drawn its first picture: its libraries,
/// two threads for each of llvmpipe's and two more, each with a stack and a glibc arena, and the code
/// compiled by LLVM.
std::size_t mesas_address_space() {
  constexpr std::size_t kMiB = std::size_t{1} << 20, kStack = 8 * kMiB, kArena = 64 * kMiB,
                        kLibraries = 200 * kMiB, kRest = 100 * kMiB;
  constexpr std::size_t kMaxRasterThreads = 32, kArenasPerCore = 8;
  // llvmpipe's default number of threads, unless the environment sets it.
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const char* given = std::getenv("LP_NUM_THREADS");
  const std::size_t raster =
      given != nullptr ? static_cast<std::size_t>(std::max(0L, std::strtol(given, nullptr, 10))) : cores;
  const std::size_t threads = 2 * std::min(raster, kMaxRasterThreads) + 2;
  return threads * kStack + std::min(threads, kArenasPerCore * cores) * kArena + kLibraries + kRest;
}

/// Throws EnvironmentError if a limit leaves less address space than that: LLVM crashes if its allocations
/// fail.
void require_address_space() {
  const std::size_t needed = mesas_address_space();
  // Reserve without committing: this tests the limit and costs no memory.
  void* const room = mmap(nullptr, needed, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED)
    throw EnvironmentError("expected at least " + std::to_string(needed >> 20) +
                           " MiB of address space for drawing, found less; raise the limit (ulimit -v), or "
                           "set LP_NUM_THREADS=1, which needs less");
  munmap(room, needed);
}

}  // namespace

Offscreen::Offscreen() {
  // Settings that crash Mesa must be found before a context exists.
  for (const Finding& f : check_gl_environment()) {
    if (f.level == Finding::Level::error) throw EnvironmentError(f.what + ": " + f.detail);
  }
  require_address_space();
  context_ = create_gl_context();
#define LRB_GL(TYPE, Name)                                                       \
  gl_.Name = reinterpret_cast<PFNGL##TYPE##PROC>(context_->address("gl" #Name)); \
  if (gl_.Name == nullptr)                                                       \
    throw EnvironmentError("OpenGL has no function gl" #Name "; this version of Mesa is too old");
  LRB_GL_FUNCTIONS(LRB_GL)
#undef LRB_GL
  // A framebuffer is limited by both textures and viewports.
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  gl_.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  max_size_ = std::min({texture, viewport[0], viewport[1]});
}

Offscreen::~Offscreen() = default;

void Offscreen::make_current() const {
  if (!context_->make_current())
    throw EnvironmentError("the off-screen OpenGL context cannot be used on this thread");
}

void Offscreen::release() const {
  context_->release();
}

void Offscreen::check(const char* where) const {
  const GLenum error = gl_.GetError();
  if (error == GL_NO_ERROR) return;
  throw EnvironmentError(std::string("OpenGL failed while ") + where + " (error " + std::to_string(error) +
                         (error == GL_OUT_OF_MEMORY ? ", out of memory: draw a smaller picture)" : ")"));
}

std::string Offscreen::version() const {
  const auto text = [&](GLenum what) {
    const GLubyte* s = gl_.GetString(what);
    return s == nullptr ? std::string("unknown") : std::string(reinterpret_cast<const char*>(s));
  };
  return text(GL_VERSION) + ", " + text(GL_RENDERER);
}

const std::string& gl_version() {
  static const std::string version = [] {
    const Offscreen context;
    std::string text = context.version();
    context.release();
    return text;
  }();
  return version;
}

std::vector<Finding> check_gl_environment() {
  using Level = Finding::Level;
  std::vector<Finding> out;
  const auto value = [](const char* name) {
    const char* v = std::getenv(name);
    return std::string(v == nullptr ? "" : v);
  };
  const std::string driver = value("GALLIUM_DRIVER"), width = value("LP_NATIVE_VECTOR_WIDTH");
  if (!driver.empty() && driver != "llvmpipe" && driver != "softpipe") {
    out.push_back(
        {Level::error, "GALLIUM_DRIVER",
         "is '" + driver + "', which crashes off-screen Mesa; unset it, or use llvmpipe or softpipe"});
  }
  if (driver == "softpipe") {
    out.push_back(
        {Level::warning, "GALLIUM_DRIVER", "is softpipe: pictures are slow and may differ from llvmpipe's"});
  }
  if (!width.empty() && width != "128" && width != "256") {
    out.push_back({Level::error, "LP_NATIVE_VECTOR_WIDTH",
                   "is '" + width + "', which can crash Mesa; unset it, or use 128 or 256"});
  }
  if (!value("MESA_GL_VERSION_OVERRIDE").empty()) {
    out.push_back(
        {Level::warning, "MESA_GL_VERSION_OVERRIDE", "is set; unset it if no context can be created"});
  }
  return out;
}

std::vector<Finding> check_rendering() {
  using Level = Finding::Level;
  std::vector<Finding> out = check_gl_environment();
  try {
    const Offscreen context;
    const std::vector<GlBackendState> backends = gl_backends();
    for (const GlBackendState& b : backends)
      if (b.used) out.push_back({Level::ok, "off-screen OpenGL", b.name + ", " + context.version()});
    for (const GlBackendState& b : backends)
      if (!b.used)
        out.push_back({Level::ok, b.name,
                       b.problem.empty()
                           ? "installed; LRB_GL=" + b.setting + " draws with it"
                           : "cannot be loaded, not needed (" + b.problem + "; Debian's " + b.package + ")"});
    out.push_back({Level::ok, "largest picture", std::to_string(context.max_size()) + " pixels per side"});
  } catch (const EnvironmentError& e) {
    out.push_back({Level::error, "off-screen OpenGL", e.what()});
  }
  for (const bool bold : {false, true}) {
    const char* what = bold ? "bold font" : "font";
    try {
      out.push_back({Level::ok, what, find_font(bold)});
    } catch (const EnvironmentError& e) {
      out.push_back({Level::error, what, e.what()});
    }
  }
  return out;
}

}  // namespace lrb::render
