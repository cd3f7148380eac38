#include "run/refusal.h"

#include <string.h>

#include "text/error_text.h"

ethd_status ethd__start_refused(const ethd_loop *loop, ethd_status status, const ethd_error *error,
                                char message[ETHD_MESSAGE_MAX]) {
  if (!strcmp(error->name, "xenomai"))
    return ethd__say(
        message, status,
        "this kernel has no Cobalt core (no /proc/xenomai/version): boot Xenomai's, 3.2 or later, or build "
        "with RT=posix");
  if (!strcmp(error->name, "clock"))
    return ethd__say(
        message, status,
        "Cobalt's clock is %.3f s away from Linux's, as before Xenomai 3.2: stamps of the device would mean "
        "nothing to the loop; boot 3.2 or later on Dovetail",
        error->found);
  if (strcmp(error->name, "require_rt"))
    return ethd__say(message, status, "the loop: %s: %s", error->name, ethd_status_sentence(status));
  int32_t bits = ethd_loop_shortfalls(loop);
  const char *first = bits ? ethd_shortfall_sentence(bits & -bits) : "";
  return ethd__say(message, status, "--require-rt: %s; mend: %s", first, bits ? ethd_shortfall_mend(bits & -bits) : "");
}
