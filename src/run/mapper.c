/* mapper.c - see mapper.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/mapper.h"

#include "measure/csv.h"
#include "measure/npy.h"
#include "measure/vti.h"
#include "run/folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const format_names[] = {
#define X(name, doc) #name,
    MAPPER_FORMATS(X)
#undef X
};

static int find_format(const char *word, size_t length)
{
    for (int f = 0; f < MAPPER_FORMAT_COUNT; f++) {
        if (strlen(format_names[f]) == length && strncmp(format_names[f], word, length) == 0) {
            return f;
        }
    }
    return -1;
}

bool mapper_parse(const char *words, unsigned *formats, struct error *error)
{
    *formats = 0;
    while (*words) {
        const size_t length = strcspn(words, ",");
        const int format = find_format(words, length);
        if (format < 0) {
            return error_set_code(error, EXIT_USAGE, "unknown format '%.*s' of maps; use png, npy, "
                                  "vti, csv, joined by commas", (int)length, words);
        }
        *formats |= 1u << format;
        words += length + (words[length] == ',');
    }
    return *formats || error_set_code(error, EXIT_USAGE, "no format of maps is named");
}

/* What a picture of a map shows: the field and the walls. */
static struct view map_view(const struct view *view)
{
    struct view bare = *view;
    bare.grains = bare.arrows = bare.forces = bare.spokes = false;
    return bare;
}

static bool choose_kinds(struct mapper *mapper, const struct measure *measure,
                         struct error *error)
{
    static const int usual[] = {MAP_density, MAP_area_fraction, MAP_velocity, MAP_temperature};
    if (measure->fields.count == 0) {
        mapper->kind_count = sizeof usual / sizeof *usual;
        memcpy(mapper->kinds, usual, sizeof usual);
        return true;
    }
    for (uint32_t k = 0; k < measure->fields.count; k++) {
        const int kind = map_find(measure->fields.texts[k]);
        if (kind < 0) {
            return error_set_code(error, EXIT_USAGE, "there is no map '%s'; `sandreel help "
                                  "measure.fields` lists them", measure->fields.texts[k]);
        }
        if (mapper->kind_count < MAP_KINDS) mapper->kinds[mapper->kind_count++] = kind;
    }
    return true;
}

bool mapper_open(struct mapper *mapper, const struct scene *scene, const struct view *view,
                 const struct measure *measure, unsigned formats, struct error *error)
{
    *mapper = (struct mapper){.scene = scene, .view = map_view(view), .formats = formats,
                               .grains = {.name = "n"},
                               .range = {measure->range[0], measure->range[1]}};
    if (!choose_kinds(mapper, measure, error)) return false;
    mapper->map = map_create(scene, measure, error);
    return mapper->map != NULL;
}

void mapper_close(struct mapper *mapper)
{
    if (mapper->map) map_destroy(mapper->map);
    if (mapper->painter) painter_destroy(mapper->painter);
    image_free(&mapper->image);
    *mapper = (struct mapper){0};
}

void mapper_clear(struct mapper *mapper) { map_clear(mapper->map); }

void mapper_add(struct mapper *mapper, const struct grains *grains)
{
    map_add(mapper->map, grains);
    snprintf(mapper->grains.text, sizeof mapper->grains.text, "%.0f",
             grains_number(grains));
}

static bool draw(struct mapper *mapper, const struct field *field, const char *path,
                 struct error *error)
{
    if (!mapper->painter) {
        mapper->painter = painter_create(&mapper->view, error);
        if (!mapper->painter) return false;
        if (!image_create(&mapper->image, (uint32_t)mapper->view.size[0],
                          (uint32_t)mapper->view.size[1], error)) {
            return false;
        }
    }
    const struct picture picture = {
        .scene = scene_at(mapper->scene, field->time), .view = &mapper->view, .field = field,
        .time = field->time, .range = {NAN, NAN},
        .variables = &mapper->grains, .variable_count = 1,
        .field_range = {mapper->range[0], mapper->range[1]},
    };
    const struct image_note notes[] = {{"Software", "sandreel"}, {"Scene", mapper->scene->name},
                                       {"Map", field->label}};
    return painter_frame(mapper->painter, &picture, &mapper->image, error)
        && image_save(&mapper->image, path, mapper->scene->output.png_level, notes,
                      sizeof notes / sizeof *notes, error);
}

static bool write_one(struct mapper *mapper, const struct field *field, int format,
                      const char *path, struct error *error)
{
    switch (format) {
    case MAPPER_BIT_png: return draw(mapper, field, path, error);
    case MAPPER_BIT_npy: return npy_save_field(path, field, error);
    case MAPPER_BIT_vti: return vti_save(path, &field, 1, error);
    case MAPPER_BIT_csv: return csv_save_field(path, field, mapper->scene, error);
    default: return true;
    }
}

bool mapper_write_field(struct mapper *mapper, const struct field *field, const char *directory,
                        const char *suffix, struct error *error)
{
    bool done = true;
    for (int f = 0; done && f < MAPPER_FORMAT_COUNT; f++) {
        char path[FILE_PATH_MAX];
        if (!(mapper->formats >> f & 1)) continue;
        if (f == MAPPER_BIT_png && field->components > 2) continue;
        folder_path(path, directory, "%s_%s.%s", field->name, suffix, format_names[f]);
        done = (!mapper->keeps || file_absent(path, error))
            && write_one(mapper, field, f, path, error);
    }
    return done;
}

bool mapper_write(struct mapper *mapper, const char *directory, const char *suffix,
                  struct error *error)
{
    bool done = true;
    for (uint32_t k = 0; done && k < mapper->kind_count; k++) {
        struct field field;
        if (!map_field(mapper->map, (enum map_kind)mapper->kinds[k], &field, error)) return false;
        done = mapper_write_field(mapper, &field, directory, suffix, error);
        field_free(&field);
    }
    return done;
}
