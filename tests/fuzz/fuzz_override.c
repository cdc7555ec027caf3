/* fuzz_override.c - any lines as -s KEY=VALUE over a good scene.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/setup.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define PLAIN                                                                       \
    "until = 4; box = (0, 0, 10, 10); gravity = (0, -1);\n"                         \
    "grains = ( { radius = 0.5; restitution = 0.9; } );\n"                          \
    "placements = ( { count = 20; } );\n"                                           \
    "walls = ( { shape = \"segment\"; from = (1, 1); to = (9, 1); } );\n"

/* A phase is the scene read once more, so most inputs do without. */
static const char plain[] = PLAIN,
    phased[] = PLAIN "phases = ( { time = 1.0; set = (\"grains.restitution=0.5\"); } );\n";

enum { LINES_MAX = 4 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    const char *lines[LINES_MAX];
    uint32_t count = 0;
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = 0;
    for (char *line = text; line && count < LINES_MAX;) {
        char *end = strchr(line, '\n');
        if (end) *end = 0;
        lines[count++] = line;
        line = end ? end + 1 : NULL;
    }
    struct setup setup;
    struct error error;
    const struct setup_request request = {.path = "fuzzed.cfg", .text = size % 4 ? plain : phased,
                                          .overrides = lines, .override_count = count};
    const bool loaded = setup_load(&setup, &request, &error);
    if (!loaded && setup.findings && setup.findings->errors == 0) abort();  /* without a reason */
    setup_free(&setup);
    free(text);
    return 0;
}
