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

enum { ROTATES = 1, GEAR = 2 };

/* Speeds are compared as bit patterns: for numbers >= 0 the order is the same, and what is not a
 * number comes out above all numbers. */
FORCE_INLINE int64_t bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & INT64_MAX;
}

FORCE_INLINE void move_verlet(struct grain *g, struct half *h, double ax, double ay, double at,
                              double dt, unsigned form)
{
    const double half = 0.5 * dt;
    double kick = dt;
    if (__builtin_expect(g->fresh, 0)) {
        g->fresh = 0;
        kick = half;
    }
    h->hx += kick * ax;
    h->hy += kick * ay;
    g->ux = h->hx + half * ax;
    g->uy = h->hy + half * ay;
    g->x += dt * h->hx;
    g->y += dt * h->hy;
    if (form & ROTATES) {
        h->hrim += kick * at;
        g->rim = h->hrim + half * at;
        h->angle += dt * h->hrim;
    }
}

/* In free flight the derivatives die away geometrically and would become denormal numbers, with
 * which processors take a hundred times longer; what is far below any physical scale goes to 0. */
static const double negligible = 1e-270;

FORCE_INLINE double without_rest(double value) { return value + negligible - negligible; }

FORCE_INLINE void correct_gear(struct grain *g, struct half *h, struct gear *d, double ax,
                               double ay, double at, double dt, unsigned form)
{
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
    h->hx = g->ux;
    h->hy = g->uy;
    if (form & ROTATES) {
        const double et = 0.5 * at * dt * dt - d->a2;
        h->angle += 1.0 / 6 * et;
        g->rim += 5.0 / 6 * et / dt;
        d->a2 += et;
        d->a3 = without_rest(d->a3 + 1.0 / 3 * et);
        h->hrim = g->rim;
    }
}

static void predict_gear(struct md *md, uint32_t t)
{
    const double dt = md->dt;
    for (uint32_t i = md->strips[t].first; i < md->strips[t].last; i++) {
        struct grain *g = &md->grains[i];
        struct half *h = &md->halves[i];
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
        h->angle += dt * g->rim + d->a2 + d->a3;
        g->rim += (2 * d->a2 + 3 * d->a3) / dt;
        d->a2 += 3 * d->a3;
    }
}

/* Moves the grains first..last-1 by their forces and empties the forces. */
FORCE_INLINE int64_t move(struct md *md, struct push *pushes, uint32_t first, uint32_t last,
                          int64_t fastest, unsigned form)
{
    const double dt = md->dt, gx = md->scene->gravity[0], gy = md->scene->gravity[1];
    for (uint32_t i = first; i < last; i++, pushes++) {
        struct grain *g = &md->grains[i];
        struct half *h = &md->halves[i];
        const double ax = pushes->fx * g->inverse_mass + gx;
        const double ay = pushes->fy * g->inverse_mass + gy;
        const double at = form & ROTATES
                        ? pushes->ft * g->inverse_mass * md->inverse_inertia[g->species] : 0;
        *pushes = (struct push){0};
        if (form & GEAR) correct_gear(g, h, &md->gears[i], ax, ay, at, dt, form);
        else move_verlet(g, h, ax, ay, at, dt, form);
        const int64_t speed2 = bits_of(h->hx * h->hx + h->hy * h->hy);
        fastest = speed2 > fastest ? speed2 : fastest;
    }
    return fastest;
}

static int64_t move_grains(const unsigned form, struct md *md, struct push *pushes,
                           uint32_t first, uint32_t last, int64_t fastest)
{
    switch (form) {
    case 0:       return move(md, pushes, first, last, fastest, 0);
    case ROTATES: return move(md, pushes, first, last, fastest, ROTATES);
    case GEAR:    return move(md, pushes, first, last, fastest, GEAR);
    default:      return move(md, pushes, first, last, fastest, GEAR | ROTATES);
    }
}

