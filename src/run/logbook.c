/* logbook.c - see logbook.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/logbook.h"

#include "measure/stress.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* A number as text: 12 digits, enough for every plot; the bytes are the same on every machine. */
#define REAL "%.12g"

/* C/N of cooperative, section 4. */
#define EACH_ONCE "1 (each collision of two grains once)"

/* The mean since the last row, and at this instant (measure/stress.h). */
#define STRESS_COLUMNS                                                                  \
    "stress_collisional_xx,stress_collisional_xy,stress_collisional_yx,"                \
    "stress_collisional_yy,stress_kinetic_xx,stress_kinetic_xy,stress_kinetic_yy"

enum { STRESS_COLUMN_COUNT = 7 };

static void write_header(const struct logbook *logbook, const struct scene *scene)
{
    FILE *out = logbook->ledger.stream;
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
    if (logbook->counts) fputs(",collisions_per_grain,elastic_per_grain", out);
    if (logbook->stress) fputs("," STRESS_COLUMNS, out);
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
    if (logbook->counts) fputs("," EACH_ONCE "," EACH_ONCE, out);
    for (int k = 0; logbook->stress && k < STRESS_COLUMN_COUNT; k++) {
        fprintf(out, ",%s", scene_unit(scene, "stress"));
    }
    fputc('\n', out);
}

bool logbook_open(struct logbook *logbook, const char *path, const struct simulation *sim,
                  bool resume, struct error *error)
{
    const struct tally *tally = simulation_tally(sim);
    *logbook = (struct logbook){.body_count = tally ? tally->body_count : 0};
    logbook->masses = sim->scene->effects & (EFFECT_INFLOW | EFFECT_OUTFLOW | EFFECT_SCREEN)
                   && tally;
    logbook->counts = scene_effects(sim->scene) & EFFECT_COLLISION_COUNT;
    logbook->stress = scene_effects(sim->scene) & EFFECT_STRESS;
    logbook->impulse_last = calloc(3 * (size_t)logbook->body_count + 1, sizeof(double));
    if (!logbook->impulse_last) return error_set(error, "not enough memory for the log");
    if (!ledger_open(&logbook->ledger, path, resume, error)) return false;
    if (resume) return true;
    write_header(logbook, sim->scene);
    return ledger_flush(&logbook->ledger, error);
}

/* The mean force since the last row: F = (impulse now - impulse then) / time between. */
static void write_bodies(struct logbook *logbook, const struct tally *tally, double time)
{
    const double span = time - logbook->time_last;
    static const struct tally_body gone = {0};          /* a phase has taken it away */
    for (uint32_t b = 0; b < logbook->body_count; b++) {
        const struct tally_body *body = b < tally->body_count ? &tally->bodies[b] : &gone;
        const double now[3] = {body->impulse_x, body->impulse_y, body->angular_impulse};
        double *last = logbook->impulse_last + 3 * (size_t)b;
        for (int k = 0; k < 3; k++) {
            fprintf(logbook->ledger.stream, "," REAL, span > 0 ? (now[k] - last[k]) / span : 0.0);
            last[k] = now[k];
        }
        fprintf(logbook->ledger.stream, ",%" PRIu64, body->contacts);
    }
}

static void write_stress(struct logbook *logbook, const struct tally *tally,
                         const struct grains *grains, const struct scene *scene, double time)
{
    FILE *out = logbook->ledger.stream;
    const double *box = scene->box, area = (box[2] - box[0]) * (box[3] - box[1]);
    const double span = (time - logbook->time_last) * area;
    for (int k = 0; k < 4; k++) {
        const double now = tally ? tally->stress.total[k] : 0;
        fprintf(out, "," REAL, span > 0 ? (now - logbook->stress_last[k]) / span : 0.0);
        logbook->stress_last[k] = now;
    }
    double kinetic[3];
    stress_kinetic(grains, scene, kinetic);
    for (int k = 0; k < 3; k++) fprintf(out, "," REAL, kinetic[k]);
}

bool logbook_row(struct logbook *logbook, const struct simulation *sim,
                 const struct grains *grains, double wall, struct error *error)
{
    const struct counters now = simulation_count(sim);
    const struct tally *tally = simulation_tally(sim);
    FILE *out = logbook->ledger.stream;
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
    if (logbook->counts) {
        const double n = now.grains > 0 ? (double)now.grains : 1;
        fprintf(out, "," REAL "," REAL, (double)now.collisions / n,
                (double)now.collisions_elastic / n);
    }
    if (logbook->stress) write_stress(logbook, tally, grains, sim->phase_scene, now.time);
    fputc('\n', out);
    logbook->time_last = now.time;
    logbook->ledger.rows++;
    return ledger_flush(&logbook->ledger, error);
}

void logbook_archive(struct logbook *logbook, struct archive *archive)
{
    ledger_archive(&logbook->ledger, "log", archive);
    archive_value(archive, "log.time_last", &logbook->time_last);
    archive_array(archive, "log.impulse_last", logbook->impulse_last,
                  3 * (size_t)logbook->body_count);
    archive_array(archive, "log.stress_last", logbook->stress ? logbook->stress_last : NULL, 4);
}

void logbook_close(struct logbook *logbook)
{
    ledger_close(&logbook->ledger);
    free(logbook->impulse_last);
    *logbook = (struct logbook){0};
}
