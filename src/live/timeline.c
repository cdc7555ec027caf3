/* timeline.c - see timeline.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/timeline.h"

#include "base/asset.h"
#include "base/text.h"
#include "run/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENE_BYTES_MAX = 64 << 20 };

static bool no_memory(struct error *error)
{
    return error_set(error, "not enough memory for a session");
}

/* ---- lists of overrides ------------------------------------------------------------------- */

void timeline_free_texts(struct timeline_texts *texts)
{
    for (uint32_t k = 0; k < texts->count; k++) free(texts->texts[k]);
    free(texts->texts);
    *texts = (struct timeline_texts){0};
}

static size_t key_length(const char *text)
{
    return strcspn(text, "= ");
}

bool timeline_put(struct timeline_texts *texts, const char *text, struct error *error)
{
    char *copy = strdup(text);
    if (!copy) return no_memory(error);
    const size_t length = key_length(text);
    for (uint32_t k = 0; k < texts->count; k++) {
        const char *old = texts->texts[k];
        if (key_length(old) != length || strncmp(old, text, length) != 0) continue;
        free(texts->texts[k]);
        memmove(&texts->texts[k], &texts->texts[k + 1],
                (texts->count - k - 1) * sizeof *texts->texts);
        texts->texts[texts->count - 1] = copy;  /* last, as it was said last */
        return true;
    }
    char **grown = realloc(texts->texts, (texts->count + 1) * sizeof *grown);
    if (!grown) {
        free(copy);
        return no_memory(error);
    }
    texts->texts = grown;
    texts->texts[texts->count++] = copy;
    return true;
}

static bool copy_texts(const struct timeline_texts *from, struct timeline_texts *to,
                       struct error *error)
{
    *to = (struct timeline_texts){0};
    for (uint32_t k = 0; k < from->count; k++) {
        if (!timeline_put(to, from->texts[k], error)) return false;
    }
    return true;
}

/* ---- the scene's text --------------------------------------------------------------------- */

static char *read_scene(const char *path, struct error *error)
{
    char name[FILE_PATH_MAX];
    size_t size;
    if (setup_is_run(path)) {
        return file_load(folder_path(name, path, "scene.cfg"), SCENE_BYTES_MAX, &size, error);
    }
    snprintf(name, sizeof name, "scenes/%s.cfg", path);
    const struct asset *asset = strchr(path, '/') || strstr(path, ".cfg") ? NULL : asset_find(name);
    if (!asset) return file_load(path, SCENE_BYTES_MAX, &size, error);
    char *text = strdup((const char *)asset->bytes);
    if (!text) no_memory(error);
    return text;
}

bool timeline_open(struct timeline *timeline, const char *path, const char *text,
                   const char *const *overrides, uint32_t override_count, struct error *error)
{
    *timeline = (struct timeline){.path = strdup(path)};
    if (!timeline->path) return no_memory(error);
    timeline->text = text ? strdup(text) : read_scene(path, error);
    if (!timeline->text) return text ? no_memory(error) : false;
    for (uint32_t k = 0; k < override_count; k++) {
        if (!timeline_put(&timeline->overrides, overrides[k], error)) return false;
    }
    return true;
}

static void free_entries(struct timeline *timeline)
{
    timeline_cut(timeline, 0);
    free(timeline->entries);
    timeline->entries = NULL;
}

void timeline_close(struct timeline *timeline)
{
    free_entries(timeline);
    timeline_free_texts(&timeline->overrides);
    free(timeline->path);
    free(timeline->text);
    *timeline = (struct timeline){0};
}

/* ---- changes ------------------------------------------------------------------------------ */

struct timeline_entry *timeline_at(struct timeline *timeline, double time, struct error *error)
{
    uint32_t at = 0;
    while (at < timeline->entry_count && timeline->entries[at].time < time) at++;
    if (at < timeline->entry_count && timeline->entries[at].time == time) {
        return &timeline->entries[at];
    }
    struct timeline_entry *grown = realloc(timeline->entries,
                                           (timeline->entry_count + 1) * sizeof *grown);
    if (!grown) {
        no_memory(error);
        return NULL;
    }
    timeline->entries = grown;
    memmove(&grown[at + 1], &grown[at], (timeline->entry_count - at) * sizeof *grown);
    grown[at] = (struct timeline_entry){.time = time};
    timeline->entry_count++;
    return &grown[at];
}

uint32_t timeline_phase(const struct timeline *timeline, const struct timeline_entry *entry)
{
    return (uint32_t)(entry - timeline->entries) + 1;
}

bool timeline_push(struct timeline_entry *entry, const double push[PHASE_PUSH],
                   struct error *error)
{
    double *grown = realloc(entry->push, (entry->push_count + PHASE_PUSH) * sizeof *grown);
    if (!grown) return no_memory(error);
    memcpy(grown + entry->push_count, push, PHASE_PUSH * sizeof *grown);
    entry->push = grown;
    entry->push_count += PHASE_PUSH;
    return true;
}

