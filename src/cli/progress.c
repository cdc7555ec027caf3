/* progress.c - see progress.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/progress.h"

#include "base/clock.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

static const double bar_seconds = 0.1, plain_seconds = 10;      /* between two lines */

bool progress_begin(struct progress *progress, const char *word, struct error *error)
{
    static const char *const words[] = {"auto", "bar", "plain", "none"};
    const char *quiet = getenv("NO_COLOR"), *terminal = getenv("TERM");
    const bool is_terminal = isatty(STDERR_FILENO) && terminal && strcmp(terminal, "dumb") != 0;
    *progress = (struct progress){.how = PROGRESS_AUTO, .color = is_terminal && !(quiet && *quiet)};
    int how = word ? -1 : PROGRESS_AUTO;
    for (int k = 0; word && k < 4; k++) if (strcmp(word, words[k]) == 0) how = k;
    if (how < 0) {
        return error_set_code(error, EXIT_USAGE, "--progress %s: use auto, bar, plain or none",
                              word);
    }
    progress->how = (enum progress_how)how;
    if (how == PROGRESS_AUTO) progress->how = is_terminal ? PROGRESS_BAR : PROGRESS_PLAIN;
    return true;
}

/* 12.3k, 4.56M, ... */
static const char *short_number(double value, char *text, size_t size)
{
    static const char *const prefixes[] = {"", "k", "M", "G", "T"};
    int k = 0;
    for (; value >= 1000 && k < 4; k++) value /= 1000;
    snprintf(text, size, "%.3g%s", value, prefixes[k]);
    return text;
}

static const char *short_time(double seconds, char *text, size_t size)
{
    if (!isfinite(seconds)) snprintf(text, size, "--");
    else if (seconds < 60) snprintf(text, size, "%.0fs", seconds);
    else if (seconds < 3600) snprintf(text, size, "%.0fm%02.0fs", floor(seconds / 60),
                                      fmod(seconds, 60));
    else snprintf(text, size, "%.0fh%02.0fm", floor(seconds / 3600),
                  floor(fmod(seconds, 3600) / 60));
    return text;
}

static void show_bar(struct progress *progress, const char *line, double share)
{
    enum { BAR = 12 };         /* leaves room for the numbers in 80 columns */
    struct winsize window = {0};
    int width = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 ? window.ws_col : 80;
    if (width < 20) width = 80;
    char bar[3 * BAR + 1] = "";
    const int full = (int)(fmin(fmax(share, 0), 1) * BAR);
    for (int k = 0; k < BAR; k++) strcat(bar, k < full ? "=" : k == full ? ">" : " ");
    const char *on = progress->color ? "\033[36m" : "", *off = progress->color ? "\033[0m" : "";
    fprintf(stderr, "\r\033[K[%s%s%s] %.*s", on, bar, off, width - BAR - 4, line);
    fflush(stderr);
    progress->line_open = true;
}

void progress_show(struct progress *progress, const struct run_status *status)
{
    if (progress->how == PROGRESS_NONE) return;
    const double now = clock_wall();
    const double pause = progress->how == PROGRESS_BAR ? bar_seconds : plain_seconds;
    if (progress->shown > 0 && now - progress->shown < pause) return;
    if (progress->shown == 0 && progress->how == PROGRESS_PLAIN && status->wall < 1) return;
    progress->shown = now;
    char line[256], rate[32], eta[32];
    const double frame_rate = status->wall > 0 ? (double)status->frames / status->wall : 0;
    if (strcmp(status->doing, "simulating") == 0) {
        snprintf(line, sizeof line, "%3.0f%% t = %.3g of %.3g, %s %s/s, %.1f frames/s, %s left",
                 100 * status->share, status->time, status->until,
                 short_number(status->rate, rate, sizeof rate), status->work, frame_rate,
                 short_time(status->eta, eta, sizeof eta));
    } else {
        snprintf(line, sizeof line, "%3.0f%%  %s", 100 * status->share, status->doing);
    }
    if (progress->how == PROGRESS_BAR) show_bar(progress, line, status->share);
    else fprintf(stderr, "%s\n", line);
}

void progress_end(struct progress *progress)
{
    if (progress->line_open) fputc('\n', stderr);
    progress->line_open = false;
}
