/* md_step.c - one time step.
 *
 * A strip is swept once: forces of a window of links, then at once the motion of every grain that
 * has all its forces, while it is still in the cache.  That is allowed because a pair belongs to
 * its lower index: nobody asks a finished grain again for its place.  Pairs from strip to strip
 * are done before, when nothing moves.
 *
 * Verlet: h(t + dt/2) = h(t - dt/2) + a dt; x += h dt; the force reads u = h + a dt/2.
 * Gear: r_k = x^(k) dt^k / k!; predict all, correct by c_k (a dt^2/2 - r_2); 6 values for the
 * position, 4 for the rim's travel (Allen and Tildesley, Computer Simulation of Liquids).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_step.h"

#include "model/md/md_fault.h"
#include "model/md/md_pairs.h"
#include "model/md/md_walls.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* How grains move: with traits of their own, turning, by Gear's method; some for the first time;
 * under gravity. */
enum { TRAITS = 1, ROTATES = 2, GEAR = 4, FRESH = 8, FALLS = 16 };

/* What turns has traits; nothing is fresh for Gear. */
#define FORMS(X) X(0) X(1) X(3) X(4) X(5) X(7) X(8) X(9) X(11) \
                 X(16) X(17) X(19) X(20) X(21) X(23) X(24) X(25) X(27)

/* Speeds are compared as bit patterns: for numbers >= 0 the order is the same, and what is not a
 * number comes out above all numbers, whatever its sign. */
FORCE_INLINE uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

FORCE_INLINE void move_verlet(struct md *md, uint32_t i, double ax, double ay, double at,
                              unsigned form)
{
    struct grain *g = &md->grains[i];
    struct half *h = &md->halves[i];
    const double dt = md->dt, half = 0.5 * dt;
    double kick = dt;
    if (form & FRESH && md->tags[i].fresh) {
        md->tags[i].fresh = 0;
        kick = half;
    }
    h->hx += kick * ax;
    h->hy += kick * ay;
    g->ux = h->hx + half * ax;
    g->uy = h->hy + half * ay;
    g->x += dt * h->hx;
    g->y += dt * h->hy;
    if (form & ROTATES) {
        struct turn *turn = &md->turns[i];
        turn->hrim += kick * at;
        md->traits[i].rim = turn->hrim + half * at;
        turn->angle += dt * turn->hrim;
    }
}

/* In free flight the derivatives die away geometrically and would become denormal numbers, with
 * which processors take a hundred times longer; what is far below any physical scale goes to 0. */
static const double negligible = 1e-270;

FORCE_INLINE double without_rest(double value) { return value + negligible - negligible; }

FORCE_INLINE void correct_gear(struct md *md, uint32_t i, double ax, double ay, double at,
                               unsigned form)
{
    struct grain *g = &md->grains[i];
    struct gear *d = &md->gears[i];
    const double dt = md->dt;
    const double ex = 0.5 * ax * dt * dt - d->x2, ey = 0.5 * ay * dt * dt - d->y2;
    g->x += 3.0 / 16 * ex;
    g->y += 3.0 / 16 * ey;
    g->ux += 251.0 / 360 * ex / dt;
    g->uy += 251.0 / 360 * ey / dt;
    d->x2 += ex;
    d->y2 += ey;
    d->x3 = without_rest(d->x3 + 11.0 / 18 * ex);
    d->y3 = without_rest(d->y3 + 11.0 / 18 * ey);
    d->x4 = without_rest(d->x4 + 1.0 / 6 * ex);
    d->y4 = without_rest(d->y4 + 1.0 / 6 * ey);
    d->x5 = without_rest(d->x5 + 1.0 / 60 * ex);
    d->y5 = without_rest(d->y5 + 1.0 / 60 * ey);
    md->halves[i] = (struct half){g->ux, g->uy};
    if (form & ROTATES) {
        struct turn *turn = &md->turns[i];
        const double et = 0.5 * at * dt * dt - d->a2;
        turn->angle += 1.0 / 6 * et;
        turn->hrim = md->traits[i].rim += 5.0 / 6 * et / dt;
        d->a2 += et;
        d->a3 = without_rest(d->a3 + 1.0 / 3 * et);
    }
}

static void predict_gear(struct md *md, uint32_t t)
{
    const double dt = md->dt;
    for (uint32_t i = md->strips[t].first; i < md->strips[t].last; i++) {
        struct grain *g = &md->grains[i];
        struct gear *d = &md->gears[i];
        g->x += dt * g->ux + d->x2 + d->x3 + d->x4 + d->x5;
        g->y += dt * g->uy + d->y2 + d->y3 + d->y4 + d->y5;
        g->ux += (2 * d->x2 + 3 * d->x3 + 4 * d->x4 + 5 * d->x5) / dt;
        g->uy += (2 * d->y2 + 3 * d->y3 + 4 * d->y4 + 5 * d->y5) / dt;
        d->x2 += 3 * d->x3 + 6 * d->x4 + 10 * d->x5;
        d->y2 += 3 * d->y3 + 6 * d->y4 + 10 * d->y5;
        d->x3 += 4 * d->x4 + 10 * d->x5;
        d->y3 += 4 * d->y4 + 10 * d->y5;
        d->x4 += 5 * d->x5;
        d->y4 += 5 * d->y5;
        if (!md->turns) continue;
        double *const rim = &md->traits[i].rim;
        md->turns[i].angle += dt * *rim + d->a2 + d->a3;
        *rim += (2 * d->a2 + 3 * d->a3) / dt;
        d->a2 += 3 * d->a3;
    }
}

