/* vtp.c - see vtp.h.  Arrays lie inline as base64, like those of vti.c.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/vtp.h"

#include "base/file.h"
#include "measure/base64.h"

#include <inttypes.h>

/* Opens an array and says how many bytes of values follow. */
static struct base64 begin_array(FILE *stream, const char *type, const char *name, int components,
                                 uint64_t bytes)
{
    struct base64 letters = {.stream = stream};
    fprintf(stream, "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
            "format=\"binary\">\n", type, name, components);
    base64_add(&letters, &bytes, sizeof bytes);
    return letters;
}

static void end_array(struct base64 *letters)
{
    base64_flush(letters);
    fputs("\n        </DataArray>\n", letters->stream);
}

static void write_array(FILE *stream, const char *type, const char *name, const void *values,
                        size_t width, uint32_t count)
{
    struct base64 letters = begin_array(stream, type, name, 1, (uint64_t)width * count);
    base64_add(&letters, values, width * count);
    end_array(&letters);
}

/* x and y become the first two of three components. */
static void write_vectors(FILE *stream, const char *name, const double *x, const double *y,
                          uint32_t count)
{
    struct base64 letters = begin_array(stream, "Float64", name, 3, (uint64_t)count * 24);
    for (uint32_t k = 0; k < count; k++) {
        const double vector[3] = {x[k], y[k], 0};
        base64_add(&letters, vector, sizeof vector);
    }
    end_array(&letters);
}

/* Every point is a vertex cell of its own, so that filters and glyphs find it. */
static void write_vertices(FILE *stream, uint32_t count)
{
    static const char *const names[] = {"connectivity", "offsets"};
    fputs("      <Verts>\n", stream);
    for (uint32_t n = 0; n < 2; n++) {
        struct base64 letters = begin_array(stream, "Int64", names[n], 1, (uint64_t)count * 8);
        for (uint32_t k = 0; k < count; k++) {
            const int64_t value = (int64_t)k + n;
            base64_add(&letters, &value, sizeof value);
        }
        end_array(&letters);
    }
    fputs("      </Verts>\n", stream);
}

bool vtp_save(const char *path, const struct grains *grains, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    FILE *stream = file.stream;
    const uint32_t count = grains->count;
    fprintf(stream,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n"
        "  <PolyData>\n"
        "    <FieldData>\n"
        "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">%.17g</DataArray>\n"
        "    </FieldData>\n"
        "    <Piece NumberOfPoints=\"%" PRIu32 "\" NumberOfVerts=\"%" PRIu32 "\">\n"
        "      <Points>\n", grains->time, count, count);
    write_vectors(stream, "Points", grains->x, grains->y, count);
    fputs("      </Points>\n", stream);
    write_vertices(stream, count);
    fputs("      <PointData Scalars=\"radius\" Vectors=\"velocity\">\n", stream);
    write_vectors(stream, "velocity", grains->vx, grains->vy, count);
    write_array(stream, "Float64", "radius", grains->radius, sizeof *grains->radius, count);
    write_array(stream, "Float64", "mass", grains->mass, sizeof *grains->mass, count);
    write_array(stream, "Float64", "angle", grains->angle, sizeof *grains->angle, count);
    write_array(stream, "Float64", "spin", grains->spin, sizeof *grains->spin, count);
    write_array(stream, "Float32", "collision_rate", grains->collision_rate,
                sizeof *grains->collision_rate, count);
    write_array(stream, "UInt32", "id", grains->id, sizeof *grains->id, count);
    write_array(stream, "UInt16", "species", grains->species, sizeof *grains->species, count);
    fputs("      </PointData>\n    </Piece>\n  </PolyData>\n</VTKFile>\n", stream);
    return file_commit(&file, error);
}
