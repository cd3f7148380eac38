/* Prints the drivers' information on a device, from the open device or from its settings alone. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"
#include "clock.h"

static void limit(const char *name, double value, const char *unit, double scale) {
  if (isinf(value))
    printf("%s no limit", name);
  else
    printf("%s %.4g %s", name, scale * value, unit);
}

/* The joint angles that the device gave when it was opened. */
static void joints(const ethd_config *config, ethd_device *device) {
  ethd_sense sense = {.time_ns = 0};
  ethd_pose pose;
  if (ethd_device_read(device, ethd__clock_now(), &sense) != ETHD_OK) {
    printf("joints       not known before it is enabled\n");
    return;
  }
  ethd_arm_pose(&config->setup.arm, sense.q, &pose);
  printf("joints       %.4f and %.4f rad: the ring's centre at %.4f, %.4f m\n", sense.q[0], sense.q[1], pose.x.x,
         pose.x.y);
}

/* What an arm says of itself, such as the way that is left to the nearest joint limit. */
static void space_figures(const ethd_device *device) {
  static ethd_figure all[ETHD_FIGURES_MAX];
  const char *head = "figures";
  for (uint32_t i = 0, n = ethd_device_figures(device, all, ETHD_FIGURES_MAX); i < n; i++, head = "")
    printf("%-12s %-32s %.4g %s\n", head, all[i].name, all[i].value, strcmp(all[i].unit, "1") ? all[i].unit : "");
}

static void unseen(double age, double lost) {
  limit("\n             a finger unseen: tracking fades after", age, "ms", 1e3);
  limit(", it stops after", lost, "ms", 1e3);
  printf("\n");
}

void ethd__report_drivers(const ethd_config *config, ethd_device *device, bool is_open) {
  const ethd_limits *l = &config->setup.limits;
  const ethd_space_setup *s = &config->space;
  const char *remark;
  printf("drivers      %s: %s\n", config->device,
         is_open ? "opened, nothing enabled" : "read, not touched (--open asks the device)");
  for (uint32_t i = 0; (remark = ethd_device_remark(device, i)); i++) printf("             %s\n", remark);
  if (config->is_space) {
    space_figures(device);
    limit("limits       speed", s->speed, "m/s", 1);
    limit(", gap between samples", s->gap, "ms", 1e3);
    unseen(s->finger_age, s->finger_lost);
    return;
  }
  if (is_open) joints(config, device);
  limit("limits       torque", l->torque, "Nm", 1);
  limit(", speed", l->speed, "m/s", 1);
  limit(", gap between samples", l->gap, "ms", 1e3);
  unseen(l->finger_age, l->finger_lost);
}
