/* exporter.c - see exporter.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/exporter.h"

#include "measure/csv.h"
#include "measure/dump.h"
#include "measure/snapshot.h"
#include "measure/vtp.h"
#include "run/folder.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct {
    const char *name, *file;
    void (*write)(FILE *, const struct grains *, const struct scene *, uint64_t);
} formats_table[EXPORTER_FORMAT_COUNT] = {
#define X(name, file, writer, doc) {#name, file, writer},
    EXPORTER_FORMATS(X)
#undef X
};

static bool wants(const struct exporter *exporter, int format)
{
    return exporter->formats >> format & 1;
}

bool exporter_parse(const char *words, unsigned *formats, struct error *error)
{
    *formats = 0;
    while (*words) {
        const size_t length = strcspn(words, ",");
        int f = 0;
        while (f < EXPORTER_FORMAT_COUNT && (strlen(formats_table[f].name) != length
               || memcmp(formats_table[f].name, words, length) != 0)) f++;
        if (f == EXPORTER_FORMAT_COUNT) {
            return error_set_code(error, EXIT_USAGE, "--to: unknown format '%.*s'; `sandreel help "
                                  "export` lists them", (int)length, words);
        }
        *formats |= 1u << f;
        words += length + (words[length] == ',');
    }
    return *formats || error_set_code(error, EXIT_USAGE, "--to: no format is named");
}

static char *trajectory_path(const struct exporter *exporter, char path[FILE_PATH_MAX],
                             const char *ending)
{
    return folder_path(path, exporter->directory, "trajectory.h5%s", ending);
}

bool exporter_open(struct exporter *exporter, const struct scene *scene, const char *directory,
                   unsigned formats, bool force, struct error *error)
{
    char path[FILE_PATH_MAX];
    *exporter = (struct exporter){.scene = scene, .formats = formats, .keeps = !force};
    snprintf(exporter->directory, sizeof exporter->directory, "%s", directory);
    if (!file_make_directory(directory, error)) return false;
    for (int f = 0; f < EXPORTER_FORMAT_COUNT; f++) {
        if (!wants(exporter, f) || !formats_table[f].file) continue;
        folder_path(path, directory, "%s", formats_table[f].file);
        if (exporter->keeps && !file_absent(path, error)) return false;
        if (!file_begin(&exporter->texts[f], path, error)) return false;
    }
    if (wants(exporter, EXPORTER_vti)
        && !mapper_open(&exporter->mapper, scene, &scene->view, &scene->measure,
                        1u << MAPPER_BIT_vti, error)) {
        return false;
    }
    exporter->mapper.keeps = exporter->keeps;
    if (!wants(exporter, EXPORTER_h5md)) return true;
    if (exporter->keeps && !file_absent(trajectory_path(exporter, path, ""), error)) return false;
    exporter->h5md = h5md_create(trajectory_path(exporter, path, ".partial"), scene, error);
    return exporter->h5md != NULL;
}

/* The path of a frame's own file; false if it is there already and is to be kept. */
static bool frame_path(const struct exporter *exporter, char path[FILE_PATH_MAX], uint32_t frame,
                       const char *ending, struct error *error)
{
    folder_path(path, exporter->directory, "grains_%06u.%s", frame, ending);
    return !exporter->keeps || file_absent(path, error);
}

/* The formats that make files of their own for each frame. */
static bool write_files(struct exporter *exporter, const struct grains *grains, uint32_t frame,
                        struct error *error)
{
    const struct scene *scene = exporter->scene;
    char path[FILE_PATH_MAX], suffix[16];
    bool done = true;
    if (wants(exporter, EXPORTER_csv)) {
        done = frame_path(exporter, path, frame, "csv", error)
            && csv_save_grains(path, grains, scene, error);
    }
    if (done && wants(exporter, EXPORTER_npy)) {
        done = frame_path(exporter, path, frame, "npy", error) && dump_save(path, grains, error);
    }
    if (done && wants(exporter, EXPORTER_vtp)) {
        done = frame_path(exporter, path, frame, "vtp", error)
            && vtp_save(path, grains, error);
    }
    if (done && wants(exporter, EXPORTER_vti)) {
        snprintf(suffix, sizeof suffix, "%06u", frame);
        mapper_clear(&exporter->mapper);
        mapper_add(&exporter->mapper, grains);
        done = mapper_write(&exporter->mapper, exporter->directory, suffix, error);
    }
    return done;
}

bool exporter_add(struct exporter *exporter, const struct grains *grains, uint32_t frame,
                  uint64_t steps, struct error *error)
{
    for (int f = 0; f < EXPORTER_FORMAT_COUNT; f++) {
        FILE *stream = exporter->texts[f].stream;
        if (stream) formats_table[f].write(stream, grains, exporter->scene, steps);
    }
    if (exporter->h5md && !h5md_add(exporter->h5md, grains, steps, error)) return false;
    return write_files(exporter, grains, frame, error);
}

bool exporter_commit(struct exporter *exporter, struct error *error)
{
    for (int f = 0; f < EXPORTER_FORMAT_COUNT; f++) {
        if (exporter->texts[f].stream && !file_commit(&exporter->texts[f], error)) return false;
    }
    if (!exporter->h5md) return true;
    char partial[FILE_PATH_MAX], path[FILE_PATH_MAX];
    struct h5md *h5md = exporter->h5md;
    exporter->h5md = NULL;
    trajectory_path(exporter, partial, ".partial");
    trajectory_path(exporter, path, "");
    const bool synced = h5md_sync(h5md, error);
    if (h5md_close(h5md, synced ? error : NULL) && synced) {
        if (rename(partial, path) == 0) return true;
        error_set(error, "%s: cannot name this file: %s", path, strerror(errno));
    }
    unlink(partial);
    return false;
}

void exporter_close(struct exporter *exporter)
{
    char path[FILE_PATH_MAX];
    for (int f = 0; f < EXPORTER_FORMAT_COUNT; f++) file_abandon(&exporter->texts[f]);
    if (exporter->h5md) {
        h5md_close(exporter->h5md, NULL);
        unlink(trajectory_path(exporter, path, ".partial"));
    }
    mapper_close(&exporter->mapper);
    *exporter = (struct exporter){0};
}
