#ifndef COGNATE_H
#define COGNATE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// cognate in C: expressions of the ADAMS function language, models, sessions, user subroutines.
//
// Handles (CognateExpr, CognateNames, CognateModel, CognateBuilder, CognateSession, CognateRows, CognateOptions,
// CognateError) are opaque, made by the functions that return them and given back by the function of the same name
// that ends in _free, which takes NULL as well; a CognateElement belongs to its builder. Texts that come in end with a
// zero byte and are UTF-8; those that go out belong to the handle that they come from, but for `char *`, which
// cognate_string_free takes back.
//
// Mistakes: a function that can fail takes `CognateError **error`. It may be NULL. Where the function
// fails it returns NULL or false and puts a CognateError there, which holds every mistake with code,
// place and advice and is given back by cognate_error_free; where it succeeds it puts NULL there. A NULL
// where there must be something is such a mistake. No panic leaves a function; after one (code "bug")
// the handle concerned should be given back.
//
// Threads: errors and expressions do not change and may be used by several threads at once, expressions with
// callbacks if these may be; a model as long as nobody calls cognate_model_change. A session, options, names, rows
// and a builder belong to one thread at a time, which may change between calls; only cognate_session_interrupt may
// be called while another thread is at work in the session.
//
// Callbacks are called in the thread that called cognate. No C++ exception may leave them. Of several routines that
// stand for one USER the last that was given counts.

// Functions are exported by the shared library, and nothing else is. COGNATE_STATIC: the static one is linked.
#ifndef COGNATE_API
#if defined(_WIN32) && !defined(COGNATE_STATIC)
#define COGNATE_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define COGNATE_API __attribute__((visibility("default")))
#else
#define COGNATE_API
#endif
#endif


// The first number of the version; it is that of the shared library, too (libcognate.so.0).
#define COGNATE_VERSION_MAJOR 0

// The second number of the version.
#define COGNATE_VERSION_MINOR 1

// The third number of the version.
#define COGNATE_VERSION_PATCH 0

// The version as a number that grows, 10203 for 1.2.3.
#define COGNATE_VERSION_NUMBER (((COGNATE_VERSION_MAJOR * 10000) + (COGNATE_VERSION_MINOR * 100)) + COGNATE_VERSION_PATCH)

// The severity of a diagnostic.
typedef enum {
  // information
  COGNATE_SEVERITY_NOTE,
  // legal, but probably not as meant
  COGNATE_SEVERITY_WARNING,
  // a mistake
  COGNATE_SEVERITY_ERROR,
} CognateSeverity;

// The answer to the question for a row.
typedef enum {
  // there is one
  COGNATE_NEXT_ROW,
  // there is none yet
  COGNATE_NEXT_NONE,
  // there is none, and the simulation has ended; rows of the next one may follow
  COGNATE_NEXT_ENDED,
} CognateNext;

// The way in which a simulation ended.
typedef enum {
  // everything that was asked for was done
  COGNATE_STATUS_COMPLETED,
  // the model has no consistent configuration, or contradicts itself
  COGNATE_STATUS_MODEL,
  // no equilibrium was found
  COGNATE_STATUS_NO_EQUILIBRIUM,
  // the integration could not go on
  COGNATE_STATUS_STOPPED,
  // a limit of time or steps was reached
  COGNATE_STATUS_LIMIT,
  // cognate_session_interrupt, or the callback for progress or for rows, ended it
  COGNATE_STATUS_INTERRUPTED,
} CognateStatus;

// The language of an expression.
typedef enum {
  // direct-entry functions: radians, TIME
  COGNATE_DIALECT_FUNCTION,
  // expressions of the modelling language: degrees, t
  COGNATE_DIALECT_EXPRESSION,
} CognateDialect;

