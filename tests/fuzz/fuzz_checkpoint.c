/* fuzz_checkpoint.c - any bytes as a checkpoint: refused, or a state that can go on.
 *
 * The first byte says how: 0 takes the rest as the whole file, which its hashes nearly always give
 * away; any other value takes it as the saved state itself, below the hashes, for the model of
 * that number (what a forger could do who computes them anew).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/file.h"
#include "model/simulation.h"
#include "run/checkpoint.h"
#include "run/setup.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char scene[] =
    "seed = 3; until = 4.0; box = (0.0, 0.0, 12.0, 12.0);\n"
    "grains = ( { radius = 0.5; restitution = 0.9; friction = 0.3; } );\n"
    "placements = ( { count = 12; spacing = 1.3; jitter = 0.5; temperature = 1.0; } );\n";

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

static void try_state(unsigned number, const uint8_t *data, size_t size)
{
    static struct setup setups[MODEL_MAX];
    struct setup *setup = &setups[number];
    struct error error;
    struct simulation sim;
    struct archive archive;
    char model[40];
    snprintf(model, sizeof model, "model=\"%s\"", model_list[number]->name);
    const char *const overrides[] = {model, "grains.friction=0"};
    const struct setup_request request = {.path = "fuzzed.cfg", .text = scene, .place = true,
        .overrides = overrides, .override_count = 2};
    if (!setup->scene && !setup_load(setup, &request, &error)) abort();
    if (!simulation_create(&sim, setup->model, setup->scene, &error)) abort();
    archive_begin_load(&archive, data, size);
    if (simulation_load(&sim, &archive, &error)) {
        for (int k = 1; k <= 3; k++) simulation_advance(&sim, 0.05 * k, 200, &error);
        simulation_digest(&sim);
    }
    simulation_destroy(&sim);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned models = 0;
    while (model_list[models]) models++;
    if (size == 0) return 0;
    if (data[0] == 0) try_file(data + 1, size - 1);
    else try_state(data[0] % models, data + 1, size - 1);
    return 0;
}
