#include "solids/solids.h"

void ethd_solids_describe(const ethd_solids *solids, ethd_solids_info *out) {
  *out = (ethd_solids_info){solids->count, solids->material_count, solids->min, solids->max, solids->bytes};
}

const ethd_material *ethd_solids_material(const ethd_solids *solids, size_t i) {
  return i < solids->material_count ? &solids->materials[i] : NULL;
}
