/* painter.h - turns grains, walls and fields into a picture; knows no model.
 *
 * One painter serves one size and one theme for a whole film: shaders, glyphs and buffers are
 * made once.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PAINTER_H
#define PAINTER_H

#include "draw/image.h"
#include "draw/transform.h"
#include "model/field.h"
#include "model/grains.h"
#include "scene/scene.h"

#include <stdbool.h>

struct painter;

/* How grains are drawn: chosen by count, or forced (tests, bench). */
enum painter_path { PAINTER_AUTO, PAINTER_GL, PAINTER_SPLATTER };

/* Variables of labels besides {t} {n} {title} {units}: {steps} {model} {method} {seed} ... */
struct painter_variable { const char *name; char text[64]; };

struct picture {
    const struct scene  *scene;         /* walls, units, gravity; walls as they stand at time t */
    const struct view   *view;          /* usually &scene->view, perhaps changed by options */
    const struct grains *grains;        /* NULL: none */
    const struct field  *field;         /* drawn beneath the grains; NULL: none */
    double time;
    double range[2];                    /* of the grains' colours; NANs: of this frame */
    double field_range[2];              /* of the field; NANs: of this field */
    const struct painter_variable *variables;
    uint32_t variable_count;
    enum painter_path path;
};

/* A painter for frames of view->size pixels. */
struct painter *painter_create(const struct view *view, struct error *error);
void painter_destroy(struct painter *painter);

/* Draws one frame into `image`, which must have the painter's size. */
bool painter_frame(struct painter *painter, const struct picture *picture, struct image *image,
                   struct error *error);

/* The part of the scene that a view asks for: its window, or the box with a margin. */
void painter_window(const struct view *view, const struct scene *scene, double window[4]);

/* Where the picture shows the scene: how its points become pixels. */
void painter_place(const struct picture *picture, struct transform *transform);

/* What a grain is coloured by (view->color) as one number, and what to call it.  Spin has a sign;
 * pressure is the sum of the sizes of its contact forces over its perimeter, and needs contacts:
 * for all grains at once painter_value_all() looks at every contact only once. */
double painter_value(const struct view *view, const struct grains *grains, uint32_t i);
void painter_value_all(const struct view *view, const struct grains *grains, float *values);

/* The range of colours that suits these values: from 0 to their 99th percentile; of spin
 * symmetric about 0; of radii from the least to the largest; of species 0 to the last. */
void painter_value_range(const struct view *view, const struct grains *grains,
                         const float *values, double range[2]);

/* Red, green, blue of a species; eight colours that also the colour-blind tell apart, repeated. */
const uint8_t *painter_species_color(uint32_t species);
const char *painter_value_name(const struct view *view);        /* "speed" */
const char *painter_value_dimension(const struct view *view);   /* "speed", "1/time", ... */

#endif
