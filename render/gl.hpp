#pragma once
/// The functions of OpenGL 3.3 core used by render, loaded at run time.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <GL/glcorearb.h>

namespace lrb::render {

/// LRB_GL(pointer type without PFNGL and PROC, function name without gl)
#define LRB_GL_FUNCTIONS(LRB_GL)                           \
  LRB_GL(ATTACHSHADER, AttachShader)                       \
  LRB_GL(BINDBUFFER, BindBuffer)                           \
  LRB_GL(BINDFRAMEBUFFER, BindFramebuffer)                 \
  LRB_GL(BINDTEXTURE, BindTexture)                         \
  LRB_GL(BINDVERTEXARRAY, BindVertexArray)                 \
  LRB_GL(BLENDFUNCSEPARATE, BlendFuncSeparate)             \
  LRB_GL(BUFFERDATA, BufferData)                           \
  LRB_GL(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)   \
  LRB_GL(CLEARBUFFERFI, ClearBufferfi)                     \
  LRB_GL(CLEARBUFFERFV, ClearBufferfv)                     \
  LRB_GL(CLEARBUFFERUIV, ClearBufferuiv)                   \
  LRB_GL(COLORMASK, ColorMask)                             \
  LRB_GL(COMPILESHADER, CompileShader)                     \
  LRB_GL(CREATEPROGRAM, CreateProgram)                     \
  LRB_GL(CREATESHADER, CreateShader)                       \
  LRB_GL(DELETEBUFFERS, DeleteBuffers)                     \
  LRB_GL(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
  LRB_GL(DELETEPROGRAM, DeleteProgram)                     \
  LRB_GL(DELETESHADER, DeleteShader)                       \
  LRB_GL(DELETETEXTURES, DeleteTextures)                   \
  LRB_GL(DELETEVERTEXARRAYS, DeleteVertexArrays)           \
  LRB_GL(DEPTHFUNC, DepthFunc)                             \
  LRB_GL(DEPTHMASK, DepthMask)                             \
  LRB_GL(DISABLE, Disable)                                 \
  LRB_GL(DRAWARRAYS, DrawArrays)                           \
  LRB_GL(ENABLE, Enable)                                   \
  LRB_GL(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  LRB_GL(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)       \
  LRB_GL(GENBUFFERS, GenBuffers)                           \
  LRB_GL(GENFRAMEBUFFERS, GenFramebuffers)                 \
  LRB_GL(GENTEXTURES, GenTextures)                         \
  LRB_GL(GENVERTEXARRAYS, GenVertexArrays)                 \
  LRB_GL(GETERROR, GetError)                               \
  LRB_GL(GETINTEGERV, GetIntegerv)                         \
  LRB_GL(GETPROGRAMINFOLOG, GetProgramInfoLog)             \
  LRB_GL(GETPROGRAMIV, GetProgramiv)                       \
  LRB_GL(GETSHADERINFOLOG, GetShaderInfoLog)               \
  LRB_GL(GETSHADERIV, GetShaderiv)                         \
  LRB_GL(GETSTRING, GetString)                             \
  LRB_GL(GETUNIFORMLOCATION, GetUniformLocation)           \
  LRB_GL(LINKPROGRAM, LinkProgram)                         \
  LRB_GL(PIXELSTOREI, PixelStorei)                         \
  LRB_GL(READPIXELS, ReadPixels)                           \
  LRB_GL(SHADERSOURCE, ShaderSource)                       \
  LRB_GL(STENCILFUNC, StencilFunc)                         \
  LRB_GL(STENCILOP, StencilOp)                             \
  LRB_GL(TEXIMAGE2D, TexImage2D)                           \
  LRB_GL(TEXPARAMETERI, TexParameteri)                     \
  LRB_GL(UNIFORM1I, Uniform1i)                             \
  LRB_GL(USEPROGRAM, UseProgram)                           \
  LRB_GL(VERTEXATTRIBIPOINTER, VertexAttribIPointer)       \
  LRB_GL(VERTEXATTRIBPOINTER, VertexAttribPointer)         \
  LRB_GL(VIEWPORT, Viewport)

struct Gl {
#define LRB_GL(TYPE, Name) PFNGL##TYPE##PROC Name = nullptr;
  LRB_GL_FUNCTIONS(LRB_GL)
#undef LRB_GL
};

// OpenGL objects that delete themselves, and operations on them.

/// OpenGL's name (number) of an object, with the function that deletes it.
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
  operator GLuint() const { return name_; }  // NOLINT: used as the number in every call

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
/// Calls glDelete*(1, &name), for all kinds of objects with a delete function of this type.
struct DeleteOne {
  PFNGLDELETETEXTURESPROC f = nullptr;
  void operator()(GLuint name) const { f(1, &name); }
};

using GlProgram = GlName<DeleteProgram>;
using GlObject = GlName<DeleteOne>;

/// Makes an object by glGen*(), to be deleted by its glDelete*().
inline GlObject make_object(PFNGLGENTEXTURESPROC generate, PFNGLDELETETEXTURESPROC remove) {
  GLuint name = 0;
  generate(1, &name);
  return {name, {remove}};
}
/// Compiles and links a program. Throws EnvironmentError with the driver's log.
GlProgram make_program(const Gl& gl, const std::string& name, const std::string& vertex,
                       const std::string& fragment);

// An OpenGL 3.3 core context without a window.

class GlContext;

class Offscreen {
 public:
  /// Creates a context and makes it current on the calling thread. Throws EnvironmentError, which names the
  /// missing part. Environment settings known to crash Mesa are rejected first.
  Offscreen();
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// Makes the context current on the calling thread. It must not be current on another thread.
  void make_current() const;
  /// Lets another thread make the context current.
  void release() const;
  const Gl& gl() const { return gl_; }
  /// Throws EnvironmentError if a call failed since the last check; `where` names the location in the
  /// message.
  void check(const char* where) const;
  int max_size() const { return max_size_; }  ///< maximum side of a picture, pixels
  std::string version() const;                ///< version and renderer as reported by OpenGL

 private:
  std::unique_ptr<GlContext> context_;
  Gl gl_;
  int max_size_ = 0;
};

/// Makes a context current on the calling thread during its own lifetime.
class CurrentContext {
 public:
  explicit CurrentContext(const Offscreen& context) : context_(context) { context_.make_current(); }
  ~CurrentContext() { context_.release(); }
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  const Offscreen& context_;
};

/// Returns the version and renderer of OpenGL, such as "4.5 (Compatibility Profile) Mesa 22.3.6, llvmpipe
/// (LLVM 15.0.6, 256 bits)". Throws EnvironmentError if nothing can be drawn.
const std::string& gl_version();

/// One result of checking the environment.
struct Finding {
  enum class Level { ok, warning, error } level = Level::ok;
  std::string what;    ///< "off-screen OpenGL", "font", ...
  std::string detail;  ///< a version, a size; or the problem and its remedy
};

/// Checks for environment variables that make Mesa crash or behave differently. Needs no context.
std::vector<Finding> check_gl_environment();

/// Checks everything that drawing needs: environment, context, sizes, fonts. Reports problems as findings and
/// does not throw.
std::vector<Finding> check_rendering();

}  // namespace lrb::render
