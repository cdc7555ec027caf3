/* lga_kernel_gmlg.h - the rules of the GMLG as logic on vectors of nodes: part of lga_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Small numbers of a node (rest grains, room, ranks) are three planes of bits, the lowest first.
 */

/* number += bit; returns the carry. */
INLINE vec N(add_bit)(vec number[3], vec bit)
{
    for (int k = 0; k < 3; k++) {
        const vec carry = number[k] & bit;
        number[k] ^= bit;
        bit = carry;
    }
    return bit;
}

INLINE void N(subtract_bit)(vec number[3], vec bit)
{
    for (int k = 0; k < 3; k++) {
        number[k] ^= bit;
        bit &= number[k];
    }
}

INLINE vec N(is_zero)(const vec number[3]) { return ~(number[0] | number[1] | number[2]); }

/* How many of the planes are set. */
INLINE uint64_t N(count_six)(const vec planes[6])
{
    if (!N(any)(planes[0] | planes[1] | planes[2] | planes[3] | planes[4] | planes[5])) return 0;
    vec sum[3] = {{0}};
    for (int d = 0; d < 6; d++) N(add_bit)(sum, planes[d]);
    return N(count)(sum[0]) + 2 * N(count)(sum[1]) + 4 * N(count)(sum[2]);
}

/* What room a row's nodes have, in three bits, and which of them are full: before the tick. */
KERNEL_TARGET static void N(survey)(const struct lga_row_survey *row)
{
    const uint32_t words = row->words;
    for (uint32_t w = 0; w < words; w += KERNEL_WIDTH) {
        vec load[3], more = {0};
        for (uint32_t k = 0; k < 3; k++) load[k] = N(load)(row->planes + (6 + k) * words + w);
        for (uint32_t d = 0; d < 6; d++) {
            more |= N(add_bit)(load, N(load)(row->planes + d * words + w));
        }
        for (uint32_t k = 0; k < 3; k++) {
            N(store)(row->room + k * row->stride + w, ~(load[k] | more));
        }
        const vec full = (load[0] & load[1] & load[2]) | more | N(load)(row->wall + w);
        N(store)(row->full + w, full & ~(row->sink ? N(load)(row->sink + w) : (vec){0}));
    }
}

/* One of the members of a set, all with equal chance: dice.  `count` is their number. */
struct N(pick) { vec third, fifth, coin, second; };

INLINE void N(choose)(const vec set[6], const vec count[3], struct N(pick) dice, vec chosen[6])
{
    const vec middle = ~dice.third & dice.coin, last = ~dice.third & ~dice.coin;  /* of three */
    const vec two = count[1] & ~count[0], three = count[1] & count[0];
    const vec four = count[2] & ~count[1] & ~count[0], five = count[2] & count[0];
    const vec six = count[2] & count[1];
    const vec most = four | (five & ~dice.fifth);
    /* Of 2 by a coin, of 4 by two; of 5 the last, or else as of 4; of 6 as of 3, and a coin. */
    const vec rank[3] = {
        (two & ~count[2] & dice.coin) | (three & middle) | (most & dice.second)
            | (six & dice.second),
        (three & last) | (most & dice.coin) | (six & middle),
        (five & dice.fifth) | (six & last)
    };
    vec before[3] = {{0}};
    for (int d = 0; d < 6; d++) {
        chosen[d] = set[d] & ~((before[0] ^ rank[0]) | (before[1] ^ rank[1])
                               | (before[2] ^ rank[2]));
        N(add_bit)(before, set[d]);
    }
}

/* Which head-on pairs of a lossy collision find room to stop, if not all of them do. */
INLINE void N(make_way)(vec pair[3], const vec rest[3], vec side, vec first, vec second)
{
    const vec one = rest[2] & ~rest[1], two = ~rest[2] & rest[1], none = rest[2] & rest[1];
    const vec all = pair[0] & pair[1] & pair[2];
    const vec both = ((pair[0] & pair[1]) | (pair[1] & pair[2]) | (pair[0] & pair[2])) & ~all;
    const vec low[3] = {pair[0], pair[1] & ~pair[0], (vec){0}};
    const vec high[3] = {(vec){0}, pair[1] & ~pair[2], pair[2]};
    const vec way[3] = {first, ~first & second, ~first & ~second};
    for (int i = 0; i < 3; i++) {
        const vec chosen = (side & low[i]) | (~side & high[i]);
        pair[i] &= ~none;
        pair[i] &= ~(one & both) | chosen;
        pair[i] &= ~(one & all) | way[i];
        pair[i] &= ~(two & all) | ~way[2 - i];
    }
}

