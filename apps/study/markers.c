#include "study/markers.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "run/telemetry.h"

#define SECOND INT64_C(1000000000)

ethd_status ethd__markers_open(const char *address, ethd__markers *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__markers){.address = address, .socket = -1};
  return address ? ethd__telemetry_open("--markers", address, true, &out->socket, message) : ETHD_OK;
}

void ethd__markers_close(ethd__markers *m) {
  if (m->socket >= 0) close(m->socket);
  m->socket = -1;
}

/* A send can report a refusal of the previous datagram without sending this one, which is then sent once more. */
static bool leaves(int socket, const char *line, size_t length) {
  for (int tries = 0; tries < 2; tries++)
    if (send(socket, line, length, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) return tries == 0;
  return false;
}

void ethd__markers_send(ethd__markers *m, const char *event, const ethd__turn *turn, int64_t ns, const char *reason) {
  char id[ETHD_STUDY_ID_MAX], line[256];
  if (!m || m->socket < 0) return;
  const ethd__protocol *p = m->protocol;
  ethd__participant_id(p, turn->person, id);
  snprintf(line, sizeof line, "%s %s %zu %" PRIu32 " %s %s %s %" PRId64 ".%09" PRId64 " %s\n", event, id, turn->number,
           turn->attempt, turn->block.training ? "training" : "test", p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed], ns / SECOND, ns % SECOND, reason);
  errno = 0;
  if (leaves(m->socket, line, strlen(line)) || atomic_exchange(&m->told, true)) return;
  fprintf(stderr, "%s: --markers: %s: %s; markers are lost, and the study goes on\n", program_invocation_short_name,
          m->address, strerror(errno));
}
