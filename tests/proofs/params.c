/* Any table of up to two rows with texts of up to three characters, any values: the check touches nothing outside of
   it, and what it lets pass has values within their rows. */
#include "../../lib/param.c"

size_t nondet_size(void);
int nondet_int(void);

ethd_status ethd__refuse(ethd_error *error, ethd_status status, const char *name, ethd__found found) {
  (void)error, (void)name, (void)found;
  return status;
}

int main(void) {
  char text[6][4];
  ethd_param rows[2];
  double values[2];
  uint32_t count = (uint32_t)nondet_int();
  __CPROVER_assume(count <= 2);
  for (int i = 0; i < 6; i++) text[i][3] = 0;
  for (int i = 0; i < 2; i++) {
    rows[i].name = nondet_int() ? text[3 * i] : 0;
    rows[i].unit = nondet_int() ? text[3 * i + 1] : 0;
    rows[i].brief = nondet_int() ? text[3 * i + 2] : 0;
  }
  if (ethd_params_check_table(rows, count, 0) != ETHD_OK) return 0;
  for (uint32_t i = 0; i < count; i++) {
    __CPROVER_assert(rows[i].name && rows[i].unit && rows[i].brief, "no text is missing");
    __CPROVER_assert(rows[i].min <= rows[i].def && rows[i].def <= rows[i].max, "the default is in its range");
  }
  if (ethd_params_check(rows, count, values, 0) != ETHD_OK) return 0;
  for (uint32_t i = 0; i < count; i++)
    __CPROVER_assert(values[i] >= rows[i].min && values[i] <= rows[i].max, "values are in their ranges");
  return 0;
}
