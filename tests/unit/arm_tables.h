/* The arms of apps/config, for tests. */
#ifndef ETHD_TESTS_ARM_TABLES_H
#define ETHD_TESTS_ARM_TABLES_H

#include <stdio.h>
#include <string.h>

#include "arm/table.h"
#include "unit/suite.h"

static const char *const arm_names[] = {"ur5e", "fr3", "iiwa7", "planar"};
enum { ARMS = 4 };

/* Reads a table, with more text behind it. */
static inline void arm_table(const char *name, const char *more, ethd__arm_table *out) {
  char path[64], text[1 << 14], message[ETHD_MESSAGE_MAX];
  snprintf(path, sizeof path, "apps/config/%s.arm", name);
  FILE *in = fopen(path, "r");
  ck_assert_ptr_nonnull(in);
  size_t length = fread(text, 1, sizeof text - 1024, in);
  fclose(in);
  memcpy(text + length, more, strlen(more));
  ck_assert_msg(ethd__arm_table_parse(text, length + strlen(more), path, out, message) == ETHD_OK, "%s", message);
}

#endif
