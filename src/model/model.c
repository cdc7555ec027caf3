/* model.c - the list of models; nothing else in sandreel names one.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/model.h"

#include <stdio.h>
#include <string.h>

extern const struct model model_dsmc, model_ed, model_lga, model_md;

const struct model *const model_list[] = {&model_md, &model_ed, &model_dsmc, &model_lga, NULL};

const struct model *model_find(const char *name)
{
    for (const struct model *const *m = model_list; *m; m++) {
        if (strcmp((*m)->name, name) == 0) return *m;
    }
    return NULL;
}

void model_names(effects_t effects, char *text, unsigned long size)
{
    size_t used = 0;
    snprintf(text, size, "none");
    for (const struct model *const *m = model_list; *m && used < size; m++) {
        if (effects & ~(*m)->effects) continue;
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", (*m)->name);
    }
}

uint32_t model_settings(const struct key_group *groups[static MODEL_MAX])
{
    uint32_t count = 0;
    for (const struct model *const *m = model_list; *m; m++) {
        if ((*m)->settings && count < MODEL_MAX) groups[count++] = (*m)->settings;
    }
    return count;
}
