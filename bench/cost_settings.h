/* cost_settings.h - the settings that `cost` tries, and factors on what a model chooses itself.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COST_SETTINGS_H
#define COST_SETTINGS_H

#include "bench/cost.h"

/* "MODEL KEY=VALUE ..."; VALUE may be *2, a factor on what the model chooses itself, or, for a
 * stiffness, `hertz` or `linear`: as stiff as now at the greatest overlap, by the other law. */
extern const char *const cost_settings_list[];          /* ends with NULL */

/* The first word of a setting: a model's name. */
const char *cost_settings_model(const char *setting, char *name, size_t size);

/* Keys of one setting; factors become numbers.  `chosen` is the scene as that model completes it.
 * False: there is no such value here, so the setting is none. */
bool cost_settings_keys(const char *setting, const struct setup *chosen, struct cost_point *point);

/* One key "PATH=VALUE" of a setting as the override `text`; false if there is no such value. */
bool cost_settings_key(const char *word, const struct setup *chosen, char text[COST_KEY]);

/* The time step of the model; NAN if it takes none. */
double cost_settings_step(const struct setup *setup);

#endif
