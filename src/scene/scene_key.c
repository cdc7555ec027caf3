/* scene_key.c - every key of a scene file, once: see key.h for what a row says.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_key.h"

#include <math.h>

#define ROW(in, key, type, fallback, low, high, unit, choices, doc) \
    {#key, type, offsetof(struct in, key), fallback, low, high, unit, choices, doc}
#define REAL(in, key, fallback, low, high, unit, doc) \
    ROW(in, key, KEY_REAL, fallback, low, high, unit, NULL, doc)
#define COUNT(in, key, fallback, high, doc) \
    ROW(in, key, KEY_COUNT, fallback, 0, high, "1", NULL, doc)
#define BOOL(in, key, fallback, doc) \
    ROW(in, key, KEY_BOOL, fallback, NAN, NAN, "", NULL, doc)
#define CHOICE(in, key, fallback, choices, doc) \
    ROW(in, key, KEY_CHOICE, fallback, NAN, NAN, "", choices, doc)
#define TEXT(in, key, fallback, choices, doc) \
    ROW(in, key, KEY_TEXT, fallback, NAN, NAN, "", choices, doc)
#define VECTOR(in, key, fallback, low, high, unit, doc) \
    ROW(in, key, KEY_VECTOR, fallback, low, high, unit, NULL, doc)
#define PLACE(in, key, fallback, doc) \
    ROW(in, key, KEY_VECTOR, fallback, -FAR, FAR, "length", NULL, doc)
#define BOX(in, key, fallback, doc) \
    ROW(in, key, KEY_BOX, fallback, -FAR, FAR, "length", NULL, doc)
#define TEXTS(in, key, doc) \
    ROW(in, key, KEY_TEXTS, "", NAN, NAN, "", NULL, doc)

#define GROUP(in, word, table, about) \
    {word, about, table, sizeof table / sizeof *table, sizeof(struct in)}

/* Lengths, times and speeds beyond this make squares and products overflow: a slip of the pen. */
#define FAR 1e30
/* Indices of grains are 32 bits, and contacts with walls use the numbers above this. */
#define COUNT_HIGH 1073741823
#define BORDERS "wall|periodic|open"

static const struct key top_keys[] = {
    TEXT(scene, title, "", NULL, "what the scene is, for people"),
    CHOICE(scene, units, "reduced", "reduced|si|cgs",
           "labels of pictures and tables; reduced: none"),
    TEXT(scene, model, "md", NULL, "the model that computes it unless --model names another"),
    ROW(scene, seed, KEY_WORD64, "1", NAN, NAN, "1", NULL, "the same seed gives the same run"),
    REAL(scene, until, NULL, KEY_POSITIVE, FAR, "time", "when the run ends"),
    BOOL(scene, quick, "false", "the small form: quick_set is applied"),
    TEXTS(scene, quick_set, "what the small form changes, as \"KEY=VALUE\""),
    COUNT(scene, count_max, "0", COUNT_HIGH,
          "most grains ever; 0: the placed ones and room for the sources"),
    REAL(scene, overlap_limit, "0.3", KEY_POSITIVE, 1, "1",
         "a run ends when an overlap exceeds this share of a radius"),
    BOX(scene, box, NULL, "the world: left, bottom, right, top"),
    CHOICE(scene, left, "wall", BORDERS, "the left border"),
    CHOICE(scene, right, "wall", BORDERS, "the right border"),
    CHOICE(scene, bottom, "wall", BORDERS, "the bottom border"),
    CHOICE(scene, top, "wall", BORDERS, "the top border"),
    VECTOR(scene, gravity, "(0, 0)", -FAR, FAR, "acceleration", "acceleration of every grain"),
    REAL(scene, shear_rate, "0", -FAR, FAR, "1/time",
         "du_x/dy: uniform shear by Lees-Edwards borders; needs four periodic borders"),
};

