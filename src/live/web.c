/* web.c - see web.h.
 *
 * A thread for each connection, few of them, each request bounded in time and in bytes.  A viewer
 * asks for the next picture when it has got the last, so a slow one simply asks more seldom.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/web.h"

#ifdef SANDREEL_MICROHTTPD

#include "base/asset.h"
#include "live/request.h"
#include "live/web_json.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

enum {
    KEY_BYTES = REQUEST_KEY_LENGTH / 2,
    CONNECTIONS_MAX = 24,
    IDLE_SECONDS = 20,          /* a connection that says nothing is closed */
    HEADERS_BYTES = 16384
};

static const double wait_seconds = 5;           /* for a newer picture */
static const double fresh_seconds = 0.5;        /* for one to save, if nothing has changed */
static const double rate_min = 0.1, rate_max = 120, rate_default = 30;
static const double after_max = 1e15;           /* frames: exact as a double */
static const int png_level = 1;                 /* the fast one */

struct web {
    struct loop *loop;
    struct MHD_Daemon *daemon;
    char key[REQUEST_KEY_LENGTH + 1];
    char address[80];
    uint16_t port;
};

bool web_available(void) { return true; }
const char *web_address(const struct web *web) { return web->address; }
uint16_t web_port(const struct web *web) { return web->port; }

/* ---- answers ------------------------------------------------------------------------------ */

static enum MHD_Result send_response(struct MHD_Connection *connection, unsigned code,
                                     const char *type, struct MHD_Response *response)
{
    if (!response) return MHD_NO;
    static const char *const headers[][2] = {
        {"Cache-Control", "no-store"}, {"Referrer-Policy", "no-referrer"},
        {"X-Content-Type-Options", "nosniff"}, {"X-Frame-Options", "DENY"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Content-Security-Policy", "default-src 'self'; img-src 'self' blob: data:; "
                                    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    };
    for (size_t k = 0; k < sizeof headers / sizeof *headers; k++) {
        MHD_add_response_header(response, headers[k][0], headers[k][1]);
    }
    if (type) MHD_add_response_header(response, "Content-Type", type);
    const enum MHD_Result result = MHD_queue_response(connection, code, response);
    MHD_destroy_response(response);
    return result;
}

static enum MHD_Result send_text(struct MHD_Connection *connection, unsigned code,
                                 const char *text)
{
    return send_response(connection, code, "text/plain; charset=utf-8",
        MHD_create_response_from_buffer(strlen(text), (void *)(uintptr_t)text,
                                        MHD_RESPMEM_MUST_COPY));
}

/* `text` is malloc'ed and goes with the answer; NULL: no memory. */
static enum MHD_Result send_json(struct MHD_Connection *connection, char *text)
{
    if (!text) return send_text(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "the session is over");
    return send_response(connection, MHD_HTTP_OK, "application/json",
        MHD_create_response_from_buffer(strlen(text), text, MHD_RESPMEM_MUST_FREE));
}

static enum MHD_Result send_asset(struct MHD_Connection *connection, const char *name,
                                  const char *type)
{
    const struct asset *asset = asset_find(name);
    if (!asset) return send_text(connection, MHD_HTTP_NOT_FOUND, "not found");
    return send_response(connection, MHD_HTTP_OK, type,
        MHD_create_response_from_buffer(asset->size, (void *)(uintptr_t)asset->bytes,
                                        MHD_RESPMEM_PERSISTENT));
}

/* ---- pictures ----------------------------------------------------------------------------- */

static const char *argument(struct MHD_Connection *connection, const char *name)
{
    return MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, name);
}

struct holding { struct stage *stage; const struct stage_frame *frame; };

static void let_go(void *context)
{
    struct holding *holding = context;
    stage_release(holding->stage, holding->frame);
    free(holding);
}

/* The pixels as they are; the picture is held until they are sent. */
static struct MHD_Response *raw_response(struct stage *stage, const struct stage_frame *frame)
{
    struct holding *holding = malloc(sizeof *holding);
    if (!holding) return NULL;
    *holding = (struct holding){stage, frame};
    const size_t size = (size_t)frame->image.width * frame->image.height * 4;
    struct MHD_Response *response = MHD_create_response_from_buffer_with_free_callback_cls(
        size, frame->image.rgba, let_go, holding);
    if (!response) free(holding);
    return response;
}

static struct MHD_Response *png_response(const struct stage_frame *frame)
{
    uint8_t *bytes;
    size_t size;
    struct error error;
    if (!image_encode(&frame->image, png_level, NULL, 0, &bytes, &size, &error)) return NULL;
    return MHD_create_response_from_buffer(size, bytes, MHD_RESPMEM_MUST_FREE);
}

