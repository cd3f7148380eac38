/* Solids in a test, as text, and what their surfaces are compared by. */
#ifndef ETHD_TESTS_SOLIDS_RIG_H
#define ETHD_TESTS_SOLIDS_RIG_H

#include <string.h>

#include "ethd/solids.h"
#include "unit/suite.h"

static inline ethd_solids *parse(const char *text) {
  ethd_solids *solids;
  ethd_error error = {.name = ""};
  ethd_status status = ethd_solids_parse(text, strlen(text), &solids, &error);
  ck_assert_msg(status == ETHD_OK, "line %d, %s: %s", error.line, error.name, ethd_status_sentence(status));
  return solids;
}

static inline bool close_to(ethd_vec3 a, ethd_vec3 b) { return ethd_vec3_norm(ethd_vec3_sub(a, b)) < 1e-15; }

/* Distance from x along the surface's normal, m. */
static inline double depth(const ethd_surface *s, ethd_vec3 x) {
  return ethd_vec3_dot(s->n, ethd_vec3_sub(s->point, x));
}

#endif
