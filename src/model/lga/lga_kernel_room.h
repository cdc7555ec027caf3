/* lga_kernel_room.h - who finds room on the nodes of the GMLG, as logic on vectors of nodes: part
 * of lga_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Few nodes have more arrivals than room, and few movers can not leave, so the dice for them are
 * rolled late.
 */

/* What room a row's nodes have, in three bits, and which of them are full: before the tick.  Tells
 * what the row holds. */
KERNEL_TARGET static enum lga_holds N(survey)(const struct lga_row_survey *row)
{
    const uint32_t words = row->words;
    vec moves = {0}, rests = {0};
    for (uint32_t w = 0; w < words; w += KERNEL_WIDTH) {
        vec m[6], rest[3], load[3];
        for (uint32_t d = 0; d < 6; d++) m[d] = N(load)(row->planes + d * words + w);
        for (uint32_t k = 0; k < 3; k++) rest[k] = N(load)(row->planes + (6 + k) * words + w);
        const struct N(tally) movers = N(tallied)(m);
        vec carry = {0};
        for (int k = 0; k < 3; k++) {
            load[k] = N(odd)(rest[k], movers.all[k], carry);
            carry = N(most)(rest[k], movers.all[k], carry);
        }
        for (uint32_t k = 0; k < 3; k++) {
            N(store)(row->room + k * row->stride + w, ~(load[k] | carry));
        }
        const vec full = (load[0] & load[1] & load[2]) | carry | N(load)(row->wall + w);
        N(store)(row->full + w, full & ~(row->sink ? N(load)(row->sink + w) : (vec){0}));
        moves |= movers.all[0] | movers.all[1] | movers.all[2];
        rests |= rest[0] | rest[1] | rest[2];
    }
    return N(any)(moves) ? LGA_HOLDS_MOVERS : N(any)(rests) ? LGA_HOLDS_REST : LGA_HOLDS_NOTHING;
}

/* --- who is let in --- */

/* a - b in three bits. */
INLINE void N(difference)(const vec a[3], const vec b[3], vec out[3])
{
    vec borrow = {0};
    for (int k = 0; k < 3; k++) {
        out[k] = N(odd)(a[k], b[k], borrow);
        borrow = N(most)(~a[k], b[k], borrow);
    }
}

/* a > b */
INLINE vec N(exceeds)(const vec a[3], const vec b[3])
{
    vec more = {0};
    for (int k = 0; k < 3; k++) more = N(most)(a[k], ~b[k], more);
    return more;
}

/* Where the dice of a block begin: of three, of five, and six coins. */
INLINE uint32_t N(admission)(uint32_t block)
{
    return block / LGA_LANES * (2 * LGA_CUT_BITS + 6);
}

/* Leaves of the `waiting` of `crowded` nodes as many as there is room for: picks those who may
 * come, or those who may not, whichever are fewer: three at most.  Apart from the loop that asks
 * for it, because that seldom does. */
KERNEL_TARGET __attribute__((noinline))
static void N(let_in)(const struct lga_row_admit *row, struct N(late) *late, uint32_t block, int p,
                      vec waiting[6], const vec count[3], const vec room[3], vec crowded)
{
    const uint32_t at = N(admission)(block);
    vec excess[3], left[6], chosen[6], picked[6] = {{0}};
    for (int d = 0; d < 6; d++) left[d] = waiting[d];
    N(difference)(count, room, excess);
    const vec refuse = N(exceeds)(room, excess), one = ~N(is_zero)(room) & crowded;
    const vec two = one & (room[1] | room[2]) & (excess[1] | excess[2]);
    const vec three = two & count[2] & count[1] & room[0] & room[1];
    const vec again[3] = {one, two, three};
    struct N(pick) pick = {.third = {0}, .fifth = {0}};
    if (N(any)(one & (count[2] | (count[1] & count[0])))) {
        N(reach)(late, p, row->source, at, LGA_CUT_BITS);
        pick.third = N(draw_known)(&late->s, p, LGA_CUT_THIRD);
    }
    if (N(any)(one & count[2] & (count[1] | count[0]))) {
        N(reach)(late, p, row->source, at + LGA_CUT_BITS, LGA_CUT_BITS);
        pick.fifth = N(draw_known)(&late->s, p, LGA_CUT_FIFTH);
    }
    for (uint32_t k = 0; k < 3 && N(any)(again[k]); k++) {
        N(reach)(late, p, row->source, at + 2 * LGA_CUT_BITS + 2 * k, 2);
        pick.coin = N(next)(&late->s, p);
        pick.second = N(next)(&late->s, p);
        if (k == 2) pick.third = pick.fifth = (vec){0};
        N(choose)(left, N(tallied)(left), again[k], pick, chosen);
        for (int d = 0; d < 6; d++) {
            picked[d] |= chosen[d];
            left[d] &= ~chosen[d];
        }
    }
    for (int d = 0; d < 6; d++) {
        waiting[d] &= ~crowded | N(either)(refuse, ~picked[d], picked[d]);
    }
}

