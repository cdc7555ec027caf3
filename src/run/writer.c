/* writer.c - see writer.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/writer.h"

#include "base/file.h"
#include "measure/csv.h"
#include "run/folder.h"
#include "run/h5md_pack.h"
#include "run/look.h"
#include "run/recall.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Two outputs nearer than this share of their time are meant for the same time. */
static const double same_time = 1e-9;

static const double average_samples = 100;      /* of a mean map whose sampling is left open */

static void set_schedules(struct writer *writer, const struct scene *scene)
{
    const struct output *output = &scene->output;
    struct schedule *schedules = writer->schedules;
    for (int e = 0; e < WRITER_EVENTS; e++) {
        schedules[e] = (struct schedule){.from = 0, .to = scene->until};
    }
    schedules[WRITER_FRAME].interval = output->frames;
    schedules[WRITER_LOG].interval = output->log;
    schedules[WRITER_MAP].interval = output->maps;
    schedules[WRITER_TALLY].interval = output->tallies;
    schedules[WRITER_TRAJECTORY].interval = output->trajectory;
    const double *average = scene->measure.average;
    writer->averages = isfinite(average[0]) && isfinite(average[1]) && average[1] > average[0]
                    && (output->maps > 0 || scene->measure.fields.count > 0);
    if (!writer->averages) return;
    struct schedule *maps = &schedules[WRITER_MAP];
    if (!(maps->interval > 0)) maps->interval = (average[1] - average[0]) / average_samples;
    maps->from = average[0];
    maps->to = fmin(average[1], scene->until);
    maps->next = (uint64_t)ceil(maps->from / maps->interval * (1 - same_time));
}

static double schedule_time(const struct schedule *schedule)
{
    if (!(schedule->interval > 0)) return INFINITY;
    const double t = (double)schedule->next * schedule->interval;
    if (t <= schedule->to) return t;
    return t * (1 - same_time) <= schedule->to ? schedule->to : INFINITY;
}

double writer_due(const struct writer *writer)
{
    double soonest = INFINITY;
    for (int e = 0; e < WRITER_EVENTS; e++) {
        soonest = fmin(soonest, schedule_time(&writer->schedules[e]));
    }
    return soonest;
}

/* Goes over to `part`; returns the one it leaves. */
static enum part enter(struct writer *writer, enum part part)
{
    return parts_enter(writer->parts, part, encoder_cpu(writer->encoder));
}

static bool begin_movie(struct writer *writer, struct error *error)
{
    const struct scene *scene = writer->sim->scene;
    char path[FILE_PATH_MAX];
    folder_path(path, writer->directory, "%s", scene->output.movie);
    writer->movie = movie_begin(path, writer->film.image.width, writer->film.image.height,
                                scene->output.frame_rate, error);
    return writer->movie != NULL;
}

static bool make_folders(const struct writer *writer, struct error *error)
{
    char path[FILE_PATH_MAX];
    return (!writer->draws
            || file_make_directory(folder_path(path, writer->directory, "frames"), error))
        && (!(writer->schedules[WRITER_MAP].interval > 0)
            || file_make_directory(folder_path(path, writer->directory, "maps"), error));
}

static bool open_pictures(struct writer *writer, bool resume, struct error *error)
{
    const struct scene *scene = writer->sim->scene;
    writer->draws = scene->output.frames > 0;
    if (!writer->draws) return true;
    if (*scene->output.movie
        && (!movie_name_ok(scene->output.movie, error) || !movie_available(error))) {
        return false;
    }
    struct view view = scene->view;
    char path[FILE_PATH_MAX];
    folder_path(path, writer->directory, "dump/index.csv");
    /* A finished run that is made longer has its colours already; without its grains they cannot
     * be found anew, so the new frames take them over. */
    if (resume && !file_exists(path) && !recall_range(writer->directory, scene, &view, error)) {
        return false;
    }
    if (!film_open(&writer->film, scene, writer->sim->model, &view, error)) return false;
    /* What is not listed is not kept either, so then each frame is coloured by itself. */
    writer->draws_later = film_needs_gathering(&writer->film) && !look_samples(writer->sim);
    if (scene->output.dump && look_samples(writer->sim)) {
        return error_set_code(error, EXIT_SCENE, "%s: more than %d grains are not listed, so their "
            "states cannot be kept; delete output.dump", scene->path, LOOK_LIST_MAX);
    }
    writer->keeps_grains = scene->output.dump || writer->draws_later;
    if (resume && !writer->keeps_grains) folder_clear(writer->directory, "dump");
    writer->movie_late = *scene->output.movie && resume && !writer->draws_later;
    return !*scene->output.movie || writer->draws_later || resume || begin_movie(writer, error);
}

