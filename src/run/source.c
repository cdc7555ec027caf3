/* source.c - see source.h. */
#include "run/source.h"

#include "base/clock.h"
#include "run/folder.h"
#include "run/look.h"

#include <math.h>
#include <string.h>

static bool has_dumps(const char *path)
{
    char index[FILE_PATH_MAX];
    return setup_is_run(path) && file_exists(folder_path(index, path, "dump/index.csv"));
}

bool source_open(struct source *source, const struct setup *setup, const char *path,
                 bool contacts, struct error *error)
{
    *source = (struct source){.setup = setup, .contacts = contacts};
    source->from_dumps = has_dumps(path);
    source->wall = source->from_dumps ? NAN : 0;
    if (source->from_dumps) return dumps_open(&source->dumps, path, error);
    return simulation_create(&source->sim, setup->model, setup->scene, error);
}

double source_end(const struct source *source)
{
    const struct dump_index *index = &source->dumps.index;
    return source->from_dumps ? index->entries[index->count - 1].time : source->setup->scene->until;
}

void source_close(struct source *source)
{
    dumps_close(&source->dumps);
    if (source->sim.state) simulation_destroy(&source->sim);
    grains_free(&source->grains);
}

static void tell(struct source *source, double t)
{
    if (!source->report) return;
    const struct counters now = simulation_count(&source->sim);
    const double share = t > 0 ? now.time / t : 1;
    const bool each = strstr(source->sim.model->work, "particle") != NULL;
    const double work = (double)now.steps * (each ? (double)now.grains : 1);
    const struct run_status status = {
        .doing = "simulating", .work = source->sim.model->work, .time = now.time, .until = t,
        .share = share, .rate = source->wall > 0 ? work / source->wall : 0, .wall = source->wall,
        .eta = share > 0 ? source->wall * (1 - share) / share : NAN, .steps = now.steps,
        .grains = now.grains,
    };
    source->report(source->context, &status);
}

static bool simulate_to(struct source *source, double t, struct error *error)
{
    uint64_t budget = 64;
    for (;;) {
        const double start = clock_wall();
        const enum advance outcome = simulation_advance(&source->sim, t, budget, error);
        const double took = clock_wall() - start;
        source->wall += took;
        if (outcome == ADVANCE_BROKEN) return false;
        if (outcome == ADVANCE_REACHED) return true;
        if (took < 0.025 && budget < UINT64_MAX / 4) budget *= 2;
        tell(source, source_end(source));
        if (source->signal && *source->signal) {
            return error_set_code(error, (enum exit_code)(128 + *source->signal),
                                  "stopped by a signal; nothing was written");
        }
    }
}

bool source_go(struct source *source, double t, struct error *error)
{
    if (source->from_dumps) {
        source->entry = dumps_nearest(&source->dumps, t);
        source->steps = source->dumps.index.entries[source->entry].steps;
        return dumps_load(&source->dumps, source->entry, &source->grains, error);
    }
    if (!simulate_to(source, t, error)) return false;
    source->steps = simulation_count(&source->sim).steps;
    return look_at(&source->sim, &source->grains, source->contacts, error);
}