static const struct key species_keys[] = {
    TEXT(species, name, "", NULL, "by which placements, sources and walls call for it"),
    ROW(species, radius, KEY_RANGE, "nan", KEY_POSITIVE, FAR, "length", NULL,
        "one radius, or a range from which radii are drawn uniformly"),
    ROW(species, radii, KEY_REALS, "", KEY_POSITIVE, FAR, "length", NULL,
        "instead of radius: a list of radii, equally often"),
    REAL(species, density, "1", KEY_POSITIVE, FAR, "mass/area", "m = density pi R^2"),
    REAL(species, restitution, "nan", 0, 1, "1",
         "of a head-on collision; absent: from stiffness and damping"),
    REAL(species, stiffness, "nan", KEY_POSITIVE, FAR, "",
         "normal; its meaning is the force law's; "
         "absent: the model chooses"),
    REAL(species, damping, "nan", 0, FAR, "", "normal; instead of restitution"),
    REAL(species, friction, "0", 0, 100, "1",
         "Coulomb coefficient; 0: no friction and no rotation"),
    CHOICE(species, inertia, "disc", "disc|sphere", "I = m R^2 / 2 or 2 m R^2 / 5"),
};

static const struct key placement_keys[] = {
    TEXT(placement, grains, "", NULL, "name of the species; absent: the first"),
    CHOICE(placement, kind, "triangular", "triangular|square|random|file",
           "how the grains lie"),
    TEXT(placement, file, "", NULL,
         "file: CSV, LAMMPS dump or data file with the grains, looked for beside the scene"),
    BOX(placement, region, "nan", "where: a rectangle; absent: the box"),
    ROW(placement, outline, KEY_POINTS, "", -FAR, FAR, "length", NULL, "or where: a polygon"),
    COUNT(placement, count, "0", COUNT_HIGH, "at most so many, from below; 0: as many as fit"),
    REAL(placement, fraction, "nan", KEY_POSITIVE, 0.9, "1",
         "random: the area fraction to reach; absent: by count"),
    REAL(placement, spacing, "1", 1, 1e6, "1",
         "lattices: distance of centres in diameters of the largest grain"),
    REAL(placement, jitter, "0", 0, 1, "1", "lattices: random shift as a share of the free gap"),
    VECTOR(placement, velocity, "(0, 0)", -FAR, FAR, "speed", "of all of them"),
    REAL(placement, temperature, "0", 0, FAR, "speed^2",
         "granular temperature <v'^2>/2 of random velocities that are added; exact, zero mean"),
    REAL(placement, spin, "0", -FAR, FAR, "1/time", "angular velocity, counter-clockwise"),
};

static const struct key source_keys[] = {
    TEXT(source, grains, "", NULL, "name of the species; absent: the first"),
    CHOICE(source, kind, "point", "point|stream",
           "grains that fall one by one, or columns of grains"),
    PLACE(source, position, NULL, "where; of a stream: the middle of a new column"),
    REAL(source, above, "0", 0, FAR, "length",
         "point: it rises with a heap, so high above its highest grain at rest; 0: it stays"),
    REAL(source, width, "0", 0, FAR, "length", "spread along x; of a stream: the column's height"),
    VECTOR(source, velocity, "(0, 0)", -FAR, FAR, "speed", "with which they enter"),
    REAL(source, rate, "0", 0, FAR, "1/time", "point: grains per time"),
    REAL(source, density, "1", KEY_POSITIVE, 1, "1",
         "stream: rho; columns are 2 R_max / sqrt(rho) apart"),
    REAL(source, jitter, "0.02", 0, 0.3, "1", "stream: relative deviation of the vertical gaps"),
    REAL(source, from, "0", -FAR, FAR, "time", "it is on from here"),
    REAL(source, to, "inf", -FAR, FAR, "time", "it is on until here"),
    COUNT(source, count, "0", COUNT_HIGH, "at most so many in all; 0: no limit"),
};

