// Everything of include/cognate.h from C11, with results that are known. Arguments: a shared library
// with routines (routines.c), a folder for files.

#include "check.h"
#include "cognate.h"

static const char *FALLING =
    "a falling ball\n"
    "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\n"
    "ACCGRAV/KGRAV=-10\n"
    "PART/1, GROUND\n"
    "MARKER/1, PART=1\n"
    "PART/2, MASS=2, CM=2, IP=1,1,1\n"
    "MARKER/2, PART=2\n"
    "REQUEST/1, F4=DZ(2)\\, CNAMES=\"\",\"\",\"\",\"Z\",\"\",\"\",\"\",\"\", RESULTS_NAME=ball\n"
    "END\n";

// a mass of 2 on a rail along z, pushed by SFORCE/3; VARIABLE, SENSOR, REQUEST with USER
static const char *PUSHED =
    "a cart that routines push\n"
    "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\n"
    "PART/1, GROUND\n"
    "MARKER/1, PART=1\n"
    "PART/2, MASS=2, CM=2, IP=1,1,1\n"
    "MARKER/2, PART=2\n"
    "JOINT/1, TRANSLATIONAL, I=2, J=1\n"
    "SFORCE/3, TRANSLATIONAL, I=2, J=1, ACTIONONLY, FUNCTION=USER(8)\\\n"
    "VARIABLE/4, FUNCTION=USER(3)\\\n"
    "REQUEST/5, FUNCTION=USER(1,2)\\\n"
    "END\n";

static CognateModel *model_of(const char *text) {
    CognateError *error = NULL;
    CognateModel *model = cognate_model_from_memory(text, strlen(text), NULL, &error);
    NO_ERROR(error);
    CHECK(model != NULL);
    return model;
}

static const double *column_of(CognateSession *session, const char *name, size_t *n) {
    size_t at = cognate_session_find(session, name);
    CHECK(at != SIZE_MAX);
    const double *column = cognate_session_column(session, at, n);
    CHECK(column != NULL && *n > 0);
    return column;
}

static void expressions_have_values_gradients_and_columns(void) {
    CognateError *error = NULL;
    CognateExpr *blend =
        cognate_expr_parse("STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)", COGNATE_DIALECT_FUNCTION, &error);
    NO_ERROR(error);
    CHECK(cognate_expr_inputs(blend) == 1 && strcmp(cognate_expr_input(blend, 0), "TIME") == 0);
    CHECK(cognate_expr_input(blend, 1) == NULL);
    double t = 0.25, value = 0.0, slope = 0.0;
    CHECK(cognate_expr_eval(blend, &t, 1, &value, &error) && value == 1.03515625);
    double high, low, up = t + 1e-6, down = t - 1e-6;
    CHECK(cognate_expr_eval(blend, &up, 1, &high, NULL) && cognate_expr_eval(blend, &down, 1, &low, NULL));
    CHECK(cognate_expr_gradient(blend, &t, 1, NULL, &slope, &error));
    NEAR(slope, (high - low) / 2e-6, 1e-6);

    enum { N = 1000 };
    static double times[N], values[N], slopes[N];
    for (int k = 0; k < N; k++) times[k] = k / 500.0;
    const double *inputs[] = {times};
    double *gradients[] = {slopes};
    CHECK(cognate_expr_batch(blend, inputs, 1, N, values, NULL, &error));
    for (int k = 0; k < N; k++) {
        CHECK(cognate_expr_eval(blend, &times[k], 1, &value, NULL) && value == values[k]);
    }
    CHECK(cognate_expr_batch(blend, inputs, 1, N, values, gradients, &error));
    CHECK(slopes[125] == slope);
    cognate_expr_free(blend);
}

// x², and how often it was asked for
static bool square(void *data, const double *arguments, size_t n, double *value, double *slopes) {
    ++*(int *)data;
    if (n != 1 || arguments[0] == 7.0) return false;
    *value = arguments[0] * arguments[0];
    if (slopes != NULL) slopes[0] = 2.0 * arguments[0];
    return true;
}

