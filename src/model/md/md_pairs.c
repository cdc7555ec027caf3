/* md_pairs.c - forces between grains.
 *
 * Three short loops over a window that stays in the first cache level: which links touch; what
 * the touching ones need, copied side by side; their forces, many at once by SIMD.  The last one
 * is compiled for each combination of effects (STYLE rule 4) and for each width of SIMD unit.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_pairs.h"

#include <math.h>

enum { HERTZ = 1, TANGENTIAL = 2, SPRING = 4, MASSES = 8, MIXTURE = 16, DAMPED = 32 };

/* A spring needs a tangential force, a mixture needs masses; what is not damped has no tangential
 * force either, and asks for no velocity. */
#define KERNELS(X) \
    X(0) X(1) X(8) X(9) X(24) X(25) \
    X(32) X(33) X(34) X(35) X(38) X(39) X(40) X(41) X(42) X(43) X(46) X(47)     \
    X(56) X(57) X(58) X(59) X(62) X(63)

static bool is_damped(const struct md *md)
{
    const uint32_t pairs = md->scene->species_count * md->scene->species_count;
    for (uint32_t k = 0; k < pairs; k++) {
        if (md->pairs[k].damping != 0 || md->pairs[k].damping_mass != 0) return true;
    }
    return false;
}

unsigned md_pairs_kernel(const struct md *md)
{
    unsigned kernel = 0;
    if (md->law.hertz) kernel |= HERTZ;
    if (md->law.tangential) kernel |= TANGENTIAL;
    if (md->law.tangential || is_damped(md)) kernel |= DAMPED;
    if (md->law.spring) kernel |= SPRING;
    if (md->effects & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE)) kernel |= MASSES;
    if (md->effects & EFFECT_MIXTURE) kernel |= MIXTURE;
    return kernel;
}

/* A contact began or ended: rare, so it may cost. */
static void turn(struct md *md, uint32_t k, bool touches, struct strip_sums *sums)
{
    struct link *link = &md->links[k];
    link->j ^= LINK_TOUCHES;
    if (!touches) {
        if (md->springs) md->springs[k] = 0;
        return;
    }
    sums->begun++;
    if (!md->collisions) return;
    const uint32_t j = link->j & LINK_INDEX;
#pragma omp atomic
    md->collisions[link->i]++;
#pragma omp atomic
    md->collisions[j]++;
}

/* Which of the links touch.  Most do not, or not yet: nothing is stored for them that lasts. */
FORCE_INLINE void find(struct md *md, uint32_t first, uint32_t last, struct md_window *w,
                       struct strip_sums *sums, unsigned kernel, bool periodic)
{
    const struct grain *const grains = md->grains;
    const struct trait *const traits = md->traits;
    const struct link *const links = md->links;
    const double reach_one = 2 * md->radius_one;
    uint32_t n = 0;
    for (uint32_t k = first; k < last; k++) {
        const struct link link = links[k];
        const uint32_t ahead = links[k + LINKS_AHEAD].j & LINK_INDEX;
        __builtin_prefetch(&grains[ahead]);
        if (kernel & (MASSES | TANGENTIAL)) __builtin_prefetch(&traits[ahead]);
        const uint32_t j = link.j & LINK_INDEX;
        const struct grain *a = &grains[link.i], *b = &grains[j];
        double dx = a->x - b->x, dy = a->y - b->y;
        if (periodic && __builtin_expect(link.j & LINK_IMAGE, 0)) {
            const uint32_t image = link.j >> LINK_IMAGE_SHIFT & 15;
            dx -= md->image_x[image];
            dy -= md->image_y[image];
        }
        const double reach = kernel & MASSES ? traits[link.i].radius + traits[j].radius
                                             : reach_one;
        const bool touches = dx * dx + dy * dy < reach * reach;
        w->link[n] = k;
        w->dx[n] = dx;
        w->dy[n] = dy;
        n += touches;
        if (__builtin_expect(touches != (link.j >= LINK_TOUCHES), 0)) turn(md, k, touches, sums);
    }
    w->count = n;
}

FORCE_INLINE void gather(const struct md *md, struct md_window *w, unsigned kernel)
{
    const bool differ = kernel & (MASSES | TANGENTIAL);
    for (uint32_t k = 0; k < w->count; k++) {
        const uint32_t link = w->link[k];
        const uint32_t i = md->links[link].i, j = md->links[link].j & LINK_INDEX;
        const struct grain *a = &md->grains[i], *b = &md->grains[j];
        const struct trait *s = differ ? &md->traits[i] : NULL, *t = differ ? &md->traits[j] : NULL;
        if (kernel & DAMPED) {
            w->ux[k] = a->ux - b->ux;
            w->uy[k] = a->uy - b->uy;
        }
        if (kernel & TANGENTIAL) w->rims[k] = s->rim + t->rim;
        if (kernel & SPRING) w->spring[k] = md->springs[link];
        if (kernel & MASSES) {
            w->reach[k] = s->radius + t->radius;
            w->inverse_mass[k] = s->inverse_mass + t->inverse_mass;
        }
        if ((kernel & (HERTZ | MASSES)) == (HERTZ | MASSES)) {
            w->radius_product[k] = s->radius * t->radius;
        }
        if (kernel & MIXTURE) {
            w->law[k] = *md_pair_law(md, md->tags[i].species, md->tags[j].species);
        }
    }
}

