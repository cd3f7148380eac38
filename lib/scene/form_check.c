#include <string.h>

#include "scene/form.h"

size_t ethd__append(char name[64], size_t at, const char *word) {
  while (*word && at < 63) name[at++] = *word++; /* unreachable: the cut, since the longest name has 53 characters */
  name[at] = 0;
  return at;
}

/* ---- numbers ---- */

static bool may_have(const ethd__form *form, size_t count) {
  if (count <= form->count || !form->step) return count == form->count;
  return count <= form->most && (count - form->count) % form->step == 0;
}

ethd_status ethd__check_count(const ethd__form *form, size_t count, ethd_status status, ethd_error *error) {
  if (may_have(form, count)) return ETHD_OK;
  const bool is_list = form->most == SIZE_MAX, is_odd = is_list && count % form->step != 0;
  char name[64];
  size_t n = ethd__append(name, 0, is_odd ? "an even count of numbers after " : "numbers after ");
  ethd__append(name, n, form->name);
  return ethd__refuse(error, status, name,
                      (ethd__found){(double)count, (double)form->count,
                                    is_list      ? INFINITY
                                    : form->step ? (double)form->most
                                                 : (double)form->count});
}

static ethd_status refuse_number(const ethd__form *form, size_t k, double v, ethd_error *error) {
  size_t i = ethd__number_of(form, k);
  const double max = ETHD__COORDINATE_MAX, min = form->numbers[i].kind == ETHD__LENGTH ? 0 : -max;
  char name[64];
  size_t n = ethd__append(name, 0, form->name);
  ethd__append(name, ethd__append(name, n, " "), form->numbers[i].name);
  return ethd__refuse(error, isfinite(v) ? ETHD_E_RANGE : ETHD_E_NOT_FINITE, name, (ethd__found){v, min, max});
}

ethd_status ethd__check_numbers(const ethd__form *form, const double *numbers, size_t count, ethd_error *error) {
  for (size_t k = 0; k < count; k++) {
    double v = numbers[k];
    bool fits = v > 0 || form->numbers[ethd__number_of(form, k)].kind != ETHD__LENGTH;
    if (!(fabs(v) <= ETHD__COORDINATE_MAX && fits)) return refuse_number(form, k, v, error);
  }
  return ETHD_OK;
}

/* ---- materials ---- */

static bool same(const char *a, const char *b) {
  while (*a && *a == *b) a++, b++;
  return *a == *b;
}

static ethd_status refuse(const ethd_material *m, ethd_status status, const char *name, ethd__found found,
                          ethd_error *error) {
  ethd__refuse(error, status, name, found);
  if (error) error->line = m->line;
  return status;
}

static bool is_name(const char name[ETHD_NAME_MAX]) { return name[0] && memchr(name, 0, ETHD_NAME_MAX); }

static ethd_status check_material(const ethd_material *materials, size_t i, ethd_error *error) {
  const ethd_material *m = &materials[i];
  if (!is_name(m->name)) return refuse(m, ETHD_E_ARGUMENT, "material", ethd__unsaid, error);
  for (size_t k = 0; k < i; k++)
    if (same(m->name, materials[k].name)) return refuse(m, ETHD_E_DUPLICATE, m->name, ethd__unsaid, error);
  if (m->count > ETHD_PARAMS_MAX)
    return refuse(m, ETHD_E_FULL, m->name, (ethd__found){m->count, 0, ETHD_PARAMS_MAX}, error);
  for (uint32_t k = 0; k < m->count; k++) {
    const char *name = m->values[k].name;
    if (!is_name(name)) return refuse(m, ETHD_E_ARGUMENT, m->name, ethd__unsaid, error);
    if (!isfinite(m->values[k].value))
      return refuse(m, ETHD_E_NOT_FINITE, name, (ethd__found){m->values[k].value, NAN, NAN}, error);
    for (uint32_t l = 0; l < k; l++)
      if (same(name, m->values[l].name)) return refuse(m, ETHD_E_DUPLICATE, name, ethd__unsaid, error);
  }
  return ETHD_OK;
}

ethd_status ethd__check_materials(const ethd_material *materials, size_t count, ethd_error *error) {
  if (count > ETHD_MATERIALS_MAX)
    return refuse(&materials[ETHD_MATERIALS_MAX], ETHD_E_FULL, "materials",
                  (ethd__found){(double)count, 0, ETHD_MATERIALS_MAX}, error);
  ethd_status status = ETHD_OK;
  for (size_t i = 0; i < count && !status; i++) status = check_material(materials, i, error);
  return status;
}
