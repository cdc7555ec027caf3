/* splat.c - see splat.h; shaders/grain.frag says the same in GLSL.
 *
 * A row goes in pieces of as many pixels as an AVX2 register has floats: their coverages are
 * computed together, needed or not, then added to the sums, one pixel (four floats) at a time.  The
 * styles are constants of forced-inline loops, so plain discs pay nothing for rims and shading.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/splat.h"

#include <math.h>
#include <string.h>

#define FORCE_INLINE static inline __attribute__((always_inline))
/* Runs the AVX2 form where the processor has it.  Both give the same bytes: square roots,
 * products and sums are rounded as IEEE 754 says, and no multiply-add is contracted. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__AVX2__)
#define DISPATCH __attribute__((target_clones("avx2", "default")))
#else
#define DISPATCH
#endif

typedef float pixel __attribute__((vector_size(16)));

/* Two pixels. */
typedef float pair __attribute__((vector_size(32)));
typedef int32_t words __attribute__((vector_size(32)));
typedef uint8_t lanes __attribute__((vector_size(32)));

enum { PIECE = 8 };             /* pixels of a row handled at a time */
enum { GROUP = 4 };             /* pixels that get their colours at a time */
enum { RIM = 1, SHADE = 2 };    /* what a loop is compiled for */

/* Below this radius a disc cannot be told from a square of its area, and sampling the analytic
 * edge at pixel centres would miss the area by up to 12 % (by 4 % at most above). */
#define RADIUS_SQUARE 1.2f

/* The integral of clamp(r + 1/2 - d) over the plane is pi (r^2 + 1/12). */
#define EDGE_AREA (1.0f / 12.0f)

/* A lit ball: dark * |u - light|^2 is taken from the colour, where u is the place on the disc in
 * radii, and a spot of white lies around the light. */
#define LIGHT_X (-0.32f)
#define LIGHT_Y 0.38f
#define LIGHT_TOP 1.07f
#define LIGHT_DARK 0.24f
#define LIGHT_SPOT 0.42f
#define LIGHT_SPOT_SHARPNESS 3.2f

#define RIM_DARK 0.52f          /* share of the colour that the rim takes away */
#define RIM_SHARE 0.11f         /* its width in radii, within these bounds in pixels: */
#define RIM_MIN 0.8f
#define RIM_MAX 2.5f

/* What the loops below call is forced into them: a call from their AVX2 forms to code without it
 * would cost the processor's change between the two. */
FORCE_INLINE float bounded(float value, float low, float high)
{
    return value < low ? low : value > high ? high : value;
}

FORCE_INLINE float square_half(float radius) { return 0.8862269f * radius; }

float splat_reach(float radius)
{
    return radius < RADIUS_SQUARE ? square_half(radius) : radius + 0.5f;
}

bool splat_touches(const struct splat *splat, const struct splat_area *area)
{
    const float reach = splat_reach(splat->radius);
    return splat->x + reach > (float)area->x0 && splat->x - reach < (float)area->x1
        && splat->y + reach > (float)area->y0 && splat->y - reach < (float)area->y1;
}

/* The pixels low..high-1 that an extent touches within first..last-1. */
FORCE_INLINE void extent_pixels(float center, float reach, uint32_t first, uint32_t last,
                                int32_t *low, int32_t *high)
{
    const float from = floorf(center - reach), to = ceilf(center + reach);
    *low = from > (float)first ? (int32_t)from : (int32_t)first;
    *high = to < (float)last ? (int32_t)to : (int32_t)last;
}

FORCE_INLINE float overlap(float low, float high, int32_t cell)
{
    const float from = low > (float)cell ? low : (float)cell;
    const float to = high < (float)(cell + 1) ? high : (float)(cell + 1);
    return to - from;
}

FORCE_INLINE void square_add(float *sums, uint32_t width, const struct splat_area *area,
                             const struct splat *splat, pixel color)
{
    const float half = square_half(splat->radius);
    int32_t x0, x1, y0, y1;
    extent_pixels(splat->x, half, area->x0, area->x1, &x0, &x1);
    extent_pixels(splat->y, half, area->y0, area->y1, &y0, &y1);
    for (int32_t y = y0; y < y1; y++) {
        const float high = overlap(splat->y - half, splat->y + half, y);
        pixel *const row = (pixel *)sums + (size_t)(y - (int32_t)area->y0) * width;
        for (int32_t x = x0; x < x1; x++) {
            row[x] += color * (high * overlap(splat->x - half, splat->x + half, x));
        }
    }
}

/* What is the same for all pixels of a disc. */
struct disc {
    float x, y, reach;          /* reach: where the coverage becomes 0 */
    float per_radius;           /* 1 / radius */
    float shade, rim, rim_from; /* strengths, and where the rim begins */
};

