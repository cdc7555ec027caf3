/* test_npy.c - array files follow NumPy's format to the byte, and no header can mislead.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "measure/npy.h"

#include <unistd.h>

static char folder[] = "/tmp/npy-XXXXXX";
static char path[64];

static void test_the_bytes_are_those_of_the_format(void **unused)
{
    (void)unused;
    const double values[6] = {1, -2, 0.5, NAN, INFINITY, 1e-300};
    const uint64_t shape[2] = {2, 3};
    struct error error;
    size_t size;
    CHECK(npy_save(path, "<f8", shape, 2, values, &error));
    unsigned char *bytes = file_load(path, 1000, &size, &error);
    /* NEP 1: magic, version 1.0, length of the header, a dictionary padded with blanks and ended
     * by a line feed such that the values begin at a multiple of 64. */
    CHECK(bytes && memcmp(bytes, "\x93NUMPY\x01\x00\x76\x00", 10) == 0);
    const char *dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
    CHECK(memcmp(bytes + 10, dictionary, strlen(dictionary)) == 0);
    CHECK(bytes[126] == ' ' && bytes[127] == '\n' && size == 128 + sizeof values);
    CHECK(memcmp(bytes + 128, values, sizeof values) == 0);
    free(bytes);
}

static void test_what_is_saved_is_loaded(void **unused)
{
    (void)unused;
    const char *types[] = {"<f8", "<f4", "<i4", "<u2", "|u1", "<i8",
                           "[('id', '<u4'), ('x', '<f8'), ('species', '<u2')]"};
    const size_t widths[] = {8, 4, 4, 2, 1, 8, 14};
    unsigned char values[12 * 14];
    struct error error;
    for (size_t k = 0; k < sizeof values; k++) values[k] = (unsigned char)(k * 7);
    for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
        const uint64_t shapes[4][2] = {{0, 0}, {12, 0}, {3, 4}, {0, 5}};
        const uint32_t dimensions[4] = {0, 1, 2, 2}, counts[4] = {1, 12, 12, 0};
        CHECK(npy_width(types[t]) == widths[t]);
        for (size_t s = 0; s < 4; s++) {
            struct npy npy;
            CHECK(npy_save(path, types[t], shapes[s], dimensions[s], values, &error));
            CHECK(npy_load(path, &npy, &error));
            CHECK(npy_is(&npy, types[t]) && npy.width == widths[t] && npy.count == counts[s]);
            CHECK(npy.dimensions == dimensions[s]);
            CHECK(memcmp(npy.shape, shapes[s], dimensions[s] * sizeof(uint64_t)) == 0);
            CHECK(memcmp(npy.values, values, npy.count * npy.width) == 0);
            npy_free(&npy);
        }
    }
}

/* Loads a file with this dictionary and so many bytes of values. */
static bool loads(const char *dictionary, size_t values)
{
    unsigned char bytes[4096] = "\x93NUMPY\x01\x00";
    const size_t length = strlen(dictionary);
    struct error error = {0};
    struct npy npy;
    bytes[8] = (unsigned char)(length & 255);
    bytes[9] = (unsigned char)(length >> 8);
    memcpy(bytes + 10, dictionary, length);
    CHECK(file_save(path, bytes, 10 + length + values, &error));
    const bool done = npy_load(path, &npy, &error);
    CHECK(done || strstr(error.text, path));    /* the sentence names the file */
    CHECK(done || npy.values == NULL);
    if (done) npy_free(&npy);
    return done;
}

