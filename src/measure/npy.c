/* npy.c - see npy.h; the format is NumPy's NEP 1.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/npy.h"

#include "base/file.h"

#include <assert.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are written as they are");

static const char magic[6] = "\x93NUMPY";
static const uint64_t bytes_max = (uint64_t)1 << 36;

enum { START = 10, HEADER_MAX = 65535, ALIGNMENT = 64 };

/* Width of "<f8", "|u1", ...: kind and size that C has too.  Big-endian and text are refused. */
static size_t number_width(const char *word, size_t length)
{
    if (length != 3 || !strchr("fiu", word[1]) || !strchr("1248", word[2])) return 0;
    const size_t width = (size_t)(word[2] - '0');
    if (word[1] == 'f' && width < 4) return 0;
    if (word[0] != '<' && !(width == 1 && word[0] == '|')) return 0;
    return width;
}

/* A quoted word at *at without blanks and escapes; moves past it.  0 if there is none. */
static size_t quoted(const char **at, const char **word)
{
    const char quote = **at;
    if (quote != '\'' && quote != '"') return 0;
    *word = *at + 1;
    const char *end = strchr(*word, quote);
    if (!end) return 0;
    *at = end + 1;
    return (size_t)(end - *word);
}

/* `type` must hold no blanks outside of names. */
static size_t type_width(const char *type)
{
    if (*type != '[') return number_width(type, strlen(type));
    size_t width = 0;
    const char *at = type + 1, *word;
    while (*at == '(') {
        at++;
        if (quoted(&at, &word) == 0 || *at++ != ',') return 0;
        const size_t length = quoted(&at, &word), one = length ? number_width(word, length) : 0;
        if (one == 0 || *at++ != ')') return 0;
        width += one;
        if (*at == ',') at++;
    }
    return at[0] == ']' && at[1] == 0 ? width : 0;
}

static bool strip_blanks(const char *from, size_t length, char *to, size_t room)
{
    size_t used = 0;
    for (size_t k = 0; k < length; k++) {
        if (from[k] == ' ') continue;
        if (used + 1 >= room) return false;
        to[used++] = from[k];
    }
    to[used] = 0;
    return true;
}

size_t npy_width(const char *type)
{
    char text[NPY_TYPE_MAX];
    return strip_blanks(type, strlen(type), text, sizeof text) ? type_width(text) : 0;
}

bool npy_is(const struct npy *npy, const char *type)
{
    char text[NPY_TYPE_MAX];
    return strip_blanks(type, strlen(type), text, sizeof text) && strcmp(text, npy->type) == 0;
}

bool npy_save(const char *path, const char *type, const uint64_t *shape, uint32_t dimensions,
              const void *values, struct error *error)
{
    const size_t width = npy_width(type);
    const char *quote = *type == '[' ? "" : "'";
    char header[NPY_TYPE_MAX + 400];
    assert(width > 0);
    assert(dimensions <= NPY_DIMENSIONS_MAX);
    int used = snprintf(header, sizeof header,
                        "{'descr': %s%s%s, 'fortran_order': False, 'shape': (", quote, type, quote);
    uint64_t count = 1;
    for (uint32_t d = 0; d < dimensions; d++) {
        count *= shape[d];
        used += snprintf(header + used, sizeof header - (size_t)used, "%s%llu%s", d ? ", " : "",
                         (unsigned long long)shape[d], dimensions == 1 ? "," : "");
    }
    used += snprintf(header + used, sizeof header - (size_t)used, "), }");
    assert((size_t)used < sizeof header - ALIGNMENT - 1);
    while ((START + used + 1) % ALIGNMENT != 0) header[used++] = ' ';
    header[used++] = '\n';

    struct file file;
    if (!file_begin(&file, path, error)) return false;
    const unsigned char start[4] = {1, 0, (unsigned char)(used & 255), (unsigned char)(used >> 8)};
    fwrite(magic, 1, sizeof magic, file.stream);
    fwrite(start, 1, sizeof start, file.stream);
    fwrite(header, 1, (size_t)used, file.stream);
    if (count > 0) fwrite(values, width, (size_t)count, file.stream);
    return file_commit(&file, error);
}

bool npy_save_field(const char *path, const struct field *field, struct error *error)
{
    const uint64_t shape[3] = {field->components, field->ny, field->nx};
    const bool scalar = field->components == 1;
    return npy_save(path, "<f8", shape + scalar, scalar ? 2 : 3, field->values, error);
}

static void skip_blanks(const char **at) { while (**at == ' ' || **at == '\n') ++*at; }

static bool take(const char **at, char wanted)
{
    skip_blanks(at);
    if (**at != wanted) return false;
    ++*at;
    return true;
}

