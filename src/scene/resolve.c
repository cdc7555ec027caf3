/* resolve.c - see resolve.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/resolve.h"

#include <math.h>
#include <string.h>

/* ---- species ------------------------------------------------------------------------------- */

uint32_t resolve_species(const struct scene *scene, const char *name)
{
    if (!name[0]) return 0;
    uint32_t index = 0;
    while (index < scene->species_count && strcmp(scene->species[index].name, name) != 0) index++;
    return index;
}

double resolve_radius_max(const struct species *species)
{
    double radius = species->radii.count ? 0 : species->radius[1];
    for (uint32_t k = 0; k < species->radii.count; k++) {
        radius = fmax(radius, species->radii.values[k]);
    }
    return radius;
}

double resolve_radius_min(const struct species *species)
{
    double radius = species->radii.count ? INFINITY : species->radius[0];
    for (uint32_t k = 0; k < species->radii.count; k++) {
        radius = fmin(radius, species->radii.values[k]);
    }
    return radius;
}

double resolve_radius_mean(const struct species *species)
{
    double sum = 0;
    for (uint32_t k = 0; k < species->radii.count; k++) sum += species->radii.values[k];
    return species->radii.count ? sum / species->radii.count
                                : 0.5 * (species->radius[0] + species->radius[1]);
}

double resolve_area_mean(const struct species *species)
{
    double sum = 0;
    for (uint32_t k = 0; k < species->radii.count; k++) {
        sum += species->radii.values[k] * species->radii.values[k];
    }
    if (species->radii.count) return M_PI * sum / species->radii.count;
    const double a = species->radius[0], b = species->radius[1];
    return M_PI * (a * a + a * b + b * b) / 3;                  /* mean of R^2, R uniform in a..b */
}

/* A species that nothing places or brings does not count. */
static bool species_occurs(const struct scene *scene, uint32_t index)
{
    bool occurs = false;
    for (uint32_t k = 0; k < scene->placement_count; k++) {
        occurs |= resolve_species(scene, scene->placements[k].grains) == index;
    }
    for (uint32_t k = 0; k < scene->source_count; k++) {
        occurs |= resolve_species(scene, scene->sources[k].grains) == index;
    }
    return occurs;
}

void resolve_radii(struct scene *scene)
{
    double low = INFINITY, high = 0, sum = 0;
    uint32_t count = 0;
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const struct species *species = &scene->species[k];
        if (!species_occurs(scene, k)) continue;
        low = fmin(low, resolve_radius_min(species));
        high = fmax(high, resolve_radius_max(species));
        sum += resolve_radius_mean(species);
        count++;
    }
    scene->radius_min = count ? low : 0;
    scene->radius_max = high;
    scene->radius_mean = count ? sum / count : 0;
    const struct placed *placed = &scene->placed;
    if (!placed->count || scene->source_count) return;
    for (sum = 0, count = 0; count < placed->count; count++) sum += placed->radius[count];
    scene->radius_mean = sum / count;           /* the true one, where all grains are known */
}

/* ---- capacity ------------------------------------------------------------------------------ */

static double source_total(const struct scene *scene, const struct source *source)
{
    const double time = fmin(source->to, scene->until) - fmax(source->from, 0);
    double total = source->rate * fmax(time, 0);
    if (source->kind == SOURCE_STREAM) {
        /* Columns of width / gap grains, one each time the last has moved on by a gap. */
        const uint32_t index = resolve_species(scene, source->grains);
        if (index >= scene->species_count) return 0;
        const double gap = 2 * resolve_radius_max(&scene->species[index]) / sqrt(source->density);
        const double speed = hypot(source->velocity[0], source->velocity[1]);
        total = (source->width / gap + 1) * (speed * fmax(time, 0) / gap + 1);
    }
    return source->count ? fmin(total, source->count) : total;
}

