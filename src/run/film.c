/* film.c - see film.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/film.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double full_colour = 0.99;         /* the share of values below the last colour */

bool film_needs_contacts(const struct view *view)
{
    return view->forces || view->color == COLOR_PRESSURE;
}

static bool is_open(const double range[2]) { return isnan(range[0]) || isnan(range[1]); }

static bool colours_by_value(const struct view *view)
{
    return view->grains && view->color != COLOR_NONE && view->color != COLOR_SPECIES;
}

bool film_needs_gathering(const struct film *film)
{
    if (film->view.range_from != RANGE_RUN) return false;
    return (colours_by_value(&film->view) && is_open(film->range))
        || (film->map && is_open(film->field_range));
}

bool film_open(struct film *film, const struct scene *scene, const struct model *model,
               const struct view *view, struct error *error)
{
    *film = (struct film){.scene = scene, .model = model, .view = *view, .map_kind = -1,
                          .range = {view->range[0], view->range[1]},
                          .field_range = {NAN, NAN}};
    if (!view->grains) {                /* then the range given is the field's */
        memcpy(film->field_range, view->range, sizeof film->field_range);
    }
    const uint32_t width = (uint32_t)view->size[0], height = (uint32_t)view->size[1];
    if (*view->map) {
        film->map_kind = map_find(view->map);
        if (film->map_kind < 0) {
            return error_set_code(error, EXIT_USAGE, "view.map: there is no map '%s'; "
                                  "`sandreel help view.map` lists them", view->map);
        }
        struct measure measure = scene->measure;
        measure.fields.count = 0;       /* whatever else is measured: gather for every kind */
        film->map = map_create(scene, &measure, error);
        if (!film->map) return false;
    }
    if (!quantile_create(&film->values, error) || !quantile_create(&film->field_values, error)) {
        return false;
    }
    film->painter = painter_create(&film->view, error);
    return film->painter && image_create(&film->image, width, height, error);
}

void film_close(struct film *film)
{
    if (film->painter) painter_destroy(film->painter);
    if (film->map) map_destroy(film->map);
    image_free(&film->image);
    quantile_free(&film->values);
    quantile_free(&film->field_values);
    *film = (struct film){0};
}

/* What stands for the grains where they are too many to be drawn: their mean speed, or how much of
 * the area they cover. */
static bool average(const struct film *film, const struct field *sample, struct field *field,
                    struct error *error)
{
    const size_t cells = (size_t)sample->nx * sample->ny;
    const bool speed = film->view.color == COLOR_SPEED;
    const double *count = sample->values + SAMPLE_COUNT * cells;
    const double *sum = sample->values + (speed ? SAMPLE_SPEED : SAMPLE_AREA) * cells;
    if (!field_create(field, sample->x0, sample->y0, sample->cell, sample->nx, sample->ny, 1,
                      error)) return false;
    field->time = sample->time;
    const char *unit = scene_unit(film->scene, "speed");
    if (speed) snprintf(field->label, sizeof field->label, "mean speed %s", unit);
    else snprintf(field->label, sizeof field->label, "area fraction");
    for (size_t k = 0; k < cells; k++) {
        const double value = speed ? sum[k] / count[k] : sum[k] / (sample->cell * sample->cell);
        field->values[k] = count[k] > 0 ? value : NAN;
    }
    return true;
}

static bool has_field(const struct film *film, const struct grains *grains)
{
    return film->map || grains->sample.values;
}

static bool make_field(struct film *film, const struct grains *grains, struct field *field,
                       struct error *error)
{
    if (!film->map) return average(film, &grains->sample, field, error);
    map_clear(film->map);
    map_add(film->map, grains);
    return map_field(film->map, (enum map_kind)film->map_kind, field, error);
}

bool film_gather(struct film *film, const struct grains *grains, struct error *error)
{
    if (colours_by_value(&film->view) && grains->count > 0) {
        float *values = malloc(grains->count * sizeof *values);
        if (!values) return error_set(error, "not enough memory to find the range of the colours");
        painter_value_all(&film->view, grains, values);
        for (uint32_t i = 0; i < grains->count; i++) quantile_add(&film->values, (double)values[i]);
        free(values);
    }
    if (!has_field(film, grains)) return true;
    struct field field;
    if (!make_field(film, grains, &field, error)) return false;
    const size_t cells = (size_t)field.nx * field.ny;
    for (size_t k = 0; k < cells; k++) {
        const double *v = field.values;
        quantile_add(&film->field_values,
                     field.components == 2 ? hypot(v[k], v[cells + k]) : v[k]);
    }
    field_free(&field);
    return true;
}