// The kind of a simulation.
typedef enum {
  // kinematic without freedom, else dynamic
  COGNATE_KIND_TRANSIENT,
  // forces move it
  COGNATE_KIND_DYNAMIC,
  // motions alone move it
  COGNATE_KIND_KINEMATIC,
  // an equilibrium, or one at each output time
  COGNATE_KIND_STATIC,
  // assembled positions and velocities
  COGNATE_KIND_INITIAL_CONDITIONS,
} CognateKind;

// A model that a program makes, a statement after the other in any order.
typedef struct CognateBuilder CognateBuilder;

// A statement of a model that is being built. It belongs to its builder, and goes with it.
typedef struct CognateElement CognateElement;

// Every mistake that a function has found.
typedef struct CognateError CognateError;

// An expression of the function language, checked and compiled.
typedef struct CognateExpr CognateExpr;

// A multibody model as its dataset (.adm) says.
typedef struct CognateModel CognateModel;

// Names of the caller's own, which expressions may use beside those of the language.
typedef struct CognateNames CognateNames;

// Choices of a session. What is not chosen is as the dataset says.
typedef struct CognateOptions CognateOptions;

// Rows of results that wait to be taken, by one thread at a time, while another simulates.
typedef struct CognateRows CognateRows;

// A model and its clock: simulations one after another, each from where the last one ended.
typedef struct CognateSession CognateSession;

// A mistake, a warning or a note. Its texts belong to the CognateError that it comes from.
typedef struct {
  // severity
  CognateSeverity severity;
  // stable short name, which `cognate explain CODE` explains
  const char *code;
  // one sentence without a full stop
  const char *message;
  // file of the text; NULL: none
  const char *file;
  // line in that text, from 1; 0: unknown
  size_t line;
  // column, from 1, in characters; 0: unknown
  size_t column;
  // the element concerned, for example "SFORCE/3"; NULL: none
  const char *element;
  // the name that the dataset gives that element; NULL: none
  const char *name;
  // what to do, a sentence a line
  const char *advice;
  // all of it as the command line prints it
  const char *text;
} CognateDiagnostic;

// A function of `n` arguments: puts its value into `*value`, and its partial derivatives, one for
// each argument, into `slopes`, which is NULL where they are not asked for. Returns false where it
// has no value.
typedef bool (*CognateFunction)(void *data,
                                const double *arguments,
                                size_t n,
                                double *value,
                                double *slopes);

// A routine of the form SFOSUB: fills `results`, which are zero, with 1 number for SFORCE,
// VARIABLE and DIFF, 6 for GFORCE (FX, FY, FZ, TX, TY, TZ), 3 for VFORCE and VTORQUE.
//
// `par`: the `*npar` numbers of USER. `*iflag` is 1 in the first call, which tells by
// cognate_sysfnc and cognate_sysary what the routine reads, else 0. `*dflag` is always 0:
// derivatives are found by differences, with the same calls.
typedef void (*CognateForceRoutine)(const int *id,
                                    const double *time,
                                    const double *par,
                                    const int *npar,
                                    const int *dflag,
                                    const int *iflag,
                                    double *results);

// A routine of the form REQSUB: fills `results`, which are zero, with 8 numbers for REQUEST, 1 for
// SENSOR.
typedef void (*CognateOutputRoutine)(const int *id,
                                     const double *time,
                                     const double *par,
                                     const int *npar,
                                     const int *iflag,
                                     double *results);

// MOTSUB: fills `value` with the value of the motion (`*iord` = 0) or its first or second
// derivative in time.
typedef void (*CognateMotionRoutine)(const int *id,
                                     const double *time,
                                     const double *par,
                                     const int *npar,
                                     const int *iord,
                                     const int *iflag,
                                     double *value);

// A routine with data of the caller's: fills `results`, which are zero.
//
// `constants`: the numbers of USER. `values`: those of the expressions that it was registered
// with. Returns false where it cannot; the simulation then ends with a mistake.
typedef bool (*CognateRoutine)(void *data,
                               double time,
                               const double *constants,
                               size_t n_constants,
                               const double *values,
                               size_t n_values,
                               double *results,
                               size_t n_results);

