/* The front of a configuration, of the plane or of space, behind one set of functions. */
#ifndef ETHD__SETTINGS_FRONT_H
#define ETHD__SETTINGS_FRONT_H

#include "ethd/config.h"

/* `setup` is an ethd_setup or an ethd_space_setup; the functions are those of control.h and space.h. */
typedef struct ethd__config_front {
  unsigned bit;
  size_t bytes; /* of a setup */
  const ethd_setup_part *(*part_of)(const char *section);
  ethd_method (*chosen)(const void *setup, const ethd_setup_part *part);
  ethd_status (*choose)(void *setup, const char *section, const char *id, const ethd_law *const *laws);
  ethd_status (*key_at)(const void *setup, uint32_t index, ethd_setup_key *out);
  ethd_status (*set)(void *setup, const char *name, double value);
  double (*get)(const void *setup, const char *name);
  /* Takes the scene's materials into a setup that has room for them, then checks it. */
  ethd_status (*check)(const ethd_config *config, void *setup, ethd_error *error);
} ethd__config_front;

enum { ETHD__PLANE = 1, ETHD__SPACE = 2, ETHD__BOTH = 3 };
extern const ethd__config_front ethd__front_plane, ethd__front_space;

/* A setup of either front, as memory for a copy. */
typedef union ethd__setup_copy {
  ethd_setup plane;
  ethd_space_setup space;
} ethd__setup_copy;

static inline const ethd__config_front *ethd__front_of(const ethd_config *config) {
  return config->is_space ? &ethd__front_space : &ethd__front_plane;
}

/* Returns the configuration's own setup. */
static inline const void *ethd__front_setup(const ethd_config *config) {
  return config->is_space ? (const void *)&config->space : &config->setup;
}

#endif