/* A new one; an earlier run's is opened once it is known how much of it counts. */
static bool begin_trajectory(struct writer *writer, bool resume, struct error *error)
{
    char path[FILE_PATH_MAX];
    if (!(writer->schedules[WRITER_TRAJECTORY].interval > 0)) return true;
    if (!h5md_available(error)) return false;
    if (resume) return true;
    writer->h5md = h5md_create(folder_path(path, writer->directory, "trajectory.h5"),
                               writer->sim->scene, error);
    return writer->h5md != NULL;
}

bool writer_open(struct writer *writer, const struct simulation *sim, const char *directory,
                 uint32_t encoders, bool resume, struct parts *parts, struct error *error)
{
    const struct scene *scene = sim->scene;
    *writer = (struct writer){.sim = sim, .parts = parts};
    snprintf(writer->directory, sizeof writer->directory, "%s", directory);
    set_schedules(writer, scene);
    writer->encoder = encoder_create(encoders, error);
    if (!writer->encoder) return false;
    const enum part before = enter(writer, PART_draw);
    if (!open_pictures(writer, resume, error)) return false;
    enter(writer, before);
    const unsigned formats = 1 << MAPPER_BIT_png | 1 << MAPPER_BIT_npy | 1 << MAPPER_BIT_vti;
    if (writer->schedules[WRITER_MAP].interval > 0
        && !mapper_open(&writer->mapper, scene, &scene->view, &scene->measure, formats, error)) {
        return false;
    }
    if (writer->schedules[WRITER_MAP].interval > 0 && scene_effects(scene) & EFFECT_STRESS) {
        writer->stress = stress_create(scene, error);
        if (!writer->stress) return false;
        stress_begin(writer->stress, simulation_tally(sim), 0);
    }
    char path[FILE_PATH_MAX];
    return make_folders(writer, error) && begin_trajectory(writer, resume, error)
        && histograms_open(&writer->histograms, directory, sim, resume, error)
        && (!writer->keeps_grains || resume
            || dumps_begin(&writer->dumps, directory, 0, error))
        && (!(scene->output.log > 0)
            || logbook_open(&writer->logbook, folder_path(path, directory, "log.csv"), sim, resume,
                            error));
}

bool writer_resume(struct writer *writer, struct error *error)
{
    const uint64_t frames = writer->schedules[WRITER_FRAME].next;
    if (writer->keeps_grains && !dumps_begin(&writer->dumps, writer->directory, frames, error)) {
        return false;
    }
    if (writer->schedules[WRITER_TRAJECTORY].interval > 0) {
        char path[FILE_PATH_MAX];
        writer->h5md = h5md_resume(folder_path(path, writer->directory, "trajectory.h5"),
                                   writer->schedules[WRITER_TRAJECTORY].next,
                                   writer->sim->scene, error);
        if (!writer->h5md) return false;
    }
    for (uint64_t k = 0; writer->draws_later && k < frames; k++) {
        if (!dumps_load(&writer->dumps, (uint32_t)k, &writer->grains, error)) return false;
        if (!film_gather(&writer->film, &writer->grains, error)) return false;
    }
    return histograms_resume(&writer->histograms, error)
        && (!writer->logbook.ledger.stream || ledger_resume(&writer->logbook.ledger, error));
}

static bool submit_frame(struct writer *writer, double time, uint64_t index, struct error *error)
{
    struct encoder_job job = {.level = writer->sim->scene->output.png_level};
    folder_path(job.path, writer->directory, "frames/%06llu.png", (unsigned long long)index);
    film_describe(&writer->film, time, &job);
    if (writer->movie && !movie_frame(writer->movie, &writer->film.image, error)) return false;
    return encoder_submit(writer->encoder, &writer->film.image, &job, error);
}

static bool look(struct writer *writer, bool contacts, struct error *error)
{
    enter(writer, PART_measure);
    return look_at(writer->sim, &writer->grains, contacts, error);
}