/* From 0 to the 99th percentile; symmetric about 0 for signed values; of radii all of them. */
static void settle(const struct quantile *values, bool radii, double range[2])
{
    if (!is_open(range) || values->count == 0) return;
    if (radii && values->high > values->low) {
        range[0] = values->low;
        range[1] = values->high;
        return;
    }
    const double low = quantile_at(values, 1 - full_colour);
    double high = quantile_at(values, full_colour);
    if (low < 0) high = fmax(-low, high);
    if (high <= 0) high = values->high;
    /* Nothing lies above, but for what the histogram cannot tell apart: all that moves on a lattice
     * has one speed, and must not be marked as out of range. */
    if (high < values->high && values->high <= high * (1 + QUANTILE_RESOLUTION)) {
        high = values->high;
    }
    if (high <= 0) high = 1;
    range[0] = low < 0 ? -high : 0;
    range[1] = high;
}

void film_settle(struct film *film)
{
    settle(&film->values, film->view.color == COLOR_RADIUS, film->range);
    if (film->map) settle(&film->field_values, false, film->field_range);
}

void film_settle_together(struct film *const *films, uint32_t count)
{
    struct film *first = films[0];
    for (uint32_t k = 1; k < count; k++) {
        struct film *film = films[k];
        if (film->view.color == first->view.color) quantile_merge(&first->values, &film->values);
        if (film->map_kind == first->map_kind) {
            quantile_merge(&first->field_values, &film->field_values);
        }
    }
    film_settle(first);
    for (uint32_t k = 1; k < count; k++) {
        struct film *film = films[k];
        if (film->view.color == first->view.color && isnan(film->range[0])) {
            memcpy(film->range, first->range, sizeof film->range);
        }
        if (film->map_kind == first->map_kind && isnan(film->field_range[0])) {
            memcpy(film->field_range, first->field_range, sizeof film->field_range);
        }
        film_settle(film);
    }
}

static void set_variable(struct film *film, uint32_t index, const char *name, const char *format,
                         ...) __attribute__((format(printf, 4, 5)));

static void set_variable(struct film *film, uint32_t index, const char *name, const char *format,
                         ...)
{
    assert(index < FILM_VARIABLES);
    film->variables[index].name = name;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(film->variables[index].text, sizeof film->variables[index].text, format, arguments);
    va_end(arguments);
}

bool film_draw(struct film *film, const struct grains *grains, uint64_t steps, double wall,
               struct error *error)
{
    set_variable(film, 0, "steps", "%llu", (unsigned long long)steps);
    set_variable(film, 1, "model", "%s", film->model->name);
    set_variable(film, 2, "seed", "%llu", (unsigned long long)film->scene->seed);
    set_variable(film, 3, "name", "%.60s", film->scene->name);
    set_variable(film, 4, "wall", wall < 10 ? "%.2f" : "%.1f", wall);
    set_variable(film, 5, "method", "%s", film->model->name);
    struct field field = {0};
    set_variable(film, 6, "n", "%.0f", grains_number(grains));
    const bool shows = has_field(film, grains);
    if (shows && !make_field(film, grains, &field, error)) return false;
    struct picture picture = {
        .scene = scene_at(film->scene, grains->time), .view = &film->view,
        .grains = grains->sample.values ? NULL : grains, .field = shows ? &field : NULL,
        .time = grains->time,
        .range = {film->range[0], film->range[1]},
        .field_range = {film->field_range[0], film->field_range[1]},
        .variables = film->variables, .variable_count = FILM_VARIABLES,
    };
    if (grains->sample.values && !film->map) {
        memcpy(picture.field_range, film->range, sizeof picture.field_range);
    }
    painter_place(&picture, &film->transform);
    const bool done = painter_frame(film->painter, &picture, &film->image, error);
    if (shows) field_free(&field);
    return done;
}

static void note(struct encoder_job *job, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void note(struct encoder_job *job, const char *key, const char *format, ...)
{
    assert(job->note_count < ENCODER_NOTES);
    struct encoder_note *at = &job->notes[job->note_count++];
    snprintf(at->key, sizeof at->key, "%s", key);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(at->text, sizeof at->text, format, arguments);
    va_end(arguments);
}

void film_describe(const struct film *film, double time, struct encoder_job *job)
{
    const struct scene *scene = film->scene;
    job->note_count = 0;
    note(job, "Software", "sandreel");
    note(job, "Scene", "%.150s", scene->name);
    note(job, "Model", "%s", film->model->name);
    note(job, "Seed", "%llu", (unsigned long long)scene->seed);
    note(job, "Time", "%.9g %s", time, scene_unit(scene, "time"));
    if (!is_open(film->range) && colours_by_value(&film->view)) {
        note(job, "Range", "%s %.9g .. %.9g %s", painter_value_name(&film->view), film->range[0],
             film->range[1], scene_unit(scene, painter_value_dimension(&film->view)));
    }
}

bool film_save(const struct film *film, double time, const char *path, struct error *error)
{
    struct encoder_job job = {0};
    struct image_note notes[ENCODER_NOTES];
    film_describe(film, time, &job);
    for (uint32_t k = 0; k < job.note_count; k++) {
        notes[k] = (struct image_note){job.notes[k].key, job.notes[k].text};
    }
    return image_save(&film->image, path, film->scene->output.png_level, notes, job.note_count,
                      error);
}
