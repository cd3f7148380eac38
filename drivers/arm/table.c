#include "arm/table.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"
#include "text/key.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 16)
#define LEAST_FACING 1e-3

typedef struct joint_keys {
  ethd__dh_row row;
  double least, most, speed, acceleration, torque, posture;
} joint_keys;

typedef struct keys {
  int32_t convention, safe;
  double base[3], turned[3], tool[3], facing[3];
  double frequency, damping, delay, rate, singular, pull, turn;
} keys;

#define NEEDED ((double)NAN)
#define MOST_ANGLE 6.3 /* rad: at most one revolution to either side, so that degrees are refused */
#define JOINT(key, unit, min, max, def, member, brief) \
  {{key, unit, min, max, def, brief}, offsetof(joint_keys, member), NULL}
#define KEY(section, key, unit, min, max, def, member, brief) \
  {{key, unit, min, max, def, brief}, offsetof(keys, member), section}

static const ethd__key_row joint_rows[] = {
    JOINT("a", "m", -3, 3, 0, row.a, "length of the link along x"),
    JOINT("d", "m", -3, 3, 0, row.d, "offset of the link along z"),
    JOINT("alpha", "rad", -MOST_ANGLE, MOST_ANGLE, 0, row.alpha, "twist of the link about x"),
    JOINT("offset", "rad", -MOST_ANGLE, MOST_ANGLE, 0, row.offset, "angle about z where the joint is at 0"),
    JOINT("least", "rad", -MOST_ANGLE, MOST_ANGLE, NEEDED, least, "lower end of its travel"),
    JOINT("most", "rad", -MOST_ANGLE, MOST_ANGLE, NEEDED, most, "upper end of its travel"),
    JOINT("speed", "rad/s", 1e-3, 50, NEEDED, speed, "its greatest speed"),
    JOINT("acceleration", "rad/s2", 1e-2, 1e4, NEEDED, acceleration, "its greatest acceleration"),
    JOINT("torque", "Nm", 1e-3, 1e5, NEEDED, torque, "its greatest torque"),
    JOINT("posture", "rad", -MOST_ANGLE, MOST_ANGLE, NEEDED, posture, "angle at the start, and the one to return to"),
};

static const ethd__key_row rows[] = {
    KEY("arm", "convention", "standard|modified", 0, 1, NEEDED, convention, "order of rotations and translations"),
    KEY("arm", "safe", "hold|brakes", 0, 1, NEEDED, safe, "safe state"),
    KEY("base", "x", "m", -100, 100, 0, base[0], "position of the base"),
    KEY("base", "y", "m", -100, 100, 0, base[1], "position of the base"),
    KEY("base", "z", "m", -100, 100, 0, base[2], "position of the base"),
    KEY("base", "roll", "rad", -MOST_ANGLE, MOST_ANGLE, 0, turned[0], "rotation of the base"),
    KEY("base", "pitch", "rad", -MOST_ANGLE, MOST_ANGLE, 0, turned[1], "rotation of the base"),
    KEY("base", "yaw", "rad", -MOST_ANGLE, MOST_ANGLE, 0, turned[2], "rotation of the base"),
    KEY("tool", "x", "m", -3, 3, 0, tool[0], "the end effector's point"),
    KEY("tool", "y", "m", -3, 3, 0, tool[1], "the end effector's point"),
    KEY("tool", "z", "m", -3, 3, 0, tool[2], "the end effector's point"),
    KEY("tool", "facing_x", "1", -1, 1, 0, facing[0], "direction of a plate"),
    KEY("tool", "facing_y", "1", -1, 1, 0, facing[1], "direction of a plate"),
    KEY("tool", "facing_z", "1", -1, 1, 1, facing[2], "direction of a plate"),
    KEY("servo", "frequency", "rad/s", 1, 1e4, NEEDED, frequency, "of the second-order lag of a joint's speed"),
    KEY("servo", "damping", "1", 0.1, 1, NEEDED, damping, "of the same lag"),
    KEY("servo", "delay", "s", 0, 0.1, NEEDED, delay, "dead time from a command to the beginning of its motion"),
    KEY("servo", "rate", "Hz", 125, 1000, NEEDED, rate, "of the commands"),
    KEY("inverse", "singular", "m", 1e-6, 1, NEEDED, singular, "singular value below which a direction is damped"),
    KEY("inverse", "pull", "1/s", 0, 100, NEEDED, pull, "rate of the return to the posture, in the null space"),
    KEY("inverse", "turn", "1/s", 0, 100, NEEDED, turn, "rate of a plate's rotation to its normal; 0: none"),
};

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* ---- sections ---- */

/* Returns the number, from 1, of a section's joint, 0: none. */
static uint32_t joint_of(const char *section) {
  const char *digit = section + strlen("joint");
  const bool is =
      !strncmp(section, "joint", strlen("joint")) && digit[0] >= '1' && digit[0] <= '0' + ETHD_JOINTS_MAX && !digit[1];
  return is ? (uint32_t)(digit[0] - '0') : 0;
}

static bool is_known(const char *section) {
  for (size_t i = 0; i < COUNT(rows); i++)
    if (!strcmp(rows[i].section, section)) return true;
  return joint_of(section) > 0;
}

