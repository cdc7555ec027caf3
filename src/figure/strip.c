/* strip.c - see strip.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/strip.h"

#include <assert.h>
#include <string.h>

static const int png_level = 6;                 /* one picture, made once: small rather than fast */

void strip_begin(struct strip *strip) { memset(strip, 0, sizeof *strip); }

bool strip_add(struct strip *strip, struct lab *lab, struct error *error)
{
    assert(strip->count < STRIP_PANELS);
    uint32_t f = 0;
    while (f < strip->films && strip->lab[f] != lab) f++;
    struct film *film = &strip->film[f];
    if (f == strip->films) {
        const struct scene *scene = lab->setup.scene;
        strip->lab[strip->films++] = lab;
        if (!film_open(film, scene, lab->setup.model, &scene->view, error)) return false;
    }
    if (film_needs_gathering(film) && !film_gather(film, &lab->footage.grains, error)) return false;
    strip->panels[strip->count].film = f;
    strip->panels[strip->count].steps = lab->footage.steps;
    strip->panels[strip->count++].grains = lab->footage.grains;
    memset(&lab->footage.grains, 0, sizeof lab->footage.grains);
    return true;
}

static bool draw(struct strip *strip, struct image *whole, struct error *error)
{
    uint32_t width = 0, height = 0;
    for (uint32_t k = 0; k < strip->count; k++) {
        const struct image *image = &strip->film[strip->panels[k].film].image;
        width += image->width;
        if (image->height > height) height = image->height;
    }
    if (!image_create(whole, width, height, error)) return false;
    memset(whole->rgba, 255, 4 * (size_t)width * height);
    uint32_t x0 = 0;
    for (uint32_t k = 0; k < strip->count; k++) {
        struct film *film = &strip->film[strip->panels[k].film];
        if (!film_draw(film, &strip->panels[k].grains, strip->panels[k].steps, 0, error)) {
            return false;
        }
        image_place(whole, &film->image, x0, 0);
        x0 += film->image.width;
    }
    return true;
}

bool strip_save(struct strip *strip, const char *path, struct error *error)
{
    struct film *films[STRIP_PANELS];
    struct image whole = {0};
    assert(strip->count > 0);
    for (uint32_t f = 0; f < strip->films; f++) films[f] = &strip->film[f];
    film_settle_together(films, strip->films);
    const struct image_note notes[] = {{"Software", "sandreel"}};
    const bool done = draw(strip, &whole, error)
        && image_save(&whole, path, png_level, notes, 1, error);
    image_free(&whole);
    strip_free(strip);
    return done;
}

void strip_free(struct strip *strip)
{
    for (uint32_t k = 0; k < strip->count; k++) grains_free(&strip->panels[k].grains);
    for (uint32_t f = 0; f < strip->films; f++) film_close(&strip->film[f]);
    strip_begin(strip);
}
