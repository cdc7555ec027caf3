/* fuzz_command.c - any line as a command of a live session.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/command.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct command_line line;
    struct error error = {0};
    char *text = malloc(size + 1);      /* its own block, so that a read behind the end is seen */
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = 0;
    const bool parsed = command_parse(text, &line, &error);
    if (parsed && line.verb > COMMAND_NONE) abort();
    if (!parsed && error.text[0] == 0) abort();                 /* refused without a reason */
    free(text);
    return 0;
}
