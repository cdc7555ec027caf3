/* movie.c - see movie.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/movie.h"

#include "base/file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

struct format {
    const char *ending, *muxer;
    const char *options[16];    /* codec and its settings; NULL ends the list */
};

/* Sizes are padded to even ones, which 4:2:0 colour needs.  A GIF gets a palette for each frame:
 * one palette for the film would make ffmpeg hold all raw frames in memory. */
#define PAD "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"
static const struct format formats[] = {
    {".mp4", "mp4", {"-vf", PAD, "-c:v", "libx264", "-preset", "medium", "-crf", "18",
                     "-pix_fmt", "yuv420p", "-movflags", "+faststart", NULL}},
    {".webm", "webm", {"-vf", PAD, "-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0", "-row-mt", "1",
                       "-cpu-used", "4", "-pix_fmt", "yuv420p", NULL}},
    {".gif", "gif", {"-vf", "split[a][b];[a]palettegen=stats_mode=single[p];"
                     "[b][p]paletteuse=new=1:dither=bayer:bayer_scale=4", NULL}},
};

struct movie {
    pid_t    process;
    int      pipe;              /* we write, ffmpeg reads */
    FILE    *complaints;        /* what ffmpeg says goes into this unnamed file */
    uint32_t width, height;
    bool     torn;              /* a signal came while ffmpeg did not read: given up */
    uint8_t *flat;              /* a frame laid on white; made when first needed */
    char     path[FILE_PATH_MAX], partial[FILE_PATH_MAX + 16];
};

static const struct format *find_format(const char *path)
{
    const char *ending = strrchr(path, '.');
    for (size_t k = 0; ending && k < sizeof formats / sizeof *formats; k++) {
        if (strcasecmp(ending, formats[k].ending) == 0) return &formats[k];
    }
    return NULL;
}

bool movie_name_ok(const char *path, struct error *error)
{
    return find_format(path) || error_set_code(error, EXIT_USAGE,
        "%s: a movie's name must end in .mp4, .webm or .gif", path);
}

bool movie_available(struct error *error)
{
    const char *path = getenv("PATH");
    while (path && *path) {
        const size_t length = strcspn(path, ":");
        char name[FILE_PATH_MAX];
        snprintf(name, sizeof name, "%.*s/ffmpeg", (int)length, path);
        if (length > 0 && access(name, X_OK) == 0) return true;
        path += length + (path[length] == ':');
    }
    return error_set(error, "movies need the program ffmpeg, which is not on the PATH; install it "
                     "(Debian: sudo apt install ffmpeg), or write frames instead of a movie");
}

/* In the child: becomes ffmpeg.  Only async-signal-safe calls until exec. */
static void become_ffmpeg(int input, int complaints, char *const *arguments)
{
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);   /* whose run is killed, its film is of no use */
    signal(SIGPIPE, SIG_DFL);
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(input, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(complaints, STDERR_FILENO);
    execvp(arguments[0], arguments);
    _exit(127);
}

static bool start(struct movie *movie, const struct format *format, double frame_rate,
                  struct error *error)
{
    char size[32], rate[32];
    snprintf(size, sizeof size, "%ux%u", movie->width, movie->height);
    snprintf(rate, sizeof rate, "%g", frame_rate);
    const char *arguments[48] = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y",
        "-f", "rawvideo", "-pix_fmt", "rgba", "-s", size, "-r", rate, "-i", "pipe:0"};
    size_t count = 0;
    while (arguments[count]) count++;
    for (size_t k = 0; format->options[k]; k++) arguments[count++] = format->options[k];
    /* "file:", or a colon in the path would end the name of a protocol; bitexact, or a film gets
     * numbers drawn by lot, and two runs differ. */
    char output[sizeof movie->partial + 8];
    snprintf(output, sizeof output, "file:%s", movie->partial);
    const char *const ends_with[] = {"-fflags", "+bitexact", "-flags:v", "+bitexact", "-f",
                                     format->muxer, output};
    for (size_t k = 0; k < sizeof ends_with / sizeof *ends_with; k++) {
        arguments[count++] = ends_with[k];
    }
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return error_set(error, "no pipe: %s", strerror(errno));
    movie->process = fork();
    if (movie->process == 0) {
        become_ffmpeg(ends[0], fileno(movie->complaints), (char *const *)(uintptr_t)arguments);
    }
    close(ends[0]);
    movie->pipe = ends[1];
    return movie->process > 0 || error_set(error, "cannot start ffmpeg: %s", strerror(errno));
}

static void movie_free(struct movie *movie)
{
    if (movie->complaints) fclose(movie->complaints);
    free(movie->flat);
    free(movie);
}

