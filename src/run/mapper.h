/* mapper.h - field maps as files: PNG with a colour bar, .npy, VTI and CSV.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MAPPER_H
#define MAPPER_H

#include "draw/painter.h"
#include "measure/map.h"

/* X(name, what it is) */
#define MAPPER_FORMATS(X)                               \
    X(png, "a picture with a colour bar")               \
    X(npy, "a NumPy array [component][row][column]")    \
    X(vti, "VTK image data, for ParaView")              \
    X(csv, "a table x,y,value")

enum mapper_format {
#define X(name, doc) MAPPER_BIT_##name,
    MAPPER_FORMATS(X)
#undef X
    MAPPER_FORMAT_COUNT
};

struct mapper {
    const struct scene *scene;
    struct view     view;
    struct map     *map;
    double          range[2];           /* of the colours; NANs: each map its own */
    struct painter *painter;            /* made when the first picture is asked for */
    struct image    image;
    unsigned        formats;            /* 1 << MAPPER_BIT_... */
    int             kinds[MAP_KINDS];
    uint32_t        kind_count;
    struct painter_variable grains;     /* {n} of labels: the last that were added */
    bool            keeps;              /* refuses to overwrite a file */
};

/* "png,npy" as a set of bits; false if a word is unknown. */
bool mapper_parse(const char *words, unsigned *formats, struct error *error);

/* `fields` names the maps; none: density, area_fraction, velocity and temperature. */
bool mapper_open(struct mapper *mapper, const struct scene *scene, const struct view *view,
                 const struct measure *measure, unsigned formats, struct error *error);
void mapper_close(struct mapper *mapper);

void mapper_clear(struct mapper *mapper);
void mapper_add(struct mapper *mapper, const struct grains *grains);

/* Writes directory/FIELD_suffix.FORMAT for each field and format. */
bool mapper_write(struct mapper *mapper, const char *directory, const char *suffix,
                  struct error *error);

/* The same for a field from elsewhere; tensors have no picture. */
bool mapper_write_field(struct mapper *mapper, const struct field *field, const char *directory,
                        const char *suffix, struct error *error);

#endif
