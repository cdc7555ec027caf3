/* check.c - see check.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/check.h"

#include "scene/place.h"
#include "scene/resolve.h"
#include "scene/tree.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* What is being checked: entry `index` of `list`; no list: the top level. */
struct check {
    const struct scene *scene;
    struct findings    *findings;
    const char *list;
    uint32_t    index;
};

static void tell(const struct check *check, enum finding_kind kind, const char *key,
                 const char *format, ...) __attribute__((format(printf, 4, 5)));

static void tell(const struct check *check, enum finding_kind kind, const char *key,
                 const char *format, ...)
{
    char path[TREE_PATH_MAX], text[480], name[100] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (check->list) {
        snprintf(name, sizeof name, "%s.[%u]", check->list, check->index);
        snprintf(path, sizeof path, "%s%s%s", name, key[0] ? "." : "", key);
    } else {
        snprintf(path, sizeof path, "%s", key);
    }
    findings_tell(check->findings, check->scene, kind, path, "%s%s%s", name, name[0] ? ": " : "",
                  text);
}

#define ERROR(key, ...) tell(&check, FINDING_ERROR, key, __VA_ARGS__)
#define WARNING(key, ...) tell(&check, FINDING_WARNING, key, __VA_ARGS__)

static void check_name(struct check check, const char *name)
{
    if (resolve_species(check.scene, name) < check.scene->species_count) return;
    const char *nearest = NULL;
    uint32_t best = 4;
    for (uint32_t k = 0; k < check.scene->species_count; k++) {
        const uint32_t distance = key_distance(name, check.scene->species[k].name);
        if (distance < best) nearest = check.scene->species[k].name;
        if (distance < best) best = distance;
    }
    ERROR("grains", "no species is called \"%.60s\"%s%.60s%s", name,
          nearest ? "; did you mean \"" : "; 'grains' lists them by 'name'", nearest ? nearest : "",
          nearest ? "\"?" : "");
}

static bool runs_backwards(const double box[4])
{
    return !(box[2] > box[0]) || !(box[3] > box[1]);
}

/* ---- grains -------------------------------------------------------------------------------- */

static void check_species(struct check check, const struct species *species)
{
    const struct scene *scene = check.scene;
    const bool radius = !isnan(species->radius[0]), radii = species->radii.count > 0;
    if (radius && radii) ERROR("radii", "both 'radius' and 'radii' are given; delete one");
    if (!radius && !radii) {
        ERROR("", "'radius' is missing; add radius = r; or radius = (low, high);");
    }
    if (!isnan(species->restitution) && !isnan(species->damping)) {
        ERROR("damping", "'restitution' and 'damping' both say how much energy a collision loses; "
              "delete one");
    }
    if (isnan(species->restitution) && isnan(species->damping)) {
        ERROR("", "it is not said how much energy a collision loses; add restitution = ... "
              "(1: none), or stiffness and damping");
    }
    if (!isnan(species->damping) && isnan(species->stiffness)) {
        ERROR("damping", "'damping' has a meaning only beside a 'stiffness'; add it, or give "
              "'restitution' instead");
    }
    if (scene->species_count > 1 && !species->name[0]) {
        ERROR("", "there are %u species, so each needs a 'name'", scene->species_count);
    }
    for (uint32_t k = 0; k < check.index; k++) {
        if (species->name[0] && strcmp(scene->species[k].name, species->name) == 0) {
            ERROR("name", "grains.[%u] is called \"%.60s\" already; choose another name", k,
                  species->name);
        }
    }
}

static void check_outline(struct check check, const struct placement *placement)
{
    const uint32_t corners = placement->outline.count / 2;
    if (!isnan(placement->region[0])) {
        ERROR("outline", "both 'region' and 'outline' are given; delete one");
    }
    if (corners < 3) ERROR("outline", "a polygon needs 3 corners or more, not %u", corners);
    else if (!(place_area(check.scene, placement) > 0)) {
        ERROR("outline", "this polygon has no area; are its corners on one line?");
    }
}

static void check_random(struct check check, const struct placement *placement)
{
    const bool fraction = !isnan(placement->fraction);
    if (!fraction && !placement->count) {
        ERROR("kind", "a random placement needs 'count' or 'fraction'; add one");
    }
    if (fraction && placement->count) {
        ERROR("fraction", "both 'count' and 'fraction' are given; delete one");
    }
}