static void add_status(struct MHD_Response *response, const struct stage_status *status,
                       const struct transform *transform)
{
    char *text = web_json_status(status, transform);
    if (text) MHD_add_response_header(response, "X-Status", text);
    free(text);
}

/* Nothing new: only how things stand, and what went wrong. */
static enum MHD_Result send_no_frame(struct web *web, struct MHD_Connection *connection)
{
    struct MHD_Response *response = MHD_create_response_from_buffer(0, "",
                                                                    MHD_RESPMEM_PERSISTENT);
    if (!response) return MHD_NO;
    const struct stage_status status = loop_status(web->loop);
    add_status(response, &status, NULL);
    return send_response(connection, MHD_HTTP_NO_CONTENT, NULL, response);
}

static enum MHD_Result send_frame(struct web *web, struct MHD_Connection *connection)
{
    struct stage *stage = loop_stage(web->loop);
    const char *as = argument(connection, "as");
    const bool png = as && strcmp(as, "png") == 0;
    const double after = request_number(argument(connection, "after"), 0, 0, after_max);
    const double rate = request_number(argument(connection, "rate"), rate_default, rate_min,
                                       rate_max);
    const struct stage_frame *frame = stage_await(stage, (uint64_t)after, wait_seconds, rate);
    if (!frame) return send_no_frame(web, connection);
    struct MHD_Response *response = png ? png_response(frame) : raw_response(stage, frame);
    if (response) {
        char number[32], size[32];
        snprintf(number, sizeof number, "%llu", (unsigned long long)frame->number);
        snprintf(size, sizeof size, "%ux%u", frame->image.width, frame->image.height);
        MHD_add_response_header(response, "X-Frame", number);
        MHD_add_response_header(response, "X-Size", size);
        add_status(response, &frame->status, &frame->transform);
    }
    const bool held = response && !png;         /* raw pixels let go when they are sent */
    if (!held) stage_release(stage, frame);
    return send_response(connection, MHD_HTTP_OK, png ? "image/png" : "application/octet-stream",
                         response);
}

static enum MHD_Result send_picture(struct web *web, struct MHD_Connection *connection)
{
    struct stage *stage = loop_stage(web->loop);
    /* The present, if it is not what was drawn last. */
    const struct stage_frame *frame = stage_await(stage, stage_drawn(stage), fresh_seconds,
                                                  rate_default);
    if (!frame) frame = stage_await(stage, 0, wait_seconds, rate_default);
    if (!frame) return send_text(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "no picture yet");
    struct MHD_Response *response = png_response(frame);
    stage_release(stage, frame);
    if (response) {
        MHD_add_response_header(response, "Content-Disposition",
                                "attachment; filename=\"sandreel.png\"");
    }
    return send_response(connection, MHD_HTTP_OK, "image/png", response);
}

/* ---- commands ----------------------------------------------------------------------------- */

static enum MHD_Result take_command(struct web *web, struct MHD_Connection *connection,
                                    const struct request_body *body)
{
    char reply[SESSION_REPLY_MAX];
    if (body->too_long) {
        return send_text(connection, MHD_HTTP_CONTENT_TOO_LARGE, "a command is one short line");
    }
    if (!request_is_text(body)) {
        return send_text(connection, MHD_HTTP_BAD_REQUEST, "a command is text");
    }
    const bool ok = loop_ask(web->loop, body->bytes, reply, sizeof reply);
    return send_json(connection, web_json_reply(ok, reply));
}

static enum MHD_Result send_news(struct web *web, struct MHD_Connection *connection)
{
    char text[1000];
    loop_trouble(web->loop, text, sizeof text);
    if (!text[0]) snprintf(text, sizeof text, "%s", stage_trouble(loop_stage(web->loop)));
    return send_json(connection, web_json_reply(text[0] == 0, text));
}

static enum MHD_Result send_call(struct web *web, struct MHD_Connection *connection,
                                 void (*answer)(void *, struct session *))
{
    char *text = NULL;
    loop_call(web->loop, answer, &text);
    return send_json(connection, text);
}

/* ---- requests ----------------------------------------------------------------------------- */

