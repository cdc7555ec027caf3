/* tty.c - see tty.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/tty.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/* The other screen, without a cursor; and back, without pictures and colours. */
static const char enter[] = "\033[?1049h\033[?25l\033[2J";
static const char leave[] = "\033_Ga=d,q=2\033\\\033[0m\033[?25h\033[?1049l";

/* A query for kitty's pictures, then one that every terminal answers. */
static const char query[] = "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\\033[c";
static const double answer_seconds = 0.5;

enum { ANSWER_MAX = 256 };

void tty_write(const char *text, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(STDOUT_FILENO, text, size);
        if (written < 0 && errno != EINTR && errno != EAGAIN) return;
        if (written <= 0) continue;
        text += written;
        size -= (size_t)written;
    }
}

int tty_read(double seconds)
{
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    unsigned char byte;
    if (poll(&input, 1, (int)(seconds * 1000)) <= 0) return -1;
    return read(STDIN_FILENO, &byte, 1) == 1 ? byte : -1;
}

/* The watcher's life: waits until the line is cut.  A byte means that all is well. */
static _Noreturn void watch(int line, const struct termios *found)
{
    char byte;
    ssize_t got;
    setsid();                   /* what kills the program's group does not reach it */
    signal(SIGTTOU, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    if (write(line, "", 1) != 1) _exit(1);
    do {
        got = read(line, &byte, 1);
    } while (got < 0 && errno == EINTR);
    if (got == 0) {
        tty_write(leave, sizeof leave - 1);
        tcsetattr(STDIN_FILENO, TCSANOW, found);
    }
    _exit(0);
}

static bool start_watcher(struct tty *tty, struct error *error)
{
    int ends[2];
    char byte;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        return error_set(error, "no line to a watcher: %s", strerror(errno));
    }
    tty->watcher = fork();
    if (tty->watcher == 0) {
        close(ends[1]);
        watch(ends[0], &tty->found);
    }
    close(ends[0]);
    /* Only once it is on its own is the terminal changed. */
    if (tty->watcher > 0 && read(ends[1], &byte, 1) == 1) {
        tty->line = ends[1];
        return true;
    }
    close(ends[1]);
    return error_set(error, "no process for a watcher: %s", strerror(errno));
}

/* What the terminal says before the end of its answer, ESC [ ? ... c. */
static void ask(struct tty *tty)
{
    char answer[ANSWER_MAX];
    size_t size = 0;
    tty_write(query, sizeof query - 1);
    for (int byte; size < sizeof answer - 1 && (byte = tty_read(answer_seconds)) >= 0;) {
        answer[size++] = (char)byte;
        answer[size] = 0;
        if (byte == 'c' && strstr(answer, "\033[?")) break;
    }
    answer[size] = 0;
    tty->kitty = strstr(answer, "_Gi=31;OK") != NULL;
    /* Attribute 4 among those of the answer is sixel. */
    const char *attributes = strstr(answer, "\033[?");
    tty->sixel = attributes && (strstr(attributes, ";4;") || strstr(attributes, ";4c"));
}

bool tty_resized(struct tty *tty)
{
    struct winsize size;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
        size = (struct winsize){.ws_col = 80, .ws_row = 24};
    }
    const bool same = tty->columns == size.ws_col && tty->rows == size.ws_row
                   && tty->width == size.ws_xpixel && tty->height == size.ws_ypixel;
    tty->columns = size.ws_col;
    tty->rows = size.ws_row;
    tty->width = size.ws_xpixel;
    tty->height = size.ws_ypixel;
    return !same;
}

void tty_again(const struct tty *tty)
{
    tcsetattr(STDIN_FILENO, TCSANOW, &tty->raw);
}

bool tty_open(struct tty *tty, struct error *error)
{
    *tty = (struct tty){.line = -1};
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)
        || tcgetattr(STDIN_FILENO, &tty->found) != 0) {
        return error_set_code(error, EXIT_USAGE, "this is no terminal; use --web for a browser or "
                              "--commands FILE");
    }
    if (!start_watcher(tty, error)) return false;
    tty->raw = tty->found;
    tty->raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    tty->raw.c_iflag &= ~(tcflag_t)(IXON | ICRNL);
    tty->raw.c_cc[VMIN] = 1;
    tty->raw.c_cc[VTIME] = 0;
    tty->raw.c_cc[VSUSP] = _POSIX_VDISABLE;     /* a shell would find its terminal changed */
    tty_again(tty);
    tty_write(enter, sizeof enter - 1);
    ask(tty);
    tty_resized(tty);
    return true;
}

void tty_close(struct tty *tty)
{
    if (tty->line < 0) return;
    tty_write(leave, sizeof leave - 1);
    tcsetattr(STDIN_FILENO, TCSADRAIN, &tty->found);
    if (write(tty->line, "", 1) == 1) {}        /* the watcher may be gone: then all is done */
    close(tty->line);
    waitpid(tty->watcher, NULL, 0);
    tty->line = -1;
}