/* The lossy column: pairs stop, then a triple, or else {i-1, i+1} merge, one way of two where pairs
 * are left (`tight`).  Returns which nodes have changed. */
INLINE vec N(lose)(vec m[6], vec rest[3], const vec pair[3], vec side, bool tight)
{
    vec left[6], sum[3] = {{0}}, merge[6];
    for (int d = 0; d < 6; d++) left[d] = m[d] & ~pair[d % 3];
    for (int i = 0; i < 3; i++) N(add_bit)(sum, pair[i]);
    const vec stopped = sum[0] | sum[1];
    /* rest + 2 sum */
    vec carry = rest[1] & sum[0];
    rest[1] ^= sum[0];
    rest[2] ^= sum[1] ^ carry;
    const vec fits = ~rest[2] | (~rest[1] & ~rest[0]), room = ~(rest[0] & rest[1] & rest[2]);
    const vec triple = ((left[0] & left[2] & left[4] & ~(left[1] | left[3] | left[5]))
                        | (left[1] & left[3] & left[5] & ~(left[0] | left[2] | left[4]))) & fits;
    vec merged = {0};
    for (int i = 0; i < 6; i++) {
        merge[i] = left[(i + 5) % 6] & left[(i + 1) % 6] & ~left[i] & ~left[(i + 3) % 6] & room;
    }
    for (int i = 0; i < 3 && tight; i++) {
        const vec both = merge[i] & merge[i + 3];
        merge[i] &= ~both | side;
        merge[i + 3] &= ~both | ~side;
    }
    for (int i = 0; i < 6; i++) merged |= merge[i];
    for (int d = 0; d < 6; d++) {
        m[d] = (left[d] & ~triple & ~merge[(d + 1) % 6] & ~merge[(d + 5) % 6]) | merge[d];
    }
    N(add_bit)(rest, triple | merged);
    carry = rest[1] & triple;
    rest[1] ^= triple;
    rest[2] ^= carry;
    return stopped | triple | merged;
}

/* Collides the nodes of a vector. */
INLINE vec N(collide_gmlg)(vec m[6], vec rest[3], vec side, vec kick, vec loss, const vec way[2],
                           bool tight)
{
    vec lossy[6], lossy_rest[3], elastic[6], elastic_rest[3], pair[3];
    for (int d = 0; d < 6; d++) lossy[d] = elastic[d] = m[d];
    for (int k = 0; k < 3; k++) lossy_rest[k] = elastic_rest[k] = rest[k];
    for (int i = 0; i < 3; i++) pair[i] = m[i] & m[i + 3];
    if (tight) N(make_way)(pair, rest, side, way[0], way[1]);
    vec splits, merges;
    const vec resting = rest[0] | rest[1] | rest[2], full = rest[0] & rest[1] & rest[2];
    const vec hit = N(scatter)(elastic, resting & kick, ~full, side, &splits, &merges);
    N(subtract_bit)(elastic_rest, splits);
    N(add_bit)(elastic_rest, merges);
    const vec lost = N(lose)(lossy, lossy_rest, pair, side, tight);
    for (int d = 0; d < 6; d++) m[d] = (lossy[d] & loss) | (elastic[d] & ~loss);
    for (int k = 0; k < 3; k++) rest[k] = (lossy_rest[k] & loss) | (elastic_rest[k] & ~loss);
    return (lost & loss) | (hit & ~loss);
}

/* Gravity on a rest grain that may start: straight down, or rolling where it is held by one side
 * only, unless friction keeps it. */
INLINE void N(start_vertical)(vec m[6], vec rest[3], vec starts, vec left, const vec full[6],
                              vec kept_left, vec kept_right)
{
    const vec rolls = starts & full[3];
    const vec go3 = starts & ~full[3] & ~m[3];
    const vec go2 = rolls & left & ~full[2] & ~m[2] & ~kept_left;
    const vec go4 = rolls & ~left & ~full[4] & ~m[4] & ~kept_right;
    m[2] |= go2;
    m[3] |= go3;
    m[4] |= go4;
    N(subtract_bit)(rest, go2 | go3 | go4);
}

