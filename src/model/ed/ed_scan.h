/* ed_scan.h - the innermost part of the loop: which of a list of grains does grain i meet first?
 *
 * Two grains under the same gravity approach on straight lines.  The dot product b of their
 * distance and relative velocity decides whether they approach at all; prediction and collision
 * compute it by the same operations, so they never disagree (a fused multiply-add in one of them
 * would make a pair in collapse be predicted and refused for ever).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed.h"
#include "model/ed/ed_shear.h"

#include <math.h>
#ifdef SCAN_AVX2
#include <immintrin.h>
#endif

/* A squared distance this much above contact still counts as contact: positions are rounded. */
static const double touch_slack = 1e-10;

/* As fmin and fmax where no NAN comes in; those are calls into a library. */
static inline double scan_least(double a, double b) { return a < b ? a : b; }
static inline double scan_most(double a, double b) { return a > b ? a : b; }

struct scan {
    uint32_t i, partner;
    bool     wraps, found;      /* neighbours across a periodic border; someone sooner was found */
    double   best;              /* time from now until the soonest contact known */
};

/* Grain j as seen from grain i now. */
struct approach { double dx, dy, du, dv, b; };

static inline __attribute__((always_inline)) struct approach
scan_approach(const struct ed *ed, const struct ed_grain *g, const struct ed_grain *o, bool wraps)
{
    const double t = ed->clock.now;
    struct approach a = {.du = o->vx - g->vx, .dv = o->vy - g->vy};
    a.dx = (o->x - g->x) + a.du * t;
    a.dy = (o->y - g->y) + a.dv * t;
    if (wraps) {
        const double up = rint(a.dy * ed->unwrap_y);    /* images; above they are ahead */
        a.dy -= ed->wrap_y * up;
        a.dx -= ed_shear_ahead(ed, t) * up;
        a.du -= ed->clock.shear_speed * up;
        a.dx -= ed->wrap_x * rint(a.dx * ed->unwrap_x);
    }
    a.b = a.dx * a.du + a.dy * a.dv;
    return a;
}

/* b above which nothing approaches but by rounding. */
static inline double scan_graze(const struct ed *ed)
{
    return -ed->clock.noise * 2 * ed->radius_one;
}

static inline double scan_reach2(const struct ed *ed, uint32_t i, uint32_t j, bool sizes)
{
    if (!sizes) return ed->diameter2;
    const double reach = ed->radius[i] + ed->radius[j];
    return reach * reach;
}

/* Do i and j touch now, and approach? */
static inline __attribute__((always_inline)) bool
scan_touches(const struct ed *ed, uint32_t i, uint32_t j, bool sizes, struct approach *a)
{
    *a = scan_approach(ed, &ed->grains[i], &ed->grains[j], true);
    const double reach2 = scan_reach2(ed, i, j, sizes);
    return a->b < scan_graze(ed)
        && a->dx * a->dx + a->dy * a->dy < reach2 * (1 + touch_slack);
}

#ifndef SCAN_AVX2

/* Copies the cell's slots, also the empty ones behind; returns how many are grains. */
static inline uint32_t scan_gather(const struct ed_cell *cell, uint32_t *list)
{
    uint32_t n = 0;
    for (; n < ED_CELL_ROOM && cell->id[n] != ED_CELL_EMPTY; n++) list[n] = cell->id[n];
    return n;
}

static inline void scan_put(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    ed_cells_put(cells, cell, id);
}

static inline void scan_remove(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    ed_cells_remove(cells, cell, id);
}

