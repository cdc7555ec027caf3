/* jsontext.h - JSON that is whole or not there.
 *
 * Few of jansson's calls are checked where a value is put together: one that finds no memory leaves
 * its part out, and the text would be written without it.  So the memory jansson takes is taken
 * here, which remembers for each thread that some was refused.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef JSONTEXT_H
#define JSONTEXT_H

#include <jansson.h>
#include <stdbool.h>

/* To be called before anything of jansson is. */
void jsontext_guard(void);

/* As json_dumps(); the caller frees.  NULL if the text or anything since the last call found no
 * memory. */
char *jsontext_dump(const json_t *root, size_t flags);

/* Did anything since the last jsontext_dump() find no memory? */
bool jsontext_failed(void);

#endif
