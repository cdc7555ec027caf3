/* percentile.c - see percentile.h: selection by partition, O(count).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/percentile.h"

#include <assert.h>
#include <math.h>

static void swap(float *a, float *b)
{
    const float kept = *a;
    *a = *b;
    *b = kept;
}

/* The middle one of three, so that sorted values do not make it quadratic. */
static float pivot(float a, float b, float c)
{
    const float low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

double percentile(float *values, uint32_t count, double share)
{
    assert(share >= 0);
    assert(share <= 1);
    if (count == 0) return 0;
    const double place = ceil(share * count) - 1;
    const int64_t wanted = place > 0 ? (int64_t)place : 0;
    int64_t first = 0, last = (int64_t)count - 1;
    while (first < last) {
        const float middle = pivot(values[first], values[first + (last - first) / 2],
                                   values[last]);
        int64_t low = first, high = last;
        while (low <= high) {
            while (values[low] < middle) low++;
            while (values[high] > middle) high--;
            if (low > high) break;
            swap(&values[low++], &values[high--]);
        }
        if (wanted <= high) last = high;
        else if (wanted >= low) first = low;
        else break;             /* between the two parts all are equal to the pivot */
    }
    return values[wanted];
}