static void test_hostile_headers_are_refused(void **unused)
{
    (void)unused;
    /* First some that are unusual but sound, so that what follows fails for its own reason. */
    CHECK(loads("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", 16));
    CHECK(loads("{\"shape\":(2,),\"fortran_order\":False,\"descr\":\"<f8\"}\n", 16));
    CHECK(loads("{'descr': [('a', '<f4'), ('b', '|u1')], 'fortran_order': False, "
                "'shape': (3)}", 15));
    static const struct { const char *text; size_t values; } bad[] = {
        {"", 16},
        {"{}", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2,), ", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2,), } x", 16},
        {"{'descr': '<f8', 'fortran_order': False}", 16},
        {"{'descr': '<f8', 'fortran_order': True, 'shape': (2,), }", 16},
        {"{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2,), 'more': 1}", 16},
        {"{'descr': '>f8', 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': '<f2', 'fortran_order': False, 'shape': (8,), }", 16},
        {"{'descr': '<f9', 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': '<U4', 'fortran_order': False, 'shape': (1,), }", 16},
        {"{'descr': '<f8, 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': [('a', '<f4'), 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': [('a', '<f4', (2,))], 'fortran_order': False, 'shape': (2,), }", 16},
        {"{'descr': [], 'fortran_order': False, 'shape': (2,), }", 0},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (-2,), }", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2 2), }", 32},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2,,), }", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': 2, }", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1,1,1,1,1,1,1,1,2), }", 16},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }", 16},      /* torn */
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }", 16},      /* too long */
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,), }", 16},
        /* 2^32 * 2^32 * 8 bytes is 0 in 64 bits; so is 2^61 * 8. */
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }", 0},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (34359738368, 67108864), }", 0},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        if (loads(bad[k].text, bad[k].values)) fail_msg("taken for sound: %s", bad[k].text);
    }
}

static void test_a_file_cut_anywhere_is_refused(void **unused)
{
    (void)unused;
    const double values[3] = {1, 2, 3};
    const uint64_t shape = 3;
    struct error error;
    struct npy npy;
    size_t size;
    CHECK(npy_save(path, "<f8", &shape, 1, values, &error));
    unsigned char *bytes = file_load(path, 1000, &size, &error);
    for (size_t cut = 0; cut < size; cut++) {
        CHECK(file_save(path, bytes, cut, &error));
        CHECK(!npy_load(path, &npy, &error) && npy.values == NULL);
    }
    bytes[8] = bytes[9] = 255;                  /* a header longer than the file */
    CHECK(file_save(path, bytes, size, &error) && !npy_load(path, &npy, &error));
    memset(bytes + 20, 0, 1);                   /* a zero byte in the text */
    bytes[8] = 0x76, bytes[9] = 0;
    CHECK(file_save(path, bytes, size, &error) && !npy_load(path, &npy, &error));
    free(bytes);
    CHECK(!npy_load("/nonexistent/a.npy", &npy, &error) && strstr(error.text, "/nonexistent"));
    CHECK(!npy_save("/nonexistent/a.npy", "<f8", &shape, 1, values, &error));
}

static void test_numpy_and_we_read_each_other(void **unused)
{
    (void)unused;
    const char *python = getenv("PYTHON_WITH_NUMPY");
    if (!python || !*python) skip();
    double values[6] = {1, -2, 0.5, 1e-300, 4, 5};
    struct field field = {.nx = 3, .ny = 2, .components = 1, .values = values};
    struct error error;
    struct npy npy;
    char command[1024], other[80];
    CHECK(npy_save_field(path, &field, &error));
    snprintf(other, sizeof other, "%s/other.npy", folder);
    snprintf(command, sizeof command, "'%s' -c \"\n"
        "import numpy as n\n"
        "a = n.load('%s')\n"
        "assert a.dtype == n.float64 and a.shape == (2, 3)\n"
        "assert (a == [[1, -2, 0.5], [1e-300, 4, 5]]).all()\n"
        "b = n.zeros(2, dtype=[('id', '<u4'), ('x', '<f8')])\n"
        "b['id'] = [7, 8]; b['x'] = [0.25, -1]\n"
        "n.save('%s', b)\n\"", python, path, other);
    CHECK(system(command) == 0);
    CHECK(npy_load(other, &npy, &error) && npy_is(&npy, "[('id', '<u4'), ('x', '<f8'), ]") == 0);
    CHECK(npy_is(&npy, "[('id', '<u4'), ('x', '<f8')]") && npy.count == 2 && npy.width == 12);
    double x;
    memcpy(&x, (char *)npy.values + 12 + 4, sizeof x);
    CHECK(x == -1);
    npy_free(&npy);
    unlink(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_bytes_are_those_of_the_format),
        cmocka_unit_test(test_what_is_saved_is_loaded),
        cmocka_unit_test(test_hostile_headers_are_refused),
        cmocka_unit_test(test_a_file_cut_anywhere_is_refused),
        cmocka_unit_test(test_numpy_and_we_read_each_other),
    };
    if (!mkdtemp(folder)) return 1;
    snprintf(path, sizeof path, "%s/a.npy", folder);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    rmdir(folder);
    return failed;
}
