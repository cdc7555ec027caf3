/* figure.h - the figures of the four papers, each made again and judged.
 *
 * A figure is a row of the table FIGURES and one function.  The function simulates built-in scenes
 * with a few keys changed, through the same footage and measurements that every command uses, and
 * leaves pictures, tables and a verdict against the paper's law or number in its job.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FIGURE_H
#define FIGURE_H

#include "base/file.h"
#include "measure/chart.h"
#include "run/run.h"

struct figure_job;

/* X(name, function, what it shows); the papers' names: simplified (000), cooperative (001), gmlg
 * (003), stream (004). */
#define FIGURES(X)                                                                              \
    X("simplified-3",   cooling_restitutions, "cooling for several r by DSMC")                  \
    X("simplified-4",   bagnold_force,        "Bagnold: F(v) of two plates by DSMC")            \
    X("simplified-5",   cooling_three_models, "K(t) by ED, DSMC and HSMC against eq. 4")        \
    X("simplified-6",   clusters_factor_three, "S(k) by ED, DSMC and HSMC at several times")    \
    X("simplified-7",   heaps_hsmc_snapshot,  "a heap by HSMC")                                 \
    X("simplified-8",   heaps_hsmc_profile,   "profile of an HSMC heap against eq. 8")          \
    X("simplified-lga-heap", heaps_lattice_profile, "profile of a lattice gas heap against eq. 8") \
    X("simplified-lga-pipe", lattice_pipe,    "density waves in a pipe: spectrum, space-time")  \
    X("cooperative-2",  cooling_two_models,   "K(t) by ED and DSMC against eq. 18")             \
    X("cooperative-3",  collisions_impact_times, "impact parameters P(b/d) at several times")   \
    X("cooperative-4",  collisions_impact_restitutions, "P(b/d) for several r, dense")          \
    X("cooperative-5",  collisions_stress,    "velocities and the stress's principal axes")     \
    X("cooperative-6",  clusters_pair,        "pair correlation g(r/d) by ED and DSMC")         \
    X("cooperative-7",  clusters_factor_two,  "S(k) by ED and DSMC at several times")           \
    X("cooperative-8",  clusters_restitutions, "K(C/N) and (Kx - Kz)/K for several r")          \
    X("cooperative-9",  clusters_cut_off,     "K(t) and K(C/N) for t_c = 1e-10 to 1e-3 s")      \
    X("cooperative-10", clusters_growth,      "K(t), C/N and elastic C/N of the large gas")     \
    X("cooperative-11", clusters_snapshots,   "snapshots coloured by collisions per time")      \
    X("cooperative-12", collisions_frequency, "collision frequencies P(Nc) with fits")          \
    X("cooperative-13", pipe_snapshots,       "an arch in a pipe, snapshots")                   \
    X("cooperative-14", pipe_frequency,       "P(Nc) in the pipe before and with arches")       \
    X("gmlg-4",         lattice_hourglass,    "an hourglass of the lattice gas")                \
    X("stream-2",       scattering_mass,      "mass scattered by angle, m(Theta)")              \
    X("stream-3",       scattering_spin,      "angular momentum by angle, L(Theta)")            \
    X("stream-4",       scattering_momentum,  "momentum by angle, |p|(Theta)")                  \
    X("stream-5",       stream_density,       "force against the density of the stream")        \
    X("stream-6",       stream_radius,        "force against the size of round and flat obstacles") \
    X("stream-7",       corona_round,         "the corona before a round obstacle")             \
    X("stream-8",       corona_flat,          "the corona before a flat obstacle")              \
    X("stream-9",       stream_speed,         "force against the speed of the stream")          \
    X("stream-10",      corona_speeds,        "snapshots at 2000, 700 and 200 cm/s")            \
    X("stream-11",      corona_gap,           "the gap between obstacle and corona")            \
    X("stream-12",      corona_fields,        "density and temperature for three radii")

struct figure {
    const char *name, *title;
    bool (*make)(struct figure_job *job, struct error *error);
};

extern const struct figure figure_list[];       /* ends with a NULL name */

const struct figure *figure_find(const char *name);     /* NULL if there is none */

/* X(name, in words).  What the corrected physics is known not to give (the exponent 1.5 of
 * stream 17) is not reproduced, and expected not to be; anything else outside its tolerance
 * differs. */
#define FIGURE_OUTCOMES(X)                  \
    X(agrees,         "agrees")             \
    X(not_reproduced, "not reproduced")     \
    X(differs,        "differs")

enum figure_outcome {
#define X(name, words) FIGURE_##name,
    FIGURE_OUTCOMES(X)
#undef X
};

enum { FIGURE_FILES = 12, FIGURE_NAME = 80, FIGURE_WORDS = 1600 };

struct figure_job {
    const struct figure *figure;
    bool quick;                 /* reduced numbers: each within a minute */
    const char *directory;      /* where all files go */
    unsigned formats;           /* of plots, 1 << PLOT_BIT_... */
    void (*report)(void *context, const struct run_status *status);     /* may be NULL */
    void  *context;
    const volatile sig_atomic_t *signal;        /* may be NULL */

    /* What came out: */
    enum figure_outcome outcome;
    char verdict[FIGURE_WORDS];         /* one line */
    char choices[FIGURE_WORDS];         /* where the paper leaves a parameter open; one line */
    char commands[4 * FIGURE_WORDS];    /* that simulate the same, one a line */
    uint32_t picture_count, table_count;
    char pictures[FIGURE_FILES][FIGURE_NAME];   /* PNG files in the directory */
    char tables[FIGURE_FILES][FIGURE_NAME];     /* CSV files */
    bool undrawn;               /* there was no gnuplot for the plots */
    double wall, cpu;           /* seconds */
};

/* Makes the figure of job->figure and fills the rest of the job.  False if it could not be made;
 * a verdict that failed is no error. */
bool figure_make(struct figure_job *job, struct error *error);

const char *figure_outcome_words(enum figure_outcome outcome);

/* For the functions of figures. */

/* One more sentence of the verdict. */
void figure_say(struct figure_job *job, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* One more sentence of what was chosen. */
void figure_choose(struct figure_job *job, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Compares: "what 0.2651 (0.265 +- 0.003)"; outside the tolerance the figure differs. */
void figure_near(struct figure_job *job, const char *what, double measured, double reference,
                 double tolerance);

/* Holds a statement; where it is false the figure differs, and the verdict says "not: ...". */
void figure_hold(struct figure_job *job, bool holds, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* What the paper says and the corrected physics does not give.  `known` says that what came out
 * is what MODELS expects. */
void figure_miss(struct figure_job *job, bool known, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* If all went well so far (`done`), saves and draws a chart as NAME or NAME-suffix.  Frees it in
 * any case; false if anything failed, here or before. */
bool figure_chart(struct figure_job *job, bool done, struct chart *chart, const char *suffix,
                  struct error *error);

/* The path of a new picture NAME-suffix.png, noted in the job. */
void figure_picture(struct figure_job *job, const char *suffix, char path[FILE_PATH_MAX]);

/* The functions of the table. */
#define X(name, function, title) bool function(struct figure_job *job, struct error *error);
FIGURES(X)
#undef X

#endif
