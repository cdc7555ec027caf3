/* grainfile.c - see grainfile.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/grainfile.h"

#include "base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { COLUMNS_MAX = 64, WORD_MAX = 40 };

static const size_t bytes_max = (size_t)1 << 34;

/* What the columns are called elsewhere; the value is column times `scale` plus `shift`. */
static const struct { const char *name; int value; double scale, shift; bool scaled; } names[] = {
    {"id", GRAINFILE_id, 1, 0, false},          {"species", GRAINFILE_species, 1, 0, false},
    {"type", GRAINFILE_species, 1, -1, false},
    {"x", GRAINFILE_x, 1, 0, false},            {"y", GRAINFILE_y, 1, 0, false},
    {"xu", GRAINFILE_x, 1, 0, false},           {"yu", GRAINFILE_y, 1, 0, false},
    {"xs", GRAINFILE_x, 1, 0, true},            {"ys", GRAINFILE_y, 1, 0, true},
    {"vx", GRAINFILE_vx, 1, 0, false},          {"vy", GRAINFILE_vy, 1, 0, false},
    {"spin", GRAINFILE_spin, 1, 0, false},      {"omegaz", GRAINFILE_spin, 1, 0, false},
    {"radius", GRAINFILE_radius, 1, 0, false},  {"r", GRAINFILE_radius, 1, 0, false},
    {"diameter", GRAINFILE_radius, 0.5, 0, false},
};

/* A text that is read line by line, and how its columns are to be understood. */
struct reader {
    struct grainfile *file;
    const char *path;
    char   *at;                 /* the coming line */
    uint32_t line;              /* number of the last one */
    int      columns[COLUMNS_MAX];      /* entry of `names`; -1: unknown */
    uint32_t column_count;
    struct error *error;
};

/* The next line, its end cut off; NULL at the end. */
static char *next_line(struct reader *reader)
{
    char *line = reader->at;
    if (!*line) return NULL;
    const size_t length = strcspn(line, "\n");
    reader->at = line + length + (line[length] == '\n');
    line[length] = 0;
    if (length > 0 && line[length - 1] == '\r') line[length - 1] = 0;
    reader->line++;
    return line;
}

static bool is_blank(const char *line) { return line[strspn(line, " \t")] == 0; }

/* Copies the next word; false if there is none. */
static bool take_word(const char **at, char word[WORD_MAX])
{
    *at += strspn(*at, " ,\t\"");
    const size_t length = strcspn(*at, " ,\t\"");
    snprintf(word, WORD_MAX, "%.*s", (int)(length < WORD_MAX ? length : WORD_MAX - 1), *at);
    *at += length;
    return length > 0;
}

static void read_names(struct reader *reader, const char *line)
{
    char word[WORD_MAX];
    reader->column_count = 0;
    while (reader->column_count < COLUMNS_MAX && take_word(&line, word)) {
        int found = -1;
        for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
            if (strcasecmp(names[n].name, word) == 0) found = (int)n;
        }
        reader->columns[reader->column_count++] = found;
        if (found >= 0) reader->file->has[names[found].value] = true;
    }
}

static bool complain(struct reader *reader, const char *why)
{
    return error_set(reader->error, "%s:%u: %s", reader->path, reader->line, why);
}

static bool has_place(struct reader *reader)
{
    const bool *has = reader->file->has;
    return (has[GRAINFILE_x] && has[GRAINFILE_y])
        || complain(reader, "no columns called x and y are named here");
}

static bool grow(struct reader *reader)
{
    struct grainfile *file = reader->file;
    if (file->count < file->capacity) return true;
    const uint32_t capacity = file->capacity ? 2 * file->capacity : 1024;
    void *rows = realloc(file->rows, capacity * sizeof *file->rows);
    if (!rows) return error_set(reader->error, "%s: not enough memory to read it", reader->path);
    file->rows = rows;
    file->capacity = capacity;
    return true;
}