static CognateNames *names_of_mine(int *calls) {
    CognateError *error = NULL;
    CognateNames *names = cognate_names_new(COGNATE_DIALECT_FUNCTION, &error);
    CHECK(cognate_names_variable(names, "x", &error) && cognate_names_variable(names, "v", &error));
    CHECK(cognate_names_constant(names, "g", 9.81, &error));
    CHECK(cognate_names_define(names, "hertz(x, k)", "k*MAX(x, 0)**1.5", &error));
    CHECK(cognate_names_function(names, "square", 1, square, true, calls, &error));
    CHECK(cognate_names_function(names, "number", 1, square, false, calls, &error));
    NO_ERROR(error);
    return names;
}

static void expressions_take_names_of_the_caller(void) {
    CognateError *error = NULL;
    CognateDiagnostic d;
    int calls = 0;
    CognateNames *names = names_of_mine(&calls);
    CognateExpr *force = cognate_expr_parse_with("HERTZ(x, 2e5) + g*square(v) + 0*TIME", names, &error);
    NO_ERROR(error);
    CognateExpr *plain = cognate_expr_parse_with("number(v)*x", names, &error);
    NO_ERROR(error);
    CognateExpr *wrong = cognate_expr_parse_with("hurtz(x, 2) + 1", names, &error);
    CHECK(wrong == NULL && cognate_error_get(error, 0, &d) && strstr(d.advice, "hertz") != NULL);
    cognate_error_free(error);
    // what is wrong with names is told at once, and expressions of before go on without them
    CHECK(cognate_names_variable(names, "SIN", &error) && cognate_names_constant(names, "x", 1.0, &error));
    CHECK(cognate_names_define(names, "broken(", "1", &error) && error == NULL);
    CHECK(cognate_expr_parse_with("x", names, &error) == NULL && cognate_error_count(error) == 3);
    CHECK(cognate_error_get(error, 0, &d) && strcmp(d.code, "bad_registration") == 0);
    cognate_error_free(error);
    cognate_names_free(names);

    // variables come first, in their order
    CHECK(cognate_expr_inputs(force) == 3);
    CHECK(strcmp(cognate_expr_input(force, 0), "x") == 0 && strcmp(cognate_expr_input(force, 1), "v") == 0);
    double inputs[] = {0.01, 2.0, 5.0}, value, slopes[3];
    CHECK(cognate_expr_eval(force, inputs, 3, &value, &error));
    NEAR(value, 200.0 + 4.0 * 9.81, 1e-12);
    CHECK(cognate_expr_gradient(force, inputs, 3, &value, slopes, &error) && calls >= 2);
    NEAR(slopes[0], 30000.0, 1e-9);
    NEAR(slopes[1], 4.0 * 9.81, 1e-12);
    CHECK(slopes[2] == 0.0);
    double x[] = {0.01, 0.02, 0.03}, v[] = {1.0, 7.0, 3.0}, times[] = {0.0, 0.0, 0.0}, values[3];
    const double *columns[] = {x, v, times};
    CHECK(!cognate_expr_batch(force, columns, 3, 3, values, NULL, &error));
    CHECK(cognate_error_get(error, 0, &d) && strstr(d.message, "point 1") != NULL);
    CHECK(isnan(values[1]) && isfinite(values[0]) && isfinite(values[2]));
    cognate_error_free(error);
    // of a callback alone the derivatives are not known
    CHECK(cognate_expr_eval(plain, inputs, 2, &value, &error) && value == 0.04);
    CHECK(!cognate_expr_gradient(plain, inputs, 2, &value, slopes, &error));
    CHECK(cognate_error_get(error, 0, &d) && strstr(d.message, "number") != NULL);
    cognate_error_free(error);
    cognate_expr_free(force);
    cognate_expr_free(plain);
}

