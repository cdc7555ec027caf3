/* fuzz_checkpoint.c - any bytes as a checkpoint: refused, or loaded within its bounds.
 *
 * The first byte says how: an even one takes the rest as the whole file, whose hashes nearly always
 * give it away; an odd one as the saved state below the hashes, which is then read record by record
 * as a model would, into arrays of known size.
 *
 * The hashes guard against damage, not against a forger: what a model makes of a state with the
 * right hashes is for test_forged.c.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/archive.h"
#include "run/checkpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { ROOM = 64 };

static char folder[64];

static void remove_folder(void)
{
    char path[100];
    snprintf(path, sizeof path, "%s/0.checkpoint", folder);
    unlink(path);
    rmdir(folder);
}

static void try_file(const uint8_t *data, size_t size)
{
    char path[100];
    struct error error;
    if (!folder[0]) {
        snprintf(folder, sizeof folder, "%s/fuzz.XXXXXX",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
        if (!mkdtemp(folder)) abort();
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/0.checkpoint", folder);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0) abort();
    void *bytes;
    size_t loaded;
    uint64_t turn;
    if (checkpoint_load(folder, "seed = 1;\n", &bytes, &loaded, &turn, &error)) free(bytes);
}

static void try_state(const uint8_t *data, size_t size)
{
    uint32_t count = 0, phase = 0, *words = calloc(ROOM, sizeof *words);
    double *numbers = calloc(ROOM, sizeof *numbers);
    struct archive archive;
    if (!words || !numbers) abort();
    archive_begin_load(&archive, data, size);
    archive_count(&archive, "simulation.phase", &phase, 3);
    archive_count(&archive, "md.count", &count, ROOM);
    archive_array(&archive, "dsmc.x", numbers, count);
    archive_array(&archive, "md.strip", words, ROOM);
    archive_value(&archive, "run.wall", numbers);
    if (phase > 3 || count > ROOM) abort();
    archive_end(&archive);
    free(words);
    free(numbers);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0) return 0;
    if (data[0] % 2 == 0) try_file(data + 1, size - 1);
    else try_state(data + 1, size - 1);
    return 0;
}
