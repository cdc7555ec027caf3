/* bands.c - see bands.h: a counting sort.  Arrays grow by a quarter more than asked for, so that
 * a film with a slowly growing number of grains seldom allocates.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/bands.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for `count` elements and forgets the old ones. */
static void *regrow(void *block, uint32_t *capacity, uint64_t count, size_t width,
                    struct error *error)
{
    if (count <= *capacity) return block;
    const uint64_t wanted = count + count / 4;
    free(block);
    *capacity = 0;
    void *const larger = wanted < UINT32_MAX ? malloc((size_t)wanted * width) : NULL;
    if (larger) *capacity = (uint32_t)wanted;
    else error_set(error, "not enough memory to draw %llu grains", (unsigned long long)count);
    return larger;
}

bool bands_reserve(struct bands *bands, uint32_t count, struct error *error)
{
    bands->splats = regrow(bands->splats, &bands->capacity, count, sizeof *bands->splats, error);
    return bands->capacity >= count;
}

void bands_free(struct bands *bands)
{
    free(bands->splats);
    free(bands->index);
    free(bands->starts);
    free(bands->picked);
    *bands = (struct bands){0};
}

/* The bands that a grain reaches into. */
static void splat_bands(const struct bands *bands, const struct splat *splat, uint32_t *first,
                        uint32_t *last)
{
    const float reach = splat_reach(splat->radius), rows = (float)bands->rows;
    const float low = (splat->y - reach) / rows, high = (splat->y + reach) / rows;
    const float top = (float)(bands->band_count - 1);
    *first = low > 0 ? (uint32_t)(low < top ? low : top) : 0;
    *last = high > 0 ? (uint32_t)(high < top ? high : top) : 0;
}

bool bands_sort(struct bands *bands, uint32_t rows, uint32_t height, struct error *error)
{
    assert(rows > 0);
    bands->rows = rows;
    bands->band_count = (height + rows - 1) / rows;
    bands->starts = regrow(bands->starts, &bands->starts_capacity, bands->band_count + 1,
                           sizeof *bands->starts, error);
    if (!bands->starts) return false;
    uint32_t *const starts = bands->starts, first, last;
    memset(starts, 0, (bands->band_count + 1) * sizeof *starts);
    uint64_t total = 0;
    for (uint32_t k = 0; k < bands->count; k++) {
        splat_bands(bands, &bands->splats[k], &first, &last);
        for (uint32_t band = first; band <= last; band++) starts[band]++;
        total += last - first + 1;
    }
    if (total > 0) {
        bands->index = regrow(bands->index, &bands->index_capacity, total, sizeof *bands->index,
                              error);
        if (!bands->index) return false;
    }
    /* Counts become ends; filling from the back turns them into starts. */
    for (uint32_t band = 1; band <= bands->band_count; band++) starts[band] += starts[band - 1];
    for (uint32_t k = bands->count; k-- > 0;) {
        splat_bands(bands, &bands->splats[k], &first, &last);
        for (uint32_t band = first; band <= last; band++) bands->index[--starts[band]] = k;
    }
    bands->picked = regrow(bands->picked, &bands->picked_capacity, bands->count,
                           sizeof *bands->picked, error);
    return bands->picked_capacity >= bands->count;
}

const uint32_t *bands_index(const struct bands *bands, uint32_t band, uint32_t *count)
{
    assert(band < bands->band_count);
    *count = bands->starts[band + 1] - bands->starts[band];
    return *count > 0 ? bands->index + bands->starts[band] : NULL;
}

const struct splat *bands_pick(struct bands *bands, uint32_t band)
{
    uint32_t count;
    const uint32_t *const index = bands_index(bands, band, &count);
    for (uint32_t k = 0; k < count; k++) bands->picked[k] = bands->splats[index[k]];
    return bands->picked;
}