FORCE_INLINE struct disc disc_prepare(const struct splat *splat, struct splat_style style)
{
    const float r = splat->radius, edge = sqrtf(r * r - EDGE_AREA);
    return (struct disc){
        .x = splat->x, .y = splat->y, .reach = edge + 0.5f, .per_radius = 1 / r,
        /* On a tiny grain among larger ones both would leave nothing of its colour. */
        .shade = style.shade * bounded(r - RADIUS_SQUARE, 0, 1),
        .rim = style.rim * RIM_DARK * bounded(r - RADIUS_SQUARE, 0, 1),
        .rim_from = edge - 0.5f - bounded(RIM_SHARE * r, RIM_MIN, RIM_MAX),
    };
}

/* Coverage, and the factors of the grain's colour and of white, for a piece of a row. */
FORCE_INLINE void disc_piece(const struct disc *disc, float x0, float dy, float *cover,
                             float *color, float *white, unsigned effects)
{
    /* As a loop the compiler makes SIMD of it, and not of eight copies. */
#pragma GCC unroll 1
    for (int32_t i = 0; i < PIECE; i++) {
        const float dx = x0 + (float)i - disc->x;
        const float d = sqrtf(dx * dx + dy * dy);
        float a = disc->reach - d;
        a = a < 0 ? 0 : a;
        a = a > 1 ? 1 : a;
        float light = 1, spot = 0;
        if (effects & SHADE) {
            const float ux = dx * disc->per_radius - LIGHT_X;
            const float uy = dy * disc->per_radius - LIGHT_Y;
            const float q = ux * ux + uy * uy;
            float s = 1 - LIGHT_SPOT_SHARPNESS * q;
            s = s < 0 ? 0 : s;
            spot = LIGHT_SPOT * s * s * disc->shade;
            light = (1 + (LIGHT_TOP - LIGHT_DARK * q - 1) * disc->shade) * (1 - spot);
        }
        if (effects & RIM) {
            float rim = d - disc->rim_from;
            rim = rim < 0 ? 0 : rim;
            rim = disc->rim * (rim > 1 ? 1 : rim);
            light *= 1 - rim;
            spot *= 1 - rim;
        }
        cover[i] = a;
        if (effects) color[i] = a * light;
        if (effects & SHADE) white[i] = a * spot;
    }
}

/* Adds the first `count` pixels of a piece. */
FORCE_INLINE void piece_add(pixel *row, pixel color, const float *cover, const float *own,
                            const float *light, int32_t count, unsigned effects)
{
    const pixel opaque = {0, 0, 0, 1}, white = {1, 1, 1, 0};
    for (int32_t i = 0; i < count; i++) {
        if (effects & SHADE) row[i] += color * own[i] + white * light[i] + opaque * cover[i];
        else if (effects) row[i] += color * own[i] + opaque * cover[i];
        else row[i] += (color + opaque) * cover[i];
    }
}

FORCE_INLINE void disc_add(float *sums, uint32_t width, const struct splat_area *area,
                           const struct splat *splat, pixel color, struct splat_style style,
                           unsigned effects)
{
    const struct disc disc = disc_prepare(splat, style);
    const int32_t end = (int32_t)area->x1;
    int32_t x0, x1, y0, y1;
    float a[PIECE], c[PIECE], w[PIECE];
    extent_pixels(disc.y, disc.reach, area->y0, area->y1, &y0, &y1);
    extent_pixels(disc.x, disc.reach, area->x0, area->x1, &x0, &x1);
    if (x1 - x0 <= PIECE && x0 + PIECE <= end) {        /* one piece holds each of its rows */
        pixel *row = (pixel *)sums + (size_t)(y0 - (int32_t)area->y0) * width + x0;
        for (int32_t y = y0; y < y1; y++, row += width) {
            disc_piece(&disc, (float)x0 + 0.5f, (float)y + 0.5f - disc.y, a, c, w, effects);
            if (x1 - x0 > PIECE / 2) piece_add(row, color, a, c, w, PIECE, effects);
            else piece_add(row, color, a, c, w, PIECE / 2, effects);
        }
        return;
    }
    for (int32_t y = y0; y < y1; y++) {
        const float dy = (float)y + 0.5f - disc.y, q = disc.reach * disc.reach - dy * dy;
        if (q <= 0) continue;
        extent_pixels(disc.x, sqrtf(q), area->x0, area->x1, &x0, &x1);
        pixel *const row = (pixel *)sums + (size_t)(y - (int32_t)area->y0) * width;
        for (int32_t x = x0; x < x1; x += PIECE) {
            disc_piece(&disc, (float)x + 0.5f, dy, a, c, w, effects);
            /* Behind the disc the coverage is 0, and adding it costs less than a loop of unknown
             * length; behind the area it need not be. */
            if (x + PIECE <= end) piece_add(row + x, color, a, c, w, PIECE, effects);
            else piece_add(row + x, color, a, c, w, x1 - x, effects);
        }
    }
}

