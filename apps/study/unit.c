#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "study/row.h"
#include "study/shard.h"

#define HASH_DIGITS 12

static char *had(char *text, int length) {
  if (length < 0) ethd__fail_memory();
  return text;
}

uint64_t ethd__unit_count(const ethd__protocol *protocol) {
  return (uint64_t)ethd__protocol_points(protocol) * protocol->participants;
}

char *ethd__shard_path(const ethd__folder *folder, const ethd__shard *shard, const char *suffix) {
  char *path = NULL;
  int length =
      asprintf(&path, "%s/shard-%" PRIu32 "-of-%" PRIu32 "%s", folder->path, shard->index, shard->count, suffix);
  return had(path, length);
}

char *ethd__shard_header(const ethd__protocol *protocol) {
  char *header = NULL;
  int length = asprintf(&header, "study,point," ETHD_STUDY_TAPS_HEADER);
  had(header, length);
  for (size_t i = 0; i < protocol->axis_count; i++) {
    char *longer = NULL;
    length = asprintf(&longer, "%s,%s", header, protocol->axes[i].key);
    free(header);
    header = had(longer, length);
  }
  return header;
}

char *ethd__unit_prefix(const ethd__folder *folder, uint64_t unit) {
  char id[ETHD_STUDY_ID_MAX], *prefix = NULL;
  uint64_t people = folder->protocol.participants;
  ethd__participant_id(&folder->protocol, (uint32_t)(unit % people), id);
  int length = asprintf(&prefix, "%.*s,%" PRIu64 ",%s,", HASH_DIGITS, folder->hash, unit / people, id);
  return had(prefix, length);
}
