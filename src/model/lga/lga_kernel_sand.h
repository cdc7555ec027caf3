/* lga_kernel_sand.h - the sandpile's own stages as logic on vectors of nodes: part of lga_kernel.h,
 * behind the gmlg, with which it shares how a mover bends.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */

/* Collides a row in its place; lossy pairs and triples stop, and their surplus is noted. */
KERNEL_TARGET static uint64_t N(stop)(const struct lga_row_stop *row)
{
    const uint32_t words = row->words;
    uint64_t collisions = 0;
    vec spills = {0};
    struct N(stream) s;
    N(seed)(&s, row->key);
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        vec side[PARTS], kick[PARTS], loss[PARTS];
        N(roll)(&s, row->dice->of[LGA_DIE_SIDE], side);
        N(roll)(&s, row->dice->of[LGA_DIE_KICK], kick);
        N(roll)(&s, row->dice->of[LGA_DIE_LOSS], loss);
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec m[6], caught[7] = {{0}}, r = N(load)(row->planes + 6 * words + w);
            for (uint32_t d = 0; d < 6; d++) m[d] = N(load)(row->planes + d * words + w);
            if (row->held) {
                const vec wall = N(load)(row->wall + w);
                for (int d = 0; d < 6; d++) caught[d] = m[d] & wall;
                for (int d = 0; d < 6; d++) m[d] &= ~wall;
                caught[6] = r & wall;
                r &= ~wall;
            }
            vec pair = {0}, none[3], left[3], right[3];
            for (int i = 0; i < 3; i++) {
                none[i] = ~(m[i] | m[i + 3]);
                left[i] = m[i] & ~m[i + 3];
                right[i] = m[i + 3] & ~m[i];
            }
            for (int i = 0; i < 3; i++) {
                pair |= m[i] & m[i + 3] & none[(i + 1) % 3] & none[(i + 2) % 3];
            }
            pair &= loss[p];
            const vec triple = ((left[0] & left[2] & right[1]) | (right[0] & right[2] & left[1]))
                             & loss[p];
            const vec stops = pair | triple, rested = r;
            for (int d = 0; d < 6; d++) m[d] &= ~stops;
            const vec hit = N(collide)(m, &r, side[p], kick[p]) | stops;
            collisions += N(count)(hit);
            if (row->hits) N(note)(row->hits, words, w, hit);
            spills |= stops;
            N(store)(row->low + w, (pair & ~rested) | (triple & rested));
            N(store)(row->high + w, (pair & rested) | triple);
            for (uint32_t d = 0; d < 6; d++) {
                N(store)(row->planes + d * words + w, m[d] | caught[d]);
            }
            N(store)(row->planes + 6 * words + w, r | stops | caught[6]);
        }
    }
    *row->spills = N(any)(spills);
    return collisions;
}

/* Rest grains start down, where no other lies, and one of a node's movers bends down; neither into
 * a wall. */
KERNEL_TARGET static void N(fall_row)(const struct lga_row_fall *row)
{
    const uint32_t words = row->words;
    struct N(stream) s;
    N(seed)(&s, row->key);
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        vec falls[PARTS], left[PARTS], bend[PARTS], bend_left[PARTS], mirror[PARTS], plate[PARTS];
        vec third[PARTS], fifth[PARTS], coin[PARTS], second[PARTS];
        N(roll)(&s, row->dice->of[LGA_DIE_FALL], falls);
        N(roll)(&s, row->dice->of[LGA_DIE_FALL_SIDE], left);
        N(roll)(&s, row->dice->of[LGA_DIE_BEND], bend);
        N(roll)(&s, row->dice->of[LGA_DIE_BEND_SIDE], bend_left);
        N(roll)(&s, row->dice->of[LGA_DIE_MIRROR], mirror);
        N(roll)(&s, row->dice->of[LGA_DIE_PLATE], plate);
        N(roll)(&s, row->dice->of[LGA_DIE_PICK_THIRD], third);
        N(roll)(&s, row->dice->of[LGA_DIE_PICK_FIFTH], fifth);
        N(roll)(&s, row->dice->of[LGA_DIE_PICK_COIN], coin);
        N(roll)(&s, row->dice->of[LGA_DIE_PICK_SECOND], second);
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec m[6], r = N(load)(row->in + 6 * words + w);
            for (uint32_t d = 0; d < 6; d++) m[d] = N(load)(row->in + d * words + w);
            if (row->held) {
                const vec fluid = ~N(load)(row->wall + w);
                for (int d = 0; d < 6; d++) m[d] &= fluid;
                r &= fluid;
            }
            const vec starts = r & falls[p];
            const vec wall[2] = {N(load)(row->wall_left + w), N(load)(row->wall_right + w)};
            const vec shut_left = wall[0] | N(load)(row->taken_left + w);
            const vec shut_right = wall[1] | N(load)(row->taken_right + w);
            const vec goes_left = starts & left[p] & ~m[4] & ~shut_left;
            const vec goes_right = starts & ~left[p] & ~m[5] & ~shut_right;
            m[4] |= goes_left;
            m[5] |= goes_right;
            if (row->fly) {
                const struct N(pick) dice = {third[p], fifth[p], coin[p], second[p]};
                vec able[6], from[6], full[6] = {{0}};
                full[4] = wall[0] | N(load)(row->rest_left + w);
                full[5] = wall[1] | N(load)(row->rest_right + w);
                N(able_level)(m, full, bend_left[p], able);
                N(choose)(able, N(tallied)(able), bend[p], dice, from);
                N(bend_level)(m, from);
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row->out + d * row->stride + w, m[d]);
            N(store)(row->out + 6 * row->stride + w, r & ~(goes_left | goes_right));
            N(store)(row->out + LGA_PLANE_MIRROR * row->stride + w, mirror[p]);
            if (row->plate) N(store)(row->out + LGA_PLANE_PLATE * row->stride + w, plate[p]);
        }
    }
}

