/* asset.h - the files of shaders/, scenes/ and assets/, compiled into the program, so that a copy
 * of the binary is complete.  The table is made at build time by assets/embed.c.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSET_H
#define ASSET_H

#include <stddef.h>

struct asset {
    const char          *name;  /* path in the source tree, as "scenes/hourglass.cfg" */
    const unsigned char *bytes; /* followed by a zero byte, so text can be used as a string */
    size_t               size;
};

extern const struct asset asset_list[];         /* ends with a NULL name */

const struct asset *asset_find(const char *name);       /* NULL if there is none */

#endif
