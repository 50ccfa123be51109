#include "render/gl.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>

#include <sys/mman.h>

#include "render/gl_backend.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

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