/* descr: a quoted word, or a list that ends with its closing bracket. */
static bool parse_type(const char **at, struct npy *npy)
{
    const char *word;
    size_t length;
    if (**at == '[') {
        const char *end = strchr(*at, ']');
        if (!end) return false;
        word = *at;
        length = (size_t)(end + 1 - word);
        *at = end + 1;
    } else if ((length = quoted(at, &word)) == 0) {
        return false;
    }
    if (!strip_blanks(word, length, npy->type, sizeof npy->type)) return false;
    npy->width = type_width(npy->type);
    return npy->width > 0;
}

static bool parse_shape(const char **at, struct npy *npy)
{
    if (!take(at, '(')) return false;
    npy->count = 1;
    for (npy->dimensions = 0; !take(at, ')'); npy->dimensions++) {
        skip_blanks(at);
        if (!isdigit((unsigned char)**at) || npy->dimensions == NPY_DIMENSIONS_MAX) return false;
        char *end;
        const unsigned long long side = strtoull(*at, &end, 10);
        if (side > bytes_max) return false;
        if (__builtin_mul_overflow(npy->count, (uint64_t)side, &npy->count)) return false;
        npy->shape[npy->dimensions] = side;
        *at = end;
        if (!take(at, ',') && (skip_blanks(at), **at != ')')) return false;
    }
    return true;
}

/* The dictionary: exactly three keys, in any order. */
static bool parse_header(const char *at, struct npy *npy)
{
    unsigned seen = 0;
    if (!take(&at, '{')) return false;
    while (!take(&at, '}')) {
        const char *word = NULL;
        skip_blanks(&at);
        const size_t length = quoted(&at, &word);
        if (!take(&at, ':')) return false;
        skip_blanks(&at);
        if (length == 5 && strncmp(word, "descr", 5) == 0) {
            if ((seen & 1) || !parse_type(&at, npy)) return false;
            seen |= 1;
        } else if (length == 13 && strncmp(word, "fortran_order", 13) == 0) {
            if ((seen & 2) || strncmp(at, "False", 5) != 0) return false;
            at += 5;
            seen |= 2;
        } else if (length == 5 && strncmp(word, "shape", 5) == 0) {
            if ((seen & 4) || !parse_shape(&at, npy)) return false;
            seen |= 4;
        } else {
            return false;
        }
        if (!take(&at, ',') && (skip_blanks(&at), *at != '}')) return false;
    }
    skip_blanks(&at);
    return seen == 7 && *at == 0;
}

/* Where the values begin; 0 if there is no sound start. */
static size_t header_end(const unsigned char *bytes, size_t size, size_t *begin)
{
    if (size < START || memcmp(bytes, magic, sizeof magic) != 0) return 0;
    const bool wide = bytes[6] == 2 || bytes[6] == 3;
    if (!wide && bytes[6] != 1) return 0;
    *begin = wide ? START + 2 : START;
    if (size < *begin) return 0;
    size_t length = (size_t)bytes[8] | (size_t)bytes[9] << 8;
    if (wide) length |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
    return length <= HEADER_MAX && length <= size - *begin ? *begin + length : 0;
}

static bool parse(const char *path, const unsigned char *bytes, size_t size, struct npy *npy,
                  struct error *error)
{
    size_t begin = 0;
    const size_t end = header_end(bytes, size, &begin);
    if (end == 0) return error_set(error, "%s: not a NumPy array file, or cut short", path);
    char *text = strndup((const char *)bytes + begin, end - begin);
    const bool understood = text && strlen(text) == end - begin && parse_header(text, npy);
    free(text);
    if (!understood) {
        return error_set(error, "%s: its header is not that of an array of little-endian numbers "
                         "in C order; save it again with numpy.save", path);
    }
    uint64_t wanted;
    if (__builtin_mul_overflow(npy->count, npy->width, &wanted) || wanted != size - end) {
        return error_set(error, "%s: %zu bytes of values where its header promises %llu items of "
                         "%zu bytes; the file is torn", path, size - end,
                         (unsigned long long)npy->count, npy->width);
    }
    npy->values = malloc(size - end + 1);
    if (!npy->values) return error_set(error, "%s: not enough memory to read it", path);
    memcpy(npy->values, bytes + end, size - end);
    return true;
}

bool npy_load(const char *path, struct npy *npy, struct error *error)
{
    size_t size = 0;
    *npy = (struct npy){0};
    unsigned char *bytes = file_load(path, (size_t)bytes_max, &size, error);
    if (!bytes) return false;
    const bool done = parse(path, bytes, size, npy, error);
    free(bytes);
    if (!done) npy_free(npy);
    return done;
}

void npy_free(struct npy *npy)
{
    free(npy->values);
    *npy = (struct npy){0};
}
