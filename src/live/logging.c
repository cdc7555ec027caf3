/* logging.c - see logging.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/logging.h"

#include "run/folder.h"
#include "run/look.h"

#include <math.h>

/* Two times nearer than this share are meant to be the same. */
static const double same_time = 1e-9;

static bool is_open(const struct logging *logging)
{
    return logging->book.ledger.stream != NULL;
}

bool logging_open(struct logging *logging, const char *directory, const struct simulation *sim,
                  struct error *error)
{
    char path[FILE_PATH_MAX];
    const struct scene *scene = sim->scene;
    const double now = simulation_count(sim).time;
    *logging = (struct logging){.interval = scene->output.log, .until = scene->until};
    folder_remove(directory, "log.csv");
    if (!(logging->interval > 0)) return true;
    logging->next = (uint64_t)ceil(now / logging->interval * (1 - same_time));
    return logbook_open(&logging->book, folder_path(path, directory, "log.csv"), sim, false, error)
        && (logging_due(logging) > now || logging_row(logging, sim, 0, error));
}

void logging_close(struct logging *logging)
{
    if (is_open(logging)) logbook_close(&logging->book);
    grains_free(&logging->grains);
    *logging = (struct logging){0};
}

double logging_due(const struct logging *logging)
{
    if (!is_open(logging)) return INFINITY;
    /* A multiple that rounding puts behind the scene's end is meant for it, as in a run. */
    const double t = (double)logging->next * logging->interval;
    return fabs(t - logging->until) <= same_time * t ? logging->until : t;
}

bool logging_row(struct logging *logging, const struct simulation *sim, double wall,
                 struct error *error)
{
    logging->next++;
    if (logging->book.stress && !look_at(sim, &logging->grains, false, error)) return false;
    return logbook_row(&logging->book, sim, &logging->grains, wall, error);
}

void logging_archive(struct logging *logging, struct archive *archive)
{
    if (!is_open(logging)) return;
    archive_value(archive, "log.next", &logging->next);
    logbook_archive(&logging->book, archive);
}

bool logging_return(struct logging *logging, const struct archive *state, struct error *error)
{
    struct archive load;
    if (!is_open(logging)) return true;
    archive_begin_load(&load, state->bytes, state->size);
    logging_archive(logging, &load);
    const bool done = !load.failed || error_set(error, "%s", load.reason);
    archive_end(&load);
    return done && ledger_resume(&logging->book.ledger, error);
}
