/* vti.h - maps as VTK ImageData (XML), for ParaView and VTK; written without the VTK library.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef VTI_H
#define VTI_H

#include "base/error.h"
#include "model/field.h"

#include <stdbool.h>

/* One file with `count` maps of the same grid as cell data named like the fields; vectors get a
 * third component 0, as VTK wants, and the time is in the field data "TimeValue". */
bool vti_save(const char *path, const struct field *const *fields, uint32_t count,
              struct error *error);

#endif
