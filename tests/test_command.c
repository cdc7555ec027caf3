/* test_command.c - the grammar of a live session: what is taken, and what is said to the rest.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "check.h"
#include "live/command.h"
#include "live/expression.h"

#include <stdbool.h>

static struct command_line line;
static struct error error;

static bool parses(const char *text)
{
    error = (struct error){0};
    return command_parse(text, &line, &error);
}

static void test_every_form_of_every_command_is_taken(void **unused)
{
    (void)unused;
    static const char *const lines[] = {
        "pause", "go", "go until 2.5", "step", "step 10", "speed 0.5", "speed max", "back",
        "back 1e-3", "reset", "set grains.[0].restitution 0.7", "set gravity = (0, -9.81)",
        "get md.dt", "color spin", "map density", "zoom 2", "zoom 2 0.5 1", "zoom 0 0 1 1",
        "pan -0.1 0", "fit", "inspect 7", "inspect 0.5 1.5", "follow", "follow 3",
        "push 1 2 3 4", "push 1 2 3 4 5", "gate open", "gate close", "gate open 2",
        "tilt -30", "pour 10", "pour 10 0.5 2", "frame a.png", "movie a.mp4 start",
        "movie stop", "movie a.mp4 stop", "checkpoint c", "expect grains > 3", "help",
        "help push", "quit", "", "   ", "# a remark", "  go  until  3  ",
    };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        if (!parses(lines[k])) fail_msg("'%s' was refused: %s", lines[k], error.text);
    }
    CHECK(parses("push 1 2 3 4 5"));
    CHECK(line.verb == COMMAND_push && line.number_count == 5 && line.numbers[4] == 5);
    CHECK(parses("set gravity = (0, -9.81)"));
    CHECK(strcmp(line.word, "gravity") == 0 && strcmp(line.rest, "(0, -9.81)") == 0);
    CHECK(parses("expect grains  <= 3"));
    CHECK(strcmp(line.rest, "grains  <= 3") == 0);
    CHECK(parses("movie a.gif start"));
    CHECK(strcmp(line.word, "a.gif") == 0 && strcmp(line.literal, "start") == 0);
}

/* Each verb has a row, and its usage parses back to its own forms. */
static void test_usage_names_the_command(void **unused)
{
    (void)unused;
    char usage[200];
    for (int verb = 0; verb < COMMAND_COUNT; verb++) {
        command_usage((enum command_verb)verb, usage, sizeof usage);
        const char *name = command_table[verb].name;
        CHECK(strncmp(usage, name, strlen(name)) == 0);
        CHECK((int)command_find(name) == verb);
        CHECK(strlen(command_table[verb].doc) > 10);
    }
    CHECK(strcmp(command_usage(COMMAND_go, usage, sizeof usage), "go [until T]") == 0);
    for (const struct command_key *key = command_keys; key->name; key++) {
        CHECK(parses(key->running));
        CHECK(parses(key->resting));
    }
}

static void test_what_is_wrong_is_said_with_the_usage(void **unused)
{
    (void)unused;
    static const char *const wrong[][2] = {
        {"goo", "did you mean 'go'"}, {"pushh 1 2", "did you mean 'push'"},
        {"nonsense at all", "`help` lists them"}, {"go until", "go [until T]"},
        {"go for 3", "go [until T]"}, {"step x", "step [N]"}, {"push 1 2 3", "push X Y VX VY"},
        {"push 1 2 3 4 5 6", "push X Y VX VY"}, {"zoom 1e999", "zoom FACTOR"},
        {"zoom nan", "zoom FACTOR"}, {"step 0x", "step [N]"}, {"set gravity", "set KEY VALUE"},
        {"pause now", "pause"}, {"gate ajar", "gate open"}, {"color", "color WHAT"},
        {"color a b", "color WHAT"}, {"get\tx", "control"}, {"go\nquit", "control"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        CHECK(!parses(wrong[k][0]));
        CHECK(error.code == EXIT_USAGE);
        if (!strstr(error.text, wrong[k][1])) {
            fail_msg("'%s': no '%s' in: %s", wrong[k][0], wrong[k][1], error.text);
        }
    }
}

/* Every length around the limits, of every kind of argument. */
static void test_long_lines_are_bounded(void **unused)
{
    (void)unused;
    static char text[4 * COMMAND_LINE_MAX];
    static const char *const heads[] = {"", "set a ", "set ", "get ", "expect ", "push 1 ", "go "};
    for (size_t h = 0; h < sizeof heads / sizeof *heads; h++) {
        for (size_t length = 1; length < 2 * COMMAND_LINE_MAX; length += 7) {
            const size_t head = strlen(heads[h]);
            memcpy(text, heads[h], head);
            memset(text + head, '1', length);
            text[head + length] = 0;
            if (parses(text)) CHECK(head + length < COMMAND_LINE_MAX);
        }
    }
    memset(text, ' ', COMMAND_LINE_MAX + 100);
    strcpy(text + COMMAND_LINE_MAX + 100, "go");
    CHECK(parses(text) && line.verb == COMMAND_go);     /* spaces before do not count */
}

static bool names(void *context, const char *name, double *value)
{
    (void)context;
    if (strcmp(name, "grains") == 0) *value = 12;
    else if (strcmp(name, "md.dt") == 0) *value = 0.5;
    else return false;
    return true;
}

static double value_of(const char *text)
{
    double value = NAN;
    error = (struct error){0};
    return expression_value(text, names, NULL, &value, &error) ? value : NAN;
}

static void test_expressions_bind_as_in_arithmetic(void **unused)
{
    (void)unused;
    CHECK_NEAR(value_of("1 + 2 * 3 - 8 / 4"), 5, 0);
    CHECK_NEAR(value_of("(1 + 2) * -3"), -9, 0);
    CHECK_NEAR(value_of("8 - 3 - 2"), 3, 0);
    CHECK_NEAR(value_of("abs(2 - grains)"), 10, 0);
    CHECK(value_of("grains == 12") == 1);
    CHECK(value_of("grains != 12") == 0);
    CHECK(value_of("md.dt <= 0.5 and grains > 1e1") == 1);
    CHECK(value_of("md.dt < 0.5 and grains > 1e1") == 0);
    CHECK(value_of("grains >= 13") == 0);
}

static void test_wrong_expressions_are_refused(void **unused)
{
    (void)unused;
    static const char *const wrong[] = {"", "1 +", "(1", "1)", "1 2", "grain", "abs 1", "abs(1",
                                        "1 < ", "* 2", "and", "1 and", "grains > 3 4", "#"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        if (!isnan(value_of(wrong[k]))) fail_msg("'%s' was taken", wrong[k]);
        CHECK(error.code == EXIT_USAGE && error.text[0]);
    }
    static char deep[20000];
    memset(deep, '(', sizeof deep - 1);
    CHECK(isnan(value_of(deep)));
    memset(deep, '-', sizeof deep - 1);
    CHECK(isnan(value_of(deep)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_form_of_every_command_is_taken),
        cmocka_unit_test(test_usage_names_the_command),
        cmocka_unit_test(test_what_is_wrong_is_said_with_the_usage),
        cmocka_unit_test(test_long_lines_are_bounded),
        cmocka_unit_test(test_expressions_bind_as_in_arithmetic),
        cmocka_unit_test(test_wrong_expressions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
