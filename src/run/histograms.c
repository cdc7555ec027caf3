/* histograms.c - see histograms.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/histograms.h"

#include "measure/csv.h"
#include "run/folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool open_one(struct ledger *ledger, const char *directory, const char *name,
                     const char *header, const char *time, bool resume, struct error *error)
{
    char path[FILE_PATH_MAX];
    if (!ledger_open(ledger, folder_path(path, directory, "%s", name), resume, error)) return false;
    if (!resume) fprintf(ledger->stream, header, time, time);
    return ledger_flush(ledger, error);
}

bool histograms_open(struct histograms *histograms, const char *directory,
                     const struct simulation *sim, bool resume, struct error *error)
{
    const struct scene *scene = sim->scene;
    const char *time = scene_unit(scene, "time");
    *histograms = (struct histograms){.bins = scene->measure.impact_bins};
    if (histograms->bins == 0) histograms->bins = 1;
    if (scene_effects(scene) & EFFECT_IMPACT) {
        histograms->before = calloc(histograms->bins, sizeof *histograms->before);
        if (!histograms->before) return error_set(error, "not enough memory for a histogram");
        if (!open_one(&histograms->impact, directory, "impact.csv",
                      "from,to,b,collisions,density\n# units: %s,%s,diameters,1,1\n", time, resume,
                      error)) {
            return false;
        }
    }
    return !(scene_effects(scene) & EFFECT_COLLISION_COUNT)
        || open_one(&histograms->collisions, directory, "collisions.csv",
                    "from,to,contacts,grains,grains_elastic\n# units: %s,%s,per grain,1,1\n", time,
                    resume, error);
}

bool histograms_wanted(const struct histograms *histograms)
{
    return histograms->impact.stream || histograms->collisions.stream;
}

static void write_times(FILE *out, double from, double to)
{
    csv_number(out, from);
    fputc(',', out);
    csv_number(out, to);
}

static void write_impacts(struct histograms *histograms, const struct tally_impact *impact,
                          double time)
{
    FILE *out = histograms->impact.stream;
    const uint32_t bins = histograms->bins;
    double total = 0;
    for (uint32_t k = 0; k < bins; k++) total += impact->count[k] - histograms->before[k];
    for (uint32_t k = 0; k < bins; k++) {
        const double count = impact->count[k] - histograms->before[k];
        write_times(out, histograms->from, time);
        fprintf(out, ",%.6g,%.0f,", (k + 0.5) / bins, count);
        csv_number(out, total > 0 ? count * bins / total : 0);
        fputc('\n', out);
        histograms->before[k] = impact->count[k];
    }
    histograms->impact.rows += bins;
}

/* No run numbers as many grains; a saved state that does was forged. */
enum { IDS_MAX = 1 << 28 };

/* Room for grains with ids below `count`; new ones have had no contact. */
static bool know(struct histograms *histograms, uint32_t count, struct error *error)
{
    if (count <= histograms->known_count) return true;
    if (count > IDS_MAX) {
        return error_set(error, "a grain has the number %u; collisions are counted for numbers "
                         "below %u", count - 1, IDS_MAX);
    }
    const uint32_t room = count + count / 2;
    struct histograms_grain *known = realloc(histograms->known, room * sizeof *known);
    if (!known) return error_set(error, "not enough memory to count collisions of %u grains", room);
    memset(known + histograms->known_count, 0, (room - histograms->known_count) * sizeof *known);
    histograms->known = known;
    histograms->known_count = room;
    return true;
}

