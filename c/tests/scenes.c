// Scenes of the gallery through the C interface: each is read, its commands are obeyed, and its
// table is written. scenes GALLERY OUT NAME...
#include "check.h"
#include "cognate.h"
#include <stdlib.h>

// Returns the text of a file, to be freed.
static char *contents(const char *path) {
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    fseek(file, 0, SEEK_END);
    const long n = ftell(file);
    rewind(file);
    char *text = malloc((size_t)n + 1);
    CHECK(text != NULL && fread(text, 1, (size_t)n, file) == (size_t)n);
    text[n] = 0;
    fclose(file);
    return text;
}

static void run(const char *gallery, const char *out, const char *name) {
    char path[4096];
    CognateError *error = NULL;
    snprintf(path, sizeof path, "%s/%s.adm", gallery, name);
    CognateModel *model = cognate_model_read(path, &error);
    CHECK(model != NULL);
    CognateSession *session = cognate_session_new(model, NULL, &error);
    CHECK(session != NULL);
    snprintf(path, sizeof path, "%s/%s.acf", gallery, name);
    char *commands = contents(path);
    CognateStatus status = COGNATE_STATUS_STOPPED;
    CHECK(cognate_session_obey(session, commands, &status, &error));
    CHECK(status == COGNATE_STATUS_COMPLETED);
    snprintf(path, sizeof path, "%s/%s.csv", out, name);
    CHECK(cognate_session_write(session, path, &error));
    free(commands);
    cognate_session_free(session);
    cognate_model_free(model);
}

int main(int argc, char **argv) {
    CHECK(argc > 3);
    for (int k = 3; k < argc; k++) {
        run(argv[1], argv[2], argv[k]);
    }
    return 0;
}
