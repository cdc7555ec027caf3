/* fuzz_request.c - any bytes as a request to the server of a live session.
 *
 * The bytes are read as HTTP: a line "METHOD URL", headers, an empty line, the body, which comes in
 * pieces of the size that the number of headers gives.  Nobody but a page of this server may get
 * further than "this is not for you", and the reason why a command is refused fits into JSON.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/request.h"
#include "run/manifest.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char key[] = "0123456789abcdef0123456789abcdef";

/* The line that begins at *at, without its end; NULL behind the last or an empty one. */
static char *line(char **at)
{
    char *begin = *at, *end = begin ? strchr(begin, '\n') : NULL;
    if (!begin) return NULL;
    *at = end ? end + 1 : NULL;
    if (end) *end = 0;
    const size_t length = strlen(begin);
    if (length > 0 && begin[length - 1] == '\r') begin[length - 1] = 0;
    return *begin ? begin : NULL;
}

/* The value of a header called `name`; NULL: another header. */
static const char *header(char *text, const char *name)
{
    const size_t length = strlen(name);
    if (strncasecmp(text, name, length) != 0 || text[length] != ':') return NULL;
    return text + length + 1 + strspn(text + length + 1, " \t");
}

/* Every word that let it in, looked at once more and in another way. */
static void check_allowed(const struct request_words *words)
{
    const char *const hosts[] = {"127.0.0.1", "localhost", "[::1]"};
    bool known = false;
    for (int k = 0; k < 3; k++) known = known || strstr(words->host, hosts[k]) == words->host;
    if (!known || strpbrk(words->host, "/@? ")) abort();
    if (strncmp(words->url + 1, key, sizeof key - 1) != 0) abort();
    if (words->origin && !strstr(words->origin, words->host)) abort();
}

static void try_command(const struct request_body *body)
{
    static struct command_line command;
    struct error error = {0};
    if (body->too_long || !request_is_text(body)) return;
    if (strlen(body->bytes) != body->size) abort();
    if (command_parse(body->bytes, &command, &error)) return;
    json_t *told = manifest_text(error.text);
    if (json_string_length(told) == 0) abort();
    json_decref(told);
}

static void try_number(const char *query)
{
    const char *equals = query ? strchr(query, '=') : NULL;
    const double number = request_number(equals ? equals + 1 : NULL, 30, 0.1, 120);
    if (!(number >= 0.1 && number <= 120)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1), *at = text;
    struct request_body *body = calloc(1, sizeof *body);
    if (!text || !body) abort();
    memcpy(text, data, size);
    text[size] = 0;
    char *first = line(&at), *space = first ? strchr(first, ' ') : NULL;
    struct request_words words = {.method = first ? first : "", .url = ""};
    char *query = NULL;
    size_t piece = 1;
    if (space) {
        *space = 0;
        words.url = strtok_r(space + 1, "? ", &query);
        if (!words.url) words.url = "";
    }
    for (char *one; first && (one = line(&at)); piece++) {
        const char *host = header(one, "Host"), *origin = header(one, "Origin"),
                   *site = header(one, "Sec-Fetch-Site");
        if (host) words.host = host;
        if (origin) words.origin = origin;
        if (site) words.site = site;
    }
    /* The body may hold bytes 0; `at` is where it begins. */
    for (size_t left = at ? size - (size_t)(at - text) : 0, now; left > 0; left -= now, at += now) {
        now = left < piece ? left : piece;
        request_gather(body, at, now);
    }
    const enum request request = request_read(&words, key);
    if (request != REQUEST_FORBIDDEN) check_allowed(&words);
    if (request == REQUEST_COMMAND) try_command(body);
    if (request == REQUEST_frame) try_number(query);
    free(body);
    free(text);
    return 0;
}
