/* findings.c - see findings.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/findings.h"

#include "scene/scene.h"
#include "scene/tree.h"

#include <stdarg.h>
#include <stdio.h>

static void keep(struct findings *findings, enum finding_kind kind, const char *file, int line,
                 const char *format, va_list arguments)
{
    findings->errors += kind == FINDING_ERROR;
    findings->warnings += kind == FINDING_WARNING;
    if (findings->count++ >= FINDINGS_MAX) return;
    struct finding *finding = &findings->list[findings->count - 1];
    finding->kind = kind;
    finding->line = line > 0 ? line : 0;
    snprintf(finding->file, sizeof finding->file, "%.127s", file ? file : "");
    vsnprintf(finding->text, sizeof finding->text, format, arguments);
}

void findings_tell_at(struct findings *findings, enum finding_kind kind, const char *file,
                      int line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    keep(findings, kind, file, line, format, arguments);
    va_end(arguments);
}

void findings_tell(struct findings *findings, const struct scene *scene, enum finding_kind kind,
                   const char *key, const char *format, ...)
{
    const char *file = scene->path;
    int line = 0;
    if (scene->places) {
        const struct tree *node = tree_nearest(scene->places->root, key);
        file = node->file;
        line = node->line;
    }
    va_list arguments;
    va_start(arguments, format);
    keep(findings, kind, file, line, format, arguments);
    va_end(arguments);
}

char *findings_line(const struct finding *finding, char *text, size_t size)
{
    const char *word = finding->kind == FINDING_ERROR ? "error" : "warning";
    if (finding->line > 0) {
        snprintf(text, size, "%s:%d: %s: %s", finding->file, finding->line, word, finding->text);
    } else {
        snprintf(text, size, "%s: %s: %s", finding->file, word, finding->text);
    }
    return text;
}