static void mistakes_have_code_place_and_advice(void) {
    CognateError *error = NULL;
    CognateDiagnostic d;
    CHECK(cognate_expr_parse("2*STPE(TIME, 1, 0, 2, 1)", COGNATE_DIALECT_FUNCTION, &error) == NULL);
    CHECK(cognate_error_count(error) == 1 && cognate_error_get(error, 0, &d));
    CHECK(strcmp(d.code, "unknown_name") == 0 && d.line == 1 && d.column == 3);
    CHECK(strstr(d.advice, "STEP") != NULL && d.severity == COGNATE_SEVERITY_ERROR);
    CHECK(!cognate_error_get(error, 1, &d));
    cognate_error_free(error);

    CognateExpr *ln = cognate_expr_parse("LOG(TIME)", COGNATE_DIALECT_FUNCTION, &error);
    double times[] = {1.0, -1.0, 2.0}, values[3];
    const double *inputs[] = {times};
    CHECK(!cognate_expr_eval(ln, &times[1], 1, values, &error));
    CHECK(cognate_error_get(error, 0, &d) && strcmp(d.code, "domain") == 0);
    cognate_error_free(error);
    CHECK(!cognate_expr_batch(ln, inputs, 1, 3, values, NULL, &error));
    CHECK(cognate_error_get(error, 0, &d) && strstr(d.message, "point 1") != NULL);
    CHECK(values[0] == 0.0 && isnan(values[1]));
    NEAR(values[2], log(2.0), 1e-15);
    cognate_error_free(error);
    CHECK(!cognate_expr_eval(ln, times, 2, values, &error));
    cognate_error_free(error);
    cognate_expr_free(ln);

    const char *wrong = "two mistakes\nPART/1, GROUND\nPART/2, MASS=-2, CM=9\nEND\n";
    CHECK(cognate_model_from_memory(wrong, strlen(wrong), "wrong.adm", &error) == NULL);
    CHECK(cognate_error_count(error) >= 2 && cognate_error_get(error, 0, &d));
    CHECK(strcmp(d.file, "wrong.adm") == 0 && strcmp(d.element, "PART/2") == 0 && d.line == 3);
    cognate_error_free(error);
}

static void nothing_that_is_passed_breaks_anything(void) {
    CognateError *error = NULL;
    double x = 0.0;
    CHECK(cognate_expr_parse(NULL, COGNATE_DIALECT_FUNCTION, &error) == NULL && error != NULL);
    cognate_error_free(error);
    CHECK(cognate_expr_parse("1", 77, &error) == NULL && error != NULL);
    cognate_error_free(error);
    CHECK(cognate_expr_parse("\xff\xfe", COGNATE_DIALECT_FUNCTION, &error) == NULL && error != NULL);
    cognate_error_free(error);
    CHECK(cognate_expr_parse("((", COGNATE_DIALECT_FUNCTION, NULL) == NULL);
    CHECK(!cognate_expr_eval(NULL, &x, 1, &x, NULL));
    CHECK(!cognate_session_simulate(NULL, COGNATE_KIND_DYNAMIC, 1.0, 1, NULL, NULL));
    CHECK(cognate_names_new(77, NULL) == NULL && !cognate_names_variable(NULL, "x", NULL));
    CHECK(cognate_expr_parse_with("x", NULL, NULL) == NULL);
    CognateNames *names = cognate_names_new(COGNATE_DIALECT_FUNCTION, NULL);
    CHECK(!cognate_names_variable(names, NULL, NULL) && !cognate_names_define(names, "f(x)", NULL, NULL));
    CHECK(!cognate_names_function(names, "f", 1, NULL, false, NULL, &error) && error != NULL);
    cognate_error_free(error);
    cognate_names_free(names);
    cognate_names_free(NULL);
    CHECK(cognate_model_read("nowhere.adm", NULL) == NULL);
    CHECK(cognate_model_from_memory(NULL, 10, NULL, NULL) == NULL);
    CHECK(cognate_error_count(NULL) == 0 && cognate_session_columns(NULL) == 0);
    CHECK(isnan(cognate_session_time(NULL)) && cognate_session_find(NULL, "x") == SIZE_MAX);
    cognate_expr_free(NULL);
    cognate_model_free(NULL);
    cognate_session_free(NULL);
    cognate_options_free(NULL);
    cognate_error_free(NULL);
    cognate_string_free(NULL);
    cognate_session_interrupt(NULL);
    CHECK(strlen(cognate_version()) >= 5);
}