/* Counts the joints and fills the lines of their sections. */
static ethd_status find_joints(const ethd__key_file *file, uint32_t *count, int line[ETHD_JOINTS_MAX]) {
  *count = 0;
  for (uint32_t i = 0; i < file->ini->section_count; i++) {
    const ethd_ini_section *section = &file->ini->sections[i];
    const uint32_t joint = joint_of(section->name);
    if (!is_known(section->name))
      return ethd__say(file->message, ETHD_E_UNKNOWN,
                       "%s:%d: found [%s]; arm, joint1 to joint%d, base, tool, servo, inverse are allowed", file->name,
                       section->line, section->name, ETHD_JOINTS_MAX);
    if (!joint || joint <= *count) continue;
    if (joint > *count + 1)
      return ethd__say(file->message, ETHD_E_UNKNOWN, "%s:%d: found [joint%u], [joint%u] comes first", file->name,
                       section->line, joint, *count + 1);
    line[(*count)++] = section->line;
  }
  if (*count >= 2) return ETHD_OK;
  return ethd__say(file->message, ETHD_E_RANGE, "%s:%d: found %u joints, 2 to %d are allowed", file->name,
                   *count ? line[0] : 1, *count, ETHD_JOINTS_MAX);
}

/* ---- joints ---- */

static ethd_status refuse(const ethd__key_file *file, const char *section, const char *name, const char *why) {
  const ethd_ini_key *own = ethd_ini_find(file->ini, section, name);
  const ethd__key key = ethd__key_of(file->name, own, file->message);
  return ethd__key_found(&key, ETHD_E_RANGE, why);
}

static ethd_status read_joint(const ethd__key_file *file, uint32_t i, int line, joint_keys *out) {
  char section[16];
  snprintf(section, sizeof section, "joint%u", i + 1);
  ethd_status status = ethd__keys_known(file, section, joint_rows, COUNT(joint_rows), NULL);
  if (!status) status = ethd__keys_read(file, section, line, joint_rows, COUNT(joint_rows), out);
  if (status) return status;
  if (!(out->least < out->most)) return refuse(file, section, "most", "more than `least`");
  if (!(out->posture >= out->least && out->posture <= out->most))
    return refuse(file, section, "posture", "`least` to `most`");
  return ETHD_OK;
}

static void put_joint(const joint_keys *from, uint32_t i, ethd__arm_table *out) {
  out->limits.joint[i] = (ethd_joint_limit){.least = from->least,
                                            .most = from->most,
                                            .speed = from->speed,
                                            .acceleration = from->acceleration,
                                            .torque = from->torque};
  out->posture[i] = from->posture;
}

/* ---- the whole ---- */

/* Refuses a key of the other sections that the table doesn't have. */
static ethd_status check_known(const ethd__key_file *file) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < file->ini->section_count && !status; i++)
    if (!joint_of(file->ini->sections[i].name))
      status = ethd__keys_known(file, file->ini->sections[i].name, rows, COUNT(rows), NULL);
  return status;
}

static ethd_status put(const ethd__key_file *file, const keys *k, const joint_keys *joints, ethd__arm_table *out) {
  ethd__dh_row dh[ETHD_JOINTS_MAX];
  const ethd_vec3 facing = ethd_vec3_of(k->facing);
  const double length = ethd_vec3_norm(facing);
  for (uint32_t i = 0; i < out->limits.count; i++) {
    dh[i] = joints[i].row;
    put_joint(&joints[i], i, out);
  }
  if (!(length >= LEAST_FACING)) return refuse(file, "tool", "facing_z", "a direction that isn't 0");
  const ethd__axes base = ethd__axes_at(k->base, k->turned);
  ethd__linkage_make((ethd__dh)k->convention, dh, out->limits.count, &base, ethd_vec3_of(k->tool),
                     ethd_vec3_scale(1 / length, facing), &out->linkage);
  out->limits.kind = ETHD_JOINTS_SPEED;
  out->limits.period = 1 / k->rate;
  out->safe = k->safe;
  out->servo.frequency = k->frequency;
  out->servo.damping = k->damping;
  out->servo.delay = k->delay;
  out->servo.rate = k->rate;
  out->singular = k->singular;
  out->pull = k->pull;
  out->turn = k->turn;
  return ETHD_OK;
}

static int line_of(const ethd__key_file *file, const char *section) {
  for (uint32_t i = 0; i < file->ini->section_count; i++)
    if (!strcmp(file->ini->sections[i].name, section)) return file->ini->sections[i].line;
  return 0;
}

static ethd_status read_rows(const ethd__key_file *file, keys *out) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; i < COUNT(rows) && !status; i++)
    status = ethd__keys_read(file, NULL, line_of(file, rows[i].section), &rows[i], 1, out);
  return status;
}

static ethd_status fill(const ethd__key_file *file, ethd__arm_table *out) {
  joint_keys joints[ETHD_JOINTS_MAX];
  keys all;
  int line[ETHD_JOINTS_MAX];
  *out = (ethd__arm_table){0};
  ethd_status status = find_joints(file, &out->limits.count, line);
  if (!status) status = check_known(file);
  if (!status) status = read_rows(file, &all);
  for (uint32_t i = 0; i < out->limits.count && !status; i++) status = read_joint(file, i, line[i], &joints[i]);
  return status ? status : put(file, &all, joints, out);
}

ethd_status ethd__arm_table_parse(const char *text, size_t length, const char *name, ethd__arm_table *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd_ini ini;
  ethd_status status = ethd_ini_parse(text, length, name, NULL, NULL, &ini, message);
  if (status) return status;
  status = fill(&(ethd__key_file){&ini, name, message}, out);
  ethd_ini_free(&ini);
  return status;
}

ethd_status ethd__arm_table_load(const char *path, const char *name, ethd__arm_table *out,
                                 char message[ETHD_MESSAGE_MAX]) {
  char *text;
  size_t length;
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  if (status) return status;
  status = ethd__arm_table_parse(text, length, name, out, message);
  free(text);
  return status;
}