INLINE void N(start_level)(vec m[6], vec rest[3], vec starts, vec left, const vec full[6],
                           vec kept_left, vec kept_right)
{
    const vec go4 = starts & left & ~full[4] & ~m[4] & ~(full[5] & kept_left);
    const vec go5 = starts & ~left & ~full[5] & ~m[5] & ~(full[4] & kept_right);
    m[4] |= go4;
    m[5] |= go5;
    N(subtract_bit)(rest, go4 | go5);
}

/* The movers that gravity can bend: down there is a free slot, and no full node. */
INLINE void N(able_vertical)(const vec m[6], const vec full[6], vec able[6])
{
    const vec free2 = ~m[2] & ~full[2], free3 = ~m[3] & ~full[3], free4 = ~m[4] & ~full[4];
    able[0] = m[0] & free3;
    able[1] = m[1] & free2;
    able[2] = m[2] & free3;
    able[3] = (vec){0};
    able[4] = m[4] & free3;
    able[5] = m[5] & free4;
}

INLINE void N(able_level)(const vec m[6], const vec full[6], vec left, vec able[6])
{
    const vec free4 = ~m[4] & ~full[4], free5 = ~m[5] & ~full[5];
    able[0] = m[0] & free5;
    able[1] = m[1] & free5;
    able[2] = m[2] & free4;
    able[3] = m[3] & free4;
    able[4] = m[4] & free5 & ~left;
    able[5] = m[5] & free4 & left;
}

/* One of them, `from`, bends. */
INLINE void N(bend_vertical)(vec m[6], const vec from[6])
{
    m[0] ^= from[0];
    m[1] ^= from[1];
    m[2] ^= from[2] | from[1];
    m[3] ^= from[0] | from[2] | from[4];
    m[4] ^= from[4] | from[5];
    m[5] ^= from[5];
}

INLINE void N(bend_level)(vec m[6], const vec from[6])
{
    for (int d = 0; d < 4; d++) m[d] ^= from[d];
    m[4] ^= from[2] | from[3] | from[5] | from[4];
    m[5] ^= from[0] | from[1] | from[4] | from[5];
}

/* What a block of nodes draws. */
struct N(rolled) {
    vec side[PARTS], kick[PARTS], loss[PARTS], falls[PARTS], left[PARTS], bends[PARTS],
        bends_left[PARTS], third[PARTS], fifth[PARTS], coin[PARTS], second[PARTS], way[2][PARTS],
        kept[2][PARTS];
};

/* Gravity on a vector of nodes that have collided. */
INLINE void N(fall_gmlg)(const struct lga_row_gmlg *row, const struct N(rolled) *rolled, uint32_t w,
                         int p, vec had_movers, bool vertical, vec m[6], vec rest[3])
{
    vec full[6], able[6], count[3] = {{0}}, from[6];
    for (int d = 2; d < 6; d++) full[d] = N(load)(row->full[d] + w);
    full[0] = full[1] = (vec){0};
    const vec starts = ~N(is_zero)(rest) & rolled->falls[p];
    const vec kept_left = rolled->kept[0][p] & ~had_movers;
    const vec kept_right = rolled->kept[1][p] & ~had_movers;
    if (vertical) {
        N(start_vertical)(m, rest, starts, rolled->left[p], full, kept_left, kept_right);
    } else {
        N(start_level)(m, rest, starts, rolled->left[p], full, kept_left, kept_right);
    }
    if (vertical) N(able_vertical)(m, full, able);
    else N(able_level)(m, full, rolled->bends_left[p], able);
    for (int d = 0; d < 6; d++) N(add_bit)(count, able[d]);
    const struct N(pick) dice = {rolled->third[p], rolled->fifth[p], rolled->coin[p],
                                 rolled->second[p]};
    N(choose)(able, count, dice, from);
    for (int d = 0; d < 6; d++) from[d] &= rolled->bends[p];
    if (vertical) N(bend_vertical)(m, from);
    else N(bend_level)(m, from);
}

