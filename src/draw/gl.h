/* gl.h - the OpenGL functions that the drawing room calls, loaded at run time.
 *
 * The program links no GL library: a canvas opens OSMesa or EGL and asks it for every function of
 * the one list below.  They are called as gl.DrawArrays(...); `gl` holds those of the context that
 * is current on this thread, and canvas_begin() keeps the two together.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GL_H
#define GL_H

#include "base/error.h"

#include <GL/glcorearb.h>
#include <stdbool.h>

/* X(name, type of the function's address) */
#define GL_FUNCTIONS(X)                                                                 \
    X(GetString, PFNGLGETSTRINGPROC)                                                    \
    X(GetIntegerv, PFNGLGETINTEGERVPROC)                                                \
    X(GetError, PFNGLGETERRORPROC)                                                      \
    X(Enable, PFNGLENABLEPROC)                                                          \
    X(Disable, PFNGLDISABLEPROC)                                                        \
    X(BlendFunc, PFNGLBLENDFUNCPROC)                                                    \
    X(BlendFuncSeparate, PFNGLBLENDFUNCSEPARATEPROC)                                    \
    X(ClearColor, PFNGLCLEARCOLORPROC)                                                  \
    X(Clear, PFNGLCLEARPROC)                                                            \
    X(Viewport, PFNGLVIEWPORTPROC)                                                      \
    X(Scissor, PFNGLSCISSORPROC)                                                        \
    X(Finish, PFNGLFINISHPROC)                                                          \
    X(ReadPixels, PFNGLREADPIXELSPROC)                                                  \
    X(PixelStorei, PFNGLPIXELSTOREIPROC)                                                \
    X(GenBuffers, PFNGLGENBUFFERSPROC)                                                  \
    X(DeleteBuffers, PFNGLDELETEBUFFERSPROC)                                            \
    X(BindBuffer, PFNGLBINDBUFFERPROC)                                                  \
    X(BufferData, PFNGLBUFFERDATAPROC)                                                  \
    X(BufferSubData, PFNGLBUFFERSUBDATAPROC)                                            \
    X(GenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                                        \
    X(DeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)                                  \
    X(BindVertexArray, PFNGLBINDVERTEXARRAYPROC)                                        \
    X(EnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC)                        \
    X(VertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC)                                \
    X(VertexAttribIPointer, PFNGLVERTEXATTRIBIPOINTERPROC)                              \
    X(VertexAttribDivisor, PFNGLVERTEXATTRIBDIVISORPROC)                                \
    X(DrawArrays, PFNGLDRAWARRAYSPROC)                                                  \
    X(DrawArraysInstanced, PFNGLDRAWARRAYSINSTANCEDPROC)                                \
    X(DrawElements, PFNGLDRAWELEMENTSPROC)                                              \
    X(CreateShader, PFNGLCREATESHADERPROC)                                              \
    X(DeleteShader, PFNGLDELETESHADERPROC)                                              \
    X(ShaderSource, PFNGLSHADERSOURCEPROC)                                              \
    X(CompileShader, PFNGLCOMPILESHADERPROC)                                            \
    X(GetShaderiv, PFNGLGETSHADERIVPROC)                                                \
    X(GetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)                                      \
    X(CreateProgram, PFNGLCREATEPROGRAMPROC)                                            \
    X(DeleteProgram, PFNGLDELETEPROGRAMPROC)                                            \
    X(AttachShader, PFNGLATTACHSHADERPROC)                                              \
    X(LinkProgram, PFNGLLINKPROGRAMPROC)                                                \
    X(GetProgramiv, PFNGLGETPROGRAMIVPROC)                                              \
    X(GetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)                                    \
    X(UseProgram, PFNGLUSEPROGRAMPROC)                                                  \
    X(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)                                  \
    X(Uniform1i, PFNGLUNIFORM1IPROC)                                                    \
    X(Uniform1f, PFNGLUNIFORM1FPROC)                                                    \
    X(Uniform2f, PFNGLUNIFORM2FPROC)                                                    \
    X(Uniform3f, PFNGLUNIFORM3FPROC)                                                    \
    X(Uniform4f, PFNGLUNIFORM4FPROC)                                                    \
    X(GenTextures, PFNGLGENTEXTURESPROC)                                                \
    X(DeleteTextures, PFNGLDELETETEXTURESPROC)                                          \
    X(BindTexture, PFNGLBINDTEXTUREPROC)                                                \
    X(ActiveTexture, PFNGLACTIVETEXTUREPROC)                                            \
    X(TexImage2D, PFNGLTEXIMAGE2DPROC)                                                  \
    X(TexSubImage2D, PFNGLTEXSUBIMAGE2DPROC)                                            \
    X(TexParameteri, PFNGLTEXPARAMETERIPROC)                                            \
    X(GenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                                        \
    X(DeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)                                  \
    X(BindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                                        \
    X(FramebufferTexture2D, PFNGLFRAMEBUFFERTEXTURE2DPROC)                              \
    X(CheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)

struct gl_functions {
#define X(name, type) type name;
    GL_FUNCTIONS(X)
#undef X
};

extern _Thread_local struct gl_functions gl;

typedef void (*gl_address)(void);       /* any function; called only after conversion */

/* Asks `find` for every function; the error names the first that is missing. */
bool gl_load(struct gl_functions *functions, gl_address (*find)(const char *name),
             struct error *error);

/* A program of two embedded shaders ("shaders/grain.vert"); 0 with the compiler's words in the
 * error.  The caller deletes it. */
GLuint gl_program(const char *vertex_asset, const char *fragment_asset, struct error *error);

#endif