/* Which of a vector of nodes have more arrivals than room?  Sends some of these away and counts
 * them. */
INLINE uint64_t N(refuse)(const struct lga_row_admit *row, struct N(late) *late, uint32_t block,
                          int p, const vec waiting[6], vec arriving[6])
{
    const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
    const struct N(tally) came = N(tallied)(waiting);
    vec room[3], out[6];
    for (uint32_t k = 0; k < 3; k++) room[k] = N(load)(row->room + k * row->stride + w);
    const vec crowded = N(exceeds)(came.all, room);
    if (!N(any)(crowded)) return 0;
    for (int d = 0; d < 6; d++) out[d] = waiting[d];
    N(let_in)(row, late, block, p, out, came.all, room, crowded);
    const vec real = N(load)(row->real + w);
    for (int d = 0; d < 6; d++) {
        out[d] = waiting[d] & ~out[d];
        arriving[d] &= ~out[d];
        out[d] &= real;
    }
    return N(count_six)(out);
}

KERNEL_TARGET static uint64_t N(admit)(const struct lga_row_admit *row)
{
    const uint32_t words = row->words, stride = row->stride;
    uint64_t refused = 0;
    struct N(late) late = {.begun = {false}};
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            const vec fluid = ~N(load)(row->wall + w);
            vec arriving[6], waiting[6];
            for (uint32_t d = 0; d < 6; d++) {
                arriving[d] = N(load)(row->from[d] + w) & fluid;
                waiting[d] = arriving[d] & ~N(load)(row->own + (d + 3) % 6 * stride + w);
            }
            if (row->crowds) refused += N(refuse)(row, &late, block, p, waiting, arriving);
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * stride + w, arriving[d]);
        }
    }
    return refused;
}

/* The movers of a vector of nodes that could not leave stop where there is room, or go back. */
INLINE void N(turn_back)(const struct lga_row_arrive *row, struct N(late) *late, uint32_t block,
                         int p, const vec stays[6], vec next[6], vec rest[3])
{
    const struct lga_die die = row->dice->of[LGA_DIE_STOP];     /* the same for all six */
    const uint32_t bits = (uint32_t)die.bits, at = block / LGA_LANES * 6 * bits;
    for (uint32_t d = 0; d < 6; d++) {
        if (!N(any)(stays[d])) continue;
        N(reach)(late, p, row->source, at + d * bits, bits);
        const vec room = ~(rest[0] & rest[1] & rest[2]);
        const vec stops = stays[d] & N(draw)(&late->s, p, die) & room;
        N(add_bit)(rest, stops);
        next[(d + 3) % 6] |= stays[d] & ~stops;
    }
}

/* Grains come, and those that could not leave stop or go back; returns how many sank. */
KERNEL_TARGET static uint64_t N(arrive)(const struct lga_row_arrive *row)
{
    const uint32_t words = row->words, stride = row->stride;
    uint64_t gone = 0;
    struct N(late) late = {.begun = {false}};
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec next[6], rest[3], stays[6] = {{0}}, stuck = {0};
            for (uint32_t d = 0; d < 6; d++) next[d] = N(load)(row->own_admitted + d * stride + w);
            for (uint32_t k = 0; k < 3; k++) rest[k] = N(load)(row->rest + k * row->apart + w);
            if (row->sink) {
                const vec sink = N(load)(row->sink + w);
                for (int d = 0; d < 6; d++) {
                    gone += N(count)(next[d] & sink);
                    next[d] &= ~sink;
                }
            }
            for (uint32_t d = 0; d < 6 && row->blocks; d++) {
                stays[d] = N(load)(row->own + d * stride + w) & ~N(load)(row->admitted[d] + w);
                stuck |= stays[d];
            }
            if (N(any)(stuck)) N(turn_back)(row, &late, block, p, stays, next, rest);
            if (row->held) {
                const vec wall = N(load)(row->wall + w);
                for (uint32_t d = 0; d < 6; d++) {
                    next[d] |= wall & N(load)(row->out + d * words + w);
                }
                for (uint32_t k = 0; k < 3; k++) {
                    rest[k] |= wall & N(load)(row->out + (6 + k) * words + w);
                }
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * words + w, next[d]);
            for (uint32_t k = 0; k < 3; k++) N(store)(row->out + (6 + k) * words + w, rest[k]);
        }
    }
    return gone;
}
