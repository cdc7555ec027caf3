/* bench_draw.c - see bench_draw.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench/bench_draw.h"

#include "base/clock.h"
#include "base/rng.h"
#include "draw/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A triangular packing, jittered a little, that fills three quarters of a 16:9 box, row by row as
 * a simulation that sorts its grains in space has them. */
static void pack(struct grains *grains, uint32_t count, double box[4])
{
    struct rng rng = rng_stream(1, 0, 0);
    const uint32_t columns = (uint32_t)ceil(sqrt(count * 16.0 / 9 * 0.8660254 / 0.75));
    const double width = columns + 1.0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t row = i / columns, column = i % columns;
        grains->x[i] = 0.5 + column + 0.5 * (row & 1) + 0.04 * (rng_uniform(&rng) - 0.5);
        grains->y[i] = 0.5 + row * 0.8660254 + 0.04 * (rng_uniform(&rng) - 0.5);
        grains->radius[i] = 0.44 + 0.06 * rng_uniform(&rng);
        const double speed = 1 - fabs(grains->x[i] / width - 0.5);
        grains->vx[i] = speed * (rng_uniform(&rng) - 0.5);
        grains->vy[i] = -speed;
    }
    grains->count = count;
    memcpy(box, (double[4]){0, 0, width, width * 9 / 16}, 4 * sizeof *box);
}

/* The scene's four borders. */
static void enclose(struct scene *scene, struct wall walls[4])
{
    const double *const box = scene->box;
    const double x[5] = {box[0], box[2], box[2], box[0], box[0]};
    const double y[5] = {box[1], box[1], box[3], box[3], box[1]};
    for (int k = 0; k < 4; k++) {
        walls[k] = (struct wall){.shape = WALL_SEGMENT, .x0 = x[k], .y0 = y[k], .x1 = x[k + 1],
            .y1 = y[k + 1], .opens = INFINITY, .closes = INFINITY, .joined0 = WALL_NONE,
            .joined1 = WALL_NONE, .body = WALL_NONE, .border = true};
    }
    scene->walls = walls;
    scene->wall_count = 4;
}

static bool measure(struct painter *painter, const struct picture *picture, uint32_t repeats,
                    struct bench_draw_result *result, struct error *error)
{
    struct image image;
    if (!image_create(&image, (uint32_t)picture->view->size[0], (uint32_t)picture->view->size[1],
                      error)) return false;
    bool done = true;
    result->paint_ms = result->encode_ms = INFINITY;
    for (uint32_t k = 0; done && k <= repeats; k++) {
        const double wall = clock_wall(), start = clock_process();
        done = painter_frame(painter, picture, &image, error);
        const double painted = clock_process();
        if (k == 0) {
            result->first_ms = 1e3 * (clock_wall() - wall);
            continue;
        }
        uint8_t *bytes = NULL;
        done = done && image_encode(&image, 1, NULL, 0, &bytes, &result->bytes, error);
        free(bytes);
        result->paint_ms = fmin(result->paint_ms, 1e3 * (painted - start));
        result->encode_ms = fmin(result->encode_ms, 1e3 * (clock_process() - painted));
    }
    image_free(&image);
    return done;
}

bool bench_draw(const struct bench_draw_case *what, uint32_t repeats,
                struct bench_draw_result *result, struct error *error)
{
    struct grains grains;
    struct scene scene = {0};
    struct wall walls[4];
    *result = (struct bench_draw_result){0};
    if (!grains_create(&grains, what->grains, 0, error)) return false;
    pack(&grains, what->grains, scene.box);
    enclose(&scene, walls);
    scene.view = (struct view){
        .size = {what->width, what->height}, .window = {NAN, NAN, NAN, NAN},
        .color = COLOR_SPEED, .scale = SCALE_SQRT, .range = {NAN, NAN}, .colormap = "viridis",
        .grains = true, .walls = true, .rims = what->rims, .shade = what->shade, .legend = true,
        .scale_bar = true, .label = "t = {t}   N = {n}", .arrow_scale = NAN, .force_scale = NAN,
        .text_size = NAN,
    };
    const struct picture picture = {.scene = &scene, .view = &scene.view, .grains = &grains,
        .range = {NAN, NAN}, .field_range = {NAN, NAN}, .path = what->path};
    const double start = clock_wall();
    struct painter *const painter = painter_create(&scene.view, error);
    result->create_ms = 1e3 * (clock_wall() - start);
    const bool done = painter && measure(painter, &picture, repeats, result, error);
    painter_destroy(painter);
    grains_free(&grains);
    return done;
}
