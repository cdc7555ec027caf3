/* place_file.c - see place_file.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/place_file.h"

#include "scene/grainfile.h"
#include "scene/resolve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Files keep six digits or more, so a radius of theirs is one of ours within this share. */
static const double rounding = 1e-5;

void place_file_path(const struct scene *scene, const struct placement *placement, char *path,
                     size_t size)
{
    const char *slash = strrchr(scene->path, '/');
    if (*placement->file == '/' || !slash) snprintf(path, size, "%s", placement->file);
    else snprintf(path, size, "%.*s/%s", (int)(slash - scene->path), scene->path, placement->file);
}

struct filler {
    struct placer *placer;
    const struct placement *placement;
    const struct grainfile *file;
    uint32_t number, species;
    char path[2 * KEY_TEXT_MAX];
};

/* Tells what is wrong with row k, under the placement's `file`. */
static void tell(const struct filler *filler, enum finding_kind kind, uint32_t k, const char *why)
{
    char key[64];
    const double *row = filler->file->rows[k];
    snprintf(key, sizeof key, "placements.[%u].file", filler->number);
    findings_tell(filler->placer->findings, filler->placer->scene, kind, key,
                  "%.200s: the grain at (%g, %g) %s", filler->path, row[GRAINFILE_x],
                  row[GRAINFILE_y], why);
}

/* The species of row k; the count of species (and a finding) if there is none. */
static uint32_t species_of(const struct filler *filler, uint32_t k)
{
    const struct scene *scene = filler->placer->scene;
    if (*filler->placement->grains || !filler->file->has[GRAINFILE_species]) return filler->species;
    const double wanted = filler->file->rows[k][GRAINFILE_species];
    if (wanted >= 0 && wanted < scene->species_count) return (uint32_t)wanted;
    char why[160];
    snprintf(why, sizeof why, "is of species %g, but the scene has %u; add species to 'grains', or "
             "name one for all by the placement's 'grains'", wanted, scene->species_count);
    tell(filler, FINDING_ERROR, k, why);
    return scene->species_count;
}

/* The radius of row k, which its species must allow; 0 after a finding. */
static double radius_of(const struct filler *filler, uint32_t k, const struct species *species)
{
    if (!filler->file->has[GRAINFILE_radius]) {
        return placer_radius(species, placer_word(filler->placer, STREAM_RADIUS, filler->number,
                                                  k));
    }
    const double radius = filler->file->rows[k][GRAINFILE_radius];
    const double low = resolve_radius_min(species), high = resolve_radius_max(species);
    const struct key_reals *radii = &species->radii;
    for (uint32_t r = 0; r < radii->count; r++) {
        if (fabs(radius - radii->values[r]) <= rounding * radius) return radii->values[r];
    }
    if (!radii->count && radius >= low * (1 - rounding) && radius <= high * (1 + rounding)) {
        return fmin(fmax(radius, low), high);
    }
    char why[200];
    snprintf(why, sizeof why, "has the radius %.9g, which its species does not allow (%g to %g); "
             "widen the 'radius' of that species", radius, low, high);
    tell(filler, FINDING_ERROR, k, why);
    return 0;
}

/* Across a periodic border a grain comes in on the other side. */
static double fold(double x, double low, double high, bool wraps)
{
    return wraps && (x < low || x >= high) ? x - (high - low) * floor((x - low) / (high - low)) : x;
}

/* Places row k; false without memory.  *overlaps counts grains that touch too much. */
static bool place_row(const struct filler *filler, uint32_t k, uint32_t *overlaps)
{
    struct placer *placer = filler->placer;
    const struct scene *scene = placer->scene;
    const double *row = filler->file->rows[k], *box = scene->box;
    const uint32_t index = species_of(filler, k);
    if (index >= scene->species_count) return true;
    const double radius = radius_of(filler, k, &scene->species[index]);
    if (!(radius > 0)) return true;
    const double x = fold(row[GRAINFILE_x], box[0], box[2], placer->wraps_x);
    const double y = fold(row[GRAINFILE_y], box[1], box[3], placer->wraps_y);
    const struct region region = placer_region(placer, filler->placement);
    if (!placer_region_holds(&region, x, y, 0)) {
        tell(filler, FINDING_ERROR, k, "lies outside of the placement's region (without one: "
             "of the box)");
        return true;
    }
    /* Soft grains overlap a little where they press on each other; more than this breaks a run. */
    const double core = radius * (1 - scene->overlap_limit);
    if (placer_is_taken(placer, x, y, core)) {
        tell(filler, FINDING_ERROR, k, "overlaps another one by more than 'overlap_limit'");
        return true;
    }
    if (placer_meets_wall(placer, x, y, core)) {
        tell(filler, FINDING_ERROR, k, "lies in a wall");
        return true;
    }
    *overlaps += placer_is_taken(placer, x, y, radius * (1 - rounding));
    if (!placer_add(placer, x, y, radius, index)) return false;
    struct placed *g = &placer->grains;
    g->vx[g->count - 1] = row[GRAINFILE_vx];
    g->vy[g->count - 1] = row[GRAINFILE_vy];
    g->spin[g->count - 1] = row[GRAINFILE_spin];
    return true;
}

bool place_file(struct placer *placer, const struct placement *placement, uint32_t number,
                uint32_t species_index)
{
    struct grainfile file;
    struct error error;
    struct filler filler = {.placer = placer, .placement = placement, .file = &file,
                            .number = number, .species = species_index};
    char key[64];
    snprintf(key, sizeof key, "placements.[%u].file", number);
    place_file_path(placer->scene, placement, filler.path, sizeof filler.path);
    bool done = true;
    uint32_t overlaps = 0;
    if (!grainfile_load(filler.path, &file, &error)) {
        findings_tell(placer->findings, placer->scene, FINDING_ERROR, key, "%.400s", error.text);
    } else {
        const uint32_t count = placement->count && placement->count < file.count ? placement->count
                                                                                 : file.count;
        for (uint32_t k = 0; done && k < count; k++) done = place_row(&filler, k, &overlaps);
    }
    if (overlaps) {
        findings_tell(placer->findings, placer->scene, FINDING_WARNING, key, "%.200s: %u grains "
                      "overlap another one; models of hard discs want them apart", filler.path,
                      overlaps);
    }
    grainfile_free(&file);
    return done;
}
