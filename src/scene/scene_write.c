/* scene_write.c - the resolved scene as a scene file: every key, with its default written out.
 *
 * Values that stand for "chosen when absent" or "never" (nan, inf) cannot be written, nor can an
 * empty outline: such keys are left out, with the reason as a comment.  Numbers have as many
 * digits as reading them back needs.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/file.h"
#include "base/text.h"
#include "scene/scene.h"
#include "scene/scene_key.h"
#include "scene/scene_value.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_number(FILE *out, double value)
{
    char text[40];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    /* Without a point or an exponent libconfig would read a whole number of limited size. */
    fprintf(out, "%s%s", text, strpbrk(text, ".e") ? "" : ".0");
}

static void write_text(FILE *out, const char *text)
{
    putc('"', out);
    for (const char *at = text; *at; at++) {
        if (*at == '"' || *at == '\\') fprintf(out, "\\%c", *at);
        else if (*at == '\n') fputs("\\n", out);
        else if ((unsigned char)*at < 32) fprintf(out, "\\x%02x", (unsigned)(unsigned char)*at);
        else putc(*at, out);
    }
    putc('"', out);
}

static void write_numbers(FILE *out, const double *values, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        fputs(k ? ", " : "(", out);
        write_number(out, values[k]);
    }
    fputs(count ? ")" : "()", out);
}

static void write_points(FILE *out, const struct key_reals *reals)
{
    for (uint32_t k = 0; k + 1 < reals->count; k += 2) {
        fputs(k ? ", " : "(", out);
        write_numbers(out, &reals->values[k], 2);
    }
    fputs(")", out);
}

static void write_texts(FILE *out, const struct key_texts *texts)
{
    putc('(', out);
    for (uint32_t k = 0; k < texts->count; k++) {
        if (k) fputs(", ", out);
        write_text(out, texts->texts[k]);
    }
    putc(')', out);
}

static uint32_t number_count(enum key_type type)
{
    if (type == KEY_BOX) return 4;
    if (type == KEY_VECTOR || type == KEY_RANGE) return 2;
    return type == KEY_REAL ? 1 : 0;
}

/* Why the key cannot be written; NULL if it can. */
static const char *reason_to_omit(const struct key *key, const void *at)
{
    const double *values = at;
    for (uint32_t k = 0; k < number_count(key->type); k++) {
        if (isnan(values[k])) return "chosen when absent";
        if (isinf(values[k])) return "never ends";
    }
    const bool list = key->type == KEY_REALS || key->type == KEY_POINTS;
    return list && ((const struct key_reals *)at)->count == 0 ? "none" : NULL;
}

static void write_value(FILE *out, const struct key *key, const void *at)
{
    char word[64];
    uint64_t word64;
    switch (key->type) {
    case KEY_REAL:   write_number(out, *(const double *)at); break;
    case KEY_VECTOR:
    case KEY_RANGE:
    case KEY_BOX:    write_numbers(out, at, number_count(key->type)); break;
    case KEY_COUNT:  fprintf(out, "%u", *(const uint32_t *)at); break;
    case KEY_WORD64:
        word64 = *(const uint64_t *)at;
        if (word64 <= INT32_MAX) fprintf(out, "%u", (unsigned)word64);
        else fprintf(out, "0x%llxL", (unsigned long long)word64);
        break;
    case KEY_BOOL:   fputs(*(const bool *)at ? "true" : "false", out); break;
    case KEY_CHOICE: write_text(out, key_choice_word(key->choices, *(const int *)at, word,
                                                     sizeof word));
                     break;
    case KEY_TEXT:   write_text(out, at); break;
    case KEY_REALS:  write_numbers(out, ((const struct key_reals *)at)->values,
                                   ((const struct key_reals *)at)->count);
                     break;
    case KEY_POINTS: write_points(out, at); break;
    case KEY_TEXTS:  write_texts(out, at); break;
    }
}

static void write_keys(FILE *out, const struct key_group *group, const void *target,
                       const char *indent)
{
    for (uint32_t k = 0; k < group->count; k++) {
        const struct key *key = &group->keys[k];
        const void *at = (const char *)target + key->offset;
        const char *omitted = reason_to_omit(key, at);
        if (omitted) {
            fprintf(out, "%s# %s: %s\n", indent, key->name, omitted);
            continue;
        }
        fprintf(out, "%s%s = ", indent, key->name);
        write_value(out, key, at);
        fputs(";\n", out);
    }
}

static void write_group(FILE *out, const struct key_group *group, const void *target)
{
    fprintf(out, "\n%s = {\n", group->name);
    write_keys(out, group, target, "    ");
    fputs("};\n", out);
}

/* ---- phases: what a model chose for one of them is written with it ------------------------- */

