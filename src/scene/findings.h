/* findings.h - everything that is wrong with a scene, told at once.
 *
 * Each finding names the place, what, why and the cure:
 *     hourglass.cfg:14: error: unknown key 'grains.restituton'; did you mean 'restitution'?
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FINDINGS_H
#define FINDINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum finding_kind { FINDING_WARNING, FINDING_ERROR };

struct finding {
    enum finding_kind kind;
    char file[128];             /* as the user named it; "-s" for an override */
    int  line;                  /* 0 if no line is to blame */
    char text[512];             /* what, why, cure; no line feed */
};

enum { FINDINGS_MAX = 100 };    /* more are counted, not kept */

struct findings {
    uint32_t count, errors, warnings;       /* all that were told, kept or not */
    struct finding list[FINDINGS_MAX];
};

/* Tells a finding about the value at `key` ("grains.[0].restitution", "md.dt"; "" for none): the
 * place is looked up in the scene's record of where each key was given. */
struct scene;
void findings_tell(struct findings *findings, const struct scene *scene, enum finding_kind kind,
                   const char *key, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* Tells a finding at a place that is known already. */
void findings_tell_at(struct findings *findings, enum finding_kind kind, const char *file,
                      int line, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* "file:line: error: text", as one line (no line feed); returns text. */
char *findings_line(const struct finding *finding, char *text, size_t size);

#endif