FORCE_INLINE void grains_add(float *sums, uint32_t width, const struct splat_area *area,
                             const struct splat *splats, const uint32_t *index, uint32_t count,
                             struct splat_style style, unsigned effects)
{
    for (uint32_t k = 0; k < count; k++) {
        const struct splat *const splat = &splats[index[k]];
        pixel color = {splat->rgb[0], splat->rgb[1], splat->rgb[2], 0};
        color *= 1.0f / 255;
        if (splat->radius < RADIUS_SQUARE) {
            color[3] = 1;
            square_add(sums, width, area, splat, color);
        } else {
            disc_add(sums, width, area, splat, color, style, effects);
        }
    }
}

#define LOOPS(X) X(plain, 0) X(rimmed, RIM) X(shaded, SHADE) X(rimmed_and_shaded, RIM | SHADE)

#define X(name, effects)                                                                      \
    DISPATCH static void add_##name(float *sums, uint32_t width, const struct splat_area *area, \
                                    const struct splat *splats, const uint32_t *index,        \
                                    uint32_t count, struct splat_style style)                 \
    {                                                                                         \
        grains_add(sums, width, area, splats, index, count, style, effects);                  \
    }
LOOPS(X)
#undef X

void splat_add(float *sums, uint32_t width, const struct splat_area *area,
               const struct splat *splats, const uint32_t *index, uint32_t count,
               struct splat_style style)
{
    switch ((style.rim > 0 ? RIM : 0) | (style.shade > 0 ? SHADE : 0)) {
#define X(name, effects) \
    case effects: add_##name(sums, width, area, splats, index, count, style); break;
    LOOPS(X)
#undef X
    }
}

/* Where the coverage is 0 the ground stays, where it is 1 it is gone, and beyond the grains share
 * the pixel: all in one formula without branches, so that two pixels go at once. */
FORCE_INLINE void resolve_group(const float *sums, uint8_t *rgba)
{
    if (sums[3] + sums[7] + sums[11] + sums[15] <= 0) return;
    for (int half = 0; half < GROUP; half += 2, sums += 8, rgba += 8) {
        pair sum;
        int32_t below[2];
        memcpy(&sum, sums, sizeof sum);
        memcpy(below, rgba, sizeof below);
        const pair coverage = __builtin_shufflevector(sum, sum, 3, 3, 3, 3, 7, 7, 7, 7);
        const words over = coverage > 1, under = coverage < 1;
        const pair one = {1, 1, 1, 1, 1, 1, 1, 1};
        const pair shared = (pair)(((words)coverage & over) | ((words)one & ~over));
        const pair ground = (pair)((words)(1 - coverage) & under);
        const words pixels = {below[0], below[0], below[0], below[0],
                              below[1], below[1], below[1], below[1]};
        const words levels = pixels >> (words){0, 8, 16, 24, 0, 8, 16, 24} & 255;
        pair value = sum * 255 * (1 / shared) + __builtin_convertvector(levels, pair) * ground;
        value += 0.5f;
        /* Lights may shine beyond white; premultiplied colours end at their alpha. */
        const pair most = __builtin_shufflevector(value, value, 3, 3, 3, 3, 7, 7, 7, 7);
        const words beyond = value > most;
        value = (pair)(((words)value & ~beyond) | ((words)most & beyond));
        /* The lowest byte of each word, to the lower end of each half of the register. */
        const lanes whole = (lanes)__builtin_convertvector(value, words);
        const lanes color = __builtin_shufflevector(whole, whole,
            0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12,
            16, 20, 24, 28, 16, 20, 24, 28, 16, 20, 24, 28, 16, 20, 24, 28);
        memcpy(rgba, &color, 4);
        memcpy(rgba + 4, (const uint8_t *)&color + 16, 4);
    }
}

DISPATCH void splat_resolve(const float *sums, uint8_t *rgba, size_t count)
{
    const size_t whole = count - count % GROUP;
    for (size_t i = 0; i < whole; i += GROUP) resolve_group(sums + 4 * i, rgba + 4 * i);
    float last_sums[4 * GROUP] = {0};
    uint8_t last[4 * GROUP] = {0};
    memcpy(last_sums, sums + 4 * whole, (count - whole) * 4 * sizeof *sums);
    memcpy(last, rgba + 4 * whole, (count - whole) * 4);
    resolve_group(last_sums, last);
    memcpy(rgba + 4 * whole, last, (count - whole) * 4);
}