static void a_ball_falls(const char *folder) {
    CognateError *error = NULL;
    CognateModel *model = model_of(FALLING);
    CognateOptions *options = cognate_options_new();
    CHECK(cognate_options_column(options, "VZ(2)", &error));
    cognate_options_error(options, 1e-8);
    CognateSession *session = cognate_session_new(model, options, &error);
    NO_ERROR(error);
    cognate_options_free(options);
    cognate_model_free(model); // sessions go on without it
    CognateStatus status;
    CHECK(cognate_session_simulate(session, COGNATE_KIND_TRANSIENT, 2.0, 4, &status, &error));
    CHECK(status == COGNATE_STATUS_COMPLETED && cognate_session_time(session) == 2.0);
    size_t n, m, l;
    const double *time = column_of(session, "time", &n), *z = column_of(session, "ball.Z", &m);
    const double *v = column_of(session, "vz( 2 )", &l);
    CHECK(n == 5 && m == 5 && l == 5);
    for (size_t k = 0; k < n; k++) {
        NEAR(z[k], -5 * time[k] * time[k], 1e-9);
        NEAR(v[k], -10 * time[k], 1e-9);
    }
    size_t at = cognate_session_find(session, "VZ(2)");
    CHECK(strcmp(cognate_session_name(session, at), "VZ(2)") == 0);
    CHECK(strcmp(cognate_session_unit(session, at), "meter/sec") == 0);
    CHECK(cognate_session_name(session, 999) == NULL);

    // files, record, state
    char path[512];
    snprintf(path, sizeof path, "%s/ball.csv", folder);
    CHECK(cognate_session_write(session, path, &error));
    CHECK(!cognate_session_write(session, "ball.unknown", &error));
    cognate_error_free(error);
    char *record = cognate_session_record(session, &error);
    CHECK(strstr(record, "\"status\": \"completed\"") != NULL);
    cognate_string_free(record);
    char *state = cognate_session_state(session, &error);
    model = model_of(FALLING);
    CognateSession *other = cognate_session_new(model, NULL, &error);
    CHECK(cognate_session_reload(other, state, &error) && cognate_session_time(other) == 2.0);
    CHECK(!cognate_session_reload(other, "nonsense", &error));
    cognate_error_free(error);
    CHECK(cognate_session_obey(other, "SIMULATE/DYNAMIC, END=3, STEPS=1", &status, &error));
    z = column_of(other, "ball.Z", &m);
    NEAR(z[m - 1], -45.0, 1e-9);
    cognate_string_free(state);
    cognate_session_free(other);

    // a changed model, freedoms, an end that is none
    CHECK(cognate_model_change(model, "ACCGRAV/KGRAV=-20", &error));
    CHECK(!cognate_model_change(model, "PART/9, MASS=3", &error));
    cognate_error_free(error);
    char *found = cognate_model_verify(model, &error);
    CHECK(strstr(found, "\"freedom\": 6") != NULL);
    cognate_string_free(found);
    other = cognate_session_new(model, NULL, &error);
    CHECK(!cognate_session_simulate(other, COGNATE_KIND_DYNAMIC, NAN, 1, NULL, &error));
    cognate_error_free(error);
    CHECK(!cognate_session_simulate(other, 99, 1.0, 1, NULL, &error));
    cognate_error_free(error);
    CHECK(cognate_session_simulate(other, COGNATE_KIND_DYNAMIC, 1.0, 1, &status, &error));
    z = column_of(other, "ball.Z", &m);
    NEAR(z[m - 1], -10.0, 1e-9);
    found = cognate_session_linearize(other, &error);
    CHECK(strstr(found, "\"A\"") != NULL);
    cognate_string_free(found);
    CognateError *doubts = cognate_model_warnings(model);
    cognate_error_free(doubts);
    cognate_session_free(other);
    cognate_model_free(model);
    cognate_session_free(session);
}

// a spring of stiffness par[0], which pulls towards z = 1
static void sfosub(const int *id, const double *time, const double *par, const int *npar,
                   const int *dflag, const int *iflag, double *value) {
    (void)time, (void)dflag, (void)iflag;
    CHECK(*id == 3 && *npar == 1);
    int failed, ids[] = {2, 1, 1};
    double z;
    cognate_sysfnc("DZ", ids, 3, &z, &failed);
    CHECK(failed == 0);
    *value = par[0] * (1.0 - z);
}

static void varsub(const int *id, const double *time, const double *par, const int *npar,
                   const int *dflag, const int *iflag, double *value) {
    (void)id, (void)npar, (void)dflag, (void)iflag;
    *value = par[0] * *time;
}

static void reqsub(const int *id, const double *time, const double *par, const int *npar,
                   const int *iflag, double *results) {
    (void)id, (void)time, (void)npar, (void)iflag;
    int n, failed, ids[] = {2, 1, 1};
    double place[3];
    cognate_sysary("TDISP", ids, 3, place, &n, &failed);
    CHECK(n == 3 && failed == 0);
    results[1] = place[2];
    results[2] = par[1];
}

