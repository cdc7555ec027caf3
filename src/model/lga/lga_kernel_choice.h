/* lga_kernel_choice.h - small numbers of each node, and a fair choice among its movers, as logic on
 * vectors of nodes: part of lga_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A number of a node (rest grains, room, ranks) is three planes of bits, the lowest first.
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

/* How many of six are set: of the first three, of the others, and of all. */
struct N(tally) { vec first[2], last[2], all[3]; };

INLINE struct N(tally) N(tallied)(const vec set[6])
{
    struct N(tally) t;
    t.first[0] = N(odd)(set[0], set[1], set[2]);
    t.first[1] = N(most)(set[0], set[1], set[2]);
    t.last[0] = N(odd)(set[3], set[4], set[5]);
    t.last[1] = N(most)(set[3], set[4], set[5]);
    const vec carry = t.first[0] & t.last[0];
    t.all[0] = t.first[0] ^ t.last[0];
    t.all[1] = N(odd)(t.first[1], t.last[1], carry);
    t.all[2] = N(most)(t.first[1], t.last[1], carry);
    return t;
}

/* The same, in all nodes together. */
INLINE uint64_t N(count_six)(const vec set[6])
{
    const struct N(tally) t = N(tallied)(set);
    return N(count)(t.all[0]) + 2 * N(count)(t.all[1]) + 4 * N(count)(t.all[2]);
}

/* One of three that are set, that with this rank, 0 to 2: of a node `here` surely one. */
INLINE void N(choose_third)(const vec set[3], vec here, const vec rank[2], vec chosen[3])
{
    const vec soon = here & ~rank[1];
    chosen[0] = soon & ~rank[0] & set[0];
    chosen[1] = soon & set[1] & ~(rank[0] ^ set[0]);
    chosen[2] = here & ~(chosen[0] | chosen[1]);
}

/* One of the members of a set, all with equal chance, where it `may` be and there is one: dice.
 * Sets of three and six need `third`, those of five `fifth`. */
struct N(pick) { vec third, fifth, coin, second; };

INLINE void N(choose)(const vec set[6], struct N(tally) t, vec may, struct N(pick) dice,
                      vec chosen[6])
{
    /* Of 2 by a coin, of 4 by two; of 5 the last, or else as of 4; of 3 the first by the die, or
     * else by a coin; of 6 as of 3, and a coin.  `n` is the number of members. */
    const vec n0 = t.all[0], n1 = t.all[1], n2 = t.all[2], fifth = n0 & dice.fifth;
    const vec doubled = N(either)(n1, dice.third, fifth), three = n0 & n1 & ~dice.third;
    const vec rank0 = N(either)(n2, dice.second & ~fifth, n1 & dice.coin & ~(n0 & dice.third));
    const vec rank1 = N(either)(n2, ~doubled & dice.coin, three & ~dice.coin);
    const vec rank2 = n2 & N(either)(n1, ~(dice.third | dice.coin), fifth);
    /* The rank less the number of the first half: is it there, or which is it of the second? */
    const vec borrow = ~rank0 & t.first[0];
    const vec less = N(most)(~rank1, t.first[1], borrow);
    const vec in_first = less & ~rank2 & may, in_last = (t.last[0] | t.last[1]) & may & ~in_first;
    const vec rank[2] = {rank0, rank1}, rest[2] = {rank0 ^ t.first[0],
                                                   N(odd)(rank1, t.first[1], borrow)};
    N(choose_third)(set, in_first, rank, chosen);
    N(choose_third)(set + 3, in_last, rest, chosen + 3);
}