/* One grain from a line of numbers in the order of the columns. */
static bool read_row(struct reader *reader, const char *line, double *row)
{
    char word[WORD_MAX];
    for (uint32_t c = 0; c < reader->column_count; c++) {
        if (!take_word(&line, word)) return complain(reader, "this line has too few numbers");
        const int column = reader->columns[c];
        if (column < 0) continue;
        char *end;
        double value = strtod(word, &end) * names[column].scale + names[column].shift;
        if (end == word || *end || !isfinite(value)) {
            return complain(reader, "a number is malformed or not finite");
        }
        if (names[column].scaled) {
            const int axis = names[column].value == GRAINFILE_y;
            const double *box = reader->file->box;
            value = box[axis] + value * (box[axis + 2] - box[axis]);
        }
        row[names[column].value] = value;
    }
    return true;
}

static bool add_row(struct reader *reader, const char *line)
{
    if (!grow(reader)) return false;
    double *row = reader->file->rows[reader->file->count];
    memset(row, 0, sizeof *reader->file->rows);
    if (!read_row(reader, line, row)) return false;
    reader->file->count++;
    return true;
}

/* ---- CSV ----------------------------------------------------------------------------------- */

static bool read_csv(struct reader *reader)
{
    for (char *line; (line = next_line(reader));) {
        if (is_blank(line) || *line == '#') continue;
        if (reader->column_count == 0) {
            read_names(reader, line);
            if (!has_place(reader)) return false;
        } else if (!add_row(reader, line)) {
            return false;
        }
    }
    return true;
}

/* ---- LAMMPS dumps -------------------------------------------------------------------------- */

static bool read_bounds(struct reader *reader)
{
    double *box = reader->file->box;
    for (int axis = 0; axis < 3; axis++) {
        const char *line = next_line(reader);
        double low, high;
        if (!line || sscanf(line, "%lf %lf", &low, &high) != 2 || !(high > low)) {
            return complain(reader, "the bounds of the box are malformed");
        }
        if (axis < 2) {
            box[axis] = low;
            box[axis + 2] = high;
        }
    }
    reader->file->has_box = true;
    return true;
}

static bool read_dump(struct reader *reader)
{
    static const char bounds[] = "ITEM: BOX BOUNDS", atoms[] = "ITEM: ATOMS";
    unsigned long wanted = 0;
    for (char *line; (line = next_line(reader));) {
        if (strncmp(line, "ITEM: NUMBER OF ATOMS", 21) == 0) {
            line = next_line(reader);
            if (!line || sscanf(line, "%lu", &wanted) != 1) {
                return complain(reader, "the number of atoms is malformed");
            }
        } else if (strncmp(line, bounds, sizeof bounds - 1) == 0) {
            if (!read_bounds(reader)) return false;
        } else if (strncmp(line, atoms, sizeof atoms - 1) == 0) {
            reader->file->count = 0;            /* the last snapshot counts */
            memset(reader->file->has, 0, sizeof reader->file->has);
            read_names(reader, line + sizeof atoms - 1);
            if (!has_place(reader)) return false;
            for (unsigned long k = 0; k < wanted; k++) {
                line = next_line(reader);
                if (!line) return complain(reader, "the file ends within a snapshot");
                if (!add_row(reader, line)) return false;
            }
        }
    }
    return true;
}

/* ---- LAMMPS data --------------------------------------------------------------------------- */

static uint32_t count_words(const char *line)
{
    char word[WORD_MAX];
    uint32_t count = 0;
    while (take_word(&line, word)) count++;
    return count;
}

