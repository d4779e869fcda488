// Claims of the test programs: each is told by its text where it fails.

#ifndef COGNATE_TESTS_CHECK_H
#define COGNATE_TESTS_CHECK_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(claim)                                                                               \
    do {                                                                                           \
        if (!(claim)) {                                                                            \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #claim);                            \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

#define NEAR(a, b, off) CHECK(fabs((a) - (b)) <= (off))

// Prints every mistake and ends, where there is one.
#define NO_ERROR(error)                                                                            \
    do {                                                                                           \
        CognateDiagnostic d;                                                                       \
        for (size_t k = 0; cognate_error_get(error, k, &d); k++) fprintf(stderr, "%s\n", d.text);  \
        CHECK((error) == NULL);                                                                    \
    } while (0)

#endif