static bool append_entry(struct timeline *timeline, const struct timeline_entry *from,
                         struct error *error)
{
    struct timeline_entry *to = timeline_at(timeline, from->time, error);
    if (!to || !copy_texts(&from->sets, &to->sets, error)) return false;
    for (uint32_t k = 0; k < from->push_count; k += PHASE_PUSH) {
        if (!timeline_push(to, from->push + k, error)) return false;
    }
    return true;
}

void timeline_cut(struct timeline *timeline, uint32_t count)
{
    while (timeline->entry_count > count) {
        struct timeline_entry *last = &timeline->entries[--timeline->entry_count];
        timeline_free_texts(&last->sets);
        free(last->push);
    }
}

bool timeline_append(struct timeline *timeline, const struct timeline *from, double time,
                     struct error *error)
{
    for (uint32_t k = 0; k < from->entry_count; k++) {
        if (from->entries[k].time <= time) continue;
        if (!append_entry(timeline, &from->entries[k], error)) return false;
    }
    return true;
}

bool timeline_copy(const struct timeline *timeline, struct timeline *copy, struct error *error)
{
    if (!timeline_open(copy, timeline->path, timeline->text,
                       (const char *const *)timeline->overrides.texts,
                       timeline->overrides.count, error)) {
        return false;
    }
    return timeline_append(copy, timeline, 0, error);
}

bool timeline_adopt(struct timeline *timeline, const struct scene *scene, struct error *error)
{
    free_entries(timeline);
    for (uint32_t k = 0; k < scene->phase_entry_count; k++) {
        const struct phase_entry *phase = &scene->phase_entries[k];
        struct timeline_entry entry = {.time = phase->time, .push_count = phase->push.count,
                                       .push = phase->push.values};
        bool done = true;
        for (uint32_t t = 0; done && t < phase->set.count; t++) {
            done = timeline_put(&entry.sets, phase->set.texts[t], error);
        }
        done = done && append_entry(timeline, &entry, error);
        timeline_free_texts(&entry.sets);
        if (!done) return false;
    }
    return true;
}

/* ---- the scene ---------------------------------------------------------------------------- */

static void write_quoted(FILE *out, const char *text)
{
    putc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') putc('\\', out);
        putc(*text, out);
    }
    putc('"', out);
}

/* "phases=({time = ...; set = (...); push = (...);}, ...)"; the caller frees. */
static char *phases_text(const struct timeline *timeline)
{
    struct text text;
    if (!text_begin(&text)) return text_end(&text, NULL);
    FILE *out = text.stream;
    fputs("phases=(", out);
    for (uint32_t k = 0; k < timeline->entry_count; k++) {
        const struct timeline_entry *entry = &timeline->entries[k];
        fprintf(out, "%s{time = %.17e; set = (", k ? ", " : "", entry->time);
        for (uint32_t s = 0; s < entry->sets.count; s++) {
            if (s) fputs(", ", out);
            write_quoted(out, entry->sets.texts[s]);
        }
        fputs(");", out);
        for (uint32_t p = 0; p < entry->push_count; p++) {
            fprintf(out, "%s%.17e", p ? ", " : " push = (", entry->push[p]);
        }
        fputs(entry->push_count ? ");}" : "}", out);
    }
    fputs(")", out);
    return text_end(&text, NULL);
}

/* The first error that was found, without the number of the phase, which users did not choose. */
static bool tell_finding(const struct findings *findings, struct error *error)
{
    for (uint32_t k = 0; findings && k < findings->count && k < FINDINGS_MAX; k++) {
        if (findings->list[k].kind != FINDING_ERROR) continue;
        const char *text = findings->list[k].text;
        const char *end = strncmp(text, "phases.[", 8) == 0 ? strstr(text, "]: ") : NULL;
        return error_set_code(error, EXIT_SCENE, "%s", end ? end + 3 : text);
    }
    return false;
}

bool timeline_setup(const struct timeline *timeline, const struct scene *grains_of,
                    const struct timeline_texts *extra, struct setup *setup,
                    struct error *error)
{
    *setup = (struct setup){0};
    const uint32_t more = extra ? extra->count : 0;
    const char **overrides = malloc((timeline->overrides.count + more + 1) * sizeof *overrides);
    char *phases = timeline->entry_count ? phases_text(timeline) : NULL;
    if (!overrides || (timeline->entry_count && !phases)) {
        free(overrides);
        free(phases);
        return no_memory(error);
    }
    uint32_t count = 0;
    for (uint32_t k = 0; k < timeline->overrides.count; k++) {
        overrides[count++] = timeline->overrides.texts[k];
    }
    for (uint32_t k = 0; k < more; k++) overrides[count++] = extra->texts[k];
    if (phases) overrides[count++] = phases;
    const struct setup_request request = {
        .path = timeline->path, .text = timeline->text, .overrides = overrides,
        .override_count = count, .place = !grains_of, .grains_of = grains_of,
    };
    const bool done = setup_load(setup, &request, error);
    if (!done) {
        tell_finding(setup->findings, error);
        setup_free(setup);
    }
    free(overrides);
    free(phases);
    return done;
}