bool scene_write_value(const struct key *key, const void *at, char **value)
{
    struct text text;
    *value = NULL;
    if (reason_to_omit(key, at)) return true;
    if (text_begin(&text)) write_value(text.stream, key, at);
    *value = text_end(&text, NULL);
    return *value != NULL;
}

static bool sets_key(const struct key_texts *set, const char *path)
{
    const size_t length = strlen(path);
    for (uint32_t k = 0; k < set->count; k++) {
        const char *text = set->texts[k];
        if (strncmp(text, path, length) == 0 && (text[length] == '=' || text[length] == ' ')) {
            return true;
        }
    }
    return false;
}

/* Keys of a group that differ from the phase before and that the phase itself does not set: a
 * model completed them (a time step, a stiffness). */
static bool write_changes(FILE *out, const struct key_group *group, const char *prefix,
                          const void *before, const void *now, const struct key_texts *set,
                          bool *first)
{
    bool done = true;
    for (uint32_t k = 0; done && k < group->count; k++) {
        const struct key *key = &group->keys[k];
        char path[200], line[KEY_TEXT_MAX], *old = NULL, *value = NULL;
        snprintf(path, sizeof path, "%s.%s", prefix, key->name);
        done = scene_write_value(key, (const char *)before + key->offset, &old)
            && scene_write_value(key, (const char *)now + key->offset, &value);
        if (done && value && (!old || strcmp(old, value) != 0) && !sets_key(set, path)) {
            snprintf(line, sizeof line, "%s=%s", path, value);
            if (!*first) fputs(", ", out);
            write_text(out, line);
            *first = false;
        }
        free(old);
        free(value);
    }
    return done;
}

static bool write_phase(FILE *out, const struct scene *scene, uint32_t index)
{
    const struct phase_entry *entry = &scene->phase_entries[index];
    const struct scene *before = scene->phases[index], *now = scene->phases[index + 1];
    fputs("        time = ", out);
    write_number(out, entry->time);
    fputs(";\n        set = (", out);
    for (uint32_t k = 0; k < entry->set.count; k++) {
        if (k) fputs(", ", out);
        write_text(out, entry->set.texts[k]);
    }
    bool first = entry->set.count == 0;
    if (now->count_max != before->count_max && !sets_key(&entry->set, "count_max")) {
        fprintf(out, "%s\"count_max=%u\"", first ? "" : ", ", now->count_max);
        first = false;
    }
    bool done = true;
    for (uint32_t k = 0; done && k < before->species_count && k < now->species_count; k++) {
        char prefix[40];
        snprintf(prefix, sizeof prefix, "grains.[%u]", k);
        done = write_changes(out, scene_key_sections[0].group, prefix, &before->species[k],
                             &now->species[k], &entry->set, &first);
    }
    for (uint32_t g = 0; done && g < scene->settings_count; g++) {
        done = write_changes(out, scene->settings_groups[g], scene->settings_groups[g]->name,
                             before->settings[g], now->settings[g], &entry->set, &first);
    }
    fputs(");\n", out);
    if (entry->push.count == 0) return done;
    fputs("        push = ", out);
    write_numbers(out, entry->push.values, entry->push.count);
    fputs(";\n", out);
    return done;
}

static bool write_list(FILE *out, const struct scene_section *section, const struct scene *scene)
{
    const char *base = (const char *)scene, *entries;
    uint32_t count;
    memcpy(&entries, base + section->offset, sizeof entries);
    memcpy(&count, base + section->count_offset, sizeof count);
    if (count == 0) return true;
    bool done = true;
    fprintf(out, "\n%s = (\n", section->group->name);
    for (uint32_t k = 0; done && k < count; k++) {
        fputs("    {\n", out);
        const bool phase = section->offset == offsetof(struct scene, phase_entries);
        if (phase && k + 1 < scene->phase_count) done = write_phase(out, scene, k);
        else write_keys(out, section->group, entries + k * section->group->size, "        ");
        fprintf(out, "    }%s\n", k + 1 < count ? "," : "");
    }
    fputs(");\n", out);
    return done;
}

bool scene_write_text(const struct scene *scene, FILE *out)
{
    fprintf(out, "# %s, resolved: every key with its value\n", scene->name);
    write_keys(out, &scene_key_top, scene, "");
    bool done = true;
    for (uint32_t s = 0; s < SCENE_SECTIONS; s++) {
        const struct scene_section *section = &scene_key_sections[s];
        if (section->list) done = done && write_list(out, section, scene);
        else write_group(out, section->group, (const char *)scene + section->offset);
    }
    for (uint32_t g = 0; g < scene->settings_count; g++) {
        write_group(out, scene->settings_groups[g], scene->settings[g]);
    }
    return done;
}

bool scene_write(const struct scene *scene, const char *path, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    if (scene_write_text(scene, file.stream)) return file_commit(&file, error);
    file_abandon(&file);
    return error_set(error, "%s: not enough memory to write this scene", path);
}
