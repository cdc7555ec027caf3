/* request.h - what a request to the server of web.h asks for, decided by its words alone.
 *
 * Whoever can reach the port can send any bytes, so what becomes of them is kept apart from the
 * library that receives them, and tried by itself (tests/fuzz/fuzz_request.c).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef REQUEST_H
#define REQUEST_H

#include "live/command.h"

#include <stdbool.h>
#include <stddef.h>

enum { REQUEST_KEY_LENGTH = 32 };

/* X(what, its name behind "/KEY/") - asked for with GET */
#define REQUESTS(X)                                                                     \
    X(page, "") X(style, "page.css") X(script, "page.js") X(frame, "frame")             \
    X(picture, "picture.png") X(about, "about") X(keys, "keys") X(news, "news")

enum request {
#define X(what, name) REQUEST_##what,
    REQUESTS(X)
#undef X
    REQUEST_COMMAND,            /* POST "/KEY/command" */
    REQUEST_FORBIDDEN,          /* no key, or from elsewhere */
    REQUEST_UNKNOWN,
    REQUEST_NOT_ALLOWED         /* another method */
};

/* The parts that decide; NULL: not sent. */
struct request_words { const char *method, *url, *host, *origin, *site; };

/* `key` has REQUEST_KEY_LENGTH letters.  Nothing but what comes from a page of this very server,
 * by its key and on this machine, is other than REQUEST_FORBIDDEN. */
enum request request_read(const struct request_words *words, const char *key);

/* A number of the query, within its limits; the fallback for what is none. */
double request_number(const char *text, double fallback, double low, double high);

/* What came with a request so far: at most one line of it is kept. */
struct request_body { size_t size; bool too_long; char bytes[COMMAND_LINE_MAX]; };

/* Takes the next piece. */
void request_gather(struct request_body *body, const char *data, size_t size);

/* Is it one line of text?  A byte 0 would hide what follows. */
bool request_is_text(const struct request_body *body);

#endif
