/* build.c - see build.h.  The versions are those of the libraries that run, where they tell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/build.h"

#include <libconfig.h>
#include <omp.h>
#include <png.h>

#include <fftw3.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#ifdef SANDREEL_MPI
#include <mpi.h>
#include <string.h>
#endif

const char *const build_version = SANDREEL_VERSION;

static json_t *freetype_version(void)
{
    FT_Library library;
    int major = 0, minor = 0, patch = 0;
    if (FT_Init_FreeType(&library) == 0) {
        FT_Library_Version(library, &major, &minor, &patch);
        FT_Done_FreeType(library);
    }
    return json_sprintf("%d.%d.%d", major, minor, patch);
}

json_t *build_versions(void)
{
    json_t *versions = json_pack("{s:s, s:s, s:s, s:o, s:s, s:s, s:s, s:i}",
        "sandreel", build_version, "compiler", __VERSION__, "libpng", png_get_libpng_ver(NULL),
        "freetype", freetype_version(), "fftw", fftw_version, "jansson", jansson_version_str(),
        "libconfig", SANDREEL_LIBCONFIG, "openmp", _OPENMP);
#ifdef SANDREEL_TERMINAL
    json_object_set_new(versions, "terminal", json_string(SANDREEL_TERMINAL));
#endif
#ifdef SANDREEL_MICROHTTPD
    json_object_set_new(versions, "libmicrohttpd", json_string(SANDREEL_MICROHTTPD));
#endif
#ifdef SANDREEL_HDF5
    json_object_set_new(versions, "hdf5", json_string(SANDREEL_HDF5));
#endif
#ifdef SANDREEL_MPI
    char library[MPI_MAX_LIBRARY_VERSION_STRING];
    int length;
    MPI_Get_library_version(library, &length);
    library[strcspn(library, ",\n")] = 0;
    json_object_set_new(versions, "mpi", json_string(library));
#endif
    return versions;
}
