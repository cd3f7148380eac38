#include "study/movements.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "text/error_text.h"
#include "text/text.h"

static char *folder_of(const ethd__protocol *p) {
  ETHD__FREED char *root = ethd__motion_folder();
  return ethd__path_join(root, p->motion);
}

ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files, size_t *count,
                                 char message[ETHD_MESSAGE_MAX]) {
  *count = 0;
  *files = NULL;
  if (finger) return ethd__movements_list(finger, files, count, message);
  if (!protocol->motion)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: hand.source: recorded needs motion = FOLDER or --finger",
                     protocol->path);
  ETHD__FREED char *folder = folder_of(protocol);
  return folder ? ethd__movements_in(folder, files, count, message) : ETHD_E_MEMORY;
}
