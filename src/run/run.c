/* run.c - see run.h.
 *
 * The model advances in pieces of about a twentieth of a second, so that signals, the time limit
 * and progress are served in time; splitting never changes the state (model.h).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/run.h"

#include "base/clock.h"
#include "base/file.h"
#include "run/checkpoint.h"
#include "run/folder.h"
#include "run/look.h"
#include "run/manifest.h"
#include "run/recall.h"
#include "run/resolved.h"
#include "run/stand_alone.h"
#include "run/writer.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double piece_seconds = 0.05;       /* of wall time between two looks at the clock */
static const double rate_seconds = 2;           /* over which the shown rate is smoothed */

struct run {
    const struct run_request *request;
    const struct scene *scene;
    char   directory[FILE_PATH_MAX];
    char  *scene_text;          /* the resolved scene */
    uint64_t scene_hash;
    bool   resumes;             /* from a checkpoint */
    struct simulation sim;
    struct writer writer;
    struct parts parts;
    struct error *error;        /* the caller's */
    uint64_t turn;              /* of the next checkpoint */
    bool     saved;             /* the newest checkpoint is of the present */
    uint64_t checkpoint_next;   /* at this multiple of output.checkpoint */
    double   checkpoint_wall;   /* when the last one was written, wall time */
    uint64_t budget;            /* of one piece */
    double   start, wall_before;        /* wall time of the start; spent before a resume */
    double   time_start;        /* simulated time at the start of this session */
    double   rate, rate_mark;
    double   work_done, work_mark;
};

static double wall_now(const struct run *run)
{
    return run->wall_before + clock_wall() - run->start;
}

static char *load_text(const char *path, struct error *error)
{
    size_t size;
    return file_load(path, 1 << 28, &size, error);
}

/* A run that is continued must be of the same scene: tells what differs. */
static bool compare_scenes(struct run *run, const char *path)
{
    char difference[500], *there = load_text(path, run->error);
    if (!there) return false;
    const bool same = resolved_hash(there) == run->scene_hash;
    if (!same) resolved_difference(there, run->scene_text, difference, sizeof difference);
    free(there);
    return same || error_set_code(run->error, EXIT_USAGE, "%s: this run was made from another "
        "scene or with other settings (only 'until' and 'count_max' may differ): %s; `sandreel run "
        "%s --resume` takes its own, or start anew with --force", run->directory, difference,
        run->directory);
}

/* Writes the resolved scene beside its final name, which it gets from name_scene(). */
static bool settle_scene(struct run *run)
{
    char path[FILE_PATH_MAX], fresh[FILE_PATH_MAX];
    folder_path(path, run->directory, "scene.cfg");
    folder_path(fresh, run->directory, "scene.cfg.new");
    if (!stand_alone_write(run->scene, run->directory, run->request->resume, fresh,
                           run->error)) return false;
    run->scene_text = load_text(fresh, run->error);
    if (!run->scene_text) return false;
    run->scene_hash = resolved_hash(run->scene_text);
    const bool compares = run->request->resume && file_exists(path);
    if (!compares || compare_scenes(run, path)) return true;
    folder_remove(run->directory, "scene.cfg.new");
    return false;
}

static bool name_scene(struct run *run)
{
    char path[FILE_PATH_MAX], fresh[FILE_PATH_MAX];
    folder_path(path, run->directory, "scene.cfg");
    return rename(folder_path(fresh, run->directory, "scene.cfg.new"), path) == 0
        || error_set(run->error, "%s: cannot name this file: %s", path, strerror(errno));
}

/* For a run that could not begin.  Where it has left other files, as on a full disk, the scene
 * stays as the mark by which `--resume` knows that they are its own. */
static void forget_scene(const struct run *run)
{
    static const char mark[] = "scene.cfg.new";
    char path[FILE_PATH_MAX];
    if (file_exists(folder_path(path, run->directory, "scene.cfg"))
        || folder_holds_only(run->directory, mark)) folder_remove(run->directory, mark);
}

/* Everything that a continued run must know beside the model's state. */
static void archive_run(struct run *run, struct archive *archive)
{
    archive_value(archive, "run.checkpoint_next", &run->checkpoint_next);
    double wall = wall_now(run);
    archive_value(archive, "run.wall", &wall);
    run->wall_before = archive->mode == ARCHIVE_LOAD ? wall : run->wall_before;
    writer_archive(&run->writer, archive);
}

