/* footage.c - see footage.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/footage.h"

#include "base/clock.h"
#include "run/folder.h"
#include "run/look.h"

#include <math.h>

bool footage_has_dumps(const char *path)
{
    return setup_is_run(path) && dumps_kept(path);
}

bool footage_open(struct footage *footage, const struct setup *setup, const char *path,
                 bool contacts, struct error *error)
{
    *footage = (struct footage){.setup = setup, .contacts = contacts};
    footage->from_dumps = footage_has_dumps(path);
    footage->wall = footage->from_dumps ? NAN : 0;
    if (footage->from_dumps) {
        if (!dumps_open(&footage->dumps, path, error)) return false;
        return !(contacts && footage->dumps.trajectory)
            || error_set_code(error, EXIT_USAGE, "%s: trajectory.h5 knows no contacts, so no "
                              "forces can be drawn; run it again with -s output.dump=true "
                              "-s output.contacts=true", path);
    }
    return simulation_create(&footage->sim, setup->model, setup->scene, error);
}

double footage_end(const struct footage *footage)
{
    const struct dump_index *index = &footage->dumps.index;
    if (!footage->from_dumps) return footage->setup->scene->until;
    return index->entries[index->count - 1].time;
}

void footage_close(struct footage *footage)
{
    dumps_close(&footage->dumps);
    if (footage->sim.state) simulation_destroy(&footage->sim);
    grains_free(&footage->grains);
}

static void tell(struct footage *footage, double t)
{
    if (!footage->report) return;
    const struct counters now = simulation_count(&footage->sim);
    const double share = t > 0 ? now.time / t : 1;
    const struct run_status status = {
        .doing = "simulating", .work = footage->sim.model->work, .time = now.time, .until = t,
        .share = share, .rate = footage->wall > 0 ? (double)now.steps / footage->wall : 0,
        .wall = footage->wall,
        .eta = share > 0 ? footage->wall * (1 - share) / share : NAN, .steps = now.steps,
        .grains = now.grains,
    };
    footage->report(footage->context, &status);
}

static bool simulate_to(struct footage *footage, double t, struct error *error)
{
    uint64_t budget = 64;
    for (;;) {
        const double start = clock_wall();
        const enum advance outcome = simulation_advance(&footage->sim, t, budget, error);
        const double took = clock_wall() - start;
        footage->wall += took;
        if (outcome == ADVANCE_BROKEN) return false;
        if (outcome == ADVANCE_REACHED) return true;
        if (took < 0.025 && budget < UINT64_MAX / 4) budget *= 2;
        tell(footage, footage_end(footage));
        if (footage->signal && *footage->signal) {
            return error_set_code(error, (enum exit_code)(128 + *footage->signal),
                                  "stopped by a signal; nothing was written");
        }
    }
}

bool footage_go(struct footage *footage, double t, struct error *error)
{
    if (footage->from_dumps) {
        footage->entry = dumps_nearest(&footage->dumps, t);
        footage->steps = footage->dumps.index.entries[footage->entry].steps;
        return dumps_load(&footage->dumps, footage->entry, &footage->grains, error);
    }
    if (!simulate_to(footage, t, error)) return false;
    footage->steps = simulation_count(&footage->sim).steps;
    return look_at(&footage->sim, &footage->grains, footage->contacts, error);
}
