#include "ethd/base.h"

const char *ethd_status_sentence(ethd_status status) {
  switch (status) {
#define SENTENCE(name, value, sentence) \
  case ETHD_##name: return sentence;
    ETHD_STATUSES(SENTENCE)
#undef SENTENCE
  }
  return "an unknown status";
}