static bool serve_frame(struct writer *writer, uint64_t index, double wall, struct error *error)
{
    const struct output *output = &writer->sim->scene->output;
    const bool contacts = film_needs_contacts(&writer->film.view)
                       || (output->dump && output->contacts);
    if (!look(writer, contacts, error)) return false;
    const uint64_t steps = simulation_count(writer->sim).steps;
    if (writer->draws_later && !film_gather(&writer->film, &writer->grains, error)) return false;
    enter(writer, PART_files);
    if (writer->keeps_grains && !dumps_add(&writer->dumps, &writer->grains, steps, error)) {
        return false;
    }
    if (writer->draws_later) return true;
    enter(writer, PART_draw);
    return film_draw(&writer->film, &writer->grains, steps, wall, error)
        && submit_frame(writer, writer->grains.time, index, error);
}

/* A snapshot at once; an average when its last sample is in. */
static bool serve_map(struct writer *writer, uint64_t index, struct error *error)
{
    const struct schedule *schedule = &writer->schedules[WRITER_MAP];
    char path[FILE_PATH_MAX], suffix[24] = "mean";
    folder_path(path, writer->directory, "maps");
    if (!look(writer, false, error)) return false;
    const struct tally *tally = simulation_tally(writer->sim);
    if (!writer->averages) mapper_clear(&writer->mapper);
    else if (writer->stress && !(writer->grains.time > schedule->from)) {
        stress_begin(writer->stress, tally, writer->grains.time);
    }
    mapper_add(&writer->mapper, &writer->grains);
    if (writer->stress) stress_add(writer->stress, &writer->grains);
    if (writer->averages && isfinite(schedule_time(schedule))) return true;
    if (!writer->averages) snprintf(suffix, sizeof suffix, "%06llu", (unsigned long long)index);
    enter(writer, PART_files);
    writer->maps++;
    bool done = mapper_write(&writer->mapper, path, suffix, error);
    if (!writer->stress) return done;
    for (int kind = 0; done && kind < STRESS_KINDS; kind++) {
        struct field field;
        done = stress_field(writer->stress, (enum stress_kind)kind, tally, writer->grains.time,
                            &field, error)
            && mapper_write_field(&writer->mapper, &field, path, suffix, error);
        field_free(&field);
    }
    stress_begin(writer->stress, tally, writer->grains.time);
    return done;
}

static bool serve_log(struct writer *writer, double wall, struct error *error)
{
    if (writer->logbook.stress && !look(writer, false, error)) return false;
    enter(writer, PART_files);
    return logbook_row(&writer->logbook, writer->sim, &writer->grains, wall, error);
}

static bool serve_histograms(struct writer *writer, struct error *error)
{
    if (!histograms_wanted(&writer->histograms)) return true;
    if (!look(writer, false, error)) return false;
    enter(writer, PART_files);
    return histograms_block(&writer->histograms, writer->sim, &writer->grains, error);
}

bool writer_serve(struct writer *writer, double t, double wall, struct error *error)
{
    const enum part before = enter(writer, PART_files);
    bool done = true;
    for (int e = 0; done && e < WRITER_EVENTS; e++) {
        struct schedule *schedule = &writer->schedules[e];
        if (schedule_time(schedule) * (1 - same_time) > t) continue;
        const uint64_t index = schedule->next++;
        switch ((enum writer_event)e) {
        case WRITER_FRAME: done = serve_frame(writer, index, wall, error); break;
        case WRITER_LOG: done = serve_log(writer, wall, error); break;
        case WRITER_TALLY: done = serve_histograms(writer, error); break;
        case WRITER_MAP: done = serve_map(writer, index, error); break;
        case WRITER_TRAJECTORY:
            done = look(writer, false, error);
            enter(writer, PART_files);
            done = done && grains_sort(&writer->grains, error)
                && h5md_add(writer->h5md, &writer->grains,
                            simulation_count(writer->sim).steps, error);
            break;
        case WRITER_EVENTS: break;
        }
    }
    enter(writer, before);
    return done;
}

bool writer_sync(struct writer *writer, struct error *error)
{
    if (!encoder_wait(writer->encoder, error)) return false;
    static const char *const folders[] = {".", "frames", "maps", "dump"};
    for (size_t k = 0; k < sizeof folders / sizeof *folders; k++) {
        char path[FILE_PATH_MAX];
        file_sync(folder_path(path, writer->directory, "%s", folders[k]));
    }
    return histograms_sync(&writer->histograms, error)
        && (!writer->logbook.ledger.stream || ledger_sync(&writer->logbook.ledger, error))
        && (!writer->h5md || h5md_sync(writer->h5md, error));
}