struct forces { struct push *pushes; double *twists; };     /* twists: NULL where none spins */

/* Moves the grains first..last-1 by their forces and empties the forces. */
FORCE_INLINE void move(struct md *md, struct forces forces, uint32_t first, uint32_t last,
                       unsigned form)
{
    const double gx = md->scene->gravity[0], gy = md->scene->gravity[1];
    for (uint32_t i = first; i < last; i++) {
        const struct push push = forces.pushes[i];
        const struct trait *trait = form & TRAITS ? &md->traits[i] : NULL;
        const double inverse_mass = form & TRAITS ? trait->inverse_mass : md->inverse_mass_one;
        double ax = push.fx * inverse_mass, ay = push.fy * inverse_mass, at = 0;
        if (form & FALLS) {
            ax += gx;
            ay += gy;
        }
        forces.pushes[i] = (struct push){0};
        if (form & ROTATES) {
            at = forces.twists[i] * inverse_mass * trait->inverse_inertia;
            forces.twists[i] = 0;
        }
        if (form & GEAR) correct_gear(md, i, ax, ay, at, form);
        else move_verlet(md, i, ax, ay, at, form);
    }
}

/* Not while they move: there each comparison waits for the one before, here it is made of many
 * grains at once. */
CLONES static uint64_t fastest_of(const struct half *halves, uint32_t count, uint64_t fastest)
{
    for (uint32_t i = 0; i < count; i++) {
        const double hx = halves[i].hx, hy = halves[i].hy;
        const uint64_t speed2 = bits_of(hx * hx + hy * hy);
        fastest = speed2 > fastest ? speed2 : fastest;
    }
    return fastest;
}

static unsigned form_of(const struct md *md)
{
    return (md->traits ? TRAITS : 0) | (md->turns ? ROTATES : 0) | (md->gears ? GEAR : 0)
         | (md->some_fresh && !md->gears ? FRESH : 0)
         | (md->effects & EFFECT_GRAVITY ? FALLS : 0);
}

static uint64_t move_grains(const unsigned form, struct md *md, struct forces forces,
                           uint32_t first, uint32_t last, uint64_t fastest)
{
    switch (form) {
#define X(form) case form: move(md, forces, first, last, form); break;
    FORMS(X)
#undef X
    }
    return fastest_of(md->halves + first, last - first, fastest);
}

/* Forces of the links from strip t to later ones. */
static void push_cross(struct md *md, uint32_t t, struct md_window *w)
{
    const struct strip *strip = &md->strips[t];
    const uint32_t base = md->link_count - md->cross_count;
    struct strip_sums sums = {0};
    for (uint32_t k = strip->cross_first; k < strip->cross_last; k += WINDOW) {
        const uint32_t left = strip->cross_last - k, last = k + (left < WINDOW ? left : WINDOW);
        md_pairs_window(md, k, last, w, &sums);
        for (uint32_t c = 0; c < w->count; c++) {
            md->cross_push[w->link[c] - base] = (struct push){w->fx[c], w->fy[c]};
            if (md->turns) md->cross_twist[w->link[c] - base] = w->ft[c];
        }
    }
    md->sums[t] = sums;
}

/* Only those that touch have a force. */
static void add_cross(struct md *md, uint32_t t, struct forces forces)
{
    const struct strip *strip = &md->strips[t];
    const uint32_t base = md->link_count - md->cross_count;
    for (uint32_t k = strip->cross_first; k < strip->cross_last; k++) {
        if (!(md->links[k].j & LINK_TOUCHES)) continue;
        const struct push *force = &md->cross_push[k - base];
        const uint32_t i = md->links[k].i;
        forces.pushes[i].fx += force->fx;
        forces.pushes[i].fy += force->fy;
        if (md->turns) forces.twists[i] += md->cross_twist[k - base];
    }
    for (uint32_t in = strip->in_first; in < strip->in_last; in++) {
        const uint32_t k = md->incoming[in], j = md->links[k].j & LINK_INDEX;
        if (!(md->links[k].j & LINK_TOUCHES)) continue;
        const struct push *force = &md->cross_push[k - base];
        forces.pushes[j].fx -= force->fx;
        forces.pushes[j].fy -= force->fy;
        if (md->turns) forces.twists[j] += md->cross_twist[k - base];
    }
}

FORCE_INLINE void scatter(const struct link *links, const struct md_window *w,
                          struct forces forces, bool rotates)
{
    for (uint32_t c = 0; c < w->count; c++) {
        const uint32_t i = links[w->link[c]].i, j = links[w->link[c]].j & LINK_INDEX;
        struct push *a = &forces.pushes[i], *b = &forces.pushes[j];
        a->fx += w->fx[c];
        a->fy += w->fy[c];
        b->fx -= w->fx[c];
        b->fy -= w->fy[c];
        if (rotates) {
            forces.twists[i] += w->ft[c];
            forces.twists[j] += w->ft[c];
        }
    }
}

