/* grains_gl.c - see grains_gl.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/grains_gl.h"

#include "draw/gl.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

struct grains_gl {
    uint32_t width, rows;
    GLuint   program, texture, framebuffer, buffer, vertices;
    GLint    area, style;       /* places of the uniforms */
    uint32_t capacity;          /* grains that the buffer has room for */
};

static bool target_create(struct grains_gl *grains, struct error *error)
{
    gl.GenTextures(1, &grains->texture);
    gl.BindTexture(GL_TEXTURE_2D, grains->texture);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, (GLsizei)grains->width, (GLsizei)grains->rows, 0,
                  GL_RGBA, GL_FLOAT, NULL);
    gl.BindTexture(GL_TEXTURE_2D, 0);
    gl.GenFramebuffers(1, &grains->framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, grains->framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, grains->texture,
                            0);
    return gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE
        || error_set(error, "this OpenGL cannot draw into %u x %u pixels of floats",
                     grains->width, grains->rows);
}

static void vertices_create(struct grains_gl *grains)
{
    gl.GenBuffers(1, &grains->buffer);
    gl.GenVertexArrays(1, &grains->vertices);
    gl.BindVertexArray(grains->vertices);
    gl.BindBuffer(GL_ARRAY_BUFFER, grains->buffer);
    const GLsizei stride = sizeof(struct splat);
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
    gl.VertexAttribDivisor(0, 1);
    gl.EnableVertexAttribArray(1);
    gl.VertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                           (const void *)offsetof(struct splat, rgb));
    gl.VertexAttribDivisor(1, 1);
    gl.BindVertexArray(0);
}

struct grains_gl *grains_gl_create(uint32_t width, uint32_t rows, struct error *error)
{
    struct grains_gl *const grains = calloc(1, sizeof *grains);
    if (!grains) {
        error_set(error, "not enough memory to draw grains");
        return NULL;
    }
    grains->width = width;
    grains->rows = rows;
    grains->program = gl_program("shaders/grain.vert", "shaders/grain.frag", error);
    if (!grains->program || !target_create(grains, error)) {
        grains_gl_destroy(grains);
        return NULL;
    }
    grains->area = gl.GetUniformLocation(grains->program, "area");
    grains->style = gl.GetUniformLocation(grains->program, "style");
    vertices_create(grains);
    return grains;
}

void grains_gl_destroy(struct grains_gl *grains)
{
    if (!grains) return;
    gl.DeleteVertexArrays(1, &grains->vertices);
    gl.DeleteBuffers(1, &grains->buffer);
    gl.DeleteFramebuffers(1, &grains->framebuffer);
    gl.DeleteTextures(1, &grains->texture);
    gl.DeleteProgram(grains->program);
    free(grains);
}

static void grains_upload(struct grains_gl *grains, const struct splat *splats, uint32_t count)
{
    gl.BindBuffer(GL_ARRAY_BUFFER, grains->buffer);
    if (count > grains->capacity) {
        grains->capacity = count + count / 4;
        gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(grains->capacity * sizeof *splats), NULL,
                      GL_STREAM_DRAW);
    }
    gl.BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(count * sizeof *splats), splats);
}

void grains_gl_add(struct grains_gl *grains, float *sums, const struct splat_area *area,
                   const struct splat *splats, uint32_t count, struct splat_style style)
{
    const uint32_t rows = area->y1 - area->y0;
    assert(rows <= grains->rows);
    gl.BindFramebuffer(GL_FRAMEBUFFER, grains->framebuffer);
    gl.Viewport(0, 0, (GLsizei)grains->width, (GLsizei)rows);
    gl.Disable(GL_SCISSOR_TEST);
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    if (count > 0) {
        grains_upload(grains, splats, count);
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor((GLint)area->x0, 0, (GLsizei)(area->x1 - area->x0), (GLsizei)rows);
        gl.Enable(GL_BLEND);
        gl.BlendFunc(GL_ONE, GL_ONE);
        gl.UseProgram(grains->program);
        gl.Uniform4f(grains->area, 0, (float)area->y0, 2 / (float)grains->width, 2 / (float)rows);
        gl.Uniform2f(grains->style, style.rim, style.shade);
        gl.BindVertexArray(grains->vertices);
        gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
        gl.BindVertexArray(0);
        gl.UseProgram(0);
        gl.Disable(GL_SCISSOR_TEST);
    }
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, (GLsizei)grains->width, (GLsizei)rows, GL_RGBA, GL_FLOAT, sums);
}