// A callback that takes a row of results: the values of all columns in their order, time first.
// Returns false to end the simulation; it is not called again in this one.
typedef bool (*CognateRow)(void *data, const double *values, size_t n);

// A callback after each step: called with `data` and the time that has been reached; returns
// false to end the simulation, with the results so far.
typedef bool (*CognateProgress)(void *data, double time);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Gives back a text that a function returned as `char *`; NULL is taken as well.
COGNATE_API void cognate_string_free(char *text);

// Begins a model of ground alone. `title`: the first line of its dataset.
//
// Elements get numbers as they are made and keep their names in written datasets. Lengths, masses,
// forces and times are in one system of units, which cognate_builder_settings "UNITS" tells; angles
// are radians. Places are in ground coordinates, in the position in which the model is drawn.
// Mistakes are collected, and told all at once by cognate_builder_build.
COGNATE_API CognateBuilder *cognate_builder_new(const char *title, CognateError **error);

// Returns the part that does not move, PART/1.
COGNATE_API CognateElement *cognate_builder_ground(CognateBuilder *builder);

// Adds an element by a word: a statement ("PART", "BUSHING"), or a type of JOINT, JPRIM or GRAPHICS
// ("REVOLUTE", "INLINE", "BOX"; "GRAPHICS_CURVE", as CURVE is a statement). It gets the next number
// of its kind. `name` may be NULL.
COGNATE_API
CognateElement *cognate_builder_element(CognateBuilder *builder,
                                        const char *word,
                                        const char *name);

// Adds an element between two ends, I and J, by a word as for cognate_builder_element. Each end is a
// marker or a body; a body gets a marker where the other end is. The axis of a joint is z of its
// markers.
COGNATE_API
CognateElement *cognate_builder_between(CognateBuilder *builder,
                                        const char *word,
                                        const char *name,
                                        const CognateElement *i,
                                        const CognateElement *j);

// Returns the statement without a number that has this keyword: "UNITS", "ACCGRAV", "INTEGRATOR".
COGNATE_API CognateElement *cognate_builder_settings(CognateBuilder *builder, const char *keyword);

// Makes a marker fixed in a body, at a place in ground, with the axes of ground. `name` may be NULL.
COGNATE_API
CognateElement *cognate_element_marker(CognateElement *body,
                                       const char *name,
                                       double x,
                                       double y,
                                       double z);

// Turns a marker that cognate_element_marker made: the direction of its z axis in ground (the axis of
// a joint), and one in the half plane of its positive x axis. Both have three numbers; `x` may be
// NULL.
COGNATE_API
void cognate_element_axes(CognateElement *marker,
                          const double *z,
                          const double *x);

// Returns the number that stands for an element in expressions: DX(number). 0: it is a statement of
// settings, or none.
COGNATE_API uint32_t cognate_element_number(const CognateElement *element);

// Gives an argument a number, by its keyword: "MASS". Whole numbers are taken as such where a count
// or the number of an element is wanted.
COGNATE_API
void cognate_element_set_number(CognateElement *element,
                                const char *keyword,
                                double value);

// Gives an argument `n` numbers: "IP".
COGNATE_API
void cognate_element_set_numbers(CognateElement *element,
                                 const char *keyword,
                                 const double *values,
                                 size_t n);

// Gives an argument a text: a word, a name of a file, or an expression ("FUNCTION"; numbers of
// elements in it are those of cognate_element_number).
COGNATE_API
void cognate_element_set_text(CognateElement *element,
                              const char *keyword,
                              const char *value);

// Gives an argument an element of the same builder: "CM" a marker, "JOINT" a joint.
COGNATE_API
void cognate_element_set_element(CognateElement *element,
                                 const char *keyword,
                                 const CognateElement *value);

