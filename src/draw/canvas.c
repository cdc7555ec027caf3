/* canvas.c - see canvas.h.
 *
 * A backend is how a context is opened, made current and let go; all else is common.  The few
 * constants of OSMesa and EGL are written out here because their headers cannot be included
 * beside the core profile's, and so that only one header package is needed to build.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/canvas.h"

#include "draw/gl.h"

#include <assert.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct canvas_backend {
    const char *name, *package;
    bool (*open)(struct canvas *canvas, struct error *error);
    bool (*enter)(struct canvas *canvas);
    void (*leave)(struct canvas *canvas);
    void (*close)(struct canvas *canvas);
};

enum { OSMESA_SURFACE = 16 };   /* side of the window that OSMesa insists on; never drawn to */

struct canvas {
    const struct canvas_backend *backend;
    void    *context;
    struct gl_functions functions;
    uint32_t width, height;
    GLuint   texture, framebuffer;
    char     renderer[200];
    uint8_t  surface[OSMESA_SURFACE * OSMESA_SURFACE * 4];
};

static _Thread_local struct canvas *canvas_current;

/* A symbol of a library as a function's address (ISO C has no cast between the two). */
static gl_address symbol_find(void *library, const char *name)
{
    void *const object = dlsym(library, name);
    gl_address address;
    static_assert(sizeof object == sizeof address, "POSIX: both kinds of address are alike");
    memcpy(&address, &object, sizeof address);
    return address;
}

/* ---- OSMesa ---- */

static struct {
    void      *(*create)(const int *attributes, void *share);
    void       (*destroy)(void *context);
    unsigned char (*make_current)(void *context, void *buffer, GLenum type, GLsizei width,
                                  GLsizei height);
    gl_address (*address)(const char *name);
} osmesa;

static bool osmesa_library(struct error *error)
{
    if (osmesa.create) return true;
    void *library = NULL;
    for (const char *const *name = (const char *const[]){"libOSMesa.so.8", "libOSMesa.so.6",
                                                         "libOSMesa.so", NULL};
         *name && !library; name++) {
        library = dlopen(*name, RTLD_NOW | RTLD_LOCAL);
    }
    if (!library) return error_set(error, "libOSMesa.so.8 is not installed");
    osmesa.destroy = (void (*)(void *))symbol_find(library, "OSMesaDestroyContext");
    osmesa.make_current = (unsigned char (*)(void *, void *, GLenum, GLsizei, GLsizei))
        symbol_find(library, "OSMesaMakeCurrent");
    osmesa.address = (gl_address (*)(const char *))symbol_find(library, "OSMesaGetProcAddress");
    osmesa.create = (void *(*)(const int *, void *))
        symbol_find(library, "OSMesaCreateContextAttribs");
    return (osmesa.create && osmesa.destroy && osmesa.make_current && osmesa.address)
        || error_set(error, "libOSMesa is too old for core contexts (Mesa 11.2 or newer)");
}

static bool osmesa_enter(struct canvas *canvas)
{
    return osmesa.make_current(canvas->context, canvas->surface, GL_UNSIGNED_BYTE,
                               OSMESA_SURFACE, OSMESA_SURFACE);
}

static void osmesa_leave(struct canvas *canvas)
{
    (void)canvas;
    osmesa.make_current(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
}

static void osmesa_close(struct canvas *canvas)
{
    osmesa.destroy(canvas->context);
}

static bool osmesa_open(struct canvas *canvas, struct error *error)
{
    enum { FORMAT = 0x22, DEPTH_BITS = 0x30, STENCIL_BITS, ACCUM_BITS, PROFILE, CORE_PROFILE,
           MAJOR = 0x36, MINOR };
    static const int attributes[] = {FORMAT, GL_RGBA, DEPTH_BITS, 0, STENCIL_BITS, 0,
        ACCUM_BITS, 0, PROFILE, CORE_PROFILE, MAJOR, 3, MINOR, 3, 0};
    if (!osmesa_library(error)) return false;
    canvas->context = osmesa.create(attributes, NULL);
    if (!canvas->context) return error_set(error, "OSMesa gives no OpenGL 3.3 core context");
    return gl_load(&canvas->functions, osmesa.address, error);
}

/* ---- EGL without a surface ---- */

static struct {
    void      *display;
    void      *(*create)(void *display, void *config, void *share, const int *attributes);
    unsigned   (*destroy)(void *display, void *context);
    unsigned   (*make_current)(void *display, void *draw, void *read, void *context);
    gl_address (*address)(const char *name);
} egl;

static bool egl_library(struct error *error)
{
    enum { PLATFORM_SURFACELESS = 0x31DD, OPENGL_API = 0x30A2 };
    if (egl.display) return true;
    void *const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) return error_set(error, "libEGL.so.1 is not installed");
    unsigned (*initialize)(void *, int *, int *) =
        (unsigned (*)(void *, int *, int *))symbol_find(library, "eglInitialize");
    unsigned (*bind)(unsigned) = (unsigned (*)(unsigned))symbol_find(library, "eglBindAPI");
    egl.create = (void *(*)(void *, void *, void *, const int *))
        symbol_find(library, "eglCreateContext");
    egl.destroy = (unsigned (*)(void *, void *))symbol_find(library, "eglDestroyContext");
    egl.make_current = (unsigned (*)(void *, void *, void *, void *))
        symbol_find(library, "eglMakeCurrent");
    egl.address = (gl_address (*)(const char *))symbol_find(library, "eglGetProcAddress");
    void *(*platform)(unsigned, void *, const int *) = egl.address == NULL ? NULL
        : (void *(*)(unsigned, void *, const int *))egl.address("eglGetPlatformDisplayEXT");
    if (!initialize || !bind || !egl.create || !egl.destroy || !egl.make_current || !platform) {
        return error_set(error, "libEGL is too old to draw without a display");
    }
    void *const display = platform(PLATFORM_SURFACELESS, NULL, NULL);
    if (!display || !initialize(display, NULL, NULL) || !bind(OPENGL_API)) {
        return error_set(error, "EGL has no surfaceless platform");
    }
    egl.display = display;
    return true;
}