INLINE void N(roll_gmlg)(const struct lga_die *of, struct N(stream) *s, struct N(stream) *ways,
                         struct N(stream) *friction, bool gravity, struct N(rolled) *rolled)
{
    N(roll)(s, of[LGA_DIE_SIDE], rolled->side);
    N(roll)(s, of[LGA_DIE_KICK], rolled->kick);
    N(roll)(s, of[LGA_DIE_LOSS], rolled->loss);
    for (int p = 0; p < PARTS && !ways; p++) rolled->way[0][p] = rolled->way[1][p] = (vec){0};
    if (ways) N(roll)(ways, of[LGA_DIE_WAY_THIRD], rolled->way[0]);
    if (ways) N(roll)(ways, of[LGA_DIE_WAY_SIDE], rolled->way[1]);
    if (!gravity) return;
    N(roll)(s, of[LGA_DIE_FALL], rolled->falls);
    N(roll)(s, of[LGA_DIE_FALL_SIDE], rolled->left);
    N(roll)(s, of[LGA_DIE_BEND], rolled->bends);
    N(roll)(s, of[LGA_DIE_BEND_SIDE], rolled->bends_left);
    N(roll)(s, of[LGA_DIE_PICK_THIRD], rolled->third);
    N(roll)(s, of[LGA_DIE_PICK_FIFTH], rolled->fifth);
    N(roll)(s, of[LGA_DIE_PICK_COIN], rolled->coin);
    N(roll)(s, of[LGA_DIE_PICK_SECOND], rolled->second);
    N(roll)(friction, of[LGA_DIE_FRICTION_LEFT], rolled->kept[0]);
    N(roll)(friction, of[LGA_DIE_FRICTION_RIGHT], rolled->kept[1]);
}

/* A row collides and falls. */
INLINE uint64_t N(gmlg_effects)(const struct lga_row_gmlg *row, unsigned effects)
{
    const uint32_t words = row->words, stride = row->stride;
    const bool tight = effects & LGA_BITS_TIGHT, gravity = effects & LGA_BITS_GRAVITY;
    uint64_t collisions = 0;
    struct N(stream) s, ways, friction;
    N(seed)(&s, row->key[LGA_STAGE_COLLIDE]);
    if (tight) N(seed)(&ways, row->key[LGA_STAGE_WAYS]);
    friction = s;
    if (row->dice->of[LGA_DIE_FRICTION_LEFT].bits) {
        N(seed)(&friction, row->key[LGA_STAGE_FRICTION]);
    }
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        struct N(rolled) rolled;
        N(roll_gmlg)(row->dice->of, &s, tight ? &ways : NULL, &friction, gravity, &rolled);
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec m[6], rest[3], had_movers = {0};
            for (uint32_t d = 0; d < 6; d++) m[d] = N(load)(row->in + d * words + w);
            for (uint32_t k = 0; k < 3; k++) rest[k] = N(load)(row->in + (6 + k) * words + w);
            if (row->held) {
                const vec fluid = ~N(load)(row->wall + w);
                for (int d = 0; d < 6; d++) m[d] &= fluid;
                for (int k = 0; k < 3; k++) rest[k] &= fluid;
            }
            for (int d = 0; d < 6; d++) had_movers |= m[d];
            const vec way[2] = {rolled.way[0][p], rolled.way[1][p]};
            const vec hit = N(collide_gmlg)(m, rest, rolled.side[p], rolled.kick[p],
                                            rolled.loss[p], way, tight);
            collisions += N(count)(hit);
            if (row->hits) N(note)(row->hits, words, w, hit);
            if (gravity) {
                N(fall_gmlg)(row, &rolled, w, p, had_movers, effects & LGA_BITS_VERTICAL, m, rest);
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * stride + w, m[d]);
            for (uint32_t k = 0; k < 3; k++) N(store)(row->out + (6 + k) * stride + w, rest[k]);
        }
    }
    return collisions;
}

/* --- who is let in --- */

struct N(admission) { vec third[PARTS], fifth[PARTS], coin[6][PARTS]; };

/* a - b in three bits. */
INLINE void N(difference)(const vec a[3], const vec b[3], vec out[3])
{
    vec borrow = {0};
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] ^ b[k] ^ borrow;
        borrow = (~a[k] & (b[k] | borrow)) | (b[k] & borrow);
    }
}

/* a > b */
INLINE vec N(exceeds)(const vec a[3], const vec b[3])
{
    vec more = {0};
    for (int k = 0; k < 3; k++) more = (a[k] & ~b[k]) | (~(a[k] ^ b[k]) & more);
    return more;
}

/* Leaves as many of the `waiting` as there is room for: picks those who may come, or those who may
 * not, whichever are fewer: three at most. */
