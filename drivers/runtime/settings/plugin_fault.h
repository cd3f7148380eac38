/* Explains why a table of parameters or a plugin was refused: the law, the row, the found value, and the allowed one.
   The library itself gives only a status and a name. All [main]. */
#ifndef ETHD__SETTINGS_PLUGIN_FAULT_H
#define ETHD__SETTINGS_PLUGIN_FAULT_H

#include "ethd/plugin.h"

/* Checks a table as ethd_params_check_table does. On a refusal `what` holds one line: "row 2, k_c: min 10 is over
   ...". */
ETHD_MUST_CHECK ethd_status ethd__table_fault(const ethd_param *params, uint32_t count, char what[ETHD_MESSAGE_MAX]);

/* Writes one line about the file that ethd_plugin_open refused with `error`; handle: the same file, open. */
void ethd__plugin_fault(void *handle, const ethd_error *error, char what[ETHD_MESSAGE_MAX]);

#endif
