/* gl.c - see gl.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/gl.h"

#include "base/asset.h"

#include <assert.h>

_Thread_local struct gl_functions gl;

bool gl_load(struct gl_functions *functions, gl_address (*find)(const char *name),
             struct error *error)
{
#define X(name, type)                                                                       \
    functions->name = (type)find("gl" #name);                                               \
    if (!functions->name) return error_set(error, "this OpenGL lacks the function gl%s", #name);
    GL_FUNCTIONS(X)
#undef X
    return true;
}

static GLuint shader_compile(GLenum kind, const char *name, struct error *error)
{
    const struct asset *asset = asset_find(name);
    assert(asset);
    const GLuint shader = gl.CreateShader(kind);
    const GLchar *text = (const GLchar *)asset->bytes;
    const GLint size = (GLint)asset->size;
    gl.ShaderSource(shader, 1, &text, &size);
    gl.CompileShader(shader);
    GLint done = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done) return shader;
    char words[600] = "";
    gl.GetShaderInfoLog(shader, sizeof words, NULL, words);
    gl.DeleteShader(shader);
    error_set(error, "%s: this OpenGL does not compile it: %s", name, words);
    return 0;
}

GLuint gl_program(const char *vertex_asset, const char *fragment_asset, struct error *error)
{
    const GLuint vertex = shader_compile(GL_VERTEX_SHADER, vertex_asset, error);
    if (!vertex) return 0;
    const GLuint fragment = shader_compile(GL_FRAGMENT_SHADER, fragment_asset, error);
    if (!fragment) {
        gl.DeleteShader(vertex);
        return 0;
    }
    GLuint program = gl.CreateProgram();
    gl.AttachShader(program, vertex);
    gl.AttachShader(program, fragment);
    gl.LinkProgram(program);
    gl.DeleteShader(vertex);
    gl.DeleteShader(fragment);
    GLint done = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &done);
    if (done) return program;
    char words[600] = "";
    gl.GetProgramInfoLog(program, sizeof words, NULL, words);
    gl.DeleteProgram(program);
    error_set(error, "%s, %s: this OpenGL does not link them: %s", vertex_asset, fragment_asset,
              words);
    return 0;
}