static bool save_state(struct run *run, const char *special)
{
    struct archive archive;
    char path[FILE_PATH_MAX];
    archive_begin_save(&archive);
    archive_run(run, &archive);
    bool done = simulation_save(&run->sim, &archive, run->error);
    if (done && special) {
        done = file_make_directory(folder_path(path, run->directory, "checkpoint"), run->error)
            && checkpoint_save_as(folder_path(path, run->directory, "checkpoint/%s", special),
                                  run->turn, run->scene_text, &archive, run->error);
    } else if (done) {
        done = checkpoint_save(folder_path(path, run->directory, "checkpoint"), run->turn++,
                               run->scene_text, &archive, run->error);
    }
    archive_end(&archive);
    run->checkpoint_wall = clock_wall();
    run->saved = done && !special;
    return done;
}

static bool save_checkpoint(struct run *run)
{
    const enum part before = parts_enter(&run->parts, PART_files, encoder_cpu(run->writer.encoder));
    const bool done = writer_sync(&run->writer, run->error) && save_state(run, NULL);
    parts_enter(&run->parts, before, encoder_cpu(run->writer.encoder));
    return done;
}

static bool load_checkpoint(struct run *run)
{
    char path[FILE_PATH_MAX];
    void *bytes;
    size_t size;
    folder_path(path, run->directory, "checkpoint");
    if (!checkpoint_load(path, run->scene_text, &bytes, &size, &run->turn, run->error)) {
        return false;
    }
    run->turn++;
    run->saved = true;
    struct archive archive;
    archive_begin_load(&archive, bytes, size);
    archive_run(run, &archive);
    const bool done = simulation_load(&run->sim, &archive, run->error);
    archive_end(&archive);
    free(bytes);
    return done && writer_resume(&run->writer, run->error);
}

static void report(struct run *run, const char *doing, double share)
{
    const struct run_request *request = run->request;
    if (!request->report) return;
    const struct counters now = simulation_count(&run->sim);
    const double wall = clock_wall() - run->start;
    const double span = run->scene->until - run->time_start;
    const double here = span > 0 ? (now.time - run->time_start) / span : 1;
    const struct run_status status = {
        .doing = doing, .work = request->model->work, .time = now.time,
        .until = run->scene->until, .share = share, .rate = run->rate, .steps = now.steps,
        .grains = now.grains, .frames = run->writer.schedules[WRITER_FRAME].next, .wall = wall,
        .eta = here > 0.005 ? wall * (1 - here) / here : NAN,
    };
    request->report(request->context, &status);
}

/* The next piece is made to take about piece_seconds. */
static void adapt(struct run *run, double took, uint64_t steps)
{
    run->work_done += (double)steps;
    if (took < piece_seconds / 2 && steps >= run->budget && run->budget < UINT64_MAX / 4) {
        run->budget *= 2;
    } else if (took > 2 * piece_seconds && run->budget > 1) {
        run->budget /= 2;
    }
    const double wall = clock_wall(), since = wall - run->rate_mark;
    if (since < (run->rate > 0 ? rate_seconds : piece_seconds)) return;
    run->rate = (run->work_done - run->work_mark) / since;
    run->work_mark = run->work_done;
    run->rate_mark = wall;
}

/* The picture of a broken state: around the grain to blame, as large as twenty of it. */
static void draw_broken(struct run *run, const struct fault *fault, struct error *error)
{
    struct view view = run->scene->view;
    const double half = 12 * run->scene->radius_max;
    view.window[0] = fault->x - half;
    view.window[1] = fault->y - half * view.size[1] / view.size[0];
    view.window[2] = fault->x + half;
    view.window[3] = fault->y + half * view.size[1] / view.size[0];
    view.forces = true;
    view.range_from = RANGE_FRAME;
    snprintf(view.title, sizeof view.title, "grain %u at (%.4g, %.4g), t = %.6g", fault->grain,
             fault->x, fault->y, fault->time);
    struct film film = {0};
    struct grains grains = {0};
    char path[FILE_PATH_MAX];
    if (film_open(&film, run->scene, run->request->model, &view, error)
        && look_at(&run->sim, &grains, true, error)
        && film_draw(&film, &grains, simulation_count(&run->sim).steps, wall_now(run), error)) {
        image_save(&film.image, folder_path(path, run->directory, "broken.png"), 1, NULL, 0, error);
    }
    film_close(&film);
    grains_free(&grains);
}

/* Keeps what helps to understand: the last good checkpoint stays, the broken state gets a name of
 * its own, and a picture. */
