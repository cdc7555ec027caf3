/* h5md_pack.c - see h5md_pack.h.
 *
 * While a trajectory grows, where the library puts a chunk depends on what was written to the disk
 * before it, and when: each checkpoint leaves its mark, and so does a run that was killed within a
 * frame.  A copy of the finished file has the groups and then each dataset chunk by chunk, in the
 * order of their names: its bytes follow from the contents alone.  Chunks are copied as they are
 * compressed, so this costs little more than copying a file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/h5md_pack.h"

#include "run/h5md.h"

#ifdef SANDREEL_HDF5

#include "base/file.h"

#include <errno.h>
#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static bool copy_groups(hid_t from, hid_t to)
{
    static const char *const groups[] = {"h5md", "parameters", "particles"};
    bool done = true;
    for (size_t k = 0; done && k < sizeof groups / sizeof *groups; k++) {
        done = H5Ocopy(from, groups[k], to, groups[k], H5P_DEFAULT, H5P_DEFAULT) >= 0;
    }
    return done;
}

/* A copy that can be continued like the original: in the newest format, without dates. */
static bool copy(const char *path, const char *partial)
{
    const hid_t how = H5Pcreate(H5P_FILE_ACCESS), root = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_libver_bounds(how, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    H5Pset_obj_track_times(root, false);
    const hid_t from = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t to = from >= 0 ? H5Fcreate(partial, H5F_ACC_TRUNC, root, how) : -1;
    bool done = to >= 0 && copy_groups(from, to);
    if (to >= 0) done = H5Fclose(to) >= 0 && done;
    if (from >= 0) H5Fclose(from);
    H5Pclose(root);
    H5Pclose(how);
    return done;
}

bool h5md_pack(const char *path, struct error *error)
{
    char partial[FILE_PATH_MAX + 16];
    snprintf(partial, sizeof partial, "%s.partial", path);
    const bool copied = copy(path, partial) && file_sync(partial);
    if (copied && rename(partial, path) == 0) return true;
    const int cause = errno;
    unlink(partial);
    return error_set(error, "%s: this trajectory cannot be packed: %s", path,
                     copied ? strerror(cause) : "is the disk full?");
}

#else

bool h5md_pack(const char *path, struct error *error)
{
    (void)path;
    return h5md_available(error);
}

#endif