/* --- with a heap --- */

/* Streams a row.  A plate stops some of what falls onto it, which begins the heap; every mover that
 * comes to a node of the heap stops there.  A node of the heap whose grain has gone is one no
 * more.  All but one of the rest grains of a node are noted as surplus. */
KERNEL_TARGET static uint64_t N(stream_heap)(const struct lga_row_stream *row)
{
    const uint32_t words = row->words;
    const bool held = row->effects & LGA_BITS_HELD;
    uint64_t left = 0;
    vec spills = {0};
    for (uint32_t w = 0; w < words; w += KERNEL_WIDTH) {
        const vec wall = N(load)(row->wall + w), plate = N(load)(row->own[LGA_PLANE_PLATE] + w);
        const vec sink = row->sink ? N(load)(row->sink + w) : (vec){0};
        const vec stop_left = N(load)(row->own[4] + w) & N(load)(row->wall_from[1] + w) & plate;
        const vec stop_right = N(load)(row->own[5] + w) & N(load)(row->wall_from[2] + w) & plate;
        vec rest[3] = {N(load)(row->own[6] + w), {0}, {0}};
        const vec heap = ((N(load)(row->heap + w) & rest[0]) | stop_left | stop_right) & ~wall;
        N(add_bit)(rest, stop_left);
        N(add_bit)(rest, stop_right);
        for (uint32_t d = 0; d < 6; d++) {
            vec back = N(load)(row->wall_from[d] + w) & N(load)(row->own[(d + 3) % 6] + w);
            if (d == 1) back &= ~stop_left;
            if (d == 2) back &= ~stop_right;
            vec m = (N(load)(row->from[d] + w) | back) & ~wall;
            if (row->sink) left += N(count)(m & sink);
            m &= ~sink;
            N(add_bit)(rest, m & heap);
            m &= ~heap;
            if (held) m |= wall & N(load)(row->out + d * words + w);
            N(store)(row->out + d * words + w, m);
        }
        vec stays = ~N(is_zero)(rest);
        N(subtract_bit)(rest, stays);
        const vec real = N(load)(row->real + w);
        for (uint32_t k = 0; k < 3; k++) {
            rest[k] &= real;
            spills |= rest[k];
            N(store)(row->surplus + k * words + w, rest[k]);
        }
        if (held) stays |= wall & N(load)(row->out + 6 * words + w);
        N(store)(row->out + 6 * words + w, stays);
        N(store)(row->heap + w, heap);
    }
    *row->spills = N(any)(spills);
    return left;
}

KERNEL_TARGET static void N(bind)(const struct lga_row_bind *row)
{
    for (uint32_t w = 0; w < row->words; w += KERNEL_WIDTH) {
        const vec left = N(load)(row->wall_left + w) | N(load)(row->heap_left + w);
        const vec right = N(load)(row->wall_right + w) | N(load)(row->heap_right + w);
        const vec lies = N(load)(row->rest + w) & ~N(load)(row->wall + w);
        N(store)(row->heap + w, N(load)(row->heap + w) | (lies & left & right));
    }
}