static enum MHD_Result answer(struct web *web, struct MHD_Connection *connection,
                              enum request request, const struct request_body *body)
{
    switch (request) {
    case REQUEST_page:
        return send_asset(connection, "assets/live/page.html", "text/html; charset=utf-8");
    case REQUEST_style:
        return send_asset(connection, "assets/live/page.css", "text/css; charset=utf-8");
    case REQUEST_script:
        return send_asset(connection, "assets/live/page.js", "text/javascript; charset=utf-8");
    case REQUEST_frame:     return send_frame(web, connection);
    case REQUEST_picture:   return send_picture(web, connection);
    case REQUEST_about:     return send_call(web, connection, web_json_about);
    case REQUEST_keys:      return send_call(web, connection, web_json_keys);
    case REQUEST_news:      return send_news(web, connection);
    case REQUEST_COMMAND:   return take_command(web, connection, body);
    case REQUEST_UNKNOWN:   return send_text(connection, MHD_HTTP_NOT_FOUND, "not found");
    case REQUEST_NOT_ALLOWED:
        return send_text(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "not allowed");
    case REQUEST_FORBIDDEN: break;
    }
    return send_text(connection, MHD_HTTP_FORBIDDEN, "this is not for you");
}

/* The body comes in pieces before the request is complete. */
static enum MHD_Result serve(void *context, struct MHD_Connection *connection, const char *url,
                             const char *method, const char *version, const char *data,
                             size_t *data_size, void **request)
{
    const struct web *web = context;
    struct request_body *body = *request;
    (void)version;
    if (!body) {
        *request = calloc(1, sizeof *body);
        return *request ? MHD_YES : MHD_NO;
    }
    if (*data_size > 0) {
        request_gather(body, data, *data_size);
        *data_size = 0;
        return MHD_YES;
    }
    const struct request_words words = {
        .method = method, .url = url,
        .host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host"),
        .origin = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Origin"),
        .site = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Sec-Fetch-Site"),
    };
    return answer(context, connection, request_read(&words, web->key), body);
}

static void forget(void *context, struct MHD_Connection *connection, void **request,
                   enum MHD_RequestTerminationCode code)
{
    (void)context, (void)connection, (void)code;
    free(*request);
    *request = NULL;
}

static void say_nothing(void *context, const char *format, va_list arguments)
{
    (void)context, (void)format, (void)arguments;
}

/* ---- the server --------------------------------------------------------------------------- */

static bool make_key(struct web *web, struct error *error)
{
    unsigned char bytes[KEY_BYTES];
    if (getrandom(bytes, sizeof bytes, 0) != sizeof bytes) {
        return error_set(error, "the system gives no random numbers for the address");
    }
    for (int k = 0; k < KEY_BYTES; k++) snprintf(web->key + 2 * k, 3, "%02x", bytes[k]);
    return true;
}

static bool start(struct web *web, uint16_t port, struct error *error)
{
    const struct sockaddr_in here = {.sin_family = AF_INET, .sin_port = htons(port),
                                     .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    web->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_ERROR_LOG,
        port, NULL, NULL, serve, web,
        MHD_OPTION_EXTERNAL_LOGGER, say_nothing, NULL,          /* the terminal is not its own */
        MHD_OPTION_SOCK_ADDR, &here, MHD_OPTION_CONNECTION_LIMIT, CONNECTIONS_MAX,
        MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_SECONDS,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)HEADERS_BYTES,
        MHD_OPTION_NOTIFY_COMPLETED, forget, NULL, MHD_OPTION_END);
    if (!web->daemon) {
        return error_set(error, "cannot listen on port %u of the loopback interface; another "
                         "program may use it: --web alone takes a free one", (unsigned)port);
    }
    web->port = MHD_get_daemon_info(web->daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    snprintf(web->address, sizeof web->address, "http://127.0.0.1:%u/%s/", (unsigned)web->port,
             web->key);
    return true;
}

struct web *web_open(struct loop *loop, uint16_t port, struct error *error)
{
    struct web *web = calloc(1, sizeof *web);
    if (!web) {
        error_set(error, "not enough memory for a server");
        return NULL;
    }
    web->loop = loop;
    if (make_key(web, error) && start(web, port, error)) return web;
    web_close(web);
    return NULL;
}

void web_close(struct web *web)
{
    if (!web) return;
    stage_dismiss(loop_stage(web->loop));
    if (web->daemon) MHD_stop_daemon(web->daemon);
    free(web);
}

#else

bool web_available(void) { return false; }
const char *web_address(const struct web *web) { (void)web; return ""; }
uint16_t web_port(const struct web *web) { (void)web; return 0; }
void web_close(struct web *web) { (void)web; }

struct web *web_open(struct loop *loop, uint16_t port, struct error *error)
{
    (void)loop, (void)port;
    error_set_code(error, EXIT_USAGE, "this sandreel was built without its browser view; install "
                   "libmicrohttpd-dev and build again");
    return NULL;
}

#endif
