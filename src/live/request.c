/* request.c - see request.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/request.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_loopback_host(const char *host)
{
    static const char *const names[] = {"127.0.0.1", "localhost", "[::1]"};
    for (size_t k = 0; host && k < sizeof names / sizeof *names; k++) {
        const size_t length = strlen(names[k]);
        if (strncmp(host, names[k], length) != 0) continue;
        const char *port = host + length;
        if (*port == 0) return true;
        /* Any port: `ssh -L` may have chosen another one at the viewer's end. */
        return *port == ':' && port[1] && strspn(port + 1, "0123456789") == strlen(port + 1);
    }
    return false;
}

/* A page from elsewhere may send requests here, but not without saying where it is from. */
static bool is_from_here(const struct request_words *words)
{
    if (!is_loopback_host(words->host)) return false;
    const char *origin = words->origin;
    if (origin && (strncmp(origin, "http://", 7) != 0 || strcmp(origin + 7, words->host) != 0)) {
        return false;
    }
    return !words->site || strcmp(words->site, "same-origin") == 0
        || strcmp(words->site, "none") == 0;
}

/* The rest of the address behind "/KEY/"; NULL if the key is not ours.  It looks at every byte,
 * so that the time tells nothing. */
static const char *behind_key(const char *url, const char *key)
{
    if (strlen(url) < REQUEST_KEY_LENGTH + 2) return NULL;
    if (url[0] != '/' || url[REQUEST_KEY_LENGTH + 1] != '/') return NULL;
    unsigned difference = 0;
    for (int k = 0; k < REQUEST_KEY_LENGTH; k++) {
        difference |= (unsigned char)url[k + 1] ^ (unsigned char)key[k];
    }
    return difference == 0 ? url + REQUEST_KEY_LENGTH + 2 : NULL;
}

enum request request_read(const struct request_words *words, const char *key)
{
    static const char *const names[] = {
#define X(what, name) [REQUEST_##what] = name,
        REQUESTS(X)
#undef X
    };
    const char *name = is_from_here(words) ? behind_key(words->url, key) : NULL;
    if (!name) return REQUEST_FORBIDDEN;
    if (strcmp(words->method, "POST") == 0 && strcmp(name, "command") == 0) return REQUEST_COMMAND;
    if (strcmp(words->method, "GET") != 0) return REQUEST_NOT_ALLOWED;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (strcmp(name, names[k]) == 0) return (enum request)k;
    }
    return REQUEST_UNKNOWN;
}

double request_number(const char *text, double fallback, double low, double high)
{
    char *end;
    const double value = text ? strtod(text, &end) : fallback;
    const bool is_number = !text || (end != text && *end == 0 && isfinite(value));
    return fmin(fmax(is_number ? value : fallback, low), high);
}

void request_gather(struct request_body *body, const char *data, size_t size)
{
    if (size < sizeof body->bytes - body->size) {
        memcpy(body->bytes + body->size, data, size);
        body->size += size;
    } else {
        body->too_long = true;
    }
}

bool request_is_text(const struct request_body *body)
{
    return !memchr(body->bytes, 0, body->size);
}