static inline __attribute__((always_inline)) void
scan_list(const struct ed *ed, struct scan *scan, uint32_t *list, uint32_t n, bool sizes)
{
    const struct ed_grain g = ed->grains[scan->i];
    const double graze = scan_graze(ed);
    for (uint32_t k = 0; k < n; k++) {
        const struct approach a = scan_approach(ed, &g, &ed->grains[list[k]], scan->wraps);
        if (!(a.b < graze)) continue;
        const double reach2 = scan_reach2(ed, scan->i, list[k], sizes);
        const double c = (a.dx * a.dx + a.dy * a.dy) - reach2, u2 = a.du * a.du + a.dv * a.dv;
        const double q = a.b * a.b - u2 * c;
        if (!(q > 0)) continue;
        /* The smaller root of |dr + du s| = reach without cancellation; an overlap by rounding
         * (c < 0) means: now. */
        const double s = scan_most(c / (sqrt(q) - a.b), 0);
        if (!(s < scan->best)) continue;
        scan->best = s;
        scan->partner = list[k];
        scan->found = true;
    }
}

#else

static inline __attribute__((always_inline)) uint32_t
scan_gather(const struct ed_cell *cell, uint32_t *list)
{
    const __m256i ids = _mm256_load_si256((const __m256i *)cell);
    const __m256i empty = _mm256_cmpeq_epi32(ids, _mm256_set1_epi32(-1));
    _mm256_storeu_si256((__m256i *)list, ids);
    return ED_CELL_ROOM - (uint32_t)__builtin_popcount(
        (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(empty)));
}

/* As ed_cells_put and ed_cells_remove, without branches on how full a cell is. */
static inline __attribute__((always_inline)) void
scan_put(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t *ids = cells->cells[cell].id;
    const __m256i empty = _mm256_cmpeq_epi32(_mm256_load_si256((const __m256i *)ids),
                                             _mm256_set1_epi32(-1));
    const unsigned mask = (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(empty));
    if (__builtin_expect(mask == 0, 0)) ed_cells_put_chained(cells, cell, id);
    else ids[__builtin_ctz(mask)] = id;
}

static inline __attribute__((always_inline)) void
scan_remove(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t *ids = cells->cells[cell].id;
    const __m256i here = _mm256_load_si256((const __m256i *)ids);
    const __m256i empty = _mm256_cmpeq_epi32(here, _mm256_set1_epi32(-1)),
                  mine = _mm256_cmpeq_epi32(here, _mm256_set1_epi32((int)id));
    const unsigned empties = (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(empty)),
                   at = (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(mine));
    if (__builtin_expect(empties == 0 || at == 0, 0)) {
        ed_cells_remove(cells, cell, id);
        return;
    }
    const int last = __builtin_ctz(empties) - 1;
    ids[__builtin_ctz(at)] = ids[last];
    ids[last] = ED_CELL_EMPTY;
}

/* Takes over the soonest of the lanes; among equals the one that came first in the list. */
static inline __attribute__((always_inline)) void
scan_keep(struct scan *scan, __m256d best, __m256d who, const uint32_t *list)
{
    __m256d least = _mm256_min_pd(best, _mm256_permute2f128_pd(best, best, 1));
    least = _mm256_min_pd(least, _mm256_permute_pd(least, 5));
    const double soonest = _mm256_cvtsd_f64(least);
    if (!(soonest < scan->best)) return;
    double times[4], places[4], first = INFINITY;
    _mm256_storeu_pd(times, best);
    _mm256_storeu_pd(places, who);
    for (int lane = 0; lane < 4; lane++) {
        if (times[lane] == soonest && places[lane] < first) first = places[lane];
    }
    scan->best = soonest;
    scan->partner = list[(uint32_t)first];
    scan->found = true;
}

