/* sweep.c - see sweep.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/sweep.h"

#include "base/text.h"
#include "run/folder.h"
#include "run/program.h"
#include "run/ranks.h"
#include "run/recall.h"
#include "run/results.h"
#include "run/setup.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const long poll_ns = 3000000;    /* between two looks at the children */

enum { PARALLEL_MAX = 1024 };

struct child { struct program program; uint32_t point; };       /* process 0: free */

struct sweep {
    const struct sweep_request *request;
    char     self[FILE_PATH_MAX];       /* this program */
    uint32_t count;                     /* points of the whole plan */
    uint32_t *due, due_count;
    uint32_t parallel;
    struct child *children;
    struct ranks ranks;
    struct sweep_status status;
    bool     exhausted;                 /* no more points for us */
};

/* ---- before -------------------------------------------------------------------------------- */

static char *plan_text(const struct plan *plan, uint32_t count)
{
    struct text text;
    if (!text_begin(&text)) return text_end(&text, NULL);
    FILE *out = text.stream;
    plan_header(plan, out);
    for (uint32_t point = 0; point < count; point++) {
        fputc('\n', out);
        plan_row(plan, point, out);
    }
    fputc('\n', out);
    return text_end(&text, NULL);
}

/* plan.csv says what the directory is for: a study goes on only with the same points. */
static bool settle_plan(const struct sweep *sweep, struct error *error)
{
    const struct sweep_request *request = sweep->request;
    char path[FILE_PATH_MAX];
    folder_path(path, request->directory, "plan.csv");
    char *text = plan_text(request->plan, sweep->count), *old = NULL;
    size_t size = 0;
    bool done = text != NULL || error_set(error, "not enough memory for a study");
    if (done && file_exists(path) && !request->force) {
        old = file_load(path, (size_t)1 << 32, &size, error);
        done = old && (strcmp(old, text) == 0 || error_set_code(error, EXIT_USAGE,
            "%s: this directory holds another study; choose another with -o, or overwrite it with "
            "--force", request->directory));
        if (done && !request->resume && request->shards == 1 && sweep->ranks.size == 1) {
            done = error_set_code(error, EXIT_USAGE, "%s: this study is there already; go on with "
                "--resume, choose another directory with -o, or overwrite it with --force",
                request->directory);
        }
    } else if (done && setup_is_run(request->directory)) {
        done = error_set_code(error, EXIT_USAGE, "%s: this directory holds a run; choose another "
                              "with -o", request->directory);
    } else if (done && !request->force) {
        /* Tables that no study left: without a plan there was none. */
        char table[FILE_PATH_MAX];
        done = file_absent(folder_path(table, request->directory, "results.csv"), error)
            && file_absent(folder_path(table, request->directory, "failed.csv"), error);
    }
    if (done && !old) done = file_save(path, text, strlen(text), error);
    free(old);
    free(text);
    return done;
}

/* What is left to do of our shard. */
static bool choose_points(struct sweep *sweep, struct error *error)
{
    const struct sweep_request *request = sweep->request;
    sweep->due = calloc((size_t)sweep->count + 1, sizeof *sweep->due);
    if (!sweep->due) return error_set(error, "not enough memory for a study");
    for (uint32_t point = request->shard; point < sweep->count; point += request->shards) {
        char path[FILE_PATH_MAX];
        if (!request->force && recall_done(results_point(path, request->directory, point))) {
            sweep->status.done++;
        } else {
            sweep->due[sweep->due_count++] = point;
        }
    }
    sweep->status.all = sweep->status.done + sweep->due_count;
    sweep->ranks.points = sweep->due;
    sweep->ranks.count = sweep->due_count;
    return true;
}

