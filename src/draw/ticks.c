/* ticks.c - see ticks.h.
 *
 * A tick is kept as an integer times a power of ten until it is written, so that 0.3 is written
 * "0.3" and not what three times 0.1 happens to give.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/ticks.h"

#include "draw/colormap.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* n * 10^exponent with one rounding only. */
static double decimal(int64_t n, int exponent)
{
    return exponent < 0 ? (double)n / pow(10, -exponent) : (double)n * pow(10, exponent);
}

/* A step of 1, 2 or 5 times a power of ten, and its neighbours. */
struct step { int mantissa, exponent; };

static double step_value(struct step s) { return decimal(s.mantissa, s.exponent); }

static struct step step_finer(struct step s)
{
    switch (s.mantissa) {
    case 5: return (struct step){2, s.exponent};
    case 2: return (struct step){1, s.exponent};
    default: return (struct step){5, s.exponent - 1};
    }
}

static struct step step_not_above(double value)
{
    struct step s = {5, (int)floor(log10(value))};
    while (step_value(s) > value * (1 + 1e-12)) s = step_finer(s);
    return s;
}

double ticks_round_down(double value)
{
    assert(value > 0);
    return step_value(step_not_above(value));
}

/* ---- writing ---- */

/* n * 10^exponent with exactly `decimals` digits behind the point. */
static void write_decimal(char text[TICKS_TEXT_MAX], int64_t n, int exponent, int decimals)
{
    snprintf(text, TICKS_TEXT_MAX, "%s%.*f", n < 0 ? "\u2212" : "", decimals > 0 ? decimals : 0,
             fabs(decimal(n, exponent)));
}

static void write_shortest(char text[TICKS_TEXT_MAX], int64_t n, int exponent)
{
    while (n != 0 && n % 10 == 0) {
        n /= 10;
        exponent++;
    }
    write_decimal(text, n, exponent, n ? -exponent : 0);
}

void ticks_power(char text[TICKS_TEXT_MAX], int exponent)
{
    static const char *const raised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    char digits[16];
    snprintf(digits, sizeof digits, "%d", exponent < 0 ? -exponent : exponent);
    snprintf(text, TICKS_TEXT_MAX, "10%s", exponent < 0 ? "\u207b" : "");
    for (const char *at = digits; *at; at++) strcat(text, raised[*at - '0']);
}

void ticks_number(char text[TICKS_TEXT_MAX], double value, int digits)
{
    assert(digits >= 1);
    assert(digits <= 9);
    if (!isfinite(value) || value == 0) {
        snprintf(text, TICKS_TEXT_MAX, "%g", value);
        return;
    }
    int exponent = (int)floor(log10(fabs(value))) - digits + 1;
    int64_t n = llround(exponent < 0 ? value * pow(10, -exponent) : value / pow(10, exponent));
    while (n % 10 == 0) {
        n /= 10;
        exponent++;
    }
    const int leading = exponent + (int)floor(log10((double)(n < 0 ? -n : n)));
    if (leading >= -3 && leading < 6) {
        write_decimal(text, n, exponent, -exponent);
        return;
    }
    char power[TICKS_TEXT_MAX];
    ticks_power(power, leading);
    if (n == 1) {
        memcpy(text, power, sizeof power);
    } else {
        char mantissa[TICKS_TEXT_MAX];
        write_decimal(mantissa, n, exponent - leading, leading - exponent);
        snprintf(text, TICKS_TEXT_MAX, "%.15s\u00b7%.14s", mantissa, power);
    }
}

/* ---- choosing ---- */

/* First and last multiple of the step inside the range; a rounding error of the ends is
 * forgiven. */
static void multiples(struct step s, double low, double high, int64_t *first, int64_t *last)
{
    const double size = step_value(s), slack = 1e-9 * (high - low) / size;
    *first = (int64_t)ceil(low / size - slack);
    *last = (int64_t)floor(high / size + slack);
}

/* The finest step that leaves at most `wanted` ticks. */
static struct step step_choose(double low, double high, uint32_t wanted)
{
    struct step best = {1, (int)ceil(log10(high - low)) + 1};
    for (struct step s = best;; s = step_finer(s)) {
        int64_t first, last;
        multiples(s, low, high, &first, &last);
        if (last - first + 1 > (int64_t)wanted) return best;
        best = s;
    }
}

struct request { enum scale scale; double range[2]; };

/* Puts the tick n * 10^exponent where it belongs, unless one is nearer than `gap`. */
static bool insert(struct ticks *ticks, const struct request *request, int64_t n, int exponent,
                   double gap)
{
    const double value = decimal(n, exponent);
    const double position = colormap_position(request->scale, request->range, value);
    uint32_t place = 0;
    while (place < ticks->count && ticks->list[place].position < position) place++;
    if (ticks->count == TICKS_MAX) return false;
    if (place < ticks->count && ticks->list[place].position - position < gap) return false;
    if (place > 0 && position - ticks->list[place - 1].position < gap) return false;
    memmove(ticks->list + place + 1, ticks->list + place,
            (ticks->count - place) * sizeof *ticks->list);
    struct tick *tick = &ticks->list[place];
    tick->value = value;
    tick->position = position;
    write_shortest(tick->text, n, exponent - ticks->exponent);
    ticks->count++;
    return true;
}

