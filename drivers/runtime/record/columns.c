/* The columns of both fronts' traces. Sense and trace grow at their ends: all columns after a newer one are newer. */
#include "ethd/record.h"
#include "ethd/space.h"

#define LETTER_double 'f'
#define LETTER_int64_t 'i'
#define SENSE_COLUMN(type, name, count, unit, brief) \
  {#name,         unit,                              \
   count,         offsetof(ethd_trace, sense.name),  \
   LETTER_##type, offsetof(ethd_trace, sense.name) >= offsetof(ethd_trace, sense.finger_noise)},
#define TRACE_COLUMN(type, name, count, unit, brief) \
  {#name,         unit,                              \
   count,         offsetof(ethd_trace, name),        \
   LETTER_##type, offsetof(ethd_trace, name) >= offsetof(ethd_trace, learnt)},

const ethd_column ethd_trace_columns[] = {ETHD_SENSE_FIELDS(SENSE_COLUMN)
                                              ETHD_TRACE_FIELDS(TRACE_COLUMN){NULL, NULL, 0, 0, 0, false}};

#define SPACE_SENSE_COLUMN(type, name, count, unit, brief) \
  {#name, unit, count, offsetof(ethd_space_trace, sense.name), LETTER_##type, false},
#define SPACE_TRACE_COLUMN(type, name, count, unit, brief) \
  {#name, unit, count, offsetof(ethd_space_trace, name), LETTER_##type, false},

const ethd_column ethd_space_trace_columns[] = {ETHD_SPACE_SENSE_FIELDS(SPACE_SENSE_COLUMN) ETHD_SPACE_TRACE_FIELDS(
    SPACE_TRACE_COLUMN){NULL, NULL, 0, 0, 0, false}};
