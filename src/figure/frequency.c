/* frequency.c - see frequency.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/frequency.h"

#include <math.h>

bool frequency_since(const struct lab *lab, uint32_t *last, uint32_t *counts, uint32_t room)
{
    const struct grains *grains = &lab->footage.grains;
    for (uint32_t i = 0; i < grains->count; i++) {
        const uint32_t id = grains->id[i];
        if (id >= room) return false;
        counts[id] = grains->collisions[i] - last[id];
        last[id] = grains->collisions[i];
    }
    return true;
}

void frequency_curve(struct chart *chart, const struct distribution *d, double span)
{
    for (uint32_t low = 0, width = 1; low + width < d->bins; low += width) {
        if (low >= 16 * width) width *= 2;
        double share = 0, times = 0;
        for (uint32_t c = low; c < low + width && c < d->bins; c++) {
            share += distribution_share(d, c, NULL);
            times += (double)d->times[c];
        }
        if (!(times > 0)) continue;
        chart_error(chart, (low + 0.5 * width) / span, share * span / width,
                    share * span / width / sqrt(times));
    }
}

void frequency_law(struct chart *chart, const struct distribution *d, double span,
                          enum distribution_law law)
{
    const struct distribution_fit fit = distribution_fit(d, law);
    chart_curve(chart, CHART_LAW, "%s, %.3g", distribution_law_name(law), fit.parameter / span);
    uint32_t most = 0;
    for (uint32_t c = 0; c < d->bins; c++) if (d->times[c] > 0) most = c;
    for (double c = 0; c <= most; c = floor(fmax(c + 1, c * 1.1))) {
        const double share = distribution_law_share(law, fit.parameter, (uint32_t)c);
        if (share * (double)d->total > 0.05) chart_point(chart, (c + 0.5) / span, share * span);
    }
}

void frequency_tell(struct figure_job *job, const char *when, const struct distribution *d,
                     enum distribution_law wanted)
{
    const enum distribution_law best = distribution_best(d);
    const struct distribution_fit fit = distribution_fit(d, best);
    figure_hold(job, best == wanted, "%s %s fits best (%.3g +- %.2g, mean %.3g)", when,
                distribution_law_name(best), fit.parameter, fit.error, d->mean);
}