static void check_placement(struct check check, const struct placement *placement)
{
    double bounds[4];
    check_name(check, placement->grains);
    const bool region = !isnan(placement->region[0]);
    if (placement->outline.count) check_outline(check, placement);
    else if (region && runs_backwards(placement->region)) {
        ERROR("region",
              "(%g, %g, %g, %g) is empty or runs backwards; write left, bottom, right, top",
              placement->region[0], placement->region[1], placement->region[2],
              placement->region[3]);
        return;
    }
    place_bounds(check.scene, placement, bounds);
    const double *box = check.scene->box;
    const double slack = 1e-9 * (box[2] - box[0] + box[3] - box[1]);
    if (bounds[0] < box[0] - slack || bounds[1] < box[1] - slack || bounds[2] > box[2] + slack
        || bounds[3] > box[3] + slack) {
        ERROR(placement->outline.count ? "outline" : "region",
              "reaches out of the box (%g, %g, %g, %g); make it smaller or the box larger", box[0],
              box[1], box[2], box[3]);
    }
    if (placement->kind == PLACEMENT_FILE && !placement->file[0]) {
        ERROR("kind", "a placement from a file needs 'file'; add file = \"grains.csv\";");
    }
    if (placement->kind != PLACEMENT_FILE && placement->file[0]) {
        ERROR("file", "is read only with kind = \"file\"; add that, or delete it");
    }
    if (placement->kind == PLACEMENT_RANDOM) check_random(check, placement);
    else if (!isnan(placement->fraction)) {
        WARNING("fraction", "is for random placements; a lattice's density follows from 'spacing'");
    }
}

/* What begins behind a screen is gone at once, and the stream is thinner than it says. */
static void check_source_screens(struct check check, const struct source *source)
{
    const double *v = source->velocity, speed = hypot(v[0], v[1]), half = source->width / 2;
    const bool stream = source->kind == SOURCE_STREAM && speed > 0;
    const double ex = stream ? -v[1] / speed : 1, ey = stream ? v[0] / speed : 0;
    for (uint32_t k = 0; k < 2 * check.scene->screen_count; k++) {
        const struct screen *screen = &check.scene->screens[k / 2];
        const double side = k % 2 ? half : -half;
        const double x = source->position[0] + side * ex, y = source->position[1] + side * ey;
        const bool behind = screen->kind == SCREEN_LINE ? x > screen->x
            : hypot(x - screen->center[0], y - screen->center[1]) > screen->radius;
        if (!behind) continue;
        ERROR("position", "grains that enter at (%g, %g) are behind screens.[%u] and vanish at "
              "once; enlarge the screen, or move the source", x, y, k / 2);
        return;
    }
}

static void check_source(struct check check, const struct source *source)
{
    const double *box = check.scene->box, *p = source->position;
    check_name(check, source->grains);
    if (source->to <= source->from) {
        ERROR("to", "the source ends (%g) before it begins (%g)", source->to, source->from);
    }
    if (p[0] < box[0] || p[0] > box[2] || p[1] < box[1] || p[1] > box[3]) {
        ERROR("position", "(%g, %g) lies outside of the box", p[0], p[1]);
    }
    const struct scene *scene = check.scene;
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        const struct wall wall = wall_at(&scene->walls[k], fmax(source->from, 0));
        if (wall.shape == WALL_DISC && wall_nearest(&wall, p[0], p[1]).distance < 0) {
            ERROR("position", "(%g, %g) lies inside a solid disc", p[0], p[1]);
            break;
        }
    }
    const double speed = hypot(source->velocity[0], source->velocity[1]);
    if (source->kind == SOURCE_POINT && !(source->rate > 0)) {
        ERROR("rate", "a point source needs a 'rate' greater than 0 (grains per time)");
    }
    if (source->kind == SOURCE_STREAM && !(source->width > 0)) {
        ERROR("width", "a stream needs a 'width' greater than 0: the height of its columns");
    }
    if (source->kind == SOURCE_STREAM && !(speed > 0)) {
        ERROR("velocity", "a stream needs a 'velocity', or its first column never makes room");
    }
    if (source->above > 0 && source->kind != SOURCE_POINT) {
        ERROR("above", "a stream cannot rise with a heap; use kind = \"point\"");
    }
    if (source->above > 0 && !(scene->gravity[1] < 0)) {
        ERROR("above", "a source rises against gravity along -y; set 'gravity', or delete 'above'");
    }
    check_source_screens(check, source);
}

/* ---- walls --------------------------------------------------------------------------------- */