static const struct key wall_keys[] = {
    TEXT(wall_entry, shape, NULL, "segment|polyline|arc|disc|row",
         "segment, polyline: points; arc, disc: center, radius; row: discs from .. to"),
    ROW(wall_entry, points, KEY_POINTS, "", -FAR, FAR, "length", NULL,
        "corners of a segment or polyline"),
    PLACE(wall_entry, center, "nan", "of an arc or disc"),
    REAL(wall_entry, radius, "nan", KEY_POSITIVE, FAR, "length",
         "of an arc, of a disc, of each disc of a row"),
    VECTOR(wall_entry, angles, "(0, 360)", -720, 720, "degree",
           "arc: from, to, counter-clockwise from +x"),
    PLACE(wall_entry, from, "nan", "row: the first centre; segment: its start"),
    PLACE(wall_entry, to, "nan", "row: the last centre; segment: its end"),
    COUNT(wall_entry, count, "0", 100000, "row: how many discs; 0: as many as make them touch"),
    VECTOR(wall_entry, velocity, "(0, 0)", -FAR, FAR, "speed", "with which it moves"),
    VECTOR(wall_entry, moves, "(0, inf)", -FAR, FAR, "time", "when it moves: from, to"),
    VECTOR(wall_entry, amplitude, "(0, 0)", -FAR, FAR, "length", "it shakes as a sin(2 pi f t)"),
    REAL(wall_entry, frequency, "0", 0, FAR, "1/time", "of shaking"),
    REAL(wall_entry, opens, "inf", -FAR, FAR, "time", "a gate: it is gone from here"),
    REAL(wall_entry, closes, "inf", -FAR, FAR, "time", "a gate: it is back from here"),
    REAL(wall_entry, surface_speed, "0", -FAR, FAR, "speed",
         "of the surface along itself: a conveyor, a turning drum"),
    TEXT(wall_entry, grains, "", NULL, "contacts as if made of this species; absent: the first"),
};

static const struct key screen_keys[] = {
    CHOICE(screen, kind, "circle", "circle|line", "a circle around, or a line x = const"),
    PLACE(screen, center, "(0, 0)", "from where angles are seen"),
    REAL(screen, radius, "nan", KEY_POSITIVE, FAR, "length", "circle: grains farther out leave"),
    REAL(screen, x, "nan", -FAR, FAR, "length", "line: grains to the right of it leave"),
    COUNT(screen, bins, "180", 1000000, "of the angle, over 360 degrees"),
    REAL(screen, from, "0", -FAR, FAR, "time", "records from here on; grains leave always"),
};

static const struct key sink_keys[] = {
    BOX(sink, region, NULL, "grains whose centre comes into it vanish"),
};

static const struct key phase_keys[] = {
    REAL(phase_entry, time, NULL, KEY_POSITIVE, FAR, "time", "when it begins"),
    TEXTS(phase_entry, set, "what changes, as \"KEY=VALUE\"; it stays for later phases"),
    ROW(phase_entry, push, KEY_REALS, "", -FAR, FAR, "", NULL,
        "x, y, radius, vx, vy: grains around a point gain a velocity; five more for another push"),
};

static const struct key view_keys[] = {
    VECTOR(view, size, "(1280, 720)", 16, 16384, "pixels", "width and height of a frame"),
    BOX(view, window, "nan", "the part of the scene to show; absent: the box with a margin"),
    CHOICE(view, color, "speed", "speed|collisions|spin|species|radius|pressure|none",
           "what the colour of a grain tells"),
    CHOICE(view, scale, "linear", "linear|sqrt|log", "from value to colour"),
    VECTOR(view, range, "nan", -FAR, FAR, "", "of the colours; absent: found from the grains"),
    CHOICE(view, range_from, "run", "run|frame",
           "a range that is found: one for the run, or one a frame"),
    TEXT(view, colormap, "viridis", "viridis|inferno|cividis|turbo", "colours from low to high"),
    CHOICE(view, theme, "white", "white|dark|transparent", "the ground"),
    TEXT(view, map, "", NULL, "a field drawn beneath the grains; absent: none"),
    BOOL(view, grains, "true", "draw the grains"),
    BOOL(view, walls, "true", "draw walls and obstacles"),
    BOOL(view, rims, "true", "a dark rim around each grain that is large enough"),
    BOOL(view, shade, "false", "grains as lit balls"),
    BOOL(view, arrows, "false", "velocities as arrows"),
    BOOL(view, forces, "false", "contact forces as line widths"),
    BOOL(view, spokes, "false", "a line from the centre that turns with the grain"),
    BOOL(view, legend, "true", "the colour bar"),
    BOOL(view, scale_bar, "true", "a bar of known length"),
    BOOL(view, gravity_arrow, "false", "an arrow along gravity"),
    TEXT(view, label, "t = {t} {time_unit}", NULL, "a line of text; {t}, {n}, ... are filled in"),
    TEXT(view, title, "", NULL, "a headline"),
    TEXT(view, caption, "", NULL, "a line of text under the picture, filled in as the label is"),
    REAL(view, arrow_scale, "nan", KEY_POSITIVE, FAR, "",
         "length of an arrow per speed; absent: chosen"),
    REAL(view, force_scale, "nan", KEY_POSITIVE, FAR, "",
         "width of a line per force; absent: chosen"),
    REAL(view, text_size, "nan", 4, 512, "pixels", "height of text; absent: from the frame's"),
};

