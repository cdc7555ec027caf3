/* test_vti.c - VTK files are sound XML whose base64 gives the values back; CSV reads back too.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "measure/csv.h"
#include "measure/vti.h"

#include <unistd.h>

static char folder[] = "/tmp/vti-XXXXXX";
static char path[64];

enum { NX = 5, NY = 3, CELLS = NX * NY };

/* A scalar with a hole and a vector, on one grid. */
static void sample(struct field *scalar, struct field *vector, double *values)
{
    for (int k = 0; k < 3 * CELLS; k++) values[k] = k % 7 == 3 ? NAN : 0.1 * k - 1;
    const struct field grid = {.x0 = -1, .y0 = 2, .cell = 0.25, .nx = NX, .ny = NY, .time = 1.5};
    *scalar = *vector = grid;
    snprintf(scalar->name, sizeof scalar->name, "density");
    snprintf(vector->name, sizeof vector->name, "velocity");
    snprintf(vector->unit, sizeof vector->unit, "cm/s");
    scalar->components = 1;
    scalar->values = values;
    vector->components = 2;
    vector->values = values + CELLS;
}

/* The letters of the n-th binary array in the file, decoded. */
static size_t decode(const char *text, int n, unsigned char *bytes)
{
    static const char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (; n >= 0; n--) text = strstr(text, "format=\"binary\">") + 17;
    size_t size = 0;
    uint32_t bits = 0, held = 0;
    for (; *text && *text != '\n' && *text != '='; text++) {
        bits = bits << 6 | (uint32_t)(strchr(alphabet, *text) - alphabet);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes[size++] = (unsigned char)(bits >> held & 255);
    }
    return size;
}

static void test_the_arrays_hold_the_values_cell_by_cell(void **unused)
{
    (void)unused;
    double values[3 * CELLS], read[3 * CELLS + 1];
    struct field scalar, vector;
    struct error error;
    size_t size;
    sample(&scalar, &vector, values);
    const struct field *fields[] = {&scalar, &vector};
    CHECK(vti_save(path, fields, 2, &error));
    char *text = file_load(path, 100000, &size, &error);
    CHECK(text && strstr(text, "WholeExtent=\"0 5 0 3 0 0\" Origin=\"-1 2 0\""));
    CHECK(strstr(text, "Spacing=\"0.25 0.25 0.25\"") && strstr(text, ">1.5</DataArray>"));
    uint64_t bytes;
    CHECK(decode(text, 0, (unsigned char *)read) == 8 + CELLS * 8);
    memcpy(&bytes, read, 8);
    CHECK(bytes == CELLS * 8 && memcmp(read + 1, values, CELLS * 8) == 0);
    CHECK(decode(text, 1, (unsigned char *)read) == 8 + 3 * CELLS * 8);
    memcpy(&bytes, read, 8);
    CHECK(bytes == 3 * CELLS * 8);
    for (int k = 0; k < CELLS; k++) {
        CHECK(memcmp(&read[1 + 3 * k], &values[CELLS + k], 8) == 0);
        CHECK(memcmp(&read[2 + 3 * k], &values[2 * CELLS + k], 8) == 0);
        CHECK(read[3 + 3 * k] == 0);
    }
    free(text);
    CHECK(!vti_save("/nonexistent/a.vti", fields, 2, &error));
}

static void test_the_file_is_well_formed_xml(void **unused)
{
    (void)unused;
    const char *python = getenv("PYTHON_ANY");
    if (!python || !*python) skip();
    double values[3 * CELLS];
    struct field scalar, vector;
    struct error error;
    char command[1200];
    sample(&scalar, &vector, values);
    const struct field *fields[] = {&scalar, &vector};
    CHECK(vti_save(path, fields, 2, &error));
    snprintf(command, sizeof command, "'%s' -c \"\n"
        "import xml.etree.ElementTree as e, base64, struct\n"
        "r = e.parse('%s').getroot()\n"
        "assert r.tag == 'VTKFile' and r.get('type') == 'ImageData'\n"
        "a = r.findall('./ImageData/Piece/CellData/DataArray')\n"
        "assert [x.get('Name') for x in a] == ['density', 'velocity']\n"
        "b = base64.b64decode(a[0].text.strip(), validate=True)\n"
        "assert struct.unpack('<Q', b[:8])[0] == len(b) - 8 == %d\n"
        "v = struct.unpack('<%dd', b[8:])\n"
        "assert all(x != x if k %% 7 == 3 else x == 0.1 * k - 1 for k, x in enumerate(v))\n"
        "assert len(base64.b64decode(a[1].text.strip(), validate=True)) == %d\n\"",
        python, path, CELLS * 8, CELLS, 8 + 3 * CELLS * 8);
    CHECK(system(command) == 0);
}

static void test_a_table_of_a_map_reads_back_to_the_bit(void **unused)
{
    (void)unused;
    double values[3 * CELLS];
    struct field scalar, vector;
    struct scene scene = {.units = UNITS_CGS};
    struct error error;
    char line[256];
    sample(&scalar, &vector, values);
    values[CELLS] = 1.0 / 3;
    values[CELLS + 1] = 1e-310;
    CHECK(csv_save_field(path, &vector, &scene, &error));
    FILE *stream = fopen(path, "r");
    CHECK(stream && fgets(line, sizeof line, stream));
    CHECK(strcmp(line, "x,y,velocity_x,velocity_y\n") == 0);
    CHECK(fgets(line, sizeof line, stream) && strncmp(line, "# units: ", 9) == 0);
    for (int k = 0; k < CELLS; k++) {
        double x, y, u, v;
        CHECK(fscanf(stream, "%lf,%lf,%lf,%lf", &x, &y, &u, &v) == 4);
        CHECK(x == -1 + (k % NX + 0.5) * 0.25 && y == 2 + (k / NX + 0.5) * 0.25);
        CHECK(u == values[CELLS + k] || (isnan(u) && isnan(values[CELLS + k])));
        CHECK(v == values[2 * CELLS + k] || (isnan(v) && isnan(values[2 * CELLS + k])));
    }
    fclose(stream);
}

static void test_a_table_of_grains_has_the_columns_of_an_export(void **unused)
{
    (void)unused;
    struct scene scene = {.units = UNITS_REDUCED};
    struct grains grains;
    struct error error;
    size_t size;
    if (!grains_create(&grains, 2, 0, &error)) fail_msg("%s", error.text);
    grains.count = 2;
    grains.id[1] = 7;
    grains.x[1] = 0.1;
    grains.vy[1] = -1.0 / 3;
    grains.radius[1] = 0.5;
    grains.collision_rate[1] = 2.5f;
    grains.species[1] = 3;
    CHECK(csv_save_grains(path, &grains, &scene, &error));
    char *text = file_load(path, 1000, &size, &error);
    const char *start = "id,x,y,vx,vy,spin,radius,collision_rate,species\n# units: ";
    CHECK(text && strncmp(text, start, strlen(start)) == 0);
    CHECK(strstr(text, "\n0,0,0,0,0,0,0,0,0\n7,0.1,0,0,-0.3333333333333333,0,0.5,2.5,3\n"));
    free(text);
    grains_free(&grains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_arrays_hold_the_values_cell_by_cell),
        cmocka_unit_test(test_the_file_is_well_formed_xml),
        cmocka_unit_test(test_a_table_of_a_map_reads_back_to_the_bit),
        cmocka_unit_test(test_a_table_of_grains_has_the_columns_of_an_export),
    };
    if (!mkdtemp(folder)) return 1;
    snprintf(path, sizeof path, "%s/a", folder);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    rmdir(folder);
    return failed;
}
