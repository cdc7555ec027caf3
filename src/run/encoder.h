/* encoder.h - PNG files compressed and written beside the simulation.
 *
 * A bounded queue between the one thread that draws and the threads that encode: when it is full
 * the drawing waits, so memory stays bounded.  What a file holds depends on the picture alone,
 * never on which thread encoded it or when.  Without threads it works in place.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ENCODER_H
#define ENCODER_H

#include "draw/image.h"

struct encoder;

enum { ENCODER_NOTES = 8, ENCODER_NOTE_TEXT = 160 };

struct encoder_note { char key[24], text[ENCODER_NOTE_TEXT]; };

struct encoder_job {
    char path[4096];
    int  level;
    uint32_t note_count;
    struct encoder_note notes[ENCODER_NOTES];
};

struct encoder *encoder_create(uint32_t threads, struct error *error);

/* Waits for what is queued, stops the threads, frees. */
void encoder_destroy(struct encoder *encoder);

/* Queues the picture; `image` comes back as another one of the same size, its pixels undefined.
 * False (with the cause) if this or an earlier picture could not be written. */
bool encoder_submit(struct encoder *encoder, struct image *image, const struct encoder_job *job,
                    struct error *error);

/* Waits until all that was queued is on the disk; false if any of it failed. */
bool encoder_wait(struct encoder *encoder, struct error *error);

double encoder_cpu(struct encoder *encoder);    /* processor seconds of its threads so far */

#endif