// Gives an argument `n` elements of the same builder: "JOINTS" of a COUPLER.
COGNATE_API
void cognate_element_set_elements(CognateElement *element,
                                  const char *keyword,
                                  const CognateElement *const *values,
                                  size_t n);

// Gives an argument that stands alone: "ROTATIONAL".
COGNATE_API void cognate_element_set_flag(CognateElement *element, const char *keyword);

// Makes the model. NULL: there are mistakes, in calls or in the model, by the names of elements. The
// builder stays, and may go on.
COGNATE_API
CognateModel *cognate_builder_build(const CognateBuilder *builder,
                                    CognateError **error);

// Returns the words that cognate_builder_element takes, one a line, to be given back by
// cognate_string_free: the word, and a sentence about it behind a tabulator.
COGNATE_API char *cognate_builder_words(void);

// Gives a builder back, and its elements with it; models that it made go on.
COGNATE_API void cognate_builder_free(CognateBuilder *builder);

// Returns how many mistakes, warnings and notes there are; 0 for NULL.
COGNATE_API size_t cognate_error_count(const CognateError *error);

// Puts one of them, counted from 0, into `diagnostic`; returns false where there is none.
COGNATE_API
bool cognate_error_get(const CognateError *error,
                       size_t index,
                       CognateDiagnostic *diagnostic);

// Gives an error back.
COGNATE_API void cognate_error_free(CognateError *error);

// Reads, checks and compiles an expression; NULL: it has a mistake. `dialect`: a CognateDialect.
COGNATE_API
CognateExpr *cognate_expr_parse(const char *source,
                                uint32_t dialect,
                                CognateError **error);

// Reads an expression that uses names of the caller's own; NULL: it, or one of the names, has a
// mistake. The names may be given back, or have more added, without changing it.
COGNATE_API
CognateExpr *cognate_expr_parse_with(const char *source,
                                     const CognateNames *names,
                                     CognateError **error);

// Returns how many inputs an expression reads.
COGNATE_API size_t cognate_expr_inputs(const CognateExpr *expr);

// Returns the name of an input, counted from 0: "TIME", "DX(1, 2)", a variable; NULL: there is none.
COGNATE_API
const char *cognate_expr_input(const CognateExpr *expr,
                               size_t index);

// Evaluates an expression for the values of its inputs, in the order of cognate_expr_input.
//
// Returns false where it has no value; the error then names the operation that has none.
COGNATE_API
bool cognate_expr_eval(const CognateExpr *expr,
                       const double *inputs,
                       size_t n_inputs,
                       double *value,
                       CognateError **error);

// Evaluates an expression and its exact derivatives along all inputs, one number for each.
//
// `value` may be NULL.
COGNATE_API
bool cognate_expr_gradient(const CognateExpr *expr,
                           const double *inputs,
                           size_t n_inputs,
                           double *value,
                           double *gradient,
                           CognateError **error);

// Evaluates an expression over columns, one of `n` numbers for each input; for many points some
// ten times as fast as one by one.
//
// `gradients` is NULL, or holds a column of `n` places for each input, which the derivatives
// along it go into. Points without a value become NaN in `values`; then false is returned and the
// error names the first. Columns may not overlap those that are written.
COGNATE_API
bool cognate_expr_batch(const CognateExpr *expr,
                        const double *const *inputs,
                        size_t n_inputs,
                        size_t n,
                        double *values,
                        double *const *gradients,
                        CognateError **error);

// Gives an expression back.
COGNATE_API void cognate_expr_free(CognateExpr *expr);

// Loads a shared library and computes every USER of the model by its routines: those that ROUTINE
// names, else sfosub, varsub, difsub, gfosub, vfosub, vtosub, reqsub, sensub, motsub.
//
// Their names are looked for as written, in small letters, with an underscore behind (as Fortran
// compilers write them), and in capitals. The library stays loaded until the session is given
// back. It may call cognate_sysfnc, cognate_sysary, c_sysfnc and c_sysary.
COGNATE_API
bool cognate_session_load(CognateSession *session,
                          const char *path,
                          CognateError **error);