/* The laws of md_law.h, without a branch. */
FORCE_INLINE uint64_t forces(const struct md *md, struct md_window *restrict w, unsigned kernel)
{
    const struct md_pair_law one = md->pairs[0];
    const double least = md->law.clip ? 0 : -1e300, dt = md->dt;
    const double inverse_mass = 2 * md->inverse_mass_one, reach_one = 2 * md->radius_one;
    const double product_one = md->radius_one * md->radius_one, suspect = md->suspect_overlap;
    const uint32_t count = w->count;
    uint64_t suspects = 0;
#pragma GCC ivdep
    for (uint32_t k = 0; k < count; k++) {
        const struct md_pair_law law = kernel & MIXTURE ? w->law[k] : one;
        const double distance = sqrt(w->dx[k] * w->dx[k] + w->dy[k] * w->dy[k]);
        const double inverse = 1 / distance;
        const double nx = w->dx[k] * inverse, ny = w->dy[k] * inverse;
        const double reach = kernel & MASSES ? w->reach[k] : reach_one;
        const double overlap = reach - distance;
        const double closing = kernel & DAMPED ? -(w->ux[k] * nx + w->uy[k] * ny) : 0;
        const double mass = 1 / (kernel & MASSES ? w->inverse_mass[k] : inverse_mass);
        double stiffness = law.stiffness;
        double damping = kernel & DAMPED ? law.damping + law.damping_mass * sqrt(mass) : 0;
        double normal;
        if (kernel & HERTZ) {
            const double product = kernel & MASSES ? w->radius_product[k] : product_one;
            const double root = sqrt(product / reach * overlap);
            stiffness *= root;
            damping *= root;
            normal = 2.0 / 3.0 * stiffness * overlap + damping * closing;
        } else {
            normal = stiffness * overlap + damping * closing;
        }
        normal = normal > least ? normal : least;
        suspects += overlap > suspect;
        double fx = normal * nx, fy = normal * ny;
        if (kernel & TANGENTIAL) {
            const double lever = distance / reach;
            const double slip = w->uy[k] * nx - w->ux[k] * ny - lever * w->rims[k];
            const double drag = law.drag + law.drag_mass * mass + law.drag_share * damping;
            const double limit = law.friction * (normal > 0 ? normal : 0);
            double pull = -drag * slip, tangential;
            if (kernel & SPRING) {
                const double tangent = stiffness * law.tangent;
                const double half = 0.5 * slip * dt, stretched = w->spring[k] + half;
                pull -= tangent * stretched;
                tangential = pull > limit ? limit : pull < -limit ? -limit : pull;
                w->spring[k] = tangential == pull ? stretched + half : -tangential / tangent;
            } else {
                tangential = pull > limit ? limit : pull < -limit ? -limit : pull;
            }
            fx -= tangential * ny;
            fy += tangential * nx;
            w->ft[k] = -lever * tangential;
        }
        w->fx[k] = fx;
        w->fy[k] = fy;
    }
    return suspects;
}

FORCE_INLINE void window_of(struct md *md, uint32_t first, uint32_t last, struct md_window *w,
                            struct strip_sums *sums, unsigned kernel)
{
    if (md->effects & EFFECT_PERIODIC) find(md, first, last, w, sums, kernel, true);
    else find(md, first, last, w, sums, kernel, false);
    gather(md, w, kernel);
    sums->suspect += forces(md, w, kernel);
    if (kernel & SPRING) {
        for (uint32_t k = 0; k < w->count; k++) md->springs[w->link[k]] = w->spring[k];
    }
    if (kernel & TANGENTIAL) sums->tangential += w->count;
}

typedef void kernel_function(struct md *, uint32_t, uint32_t, struct md_window *,
                             struct strip_sums *);

#define X(kernel)                                                                           \
    CLONES static void kernel_##kernel(struct md *md, uint32_t first, uint32_t last,        \
                                       struct md_window *w, struct strip_sums *sums)        \
    {                                                                                       \
        window_of(md, first, last, w, sums, kernel);                                        \
    }
KERNELS(X)
#undef X

static kernel_function *const kernels[] = {
#define X(kernel) [kernel] = kernel_##kernel,
    KERNELS(X)
#undef X
};

void md_pairs_window(struct md *md, uint32_t first, uint32_t last, struct md_window *window,
                     struct strip_sums *sums)
{
    kernels[md->kernel](md, first, last, window, sums);
}
