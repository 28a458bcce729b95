// SPDX-License-Identifier: MIT
#pragma once

#include "render/context/context.h"

#include <GL/glcorearb.h>

namespace sheen::render::gl {

// Every entry point this module calls: type of the pointer, name without its prefix.
#define SHEEN_GL_FUNCTIONS(X)                                          \
  X(PFNGLATTACHSHADERPROC, AttachShader)                               \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                           \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                         \
  X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)                         \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                         \
  X(PFNGLBLENDFUNCPROC, BlendFunc)                                     \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus) \
  X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)         \
  X(PFNGLCLIPCONTROLPROC, ClipControl)                                 \
  X(PFNGLCOLORMASKPROC, ColorMask)                                     \
  X(PFNGLCOMPILESHADERPROC, CompileShader)                             \
  X(PFNGLCREATEBUFFERSPROC, CreateBuffers)                             \
  X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers)                   \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)                             \
  X(PFNGLCREATESHADERPROC, CreateShader)                               \
  X(PFNGLCREATETEXTURESPROC, CreateTextures)                           \
  X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays)                   \
  X(PFNGLCULLFACEPROC, CullFace)                                       \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                             \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                   \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                             \
  X(PFNGLDELETESHADERPROC, DeleteShader)                               \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures)                           \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                   \
  X(PFNGLDEPTHFUNCPROC, DepthFunc)                                     \
  X(PFNGLDEPTHMASKPROC, DepthMask)                                     \
  X(PFNGLDISABLEPROC, Disable)                                         \
  X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                 \
  X(PFNGLDRAWELEMENTSPROC, DrawElements)                               \
  X(PFNGLENABLEPROC, Enable)                                           \
  X(PFNGLENABLEVERTEXARRAYATTRIBPROC, EnableVertexArrayAttrib)         \
  X(PFNGLFRONTFACEPROC, FrontFace)                                     \
  X(PFNGLGENERATETEXTUREMIPMAPPROC, GenerateTextureMipmap)             \
  X(PFNGLGETERRORPROC, GetError)                                       \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                                 \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                     \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                               \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                       \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                                 \
  X(PFNGLGETSTRINGPROC, GetString)                                     \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                                 \
  X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage)                   \
  X(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)                   \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture)         \
  X(PFNGLPATCHPARAMETERIPROC, PatchParameteri)                         \
  X(PFNGLPIXELSTOREIPROC, PixelStorei)                                 \
  X(PFNGLREADPIXELSPROC, ReadPixels)                                   \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                               \
  X(PFNGLTEXTUREBUFFERPROC, TextureBuffer)                             \
  X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)                     \
  X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)                       \
  X(PFNGLTEXTURESTORAGE3DPROC, TextureStorage3D)                       \
  X(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)                     \
  X(PFNGLTEXTURESUBIMAGE3DPROC, TextureSubImage3D)                     \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                                   \
  X(PFNGLVERTEXARRAYATTRIBBINDINGPROC, VertexArrayAttribBinding)       \
  X(PFNGLVERTEXARRAYATTRIBFORMATPROC, VertexArrayAttribFormat)         \
  X(PFNGLVERTEXARRAYATTRIBIFORMATPROC, VertexArrayAttribIFormat)       \
  X(PFNGLVERTEXARRAYBINDINGDIVISORPROC, VertexArrayBindingDivisor)     \
  X(PFNGLVERTEXARRAYELEMENTBUFFERPROC, VertexArrayElementBuffer)       \
  X(PFNGLVERTEXARRAYVERTEXBUFFERPROC, VertexArrayVertexBuffer)         \
  X(PFNGLVIEWPORTPROC, Viewport)

/// OpenGL as one context offers it. Objects keep a reference to the table they were made through.
struct Functions {
#define SHEEN_GL_MEMBER(type, name) type name = nullptr;
  SHEEN_GL_FUNCTIONS(SHEEN_GL_MEMBER)
#undef SHEEN_GL_MEMBER
};

/// Makes the context current and fills the table. Throws core::Error (run_failed) naming the first
/// entry point the context lacks.
Functions load_functions(Context& context);

/// Value of an integer limit such as GL_MAX_TEXTURE_SIZE; the context is current.
GLint integer_limit(const Functions& gl, GLenum name);

/// Whether the CPU draws (Mesa's rasterisers); the context is current.
bool is_software(const Functions& gl);

}  // namespace sheen::render::gl