static bool egl_enter(struct canvas *canvas)
{
    return egl.make_current(egl.display, NULL, NULL, canvas->context);
}

static void egl_leave(struct canvas *canvas)
{
    (void)canvas;
    egl.make_current(egl.display, NULL, NULL, NULL);
}

static void egl_close(struct canvas *canvas)
{
    egl.destroy(egl.display, canvas->context);
}

static bool egl_open(struct canvas *canvas, struct error *error)
{
    enum { MAJOR = 0x3098, MINOR = 0x30FB, PROFILE = 0x30FD, CORE_PROFILE = 1, NONE = 0x3038 };
    static const int attributes[] = {MAJOR, 3, MINOR, 3, PROFILE, CORE_PROFILE, NONE};
    if (!egl_library(error)) return false;
    canvas->context = egl.create(egl.display, NULL, NULL, attributes);
    if (!canvas->context) return error_set(error, "EGL gives no OpenGL 3.3 core context");
    return gl_load(&canvas->functions, egl.address, error);
}

/* ---- common ---- */

/* In the order in which they are tried. */
static const struct canvas_backend backends[] = {
    {"osmesa", "libosmesa6", osmesa_open, osmesa_enter, osmesa_leave, osmesa_close},
    {"egl", "libegl1 libegl-mesa0 libgl1-mesa-dri", egl_open, egl_enter, egl_leave, egl_close},
};
enum { BACKEND_COUNT = sizeof backends / sizeof *backends };

/* What the libraries read from the environment when they are loaded; what the user set stays.
 * EGL must not pick a graphics card, whose pixels would differ, and should not talk to stderr.
 * Mesa's own threads save no processor time on pictures of this kind, and would take it from the
 * simulation that runs beside. */
static void environment_prepare(void)
{
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
    setenv("LP_NUM_THREADS", "0", 0);
    setenv("EGL_LOG_LEVEL", "fatal", 0);
}

static void canvas_leave(void)
{
    if (canvas_current) canvas_current->backend->leave(canvas_current);
    canvas_current = NULL;
}

/* Both backends share Mesa's idea of a current context, so the old one is always let go first:
 * EGL might otherwise believe that its own is still current, and do nothing. */
static bool canvas_enter(struct canvas *canvas)
{
    if (canvas_current == canvas) return true;
    canvas_leave();
    if (!canvas->backend->enter(canvas)) return false;
    canvas_current = canvas;
    gl = canvas->functions;
    return true;
}

static bool framebuffer_create(struct canvas *canvas, struct error *error)
{
    GLint side_max = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &side_max);
    if (canvas->width > (uint32_t)side_max || canvas->height > (uint32_t)side_max) {
        return error_set(error, "a picture of %u x %u pixels is too large: this OpenGL draws up "
                         "to %d a side", canvas->width, canvas->height, side_max);
    }
    gl.GenTextures(1, &canvas->texture);
    gl.BindTexture(GL_TEXTURE_2D, canvas->texture);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)canvas->width, (GLsizei)canvas->height, 0,
                  GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    gl.BindTexture(GL_TEXTURE_2D, 0);
    gl.GenFramebuffers(1, &canvas->framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, canvas->framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, canvas->texture,
                            0);
    const bool whole = gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    return (whole && gl.GetError() == GL_NO_ERROR)
        || error_set(error, "not enough memory for a picture of %u x %u pixels", canvas->width,
                     canvas->height);
}

static bool canvas_open(struct canvas *canvas, const struct canvas_backend *backend,
                        struct error *error)
{
    canvas->backend = backend;
    if (!backend->open(canvas, error)) return false;
    if (!canvas_enter(canvas)) {
        return error_set(error, "%s does not make its context current", backend->name);
    }
    snprintf(canvas->renderer, sizeof canvas->renderer, "%s, OpenGL %s",
             (const char *)gl.GetString(GL_RENDERER), (const char *)gl.GetString(GL_VERSION));
    return true;
}