static void check_shape(struct check check, const struct wall_entry *entry)
{
    const bool row = strcmp(entry->shape, "row") == 0, arc = strcmp(entry->shape, "arc") == 0,
               disc = strcmp(entry->shape, "disc") == 0;
    const bool ends = !isnan(entry->from[0]) && !isnan(entry->to[0]);
    if ((row || arc || disc) && isnan(entry->radius)) ERROR("", "a %s needs a 'radius'",
                                                            entry->shape);
    if ((arc || disc) && isnan(entry->center[0])) ERROR("", "a %s needs a 'center'", entry->shape);
    if (row && !ends) {
        ERROR("", "a row needs 'from' and 'to', the centres of its first and last disc");
    }
    if (arc && !(entry->angles[1] > entry->angles[0])) {
        ERROR("angles",
              "(%g, %g): an arc runs counter-clockwise, so the second angle must be larger",
              entry->angles[0], entry->angles[1]);
    }
    if (arc && entry->angles[1] - entry->angles[0] > 360) {
        ERROR("angles", "(%g, %g) is more than a full turn", entry->angles[0], entry->angles[1]);
    }
    if (row || arc || disc) return;
    const uint32_t points = entry->points.count / 2;
    const bool segment = strcmp(entry->shape, "segment") == 0;
    if (points == 0 && !(segment && ends)) ERROR("", "a %s needs 'points'", entry->shape);
    else if (points == 1 || (segment && points > 2)) {
        ERROR("points", "a %s needs %s, not %u", entry->shape,
              segment ? "2 points" : "2 points or more", points);
    }
    const double *p = entry->points.values;
    for (uint32_t k = 1; k < points; k++) {
        if (p[2 * k] == p[2 * k - 2] && p[2 * k + 1] == p[2 * k - 1]) {
            ERROR("points", "points %u and %u are the same, (%g, %g); delete one", k, k + 1,
                  p[2 * k], p[2 * k + 1]);
        }
    }
    if (!points && ends && entry->from[0] == entry->to[0] && entry->from[1] == entry->to[1]) {
        ERROR("to", "the segment has no length: 'from' and 'to' are the same");
    }
}

static void check_wall(struct check check, const struct wall_entry *entry)
{
    if (entry->shape[0]) check_shape(check, entry);
    check_name(check, entry->grains);
    if (entry->closes < entry->opens) {
        if (isinf(entry->opens)) ERROR("closes", "the gate closes but never opens; add 'opens'");
        else ERROR("closes", "the gate closes (%g) before it opens (%g)", entry->closes,
                   entry->opens);
    }
    if (entry->moves[1] < entry->moves[0]) {
        ERROR("moves", "(%g, %g) runs backwards", entry->moves[0], entry->moves[1]);
    }
    const bool shakes = entry->amplitude[0] != 0 || entry->amplitude[1] != 0;
    if (shakes && entry->frequency == 0) {
        WARNING("amplitude", "the wall does not shake without a 'frequency'");
    }
    if (!shakes && entry->frequency > 0) {
        WARNING("frequency", "the wall does not shake without an 'amplitude'");
    }
}

static void check_walls_reachable(struct check check)
{
    const struct scene *scene = check.scene;
    const double *box = scene->box;
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        double x0, y0, x1, y1;
        wall_bounds(&scene->walls[k], &x0, &y0, &x1, &y1);
        if (x1 < box[0] || x0 > box[2] || y1 < box[1] || y0 > box[3]) {
            WARNING("walls", "a piece of wall lies outside of the box, near (%g, %g); no grain can "
                    "meet it", x0, y0);
            return;
        }
    }
}

static void check_screen(struct check check, const struct screen *screen)
{
    if (screen->kind == SCREEN_CIRCLE && isnan(screen->radius)) {
        ERROR("", "a circle needs a 'radius'");
    }
    if (screen->kind == SCREEN_LINE && isnan(screen->x)) ERROR("", "a line needs 'x'");
    if (screen->bins == 0) ERROR("bins", "there must be one bin or more");
}

static void check_sink(struct check check, const struct sink *sink)
{
    if (!isnan(sink->region[0]) && runs_backwards(sink->region)) {
        ERROR("region",
              "(%g, %g, %g, %g) is empty or runs backwards; write left, bottom, right, top",
              sink->region[0], sink->region[1], sink->region[2], sink->region[3]);
    }
}

/* ---- the whole ----------------------------------------------------------------------------- */

