/* movie.c - see movie.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/movie.h"

#include "base/file.h"
#include "run/program.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
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
    struct program program;     /* ffmpeg */
    uint32_t width, height;
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
    return program_is_there("ffmpeg")
        || error_set(error, "movies need the program ffmpeg, which is not on the PATH; install it "
                     "(Debian: sudo apt install ffmpeg), or write frames instead of a movie");
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
    return program_start(&movie->program, arguments, NULL, error);
}

static void movie_free(struct movie *movie)
{
    program_close(&movie->program);
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
    movie->program.pipe = -1;
    movie->width = width;
    movie->height = height;
    snprintf(movie->path, sizeof movie->path, "%s", path);
    snprintf(movie->partial, sizeof movie->partial, "%s.partial", path);
    if (start(movie, find_format(path), frame_rate, error)) return movie;
    movie_free(movie);
    return NULL;
}

static bool complain(struct movie *movie, struct error *error)
{
    char words[300];
    program_words(&movie->program, words, sizeof words);
    return error_set(error, "%s: ffmpeg could not write this movie: %s", movie->path,
                     *words ? words : "it ended early; is the disk full?");
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
    if (program_send(&movie->program, bytes, (size_t)4 * image->width * image->height)) return true;
    program_finish(&movie->program);
    return complain(movie, error);
}

bool movie_commit(struct movie *movie, struct error *error)
{
    if (movie->program.hangs) {
        error_set(error, "%s: a signal came while ffmpeg did not read; no movie was made",
                  movie->path);
        movie_abandon(movie);
        return false;
    }
    bool done = program_finish(&movie->program);
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
    movie->program.hangs = true;        /* its work goes away: it need not tidy up */
    program_stop(&movie->program);
    unlink(movie->partial);
    movie_free(movie);
}