static void canvas_close(struct canvas *canvas)
{
    if (!canvas->context) return;
    if (canvas_enter(canvas)) {
        gl.DeleteFramebuffers(1, &canvas->framebuffer);
        gl.DeleteTextures(1, &canvas->texture);
        canvas_leave();
    }
    canvas->backend->close(canvas);
    canvas->context = NULL;
}

/* Tries the backends that SANDREEL_GL allows, and gathers why each of them failed. */
static bool canvas_open_any(struct canvas *canvas, struct error *error)
{
    const char *const wish = getenv("SANDREEL_GL");
    char tried[600] = "", packages[200] = "";
    bool known = false;
    for (int b = 0; b < BACKEND_COUNT; b++) {
        if (wish && *wish && strcmp(wish, backends[b].name) != 0) continue;
        known = true;
        struct error why = {0};
        if (canvas_open(canvas, &backends[b], &why)) return true;
        canvas_close(canvas);
        const size_t end = strlen(tried), packages_end = strlen(packages);
        snprintf(tried + end, sizeof tried - end, "%s%s: %.250s", end ? "; " : "",
                 backends[b].name, why.text);
        snprintf(packages + packages_end, sizeof packages - packages_end, "%s%s",
                 packages_end ? ", or " : "", backends[b].package);
    }
    if (!known) {
        return error_set_code(error, EXIT_USAGE, "SANDREEL_GL=%s: unknown; use osmesa or egl",
                              wish);
    }
    return error_set(error, "cannot draw, no OpenGL without a display (%s); install one of the "
                     "Debian packages %s", tried, packages);
}

struct canvas *canvas_create(uint32_t width, uint32_t height, struct error *error)
{
    assert(width > 0);
    assert(height > 0);
    struct canvas *const canvas = calloc(1, sizeof *canvas);
    if (!canvas) {
        error_set(error, "not enough memory for a canvas");
        return NULL;
    }
    canvas->width = width;
    canvas->height = height;
    environment_prepare();
    if (canvas_open_any(canvas, error) && framebuffer_create(canvas, error)) return canvas;
    canvas_destroy(canvas);
    return NULL;
}

void canvas_destroy(struct canvas *canvas)
{
    if (!canvas) return;
    canvas_close(canvas);
    free(canvas);
}

void canvas_begin(struct canvas *canvas)
{
    const bool entered = canvas_enter(canvas);
    assert(entered);
    (void)entered;
    gl.BindFramebuffer(GL_FRAMEBUFFER, canvas->framebuffer);
    gl.Viewport(0, 0, (GLsizei)canvas->width, (GLsizei)canvas->height);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void canvas_write(struct canvas *canvas, uint32_t row, uint32_t row_count, const uint8_t *rgba)
{
    assert(row + row_count <= canvas->height);
    gl.BindTexture(GL_TEXTURE_2D, canvas->texture);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)row, (GLsizei)canvas->width, (GLsizei)row_count,
                     GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl.BindTexture(GL_TEXTURE_2D, 0);
}

/* Premultiplied to straight, rounded; opaque and empty pixels are what they are. */
static void row_straighten(uint8_t *rgba, uint32_t count)
{
    uint32_t every = UINT32_MAX;                /* whole pixels: the compiler takes many at once */
    for (size_t i = 0; i < count; i++) {
        uint32_t pixel;
        memcpy(&pixel, rgba + 4 * i, sizeof pixel);
        every &= pixel;
    }
    uint8_t common[4];
    memcpy(common, &every, sizeof common);
    if (common[3] == 255) return;
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        const unsigned alpha = rgba[3];
        if (alpha == 255 || alpha == 0) continue;
        for (int k = 0; k < 3; k++) {
            const unsigned straight = (rgba[k] * 255u + alpha / 2) / alpha;
            rgba[k] = (uint8_t)(straight < 255 ? straight : 255);
        }
    }
}

static void rows_swap(uint8_t *a, uint8_t *b, size_t size)
{
    uint8_t piece[4096];
    for (size_t done = 0; done < size; done += sizeof piece) {
        const size_t part = size - done < sizeof piece ? size - done : sizeof piece;
        memcpy(piece, a + done, part);
        memcpy(a + done, b + done, part);
        memcpy(b + done, piece, part);
    }
}

void canvas_read(struct canvas *canvas, struct image *image)
{
    assert(image->width == canvas->width);
    assert(image->height == canvas->height);
    const size_t row_size = (size_t)canvas->width * 4;
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, (GLsizei)canvas->width, (GLsizei)canvas->height, GL_RGBA,
                  GL_UNSIGNED_BYTE, image->rgba);
    for (uint32_t low = 0, high = canvas->height - 1; low < high; low++, high--) {
        rows_swap(image->rgba + low * row_size, image->rgba + high * row_size, row_size);
    }
    for (uint32_t y = 0; y < canvas->height; y++) {
        row_straighten(image->rgba + y * row_size, canvas->width);
    }
}

const char *canvas_backend(const struct canvas *canvas)
{
    return canvas->backend->name;
}

const char *canvas_renderer(const struct canvas *canvas)
{
    return canvas->renderer;
}
