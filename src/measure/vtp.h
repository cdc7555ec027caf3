/* vtp.h - grains as VTK PolyData (XML): points that ParaView shows as spheres by their `radius`.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef VTP_H
#define VTP_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>

/* One file: a point for each grain with velocity, radius, mass, angle, spin, collision_rate, id
 * and species, and the time in the field data "TimeValue". */
bool vtp_save(const char *path, const struct grains *grains, struct error *error);

#endif
