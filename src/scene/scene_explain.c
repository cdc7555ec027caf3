/* scene_explain.c - which effects a scene calls for, and by which key: derived here and nowhere
 * else.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_explain.h"

#include "scene/resolve.h"
#include "scene/tree.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool on(const struct scene *scene, struct scene_reason *reason, const char *key,
               const char *format, ...) __attribute__((format(printf, 4, 5)));

/* "grains.[0].friction = 0.5 (hourglass.cfg:12)" */
static bool on(const struct scene *scene, struct scene_reason *reason, const char *key,
               const char *format, ...)
{
    char what[120], place[80] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    const struct tree *node = scene->places ? tree_nearest(scene->places->root, key) : NULL;
    if (node && node->line > 0) snprintf(place, sizeof place, " (%.60s:%d)", node->file,
                                         node->line);
    else if (node && node->file) snprintf(place, sizeof place, " (%.60s)", node->file);
    snprintf(reason->why, sizeof reason->why, "%s%s", what, place);
    reason->on = true;
    return true;
}

static bool off(struct scene_reason *reason, const char *why)
{
    snprintf(reason->why, sizeof reason->why, "%s", why);
    reason->on = false;
    return false;
}

static const char *path_of(char path[64], const char *list, uint32_t index, const char *key)
{
    snprintf(path, 64, "%s.[%u].%s", list, index, key);
    return path;
}

static bool friction(const struct scene *scene, struct scene_reason *reason)
{
    char path[64];
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const double mu = scene->species[k].friction;
        if (mu > 0) return on(scene, reason, path_of(path, "grains", k, "friction"),
                              "grains.[%u].friction = %g", k, mu);
    }
    return off(reason, "no species has a friction");
}

static bool dissipation(const struct scene *scene, struct scene_reason *reason)
{
    char path[64];
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const struct species *s = &scene->species[k];
        if (s->restitution < 1) return on(scene, reason, path_of(path, "grains", k, "restitution"),
                                          "grains.[%u].restitution = %g", k, s->restitution);
        if (s->damping > 0) return on(scene, reason, path_of(path, "grains", k, "damping"),
                                      "grains.[%u].damping = %g", k, s->damping);
    }
    return friction(scene, reason) || off(reason, "every restitution is 1, nothing is damped");
}

static bool polydisperse(const struct scene *scene, struct scene_reason *reason)
{
    if (scene->radius_max > scene->radius_min) {
        return on(scene, reason, "grains.[0].radius", "radii from %g to %g", scene->radius_min,
                  scene->radius_max);
    }
    return off(reason, "all grains have one radius");
}

static bool same_contact(const struct species *a, const struct species *b)
{
    const double x[] = {a->restitution, a->stiffness, a->damping, a->friction, a->density},
                 y[] = {b->restitution, b->stiffness, b->damping, b->friction, b->density};
    for (size_t k = 0; k < sizeof x / sizeof *x; k++) {
        if (x[k] != y[k] && !(isnan(x[k]) && isnan(y[k]))) return false;
    }
    return a->inertia == b->inertia;
}

static bool mixture(const struct scene *scene, struct scene_reason *reason)
{
    char path[64];
    for (uint32_t k = 1; k < scene->species_count; k++) {
        if (!same_contact(&scene->species[0], &scene->species[k])) {
            return on(scene, reason, path_of(path, "grains", k, "name"),
                      "grains.[%u] differs from grains.[0] in a contact parameter", k);
        }
    }
    return off(reason, "all species have the same contact parameters");
}

static bool periodic(const struct scene *scene, struct scene_reason *reason)
{
    if (scene->left == BORDER_PERIODIC) return on(scene, reason, "left",
                                                  "left and right are periodic");
    if (scene->bottom == BORDER_PERIODIC) {
        return on(scene, reason, "bottom", "bottom and top are periodic");
    }
    return off(reason, "no border is periodic");
}

static bool outflow(const struct scene *scene, struct scene_reason *reason)
{
    const int sides[4] = {scene->left, scene->right, scene->bottom, scene->top};
    const char *const names[4] = {"left", "right", "bottom", "top"};
    for (int k = 0; k < 4; k++) {
        if (sides[k] == BORDER_OPEN) return on(scene, reason, names[k], "the border '%s' is open",
                                               names[k]);
    }
    if (scene->sink_count) return on(scene, reason, "sinks", "there are %u sinks",
                                     scene->sink_count);
    return off(reason, "no border is open and there is no sink");
}

static bool rising(const struct scene *scene, struct scene_reason *reason)
{
    for (uint32_t k = 0; k < scene->source_count; k++) {
        if (scene->sources[k].above > 0) {
            return on(scene, reason, "sources", "source %u stays %g above what is at rest", k,
                      scene->sources[k].above);
        }
    }
    return off(reason, "no source has 'above'");
}

static bool moving(const struct scene *scene, struct scene_reason *reason)
{
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        const struct wall *wall = &scene->walls[k];
        if (wall_moves(wall) || wall->surface_speed != 0) {
            return on(scene, reason, wall->body == WALL_NONE ? "walls" : "obstacles",
                      "wall %u moves, shakes or has a surface speed", k);
        }
    }
    return off(reason, "every wall stands still");
}

