/* test_chart.c - what is put into a chart stands in its table, and tables read back.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "measure/chart.h"
#include "measure/table.h"

#include <unistd.h>

static char path[] = "chart-XXXXXX";

static void write_text(const char *text)
{
    struct error error;
    if (!file_save(path, text, strlen(text), &error)) fail_msg("%s", error.text);
}

static double line(double x, const void *context) { return *(const double *)context * x; }

static void test_a_chart_saves_every_point_of_every_curve(void **unused)
{
    (void)unused;
    struct chart chart;
    struct error error;
    const double slope = 3;
    chart_begin(&chart, "title", "x [s]", "y");
    chart_curve(&chart, CHART_POINTS, "first, \"quoted\"");
    for (int k = 0; k < 300; k++) chart_point(&chart, k, 0.125 * k);
    chart_curve(&chart, CHART_ERRORS, "second");
    chart_error(&chart, 1.0 / 3, 2, 0.25);
    chart_law(&chart, "law", line, &slope, 0, 4, 5);
    CHECK(chart_save_csv(&chart, path, &error));
    size_t size;
    char *text = file_load(path, 1 << 20, &size, &error);
    CHECK(strncmp(text, "curve,x,y,error\n# units: ,x [s],y,\nfirst; ;quoted;,0,0,nan\n", 58) == 0);
    CHECK(strstr(text, "\nfirst; ;quoted;,299,37.375,nan\nsecond,0.3333333333333333,2,0.25\nlaw,0,"));
    CHECK(strstr(text, "\nlaw,4,12,nan\n"));
    CHECK_NEAR(chart_at(&chart, 0, 10.5), 1.3125, 1e-12);
    CHECK_NEAR(chart_at(&chart, 2, 2), 6, 1e-12);
    CHECK(isnan(chart_at(&chart, 0, 1000)));
    free(text);
    chart_free(&chart);
}

static void test_a_table_reads_back_names_units_and_numbers(void **unused)
{
    (void)unused;
    struct table table;
    struct error error;
    write_text("time,energy,,force\n# units: s,erg,,\n0,1.5,nan,-2e3\n# a word\n1,0x1p-2,,7\n");
    CHECK(table_load(path, &table, &error));
    CHECK(table.columns == 4 && table.rows == 2);
    CHECK(table_find(&table, "force") == 3 && table_find(&table, "forces") == -1);
    CHECK(strcmp(table.units[1], "erg") == 0 && strcmp(table.units[3], "") == 0);
    CHECK_NEAR(table_at(&table, 0, 3), -2000, 0);
    CHECK_NEAR(table_at(&table, 1, 1), 0.25, 0);
    CHECK(isnan(table_at(&table, 0, 2)) && isnan(table_at(&table, 1, 2)));
    CHECK(isnan(table_at(&table, 1, -1)));
    table_free(&table);
}

static void test_a_torn_table_is_refused_with_its_line(void **unused)
{
    (void)unused;
    static const char *const torn[] = {"a,b\n1,2\n3\n", "a,b\n1,2\n3,4,5\n", "a,b\n1,2\n3,x\n"};
    struct table table;
    for (int k = 0; k < 3; k++) {
        struct error error = {0};
        write_text(torn[k]);
        CHECK(!table_load(path, &table, &error));
        CHECK(strstr(error.text, ":3: not 2 numbers"));
    }
    struct error error = {0};
    CHECK(!table_load("no/such/table.csv", &table, &error));
    CHECK(strstr(error.text, "no/such/table.csv"));
}

static int begin(void **unused)
{
    (void)unused;
    const int file = mkstemp(path);
    return file < 0 ? -1 : close(file);
}

static int end(void **unused)
{
    (void)unused;
    return unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_chart_saves_every_point_of_every_curve),
        cmocka_unit_test(test_a_table_reads_back_names_units_and_numbers),
        cmocka_unit_test(test_a_torn_table_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