static bool prepare(struct sweep *sweep, struct error *error)
{
    const struct sweep_request *request = sweep->request;
    char path[FILE_PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", sweep->self, sizeof sweep->self - 1);
    if (length <= 0) return error_set(error, "cannot find this program (is /proc there?)");
    sweep->parallel = request->parallel;
    if (!sweep->parallel) {
        sweep->parallel = sweep->ranks.size > 1 ? 1 : (uint32_t)sysconf(_SC_NPROCESSORS_ONLN);
    }
    if (sweep->parallel > PARALLEL_MAX) sweep->parallel = PARALLEL_MAX;
    sweep->children = calloc(sweep->parallel, sizeof *sweep->children);
    if (!sweep->children) return error_set(error, "not enough memory for a study");
    return plan_count(request->plan, &sweep->count, error)
        && file_make_directory(folder_path(path, request->directory, "points"), error)
        && (sweep->ranks.rank > 0 || settle_plan(sweep, error)) && choose_points(sweep, error);
}

/* ---- one point ----------------------------------------------------------------------------- */

static bool has_checkpoint(const char *run)
{
    char path[FILE_PATH_MAX];
    return file_exists(folder_path(path, run, "checkpoint/0.checkpoint"))
        || file_exists(folder_path(path, run, "checkpoint/1.checkpoint"));
}

static bool start_point(struct sweep *sweep, struct child *child, uint32_t point,
                        struct error *error)
{
    const struct sweep_request *request = sweep->request;
    const struct plan *plan = request->plan;
    const char *arguments[SWEEP_ARGUMENTS_MAX + 3 * PLAN_KEYS_MAX + 20];
    char run[FILE_PATH_MAX], seed[32], sets[PLAN_KEYS_MAX][2 * KEY_TEXT_MAX + 2];
    uint32_t count = 0;
    results_point(run, request->directory, point);
    const bool resumes = request->resume && has_checkpoint(run);
    arguments[count++] = sweep->self;
    arguments[count++] = "run";
    if (resumes) {
        arguments[count++] = run;
        arguments[count++] = "--resume";
    } else {
        arguments[count++] = request->scene;
        for (uint32_t k = 0; k < request->argument_count; k++) {
            arguments[count++] = request->arguments[k];
        }
        for (uint32_t k = 0; k < plan->key_count; k++) {
            char value[KEY_TEXT_MAX];
            snprintf(sets[k], sizeof sets[k], "%s=%s", plan->keys[k].name,
                     plan_value(plan, point, k, value));
            arguments[count++] = "-s";
            arguments[count++] = sets[k];
        }
        snprintf(seed, sizeof seed, "%" PRIu64, plan_seed(plan, point));
        arguments[count++] = "--seed";
        arguments[count++] = seed;
        arguments[count++] = "--force";
    }
    static const char *const last[] = {"-j1", "--progress", "none", "-o"};
    for (size_t k = 0; k < sizeof last / sizeof *last; k++) arguments[count++] = last[k];
    arguments[count++] = run;
    arguments[count] = NULL;
    child->point = point;
    return program_start(&child->program, arguments, NULL, error);
}

/* A point that failed leaves a file beside its directory that says why. */
static bool end_point(struct sweep *sweep, struct child *child, int status, struct error *error)
{
    char path[FILE_PATH_MAX], words[600], cause[800];
    const bool good = WIFEXITED(status) && WEXITSTATUS(status) == EXIT_DONE;
    program_words(&child->program, words, sizeof words);
    program_close(&child->program);
    child->program.process = 0;
    sweep->status.running--;
    results_cause(path, sweep->request->directory, child->point);
    unlink(path);
    if (good) {
        sweep->status.done++;
        return true;
    }
    sweep->status.failed++;
    if (WIFSIGNALED(status)) {
        snprintf(cause, sizeof cause, "killed by signal %d (%s)", WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    } else {
        snprintf(cause, sizeof cause, "exit code %d: %s", WEXITSTATUS(status), words);
    }
    return file_save(path, cause, strlen(cause), error);
}

/* ---- all of them --------------------------------------------------------------------------- */

static bool stopped(const struct sweep *sweep)
{
    return sweep->request->signal && *sweep->request->signal;
}

/* Ends what has ended, starts what can be started.  False if the study cannot go on. */
static bool turn(struct sweep *sweep, struct error *error)
{
    for (uint32_t k = 0; k < sweep->parallel; k++) {
        struct child *child = &sweep->children[k];
        int status;
        if (child->program.process && program_poll(&child->program, &status)
            && !end_point(sweep, child, status, error)) return false;
        if (child->program.process || sweep->exhausted || stopped(sweep)) continue;
        const uint32_t point = ranks_next(&sweep->ranks);
        if (point == UINT32_MAX) {
            sweep->exhausted = true;
        } else {
            if (!start_point(sweep, child, point, error)) return false;
            sweep->status.running++;
        }
    }
    return true;
}

/* The children get SIGTERM, write their checkpoints and end. */
static void stop_all(struct sweep *sweep)
{
    for (uint32_t k = 0; k < sweep->parallel; k++) {
        struct child *child = &sweep->children[k];
        if (child->program.process) kill(child->program.process, SIGTERM);
    }
    for (uint32_t k = 0; k < sweep->parallel; k++) {
        struct child *child = &sweep->children[k];
        if (!child->program.process) continue;
        program_finish(&child->program);
        program_close(&child->program);
        child->program.process = 0;
        sweep->status.running--;
    }
}

static bool work(struct sweep *sweep, struct error *error)
{
    bool done = true, serves = true;
    while (done && !stopped(sweep) && (!sweep->exhausted || sweep->status.running || serves)) {
        serves = ranks_serve(&sweep->ranks);
        done = turn(sweep, error);
        if (sweep->request->report) sweep->request->report(sweep->request->context, &sweep->status);
        nanosleep(&(struct timespec){.tv_nsec = poll_ns}, NULL);
    }
    stop_all(sweep);
    if (!sweep->exhausted) ranks_leave(&sweep->ranks);
    while (ranks_serve(&sweep->ranks)) nanosleep(&(struct timespec){.tv_nsec = poll_ns}, NULL);
    return done;
}

bool sweep_run(const struct sweep_request *request, struct sweep_status *status,
               struct error *error)
{
    struct sweep sweep = {.request = request};
    bool done = ranks_begin(&sweep.ranks, error) && prepare(&sweep, error);
    /* A rank that cannot begin must still let the others end. */
    if (done) done = work(&sweep, error);
    else if (sweep.ranks.parallel) ranks_leave(&sweep.ranks);
    while (!done && ranks_serve(&sweep.ranks)) { }
    ranks_wait(&sweep.ranks);
    sweep.status.failed = ranks_sum(&sweep.ranks, sweep.status.failed);
    sweep.status.rank = sweep.ranks.rank;
    if (done && sweep.ranks.rank == 0) {
        done = results_write(request->plan, sweep.count, request->directory, request->from, error);
    }
    ranks_end(&sweep.ranks);
    free(sweep.children);
    free(sweep.due);
    *status = sweep.status;
    if (done && stopped(&sweep)) {
        return error_set_code(error, (enum exit_code)(128 + *request->signal), "stopped by a "
            "signal; results.csv holds the points that are done; go on with --resume");
    }
    return done;
}
