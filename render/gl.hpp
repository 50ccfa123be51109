#pragma once
/// The functions of OpenGL 3.3 core that we use, loaded at run time: whoever makes the context
/// (offscreen.hpp) chooses the library that provides them, and nothing else links one.

#include <GL/glcorearb.h>

namespace lrb::render {

/// LRB_GL(type of the pointer without PFNGL and PROC, name of the function without gl)
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

}  // namespace lrb::render
