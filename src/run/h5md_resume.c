/* h5md_resume.c - going on with a trajectory whose program was stopped or killed.
 *
 * A killed writer leaves the file as one who reads beside it would have met it: all frames before
 * the last checkpoint can be read, but where its last blocks end may not be known, and to write on
 * from there would lay new blocks over old ones.  So the frames that count are written anew, into a
 * file of their own that takes the old one's place when it is whole.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/h5md.h"

#include "base/file.h"
#include "run/h5md_read.h"

#include <stdio.h>
#include <unistd.h>

static bool copy_frames(struct h5md_read *from, const struct dump_index *index, struct h5md *to,
                        uint64_t frames, struct error *error)
{
    struct grains grains = {0};
    bool done = true;
    for (uint32_t k = 0; done && k < frames; k++) {
        done = h5md_read_frame(from, k, &grains, error);
        grains.time = index->entries[k].time;
        done = done && h5md_add(to, &grains, index->entries[k].steps, error);
    }
    grains_free(&grains);
    return done;
}

static bool copy(const char *path, struct h5md *to, uint64_t frames, struct error *error)
{
    struct dump_index index = {0};
    struct h5md_read *from = h5md_read_open(path, &index, error);
    bool done = from != NULL;
    if (done && index.count < frames) {
        done = error_set(error, "%s: %u frames, but the checkpoint knows %llu; the trajectory "
                         "cannot be continued", path, index.count, (unsigned long long)frames);
    }
    done = done && copy_frames(from, &index, to, frames, error);
    dump_index_free(&index);
    h5md_read_close(from);
    return done;
}

struct h5md *h5md_resume(const char *path, uint64_t frames, const struct scene *scene,
                         struct error *error)
{
    char partial[FILE_PATH_MAX + 16];
    snprintf(partial, sizeof partial, "%s.partial", path);
    struct h5md *h5md = h5md_create(partial, scene, error);
    if (!h5md) return NULL;
    if (copy(path, h5md, frames, error) && h5md_sync(h5md, error)
        && h5md_rename(h5md, path, error)) {
        return h5md;
    }
    h5md_close(h5md, NULL);
    unlink(partial);
    return NULL;
}