/* Atoms of a style that has three image flags at the end or not. */
static bool read_atoms(struct reader *reader, const char *style, unsigned long wanted)
{
    for (unsigned long k = 0; k < wanted; k++) {
        char *line = next_line(reader);
        if (line && is_blank(line)) {
            k--;
            continue;
        }
        if (!line) return complain(reader, "the file ends within the atoms");
        if (reader->file->count == 0) {
            const uint32_t words = count_words(line);
            const bool sphere = strstr(style, "sphere") || words == 7 || words == 10;
            if (!sphere && words != 5 && words != 8) {
                return complain(reader, "this style of atoms is not known; use atom_style "
                                "sphere or atomic");
            }
            read_names(reader, sphere ? "id type diameter density x y z" : "id type x y z");
        }
        if (!add_row(reader, line)) return false;
    }
    return true;
}

static int row_compare(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (p[GRAINFILE_id] > q[GRAINFILE_id]) - (p[GRAINFILE_id] < q[GRAINFILE_id]);
}

static void sort_rows(struct grainfile *file)
{
    if (file->has[GRAINFILE_id] && file->count) {
        qsort(file->rows, file->count, sizeof *file->rows, row_compare);
    }
}

/* Velocities name their atoms: id vx vy vz, then for spheres three angular velocities. */
static bool read_velocities(struct reader *reader)
{
    struct grainfile *file = reader->file;
    sort_rows(file);
    for (uint32_t k = 0; k < file->count; k++) {
        char *line = next_line(reader);
        if (!line) return complain(reader, "the file ends within the velocities");
        if (is_blank(line)) {
            k--;
            continue;
        }
        if (k == 0) read_names(reader, count_words(line) >= 7 ? "id vx vy vz wx wy omegaz"
                                                              : "id vx vy vz");
        double row[GRAINFILE_VALUE_COUNT] = {0};
        if (!read_row(reader, line, row)) return false;
        double (*found)[GRAINFILE_VALUE_COUNT] = bsearch(row, file->rows, file->count,
                                                         sizeof *file->rows, row_compare);
        if (!found) return complain(reader, "a velocity belongs to no atom");
        (*found)[GRAINFILE_vx] = row[GRAINFILE_vx];
        (*found)[GRAINFILE_vy] = row[GRAINFILE_vy];
        (*found)[GRAINFILE_spin] = row[GRAINFILE_spin];
    }
    return true;
}

static bool read_data(struct reader *reader)
{
    unsigned long wanted = 0;
    double low, high;
    double *box = reader->file->box;
    next_line(reader);                  /* a comment, whatever it says */
    for (char *line; (line = next_line(reader));) {
        if (strstr(line, " atoms") && sscanf(line, "%lu atoms", &wanted) != 1) {
            return complain(reader, "the number of atoms is malformed");
        }
        const int bounds = sscanf(line, "%lf %lf", &low, &high);
        if (bounds == 2 && strstr(line, "xlo xhi")) {
            box[0] = low;
            box[2] = high;
            reader->file->has_box = true;
        } else if (bounds == 2 && strstr(line, "ylo yhi")) {
            box[1] = low;
            box[3] = high;
        } else if (strncmp(line, "Atoms", 5) == 0) {
            if (!read_atoms(reader, line, wanted)) return false;
        } else if (strncmp(line, "Velocities", 10) == 0 && !read_velocities(reader)) {
            return false;
        }
    }
    return true;
}

/* ---- the whole ----------------------------------------------------------------------------- */

bool grainfile_load(const char *path, struct grainfile *file, struct error *error)
{
    size_t size;
    *file = (struct grainfile){0};
    char *text = file_load(path, bytes_max, &size, error);
    if (!text) return false;
    struct reader reader = {.file = file, .path = path, .at = text, .error = error};
    bool done;
    if (strncmp(text, "ITEM:", 5) == 0) done = read_dump(&reader);
    else if (strstr(text, "\nAtoms")) done = read_data(&reader);
    else done = read_csv(&reader);
    sort_rows(file);
    free(text);
    return done && (file->count > 0 || error_set(error, "%s: no grain is in it; it should be CSV "
        "with columns x,y, a LAMMPS dump or a LAMMPS data file", path));
}

void grainfile_free(struct grainfile *file)
{
    free(file->rows);
    *file = (struct grainfile){0};
}
