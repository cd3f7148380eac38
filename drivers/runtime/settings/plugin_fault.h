/* Says what is wrong with a table of parameters or with a plugin that the library refused: which law, which row, what
   was found, and what to write instead. The library itself gives a status and a name. All [main]. */
#ifndef ETHD__SETTINGS_PLUGIN_FAULT_H
#define ETHD__SETTINGS_PLUGIN_FAULT_H

#include "ethd/plugin.h"

/* Checks a table as ethd_params_check_table does. On a refusal `what` holds one line: "row 2, k_c: min 10 is over
   ...". */
ETHD_MUST_CHECK ethd_status ethd__table_fault(const ethd_param *params, uint32_t count, char what[ETHD_MESSAGE_MAX]);

/* Writes one line about the file that ethd_plugin_open refused with `error`; handle: the same file, open. */
void ethd__plugin_fault(void *handle, const ethd_error *error, char what[ETHD_MESSAGE_MAX]);

#endif
