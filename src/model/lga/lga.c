/* lga.c - the lattice gas as a model: what a scene asks for, turned into nodes, and back.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Seven grains fill a node: one in its centre and six around it, at spacing / sqrt(7), turned by
 * 19.1 degrees against the links.  Those places of all nodes together form a perfect triangular
 * lattice, so a heap at rest looks like densely packed discs of diameter spacing / sqrt(7), and
 * the default spacing is sqrt(7) mean diameters.
 */
#include "model/lga/lga_bits.h"

#include "model/model.h"
#include "model/speed.h"
#include "model/stepping.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SQRT7 2.6457513110645905905

/* Nodes are numbered in 32 bits. */
static const double sites_max = 0xf0000000u;

#define ROW(member) offsetof(struct lga_settings, member)
static const struct key keys[] = {
    {"method", KEY_CHOICE, ROW(method), "gmlg", NAN, NAN, NULL, "gmlg|fhp2|sandpile",
     "rules: gmlg, sand with up to seven rest grains a node; fhp2, a gas with one; sandpile, the "
     "same with collisions that end at rest"},
    {"spacing", KEY_REAL, ROW(spacing), "nan", KEY_POSITIVE, NAN, "length", NULL,
     "distance of nodes; when absent one mean diameter, with gmlg sqrt(7) of them, so that seven "
     "grains fill a node"},
    {"tick", KEY_REAL, ROW(tick), "nan", KEY_POSITIVE, NAN, "time", NULL,
     "duration of a tick, in which a mover goes one spacing; "
     "when absent a fall through the box takes "
     "as long as free fall, and without gravity movers are as fast as the grains at the start"},
    {"k", KEY_REAL, ROW(k), "nan", 0, 1, "1", NULL,
     "share of collisions that lose energy; when absent 1 - restitution^2"},
    {"g", KEY_REAL, ROW(g), "0.5", 0, 1, "1", NULL,
     "chance that gravity acts on a node in a tick"},
    {"s", KEY_REAL, ROW(s), "0", 0, 1, "1", NULL,
     "static friction: chance that a grain supported on one side stays"},
    {"frozen_friction", KEY_BOOL, ROW(frozen_friction), "false", NAN, NAN, NULL, NULL,
     "gmlg: that chance is drawn once for each node and side, not anew in every tick; slopes "
     "between those of the lattice and the upright then last"},
    {"pw", KEY_REAL, ROW(pw), "nan", 0, 1, "1", NULL,
     "chance that a grain stops at a wall or a full node instead of bouncing back; when absent k"},
    {"gain", KEY_REAL, ROW(gain), "1", 0, 1, "1", NULL,
     "chance that an elastic collision with a rest grain sets it in motion"},
    {"orientation", KEY_CHOICE, ROW(orientation), "V", NAN, NAN, NULL, "V|H",
     "gmlg: V, a link points down (heaps of 30 degrees); H, links lie level (60 degrees); the "
     "other methods are always H"},
    {"p", KEY_REAL, ROW(p), "nan", 0, 1, "1", NULL,
     "fhp2, sandpile: share of collisions that lose energy; when absent 1 - restitution^2"},
    {"b", KEY_REAL, ROW(b), "1", 0, 1, "1", NULL,
     "fhp2, sandpile: roughness of walls, the chance that they send a grain straight back instead "
     "of reflecting it like a mirror"},
    {"fill", KEY_REAL, ROW(fill), "0", 0, 1, "1", NULL,
     "share of the directions of all nodes that is filled with movers at the start, at random"},
    {"fly", KEY_BOOL, ROW(fly), "true", NAN, NAN, NULL, NULL,
     "sandpile: gravity bends the way of moving grains, not only of those at rest"},
    {"strict", KEY_BOOL, ROW(strict), "false", NAN, NAN, NULL, NULL,
     "sandpile: a grain at rest does not start towards a node with movers"},
    {"heap", KEY_BOOL, ROW(heap), "false", NAN, NAN, NULL, NULL,
     "sandpile: grains that stop where they hit a floor belong to a heap, which stops others"},
};

