/* lga_kernel_gmlg.h - how nodes of the GMLG collide and fall, as logic on vectors of nodes: part of
 * lga_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */

/* Collides nodes of at most seven grains, so that all who stop find room.  Both columns at once:
 * they share the turns {i-1, i+1} -> {i}, and their other cases exclude each other. */
INLINE vec N(collide_roomy)(vec m[6], vec rest[3], vec side, vec kick, vec loss)
{
    vec alone[6], none[3], turn[6], pair[3], stop[3], rotate[3], splits = {0};
    for (int i = 0; i < 3; i++) {
        alone[i] = m[i] & ~m[i + 3];
        alone[i + 3] = m[i + 3] & ~m[i];
        none[i] = ~(m[i] | m[i + 3]);
        pair[i] = m[i] & m[i + 3];
        stop[i] = pair[i] & loss;
    }
    const vec triple = (alone[0] & alone[2] & alone[4]) | (alone[1] & alone[3] & alone[5]);
    const vec lost = triple & loss, swapped = triple & ~loss;
    const vec kicked = (rest[0] | rest[1] | rest[2]) & kick & ~loss;
    for (int i = 0; i < 3; i++) {
        const vec others = none[(i + 1) % 3] & none[(i + 2) % 3], can_split = others & kicked;
        /* Two merge if nothing is left on the axis between them: pairs stop first. */
        const vec open = none[i] | stop[i];
        for (int d = i; d < 6; d += 3) {
            turn[d] = (alone[(d + 5) % 6] & alone[(d + 1) % 6] & open) | (alone[d] & can_split);
        }
        splits |= (m[i] ^ m[i + 3]) & can_split;
        rotate[i] = pair[i] & others & ~loss;
    }
    const vec turned = turn[0] | turn[1] | turn[2] | turn[3] | turn[4] | turn[5];
    vec flip[3];
    for (int i = 0; i < 3; i++) {
        flip[i] = N(either)(side, rotate[(i + 2) % 3], rotate[(i + 1) % 3]) | swapped
                | rotate[i] | stop[i];
    }
    for (int d = 0; d < 6; d++) {
        m[d] = N(odd)(m[d], flip[d % 3], turn[(d + 5) % 6] | turn[d] | turn[(d + 1) % 6]) & ~lost;
    }
    /* rest + merges - splits + 2 for each pair that stops + 3 for a triple; -1 is 7. */
    const vec one = turned | lost, carry = rest[0] & one;
    const vec two = N(odd)(stop[0], stop[1], stop[2]) | lost | splits;
    const vec four = N(most)(stop[0], stop[1], stop[2]) | splits;
    rest[0] ^= one;
    rest[2] = N(odd)(rest[2], four, N(most)(rest[1], carry, two));
    rest[1] = N(odd)(rest[1], carry, two);
    return turned | triple | flip[0] | flip[1] | flip[2];
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
 * are left.  Returns which nodes have changed. */
INLINE vec N(lose)(vec m[6], vec rest[3], const vec pair[3], vec side)
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
    for (int i = 0; i < 3; i++) {
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

/* Collides nodes of any number of grains: what finds no room does not happen. */
INLINE vec N(collide_tight)(vec m[6], vec rest[3], vec side, vec kick, vec loss, const vec way[2])
{
    vec lossy[6], lossy_rest[3], elastic[6], elastic_rest[3], pair[3];
    for (int d = 0; d < 6; d++) lossy[d] = elastic[d] = m[d];
    for (int k = 0; k < 3; k++) lossy_rest[k] = elastic_rest[k] = rest[k];
    for (int i = 0; i < 3; i++) pair[i] = m[i] & m[i + 3];
    N(make_way)(pair, rest, side, way[0], way[1]);
    vec splits, merges;
    const vec resting = rest[0] | rest[1] | rest[2], full = rest[0] & rest[1] & rest[2];
    const vec hit = N(scatter)(elastic, resting & kick, ~full, side, &splits, &merges);
    N(subtract_bit)(elastic_rest, splits);
    N(add_bit)(elastic_rest, merges);
    const vec lost = N(lose)(lossy, lossy_rest, pair, side);
    for (int d = 0; d < 6; d++) m[d] = N(either)(loss, lossy[d], elastic[d]);
    for (int k = 0; k < 3; k++) rest[k] = N(either)(loss, lossy_rest[k], elastic_rest[k]);
    return N(either)(loss, lost, hit);
}

/* Where a node holds more than seven grains, all is done in the longer way. */
INLINE vec N(collide_gmlg)(const struct lga_row_gmlg *row, struct N(late) *ways, uint32_t block,
                           int p, vec m[6], vec rest[3], vec side, vec kick, vec loss)
{
    const struct N(tally) movers = N(tallied)(m);
    const vec carry = N(most)(rest[1], movers.all[1], rest[0] & movers.all[0]);
    if (!N(any)(N(most)(rest[2], movers.all[2], carry))) {
        return N(collide_roomy)(m, rest, side, kick, loss);
    }
    N(reach)(ways, p, row->ways, block / LGA_LANES * (LGA_CUT_BITS + 1), LGA_CUT_BITS + 1);
    const vec third = N(draw_known)(&ways->s, p, LGA_CUT_THIRD);
    const vec way[2] = {third, N(next)(&ways->s, p)};
    return N(collide_tight)(m, rest, side, kick, loss, way);
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

/* Dice for a choice among those who are able to bend.  They are never more than four (H: two to
 * either side; V: three, as those who fly where others would bend to are in their way), so `fifth`
 * is passed over, and so is `third` where no node needs it. */
INLINE struct N(pick) N(roll_pick)(struct N(stream) *s, int p, const vec count[3], vec bends)
{
    struct N(pick) dice = {.third = {0}, .fifth = {0}};
    if (N(any)(bends & count[1] & count[0])) dice.third = N(draw_known)(s, p, LGA_CUT_THIRD);
    else N(skip)(s, p, LGA_CUT_BITS);
    N(skip)(s, p, LGA_CUT_BITS);
    dice.coin = N(next)(s, p);
    dice.second = N(next)(s, p);
    return dice;
}

/* Gravity on a vector of nodes that have collided; the grains that had movers before are not held
 * by friction. */
INLINE void N(fall_gmlg)(const struct lga_row_gmlg *row, struct N(stream) *s,
                         struct N(stream) *friction, uint32_t w, int p, vec had_movers,
                         bool vertical, vec m[6], vec rest[3])
{
    const struct lga_die *of = row->dice->of;
    const vec falls = N(draw)(s, p, of[LGA_DIE_FALL]);
    const vec left = N(draw)(s, p, of[LGA_DIE_FALL_SIDE]);
    const vec bends = N(draw)(s, p, of[LGA_DIE_BEND]);
    const vec bends_left = N(draw)(s, p, of[LGA_DIE_BEND_SIDE]);
    const vec kept_left = N(draw)(friction, p, of[LGA_DIE_FRICTION_LEFT]) & ~had_movers;
    const vec kept_right = N(draw)(friction, p, of[LGA_DIE_FRICTION_RIGHT]) & ~had_movers;
    const vec starts = (rest[0] | rest[1] | rest[2]) & falls;
    vec full[6] = {{0}}, able[6], from[6];
    for (int d = 2; d < 6; d++) full[d] = N(load)(row->full[d] + w);
    if (vertical) N(start_vertical)(m, rest, starts, left, full, kept_left, kept_right);
    else N(start_level)(m, rest, starts, left, full, kept_left, kept_right);
    if (vertical) N(able_vertical)(m, full, able);
    else N(able_level)(m, full, bends_left, able);
    const struct N(tally) t = N(tallied)(able);
    N(choose)(able, t, bends, N(roll_pick)(s, p, t.all, bends), from);
    if (vertical) N(bend_vertical)(m, from);
    else N(bend_level)(m, from);
}

/* A row collides and falls. */
INLINE uint64_t N(gmlg_effects)(const struct lga_row_gmlg *row, unsigned effects)
{
    const uint32_t words = row->words, stride = row->stride;
    const bool tight = effects & LGA_BITS_TIGHT, gravity = effects & LGA_BITS_GRAVITY;
    const struct lga_die *of = row->dice->of;
    uint64_t collisions = 0;
    struct N(late) ways = {.begun = {false}};
    struct N(stream) s, friction;
    N(seed)(&s, lga_dice_key(row->source));
    friction = s;
    if (of[LGA_DIE_FRICTION_LEFT].bits) N(seed)(&friction, lga_dice_key(row->friction));
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
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
            const vec side = N(draw)(&s, p, of[LGA_DIE_SIDE]);
            const vec kick = N(draw)(&s, p, of[LGA_DIE_KICK]);
            const vec loss = N(draw)(&s, p, of[LGA_DIE_LOSS]);
            const vec hit = tight ? N(collide_gmlg)(row, &ways, block, p, m, rest, side, kick, loss)
                                  : N(collide_roomy)(m, rest, side, kick, loss);
            collisions += N(count)(hit);
            if (row->hits) N(note)(row->hits, words, w, hit);
            if (gravity) {
                N(fall_gmlg)(row, &s, &friction, w, p, had_movers, effects & LGA_BITS_VERTICAL, m,
                             rest);
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * stride + w, m[d]);
            for (uint32_t k = 0; k < 3; k++) N(store)(row->out + (6 + k) * stride + w, rest[k]);
        }
    }
    return collisions;
}

/* Does a rest grain of a row without movers lie where it could start? */
KERNEL_TARGET static bool N(stirs)(const struct lga_row_gmlg *row)
{
    const bool vertical = row->effects & LGA_BITS_VERTICAL;
    for (uint32_t w = 0; w < row->words; w += KERNEL_WIDTH) {
        vec rest = {0}, shut = ~(vec){0};
        for (uint32_t k = 0; k < 3; k++) rest |= N(load)(row->in + (6 + k) * row->words + w);
        for (int d = vertical ? 2 : 4; d < (vertical ? 5 : 6); d++) {
            shut &= N(load)(row->full[d] + w);
        }
        if (N(any)(rest & ~shut)) return true;
    }
    return false;
}
