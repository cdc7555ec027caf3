/* test_dump.c - a dumped frame comes back to the bit; foreign and torn files are refused.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "measure/dump.h"
#include "measure/dump_index.h"
#include "measure/npy.h"

#include <unistd.h>

static char folder[] = "/tmp/dump-XXXXXX";
static char frame[64], contacts[64], index_path[64];

static struct grains sample(uint32_t count)
{
    struct grains grains;
    struct error error;
    if (!grains_create(&grains, count + 1, 2, &error)) fail_msg("%s", error.text);
    grains.count = count;
    for (uint32_t k = 0; k < count; k++) {
        grains.id[k] = 1000 + 3 * k;
        grains.x[k] = 0.1 * k;
        grains.y[k] = -1.0 / (k + 1);
        grains.vx[k] = 1e-300 * k;
        grains.vy[k] = -0.0;
        grains.angle[k] = 2.5 + k;
        grains.spin[k] = -3.5 - k;
        grains.radius[k] = 0.5 + 0.01 * k;
        grains.mass[k] = 7.0 / (k + 3);
        grains.collision_rate[k] = 0.3f * (float)k;
        grains.species[k] = (uint16_t)(65535 - k);
    }
    grains.contact_count = count > 1 ? 2 : 0;
    grains.contacts[0] = (struct contact){0, 1, 1.5f, 2.5f, 3.5f, -4.5f, 0.01f};
    grains.contacts[1] = (struct contact){1, CONTACT_WALL + 5, 0, 1, 2, 3, 4};
    return grains;
}

static void test_a_frame_comes_back_to_the_bit(void **unused)
{
    (void)unused;
    struct grains out = sample(17), in;
    struct error error;
    CHECK(dump_save(frame, &out, &error) && dump_save_contacts(contacts, &out, &error));
    CHECK(dump_load(frame, contacts, &in, &error));
    CHECK(in.count == 17 && in.contact_count == 2);
#define X(name, type, word) CHECK(memcmp(in.name, out.name, 17 * sizeof *in.name) == 0);
    DUMP_FIELDS(X)
#undef X
    CHECK(memcmp(in.contacts, out.contacts, 2 * sizeof *in.contacts) == 0);
    grains_free(&in);
    CHECK(dump_load(frame, NULL, &in, &error) && in.count == 17 && in.contact_count == 0);
    grains_free(&in);
    grains_free(&out);
    out = sample(0);
    CHECK(dump_save(frame, &out, &error) && dump_save_contacts(contacts, &out, &error));
    CHECK(dump_load(frame, contacts, &in, &error) && in.count == 0 && in.x != NULL);
    grains_free(&in);
    grains_free(&out);
}

static void test_a_torn_or_foreign_frame_is_refused(void **unused)
{
    (void)unused;
    struct grains out = sample(5), in;
    struct error error;
    size_t size;
    CHECK(dump_save(frame, &out, &error) && dump_save_contacts(contacts, &out, &error));
    CHECK(!dump_load(contacts, NULL, &in, &error) && strstr(error.text, "not a dump of grains"));
    CHECK(!dump_load(frame, frame, &in, &error) && strstr(error.text, "not a dump of contacts"));
    const uint64_t shape[2] = {1, 5};
    CHECK(npy_save(frame, "<f8", shape, 2, out.x, &error));
    CHECK(!dump_load(frame, NULL, &in, &error) && in.x == NULL);
    CHECK(dump_save(frame, &out, &error));
    unsigned char *bytes = file_load(frame, 100000, &size, &error);
    for (size_t cut = 0; cut < size; cut += 7) {
        CHECK(file_save(frame, bytes, cut, &error) && !dump_load(frame, NULL, &in, &error));
    }
    free(bytes);
    /* Contacts of a frame with more grains must not lead beyond this frame's. */
    struct grains one = sample(1);
    CHECK(dump_save(frame, &one, &error));
    CHECK(!dump_load(frame, contacts, &in, &error) && strstr(error.text, "another frame"));
    CHECK(in.x == NULL);
    grains_free(&one);
    grains_free(&out);
}