/* As above, four candidates at a time: the same operations in each lane. */
static inline __attribute__((always_inline)) void
scan_list(const struct ed *ed, struct scan *scan, uint32_t *list, uint32_t n, bool sizes)
{
    const struct ed_grain *grains = ed->grains, *g = &grains[scan->i];
    const __m256d x = _mm256_set1_pd(g->x), y = _mm256_set1_pd(g->y), vx = _mm256_set1_pd(g->vx),
                  vy = _mm256_set1_pd(g->vy), t = _mm256_set1_pd(ed->clock.now),
                  zero = _mm256_setzero_pd(), graze = _mm256_set1_pd(scan_graze(ed));
    __m256d best = _mm256_set1_pd(scan->best), who = _mm256_set1_pd(-1);
    __m256d place = _mm256_set_pd(3, 2, 1, 0), reach2 = _mm256_set1_pd(ed->diameter2);
    /* The last quadruple is filled up with the grain that is nowhere. */
    for (uint32_t k = n; k < n + 3; k++) list[k] = ed->count_max;
    for (uint32_t k = 0; k < n; k += 4) {
        const __m256d a = _mm256_load_pd(&grains[list[k]].x),
                      b = _mm256_load_pd(&grains[list[k + 1]].x),
                      c = _mm256_load_pd(&grains[list[k + 2]].x),
                      d = _mm256_load_pd(&grains[list[k + 3]].x);
        const __m256d ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b),
                      cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
        __m256d du = _mm256_sub_pd(_mm256_permute2f128_pd(ab_low, cd_low, 0x31), vx);
        const __m256d dv = _mm256_sub_pd(_mm256_permute2f128_pd(ab_high, cd_high, 0x31), vy);
        __m256d dx = _mm256_sub_pd(_mm256_permute2f128_pd(ab_low, cd_low, 0x20), x),
                dy = _mm256_sub_pd(_mm256_permute2f128_pd(ab_high, cd_high, 0x20), y);
        dx = _mm256_add_pd(dx, _mm256_mul_pd(du, t));
        dy = _mm256_add_pd(dy, _mm256_mul_pd(dv, t));
        if (__builtin_expect(scan->wraps, 0)) {
            enum { nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC };
            const __m256d up = _mm256_round_pd(
                _mm256_mul_pd(dy, _mm256_set1_pd(ed->unwrap_y)), nearest);
            dy = _mm256_sub_pd(dy, _mm256_mul_pd(_mm256_set1_pd(ed->wrap_y), up));
            dx = _mm256_sub_pd(dx, _mm256_mul_pd(
                _mm256_set1_pd(ed_shear_ahead(ed, ed->clock.now)), up));
            du = _mm256_sub_pd(du, _mm256_mul_pd(_mm256_set1_pd(ed->clock.shear_speed), up));
            const __m256d turns_x = _mm256_mul_pd(dx, _mm256_set1_pd(ed->unwrap_x));
            dx = _mm256_sub_pd(dx, _mm256_mul_pd(_mm256_set1_pd(ed->wrap_x),
                                                 _mm256_round_pd(turns_x, nearest)));
        }
        if (sizes) {
            const double *r = ed->radius;
            const __m256d reach = _mm256_add_pd(_mm256_set1_pd(r[scan->i]),
                _mm256_set_pd(r[list[k + 3]], r[list[k + 2]], r[list[k + 1]], r[list[k]]));
            reach2 = _mm256_mul_pd(reach, reach);
        }
        const __m256d bb = _mm256_add_pd(_mm256_mul_pd(dx, du), _mm256_mul_pd(dy, dv));
        const __m256d d2 = _mm256_add_pd(_mm256_mul_pd(dx, dx), _mm256_mul_pd(dy, dy));
        const __m256d cc = _mm256_sub_pd(d2, reach2);
        const __m256d u2 = _mm256_add_pd(_mm256_mul_pd(du, du), _mm256_mul_pd(dv, dv));
        const __m256d q = _mm256_sub_pd(_mm256_mul_pd(bb, bb), _mm256_mul_pd(u2, cc));
        const __m256d meets = _mm256_and_pd(_mm256_cmp_pd(bb, graze, _CMP_LT_OQ),
                                            _mm256_cmp_pd(q, zero, _CMP_GT_OQ));
        const __m256d root = _mm256_div_pd(cc, _mm256_sub_pd(_mm256_sqrt_pd(q), bb));
        const __m256d s = _mm256_max_pd(root, zero);
        const __m256d sooner = _mm256_and_pd(meets, _mm256_cmp_pd(s, best, _CMP_LT_OQ));
        best = _mm256_blendv_pd(best, s, sooner);
        who = _mm256_blendv_pd(who, place, sooner);
        place = _mm256_add_pd(place, _mm256_set1_pd(4));
    }
    scan_keep(scan, best, who, list);
}

#endif