static const struct key_group group = {
    "lga", "the lattice gas", keys, sizeof keys / sizeof *keys, sizeof(struct lga_settings)
};

/* --- what the scene leaves open --- */

static double diameters_a_node(const struct lga_settings *s)
{
    return s->method == LGA_GMLG ? SQRT7 : 1;
}

/* A collision with restitution e keeps e^2 of the energy of the relative motion; here a share k
 * of the collisions loses all of it. */
static double inelastic_share(const struct scene *scene)
{
    double sum = 0;
    if (!(scene->effects & EFFECT_DISSIPATION)) return 0;
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const double e = scene->species[k].restitution;
        sum += isfinite(e) ? 1 - fmin(1, e * e) : 0.5;
    }
    return scene->species_count ? sum / scene->species_count : 0.5;
}

static struct lga_settings completed(const struct scene *scene)
{
    struct lga_settings s = {.spacing = NAN, .tick = NAN, .k = NAN, .g = 0.5, .pw = NAN, .gain = 1,
                             .p = NAN, .b = 1, .fly = true};
    const struct lga_settings *given = scene_settings(scene, "lga");
    if (given) s = *given;
    if (!isfinite(s.spacing)) s.spacing = diameters_a_node(&s) * 2 * scene->radius_mean;
    if (!isfinite(s.tick)) {
        double gravity = 0;             /* the strongest of all phases, so that they tick alike */
        for (uint32_t p = 0; p < scene->phase_count; p++) {
            const double *g = scene->phases[p]->gravity;
            gravity = fmax(gravity, hypot(g[0], g[1]));
        }
        const double height = scene->box[3] - scene->box[1];
        const double fall = sqrt(0.5 * gravity * height);       /* mean speed from top to bottom */
        const double start = speed_at_start(scene, 1);
        s.tick = s.spacing / (gravity > 0 ? fall : start > 0 ? start : 1);
    }
    if (!isfinite(s.k)) s.k = inelastic_share(scene);
    if (!isfinite(s.pw)) s.pw = s.k;
    if (!isfinite(s.p)) s.p = inelastic_share(scene);
    return s;
}

/* How many nodes, as a real number: too many must not overflow. */
static double sites_about(const struct scene *scene, double spacing)
{
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    return (width / spacing + 5) * (height / spacing + 5) * 2 / sqrt(3);
}

/* Fills in spacing and tick, the same ones for all phases.  k and pw stay open: they follow from
 * each phase's own restitution. */
static void fill_settings(const struct scene *scene, const struct lga_settings *s)
{
    for (uint32_t p = 0; p < scene->phase_count; p++) {
        struct lga_settings *given = scene_settings(scene->phases[p], "lga");
        if (given && isnan(given->spacing)) given->spacing = s->spacing;
        if (given && isnan(given->tick)) given->tick = s->tick;
    }
}

static void lga_resolve(struct scene *scene, struct findings *findings)
{
    const struct lga_settings s = completed(scene);
    fill_settings(scene, &s);
    if (!(sites_about(scene, s.spacing) <= sites_max)) {
        findings_tell(findings, scene, FINDING_ERROR, "lga.spacing", "lga.spacing = %g gives about "
            "%.3g nodes, more than %.3g; use a larger spacing or a smaller box", s.spacing,
            sites_about(scene, s.spacing), sites_max);
    }
    const double gx = scene->gravity[0], gy = scene->gravity[1];
    if (gx != 0 || gy > 0) {
        const bool down = fabs(gx) <= -gy * tan(M_PI / 6);
        findings_tell(findings, scene, down ? FINDING_WARNING : FINDING_ERROR, "gravity",
            "gravity = (%g, %g): the lattice gas knows gravity along -y only%s", gx, gy,
            down ? "; its tilt is passed over" : "; turn the scene");
    }
    for (uint32_t k = 0; k < scene->source_count; k++) {
        if (scene->sources[k].kind == SOURCE_POINT) continue;
        findings_tell(findings, scene, FINDING_ERROR, "sources", "source %u is a stream of columns;"
            " the lattice gas pours from points only: give it kind = \"point\" and a rate", k);
    }
    if (scene->effects & EFFECT_POLYDISPERSE) {
        findings_tell(findings, scene, FINDING_WARNING, "grains", "the grains of a lattice gas are "
            "all alike; the mean radius %g stands for all", scene->radius_mean);
    }
}

