/* table.h - reads back the tables that a run writes (log.csv, impact.csv, ...): a line of names,
 * lines that begin with '#', then numbers.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TABLE_H
#define TABLE_H

#include "base/error.h"

#include <stdint.h>

enum { TABLE_COLUMNS = 96, TABLE_NAME = 64 };

struct table {
    uint32_t columns, rows;
    char   names[TABLE_COLUMNS][TABLE_NAME];
    char   units[TABLE_COLUMNS][TABLE_NAME];    /* from "# units: ..."; "" where there are none */
    double *values;             /* row by row */
};

/* False if the file cannot be read, has no header, or a line has not as many numbers as names.
 * The caller frees. */
bool table_load(const char *path, struct table *table, struct error *error);
void table_free(struct table *table);

/* The number of the column called `name`; -1 if there is none. */
int table_find(const struct table *table, const char *name);

/* NAN for column -1. */
double table_at(const struct table *table, uint32_t row, int column);

#endif