/* Numbers that would need many zeros are written in units of 10^3, 10^6, 10^-3, ... */
static int common_exponent(double low, double high)
{
    const double largest = fmax(fabs(low), fabs(high));
    if (largest >= 1e-2 && largest < 1e5) return 0;
    return 3 * (int)floor(log10(largest) / 3);
}

static void linear_ticks(struct ticks *ticks, const struct request *request, uint32_t wanted,
                         double gap)
{
    const struct step s = step_choose(request->range[0], request->range[1], wanted);
    int64_t first, last;
    multiples(s, request->range[0], request->range[1], &first, &last);
    for (int64_t k = first; k <= last; k++) insert(ticks, request, k * s.mantissa, s.exponent, gap);
    if (request->scale != SCALE_LINEAR) return;
    for (uint32_t k = 0; k < ticks->count; k++) {
        const int exponent = s.exponent - ticks->exponent;
        write_decimal(ticks->list[k].text, (first + k) * s.mantissa, exponent, -exponent);
    }
}

/* Half of the wanted ticks at equal steps; then the low end, which the root stretches, is filled
 * with ever finer ones.  A range on both sides of zero is stretched in the middle: equal steps. */
static void sqrt_ticks(struct ticks *ticks, const struct request *request, uint32_t wanted)
{
    const double gap = 0.8 / wanted, low = request->range[0];
    const uint32_t even = wanted > 4 ? (wanted + 2) / 2 : wanted < 3 ? wanted : 3;
    struct step s = step_choose(low, request->range[1], even);
    int64_t first, last;
    multiples(s, low, request->range[1], &first, &last);
    for (int64_t k = last; k >= first; k--) insert(ticks, request, k * s.mantissa, s.exponent, gap);
    for (int finer = 0; finer < 7 && low >= 0; finer++) {
        const int64_t end = decimal(first * s.mantissa, s.exponent) > low ? first : first + 1;
        const double below = (double)end * step_value(s);
        s = step_finer(s);
        multiples(s, low, below, &first, &last);
        for (int64_t k = last; k >= first && ticks->count < wanted; k--) {
            insert(ticks, request, k * s.mantissa, s.exponent, gap);
        }
    }
}

/* Tries 1, 2, 5 in each decade, then 1, 3, then the decades alone, then every second one. */
static void log_ticks(struct ticks *ticks, const struct request *request, uint32_t wanted)
{
    static const struct { int mantissas[4], decades; } sets[] = {
        {{1, 2, 5, 0}, 1}, {{1, 3, 0, 0}, 1}, {{1, 0, 0, 0}, 1}, {{1, 0, 0, 0}, 2}};
    const double high = request->range[1], low = fmax(request->range[0], high / 1000);
    const int first = (int)floor(log10(low)), last = (int)ceil(log10(high));
    for (size_t set = 0; set < sizeof sets / sizeof *sets; set++) {
        ticks->count = 0;
        uint32_t found = 0;
        for (int exponent = first; exponent <= last; exponent += sets[set].decades) {
            for (const int *m = sets[set].mantissas; *m; m++) {
                const double value = decimal(*m, exponent);
                if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
                found++;
                insert(ticks, request, *m, exponent, 0);
                ticks_number(ticks->list[ticks->count - 1].text, value, 3);
            }
        }
        if (found <= wanted) break;
    }
    if (ticks->count >= (wanted < 3 ? wanted : 3)) return;
    ticks->count = 0;
    ticks->exponent = common_exponent(low, high);
    linear_ticks(ticks, &(struct request){SCALE_LOG, {low, high}}, wanted, 0.5 / wanted);
}

void ticks_make(struct ticks *ticks, enum scale scale, const double range[2], uint32_t wanted)
{
    assert(wanted >= 2);
    assert(wanted <= TICKS_MAX);
    const struct request request = {scale, {range[0], range[1]}};
    *ticks = (struct ticks){0};
    const double largest = fmax(fabs(range[0]), fabs(range[1]));
    if (!isfinite(range[0]) || !isfinite(range[1])) return;
    if (!(range[1] - range[0] > 1e-11 * largest) || (scale == SCALE_LOG && !(range[1] > 0))) {
        ticks->count = 1;
        ticks->list[0].value = range[0];
        ticks_number(ticks->list[0].text, range[0], 4);
        return;
    }
    if (scale == SCALE_LOG) {
        log_ticks(ticks, &request, wanted);
        return;
    }
    ticks->exponent = common_exponent(range[0], range[1]);
    if (scale == SCALE_SQRT) sqrt_ticks(ticks, &request, wanted);
    else linear_ticks(ticks, &request, wanted, 0);
}