static uint64_t lga_memory(const struct scene *scene)
{
    const struct lga_settings s = completed(scene);
    const int planes = s.method == LGA_GMLG ? LGA_GMLG_PLANES : LGA_PLANES;
    /* Walls, sinks, a bit for each node in a search for room, and the surplus. */
    const int counted = scene->effects & EFFECT_COLLISION_RATE ? 2 * LGA_RATE_DIGITS : 0;
    const double bytes = (planes + 4 + (s.heap ? 2 : 0) + counted) / 8.0;
    return (uint64_t)(fmin(sites_about(scene, s.spacing), 1e15) * bytes);
}

/* --- life --- */

/* Gravity lets seven grains into a node, but a phase without it may have left more there. */
static bool is_crowded(const struct lga *lga)
{
    if (lga->rule.method != LGA_GMLG || !lga->rule.gravity) return false;
    for (uint32_t n = 0; n < lga->sites; n++) if (lga_node_load(lga, n) > LGA_ROOM) return true;
    return false;
}

/* The walls may have changed: by a gate, or because a saved state was loaded. */
static void update_walls(struct lga *lga)
{
    const double t = lga_step_time(lga);
    uint64_t present = ARCHIVE_HASH_START;
    for (uint32_t w = 0; w < lga->scene->wall_count; w++) {
        const bool there = wall_present(&lga->scene->walls[w], t);
        present = archive_hash(present, &there, sizeof there);
    }
    if (lga->walls_stale || present != lga->gates_present) {
        lga_node_set_kinds(lga, t);
        lga->gates_present = present;
        lga->walls_stale = false;
        lga->trapped = true;
    }
    if (lga->trapped) lga_fill_release_trapped(lga);
}

static void mean_grain(struct lga *lga)
{
    const struct scene *scene = lga->scene;
    double density = 0;
    for (uint32_t k = 0; k < scene->species_count; k++) density += scene->species[k].density;
    density = scene->species_count ? density / scene->species_count : 1;
    /* Seven to a node do not overlap at this size; at rest in a heap there is one. */
    lga->radius = lga->lattice.spacing / (lga->rule.heap ? 2 : 2 * SQRT7);
    lga->mass = density * M_PI * scene->radius_mean * scene->radius_mean;
}

static void lga_destroy(void *state)
{
    struct lga *lga = state;
    arena_free(&lga->arena);
    free(lga);
}

static bool set_up(struct lga *lga, struct error *error)
{
    const struct scene *scene = lga->scene;
    const struct lga_settings s = completed(scene);
    if (!(s.spacing > 0) || !(sites_about(scene, s.spacing) <= sites_max)) {
        return error_set_code(error, EXIT_SCENE, "%s: lga.spacing = %g does not give a lattice of "
            "1 to %.3g nodes; delete the line and sandreel chooses", scene->path, s.spacing,
            sites_max);
    }
    lga->rule = (struct lga_rule){
        .method = (enum lga_method)s.method, .gravity = scene->effects & EFFECT_GRAVITY,
        .vertical = s.method == LGA_GMLG && s.orientation == LGA_VERTICAL,
        .inelastic = s.k, .fall = s.g, .friction = s.s, .frozen = s.frozen_friction,
        .wall_stop = s.pw, .gain = s.gain,
        .loss = s.p, .smooth = 1 - s.b, .fly = s.fly, .strict = s.strict,
        .heap = s.heap && s.method == LGA_SANDPILE
    };
    lga->fill = s.fill;
    lga->sinks = scene->effects & EFFECT_OUTFLOW;
    lga->lattice = lga_lattice_of(scene, s.spacing, lga->rule.vertical);
    lga->sites = lga->lattice.rows * lga->lattice.columns;
    lga->tick = s.tick;
    lga->seed = scene->seed;
    if (scene->effects & EFFECT_COLLISION_RATE) {
        lga->rate.window = (uint64_t)fmin(fmax(rint(stepping_window(scene, s.tick) / s.tick), 1),
                                          0x1p53);
    }
    if (!lga_step_allocate(lga) || !arena_array(&lga->arena, &lga->entered, scene->source_count)) {
        return error_set(error, "%s: not enough memory for a lattice of %u nodes; give "
            "lga.spacing a larger value than %g", scene->path, lga->sites, s.spacing);
    }
    mean_grain(lga);
    lga_node_set_kinds(lga, 0);
    lga->walls_stale = true;            /* the next tick may begin at another time */
    return lga_fill_placed(lga, error);
}