static void check_borders(struct check check)
{
    const struct scene *scene = check.scene;
    const bool x_left = scene->left == BORDER_PERIODIC, x_right = scene->right == BORDER_PERIODIC;
    const bool y_low = scene->bottom == BORDER_PERIODIC, y_high = scene->top == BORDER_PERIODIC;
    if (x_left != x_right) ERROR(x_left ? "left" : "right", "'left' and 'right' must both be "
                                 "periodic, or neither");
    if (y_low != y_high) ERROR(y_low ? "bottom" : "top",
                               "'bottom' and 'top' must both be periodic, "
                               "or neither");
    /* With less, a grain could touch another one from both sides. */
    const double least = 6 * scene->radius_max;
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    if (x_left && x_right && width < least) {
        ERROR("box", "a periodic box must be at least 3 diameters (%g) wide, not %g", least, width);
    }
    if (y_low && y_high && height < least) {
        ERROR("box", "a periodic box must be at least 3 diameters (%g) high, not %g", least,
              height);
    }
    if (scene->shear_rate != 0 && !(x_left && x_right && y_low && y_high)) {
        ERROR("shear_rate", "'shear_rate' = %g moves the images of the box above and below along "
              "it, so left, right, bottom and top must all be \"periodic\"; or delete it and shear "
              "by walls with a 'velocity' or a 'surface_speed'", scene->shear_rate);
    }
}

static void check_view(struct check check)
{
    const struct view *view = &check.scene->view;
    for (int k = 0; k < 2; k++) {
        if (!isnan(view->size[k]) && view->size[k] != floor(view->size[k])) {
            ERROR("view.size", "'view.size' must be whole pixels, not %g", view->size[k]);
        }
    }
    if (!isnan(view->window[0]) && runs_backwards(view->window)) {
        ERROR("view.window",
              "'view.window' is empty or runs backwards; write left, bottom, right, top");
    }
    if (view->range[1] <= view->range[0]) {
        ERROR("view.range", "'view.range' = (%g, %g) is empty or runs backwards", view->range[0],
              view->range[1]);
    }
    if (view->scale == SCALE_LOG && view->range[0] <= 0) {
        ERROR("view.range", "a logarithmic scale cannot begin at %g; begin above 0",
              view->range[0]);
    }
    const double *average = check.scene->measure.average;
    if (average[1] <= average[0]) {
        ERROR("measure.average", "'measure.average' = (%g, %g) is empty or runs backwards",
              average[0],
              average[1]);
    }
}

double check_placed_estimate(const struct scene *scene)
{
    double total = 0;
    for (uint32_t k = 0; k < scene->placement_count; k++) {
        const struct placement *placement = &scene->placements[k];
        const uint32_t index = resolve_species(scene, placement->grains);
        if (index >= scene->species_count) continue;
        const struct species *species = &scene->species[index];
        const double area = place_area(scene, placement);
        const double d = 2 * resolve_radius_max(species) * placement->spacing;
        double most = area / (d * d * (placement->kind == PLACEMENT_SQUARE ? 1 : 0.8660254));
        if (placement->kind >= PLACEMENT_RANDOM) {      /* unknown until a file is read */
            most = 0.91 * area / resolve_area_mean(species);
            if (!isnan(placement->fraction)) most *= placement->fraction / 0.91;
        }
        total += placement->count ? fmin(placement->count, most + 1) : most;
    }
    return total;
}

/* Positions, velocities, lists of contacts, the picture: about this many bytes for each grain in
 * the leanest model. */
enum { BYTES_PER_GRAIN = 400 };

static void check_memory(struct check check)
{
    const struct scene *scene = check.scene;
    const double count = resolve_count_max(scene, check_placed_estimate(scene));
    const double need = count * BYTES_PER_GRAIN;
    const double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (have <= 0 || need < have) return;
    const char *key = scene->count_max ? "count_max" : "placements";
    ERROR(key, "%.3g grains need about %.1f GB, and this machine has %.1f GB; use fewer or larger "
          "grains", count, need * 1e-9, have * 1e-9);
}

static void check_counts(struct check check)
{
    const struct scene *scene = check.scene;
    if (scene->species_count == 0) {
        ERROR("", "there are no 'grains'; add grains = ( { radius = ...; restitution = ...; } );");
    }
    if (scene->placement_count == 0 && scene->source_count == 0) {
        ERROR("", "no grain is ever there; add 'placements' or 'sources'");
    }
    for (uint32_t k = 0; k < scene->placement_count; k++) {
        const struct placement *placement = &scene->placements[k];
        if (scene->count_max && placement->count > scene->count_max) {
            ERROR("count_max", "'count_max' = %u is less than the %u grains of placements.[%u]",
                  scene->count_max, placement->count, k);
        }
    }
}

