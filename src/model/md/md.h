/* md.h - the soft-disc model's own state; only files of this folder include it.
 *
 * What the contact loop reads of every grain is a record of half a cache line; what only some
 * scenes need (sizes, spins) lies in records of its own, which other scenes neither have nor read.
 * Grains are sorted in space at every rebuild of the neighbour list, so that partners lie close
 * in memory; `id` keeps their names.
 *
 * Spin is held as the speed of the rim, R omega: then neither the slip of a contact nor the
 * change of spin needs a radius (d(R omega)/dt = R M / I = sum of forces / (q m)).
 *
 * Time runs in leapfrog: `hx hy hrim` are velocities half a step back, `ux uy rim` the ones
 * predicted for now, u = h + a dt/2, which velocity-dependent forces read (second order).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MD_H
#define MD_H

#include "base/arena.h"
#include "model/md/md_law.h"
#include "model/md/md_settings.h"
#include "model/model.h"
#include "model/source.h"

#define FORCE_INLINE static inline __attribute__((always_inline))

/* The hot loops exist three times and the loader takes the widest that the processor has.
 * Addition, multiplication, division and square root round the same in all of them.  Not with
 * Clang: its ThreadSanitizer is not ready yet when the loader chooses. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

struct grain {
    double   x, y;
    double   ux, uy;            /* velocity now, which forces read */
};

struct half { double hx, hy; }; /* velocities half a step back: only the integrator reads them */

struct trait {                  /* where grains spin or are not all alike */
    double radius, inverse_mass;
    double inverse_inertia;     /* 1 / q, I = q m R^2 */
    double rim;                 /* R omega, counter-clockwise */
};

struct turn { double hrim, angle; };    /* half a step back; R times the angle turned */

struct tag {                    /* what no step reads */
    uint32_t id;
    uint16_t species;
    uint8_t  fresh;             /* has taken no step yet: its first kick is half a one */
    uint8_t  gone;              /* has left; the next list drops it */
};

/* Gear: scaled derivatives d^k/dt^k dt^k/k! beyond the velocity, of position (k = 2..5) and of
 * the rim's travel (k = 2..3). */
struct gear { double x2, y2, x3, y3, x4, y4, x5, y5, a2, a3; };

/* Two grains that may touch before the list is made anew; i < j.  The partner's word holds its
 * index, the image of it that is meant, and whether the two touched at the last step. */
struct link { uint32_t i, j; };

enum {
    LINK_IMAGE_SHIFT = 27,                      /* 4 bits: which periodic image */
    LINK_INDEX = (1 << LINK_IMAGE_SHIFT) - 1,   /* at most 134 million grains */
    LINK_IMAGE = 15 << LINK_IMAGE_SHIFT,
    LINK_IMAGES = 9,
    LINKS_AHEAD = 32            /* whose partner is fetched into the cache beforehand */
};
#define LINK_TOUCHES 0x80000000u

struct push { double fx, fy; };                 /* force on a grain */

/* A grain near a wall. */
struct wall_link {
    uint32_t grain, wall;
    uint32_t image;             /* of the wall, in a periodic box */
    uint32_t touches;
    double   spring;
};

/* Grains first..last-1: one strip is worked by one thread at a time, in index order.  Links from
 * strip to strip are worked before, from positions that nobody changes meanwhile.  The cut does
 * not depend on the number of threads, so neither does any sum. */
struct strip {
    uint32_t first, last;
    uint32_t link_first, link_last;     /* within the strip */
    uint32_t cross_first, cross_last;   /* from here to later strips */
    uint32_t in_first, in_last;         /* entries of `incoming`: cross links that end here */
    uint32_t wall_first, wall_last;
};

struct strip_sums {             /* what a strip adds up in a step */
    uint64_t begun, tangential, suspect;
    double   speed2_max;
};

enum {
    STRIP_GRAINS = 4096, STRIP_GRAINS_MAX = 16384,
    STRIPS_SHARED = 4,          /* many strips come in multiples of it, to share them out evenly */
    WINDOW = 256
};

struct md {
    const struct scene *scene;
    const struct md_settings *settings;
    effects_t effects;
    unsigned  kernel;           /* index of the compiled force loop */
    struct md_law law;
    struct md_pair_law *pairs;  /* [species][species] */

    double   dt, epoch;         /* time = epoch + steps_here * dt */
    uint64_t steps, steps_here;

    uint32_t count, count_max, id_next;
    struct grain *grains;
    struct half  *halves;
    struct tag   *tags;
    struct trait *traits;       /* NULL where all grains are alike and none spins */
    struct turn  *turns;        /* NULL where none spins */
    struct gear  *gears;        /* NULL without the Gear integrator */
    double   radius_one, inverse_mass_one;      /* where all are alike */
    bool     some_fresh;

    double   reach_max;         /* largest sum of two radii */
    double   suspect_overlap;   /* beyond which a contact is looked at one by one */
    double   skin, travel;      /* a list holds while 2 travel < skin */
    double   stride;            /* travel of the last step */
    double   wall_speed;
    uint64_t suspects;          /* overlaps of the last step to look at */
    bool     stale;             /* the list belongs to other grains or settings */
    double   image_x[LINK_IMAGES], image_y[LINK_IMAGES];

    uint32_t link_count, link_max, cross_count, incoming_count;
    struct link *links;         /* inner links of all strips, then the cross links */
    double  *springs;           /* NULL without static friction */
    uint32_t *incoming;         /* cross links by the strip in which they end */
    struct push *cross_push;    /* force of each cross link on its first grain */
    double  *cross_twist;       /* and on the rims of both; NULL where none spins */

    uint32_t strip_count, strip_max;
    struct strip *strips;
    struct strip_sums *sums;
    uint32_t thread_count;
    struct push *pushes;        /* [thread][strip_room]: forces while a strip is worked */
    double  *twists;            /* likewise: sums of rim forces; NULL where none spins */
    uint32_t strip_room;

    uint32_t wall_link_count, wall_link_max;
    struct wall_link *wall_links, *wall_links_old;      /* by grain; the list before */
    uint32_t *wall_first;       /* of a rebuild */
    struct wall *walls_now;     /* as placed at the present time */
    bool    *wall_here;
    bool     walls_vary;
    struct tally_body *body_sums;       /* [strip][body] */

    uint32_t *collisions;       /* begun in this window, by grain; NULL if nobody measures */
    float    *collision_rate;   /* of the last whole window */
    double    window_length;
    uint64_t  window;           /* number of the window that is being counted */

    struct source_cursor *cursors;
    uint64_t retry_step;        /* a grain that found no room tries again then */
    struct source_grain *batch;
    uint32_t batch_max;
    struct tally tally;

    uint64_t begun, tangential, rebuilds, grains_in, grains_out, rejected;
    struct md_scratch *scratch; /* of a rebuild */
    struct fault fault;
    bool     broken;
    struct arena arena;
};

static inline double md_time(const struct md *md)
{
    return md->epoch + (double)md->steps_here * md->dt;
}

static inline double md_radius(const struct md *md, uint32_t i)
{
    return md->traits ? md->traits[i].radius : md->radius_one;
}

static inline double md_inverse_mass(const struct md *md, uint32_t i)
{
    return md->traits ? md->traits[i].inverse_mass : md->inverse_mass_one;
}

static inline double md_rim(const struct md *md, uint32_t i)
{
    return md->traits ? md->traits[i].rim : 0;
}

static inline const struct md_pair_law *md_pair_law(const struct md *md, uint32_t a, uint32_t b)
{
    return &md->pairs[a * md->scene->species_count + b];
}

#endif
