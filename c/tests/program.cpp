// The header from C++17: handles in unique_ptr, a routine with data of its own, a session that moves
// to another thread and is interrupted there.

#include "check.h"
#include "cognate.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

template <typename T, void (*Free)(T *)> struct Freed {
    void operator()(T *handle) const { Free(handle); }
};
using Expr = std::unique_ptr<CognateExpr, Freed<CognateExpr, cognate_expr_free>>;
using Names = std::unique_ptr<CognateNames, Freed<CognateNames, cognate_names_free>>;
using Model = std::unique_ptr<CognateModel, Freed<CognateModel, cognate_model_free>>;
using Options = std::unique_ptr<CognateOptions, Freed<CognateOptions, cognate_options_free>>;
using Session = std::unique_ptr<CognateSession, Freed<CognateSession, cognate_session_free>>;
using Rows = std::unique_ptr<CognateRows, Freed<CognateRows, cognate_rows_free>>;

static const std::string CART = "a cart that a routine pushes\n"
                                "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\n"
                                "PART/1, GROUND\nMARKER/1, PART=1\n"
                                "PART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2\n"
                                "JOINT/1, TRANSLATIONAL, I=2, J=1\n"
                                "SFORCE/3, TRANSLATIONAL, I=2, J=1, ACTIONONLY, FUNCTION=USER(8)\\\n"
                                "END\n";

struct Spring {
    double rest;
    int calls;
};

static bool pull(void *data, double, const double *constants, size_t n_constants,
                 const double *values, size_t n_values, double *results, size_t n_results) {
    auto *spring = static_cast<Spring *>(data);
    spring->calls++;
    if (n_constants != 1 || n_values != 1 || n_results != 1) return false;
    results[0] = constants[0] * (spring->rest - values[0]);
    return true;
}

static Session cart(Spring *spring) {
    Model model(cognate_model_from_memory(CART.data(), CART.size(), nullptr, nullptr));
    Options options(cognate_options_new());
    CHECK(cognate_options_column(options.get(), "DZ(2,1,1)", nullptr));
    cognate_options_error(options.get(), 1e-8);
    Session session(cognate_session_new(model.get(), options.get(), nullptr));
    const char *inputs[] = {"DZ(2,1,1)"};
    CHECK(cognate_session_user(session.get(), "SFORCE/3", inputs, 1, pull, spring, nullptr));
    return session;
}

static void expressions_are_shared_by_threads() {
    Expr f(cognate_expr_parse("STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)", COGNATE_DIALECT_FUNCTION, nullptr));
    const size_t n = 10000;
    std::vector<double> times(n);
    for (size_t k = 0; k < n; k++) times[k] = static_cast<double>(k) / n;
    std::vector<std::vector<double>> found(4, std::vector<double>(n));
    std::vector<std::thread> threads;
    for (auto &values : found) {
        threads.emplace_back([&] {
            const double *inputs[] = {times.data()};
            CHECK(cognate_expr_batch(f.get(), inputs, 1, n, values.data(), nullptr, nullptr));
        });
    }
    for (auto &thread : threads) thread.join();
    for (auto &values : found) CHECK(values == found[0]);
}

static void a_callback_of_an_expression_is_called_by_all_threads() {
    std::atomic<int> calls{0};
    auto count = [](void *data, const double *arguments, size_t, double *value, double *slopes) {
        ++*static_cast<std::atomic<int> *>(data);
        *value = 2.0 * arguments[0] + arguments[1];
        if (slopes != nullptr) slopes[0] = 2.0, slopes[1] = 1.0;
        return true;
    };
    Names names(cognate_names_new(COGNATE_DIALECT_FUNCTION, nullptr));
    CHECK(cognate_names_variable(names.get(), "x", nullptr));
    CHECK(cognate_names_function(names.get(), "line", 2, count, true, &calls, nullptr));
    Expr f(cognate_expr_parse_with("line(x, 3)", names.get(), nullptr));
    names.reset();
    std::vector<std::thread> threads;
    for (int k = 0; k < 4; k++) {
        threads.emplace_back([&f, k] {
            for (int j = 0; j < 100; j++) {
                const double x = 100.0 * k + j;
                double value = 0.0, slope = 0.0;
                CHECK(cognate_expr_gradient(f.get(), &x, 1, &value, &slope, nullptr));
                CHECK(value == 2.0 * x + 3.0 && slope == 2.0);
            }
        });
    }
    for (auto &thread : threads) thread.join();
    CHECK(calls >= 400);
}

static void a_routine_has_data_of_its_own() {
    Spring spring{1.0, 0};
    Session session = cart(&spring);
    CognateStatus status;
    CHECK(cognate_session_simulate(session.get(), COGNATE_KIND_DYNAMIC, 3.0, 30, &status, nullptr));
    size_t n = 0;
    const size_t at = cognate_session_find(session.get(), "DZ(2,1,1)");
    const double *z = cognate_session_column(session.get(), at, &n);
    CHECK(n == 31 && spring.calls > 31);
    NEAR(z[n - 1], 1.0 - std::cos(6.0), 1e-6);
}

static void a_session_moves_to_another_thread_and_is_interrupted_there() {
    Spring spring{1.0, 0};
    Session session = cart(&spring);
    CognateStatus status = COGNATE_STATUS_COMPLETED;
    std::atomic<bool> ended{false};
    std::thread thread([&] {
        CHECK(cognate_session_simulate(session.get(), COGNATE_KIND_DYNAMIC, 1e9, 1, &status, nullptr));
        ended = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    // two threads at once are refused, never mixed up
    CognateError *error = nullptr;
    if (!ended) CHECK(!cognate_session_write(session.get(), "x.csv", &error) && error != nullptr);
    cognate_error_free(error);
    while (!ended) {
        cognate_session_interrupt(session.get());
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    thread.join();
    CHECK(status == COGNATE_STATUS_INTERRUPTED);
}

static void another_thread_takes_rows_while_the_simulation_goes_on() {
    Spring spring{1.0, 0};
    Session session = cart(&spring);
    Rows rows(cognate_session_queue(session.get(), false, nullptr));
    const size_t width = cognate_session_columns(session.get());
    std::vector<double> times;
    std::thread reader([&] {
        std::vector<double> row(width);
        CognateNext next;
        while ((next = cognate_rows_next(rows.get(), row.data(), width, 60.0, nullptr)) == COGNATE_NEXT_ROW) {
            times.push_back(row[0]);
        }
        CHECK(next == COGNATE_NEXT_ENDED);
    });
    CHECK(cognate_session_simulate(session.get(), COGNATE_KIND_DYNAMIC, 3.0, 3000, nullptr, nullptr));
    reader.join();
    CHECK(times.size() == 3001 && times.front() == 0.0 && times.back() == 3.0);
}

int main() {
    expressions_are_shared_by_threads();
    a_callback_of_an_expression_is_called_by_all_threads();
    a_routine_has_data_of_its_own();
    a_session_moves_to_another_thread_and_is_interrupted_there();
    another_thread_takes_rows_while_the_simulation_goes_on();
    std::puts("C++: all claims hold");
    return 0;
}