// Reads a dataset from a file, and the set-up in the file of the same name with the ending .toml:
// chosen loads, functions that give them, error and method of runs. NULL: one of them has mistakes.
COGNATE_API CognateModel *cognate_model_read(const char *path, CognateError **error);

// Reads a dataset from a file, whatever stands beside it; NULL: it has mistakes.
COGNATE_API CognateModel *cognate_model_read_alone(const char *path, CognateError **error);

// Reads a dataset from `length` bytes in memory; NULL: it has mistakes.
//
// `file` is NULL, or the file that the bytes stand for: in messages, and for the folder of files
// that the dataset names.
COGNATE_API
CognateModel *cognate_model_from_memory(const char *bytes,
                                        size_t length,
                                        const char *file,
                                        CognateError **error);

// Returns warnings and notes about a model, to be given back by cognate_error_free; NULL for NULL.
COGNATE_API CognateError *cognate_model_warnings(const CognateModel *model);

// Changes a model by statements, one a line, as command files hold them: "PART/2, MASS=3",
// "DEACTIVATE/MOTION, ID=1". Where one of them is wrong the model stays as it was.
COGNATE_API
bool cognate_model_change(CognateModel *model,
                          const char *statements,
                          CognateError **error);

// Returns the dataset of a model as it is now, to be given back by cognate_string_free.
COGNATE_API char *cognate_model_text(const CognateModel *model, CognateError **error);

// Counts the freedoms of a model and tells what is fixed twice and what is free, as JSON, to be
// given back by cognate_string_free.
COGNATE_API char *cognate_model_verify(const CognateModel *model, CognateError **error);

// Gives a model back; sessions of it go on.
COGNATE_API void cognate_model_free(CognateModel *model);

// Returns names of which there are none, for expressions of a language (a CognateDialect); NULL:
// there is no such language.
//
// Upper and lower case are one. What is wrong with names (one that cannot be written, that hides
// one of the language, or that is there already) is told by cognate_expr_parse_with, all at once.
COGNATE_API CognateNames *cognate_names_new(uint32_t dialect, CognateError **error);

// Adds a variable: "x". Variables are the first inputs of an expression, in the order in which they
// were added, also those that it does not read.
COGNATE_API
bool cognate_names_variable(CognateNames *names,
                            const char *name,
                            CognateError **error);

// Adds a named number.
COGNATE_API
bool cognate_names_constant(CognateNames *names,
                            const char *name,
                            double value,
                            CognateError **error);

// Adds a function by its head and a formula of the language: "hertz(x, k)", "k*MAX(x, 0)**1.5".
//
// It may use constants and functions that were added before it. It is as fast as if it were written
// out, and has all derivatives.
COGNATE_API
bool cognate_names_define(CognateNames *names,
                          const char *head,
                          const char *formula,
                          CognateError **error);

// Adds a function of `n_arguments` arguments that a callback computes, which is given `data`.
//
// `has_slopes`: it gives its derivatives, too. Without them, asking an expression for derivatives
// along what the arguments depend on is a mistake that names the function. Expressions call it in
// each thread that evaluates them; `data` must live as long as they do.
COGNATE_API
bool cognate_names_function(CognateNames *names,
                            const char *name,
                            size_t n_arguments,
                            CognateFunction function,
                            bool has_slopes,
                            void *data,
                            CognateError **error);

// Gives names back; expressions that use them go on.
COGNATE_API void cognate_names_free(CognateNames *names);

// Returns options of which none is chosen.
COGNATE_API CognateOptions *cognate_options_new(void);

