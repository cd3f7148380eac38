#include "study/markers.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "run/telemetry.h"

#define SECOND INT64_C(1000000000)

ethd_status ethd__markers_open(const ethd__protocol *p, ethd__markers *out, char message[ETHD_MESSAGE_MAX]) {
  char what[ETHD_MESSAGE_MAX / 2];
  *out = (ethd__markers){.protocol = p, .socket = -1};
  snprintf(what, sizeof what, "%s: study.markers", p->path);
  return p->markers ? ethd__telemetry_open(what, p->markers, true, &out->socket, message) : ETHD_OK;
}

void ethd__markers_close(ethd__markers *m) {
  if (m->socket >= 0) close(m->socket);
  m->socket = -1;
}

/* A send may fail because of the one before, whose datagram nobody took; this one is then still to be sent. */
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
  fprintf(stderr, "%s: study.markers: %s: %s; markers are lost, and the study goes on\n", program_invocation_short_name,
          p->markers, strerror(errno));
}