struct movie *movie_begin(const char *path, uint32_t width, uint32_t height, double frame_rate,
                          struct error *error)
{
    if (!movie_name_ok(path, error) || !movie_available(error)) return NULL;
    /* ffmpeg's own message about a directory that is missing is hard to read: try it first. */
    struct file probe;
    if (!file_begin(&probe, path, error)) return NULL;
    file_abandon(&probe);
    struct movie *movie = calloc(1, sizeof *movie);
    if (!movie) {
        error_set(error, "not enough memory for a movie");
        return NULL;
    }
    movie->pipe = -1;
    movie->width = width;
    movie->height = height;
    snprintf(movie->path, sizeof movie->path, "%s", path);
    snprintf(movie->partial, sizeof movie->partial, "%s.partial", path);
    movie->complaints = tmpfile();
    if (!movie->complaints) error_set(error, "cannot make a temporary file: %s", strerror(errno));
    if (movie->complaints && start(movie, find_format(path), frame_rate, error)) return movie;
    if (movie->pipe >= 0) close(movie->pipe);
    movie_free(movie);
    return NULL;
}

/* Ends ffmpeg's input and waits; true if it was content. */
static bool finish(struct movie *movie)
{
    if (movie->pipe >= 0) close(movie->pipe);
    movie->pipe = -1;
    int status = 0;
    pid_t ended;
    do ended = waitpid(movie->process, &status, 0);
    while (ended < 0 && errno == EINTR);
    movie->process = 0;
    return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static bool complain(struct movie *movie, struct error *error)
{
    char words[300] = "";
    rewind(movie->complaints);
    const size_t size = fread(words, 1, sizeof words - 1, movie->complaints);
    words[size] = 0;
    for (char *at = words; *at; at++) if (*at == '\n' || *at == '\r') *at = ' ';
    return error_set(error, "%s: ffmpeg could not write this movie: %s", movie->path,
                     *words ? words : "it ended early; is the disk full?");
}

/* After a signal ffmpeg has so long to read on; it needs milliseconds unless it hangs. */
enum { PATIENCE_MS = 3000 };

/* A signal while ffmpeg hangs gives the film up, not the run: whoever asked for the end must not
 * wait forever.  Only a signal lets write() to a pipe return before all is written. */
static bool send(struct movie *movie, const uint8_t *bytes, size_t size)
{
    while (size > 0 && !movie->torn) {
        const ssize_t sent = write(movie->pipe, bytes, size);
        if (sent < 0 && errno != EINTR) return false;
        if (sent > 0) {
            bytes += sent;
            size -= (size_t)sent;
        }
        struct pollfd room = {.fd = movie->pipe, .events = POLLOUT};
        if (size > 0) movie->torn = poll(&room, 1, PATIENCE_MS) == 0;
    }
    return true;
}

/* The picture itself if it is opaque, else a copy laid on white; NULL without memory. */
static const uint8_t *flatten(struct movie *movie, const struct image *image)
{
    const size_t count = (size_t)image->width * image->height;
    size_t first = 0;
    while (first < count && image->rgba[4 * first + 3] == 255) first++;
    if (first == count) return image->rgba;
    if (!movie->flat) movie->flat = malloc(4 * count);
    if (!movie->flat) return NULL;
    for (size_t k = 0; k < count; k++) {
        const uint8_t *from = image->rgba + 4 * k;
        uint8_t *to = movie->flat + 4 * k;
        for (int c = 0; c < 3; c++) {
            to[c] = (uint8_t)((from[c] * from[3] + 255 * (255 - from[3]) + 127) / 255);
        }
        to[3] = 255;
    }
    return movie->flat;
}

bool movie_frame(struct movie *movie, const struct image *image, struct error *error)
{
    assert(image->width == movie->width);
    assert(image->height == movie->height);
    const uint8_t *bytes = flatten(movie, image);
    if (!bytes) return error_set(error, "not enough memory for a frame of the movie");
    if (send(movie, bytes, (size_t)4 * image->width * image->height)) return true;
    finish(movie);
    return complain(movie, error);
}

bool movie_commit(struct movie *movie, struct error *error)
{
    if (movie->torn) {
        error_set(error, "%s: a signal came while ffmpeg did not read; no movie was made",
                  movie->path);
        movie_abandon(movie);
        return false;
    }
    bool done = movie->process > 0 && finish(movie);
    if (!done) complain(movie, error);
    if (done) file_sync(movie->partial);
    if (done && rename(movie->partial, movie->path) != 0) {
        done = error_set(error, "%s: cannot name the movie: %s", movie->path, strerror(errno));
    }
    if (!done) unlink(movie->partial);
    movie_free(movie);
    return done;
}

void movie_abandon(struct movie *movie)
{
    if (!movie) return;
    if (movie->process > 0) {
        kill(movie->process, SIGKILL);          /* it may wait for something, and need not tidy */
        finish(movie);
    }
    unlink(movie->partial);
    movie_free(movie);
}