#define EACH(array, counter, word, function)                                    \
    for (uint32_t k = 0; k < scene->counter; k++) {                             \
        function((struct check){scene, findings, word, k}, &scene->array[k]);   \
    }

void check_scene(const struct scene *scene, struct findings *findings)
{
    const struct check check = {scene, findings, NULL, 0};
    const uint32_t before = findings->errors;
    check_counts(check);
    EACH(species, species_count, "grains", check_species)
    const bool box = !isnan(scene->box[0] + scene->box[1] + scene->box[2] + scene->box[3]);
    if (box && runs_backwards(scene->box)) {
        ERROR("box", "'box' = (%g, %g, %g, %g) is empty or runs backwards; write left, bottom, "
              "right, top", scene->box[0], scene->box[1], scene->box[2], scene->box[3]);
    }
    if (!box || runs_backwards(scene->box)) return;     /* nothing can be compared with it */
    EACH(placements, placement_count, "placements", check_placement)
    EACH(sources, source_count, "sources", check_source)
    EACH(wall_entries, wall_entry_count, "walls", check_wall)
    EACH(obstacles, obstacle_count, "obstacles", check_wall)
    EACH(screens, screen_count, "screens", check_screen)
    EACH(sinks, sink_count, "sinks", check_sink)
    check_borders(check);
    check_walls_reachable(check);
    check_view(check);
    if (findings->errors == before) check_memory(check);
}

/* ---- phases -------------------------------------------------------------------------------- */

/* What a phase cannot change, because the grains are there already. */
static const char *const fixed_keys[] = {"placements", "box", "seed", "phases", "quick",
                                         "quick_set", "units", "until", "model", "title"};

static void check_phase(struct check check, const struct phase_entry *entry)
{
    const struct scene *scene = check.scene;
    const struct phase_entry *last = check.index ? entry - 1 : NULL;
    if (last && entry->time <= last->time) {
        ERROR("time", "phases must be in the order of time, but %g does not come after %g",
              entry->time,
              last->time);
    }
    if (entry->time >= scene->until) {
        WARNING("time", "the phase begins at %g, but the run ends at %g", entry->time,
                scene->until);
    }
    if (entry->push.count % PHASE_PUSH != 0) {
        ERROR("push", "a push is five numbers (x, y, radius, vx, vy), or five for each of several; "
              "these are %u", entry->push.count);
    }
    for (uint32_t k = 2; k < entry->push.count; k += PHASE_PUSH) {
        if (entry->push.values[k] > 0) continue;
        ERROR("push", "the radius of a push is its third number and must be greater than 0, not %g",
              entry->push.values[k]);
    }
    for (uint32_t k = 0; k < entry->set.count; k++) {
        const char *text = entry->set.texts[k];
        const size_t length = strcspn(text, ".=[ ");
        for (size_t f = 0; f < sizeof fixed_keys / sizeof *fixed_keys; f++) {
            if (strlen(fixed_keys[f]) == length && strncmp(text, fixed_keys[f], length) == 0) {
                ERROR("set", "'%.80s': a phase cannot change '%s'", text, fixed_keys[f]);
            }
        }
        if (strncmp(text, "grains.", 7) == 0 && strstr(text, ".radi")) {
            ERROR("set", "'%.80s': a phase cannot change radii", text);
        }
    }
}

void check_phases(const struct scene *scene, struct findings *findings)
{
    EACH(phase_entries, phase_entry_count, "phases", check_phase)
}

static bool was_told(const struct findings *findings, const struct finding *finding)
{
    const uint32_t kept = findings->count < FINDINGS_MAX ? findings->count : FINDINGS_MAX;
    for (uint32_t k = 0; k < kept; k++) {
        const struct finding *old = &findings->list[k];
        if (old->line == finding->line && strcmp(old->file, finding->file) == 0
            && strstr(old->text, finding->text)) return true;
    }
    return false;
}

void check_phase_findings(const struct scene *scene, uint32_t phase, const struct findings *own,
                          struct findings *findings)
{
    const uint32_t kept = own->count < FINDINGS_MAX ? own->count : FINDINGS_MAX;
    char key[64];
    snprintf(key, sizeof key, "phases.[%u].set", phase - 1);
    for (uint32_t k = 0; k < kept; k++) {
        const struct finding *finding = &own->list[k];
        if (was_told(findings, finding)) continue;
        findings_tell(findings, scene, finding->kind, key, "phases.[%u]: %s", phase - 1,
                      finding->text);
    }
}
