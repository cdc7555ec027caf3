/* results.c - see results.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/results.h"

#include "measure/csv.h"
#include "measure/stats.h"
#include "run/folder.h"
#include "run/recall.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS_MAX = 200, NAME_MAX_LENGTH = 64 };

/* A log as numbers, row after row. */
struct table {
    uint32_t columns, rows;
    char    (*names)[NAME_MAX_LENGTH];
    double  *values;
};

char *results_point(char path[4096], const char *directory, uint32_t point)
{
    return folder_path(path, directory, "points/%06u", point);
}

char *results_cause(char path[4096], const char *directory, uint32_t point)
{
    return folder_path(path, directory, "points/%06u.failed", point);
}

static void table_free(struct table *table)
{
    free(table->names);
    free(table->values);
    *table = (struct table){0};
}

static void read_names(struct table *table, const char *line)
{
    while (*line && table->columns < COLUMNS_MAX) {
        const size_t length = strcspn(line, ",");
        snprintf(table->names[table->columns++], NAME_MAX_LENGTH, "%.*s", (int)length, line);
        line += length + (line[length] == ',');
    }
}

static bool table_load(struct table *table, const char *path, struct error *error)
{
    size_t size;
    *table = (struct table){.names = calloc(COLUMNS_MAX, sizeof *table->names)};
    if (!table->names) return error_set(error, "%s: not enough memory to read it", path);
    char *text = file_load(path, (size_t)1 << 32, &size, error);
    if (!text) return false;
    uint32_t lines = 0;
    for (const char *at = text; *at; at++) lines += *at == '\n';
    char *rest = NULL;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        if (*line == '#') continue;
        if (table->columns == 0) {
            read_names(table, line);
            table->values = calloc((size_t)lines * table->columns + 1, sizeof *table->values);
            if (!table->values) break;
            continue;
        }
        double *row = table->values + (size_t)table->rows++ * table->columns;
        for (uint32_t c = 0; c < table->columns; c++) {
            char *end;
            row[c] = strtod(line, &end);
            if (end == line) row[c] = NAN;
            line = end + strcspn(end, ",");
            line += *line == ',';
        }
    }
    free(text);
    return table->values || error_set(error, "%s: cannot be read, or not enough memory", path);
}

static int find_column(const struct table *table, const char *name)
{
    for (uint32_t c = 0; c < table->columns; c++) {
        if (strcmp(table->names[c], name) == 0) return (int)c;
    }
    return -1;
}

/* The last value of a column, its mean over the time from `from` on, and the mean's error. */
static bool summarise(const struct table *table, const char *name, double from, double *scratch,
                      double out[3], struct error *error)
{
    const int column = find_column(table, name), time = find_column(table, "time");
    out[0] = out[1] = out[2] = NAN;
    if (column < 0 || time < 0 || table->rows == 0) return true;
    size_t count = 0;
    for (uint32_t r = 0; r < table->rows; r++) {
        const double *row = table->values + (size_t)r * table->columns;
        if (row[time] >= from * (1 - 1e-9)) scratch[count++] = row[column];
        out[0] = row[column];
    }
    struct stats_mean mean;
    if (count == 0) return true;
    if (!stats_mean(scratch, count, &mean, error)) return false;
    out[1] = mean.mean;
    out[2] = mean.error;
    return true;
}

static double number_of(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* One line; the columns are those of the first run's log. */
static bool write_point(const struct plan *plan, uint32_t point, const char *run,
                        const json_t *manifest, double from, struct table *first, FILE *stream,
                        struct error *error)
{
    struct table table;
    char path[FILE_PATH_MAX];
    bool done = table_load(&table, folder_path(path, run, "log.csv"), error);
    double *scratch = done ? calloc(table.rows + 1, sizeof *scratch) : NULL;
    if (scratch) {
        const bool begins = first->columns == 0;
        if (begins) {
            plan_header(plan, stream);
            fputs(",time,steps,run_seconds", stream);
        }
        const struct table *names = begins ? &table : first;
        for (uint32_t c = 0; begins && c < names->columns; c++) {
            const char *name = names->names[c];
            if (strcmp(name, "time") == 0 || strcmp(name, "steps") == 0) continue;
            fprintf(stream, ",%s,%s_mean,%s_error", name, name, name);
        }
        if (begins) fputc('\n', stream);
        plan_row(plan, point, stream);
        const json_t *total = json_object_get(json_object_get(manifest, "seconds"), "total");
        const double numbers[] = {number_of(manifest, "time"),
                                  number_of(json_object_get(manifest, "counts"), "steps"),
                                  number_of(total, "wall")};
        csv_numbers(stream, ',', numbers, 3);
        for (uint32_t c = 0; done && c < names->columns; c++) {
            const char *name = names->names[c];
            if (strcmp(name, "time") == 0 || strcmp(name, "steps") == 0) continue;
            double summary[3];
            done = summarise(&table, name, from, scratch, summary, error);
            csv_numbers(stream, ',', summary, 3);
        }
        fputc('\n', stream);
        if (begins) {
            *first = table;
            table = (struct table){0};
        }
    } else if (done) {
        done = error_set(error, "not enough memory for the results");
    }
    free(scratch);
    table_free(&table);
    return done;
}

/* The reason, quoted for CSV. */
static bool write_cause(const struct plan *plan, uint32_t point, const char *path, FILE *stream,
                        struct error *error)
{
    size_t size;
    char *text = file_load(path, 1 << 16, &size, error);
    if (!text) return false;
    plan_row(plan, point, stream);
    fputs(",\"", stream);
    for (const char *at = text; *at; at++) {
        if (*at == '"') fputc('"', stream);
        fputc(*at == '\n' ? ' ' : *at, stream);
    }
    fputs("\"\n", stream);
    free(text);
    return true;
}

static bool write_tables(const struct plan *plan, uint32_t count, const char *directory,
                         double from, struct error *error)
{
    struct file good = {0}, bad = {0};
    struct table first = {0};
    char path[FILE_PATH_MAX], run[FILE_PATH_MAX];
    bool done = file_begin(&good, folder_path(path, directory, "results.csv"), error)
             && file_begin(&bad, folder_path(path, directory, "failed.csv"), error);
    uint32_t failures = 0;
    for (uint32_t point = 0; done && point < count; point++) {
        json_t *manifest = NULL;
        results_point(run, directory, point);
        if (file_exists(folder_path(path, run, "manifest.json"))) {
            manifest = recall_manifest(run, error);
            done = manifest != NULL;
        }
        if (recall_says_done(manifest)) {
            done = write_point(plan, point, run, manifest, from, &first, good.stream, error);
        } else if (file_exists(results_cause(path, directory, point))) {
            if (failures++ == 0) {
                plan_header(plan, bad.stream);
                fputs(",cause\n", bad.stream);
            }
            done = done && write_cause(plan, point, path, bad.stream, error);
        }
        json_decref(manifest);
    }
    table_free(&first);
    if (done) done = file_commit(&good, error);
    if (done && failures) done = file_commit(&bad, error);
    else if (done) folder_remove(directory, "failed.csv");
    file_abandon(&good);
    file_abandon(&bad);
    return done;
}

bool results_write(const struct plan *plan, uint32_t count, const char *directory, double from,
                   struct error *error)
{
    char path[FILE_PATH_MAX];
    const int lock = open(folder_path(path, directory, "lock"), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock < 0 || lockf(lock, F_LOCK, 0) != 0) {
        if (lock >= 0) close(lock);
        return error_set(error, "%s: cannot lock this file; is the directory writable?", path);
    }
    const bool done = write_tables(plan, count, directory, from, error);
    close(lock);
    return done;
}