INLINE void N(let_in)(vec waiting[6], const vec room[3], const struct N(admission) *dice, int p)
{
    vec count[3] = {{0}}, excess[3], left[6], chosen[6], picked[6] = {{0}};
    for (int d = 0; d < 6; d++) {
        N(add_bit)(count, waiting[d]);
        left[d] = waiting[d];
    }
    const vec crowded = N(exceeds)(count, room);
    N(difference)(count, room, excess);
    const vec refuse = N(exceeds)(room, excess), one = ~N(is_zero)(room) & crowded;
    const vec two = one & (room[1] | room[2]) & (excess[1] | excess[2]);
    const vec three = two & count[2] & count[1] & room[0] & room[1];
    const vec again[3] = {one, two, three};
    for (int k = 0; k < 3 && N(any)(again[k]); k++) {
        const vec zero = {0};
        const struct N(pick) pick = {k < 2 ? dice->third[p] : zero, k < 2 ? dice->fifth[p] : zero,
                                     dice->coin[2 * k][p], dice->coin[2 * k + 1][p]};
        N(choose)(left, count, pick, chosen);
        for (int d = 0; d < 6; d++) {
            picked[d] |= chosen[d] & again[k];
            left[d] &= ~chosen[d];
        }
        N(subtract_bit)(count, ~N(is_zero)(count));
    }
    for (int d = 0; d < 6; d++) {
        const vec admitted = (refuse & ~picked[d]) | (~refuse & picked[d]);
        waiting[d] &= ~crowded | admitted;
    }
}

KERNEL_TARGET static uint64_t N(admit)(const struct lga_row_admit *row)
{
    const uint32_t words = row->words, stride = row->stride;
    const struct lga_die *of = row->dice->of;
    uint64_t refused = 0;
    struct N(stream) s;
    N(seed)(&s, row->key);
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        struct N(admission) dice;
        if (row->crowds) {
            N(roll)(&s, of[LGA_DIE_ADMIT_THIRD], dice.third);
            N(roll)(&s, of[LGA_DIE_ADMIT_FIFTH], dice.fifth);
            for (int k = 0; k < 6; k++) N(roll)(&s, of[LGA_DIE_ADMIT_COIN + k], dice.coin[k]);
        }
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            const vec fluid = ~N(load)(row->wall + w);
            vec arriving[6], waiting[6], room[3];
            for (uint32_t d = 0; d < 6; d++) {
                arriving[d] = N(load)(row->from[d] + w) & fluid;
                waiting[d] = arriving[d] & ~N(load)(row->own + (d + 3) % 6 * stride + w);
            }
            if (row->crowds) {
                vec out[6];
                const vec real = N(load)(row->real + w);
                for (uint32_t k = 0; k < 3; k++) room[k] = N(load)(row->room + k * stride + w);
                for (int d = 0; d < 6; d++) out[d] = waiting[d];
                N(let_in)(out, room, &dice, p);
                for (int d = 0; d < 6; d++) {
                    out[d] = waiting[d] & ~out[d];
                    arriving[d] &= ~out[d];
                    out[d] &= real;
                }
                refused += N(count_six)(out);
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * stride + w, arriving[d]);
        }
    }
    return refused;
}

/* Grains come, and those that could not leave stop or go back; returns how many sank. */
KERNEL_TARGET static uint64_t N(arrive)(const struct lga_row_arrive *row)
{
    const uint32_t words = row->words, stride = row->stride;
    uint64_t gone = 0;
    struct N(stream) s;
    N(seed)(&s, row->key);
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        vec stop[6][PARTS];
        for (int d = 0; d < 6 && row->blocks; d++) {
            N(roll)(&s, row->dice->of[LGA_DIE_STOP + d], stop[d]);
        }
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec next[6], rest[3];
            for (uint32_t d = 0; d < 6; d++) next[d] = N(load)(row->own_admitted + d * stride + w);
            for (uint32_t k = 0; k < 3; k++) rest[k] = N(load)(row->own + (6 + k) * stride + w);
            if (row->sink) {
                const vec sink = N(load)(row->sink + w);
                for (int d = 0; d < 6; d++) {
                    gone += N(count)(next[d] & sink);
                    next[d] &= ~sink;
                }
            }
            for (uint32_t d = 0; d < 6 && row->blocks; d++) {
                const vec stays = N(load)(row->own + d * stride + w)
                                & ~N(load)(row->admitted[d] + w);
                const vec stops = stays & stop[d][p] & ~(rest[0] & rest[1] & rest[2]);
                N(add_bit)(rest, stops);
                next[(d + 3) % 6] |= stays & ~stops;
            }
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
