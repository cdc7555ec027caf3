/* web.h - a session in a browser: one page, its pictures and its commands over HTTP.
 *
 * The server listens on the loopback interface alone, and every address begins with a random key,
 * so that neither other machines nor other users of this one can steer; requests that a page from
 * elsewhere makes the browser send are refused by their Host and Origin.
 *
 *     GET  /KEY/            the page            GET /KEY/about     commands, keys, words, as JSON
 *     GET  /KEY/frame?after=N&as=raw|png&rate=R waits for a newer picture: 200, or 204 if none came
 *     GET  /KEY/keys        every key of the scene with its value
 *     GET  /KEY/picture.png what is to be seen, to be saved
 *     POST /KEY/command     one line; the answer is {"ok": ..., "text": ...}
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef WEB_H
#define WEB_H

#include "live/loop.h"

struct web;

/* `port` 0 takes any that is free. */
struct web *web_open(struct loop *loop, uint16_t port, struct error *error);

/* Refuses new requests and waits for those under way.  The loop must be over or still running. */
void web_close(struct web *web);

/* "http://127.0.0.1:PORT/KEY/" */
const char *web_address(const struct web *web);
uint16_t web_port(const struct web *web);

/* Was it built with a server? */
bool web_available(void);

#endif
