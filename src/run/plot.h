/* plot.h - charts drawn by gnuplot: PNG, SVG, PDF, or as text for a terminal.
 *
 * What is drawn also stays as numbers: STEM.csv holds every curve, STEM.gp is the script that draws
 * them.  Without gnuplot these two are all there is, and `gnuplot STEM.gp` makes the pictures
 * later or elsewhere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PLOT_H
#define PLOT_H

#include "measure/chart.h"

/* X(name, ending, terminal of gnuplot) */
#define PLOT_FORMATS(X)                                                                 \
    X(png,  "png", "pngcairo size 1100,800 fontscale 1.2 linewidth 1.6 background 'white'") \
    X(svg,  "svg", "svg size 880,640 dynamic background 'white' font 'DejaVu Sans,14'") \
    X(pdf,  "pdf", "pdfcairo size 16cm,12cm font 'DejaVu Sans,11'")                     \
    X(text, "txt", "dumb size 100,32 noenhanced")

enum plot_format {
#define X(name, ending, terminal) PLOT_BIT_##name,
    PLOT_FORMATS(X)
#undef X
    PLOT_FORMAT_COUNT
};

/* "png,svg" as a set of bits; false if a word is unknown. */
bool plot_parse(const char *words, unsigned *formats, struct error *error);

/* The ending of a format's files. */
const char *plot_ending(enum plot_format format);

/* Is there a gnuplot on the PATH? */
bool plot_available(void);

/* Writes directory/STEM.csv and STEM.gp, and if gnuplot is there STEM.png and so on; *drawn tells
 * whether it was. */
bool plot_save(const struct chart *chart, const char *directory, const char *stem,
               unsigned formats, bool *drawn, struct error *error);

#endif
