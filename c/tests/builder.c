// Models that a C program makes, and rows of results while a simulation goes on: against the package
// as it is installed.

#include "check.h"
#include "cognate.h"

static void the_header_is_that_of_the_library(void) {
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", COGNATE_VERSION_MAJOR, COGNATE_VERSION_MINOR, COGNATE_VERSION_PATCH);
    CHECK(strcmp(text, cognate_version()) == 0);
    CHECK(cognate_version_number() == COGNATE_VERSION_NUMBER);
}

// A rod of one metre on a hinge, lying along x. Puts the markers at its ends into `pivot` and `tip`.
static CognateBuilder *pendulum(CognateElement **pivot, CognateElement **tip) {
    CognateError *error = NULL;
    CognateBuilder *model = cognate_builder_new("pendulum", &error);
    NO_ERROR(error);
    cognate_element_set_text(cognate_builder_settings(model, "UNITS"), "SYSTEM", "MKS");
    cognate_element_set_number(cognate_builder_settings(model, "ACCGRAV"), "JGRAV", -9.81);
    CognateElement *rod = cognate_builder_element(model, "PART", "rod");
    const double moments[] = {0.0, 0.2, 0.2};
    cognate_element_set_number(rod, "MASS", 2);
    cognate_element_set_numbers(rod, "IP", moments, 3);
    cognate_element_set_element(rod, "CM", cognate_element_marker(rod, NULL, 0.5, 0, 0));
    *pivot = cognate_element_marker(rod, "pivot", 0, 0, 0);
    *tip = cognate_element_marker(rod, "tip", 1, 0, 0);
    CognateElement *hinge =
        cognate_builder_between(model, "revolute", "hinge", *pivot, cognate_builder_ground(model));
    CHECK(cognate_element_number(hinge) == 1);
    return model;
}

static CognateModel *built(CognateBuilder *model) {
    CognateError *error = NULL;
    CognateModel *made = cognate_builder_build(model, &error);
    NO_ERROR(error);
    CHECK(made != NULL);
    cognate_builder_free(model);
    return made;
}

static void a_pendulum_that_a_program_makes_keeps_its_energy(void) {
    CognateElement *pivot, *tip;
    CognateBuilder *builder = pendulum(&pivot, &tip);
    char height[32], speed[32];
    snprintf(height, sizeof height, "DY(%u)", cognate_element_number(tip));
    snprintf(speed, sizeof speed, "WZ(%u)", cognate_element_number(tip));
    CognateModel *model = built(builder);
    CognateError *error = NULL;
    char *text = cognate_model_text(model, &error);
    CHECK(strstr(text, "JOINT/1") != NULL && strstr(text, "REVOLUTE") != NULL && strstr(text, "'hinge'") != NULL);
    cognate_string_free(text);
    CognateOptions *options = cognate_options_new();
    CHECK(cognate_options_column(options, height, &error) && cognate_options_column(options, speed, &error));
    cognate_options_error(options, 1e-9);
    CognateSession *session = cognate_session_new(model, options, &error);
    NO_ERROR(error);
    CognateStatus status;
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 2.0, 100, &status, &error));
    size_t n, m;
    const double *y = cognate_session_column(session, cognate_session_find(session, height), &n);
    const double *w = cognate_session_column(session, cognate_session_find(session, speed), &m);
    CHECK(n == m && n == 101 && y[50] != y[0]);
    for (size_t k = 0; k < n; k++) NEAR(0.5 * (0.2 + 2 * 0.25) * w[k] * w[k] + 2 * 9.81 * 0.5 * y[k], 0.0, 1e-6);
    cognate_session_free(session);
    cognate_options_free(options);
    cognate_model_free(model);
}

static void every_word_of_the_table_makes_an_element(void) {
    char *words = cognate_builder_words();
    CHECK(words != NULL && strncmp(words, "PART\t", 5) == 0);
    int count = 0;
    for (char *line = words, *end; *line != 0; line = end + 1) {
        end = strchr(line, '\n');
        char *sentence = strchr(line, '\t');
        CHECK(end != NULL && sentence != NULL && sentence < end && end[-1] == '.');
        *sentence = 0;
        CognateBuilder *builder = cognate_builder_new("words", NULL);
        CognateElement *element = cognate_builder_element(builder, line, "it");
        CHECK(cognate_element_number(element) > 0);
        cognate_builder_free(builder);
        count++;
    }
    CHECK(count > 60);
    cognate_string_free(words);
}