static int by_size(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* How many entries of the ascending list are equal to the one at `at`; moves on behind them. */
static uint32_t count_equal(const uint32_t *list, uint32_t count, uint32_t value, uint32_t *at)
{
    const uint32_t first = *at;
    while (*at < count && list[*at] == value) ++*at;
    return *at - first;
}

static bool write_counts(struct histograms *histograms, const struct grains *grains, double time,
                         struct error *error)
{
    const uint32_t n = grains->count;
    uint32_t ids = 0;
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t id = grains->id[k];
        if (id >= ids) ids = id < IDS_MAX ? id + 1 : IDS_MAX + 1;
    }
    uint32_t *contacts = malloc((size_t)n * sizeof *contacts + 1),
             *elastic = malloc((size_t)n * sizeof *elastic + 1);
    bool done = know(histograms, ids, error);
    if (done && (!contacts || !elastic)) done = error_set(error, "not enough memory for counts");
    for (uint32_t k = 0; done && k < n; k++) {
        struct histograms_grain *known = &histograms->known[grains->id[k]];
        contacts[k] = grains->collisions[k] - known->contacts;
        elastic[k] = grains->collisions_elastic[k] - known->elastic;
        *known = (struct histograms_grain){grains->collisions[k], grains->collisions_elastic[k]};
    }
    if (done && n > 0) {
        qsort(contacts, n, sizeof *contacts, by_size);
        qsort(elastic, n, sizeof *elastic, by_size);
    }
    for (uint32_t a = 0, b = 0; done && (a < n || b < n); histograms->collisions.rows++) {
        const uint32_t value = b == n || (a < n && contacts[a] < elastic[b]) ? contacts[a]
                                                                             : elastic[b];
        const uint32_t with = count_equal(contacts, n, value, &a),
                       among = count_equal(elastic, n, value, &b);
        write_times(histograms->collisions.stream, histograms->from, time);
        fprintf(histograms->collisions.stream, ",%u,%u,%u\n", value, with, among);
    }
    free(contacts);
    free(elastic);
    return done;
}

bool histograms_block(struct histograms *histograms, const struct simulation *sim,
                      const struct grains *grains, struct error *error)
{
    const struct tally *tally = simulation_tally(sim);
    const double time = grains->time;
    bool done = true;
    if (!(time > histograms->from)) return true;
    if (histograms->impact.stream && tally && tally->impact.bins == histograms->bins) {
        write_impacts(histograms, &tally->impact, time);
        done = ledger_flush(&histograms->impact, error);
    }
    const bool counts = histograms->collisions.stream
                     && sim->phase_scene->effects & EFFECT_COLLISION_COUNT;
    if (done && counts) {
        done = write_counts(histograms, grains, time, error)
            && ledger_flush(&histograms->collisions, error);
    }
    histograms->from = time;
    return done;
}

bool histograms_resume(struct histograms *histograms, struct error *error)
{
    return (!histograms->impact.stream || ledger_resume(&histograms->impact, error))
        && (!histograms->collisions.stream || ledger_resume(&histograms->collisions, error));
}

bool histograms_sync(struct histograms *histograms, struct error *error)
{
    return (!histograms->impact.stream || ledger_sync(&histograms->impact, error))
        && (!histograms->collisions.stream || ledger_sync(&histograms->collisions, error));
}

void histograms_archive(struct histograms *histograms, struct archive *archive)
{
    if (!histograms_wanted(histograms)) return;
    archive_value(archive, "histograms.from", &histograms->from);
    ledger_archive(&histograms->impact, "histograms.impact", archive);
    ledger_archive(&histograms->collisions, "histograms.collisions", archive);
    archive_array(archive, "histograms.before", histograms->before, histograms->bins);
    uint32_t count = histograms->known_count;
    const size_t most = archive->mode == ARCHIVE_LOAD ? archive->size / sizeof *histograms->known
                                                      : IDS_MAX;
    archive_count(archive, "histograms.known_count", &count, (uint32_t)fmin((double)most, IDS_MAX));
    struct error minor = {0};
    if (!know(histograms, count, &minor)) archive_fail(archive, minor.text);
    else archive_array(archive, "histograms.known", histograms->known, count);
}

void histograms_close(struct histograms *histograms)
{
    ledger_close(&histograms->impact);
    ledger_close(&histograms->collisions);
    free(histograms->before);
    free(histograms->known);
    *histograms = (struct histograms){0};
}