static const struct key measure_keys[] = {
    TEXTS(measure, fields, "names of the maps to make: density, velocity, ..."),
    REAL(measure, cell, "nan", KEY_POSITIVE, FAR, "length",
         "of maps; absent: two mean diameters, in a huge box more"),
    CHOICE(measure, kernel, "gauss", "box|gauss|lucy", "how a grain is spread over a map"),
    REAL(measure, width, "nan", KEY_POSITIVE, FAR, "length", "of the kernel; absent: one cell"),
    VECTOR(measure, average, "nan", 0, FAR, "time",
           "maps are averaged from, to; absent: snapshots"),
    VECTOR(measure, range, "nan", -FAR, FAR, "",
           "of the colours of maps; absent: each map its own"),
    BOOL(measure, collisions, "false", "count the contacts of each grain"),
    REAL(measure, collision_window, "nan", KEY_POSITIVE, FAR, "time",
         "over which a rate is formed; absent: the time between frames"),
    BOOL(measure, collision_counts, "false",
         "contacts begun by each grain, elastic ones apart: collisions.csv, and C/N in log.csv"),
    BOOL(measure, impact_parameters, "false", "how far off centre grains hit: impact.csv"),
    COUNT(measure, impact_bins, "50", 10000, "of the impact parameter, over 0 to 1"),
    BOOL(measure, stress, "false",
         "the stress that collisions carry and the kinetic one: in log.csv, and as maps"),
    TEXTS(measure, cost, "what `sandreel cost` compares: energy, collisions, discharge, rate, "
          "height, slope, force, structure, density, path; absent: what suits the scene"),
    TEXT(measure, reference, "", NULL, "with what `sandreel cost` compares: a model and keys, "
         "=*2 being a factor on what the model chooses; absent: md or ed, by the effects"),
    TEXTS(measure, settings, "what `sandreel cost` tries, each a model and keys; absent: a list "
          "for every model"),
};

static const struct key output_keys[] = {
    REAL(output, frames, "0", 0, FAR, "time", "between pictures; 0: none"),
    REAL(output, log, "0", 0, FAR, "time", "between rows of log.csv; 0: none"),
    REAL(output, maps, "0", 0, FAR, "time", "between maps; 0: none"),
    REAL(output, trajectory, "0", 0, FAR, "time",
         "between frames of trajectory.h5 (H5MD, compressed); 0: none"),
    REAL(output, tallies, "0", 0, FAR, "time",
         "between histograms in impact.csv and collisions.csv; 0: one, of the whole run"),
    REAL(output, checkpoint, "0", 0, FAR, "time", "between checkpoints; 0: none"),
    REAL(output, checkpoint_wall, "600", 0, FAR, "s of wall time", "between checkpoints; 0: none"),
    BOOL(output, dump, "false", "keep the grains' states at each frame"),
    BOOL(output, contacts, "false", "with their contacts"),
    TEXT(output, movie, "", NULL, "a movie written while it runs: movie.mp4; absent: none"),
    REAL(output, frame_rate, "25", 1, 240, "1/s", "of movies"),
    {"png_level", KEY_COUNT, offsetof(struct output, png_level), "1", 0, 9, "1", NULL,
     "effort of compression"},
};