static bool give_up(struct run *run)
{
    const struct error cause = *run->error;
    const struct model *model = run->request->model;
    const struct fault *fault = model->fault ? model->fault(run->sim.state) : NULL;
    struct error minor = {0};
    struct error *const kept = run->error;
    run->error = &minor;
    writer_sync(&run->writer, &minor);
    save_state(run, "broken.checkpoint");
    if (fault) draw_broken(run, fault, &minor);
    run->error = kept;
    return error_set(run->error, "%.700s (see %s/broken.png and checkpoint/broken.checkpoint)",
                     cause.text, run->directory);
}

/* A signal or the time limit: true if the run should go on. */
static bool may_go_on(struct run *run)
{
    const struct run_request *request = run->request;
    const int signal = request->signal ? *request->signal : 0;
    const bool late = request->time_limit > 0
                   && clock_wall() - run->start >= request->time_limit;
    if (!signal && !late) return true;
    if (!save_checkpoint(run)) return false;
    const double t = simulation_count(&run->sim).time;
    return error_set_code(run->error, signal ? (enum exit_code)(128 + signal) : EXIT_STOPPED,
        "stopped by %s at t = %.6g; the checkpoint is kept: go on with `sandreel run %s --resume`",
        signal ? "a signal" : "the time limit", t, run->directory);
}

static bool advance_to(struct run *run, double t)
{
    for (;;) {
        const uint64_t before = simulation_count(&run->sim).steps;
        const double start = clock_wall();
        const enum advance outcome = simulation_advance(&run->sim, t, run->budget, run->error);
        const uint64_t steps = simulation_count(&run->sim).steps - before;
        run->saved = run->saved && steps == 0;
        if (outcome == ADVANCE_BROKEN) return give_up(run);
        adapt(run, clock_wall() - start, steps);
        const double time = simulation_count(&run->sim).time, until = run->scene->until;
        report(run, "simulating", until > 0 ? time / until : 1);
        if (!may_go_on(run)) return false;
        if (outcome == ADVANCE_REACHED) return true;
        const double wall = run->scene->output.checkpoint_wall;
        if (wall > 0 && clock_wall() - run->checkpoint_wall >= wall && !save_checkpoint(run)) {
            return false;
        }
    }
}

static double checkpoint_due(const struct run *run)
{
    const double interval = run->scene->output.checkpoint;
    return interval > 0 ? (double)run->checkpoint_next * interval : INFINITY;
}

static bool simulate(struct run *run)
{
    const double until = run->scene->until;
    for (;;) {
        const double due = fmin(writer_due(&run->writer), checkpoint_due(run));
        const double t = fmin(due, until);
        if (!advance_to(run, t)) return false;
        if (due > until) break;
        run->saved = run->saved && writer_due(&run->writer) > t;
        if (!writer_serve(&run->writer, t, wall_now(run), run->error)) return false;
        if (checkpoint_due(run) > t) continue;
        run->checkpoint_next++;
        if (!save_checkpoint(run)) return false;
    }
    return run->scene->output.checkpoint == 0 || run->saved || save_checkpoint(run);
}

static bool drawn_one(void *context, uint64_t done, uint64_t count)
{
    struct run *run = context;
    report(run, "drawing", (double)done / (double)count);
    return may_go_on(run);
}

double run_part_seconds(const struct run_result *result, enum part part)
{
    return part == PART_encode ? result->cpu_encode : result->parts.wall[part];
}

static void fill_result(struct run *run, struct run_result *result)
{
    parts_enter(&run->parts, run->parts.now, encoder_cpu(run->writer.encoder));
    result->counters = simulation_count(&run->sim);
    result->digest = simulation_digest(&run->sim);
    result->parts = run->parts;
    result->cpu_encode = encoder_cpu(run->writer.encoder);
    result->wall = wall_now(run);
    for (uint32_t p = 0; p < run->scene->phase_count; p++) {
        result->effects |= run->scene->phases[p]->effects;
    }
    result->span = result->counters.time - run->time_start;
    result->work = run->work_done;
    result->frames = run->writer.schedules[WRITER_FRAME].next;
    result->maps = run->writer.maps;
    result->log_rows = run->writer.logbook.ledger.rows;
    result->range[0] = run->writer.draws ? run->writer.film.range[0] : NAN;
    result->range[1] = run->writer.draws ? run->writer.film.range[1] : NAN;
}

static const char *status_word(bool done, enum exit_code code)
{
    if (done) return "done";
    if (code == EXIT_STOPPED) return "stopped";
    return code == EXIT_INTERRUPT || code == EXIT_TERMINATED ? "interrupted" : "failed";
}