static void *lga_create(const struct scene *scene, struct error *error)
{
    struct lga *lga = calloc(1, sizeof *lga);
    if (!lga) {
        error_set(error, "not enough memory for the lattice gas");
        return NULL;
    }
    lga->scene = scene;
    if (set_up(lga, error)) return lga;
    lga_destroy(lga);
    return NULL;
}

static enum advance lga_advance(void *state, double t_end, uint64_t budget)
{
    struct lga *lga = state;
    for (; lga_step_time(lga) + 0.5 * lga->tick <= t_end; budget--) {
        if (budget == 0) return ADVANCE_BUDGET;
        update_walls(lga);
        lga_fill_sources(lga);
        lga_step(lga);
    }
    return ADVANCE_REACHED;
}

/* --- counting --- */

/* All grains of a row of nodes are alike high, or (turned) they are asked one by one. */
static void count_row(const struct lga *lga, uint32_t row, uint64_t sum[LGA_PLANES],
                      double *potential)
{
    const struct lga_lattice *lattice = &lga->lattice;
    const double *gravity = lga->scene->gravity;
    const uint32_t first = row * lattice->columns;
    double x, y;
    if (lga->bits && gravity[0] == 0) {
        uint64_t grains = 0;
        lga_bits_sum(lga, row, sum);
        for (int p = 0; p < LGA_PLANES; p++) grains += sum[p];
        lga_lattice_position(lattice, first, &x, &y);
        *potential -= lga->mass * (double)grains * gravity[1] * y;
        return;
    }
    for (uint32_t n = first; n < first + lattice->columns; n++) {
        const struct lga_node node = lga_node_get(lga, n);
        const int load = node.rest + __builtin_popcount(node.moving);
        if (load == 0) continue;
        lga_lattice_position(lattice, n, &x, &y);
        *potential -= lga->mass * load * (gravity[0] * x + gravity[1] * y);
        for (int d = 0; d < LGA_DIRECTIONS; d++) sum[d] += node.moving >> d & 1;
        sum[LGA_DIRECTIONS] += node.rest;
    }
}

static void lga_count(const void *state, struct counters *out)
{
    const struct lga *lga = state;
    uint64_t grains[LGA_PLANES] = {0};
    *out = (struct counters){.time = lga_step_time(lga), .steps = lga->ticks,
        .grains_in = lga->grains_in, .grains_out = lga->grains_out,
        .collisions = lga->collisions, .rejected = lga->refused, .overlap_max = NAN};
    for (uint32_t row = 0; row < lga->lattice.rows; row++) {
        uint64_t sum[LGA_PLANES] = {0};
        count_row(lga, row, sum, &out->potential_energy);
        for (int p = 0; p < LGA_PLANES; p++) grains[p] += sum[p];
    }
    for (int p = 0; p < LGA_PLANES; p++) out->grains += grains[p];
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        double vx, vy;
        lga_lattice_vector(&lga->lattice, d * M_PI / 3, &vx, &vy);
        vx /= lga->tick;
        vy /= lga->tick;
        const double flying = lga->mass * (double)grains[d];
        out->kinetic_energy += 0.5 * flying * (vx * vx + vy * vy);
        out->momentum_x += flying * vx;
        out->momentum_y += flying * vy;
    }
}

