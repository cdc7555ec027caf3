/* h5md_layout.h - what trajectory.h5 says of a grain, for those who write it and who read it.
 *
 * Besides these, `position` and `velocity` are pairs of doubles.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef H5MD_LAYOUT_H
#define H5MD_LAYOUT_H

/* X(name in the file, member of struct grains, HDF5 type, its dimension) of one number a grain */
#define H5MD_SCALARS(X)                                                         \
    X(id,               id,             H5T_NATIVE_UINT32, "1")                 \
    X(species,          species,        H5T_NATIVE_UINT16, "1")                 \
    X(mass,             mass,           H5T_NATIVE_DOUBLE, "mass")              \
    X(radius,           radius,         H5T_NATIVE_DOUBLE, "length")            \
    X(angle,            angle,          H5T_NATIVE_DOUBLE, "1")                 \
    X(angular_velocity, spin,           H5T_NATIVE_DOUBLE, "1/time")            \
    X(collision_rate,   collision_rate, H5T_NATIVE_FLOAT,  "1/time")

/* The id in rows without a grain. */
#define H5MD_NO_ID UINT32_MAX

#endif