static void joints_are_named_and_gears_and_shapes_refer_to_others(void) {
    CognateElement *pivot, *tip;
    CognateBuilder *model = pendulum(&pivot, &tip);
    CognateElement *ground = cognate_builder_ground(model);
    CognateElement *block = cognate_builder_element(model, "PART", "block");
    cognate_element_set_number(block, "MASS", 1);
    const double moments[] = {1, 1, 1}, along[] = {1, 0, 0}, across[] = {0, 1, 0};
    cognate_element_set_numbers(block, "IP", moments, 3);
    cognate_element_set_element(block, "CM", cognate_element_marker(block, NULL, 2, 0, 0));
    CognateElement *place = cognate_element_marker(block, "place", 2, 0, 0);
    cognate_element_axes(place, along, across);
    CognateElement *slide = cognate_builder_between(model, "TRANSLATIONAL", "slide", place, ground);
    CognateElement *hinge = cognate_builder_between(model, "REVOLUTE", "second", tip, block);
    CHECK(cognate_element_number(slide) == 2 && cognate_element_number(hinge) == 3);
    CognateElement *spring = cognate_builder_between(model, "SPRINGDAMPER", "coil", place, pivot);
    cognate_element_set_flag(spring, "TRANSLATIONAL");
    cognate_element_set_number(spring, "K", 100);
    cognate_element_set_number(spring, "LENGTH", 2);
    CognateElement *coupler = cognate_builder_element(model, "COUPLER", "belt");
    const CognateElement *joints[] = {slide, hinge};
    const double scales[] = {1, -0.5};
    cognate_element_set_elements(coupler, "JOINTS", joints, 2);
    cognate_element_set_text(coupler, "TYPE", "T:R");
    cognate_element_set_numbers(coupler, "SCALES", scales, 2);
    CognateElement *box = cognate_builder_element(model, "BOX", "shown");
    cognate_element_set_element(box, "CORNER", place);
    cognate_element_set_number(box, "X", 0.25);
    CognateModel *made = built(model);
    char *text = cognate_model_text(made, NULL);
    CHECK(strstr(text, "COUPLER/1") != NULL && strstr(text, "BOX") != NULL && strstr(text, "SPRINGDAMPER/1") != NULL);
    cognate_string_free(text);
    cognate_model_free(made);
}

static void all_mistakes_of_a_builder_are_told_at_once(void) {
    CognateError *error = NULL;
    CognateDiagnostic d;
    CognateBuilder *model = cognate_builder_new("mistakes", &error);
    CognateElement *wheel = cognate_builder_element(model, "PART", "wheel");
    cognate_element_set_number(wheel, "MASS", NAN);
    cognate_element_set_number(wheel, "WEIGHT", 1);
    cognate_element_set_number(wheel, NULL, 1);
    cognate_element_set_text(wheel, "MATERIAL", "\xff");
    CognateElement *lost = cognate_builder_element(model, "REVOLUT", "axle");
    cognate_element_set_number(lost, "IC", 1);
    CHECK(lost != NULL && cognate_element_number(lost) == 0);
    CHECK(cognate_element_marker(lost, "nowhere", 0, 0, 0) != NULL);
    cognate_builder_between(model, "REVOLUTE", "axle", wheel, NULL);
    cognate_builder_between(model, "REVOLUTE", "axle", wheel, cognate_builder_ground(model));
    cognate_element_axes(wheel, NULL, NULL);
    CognateElement *foreign, *tip;
    CognateBuilder *other = pendulum(&foreign, &tip);
    cognate_builder_between(model, "SPHERICAL", "ball", foreign, wheel);
    cognate_element_set_element(wheel, "CM", foreign);
    CHECK(cognate_builder_build(model, &error) == NULL && cognate_error_count(error) >= 9);
    char all[8192] = "";
    for (size_t k = 0; cognate_error_get(error, k, &d); k++) {
        CHECK(strcmp(d.code, "bug") != 0);
        strncat(all, d.text, sizeof all - strlen(all) - 1);
        strncat(all, "\n", sizeof all - strlen(all) - 1);
    }
    const char *said[] = {"REVOLUTE", "WEIGHT", "NaN", "keyword is NULL", "UTF-8", "an end of `axle` is NULL",
                          "another builder", "neither", "no marker", "no body"};
    for (size_t k = 0; k < sizeof said / sizeof *said; k++) {
        if (strstr(all, said[k]) == NULL) fprintf(stderr, "%s\n%s\n", said[k], all);
        CHECK(strstr(all, said[k]) != NULL);
    }
    cognate_error_free(error);
    cognate_builder_free(model);
    cognate_builder_free(other);
    // nothing breaks by NULL
    CHECK(cognate_builder_new(NULL, &error) == NULL && error != NULL);
    cognate_error_free(error);
    CHECK(cognate_builder_build(NULL, NULL) == NULL && cognate_builder_ground(NULL) == NULL);
    CHECK(cognate_builder_element(NULL, "PART", NULL) == NULL && cognate_builder_settings(NULL, "UNITS") == NULL);
    CHECK(cognate_element_marker(NULL, NULL, 0, 0, 0) == NULL && cognate_element_number(NULL) == 0);
    cognate_element_set_number(NULL, "MASS", 1);
    cognate_builder_free(NULL);
}

