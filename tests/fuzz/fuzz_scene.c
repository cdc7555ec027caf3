/* fuzz_scene.c - any bytes as a scene file: refused with findings, or resolved.
 *
 * Grains are not placed: a scene may well ask for a billion of them.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/setup.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = 0;
    struct setup setup;
    struct error error;
    const struct setup_request request = {.path = "fuzzed.cfg", .text = text};
    const bool loaded = setup_load(&setup, &request, &error);
    if (!loaded && setup.findings && setup.findings->errors == 0) abort();  /* without a reason */
    setup_free(&setup);
    free(text);
    return 0;
}
