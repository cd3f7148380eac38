#include "screen/place.h"

#include <stdio.h>

#include "cli/cli.h"
#include "record/recording_parts.h"
#include "run/summary.h"

static void choose(ethd__sitting *sitting, const ethd__protocol *protocol, const ethd__place_options *o) {
  if (o->last > protocol->participants)
    ethd__fail(ETHD_EXIT_INPUT, "--participant: found %lld, 1 to %u are allowed", (long long)o->last,
               protocol->participants);
  if (!o->first) return;
  sitting->first = (uint32_t)o->first - 1;
  sitting->last = (uint32_t)o->last;
}

static ethd__hand_source hand_of(const ethd__place_options *o, const ethd__folder *folder) {
  if (folder->protocol.hands == ETHD_HANDS_PEOPLE) return ETHD_HAND_DEVICE;
  if (o->width) return ETHD_HAND_MOUSE;
  return folder->finger ? ETHD_HAND_RECORDED : ETHD_HAND_SIMULATED;
}

/* This comes first, so that nothing moves any more. */
static void close_device(ethd__screen_place *at) {
  char message[ETHD_MESSAGE_MAX];
  if (at->device.self && ethd__station_close(&at->station, message) < 0)
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
  at->device.self = NULL;
}

/* Prints what isn't realtime on this machine and which risks remain. */
static void take_device(ethd__screen_place *at, const ethd__place_options *o) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *config = ethd__folder_path(o->path, ETHD_RECORDING_CONFIG);
  ethd_status status = ethd__station_open(&at->desk, config, at->folder.device, o->is_virtual, &at->station, message);
  ethd__need(status, message);
  ethd__remarks_print(stderr, &at->station.session);
  at->device = ethd__station_source(&at->station);
  at->sitting.source = at->device;
}

/* Opens the requested window; without one the terminal is used. */
static void take_front(ethd__screen_place *at, const ethd__place_options *o) {
  char message[ETHD_MESSAGE_MAX];
  bool people = at->device.self != NULL;
  at->sitting.front = ethd__console_front(&at->console);
  if (!o->width) return;
  if (ethd__screen_open(&at->screen, &at->desk, people ? &at->device : NULL, o->width, o->height, message)) {
    close_device(at);
    ethd__fail(ETHD_EXIT_FAILED, "--screen: %s", message);
  }
  at->has_screen = true;
  if (!people) at->sitting.source = ethd__screen_source(&at->screen);
  if (people) at->station.watcher = ethd__screen_watcher(&at->screen);
  at->sitting.front = ethd__screen_front(&at->screen);
  ethd__screen_describe(&at->screen, message);
  char unsaid[ETHD_MESSAGE_MAX];
  if (ethd__sitting_event(&at->sitting, (ethd__about){0}, "screen", message, unsaid)) {
    close_device(at);
    ethd__fail(ETHD_EXIT_FAILED, "%s", unsaid);
  }
}

void ethd__place_open(const ethd__place_options *o, ethd__screen_place *out) {
  char message[ETHD_MESSAGE_MAX] = "";
  const ethd__protocol *protocol = &out->folder.protocol;
  ethd__need(ethd__folder_open(o->path, true, &out->folder, message), message);
  bool people = protocol->hands == ETHD_HANDS_PEOPLE;
  if (o->is_virtual && !people)
    ethd__fail(ETHD_EXIT_INPUT, "--virtual: %s: hand.source: people is needed", protocol->path);
  if (out->folder.simulated)
    ethd__fail(ETHD_EXIT_INPUT, "%s: holds a simulation; the same command with --simulate goes on", o->path);
  out->console = (ethd__console){.protocol = protocol, .ask = o->ask, .quiet = o->quiet};
  ethd__need(ethd__desk_open(protocol, &out->folder.loaded, out->folder.finger, &out->desk, message), message);
  ethd__need(ethd__sitting_open(&out->folder, hand_of(o, &out->folder), &out->sitting, message), message);
  choose(&out->sitting, protocol, o);
  out->markers.protocol = protocol;
  out->desk.markers = out->sitting.markers = &out->markers;
  out->sitting.source = ethd__desk_source(&out->desk);
  (people ? ethd__hold_device : ethd__catch_interrupt)();
  if (people) take_device(out, o);
  take_front(out, o);
}

ethd_status ethd__place_run(ethd__screen_place *at, bool *over, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__sitting_run(&at->sitting, over, message);
  close_device(at);
  if (!at->has_screen) return status;
  ethd__screen_end(&at->screen, *over);
  ethd__screen_close(&at->screen);
  return status;
}

void ethd__place_close(ethd__screen_place *at) {
  ethd__sitting_close(&at->sitting);
  ethd__markers_close(&at->markers);
  ethd__desk_close(&at->desk);
  ethd__folder_close(&at->folder);
}