/* `forces` are those of the strip, which count from its first grain. */
static void sweep(struct md *md, uint32_t t, struct forces forces, struct md_window *w)
{
    const struct strip *strip = &md->strips[t];
    const unsigned form = form_of(md);
    if (md->wall_link_count > 0) md_walls_push(md, t, forces.pushes, forces.twists);
    /* Added up here and not in place: neighbouring strips share a line of the cache. */
    struct strip_sums sums = md->sums[t];
    forces.pushes -= strip->first;
    if (md->turns) forces.twists -= strip->first;
    if (md->cross_count > 0) add_cross(md, t, forces);
    uint32_t done = strip->first;
    uint64_t fastest = 0;
    for (uint32_t k = strip->link_first; k < strip->link_last;) {
        const uint32_t left = strip->link_last - k, last = k + (left < WINDOW ? left : WINDOW);
        md_pairs_window(md, k, last, w, &sums);
        if (form & ROTATES) scatter(md->links, w, forces, true);
        else scatter(md->links, w, forces, false);
        k = last;
        const uint32_t next = k < strip->link_last ? md->links[k].i : strip->last;
        fastest = move_grains(form, md, forces, done, next, fastest);
        done = next;
    }
    fastest = move_grains(form, md, forces, done, strip->last, fastest);
    memcpy(&sums.speed2_max, &fastest, sizeof fastest);
    md->sums[t] = sums;
}

static void add_sums(struct md *md)
{
    double speed2 = 0;
    uint64_t suspects = 0;
    bool finite = true;
    for (uint32_t t = 0; t < md->strip_count; t++) {
        const struct strip_sums *sums = &md->sums[t];
        md->begun += sums->begun;
        md->tangential += sums->tangential;
        suspects += sums->suspect;
        finite = finite && isfinite(sums->speed2_max);
        speed2 = fmax(speed2, sums->speed2_max);
    }
    const uint32_t bodies = md->scene->obstacle_count;
    for (uint32_t t = 0; md->body_sums && t < md->strip_count; t++) {
        for (uint32_t b = 0; b < bodies; b++) {
            struct tally_body *sum = &md->body_sums[t * bodies + b], *body = &md->tally.bodies[b];
            body->impulse_x += sum->impulse_x;
            body->impulse_y += sum->impulse_y;
            body->angular_impulse += sum->angular_impulse;
            body->contacts += sum->contacts;
            *sum = (struct tally_body){0};
        }
    }
    md->stride = md->dt * (sqrt(speed2) + md->wall_speed);
    md->travel += md->stride;
    md->suspects = suspects;
    if (!finite) md->broken = true;
}

bool md_step_take(struct md *md)
{
    if (md->gears) md->steps_here++;                            /* Gear: forces at the new time */
    if (md->walls_vary && md->gears) md_walls_place(md);
    const uint32_t strips = md->strip_count;
#pragma omp parallel num_threads(md->thread_count) if (strips > 1)
    {
        struct md_window w;
        const size_t room = (size_t)omp_get_thread_num() * md->strip_room;
        const struct forces forces = {md->pushes + room, md->turns ? md->twists + room : NULL};
        if (md->gears) {
#pragma omp for schedule(dynamic, 1)
            for (uint32_t t = 0; t < strips; t++) predict_gear(md, t);
        }
#pragma omp for schedule(dynamic, 1)
        for (uint32_t t = 0; t < strips; t++) push_cross(md, t, &w);
#pragma omp for schedule(dynamic, 1)
        for (uint32_t t = 0; t < strips; t++) sweep(md, t, forces, &w);
    }
    if (!md->gears) md->steps_here++;
    md->steps++;
    md->some_fresh = false;
    add_sums(md);
    if (!md_fault_check(md)) return false;
    /* Walls stand where the grains are, for the next forces and for whoever looks before them. */
    if (md->walls_vary && !md->gears) md_walls_place(md);
    return true;
}

void md_step_rescale(struct md *md, double dt_before)
{
    const double q = md->dt / dt_before;
    if (q == 1) return;
    for (uint32_t i = 0; i < md->count; i++) {
        struct grain *g = &md->grains[i];
        struct half *h = &md->halves[i];
        h->hx = g->ux + q * (h->hx - g->ux);
        h->hy = g->uy + q * (h->hy - g->uy);
        if (md->turns) {
            const double rim = md->traits[i].rim;
            md->turns[i].hrim = rim + q * (md->turns[i].hrim - rim);
        }
        if (!md->gears) continue;
        struct gear *d = &md->gears[i];
        const double q2 = q * q, q3 = q2 * q, q4 = q3 * q, q5 = q4 * q;
        d->x2 *= q2; d->y2 *= q2; d->a2 *= q2;
        d->x3 *= q3; d->y3 *= q3; d->a3 *= q3;
        d->x4 *= q4; d->y4 *= q4;
        d->x5 *= q5; d->y5 *= q5;
    }
}