// Asks for a further column: an expression of the function language, in which elements may have
// their names ("DX(slider.cm, ground)"), or a component of a set of results ("crank_bearing.FX").
COGNATE_API
bool cognate_options_column(CognateOptions *options,
                            const char *expression,
                            CognateError **error);

// Chooses the permitted local error of the integration.
COGNATE_API void cognate_options_error(CognateOptions *options, double permitted);

// Chooses the method of integration by its name; "AUTO" chooses by itself.
COGNATE_API
bool cognate_options_method(CognateOptions *options,
                            const char *name,
                            CognateError **error);

// Chooses the base name of results.
COGNATE_API
bool cognate_options_name(CognateOptions *options,
                          const char *name,
                          CognateError **error);

// Leaves out elements of a statement ("CONTACT") where they are not solved.
COGNATE_API
bool cognate_options_skip(CognateOptions *options,
                          const char *keyword,
                          CognateError **error);

// Gives every column bars of error (a column "name±" each), from a further run at a smaller
// permitted error.
COGNATE_API void cognate_options_accuracy(CognateOptions *options, bool wanted);

// Says how many digits of the results to believe ("accuracy" in the record), from a further
// integration of each dynamic simulation at a larger permitted error: about six tenths of its
// time. Instead of bars of error, and they instead of it.
COGNATE_API void cognate_options_digits(CognateOptions *options, bool wanted);

// Asks for sets of results of all elements, or for what is asked for alone. Without a word a
// session has all of them where the dataset asks for RESULTS, or where no column and no REQUEST is
// asked for (of a model of more than 400 elements then the places of the bodies).
COGNATE_API void cognate_options_full(CognateOptions *options, bool wanted);

// Asks for positions and angles of all parts, whatever else is recorded.
COGNATE_API void cognate_options_frames(CognateOptions *options, bool wanted);

// Takes what USER would compute as zero where no routine is given.
COGNATE_API void cognate_options_zero_user(CognateOptions *options, bool wanted);

// Runs motions whose displacement or velocity jumps, piece by piece.
COGNATE_API void cognate_options_piecewise(CognateOptions *options, bool wanted);

// Limits the processor time of a session [s] and the steps that an integration may try; 0: no
// limit. Where one is reached the status is COGNATE_STATUS_LIMIT.
COGNATE_API void cognate_options_limit(CognateOptions *options, double seconds, size_t steps);

// Integrates mechanisms that nothing couples on so many threads, which change no result; 0: on the
// one that calls.
COGNATE_API void cognate_options_threads(CognateOptions *options, size_t threads);

// Gives options back; sessions made with them go on.
COGNATE_API void cognate_options_free(CognateOptions *options);

// Computes SFORCE/id, or with id 0 all SFORCEs that have a USER, by SFOSUB.
COGNATE_API
bool cognate_session_sfosub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes VARIABLE/id, or with id 0 all VARIABLEs that have a USER, by VARSUB.
COGNATE_API
bool cognate_session_varsub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes DIFF/id, or with id 0 all DIFFs that have a USER, by DIFSUB.
COGNATE_API
bool cognate_session_difsub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes GFORCE/id, or with id 0 all GFORCEs that have a USER, by GFOSUB.
COGNATE_API
bool cognate_session_gfosub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes VFORCE/id, or with id 0 all VFORCEs that have a USER, by VFOSUB.
COGNATE_API
bool cognate_session_vfosub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes VTORQUE/id, or with id 0 all VTORQUEs that have a USER, by VTOSUB.
COGNATE_API
bool cognate_session_vtosub(CognateSession *session,
                            uint32_t id,
                            CognateForceRoutine routine,
                            CognateError **error);

// Computes REQUEST/id, or with id 0 all REQUESTs that have a USER, by REQSUB.
COGNATE_API
bool cognate_session_reqsub(CognateSession *session,
                            uint32_t id,
                            CognateOutputRoutine routine,
                            CognateError **error);

