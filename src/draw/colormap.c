/* colormap.c - see colormap.h.
 *
 * The maps are published tables, kept as text in assets/colormaps and read once.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/colormap.h"

#include "base/asset.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define COLORMAPS(X) X(viridis) X(inferno) X(cividis) X(turbo)

enum {
#define X(name) COLORMAP_##name,
    COLORMAPS(X)
#undef X
    COLORMAP_COUNT
};

static const char *const names[] = {
#define X(name) #name,
    COLORMAPS(X)
#undef X
};

static uint8_t tables[COLORMAP_COUNT][COLORMAP_SIZE][3];
static pthread_once_t read_once = PTHREAD_ONCE_INIT;

/* One line an entry: "r,g,b". */
static void read_table(const char *text, uint8_t table[][3])
{
    for (uint32_t k = 0; k < COLORMAP_SIZE; k++) {
        for (uint32_t c = 0; c < 3; c++) {
            char *end;
            table[k][c] = (uint8_t)strtoul(text, &end, 10);
            assert(end > text);
            text = end + 1;
        }
    }
}

static void read_tables(void)
{
#define X(name)                                                                         \
    {                                                                                   \
        const struct asset *asset = asset_find("assets/colormaps/" #name ".csv");       \
        assert(asset);                                                                  \
        read_table((const char *)asset->bytes, tables[COLORMAP_##name]);                \
    }
    COLORMAPS(X)
#undef X
}

const uint8_t (*colormap_find(const char *name))[3]
{
    pthread_once(&read_once, read_tables);
    for (int k = 0; k < COLORMAP_COUNT; k++) {
        if (strcmp(name, names[k]) == 0) return (const uint8_t (*)[3])tables[k];
    }
    return NULL;
}

const char *colormap_names(void)
{
#define X(name) ", " #name
    return &COLORMAPS(X)[2];
#undef X
}

static double signed_root(double x) { return copysign(sqrt(fabs(x)), x); }

double colormap_position(enum scale scale, const double range[2], double value)
{
    double low = range[0], high = range[1];
    if (scale == SCALE_SQRT && low < 0 && high > 0) {   /* both ways from zero, as spins go */
        low = signed_root(low);
        high = signed_root(high);
        value = signed_root(value);
        scale = SCALE_LINEAR;
    }
    if (scale == SCALE_LOG) {
        low = fmax(low, high / 1000);
        if (!(low > 0)) return value > high ? 1 : 0;    /* no positive values: no logarithm */
        value = value > 0 ? log(value / low) : -INFINITY;
        high = log(high / low);
    } else {
        value -= low;
        high -= low;
    }
    if (!(high > 0)) return value > 0 ? 1 : 0;
    const double position = value / high;
    if (!(position > 0)) return 0;                      /* NAN too */
    if (position > 1) return 1;
    return scale == SCALE_SQRT ? sqrt(position) : position;
}