/* Frames whose colours had to wait for the whole run. */
static bool draw_dumps(struct writer *writer, double wall,
                       bool (*step)(void *, uint64_t, uint64_t), void *context,
                       struct error *error)
{
    const struct dumps *dumps = &writer->dumps;
    const uint32_t count = dumps->index.count;
    film_settle(&writer->film);
    bool done = !*writer->sim->scene->output.movie || begin_movie(writer, error);
    for (uint32_t k = 0; done && k < count; k++) {
        enter(writer, PART_files);
        done = dumps_load(dumps, k, &writer->grains, error);
        enter(writer, PART_draw);
        done = done
            && film_draw(&writer->film, &writer->grains, dumps->index.entries[k].steps, wall, error)
            && submit_frame(writer, writer->grains.time, k, error);
        if (done && step) done = step(context, k + 1, count);
    }
    return done && encoder_wait(writer->encoder, error);
}

/* A resumed run has drawn its early frames before: the movie is put together from the files. */
static bool movie_from_frames(struct writer *writer, struct error *error)
{
    if (!begin_movie(writer, error)) return false;
    bool done = true;
    for (uint64_t k = 0; done && k < writer->schedules[WRITER_FRAME].next; k++) {
        struct image image = {0};
        char path[FILE_PATH_MAX];
        folder_path(path, writer->directory, "frames/%06llu.png", (unsigned long long)k);
        done = image_load(&image, path, error) && movie_frame(writer->movie, &image, error);
        image_free(&image);
    }
    return done;
}

/* What crossed each screen, by angle: sums over the whole run, hence only at its end. */
static bool save_screens(const struct writer *writer, struct error *error)
{
    const struct tally *tally = simulation_tally(writer->sim);
    bool done = true;
    for (uint32_t k = 0; tally && done && k < tally->screen_count && tally->mass_in > 0; k++) {
        struct scatter scatter;
        char path[FILE_PATH_MAX];
        folder_path(path, writer->directory, "screen%u.csv", k);
        done = scatter_create(&tally->screens[k], tally->mass_in, &scatter, error)
            && csv_save_scatter(path, &scatter, writer->sim->scene, error);
        scatter_free(&scatter);
    }
    return done;
}

bool writer_finish(struct writer *writer, double wall, bool (*step)(void *, uint64_t, uint64_t),
                   void *context, struct error *error)
{
    const enum part before = enter(writer, PART_files);
    bool done = true;
    if (writer->draws_later) done = draw_dumps(writer, wall, step, context, error);
    done = done && serve_histograms(writer, error) && writer_sync(writer, error)
        && save_screens(writer, error);
    if (done && writer->h5md) {
        char path[FILE_PATH_MAX];
        done = h5md_close(writer->h5md, error);
        writer->h5md = NULL;
        done = done && h5md_pack(folder_path(path, writer->directory, "trajectory.h5"), error);
    }
    if (done && writer->movie_late) done = movie_from_frames(writer, error);
    if (done && writer->movie) {
        done = movie_commit(writer->movie, error);
        writer->movie = NULL;
    }
    enter(writer, before);
    return done;
}

/* The index goes first: without it the other files mean nothing, so that it does not matter where
 * this is interrupted. */
void writer_tidy(const struct writer *writer)
{
    char path[FILE_PATH_MAX];
    if (!writer->draws_later || writer->sim->scene->output.dump) return;
    unlink(folder_path(path, writer->directory, "dump/index.csv"));
    folder_clear(writer->directory, "dump");
}

void writer_archive(struct writer *writer, struct archive *archive)
{
    uint64_t next[WRITER_EVENTS];
    for (int e = 0; e < WRITER_EVENTS; e++) next[e] = writer->schedules[e].next;
    archive_array(archive, "run.next", next, WRITER_EVENTS);
    for (int e = 0; e < WRITER_EVENTS; e++) writer->schedules[e].next = next[e];
    archive_value(archive, "run.maps", &writer->maps);
    histograms_archive(&writer->histograms, archive);
    if (writer->stress) stress_archive(writer->stress, archive);
    if (writer->logbook.ledger.stream) logbook_archive(&writer->logbook, archive);
    if (writer->averages) map_archive(writer->mapper.map, archive);
}

void writer_close(struct writer *writer)
{
    movie_abandon(writer->movie);
    encoder_destroy(writer->encoder);
    logbook_close(&writer->logbook);
    histograms_close(&writer->histograms);
    stress_destroy(writer->stress);
    film_close(&writer->film);
    mapper_close(&writer->mapper);
    dumps_close(&writer->dumps);
    h5md_close(writer->h5md, NULL);
    grains_free(&writer->grains);
    *writer = (struct writer){0};
}