static void nothing(const int *id, const double *time, const double *par, const int *npar,
                    const int *dflag, const int *iflag, double *value) {
    (void)id, (void)time, (void)par, (void)npar, (void)dflag, (void)iflag;
    *value = *time > 0.1 ? NAN : 0.0;
}

static void swings(CognateSession *session) {
    size_t n, m;
    const double *time = column_of(session, "time", &n), *z = column_of(session, "DZ(2,1,1)", &m);
    CHECK(n == m && n == 31);
    for (size_t k = 0; k < n; k++) NEAR(z[k], 1.0 - cos(2.0 * time[k]), 1e-6);
}

static CognateSession *pushed(void) {
    CognateError *error = NULL;
    CognateModel *model = model_of(PUSHED);
    CognateOptions *options = cognate_options_new();
    CHECK(cognate_options_column(options, "DZ(2,1,1)", &error));
    CHECK(cognate_options_column(options, "VARVAL(4)", &error));
    cognate_options_error(options, 1e-8);
    CognateSession *session = cognate_session_new(model, options, &error);
    NO_ERROR(error);
    cognate_options_free(options);
    cognate_model_free(model);
    return session;
}

static void routines_compute_what_user_stands_for(const char *library) {
    CognateError *error = NULL;
    CognateDiagnostic d;
    CognateSession *session = pushed();
    // without routines it is a mistake
    CHECK(!cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 3.0, 30, NULL, &error));
    cognate_error_free(error);
    CHECK(cognate_session_sfosub(session, 3, sfosub, &error));
    CHECK(cognate_session_varsub(session, 0, varsub, &error));
    CHECK(cognate_session_reqsub(session, 5, reqsub, &error));
    CHECK(!cognate_session_gfosub(session, 0, sfosub, &error) && error != NULL);
    cognate_error_free(error);
    CHECK(!cognate_session_sfosub(session, 3, NULL, &error));
    cognate_error_free(error);
    CognateStatus status;
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 3.0, 30, &status, &error));
    swings(session);
    size_t n;
    const double *variable = column_of(session, "VARVAL(4)", &n);
    NEAR(variable[n - 1], 9.0, 1e-12);
    cognate_session_free(session);

    session = pushed();
    CHECK(cognate_session_load(session, library, &error));
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 3.0, 30, &status, &error));
    swings(session);
    cognate_session_free(session);

    session = pushed();
    CHECK(!cognate_session_load(session, "./no_such_library.so", &error));
    CHECK(cognate_error_get(error, 0, &d) && strcmp(d.code, "cannot_open") == 0);
    cognate_error_free(error);
    CHECK(cognate_session_sfosub(session, 3, nothing, &error));
    CHECK(cognate_session_varsub(session, 4, varsub, &error));
    CHECK(cognate_session_reqsub(session, 5, reqsub, &error));
    CHECK(!cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 3.0, 30, NULL, &error));
    CHECK(cognate_error_get(error, 0, &d) && strcmp(d.element, "SFORCE/3") == 0);
    cognate_error_free(error);
    cognate_session_free(session);

    // outside a routine there is nothing to ask
    double x;
    int failed, ids[] = {2};
    cognate_sysfnc("DZ", ids, 1, &x, &failed);
    CHECK(failed == 1);
}

// a crank that MOTSUB drives, a free body that GFOSUB pushes, a SENSOR that SENSUB ends the run by
static const char *DRIVEN =
    "other routines\n"
    "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\n"
    "PART/1, GROUND\n"
    "MARKER/1, PART=1\n"
    "PART/2, MASS=1, CM=2, IP=1,1,1\n"
    "MARKER/2, PART=2\n"
    "JOINT/1, REVOLUTE, I=2, J=1\n"
    "MOTION/1, JOINT=1, ROTATION, FUNCTION=USER(3)\\\n"
    "PART/3, MASS=2, CM=3, IP=1,1,1\n"
    "MARKER/3, PART=3\n"
    "MARKER/4, PART=1, FLOATING\n"
    "GFORCE/7, I=3, JFLOAT=4, RM=1, FUNCTION=USER(4)\\\n"
    "SENSOR/6, FUNCTION=USER(1)\\, VALUE=0.5, ERROR=1E-6, GE, HALT\n"
    "END\n";

