/* film.h - frames with one look: painter, picture and colour range, from the first to the last.
 *
 * Colours mean the same in every frame of a film.  A range that the scene fixes is there from the
 * start; otherwise the film is shown all its frames first (film_gather) and takes the 99th
 * percentile, so that a few fast grains do not darken all others.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FILM_H
#define FILM_H

#include "draw/painter.h"
#include "measure/map.h"
#include "measure/quantile.h"
#include "model/model.h"
#include "run/encoder.h"

enum { FILM_VARIABLES = 7 };

struct film {
    const struct scene *scene;
    const struct model *model;
    struct view     view;
    struct painter *painter;
    struct image    image;              /* the last frame drawn */
    struct transform transform;         /* where it shows the scene */
    struct map     *map;                /* of the field beneath the grains; NULL: none */
    int             map_kind;
    double          range[2], field_range[2];   /* NANs: each frame its own */
    struct quantile values, field_values;       /* of all frames gathered so far */
    struct painter_variable variables[FILM_VARIABLES];
};

/* `view` is copied. */
bool film_open(struct film *film, const struct scene *scene, const struct model *model,
               const struct view *view, struct error *error);
void film_close(struct film *film);

/* Must the whole film be seen before its first frame can be coloured? */
bool film_needs_gathering(const struct film *film);

/* Does the look need contacts in the grains it is given? */
bool film_needs_contacts(const struct view *view);

/* Shows it one frame's grains, in any order; film_settle() then sets the ranges. */
bool film_gather(struct film *film, const struct grains *grains, struct error *error);
void film_settle(struct film *film);

/* The same for films that are seen side by side: those that colour by the same quantity share its
 * range, so that they can be compared.  What the first one gathered becomes that of all. */
void film_settle_together(struct film *const *films, uint32_t count);

/* Draws into film->image.  `steps` and `wall` fill the variables {steps} and {wall} of labels. */
bool film_draw(struct film *film, const struct grains *grains, uint64_t steps, double wall,
               struct error *error);

/* Saves the frame drawn last, which belongs to `time`, as a PNG file that tells about itself. */
bool film_save(const struct film *film, double time, const char *path, struct error *error);

/* What a PNG file of this frame tells about itself. */
void film_describe(const struct film *film, double time, struct encoder_job *job);

#endif
