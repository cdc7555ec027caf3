/* asset.c - see asset.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/asset.h"

#include <string.h>

const struct asset *asset_find(const char *name)
{
    for (const struct asset *asset = asset_list; asset->name; asset++) {
        if (strcmp(asset->name, name) == 0) return asset;
    }
    return NULL;
}