static bool gates(const struct scene *scene, struct scene_reason *reason)
{
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        if (wall_is_gate(&scene->walls[k])) {
            return on(scene, reason, "walls", "wall %u opens at %g", k, scene->walls[k].opens);
        }
    }
    return off(reason, "no wall has 'opens'");
}

static bool collision_rate(const struct scene *scene, struct scene_reason *reason)
{
    if (scene->measure.collisions) return on(scene, reason, "measure.collisions",
                                             "measure.collisions is true");
    if (scene->view.color == COLOR_COLLISIONS) {
        return on(scene, reason, "view.color", "view.color = \"collisions\"");
    }
    return off(reason, "neither measure.collisions nor view.color asks for it");
}

static bool measured(const struct scene *scene, struct scene_reason *reason, const char *key,
                     bool asked)
{
    if (asked) return on(scene, reason, key, "%s is true", key);
    char why[80];
    snprintf(why, sizeof why, "%s is false", key);
    return off(reason, why);
}

static bool counted(const struct scene *scene, struct scene_reason *reason, const char *list,
                    uint32_t count)
{
    if (count) return on(scene, reason, list, "'%s' has %u entries", list, count);
    char why[80];
    snprintf(why, sizeof why, "there are no '%s'", list);
    return off(reason, why);
}

/* Whether the scene itself calls for the effect. */
static bool derive(const struct scene *scene, uint32_t bit, struct scene_reason *reason)
{
    const double *g = scene->gravity;
    switch (bit) {
    case EFFECT_BIT_GRAVITY:
        return g[0] != 0 || g[1] != 0 ? on(scene, reason, "gravity", "gravity = (%g, %g)", g[0],
                                           g[1])
                                      : off(reason, "gravity is zero");
    case EFFECT_BIT_DISSIPATION:  return dissipation(scene, reason);
    case EFFECT_BIT_FRICTION:     return friction(scene, reason);
    case EFFECT_BIT_POLYDISPERSE: return polydisperse(scene, reason);
    case EFFECT_BIT_MIXTURE:      return mixture(scene, reason);
    case EFFECT_BIT_PERIODIC:     return periodic(scene, reason);
    case EFFECT_BIT_WALLS:
        return scene->wall_count ? on(scene, reason, "walls", "%u pieces of wall, borders included",
                                      scene->wall_count)
                                 : off(reason, "no border is a wall, and there are no 'walls'");
    case EFFECT_BIT_MOVING_WALLS: return moving(scene, reason);
    case EFFECT_BIT_GATES:        return gates(scene, reason);
    case EFFECT_BIT_OBSTACLE:     return counted(scene, reason, "obstacles", scene->obstacle_count);
    case EFFECT_BIT_INFLOW:       return counted(scene, reason, "sources", scene->source_count);
    case EFFECT_BIT_RISING:       return rising(scene, reason);
    case EFFECT_BIT_OUTFLOW:      return outflow(scene, reason);
    case EFFECT_BIT_SCREEN:       return counted(scene, reason, "screens", scene->screen_count);
    case EFFECT_BIT_COLLISION_RATE: return collision_rate(scene, reason);
    case EFFECT_BIT_COLLISION_COUNT:
        return measured(scene, reason, "measure.collision_counts",
                        scene->measure.collision_counts);
    case EFFECT_BIT_IMPACT:
        return measured(scene, reason, "measure.impact_parameters",
                        scene->measure.impact_parameters);
    case EFFECT_BIT_STRESS:
        return measured(scene, reason, "measure.stress", scene->measure.stress);
    case EFFECT_BIT_SHEAR:
        return scene->shear_rate != 0 ? on(scene, reason, "shear_rate", "shear_rate = %g",
                                           scene->shear_rate)
                                      : off(reason, "shear_rate is zero");
    /* How friction is carried is a model's own: discs spin, springs remember, lattices do
     * neither. */
    case EFFECT_BIT_ROTATION:     return off(reason, "no torque turns a grain");
    default:
        return off(reason, "the model's tangential law does not ask for it");
    }
}

effects_t scene_explain_effects(const struct scene *scene)
{
    effects_t effects = 0;
    struct scene_reason reason;
    for (uint32_t bit = 0; bit < EFFECT_COUNT; bit++) {
        if (derive(scene, bit, &reason)) effects |= (effects_t)1 << bit;
    }
    return effects;
}

bool scene_explain(const struct scene *scene, uint32_t index, struct scene_reason *reason)
{
    *reason = (struct scene_reason){0};
    if (index >= EFFECT_COUNT) return false;
    reason->effect = (effects_t)1 << index;
    const bool derived = derive(scene, index, reason);
    reason->on = (scene->effects & reason->effect) != 0;
    struct scene_reason cause = {0};
    const effects_t carried = EFFECT_ROTATION | EFFECT_STATIC_FRICTION;
    if (reason->on && !derived && reason->effect & carried && friction(scene, &cause)) {
        snprintf(reason->why, sizeof reason->why, "%.150s, as '%.40s' carries it", cause.why,
                 scene->model);
    } else if (reason->on && !derived) {
        snprintf(reason->why, sizeof reason->why, "settings of the model '%.60s' ask for it",
                 scene->model);
    } else if (!reason->on && derived) {
        snprintf(reason->why, sizeof reason->why, "the model '%.60s' leaves it out", scene->model);
    }
    return true;
}