static bool save_manifest(const struct run *run, const char *status,
                          const struct run_result *result, struct error *error)
{
    const struct manifest manifest = {
        .scene = run->scene, .model = run->request->model, .status = status,
        .scene_hash = run->scene_hash, .result = result,
        .range = run->writer.draws ? run->writer.film.range : NULL,
    };
    return manifest_save(&manifest, run->directory, error);
}

/* A run that was killed at any moment goes on as if it had not been, so the order counts: the
 * directory becomes a run (name_scene) when all is opened, `done` is told when everything is
 * there, and only then what is no longer needed goes away. */
static bool carry_out(struct run *run, struct run_result *result)
{
    const struct run_request *request = run->request;
    if (!writer_open(&run->writer, &run->sim, run->directory, request->threads, run->resumes,
                     &run->parts, run->error)
        || (run->resumes && !load_checkpoint(run))
        || !save_manifest(run, "running", NULL, run->error) || !name_scene(run)) {
        forget_scene(run);
        return false;
    }
    run->time_start = simulation_count(&run->sim).time;
    run->rate_mark = run->checkpoint_wall = clock_wall();
    bool done = simulate(run);
    if (done) done = writer_finish(&run->writer, wall_now(run), drawn_one, run, run->error);
    fill_result(run, result);
    struct error minor = {0};
    done = save_manifest(run, status_word(done, run->error->code), result,
                         done ? run->error : &minor) && done;
    if (done) writer_tidy(&run->writer);
    return done;
}

/* Do two resolved scenes that are otherwise the same end at the same time? */
static bool same_end(const char *one, const char *other)
{
    static const char line[] = "\nuntil ";
    const char *a = strstr(one, line), *b = strstr(other, line);
    return a && b && strcspn(a + 1, "\n") == strcspn(b + 1, "\n")
        && strncmp(a, b, 1 + strcspn(a + 1, "\n")) == 0;
}

/* A run that is done and keeps no checkpoints: all of it is there, but it cannot be made longer. */
static bool is_there(struct run *run, bool *there)
{
    char path[FILE_PATH_MAX];
    *there = false;
    if (!run->resumes || checkpoint_exists(folder_path(path, run->directory, "checkpoint"))) {
        return true;
    }
    char *text = load_text(folder_path(path, run->directory, "scene.cfg"), run->error);
    *there = text && same_end(text, run->scene_text);
    folder_remove(run->directory, "scene.cfg.new");
    if (text && !*there) {
        error_set_code(run->error, EXIT_USAGE, "%s: this run is done and kept no checkpoint, so it "
                       "cannot be made longer; run it anew with --force, and with "
                       "-s output.checkpoint=INTERVAL", run->directory);
    } else if (text && run->request->warn) {
        run->request->warn(run->request->context, "this run is done already; nothing was left to "
                                                  "do");
    }
    free(text);
    return *there;
}

/* Opens the directory.  A run that died before its first checkpoint is begun anew. */
static bool claim(struct run *run)
{
    const struct run_request *request = run->request;
    if (!request->resume) return folder_claim(run->directory, request->force, run->error);
    if (!folder_reclaim(run->directory, run->error)) return false;
    char path[FILE_PATH_MAX];
    run->resumes = checkpoint_exists(folder_path(path, run->directory, "checkpoint"));
    if (!run->resumes && !recall_done(run->directory, &run->resumes, run->error)) return false;
    if (!run->resumes && request->warn) {
        request->warn(request->context, "this run ended before its first checkpoint; it begins "
                                        "anew");
    }
    return true;
}

bool run_scene(const struct run_request *request, struct run_result *result,
               struct error *error)
{
    struct error own = {0};
    struct run *run = calloc(1, sizeof *run);
    if (!run) return error_set(error, "not enough memory for a run");
    *run = (struct run){.request = request, .scene = request->scene, .budget = 64,
                        .error = error ? error : &own, .start = clock_wall(),
                        .checkpoint_next = 1};
    *result = (struct run_result){0};
    snprintf(run->directory, sizeof run->directory, "%s", request->directory);
    parts_begin(&run->parts, PART_core);
    const bool done = claim(run) && settle_scene(run) && is_there(run, &result->was_done)
        && (result->was_done
            || (simulation_create(&run->sim, request->model, request->scene, run->error)
                && carry_out(run, result)));
    writer_close(&run->writer);
    simulation_destroy(&run->sim);
    free(run->scene_text);
    free(run);
    return done;
}