static void test_numpy_finds_the_columns_by_name(void **unused)
{
    (void)unused;
    const char *python = getenv("PYTHON_WITH_NUMPY");
    if (!python || !*python) skip();
    struct grains out = sample(17);
    struct error error;
    char command[1024];
    CHECK(dump_save(frame, &out, &error) && dump_save_contacts(contacts, &out, &error));
    snprintf(command, sizeof command, "'%s' -c \"\n"
        "import numpy as n\n"
        "a = n.load('%s'); c = n.load('%s')\n"
        "k = n.arange(17)\n"
        "assert a.dtype.names == ('id', 'x', 'y', 'vx', 'vy', 'angle', 'spin', 'radius', 'mass', "
        "'collision_rate', 'species')\n"
        "assert (a['id'] == 1000 + 3 * k).all() and (a['x'] == 0.1 * k).all()\n"
        "assert (a['y'] == -1 / (k + 1)).all() and (a['spin'] == -3.5 - k).all()\n"
        "assert (a['mass'] == 7 / (k + 3)).all() and (a['species'] == 65535 - k).all()\n"
        "assert c['j'][1] == 0x40000005 and c['fy'][0] == -4.5 and len(c) == 2\n\"",
        python, frame, contacts);
    CHECK(system(command) == 0);
    grains_free(&out);
}

static void test_the_index_grows_line_by_line_and_survives_a_torn_one(void **unused)
{
    (void)unused;
    struct error error;
    struct dump_index index;
    for (uint32_t k = 0; k < 100; k++) {
        const struct dump_entry entry = {k, 0.1 * k, 1000000000000u + k, 5 * k, 2 * k};
        CHECK(dump_index_append(index_path, &entry, &error));
    }
    CHECK(dump_index_load(index_path, &index, &error) && index.count == 100);
    CHECK(index.entries[7].time == 0.1 * 7 && index.entries[7].steps == 1000000000007u);
    CHECK(index.entries[99].grains == 495 && index.entries[99].contacts == 198);
    CHECK(dump_index_nearest(&index, 0.74)->frame == 7);
    CHECK(dump_index_nearest(&index, 1e9)->frame == 99);
    dump_index_free(&index);

    FILE *stream = fopen(index_path, "ab");     /* a crash in the middle of a line */
    fputs("000100,10.0,1000", stream);
    fclose(stream);
    CHECK(dump_index_load(index_path, &index, &error) && index.count == 100);
    const struct dump_entry next = {100, 10, 5, 6, 7};
    CHECK(dump_index_append(index_path, &next, &error));
    dump_index_free(&index);
    CHECK(dump_index_load(index_path, &index, &error) && index.count == 101);
    CHECK(index.entries[100].steps == 5 && index.entries[100].contacts == 7);
    index.count = 50;                           /* resuming from an earlier time */
    CHECK(dump_index_save(index_path, &index, &error));
    dump_index_free(&index);
    CHECK(dump_index_load(index_path, &index, &error) && index.count == 50);
    dump_index_free(&index);
    CHECK(dump_index_nearest(&index, 1) == NULL);
}

static void test_what_is_no_index_is_refused(void **unused)
{
    (void)unused;
    const char *const bad[] = {"", "frame,time\n", "frame,time,steps,grains,contacts\n1,2,3\n",
                               "frame,time,steps,grains,contacts\n1,nan,3,4,5\n",
                               "frame,time,steps,grains,contacts\n1,2,3,4,5,6\n"};
    struct error error;
    struct dump_index index;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        CHECK(file_save(index_path, bad[k], strlen(bad[k]), &error));
        CHECK(!dump_index_load(index_path, &index, &error) && index.entries == NULL);
        CHECK(strstr(error.text, index_path));
    }
    CHECK(strstr(error.text, ":2:"));           /* the line to blame */
    const struct dump_entry entry = {0};
    CHECK(!dump_index_append("/nonexistent/index.csv", &entry, &error));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_frame_comes_back_to_the_bit),
        cmocka_unit_test(test_a_torn_or_foreign_frame_is_refused),
        cmocka_unit_test(test_numpy_finds_the_columns_by_name),
        cmocka_unit_test(test_the_index_grows_line_by_line_and_survives_a_torn_one),
        cmocka_unit_test(test_what_is_no_index_is_refused),
    };
    if (!mkdtemp(folder)) return 1;
    snprintf(frame, sizeof frame, "%s/000000.npy", folder);
    snprintf(contacts, sizeof contacts, "%s/000000.contacts.npy", folder);
    snprintf(index_path, sizeof index_path, "%s/index.csv", folder);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(frame);
    unlink(contacts);
    unlink(index_path);
    rmdir(folder);
    return failed;
}