uint32_t resolve_count_max(const struct scene *scene, double placed)
{
    if (scene->count_max) return scene->count_max;
    double total = placed;
    for (uint32_t k = 0; k < scene->source_count; k++) {
        total += ceil(source_total(scene, &scene->sources[k]) + 1);
    }
    /* Discs fill at most 0.907 of an area; soft ones a little more.  Grains outside the box are
     * gone where it is open, and cannot be where it is not. */
    const double area = (scene->box[2] - scene->box[0]) * (scene->box[3] - scene->box[1]);
    const double smallest = M_PI * scene->radius_min * scene->radius_min;
    if (scene->source_count && smallest > 0) total = fmin(total, placed + area / smallest + 1000);
    return (uint32_t)fmin(fmax(total, 1), 1073741823.0);
}

/* ---- walls --------------------------------------------------------------------------------- */

struct builder { struct scene *scene; uint32_t count; bool counting; };

static void add(struct builder *builder, struct wall wall)
{
    if (!builder->counting) builder->scene->walls[builder->count] = wall;
    builder->count++;
}

static struct wall blank(enum wall_shape shape)
{
    return (struct wall){.shape = shape, .moves_to = INFINITY, .opens = INFINITY,
                         .closes = INFINITY, .joined0 = WALL_NONE, .joined1 = WALL_NONE,
                         .body = WALL_NONE};
}

static void add_border(struct builder *builder, int kind, double x0, double y0, double x1,
                       double y1)
{
    if (kind != BORDER_WALL) return;
    struct wall wall = blank(WALL_SEGMENT);
    wall.x0 = x0;
    wall.y0 = y0;
    wall.x1 = x1;
    wall.y1 = y1;
    wall.border = true;
    add(builder, wall);
}

static void add_segments(struct builder *builder, struct wall wall, const struct wall_entry *entry)
{
    const double *p = entry->points.values;
    wall.shape = WALL_SEGMENT;
    for (uint32_t k = 0; k + 3 < entry->points.count; k += 2) {
        wall.x0 = p[k];
        wall.y0 = p[k + 1];
        wall.x1 = p[k + 2];
        wall.y1 = p[k + 3];
        if (wall.x0 != wall.x1 || wall.y0 != wall.y1) add(builder, wall);
    }
    if (entry->points.count > 0 || isnan(entry->from[0]) || isnan(entry->to[0])) return;
    wall.x0 = entry->from[0];
    wall.y0 = entry->from[1];
    wall.x1 = entry->to[0];
    wall.y1 = entry->to[1];
    if (wall.x0 != wall.x1 || wall.y0 != wall.y1) add(builder, wall);
}

static void add_arc(struct builder *builder, struct wall wall, const struct wall_entry *entry)
{
    wall.shape = WALL_ARC;
    wall.cx = entry->center[0];
    wall.cy = entry->center[1];
    wall.radius = entry->radius;
    wall.angle0 = entry->angles[0] * M_PI / 180;
    wall.angle1 = entry->angles[1] * M_PI / 180;
    if (!(wall.radius > 0) || !(wall.angle1 > wall.angle0) || isnan(wall.cx + wall.cy)) return;
    wall.angle1 = fmin(wall.angle1, wall.angle0 + 2 * M_PI);
    wall.x0 = wall.cx + wall.radius * cos(wall.angle0);
    wall.y0 = wall.cy + wall.radius * sin(wall.angle0);
    wall.x1 = wall.cx + wall.radius * cos(wall.angle1);
    wall.y1 = wall.cy + wall.radius * sin(wall.angle1);
    add(builder, wall);
}

static void add_row(struct builder *builder, struct wall wall, const struct wall_entry *entry)
{
    wall.shape = WALL_DISC;
    wall.radius = entry->radius;
    if (!(wall.radius > 0)) return;
    const double length = hypot(entry->to[0] - entry->from[0], entry->to[1] - entry->from[1]);
    if (!isfinite(length)) return;
    const uint32_t touching = (uint32_t)fmin(ceil(length / (2 * wall.radius) - 1e-9) + 1, 1e6);
    const uint32_t count = entry->count ? entry->count : touching;
    for (uint32_t k = 0; k < count; k++) {
        const double share = count > 1 ? (double)k / (count - 1) : 0.5;
        wall.cx = entry->from[0] + share * (entry->to[0] - entry->from[0]);
        wall.cy = entry->from[1] + share * (entry->to[1] - entry->from[1]);
        add(builder, wall);
    }
}

