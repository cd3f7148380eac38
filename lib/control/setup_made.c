/* Recognises setups, and programs compiled with other headers. */
#include <string.h>

#include "control/setup.h"
#include "error.h"

#define COOKIE 0x45544844u
#define SKEWED 0x45544900u /* + i: the setup of a program with another size of struct i of ETHD_SIZED */

#define NAME(name) "ethd_" #name,
static const char *const names[] = {ETHD_SIZED(NAME)};
#define COUNT (uint32_t)(sizeof names / sizeof *names)

static uint32_t size_of(const ethd_sizes *sizes, uint32_t i) {
  uint32_t size;
  memcpy(&size, (const char *)sizes + i * sizeof size, sizeof size);
  return size;
}

/* Returns a struct whose size differs between program and library, the innermost first; COUNT: none. The program's list
   may be shorter or longer than this one. */
static uint32_t skewed(const ethd_sizes *there) {
  const ethd_sizes here = ethd_sizes_here();
  const uint32_t count = there->sizes / (uint32_t)sizeof there->sizes;
  for (uint32_t i = count < COUNT ? count : COUNT; i-- > 0;)
    if (size_of(there, i) != size_of(&here, i)) return i;
  return COUNT;
}

static ethd_status refuse(uint32_t i, uint32_t bytes, ethd_error *error) {
  const ethd_sizes here = ethd_sizes_here();
  const double own = size_of(&here, i);
  return ethd__refuse(error, ETHD_E_SIZE, names[i], (ethd__found){bytes, own, own});
}

ethd_status ethd_sizes_check(const ethd_sizes *sizes, ethd_error *error) {
  const uint32_t i = skewed(sizes);
  return i < COUNT ? refuse(i, size_of(sizes, i), error) : ETHD_OK;
}

void ethd_setup_fill(ethd_setup *setup, const ethd_sizes *sizes) {
  const uint32_t i = skewed(sizes);
  memset(setup, 0, sizes->setup);
  setup->cookie = i < COUNT ? SKEWED + i : COOKIE;
  if (i < COUNT)
    setup->bytes = size_of(sizes, i);
  else
    ethd__setup_defaults(setup);
}

ethd_status ethd__setup_made(const void *any, ethd_error *error) {
  const ethd_setup *setup = any;
  if (setup && setup->cookie == COOKIE) return ETHD_OK;
  if (setup && setup->cookie - SKEWED < COUNT) return refuse(setup->cookie - SKEWED, setup->bytes, error);
  return ethd__error(error, ETHD_E_ARGUMENT, "setup (made by ethd_setup_default?)");
}