static void motsub(const int *id, const double *time, const double *par, const int *npar,
                   const int *iord, const int *iflag, double *value) {
    (void)id, (void)npar, (void)iflag;
    // par[0]*t² and its derivatives
    *value = *iord == 0 ? par[0] * *time * *time : *iord == 1 ? 2 * par[0] * *time : 2 * par[0];
}

static void gfosub(const int *id, const double *time, const double *par, const int *npar,
                   const int *dflag, const int *iflag, double *results) {
    (void)id, (void)time, (void)npar, (void)dflag, (void)iflag;
    results[1] = par[0];
    results[5] = 2.0;
}

static void sensub(const int *id, const double *time, const double *par, const int *npar,
                   const int *iflag, double *results) {
    (void)id, (void)par, (void)npar, (void)iflag;
    results[0] = *time;
}

static void motions_forces_and_sensors_have_routines(void) {
    CognateError *error = NULL;
    CognateModel *model = model_of(DRIVEN);
    CognateOptions *options = cognate_options_new();
    CHECK(cognate_options_column(options, "AZ(2,1)", &error));
    CHECK(cognate_options_column(options, "DY(3)", &error));
    CHECK(cognate_options_column(options, "WZ(3)", &error));
    cognate_options_error(options, 1e-9);
    CognateSession *session = cognate_session_new(model, options, &error);
    NO_ERROR(error);
    CHECK(cognate_session_motsub(session, 1, motsub, &error));
    CHECK(cognate_session_gfosub(session, 7, gfosub, &error));
    CHECK(cognate_session_sensub(session, 6, sensub, &error));
    CognateStatus status;
    cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 2.0, 20, &status, &error);
    NO_ERROR(error);
    size_t n;
    const double *time = column_of(session, "time", &n), t = time[n - 1];
    NEAR(t, 0.5, 1e-5);
    NEAR(column_of(session, "AZ(2,1)", &n)[n - 1], 3 * t * t, 1e-9);
    NEAR(column_of(session, "DY(3)", &n)[n - 1], 0.5 * 4 / 2 * t * t, 1e-8);
    NEAR(column_of(session, "WZ(3)", &n)[n - 1], 2 * t, 1e-8);
    cognate_session_free(session);
    cognate_options_free(options);
    cognate_model_free(model);
}

static bool until_one(void *data, double time) {
    (*(int *)data)++;
    return time < 1.0;
}

static void a_simulation_can_be_ended(void) {
    CognateError *error = NULL;
    CognateModel *model = model_of(FALLING);
    CognateOptions *options = cognate_options_new();
    CHECK(cognate_options_method(options, "RADAU5", &error) && cognate_options_name(options, "b", &error));
    CHECK(cognate_options_skip(options, "contact", &error));
    CHECK(!cognate_options_skip(options, "nothing", &error));
    cognate_error_free(error);
    CognateSession *session = cognate_session_new(model, options, &error);
    NO_ERROR(error);
    int calls = 0;
    CHECK(cognate_session_progress(session, until_one, &calls, &error));
    CognateStatus status;
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 1e6, 100, &status, &error));
    CHECK(status == COGNATE_STATUS_INTERRUPTED && calls > 0);
    cognate_session_free(session);
    cognate_options_threads(options, 2);
    cognate_options_limit(options, 0.0, 3);
    session = cognate_session_new(model, options, &error);
    CHECK(cognate_session_simulate(session, COGNATE_KIND_DYNAMIC, 1e6, 100, &status, &error));
    CHECK(status == COGNATE_STATUS_LIMIT);
    cognate_session_free(session);
    cognate_options_free(options);
    cognate_model_free(model);
}

int main(int argc, char **argv) {
    CHECK(argc == 3);
    expressions_have_values_gradients_and_columns();
    expressions_take_names_of_the_caller();
    mistakes_have_code_place_and_advice();
    nothing_that_is_passed_breaks_anything();
    a_ball_falls(argv[2]);
    routines_compute_what_user_stands_for(argv[1]);
    motions_forces_and_sensors_have_routines();
    a_simulation_can_be_ended();
    puts("C: all claims hold");
    return 0;
}