typedef struct {
    size_t rows, columns, most;
    double last;
} Seen;

static bool see(void *data, const double *values, size_t n) {
    Seen *seen = data;
    CHECK(seen->rows == 0 || values[0] > seen->last);
    seen->rows++, seen->columns = n, seen->last = values[0];
    return seen->rows < seen->most;
}

static CognateSession *swinging(bool bars) {
    CognateElement *pivot, *tip;
    CognateModel *model = built(pendulum(&pivot, &tip));
    CognateOptions *options = cognate_options_new();
    cognate_options_accuracy(options, bars);
    CHECK(cognate_options_column(options, "WZ(2)", NULL));
    CognateSession *session = cognate_session_new(model, options, NULL);
    CHECK(session != NULL);
    cognate_options_free(options);
    cognate_model_free(model);
    return session;
}

static void rows_come_while_a_simulation_goes_on_and_may_end_it(void) {
    CognateError *error = NULL;
    CognateStatus status;
    // all rows, once, in order; they stay in the results
    Seen seen = {0, 0, SIZE_MAX, 0.0};
    CognateSession *session = swinging(false);
    CHECK(cognate_session_rows(session, see, &seen, true, &error));
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 1.0, 50, &status, &error));
    size_t n;
    const double *time = cognate_session_column(session, 0, &n);
    CHECK(seen.rows == 51 && n == 51 && time[50] == seen.last && seen.columns == cognate_session_columns(session));
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 2.0, 50, &status, &error));
    CHECK(seen.rows >= 101 && seen.rows <= 102 && seen.last == 2.0);
    cognate_session_free(session);
    // none is kept
    seen = (Seen){0, 0, SIZE_MAX, 0.0};
    session = swinging(false);
    CHECK(cognate_session_rows(session, see, &seen, false, &error));
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 1.0, 50, &status, &error));
    cognate_session_column(session, 0, &n);
    CHECK(seen.rows == 51 && n == 0 && status == COGNATE_STATUS_COMPLETED);
    cognate_session_free(session);
    // enough of them
    seen = (Seen){0, 0, 3, 0.0};
    session = swinging(false);
    CHECK(cognate_session_rows(session, see, &seen, true, &error));
    cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 1e5, 1000000, &status, &error);
    NO_ERROR(error);
    CHECK(seen.rows == 3 && status == COGNATE_STATUS_INTERRUPTED);
    cognate_session_free(session);
    // bars are found at the end, so rows with them cannot come before
    session = swinging(true);
    CHECK(!cognate_session_rows(session, see, &seen, true, &error) && error != NULL);
    cognate_error_free(error);
    CHECK(!cognate_session_rows(session, NULL, NULL, true, NULL) && !cognate_session_rows(NULL, see, &seen, true, NULL));
    cognate_session_free(session);
}

static void rows_are_taken_from_a_queue_between_simulations(void) {
    CognateError *error = NULL;
    double values[8];
    CognateSession *session = swinging(false);
    CognateRows *rows = cognate_session_queue(session, false, &error);
    NO_ERROR(error);
    CHECK(cognate_rows_next(rows, values, 8, 0.0, &error) == COGNATE_NEXT_NONE);
    for (int part = 1; part <= 3; part++) {
        CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, part, 10, NULL, &error));
        int count = 0;
        while (cognate_rows_next(rows, values, 8, 0.0, &error) == COGNATE_NEXT_ROW) count++;
        NO_ERROR(error);
        CHECK((count == 10 || count == 11) && values[0] == part);
    }
    CHECK(cognate_rows_next(rows, values, 8, NAN, &error) == COGNATE_NEXT_NONE && error == NULL);
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 4, 1, NULL, &error));
    CHECK(cognate_rows_next(rows, values, 1, 0.0, &error) == COGNATE_NEXT_ENDED && error != NULL);
    cognate_error_free(error);
    CHECK(cognate_rows_next(NULL, values, 8, 0.0, NULL) == COGNATE_NEXT_ENDED);
    cognate_session_free(session);
    while (cognate_rows_next(rows, values, 8, 0.0, NULL) == COGNATE_NEXT_ROW) {}
    CHECK(cognate_rows_next(rows, values, 8, 1e300, NULL) == COGNATE_NEXT_ENDED);
    cognate_rows_free(rows);
    cognate_rows_free(NULL);
}

int main(void) {
    the_header_is_that_of_the_library();
    a_pendulum_that_a_program_makes_keeps_its_energy();
    every_word_of_the_table_makes_an_element();
    joints_are_named_and_gears_and_shapes_refer_to_others();
    all_mistakes_of_a_builder_are_told_at_once();
    rows_come_while_a_simulation_goes_on_and_may_end_it();
    rows_are_taken_from_a_queue_between_simulations();
    puts("builder and rows in C: all claims hold");
    return 0;
}