static void add_entry(struct builder *builder, const struct wall_entry *entry, uint32_t body)
{
    struct wall wall = blank(WALL_DISC);
    wall.vx = entry->velocity[0];
    wall.vy = entry->velocity[1];
    wall.moves_from = entry->moves[0];
    wall.moves_to = entry->moves[1];
    wall.amplitude_x = entry->amplitude[0];
    wall.amplitude_y = entry->amplitude[1];
    wall.frequency = entry->frequency;
    wall.opens = entry->opens;
    wall.closes = entry->closes;
    wall.surface_speed = entry->surface_speed;
    wall.body = body;
    const uint32_t species = resolve_species(builder->scene, entry->grains);
    wall.species = species < builder->scene->species_count ? species : 0;
    if (strcmp(entry->shape, "arc") == 0) add_arc(builder, wall, entry);
    else if (strcmp(entry->shape, "row") == 0) add_row(builder, wall, entry);
    else if (strcmp(entry->shape, "disc") != 0) add_segments(builder, wall, entry);
    else if (entry->radius > 0 && !isnan(entry->center[0] + entry->center[1])) {
        wall.radius = entry->radius;
        wall.cx = entry->center[0];
        wall.cy = entry->center[1];
        add(builder, wall);
    }
}

static void add_all(struct builder *builder)
{
    const struct scene *scene = builder->scene;
    const double x0 = scene->box[0], y0 = scene->box[1], x1 = scene->box[2], y1 = scene->box[3];
    add_border(builder, scene->left, x0, y1, x0, y0);           /* counter-clockwise: the box */
    add_border(builder, scene->bottom, x0, y0, x1, y0);         /* lies to the left of each   */
    add_border(builder, scene->right, x1, y0, x1, y1);
    add_border(builder, scene->top, x1, y1, x0, y1);
    for (uint32_t k = 0; k < scene->wall_entry_count; k++) {
        add_entry(builder, &scene->wall_entries[k], WALL_NONE);
    }
    for (uint32_t k = 0; k < scene->obstacle_count; k++) add_entry(builder, &scene->obstacles[k],
                                                                   k);
}

/* Ends within a billionth of the box's size are the same point. */
static void join_ends(struct wall *walls, uint32_t count, double reach)
{
    for (uint32_t i = 0; i < count; i++) {
        struct wall *a = &walls[i];
        if (a->shape == WALL_DISC) continue;
        for (uint32_t j = 0; j < count; j++) {
            const struct wall *b = &walls[j];
            if (j == i || b->shape == WALL_DISC) continue;
            const bool a0b0 = hypot(a->x0 - b->x0, a->y0 - b->y0) <= reach;
            const bool a0b1 = hypot(a->x0 - b->x1, a->y0 - b->y1) <= reach;
            const bool a1b0 = hypot(a->x1 - b->x0, a->y1 - b->y0) <= reach;
            const bool a1b1 = hypot(a->x1 - b->x1, a->y1 - b->y1) <= reach;
            if (a->joined0 == WALL_NONE && (a0b0 || a0b1)) a->joined0 = j;
            if (a->joined1 == WALL_NONE && (a1b0 || a1b1)) a->joined1 = j;
        }
    }
}

bool resolve_walls(struct scene *scene)
{
    struct builder builder = {.scene = scene, .counting = true};
    add_all(&builder);
    if (!arena_array(&scene->arena, &scene->walls, builder.count)) return false;
    builder.counting = false;
    builder.count = 0;
    add_all(&builder);
    scene->wall_count = builder.count;
    join_ends(scene->walls, scene->wall_count,
              1e-9 * fmax(scene->box[2] - scene->box[0], scene->box[3] - scene->box[1]));
    return true;
}
