/* vti.c - see vti.h.
 *
 * Arrays lie inline as base64 of their byte count (UInt64) and their values, so the file stays
 * well-formed XML and keeps every bit.  Cells without a value are NAN, which ParaView can colour.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "measure/vti.h"

#include "base/file.h"
#include "measure/base64.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>

static void write_field(FILE *stream, const struct field *field)
{
    const size_t cells = (size_t)field->nx * field->ny;
    const uint32_t components = field->components == 1 ? 1 : 3;
    const uint64_t size = cells * components * sizeof(double);
    struct base64 letters = {.stream = stream};
    assert(field->components <= 3);
    fprintf(stream, "        <DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%" PRIu32
            "\" format=\"binary\">\n", field->name, components);
    base64_add(&letters, &size, sizeof size);
    for (size_t k = 0; k < cells; k++) {
        for (uint32_t c = 0; c < components; c++) {
            const double value = c < field->components ? field->values[c * cells + k] : 0;
            base64_add(&letters, &value, sizeof value);
        }
    }
    base64_flush(&letters);
    fprintf(stream, "\n        </DataArray>\n");
}

bool vti_save(const char *path, const struct field *const *fields, uint32_t count,
              struct error *error)
{
    struct file file;
    assert(count > 0);
    if (!file_begin(&file, path, error)) return false;
    const struct field *grid = fields[0];
    FILE *stream = file.stream;
    fprintf(stream,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n"
        "  <ImageData WholeExtent=\"0 %" PRIu32 " 0 %" PRIu32 " 0 0\" Origin=\"%.17g %.17g 0\" "
        "Spacing=\"%.17g %.17g %.17g\">\n"
        "    <FieldData>\n"
        "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">%.17g</DataArray>\n"
        "    </FieldData>\n"
        "    <Piece Extent=\"0 %" PRIu32 " 0 %" PRIu32 " 0 0\">\n"
        "      <CellData Scalars=\"%s\">\n",
        grid->nx, grid->ny, grid->x0, grid->y0, grid->cell, grid->cell, grid->cell, grid->time,
        grid->nx, grid->ny, grid->name);
    for (uint32_t k = 0; k < count; k++) {
        assert(fields[k]->nx == grid->nx);
        assert(fields[k]->ny == grid->ny);
        write_field(stream, fields[k]);
    }
    fprintf(stream, "      </CellData>\n    </Piece>\n  </ImageData>\n</VTKFile>\n");
    return file_commit(&file, error);
}