// Computes SENSOR/id, or with id 0 all SENSORs that have a USER, by SENSUB.
COGNATE_API
bool cognate_session_sensub(CognateSession *session,
                            uint32_t id,
                            CognateOutputRoutine routine,
                            CognateError **error);

// Computes MOTION/id, or with id 0 all MOTIONs that have a USER, by MOTSUB.
COGNATE_API
bool cognate_session_motsub(CognateSession *session,
                            uint32_t id,
                            CognateMotionRoutine routine,
                            CognateError **error);

// Computes what USER stands for by a routine with data of the caller's.
//
// `name`: an element ("SFORCE/3"), the text of its ROUTINE, or the first number of USER.
// `inputs`: `n_inputs` expressions whose values the routine is given, in this order.
COGNATE_API
bool cognate_session_user(CognateSession *session,
                          const char *name,
                          const char *const *inputs,
                          size_t n_inputs,
                          CognateRoutine routine,
                          void *data,
                          CognateError **error);

// Calls `callback` with `data` for each row of results while simulations go on, at most a second
// after it was computed; before the first simulation, in place of what was set before.
//
// `keep`: rows stay in the results of the session as well. Without it they are gone when the
// callback has had them, and a run may be as long as it likes.
COGNATE_API
bool cognate_session_rows(CognateSession *session,
                          CognateRow callback,
                          void *data,
                          bool keep,
                          CognateError **error);

// Returns the rows of results that come while simulations of this session go on, for a thread that
// takes them by cognate_rows_next; before the first simulation, in place of what was set before.
// `keep`: as for cognate_session_rows. Rows wait until they are taken.
COGNATE_API
CognateRows *cognate_session_queue(CognateSession *session,
                                   bool keep,
                                   CognateError **error);

// Takes the next row: puts the values of all columns, which are cognate_session_columns, into
// `values`, which has room for `n` numbers. Waits up to `seconds` for it.
//
// COGNATE_NEXT_ENDED comes once behind the rows of each simulation, and for ever when the session
// has been given back. A mistake (NULL, no room) is told by `error`, and COGNATE_NEXT_ENDED returned.
COGNATE_API
CognateNext cognate_rows_next(CognateRows *rows,
                              double *values,
                              size_t n,
                              double seconds,
                              CognateError **error);

// Gives rows back; simulations go on without a reader.
COGNATE_API void cognate_rows_free(CognateRows *rows);

// Begins a session of a model, at time 0; NULL: an option is wrong. `options` may be NULL.
COGNATE_API
CognateSession *cognate_session_new(const CognateModel *model,
                                    const CognateOptions *options,
                                    CognateError **error);

// Sets the callback after each step; NULL: none.
COGNATE_API
bool cognate_session_progress(CognateSession *session,
                              CognateProgress callback,
                              void *data,
                              CognateError **error);

// Ends the simulation that is going on in another thread, with the results so far.
COGNATE_API void cognate_session_interrupt(const CognateSession *session);

// Simulates on to `end`, a time of the clock, with `steps` output steps. `kind`: a CognateKind. A
// first simulation over time begins at equilibrium where the set-up beside the model asks for that.
//
// Returns false where the model or the call is wrong. A numerical failure is no mistake: it is
// told by `status`, which may be NULL, and results so far are kept.
COGNATE_API
bool cognate_session_simulate(CognateSession *session,
                              uint32_t kind,
                              double end,
                              uint32_t steps,
                              CognateStatus *status,
                              CognateError **error);

// Obeys commands, one a line, as a command file (.acf) holds them. `status`, which may be NULL:
// how the last simulation ended.
COGNATE_API
bool cognate_session_obey(CognateSession *session,
                          const char *script,
                          CognateStatus *status,
                          CognateError **error);

// Returns the clock of a session; NaN where it cannot be told.
COGNATE_API double cognate_session_time(const CognateSession *session);

