/* expression.c - see expression.h.
 *
 * A descent through the levels of binding: and < comparison < sum < product < sign < value.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/expression.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 50, NAME_MAX_HERE = 200 };

struct reader {
    const char *at;
    expression_names names;
    void *context;
    int depth;
    bool failed;
    struct error *error;
};

static double read_and(struct reader *reader);

static double fail(struct reader *reader, const char *what)
{
    if (!reader->failed) {
        error_set_code(reader->error, EXIT_USAGE, "%s at '%.40s'", what, reader->at);
    }
    reader->failed = true;
    return NAN;
}

static bool takes(struct reader *reader, const char *token)
{
    reader->at += strspn(reader->at, " ");
    const size_t length = strlen(token);
    if (reader->failed || strncmp(reader->at, token, length) != 0) return false;
    const bool word = isalpha((unsigned char)token[0]);
    if (word && isalnum((unsigned char)reader->at[length])) return false;
    reader->at += length;
    return true;
}

static double read_name(struct reader *reader)
{
    char name[NAME_MAX_HERE];
    size_t length = 0;
    while (isalnum((unsigned char)reader->at[length]) || reader->at[length] == '_'
           || reader->at[length] == '.' || reader->at[length] == '['
           || reader->at[length] == ']') {
        length++;
    }
    if (length == 0) {
        return fail(reader, *reader->at ? "no number or name" : "something is missing");
    }
    if (length >= sizeof name) return fail(reader, "too long a name");
    memcpy(name, reader->at, length);
    name[length] = 0;
    double value = NAN;
    if (!reader->names(reader->context, name, &value)) return fail(reader, "an unknown name");
    reader->at += length;
    return value;
}

static double read_value(struct reader *reader)
{
    if (reader->depth++ > DEPTH_MAX) return fail(reader, "too deep a nesting");
    double value;
    char *end;
    if (takes(reader, "-")) {
        value = -read_value(reader);
    } else if (takes(reader, "abs")) {
        value = takes(reader, "(") ? fabs(read_and(reader)) : fail(reader, "abs needs a '('");
        if (!takes(reader, ")")) fail(reader, "a ')' is missing");
    } else if (takes(reader, "(")) {
        value = read_and(reader);
        if (!takes(reader, ")")) fail(reader, "a ')' is missing");
    } else if (isdigit((unsigned char)*reader->at) || *reader->at == '.') {
        value = strtod(reader->at, &end);
        if (end == reader->at) return fail(reader, "no number");
        reader->at = end;
    } else {
        value = read_name(reader);
    }
    reader->depth--;
    return value;
}

static double read_product(struct reader *reader)
{
    double value = read_value(reader);
    for (;;) {
        if (takes(reader, "*")) value *= read_value(reader);
        else if (takes(reader, "/")) value /= read_value(reader);
        else return value;
    }
}

static double read_sum(struct reader *reader)
{
    double value = read_product(reader);
    for (;;) {
        if (takes(reader, "+")) value += read_product(reader);
        else if (takes(reader, "-")) value -= read_product(reader);
        else return value;
    }
}

static double read_comparison(struct reader *reader)
{
    const double value = read_sum(reader);
    if (takes(reader, "<=")) return value <= read_sum(reader);
    if (takes(reader, ">=")) return value >= read_sum(reader);
    if (takes(reader, "==")) return value == read_sum(reader);
    if (takes(reader, "!=")) return value != read_sum(reader);
    if (takes(reader, "<")) return value < read_sum(reader);
    if (takes(reader, ">")) return value > read_sum(reader);
    return value;
}

static double read_and(struct reader *reader)
{
    double value = read_comparison(reader);
    while (takes(reader, "and")) {
        const double other = read_comparison(reader);
        value = value != 0 && other != 0;
    }
    return value;
}

bool expression_value(const char *text, expression_names names, void *context, double *value,
                      struct error *error)
{
    struct reader reader = {.at = text, .names = names, .context = context, .error = error};
    *value = read_and(&reader);
    reader.at += strspn(reader.at, " ");
    if (!reader.failed && *reader.at) fail(&reader, "nothing may follow");
    return !reader.failed;
}