/* Forces of the links from strip t to later ones. */
static void push_cross(struct md *md, uint32_t t, struct md_window *w)
{
    const struct strip *strip = &md->strips[t];
    const uint32_t base = md->link_count - md->cross_count;
    struct strip_sums sums = {0};
    for (uint32_t k = strip->cross_first; k < strip->cross_last; k += WINDOW) {
        const uint32_t left = strip->cross_last - k, last = k + (left < WINDOW ? left : WINDOW);
        for (uint32_t c = k; c < last; c++) md->cross_push[c - base] = (struct push){0};
        md_pairs_window(md, k, last, w, &sums);
        for (uint32_t c = 0; c < w->count; c++) {
            md->cross_push[w->link[c] - base] = (struct push){w->fx[c], w->fy[c], w->ft[c], 0};
        }
    }
    md->sums[t] = sums;
}

static void add_cross(struct md *md, uint32_t t, struct push *pushes)
{
    const struct strip *strip = &md->strips[t];
    const uint32_t base = md->link_count - md->cross_count;
    for (uint32_t k = strip->cross_first; k < strip->cross_last; k++) {
        const struct push *force = &md->cross_push[k - base];
        struct push *push = &pushes[md->links[k].i - strip->first];
        push->fx += force->fx;
        push->fy += force->fy;
        push->ft += force->ft;
    }
    for (uint32_t in = strip->in_first; in < strip->in_last; in++) {
        const uint32_t k = md->incoming[in];
        const struct push *force = &md->cross_push[k - base];
        struct push *push = &pushes[(md->links[k].j & LINK_INDEX) - strip->first];
        push->fx -= force->fx;
        push->fy -= force->fy;
        push->ft += force->ft;
    }
}

FORCE_INLINE void scatter(const struct md_window *w, struct push *pushes, bool rotates)
{
    for (uint32_t c = 0; c < w->count; c++) {
        struct push *a = &pushes[w->i[c]], *b = &pushes[w->j[c]];
        a->fx += w->fx[c];
        a->fy += w->fy[c];
        b->fx -= w->fx[c];
        b->fy -= w->fy[c];
        if (rotates) {
            a->ft += w->ft[c];
            b->ft += w->ft[c];
        }
    }
}

static void sweep(struct md *md, uint32_t t, struct push *pushes, struct md_window *w)
{
    const struct strip *strip = &md->strips[t];
    const unsigned form = (md->law.tangential ? ROTATES : 0) | (md->gears ? GEAR : 0);
    if (md->wall_link_count > 0) md_walls_push(md, t, pushes);
    /* Added up here and not in place: neighbouring strips share a line of the cache. */
    struct strip_sums sums = md->sums[t];
    if (md->cross_count > 0) add_cross(md, t, pushes);
    uint32_t done = strip->first;
    int64_t fastest = 0;
    struct push *const from_zero = pushes - strip->first;
    for (uint32_t k = strip->link_first; k < strip->link_last;) {
        const uint32_t left = strip->link_last - k, last = k + (left < WINDOW ? left : WINDOW);
        md_pairs_window(md, k, last, w, &sums);
        if (form & ROTATES) scatter(w, from_zero, true);
        else scatter(w, from_zero, false);
        k = last;
        const uint32_t next = k < strip->link_last ? md->links[k].i : strip->last;
        fastest = move_grains(form, md, from_zero + done, done, next, fastest);
        done = next;
    }
    fastest = move_grains(form, md, from_zero + done, done, strip->last, fastest);
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
        struct push *pushes = md->pushes + (size_t)omp_get_thread_num() * md->strip_room;
        if (md->gears) {
#pragma omp for schedule(dynamic, 1)
            for (uint32_t t = 0; t < strips; t++) predict_gear(md, t);
        }
#pragma omp for schedule(dynamic, 1)
        for (uint32_t t = 0; t < strips; t++) push_cross(md, t, &w);
#pragma omp for schedule(dynamic, 1)
        for (uint32_t t = 0; t < strips; t++) sweep(md, t, pushes, &w);
    }
    if (!md->gears) md->steps_here++;
    md->steps++;
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
        h->hrim = g->rim + q * (h->hrim - g->rim);
        if (!md->gears) continue;
        struct gear *d = &md->gears[i];
        const double q2 = q * q, q3 = q2 * q, q4 = q3 * q, q5 = q4 * q;
        d->x2 *= q2; d->y2 *= q2; d->a2 *= q2;
        d->x3 *= q3; d->y3 *= q3; d->a3 *= q3;
        d->x4 *= q4; d->y4 *= q4;
        d->x5 *= q5; d->y5 *= q5;
    }
}