// Returns the number of columns of the results so far; the first is time.
COGNATE_API size_t cognate_session_columns(const CognateSession *session);

// Returns the name of a column, until the next simulation; NULL: there is none.
COGNATE_API const char *cognate_session_name(const CognateSession *session, size_t column);

// Returns the unit of a column as result files spell it, until the next simulation; "": a pure
// number; NULL: there is no such column.
COGNATE_API const char *cognate_session_unit(const CognateSession *session, size_t column);

// Finds a column by its name, without regard to blanks and case, or by its element
// ("JOINT/1.FX"); SIZE_MAX: there is none, or there are several.
COGNATE_API size_t cognate_session_find(const CognateSession *session, const char *name);

// Returns the numbers of a column, until the next simulation, and puts how many there are into
// `n`; NULL: there is no such column.
COGNATE_API
const double *cognate_session_column(const CognateSession *session,
                                     size_t column,
                                     size_t *n);

// Returns the run record as JSON: status, reason, counts, timings, energy, warnings. To be given
// back by cognate_string_free.
COGNATE_API char *cognate_session_record(const CognateSession *session, CognateError **error);

// Linearizes about the present state, between all plant inputs and outputs: matrices A, B, C, D,
// names, eigenvalues and mode shapes as JSON, to be given back by cognate_string_free.
COGNATE_API char *cognate_session_linearize(CognateSession *session, CognateError **error);

// Writes the results so far to a file; the ending of its name tells the format: .csv, .parquet,
// .res, .json, .msg.
COGNATE_API
bool cognate_session_write(const CognateSession *session,
                           const char *path,
                           CognateError **error);

// Writes a page (.html) that shows the run in motion in any browser, and needs nothing else. The
// session wants cognate_options_frames. Shells whose files cannot be read are left out.
COGNATE_API
bool cognate_session_page(const CognateSession *session,
                          const char *path,
                          CognateError **error);

// Returns the state of a session as a text, from which another one goes on, also elsewhere. To be
// given back by cognate_string_free.
COGNATE_API char *cognate_session_state(const CognateSession *session, CognateError **error);

// Goes on from a state.
COGNATE_API
bool cognate_session_reload(CognateSession *session,
                            const char *state,
                            CognateError **error);

// Gives a session back.
COGNATE_API void cognate_session_free(CognateSession *session);

// Reads a function of the model (DX, VM, VARVAL …) from within a routine, as SYSFNC of Adams.
//
// `ids`: `n` numbers, as they stand in parentheses in the function language. `failed` becomes 1
// where there is no such function, or no routine is being called, else 0. NULL is a failure.
COGNATE_API
void cognate_sysfnc(const char *name,
                    const int *ids,
                    int n,
                    double *value,
                    int *failed);

// Reads several functions of the model from within a routine, as SYSARY of Adams.
//
// `name`: TDISP, RDISP, DISP, TVEL, RVEL, VEL, TACC, RACC, ACC, TFORCE, RFORCE or FORCE; 3 or 6
// numbers go into `values`, and how many into `n_values`.
COGNATE_API
void cognate_sysary(const char *name,
                    const int *ids,
                    int n,
                    double *values,
                    int *n_values,
                    int *failed);

// cognate_sysfnc under the name that C routines for Adams call.
COGNATE_API void c_sysfnc(const char *name, const int *ids, int n, double *value, int *failed);

// cognate_sysary under the name that C routines for Adams call.
COGNATE_API
void c_sysary(const char *name,
              const int *ids,
              int n,
              double *values,
              int *n_values,
              int *failed);

// Returns the version of the library: "0.1.0".
COGNATE_API const char *cognate_version(void);

// Returns the version of the library as a number: COGNATE_VERSION_NUMBER of its header. A program
// that finds another than its own COGNATE_VERSION_NUMBER runs with another library than it was
// compiled for.
COGNATE_API uint32_t cognate_version_number(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* COGNATE_H */
