/* logbook.c - see logbook.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/logbook.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A number as text: 12 digits, enough for every plot; the bytes are the same on every machine. */
#define REAL "%.12g"

static void write_header(const struct logbook *logbook, const struct scene *scene)
{
    FILE *out = logbook->stream;
    fputs("time", out);
#define X(name, dimension) fputs("," #name, out);
    LOG_WHOLES(X) LOG_ENERGIES(X) LOG_COLLISIONS(X) LOG_MOMENTA(X)
    fputs(",wall_seconds", out);
    LOG_EXTRAS(X)
#undef X
    for (uint32_t b = 0; b < logbook->body_count; b++) {
        fprintf(out, ",obstacle%u_fx,obstacle%u_fy,obstacle%u_torque,obstacle%u_contacts", b, b, b,
                b);
    }
    if (logbook->masses) fputs(",mass_in,mass_out", out);
    fprintf(out, "\n# units: %s", scene_unit(scene, "time"));
#define X(name, dimension) fprintf(out, ",%s", scene_unit(scene, dimension));
    LOG_WHOLES(X) LOG_ENERGIES(X) LOG_COLLISIONS(X) LOG_MOMENTA(X)
    fputs(",s", out);
    LOG_EXTRAS(X)
#undef X
    for (uint32_t b = 0; b < logbook->body_count; b++) {
        fprintf(out, ",%s,%s,%s,", scene_unit(scene, "force"), scene_unit(scene, "force"),
                scene_unit(scene, "torque"));
    }
    const char *mass = scene_unit(scene, "mass");
    if (logbook->masses) fprintf(out, ",%s,%s", mass, mass);
    fputc('\n', out);
}

static bool flush(struct logbook *logbook, struct error *error)
{
    errno = 0;
    if (fflush(logbook->stream) != 0 || ferror(logbook->stream)) {
        logbook->failed = true;
        return error_set(error, "%s: writing stopped: %s", logbook->path,
                         errno ? strerror(errno) : "is the disk full?");
    }
    const long at = ftell(logbook->stream);
    if (at >= 0) logbook->size = (uint64_t)at;
    return true;
}

bool logbook_open(struct logbook *logbook, const char *path, const struct simulation *sim,
                  bool resume, struct error *error)
{
    const struct tally *tally = simulation_tally(sim);
    *logbook = (struct logbook){.body_count = tally ? tally->body_count : 0};
    logbook->masses = sim->scene->effects & (EFFECT_INFLOW | EFFECT_OUTFLOW | EFFECT_SCREEN)
                   && tally;
    snprintf(logbook->path, sizeof logbook->path, "%s", path);
    logbook->impulse_last = calloc(3 * (size_t)logbook->body_count + 1, sizeof(double));
    if (!logbook->impulse_last) return error_set(error, "not enough memory for the log");
    logbook->stream = fopen(path, resume ? "r+b" : "wb");
    if (!logbook->stream) {
        return error_set(error, "%s: cannot open this file: %s", path, strerror(errno));
    }
    if (resume) return true;
    write_header(logbook, sim->scene);
    return flush(logbook, error);
}

bool logbook_resume(struct logbook *logbook, struct error *error)
{
    bool done = fseek(logbook->stream, 0, SEEK_END) == 0;
    const long end = ftell(logbook->stream);
    if (!done || end < 0 || (uint64_t)end < logbook->size) {
        return error_set(error, "%s: shorter than the checkpoint says; it cannot be continued",
                         logbook->path);
    }
    done = ftruncate(fileno(logbook->stream), (off_t)logbook->size) == 0
        && fseek(logbook->stream, (long)logbook->size, SEEK_SET) == 0;
    return done || error_set(error, "%s: cannot be cut back: %s", logbook->path, strerror(errno));
}

/* The mean force since the last row: F = (impulse now - impulse then) / time between. */
static void write_bodies(struct logbook *logbook, const struct tally *tally, double time)
{
    const double span = time - logbook->time_last;
    for (uint32_t b = 0; b < logbook->body_count; b++) {
        const struct tally_body *body = &tally->bodies[b];
        const double now[3] = {body->impulse_x, body->impulse_y, body->angular_impulse};
        double *last = logbook->impulse_last + 3 * (size_t)b;
        for (int k = 0; k < 3; k++) {
            fprintf(logbook->stream, "," REAL, span > 0 ? (now[k] - last[k]) / span : 0.0);
            last[k] = now[k];
        }
        fprintf(logbook->stream, ",%" PRIu64, body->contacts);
    }
}

bool logbook_row(struct logbook *logbook, const struct simulation *sim, double wall,
                 struct error *error)
{
    const struct counters now = simulation_count(sim);
    const struct tally *tally = simulation_tally(sim);
    FILE *out = logbook->stream;
    fprintf(out, REAL, now.time);
#define X(name, dimension) fprintf(out, ",%" PRIu64, now.name);
    LOG_WHOLES(X)
#undef X
#define X(name, dimension) fprintf(out, "," REAL, now.name);
    LOG_ENERGIES(X)
#undef X
#define X(name, dimension) fprintf(out, ",%" PRIu64, now.name);
    LOG_COLLISIONS(X)
#undef X
#define X(name, dimension) fprintf(out, "," REAL, now.name);
    LOG_MOMENTA(X)
    fprintf(out, ",%.3f", wall);
    LOG_EXTRAS(X)
#undef X
    if (tally) write_bodies(logbook, tally, now.time);
    if (tally && logbook->masses) fprintf(out, "," REAL "," REAL, tally->mass_in, tally->mass_out);
    fputc('\n', out);
    logbook->time_last = now.time;
    logbook->rows++;
    return flush(logbook, error);
}

bool logbook_sync(struct logbook *logbook, struct error *error)
{
    if (!flush(logbook, error)) return false;
    return fsync(fileno(logbook->stream)) == 0
        || error_set(error, "%s: writing stopped: %s", logbook->path, strerror(errno));
}

void logbook_archive(struct logbook *logbook, struct archive *archive)
{
    archive_value(archive, "log.size", &logbook->size);
    archive_value(archive, "log.rows", &logbook->rows);
    archive_value(archive, "log.time_last", &logbook->time_last);
    archive_array(archive, "log.impulse_last", logbook->impulse_last,
                  3 * (size_t)logbook->body_count);
}

void logbook_close(struct logbook *logbook)
{
    if (logbook->stream) fclose(logbook->stream);
    if (logbook->failed && truncate(logbook->path, (off_t)logbook->size) != 0) {
        unlink(logbook->path);          /* better no log than half a row */
    }
    free(logbook->impulse_last);
    *logbook = (struct logbook){0};
}
