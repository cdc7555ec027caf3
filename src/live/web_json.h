/* web_json.h - what the page is told, as JSON.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef WEB_JSON_H
#define WEB_JSON_H

#include "live/stage.h"

/* One line, for a header; the caller frees.  `transform` may be NULL. */
char *web_json_status(const struct stage_status *status, const struct transform *transform);

/* {"text": reply or complaint, "ok": ...} */
char *web_json_reply(bool ok, const char *text);

/* What does not change: the scene's name and model, commands, keys, words, maps.  For loop_call():
 * `context` is a char * that takes the text, malloc'ed. */
void web_json_about(void *context, struct session *session);

/* Every key that can be changed while it runs, with its value and limits; likewise. */
void web_json_keys(void *context, struct session *session);

#endif
