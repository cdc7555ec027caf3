/* effect.c - see effect.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/effect.h"

#include <stdio.h>
#include <string.h>

static const char *const words[] = {
#define X(name, word, doc) word,
    EFFECTS(X)
#undef X
};

static const char *const docs[] = {
#define X(name, word, doc) doc,
    EFFECTS(X)
#undef X
};

static int lowest(effects_t set)
{
    for (int bit = 0; bit < EFFECT_COUNT; bit++) if (set >> bit & 1) return bit;
    return -1;
}

const char *effect_word(effects_t set)
{
    const int bit = lowest(set);
    return bit < 0 ? "none" : words[bit];
}

const char *effect_doc(effects_t set)
{
    const int bit = lowest(set);
    return bit < 0 ? "nothing" : docs[bit];
}

void effect_words(effects_t set, char *text, unsigned long size)
{
    snprintf(text, size, "%s", set ? "" : "none");
    for (size_t used = 0; set; set &= set - 1) {
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                 effect_word(set));
        if (used >= size) return;
    }
}
