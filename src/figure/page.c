/* page.c - see page.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/page.h"

#include "run/build.h"
#include "run/folder.h"

#include <stdio.h>
#include <string.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<title>Figures of the four papers</title>\n<style>\n"
    "body{font:16px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}\n"
    "img{max-width:100%;border:1px solid #ddd;margin:.3em 0}\n"
    "table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:.2em .6em;"
    "text-align:left;vertical-align:top}\n"
    "pre{background:#f4f4f4;padding:.6em;overflow-x:auto;font-size:13px}\n"
    ".agrees{color:#006b3c}.not{color:#8a5a00}.differs,.failed{color:#b00020}\n"
    "section{border-top:2px solid #ddd;margin-top:2em}\n</style></head><body>\n"
    "<h1>Figures of the four papers</h1>\n";

/* Text between tags. */
static void put(FILE *out, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '&': fputs("&amp;", out); break;
        default: fputc(*text, out);
        }
    }
}

static void put_outcome(FILE *out, const struct figure_job *job, const struct error *failure)
{
    const bool failed = *failure->text;
    const char *words = failed ? "failed" : figure_outcome_words(job->outcome);
    fprintf(out, "<span class=\"%.*s\">%s</span>", (int)strcspn(words, " "), words, words);
}

static void put_table(FILE *out, const struct figure_job *jobs, const struct error *failures,
                      uint32_t count)
{
    double wall = 0;
    fputs("<table><tr><th>figure</th><th>shows</th><th>verdict</th><th>seconds</th></tr>\n", out);
    for (uint32_t k = 0; k < count; k++) {
        const char *name = jobs[k].figure->name;
        fprintf(out, "<tr><td><a href=\"#%s\">%s</a></td><td>", name, name);
        put(out, jobs[k].figure->title);
        fputs("</td><td>", out);
        put_outcome(out, &jobs[k], &failures[k]);
        fprintf(out, "</td><td>%.1f</td></tr>\n", jobs[k].wall);
        wall += jobs[k].wall;
    }
    fprintf(out, "</table>\n<p>%u figures in %.0f s, by sandreel %s.</p>\n", count, wall,
            build_version);
}

static void put_figure(FILE *out, const struct figure_job *job, const struct error *failure)
{
    fprintf(out, "<section id=\"%s\"><h2>%s: ", job->figure->name, job->figure->name);
    put(out, job->figure->title);
    fputs("</h2>\n<p><b>", out);
    put_outcome(out, job, failure);
    fputs("</b>: ", out);
    put(out, *failure->text ? failure->text : job->verdict);
    fputs("</p>\n", out);
    if (*job->choices) {
        fputs("<p>Chosen: ", out);
        put(out, job->choices);
        fputs("</p>\n", out);
    }
    for (uint32_t k = 0; k < job->picture_count; k++) {
        fprintf(out, "<img src=\"%s\" alt=\"%s\" loading=\"lazy\">\n", job->pictures[k],
                job->pictures[k]);
    }
    if (job->undrawn) fputs("<p>Without gnuplot there are only tables and scripts.</p>\n", out);
    for (uint32_t k = 0; k < job->table_count; k++) {
        fprintf(out, "%s<a href=\"%s\">%s</a>", k ? ", " : "<p>", job->tables[k], job->tables[k]);
    }
    if (job->table_count > 0) fputs("</p>\n", out);
    fprintf(out, "<p>%.1f s (%.1f s of the processor):</p>\n<pre>sandreel figure %s%s</pre>\n",
            job->wall, job->cpu, job->figure->name, job->quick ? " --quick" : "");
    if (*job->commands) {
        fputs("<details><summary>the runs it is made of</summary><pre>", out);
        put(out, job->commands);
        fputs("</pre></details>\n", out);
    }
    fputs("</section>\n", out);
}

bool page_save(const char *directory, const struct figure_job *jobs, const struct error *failures,
               uint32_t count, struct error *error)
{
    struct file file;
    char path[FILE_PATH_MAX];
    if (!file_begin(&file, folder_path(path, directory, "index.html"), error)) return false;
    fputs(head, file.stream);
    put_table(file.stream, jobs, failures, count);
    for (uint32_t k = 0; k < count; k++) put_figure(file.stream, &jobs[k], &failures[k]);
    fputs("</body></html>\n", file.stream);
    return file_commit(&file, error);
}