static const struct key hard_keys[] = {
    TEXTS(hard, models, "runs to make, each \"MODEL KEY=VALUE ...\"; none: it is no hard case"),
    BOOL(hard, slow, "false", "takes longer than a few seconds"),
    CHOICE(hard, ends, "reached", "reached|refused|stopped", "how the run must end"),
    TEXT(hard, because, "", NULL, "words that the reason of a refusal or stop must hold"),
    BOOL(hard, mass, "true", "grains and mass are kept, but for what enters and leaves"),
    REAL(hard, momentum, "nan", 0, FAR, "1",
         "it changes at most by this share of sqrt(2 M K), K: kinetic energy at the start"),
    REAL(hard, energy_rises, "nan", 0, FAR, "1",
         "the sum of energies rises at most by this share of what has been in motion"),
    REAL(hard, energy_changes, "nan", 0, FAR, "1",
         "the sum of energies differs from its first value at most by this share"),
    REAL(hard, overlap, "nan", 0, 2, "1",
         "largest overlap with a grain or a wall, as a share of the smaller radius"),
    BOX(hard, within, "nan", "all centres stay in this rectangle; absent: no further than a "
        "radius outside of solid borders"),
    ROW(hard, grains, KEY_RANGE, "nan", 0, FAR, "1", NULL, "how many there are at the end"),
    ROW(hard, energy_left, KEY_RANGE, "nan", 0, FAR, "1", NULL,
        "kinetic energy at the end as a share of that at the start"),
    ROW(hard, travel, KEY_RANGE, "nan", 0, FAR, "1", NULL,
        "mean way of a grain from its start to its end, in mean diameters"),
    REAL(hard, collisions, "0", 0, FAR, "1", "so many must happen"),
    REAL(hard, since, "0", 0, FAR, "time",
         "changes, shares and ways are measured from here on"),
    REAL(hard, work, "nan", KEY_POSITIVE, FAR, "1", "at most so many steps, events or ticks"),
    REAL(hard, seconds, "120", KEY_POSITIVE, FAR, "s of wall time", "after these it has failed"),
    {"looks", KEY_COUNT, offsetof(struct hard, looks), "20", 1, 1000000, "1", NULL,
     "how often everything is compared on the way"},
    TEXTS(hard, agrees_with, "\"KEY=VALUE\" of a second run that must end alike"),
    REAL(hard, positions, "nan", 0, FAR, "1",
         "of the two runs may differ by so many mean diameters, measured from box to box"),
    REAL(hard, energies, "nan", 0, FAR, "1",
         "kinetic ones of the two runs may differ by this share"),
};

const struct key_group scene_key_top = GROUP(scene, "", top_keys, "keys outside of any group");

static const struct key_group
    species_group = GROUP(species, "grains", species_keys, "a species of grains"),
    placement_group = GROUP(placement, "placements", placement_keys, "grains at the start"),
    source_group = GROUP(source, "sources", source_keys, "grains that enter while it runs"),
    wall_group = GROUP(wall_entry, "walls", wall_keys, "solid geometry"),
    obstacle_group = GROUP(wall_entry, "obstacles", wall_keys,
                           "solid geometry on which the force is summed up"),
    screen_group = GROUP(screen, "screens", screen_keys,
                         "grains that cross are recorded, and leave"),
    sink_group = GROUP(sink, "sinks", sink_keys, "where grains vanish"),
    phase_group = GROUP(phase_entry, "phases", phase_keys, "keys that change at a time"),
    view_group = GROUP(view, "view", view_keys, "how frames look"),
    measure_group = GROUP(measure, "measure", measure_keys, "maps, and what is gathered"),
    output_group = GROUP(output, "output", output_keys, "what a run writes, and how often"),
    hard_group = GROUP(hard, "hard", hard_keys,
                         "what must hold while it runs, tried by `sandreel stress`");

#define LIST(group, array, counter) \
    {&group, true, offsetof(struct scene, array), offsetof(struct scene, counter)}
#define SINGLE(group, part) {&group, false, offsetof(struct scene, part), 0}

const struct scene_section scene_key_sections[SCENE_SECTIONS] = {
    LIST(species_group, species, species_count),
    LIST(placement_group, placements, placement_count),
    LIST(source_group, sources, source_count),
    LIST(wall_group, wall_entries, wall_entry_count),
    LIST(obstacle_group, obstacles, obstacle_count),
    LIST(screen_group, screens, screen_count),
    LIST(sink_group, sinks, sink_count),
    LIST(phase_group, phase_entries, phase_entry_count),
    SINGLE(view_group, view),
    SINGLE(measure_group, measure),
    SINGLE(output_group, output),
    SINGLE(hard_group, hard),
};

const struct key_group *scene_key_group(uint32_t index)
{
    if (index == 0) return &scene_key_top;
    return index <= SCENE_SECTIONS ? scene_key_sections[index - 1].group : NULL;
}