/* The hashes of a checkpoint tell damage, not intent: what was written on purpose must not lead
 * out of a table.  Bits behind the columns of a row belong to nobody and are cleared. */
static const char *check_loaded(struct lga *lga, double tick)
{
    if (!(tick > 0) || !isfinite(tick) || lga->base_ticks > lga->ticks || !(lga->base_time >= 0)
        || !isfinite(lga->base_time)) return "the saved clock does not show a time";
    const uint8_t rest_max = lga->rule.method == LGA_GMLG ? LGA_ROOM : 1;
    for (uint32_t n = 0; n < lga->sites && !lga->bits; n++) {
        if (lga->rest[n] > rest_max || lga->moving[n] >= LGA_STATES) {
            return "the saved lattice holds a node in an impossible state";
        }
    }
    for (uint32_t n = 0; n < lga->sites && lga->heap; n++) {
        if (lga->heap[n] > 1) return "the saved lattice holds a node in an impossible state";
    }
    for (uint32_t row = 0; row < lga->lattice.rows && lga->bits; row++) lga_bits_clean(lga, row);
    return NULL;
}

static void lga_archive(void *state, struct archive *archive)
{
    struct lga *lga = state;
    double tick = lga->tick;
    if (lga->bits) {
        archive_array(archive, "lga.planes", lga->bits->planes,
                      (size_t)lga->lattice.rows * lga->bits->depth * lga->bits->words);
    } else {
        archive_array(archive, "lga.moving", lga->moving, lga->sites);
        archive_array(archive, "lga.rest", lga->rest, lga->sites);
    }
    if (lga->heap) archive_array(archive, "lga.heap", lga->heap, lga->sites);
    if (lga->bits && lga->bits->heap) {
        archive_array(archive, "lga.heap", lga->bits->heap,
                      (size_t)lga->lattice.rows * lga->bits->stride);
    }
    archive_value(archive, "lga.ticks", &lga->ticks);
    archive_value(archive, "lga.tick", &tick);
    archive_value(archive, "lga.base_ticks", &lga->base_ticks);
    archive_value(archive, "lga.base_time", &lga->base_time);
    archive_value(archive, "lga.grains_in", &lga->grains_in);
    archive_value(archive, "lga.grains_out", &lga->grains_out);
    archive_value(archive, "lga.collisions", &lga->collisions);
    archive_value(archive, "lga.refused", &lga->refused);
    for (uint32_t k = 0; k < lga->scene->source_count; k++) {
        char name[40];
        snprintf(name, sizeof name, "lga.source.%u", k);
        archive_value(archive, name, &lga->entered[k]);
    }
    lga_rate_archive(lga, archive);
    if (archive->mode != ARCHIVE_LOAD || archive->failed) return;
    const char *wrong = check_loaded(lga, tick);
    if (wrong) {
        archive_fail(archive, wrong);
        return;
    }
    if (tick != lga->tick) {            /* this phase ticks otherwise: count its time from here */
        lga->base_time += (double)(lga->ticks - lga->base_ticks) * tick;
        lga->base_ticks = lga->ticks;
    }
    lga->walls_stale = true;
    lga->crowded = is_crowded(lga);
}

const struct model model_lga = {
    .name     = "lga",
    .summary  = "Grains that hop on a triangular lattice, "
                "seven to a node: the fastest flow of sand.",
    .work     = "ticks",
    /* Friction is the lattice's own: its slopes stand without a coefficient, and `s` says how
     * firmly a grain with one-sided support holds. */
    .effects  = EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_FRICTION | EFFECT_POLYDISPERSE
              | EFFECT_PERIODIC | EFFECT_WALLS | EFFECT_GATES | EFFECT_INFLOW | EFFECT_OUTFLOW
              | EFFECT_COLLISION_RATE,
    .settings = &group,
    .resolve  = lga_resolve,
    .memory   = lga_memory,
    .create   = lga_create,
    .destroy  = lga_destroy,
    .advance  = lga_advance,
    .observe  = lga_look_list,
    .sample   = lga_look_sample,
    .ground   = lga_look_ground,
    .archive  = lga_archive,
    .count    = lga_count,
};
