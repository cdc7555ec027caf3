/* scatter.c - see scatter.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/scatter.h"

#include "measure/stats.h"

#include <assert.h>
#include <math.h>

static bool scatter_allocate(struct scatter *scatter, uint32_t bins, double width,
                             struct error *error)
{
    *scatter = (struct scatter){.bins = bins, .width = width};
    struct arena *arena = &scatter->arena;
    const bool done = arena_array(arena, &scatter->angle, bins)
        && arena_array(arena, &scatter->count, bins) && arena_array(arena, &scatter->mass, bins)
        && arena_array(arena, &scatter->mass_error, bins)
        && arena_array(arena, &scatter->momentum, bins) && arena_array(arena, &scatter->spin, bins);
    if (done) return true;
    scatter_free(scatter);
    return error_set(error, "not enough memory for %u angles", bins);
}

void scatter_free(struct scatter *scatter)
{
    struct arena arena = scatter->arena;
    *scatter = (struct scatter){0};
    arena_free(&arena);
}

bool scatter_create(const struct tally_screen *screen, double mass_in, struct scatter *out,
                    struct error *error)
{
    assert(screen->bins > 0);
    if (!(mass_in > 0)) {
        *out = (struct scatter){0};
        return error_set(error, "no mass has entered yet: nothing to compare the scattered mass "
                         "with; run longer, or give the scene a source");
    }
    if (!scatter_allocate(out, screen->bins, 360.0 / screen->bins, error)) return false;
    double mass = 0, count = 0;
    for (uint32_t k = 0; k < screen->bins; k++) {
        mass += screen->mass[k];
        count += screen->count[k];
    }
    const double unit = 1 / (mass_in * out->width * M_PI / 180);
    const double grain = count > 0 ? mass / count : mass_in;
    for (uint32_t k = 0; k < screen->bins; k++) {
        const double n = screen->count[k];
        out->angle[k] = (k + 0.5) * out->width - 180;
        out->count[k] = n;
        out->mass[k] = screen->mass[k] * unit;
        out->mass_error[k] = unit * (n > 0 ? screen->mass[k] / sqrt(n) : grain);
        out->momentum[k] = n > 0 ? screen->momentum[k] / n : NAN;
        out->spin[k] = n > 0 ? screen->spin[k] / n : NAN;
    }
    return true;
}

/* a + sign * b, each a mean over so many grains; NAN if there are none on either side. */
static double joint_mean(double a, double count_a, double b, double count_b, double sign)
{
    const double sum = (count_a > 0 ? a * count_a : 0) + sign * (count_b > 0 ? b * count_b : 0);
    return count_a + count_b > 0 ? sum / (count_a + count_b) : NAN;
}

bool scatter_fold(const struct scatter *scatter, struct scatter *folded, struct error *error)
{
    /* With an odd number of bins the middle one is its own mirror image and counts twice, as
     * f(Theta) + f(-Theta) says. */
    const uint32_t first = scatter->bins / 2;
    if (!scatter_allocate(folded, scatter->bins - first, scatter->width, error)) return false;
    for (uint32_t k = first; k < scatter->bins; k++) {
        const uint32_t to = k - first, mirror = scatter->bins - 1 - k;
        const double n = scatter->count[k], m = scatter->count[mirror];
        folded->angle[to] = scatter->angle[k];
        folded->count[to] = n + m;
        folded->mass[to] = scatter->mass[k] + scatter->mass[mirror];
        folded->mass_error[to] = hypot(scatter->mass_error[k], scatter->mass_error[mirror]);
        folded->momentum[to] = joint_mean(scatter->momentum[k], n, scatter->momentum[mirror], m, 1);
        folded->spin[to] = joint_mean(scatter->spin[k], n, scatter->spin[mirror], m, -1);
    }
    return true;
}

/* The bin around which `reach` bins to both sides hold the most: one noisy bin does not win. */
static uint32_t fullest(const struct scatter *scatter, uint32_t reach)
{
    uint32_t best = 0;
    double best_sum = -1;
    for (uint32_t k = 0; k < scatter->bins; k++) {
        double sum = 0, bins = 0;
        for (uint32_t n = k > reach ? k - reach : 0; n <= k + reach && n < scatter->bins; n++) {
            sum += scatter->mass[n];
            bins++;
        }
        if (sum / bins > best_sum) best_sum = sum / bins, best = k;
    }
    return best;
}

struct scatter_peak scatter_peak(const struct scatter *scatter, double reach)
{
    struct scatter_peak peak = {NAN, NAN, NAN, NAN, 0};
    const uint32_t side = (uint32_t)fmax(1, reach / scatter->width);
    double middle = scatter->angle[fullest(scatter, (side + 1) / 2)];
    /* The second round centres the window on the top that the first one found. */
    for (int round = 0; round < 2; round++) {
        uint32_t first = 0, last = scatter->bins;
        while (first < last && scatter->angle[first] < middle - reach) first++;
        while (last > first && scatter->angle[last - 1] > middle + reach) last--;
        const struct stats_parabola fit = stats_parabola(scatter->angle + first,
            scatter->mass + first, scatter->mass_error + first, last - first);
        if (!(fabs(fit.top - middle) <= reach)) return peak;
        const double freedom = (double)fit.count - 3;
        const double raise = freedom > 0 ? sqrt(fmax(1, fit.chi2 / freedom)) : 1;
        peak = (struct scatter_peak){fit.top, raise * fit.top_error, fit.height,
                                     raise * fit.height_error, last - first};
        middle = fit.top;
    }
    return peak;
}
