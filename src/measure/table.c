/* table.c - see table.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/table.h"

#include "base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t size_max = (size_t)1 << 30;

/* Copies the words between commas; returns how many there are. */
static uint32_t split(const char *line, size_t length, char words[TABLE_COLUMNS][TABLE_NAME])
{
    uint32_t count = 0;
    for (size_t at = 0; at <= length && count < TABLE_COLUMNS; count++) {
        size_t word = 0;
        while (at + word < length && line[at + word] != ',') word++;
        snprintf(words[count], TABLE_NAME, "%.*s", (int)word, line + at);
        at += word + 1;
    }
    return count;
}

/* The numbers of a line; false if there are more or fewer than columns. */
static bool read_row(const char *line, size_t length, struct table *table, double *row)
{
    const char *end = line + length;
    for (uint32_t c = 0; c < table->columns; c++) {
        char *after;
        if (line > end) return false;
        row[c] = line < end && *line != ',' ? strtod(line, &after) : NAN;
        if (line < end && *line != ',' && after == line) return false;
        while (line < end && *line != ',') line++;
        line++;
    }
    return line == end + 1;
}

static bool read_all(struct table *table, const char *text, const char *path,
                     struct error *error)
{
    size_t lines = 1;
    for (const char *at = text; *at; at++) lines += *at == '\n';
    for (uint32_t line = 1; *text; line++) {
        const size_t length = strcspn(text, "\n");
        const char *next = text + length + (text[length] == '\n');
        static const char units[] = "# units: ";
        if (line == 1) {
            table->columns = split(text, length, table->names);
            table->values = calloc(lines * table->columns, sizeof *table->values);
            if (!table->values) return error_set(error, "%s: not enough memory to read it", path);
        } else if (strncmp(text, units, sizeof units - 1) == 0) {
            split(text + sizeof units - 1, length - (sizeof units - 1), table->units);
        } else if (*text != '#' && length > 0) {
            double *row = table->values + (size_t)table->rows * table->columns;
            if (!read_row(text, length, table, row)) {
                return error_set(error, "%s:%u: not %u numbers, as the first line has names", path,
                                 line, table->columns);
            }
            table->rows++;
        }
        text = next;
    }
    return table->columns > 0 || error_set(error, "%s: an empty table", path);
}

bool table_load(const char *path, struct table *table, struct error *error)
{
    size_t size;
    memset(table, 0, sizeof *table);
    char *text = file_load(path, size_max, &size, error);
    if (!text) return false;
    const bool done = read_all(table, text, path, error);
    free(text);
    if (!done) table_free(table);
    return done;
}

void table_free(struct table *table)
{
    free(table->values);
    table->values = NULL;
    table->rows = table->columns = 0;
}

int table_find(const struct table *table, const char *name)
{
    for (uint32_t c = 0; c < table->columns; c++) {
        if (strcmp(table->names[c], name) == 0) return (int)c;
    }
    return -1;
}

double table_at(const struct table *table, uint32_t row, int column)
{
    return column < 0 ? NAN : table->values[(size_t)row * table->columns + (uint32_t)column];
}
