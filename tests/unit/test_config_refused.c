/* Configurations that are refused: each with its line, what was found and what is allowed. */
#include <stdio.h>
#include <string.h>

#include "config_text.h"
#include "ethd/config.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];

typedef struct bad {
  const char *text, *says;
} bad;

static const bad bads[] = {
    {"[contact]\nk_e = 1\nk_e = 1\n", "x.ini:3: contact.k_e: occurs twice, first on line 2"},
    {"[contact]\nk_e = 1\n[arm]\n[contact]\nk_e = 2\n", "x.ini:5: contact.k_e: occurs twice, first on line 2"},
    {"[device]\na = 1\na = 1\n", "x.ini:3: device.a: occurs twice, first on line 2"},
    {"[nothing]\nx = 1\n", "x.ini:1: [nothing]: unknown section; arm, "},
    {"[arm]\n[nothing]\n[ring]\n", "x.ini:2: [nothing]: unknown section; arm, "},
    {"[ arm]\n", "x.ini:1: [ arm]: unknown section"},
    {"[]\n", "x.ini:1: []: unknown section"},
    {"[contact]\nk_x = 1\n", "x.ini:2: contact.k_x: not a key of kelvin-voigt, which has law, k_e, b_e"},
    {"[arm]\n[ring]\nradius = 0.005\n", "x.ini:3: finger.radius: a value is out of its range; found 0.0075, allowed "
                                        "0.0001 to 0.005, by ring.radius = 0.005"},
    {"[ring]\nradius = 0.0076\n", "x.ini:2: finger.radius_max: a value is out of its range; found "},
    {"[ring]\nr = 1\n", "x.ini:2: ring.r: unknown key; radius are allowed"},
    {"[contact]\nlaw = spring\nb_e = 1\n", "x.ini:3: contact.b_e: not a key of spring, which has law, k_e"},
    {"[contact]\nb_e = 1\nlaw = spring\n", "x.ini:2: contact.b_e: not a key of spring"},
    {"[velocity]\nlaw = lsq\n", "x.ini:2: velocity.law: not a key of lowpass, which has method"},
    {"[tracking]\nmethod = pd\n", "x.ini:2: tracking.method: not a key of pd"},
    {"[contact]\nlaw = offset\n", "x.ini:2: contact.law: found \"offset\", kelvin-voigt, spring, "},
    {"[velocity]\nmethod = fast\n", "x.ini:2: velocity.method: found \"fast\", lowpass, difference, lsq, foaw"},
    {"[transition]\npreset = papers\n", "x.ini:2: transition.preset: found \"papers\", product or paper is allowed"},
    {"[contact]\nk_e = -1\n", "x.ini:2: contact.k_e: found \"-1\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = inf\n", "x.ini:2: contact.k_e: found \"inf\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = nan\n", "x.ini:2: contact.k_e: found \"nan\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = NaN\n", "x.ini:2: contact.k_e: found \"NaN\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = 0x10\n", "x.ini:2: contact.k_e: found \"0x10\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = 1e\n", "x.ini:2: contact.k_e: found \"1e\""},
    {"[contact]\nk_e = 1e400\n", "x.ini:2: contact.k_e: found \"1e400\""},
    {"[contact]\nk_e = 10 N/m\n", "x.ini:2: contact.k_e: found \"10 N/m\", 0 to 1000000 N/m is allowed"},
    {"[contact]\nk_e = 1,5\n", "x.ini:2: contact.k_e: found \"1,5\""},
    {"[contact]\nk_e = .\n", "x.ini:2: contact.k_e: found \".\""},
    {"[contact]\nk_e = 10 # stiff\n", "x.ini:2: contact.k_e: found \"10 # stiff\""},
    {"[contact]\nk_e =\n", "x.ini:2: contact.k_e: found nothing, a value is needed"},
    {"[contact]\nk_e = ; 5\n", "x.ini:2: contact.k_e: found nothing, a value is needed"},
    {"[contact]\n= 5\n", "x.ini:2: contact: a value without a key"},
    {"[contact]\nk_e\n", "x.ini:2: found \"k_e\", [section] or key = value is allowed"},
    {"[contact]\nk_e: 5\n", "x.ini:2: found \"k_e: 5\", [section] or key = value is allowed"},
    {"k_e = 5\n", "x.ini:1: k_e: a key before the first [section]"},
    {"[contact\nk_e = 5\n", "x.ini:1: found \"[contact\", a section needs its ]"},
    {"[contact] k_e = 5\n", "x.ini:1: found \"[contact] k_e = 5\", nothing is allowed after ]"},
    {"[" X50 "]\n", "x.ini:1: a section's name of 50 characters, at most 49 are allowed"},
    {"[device]\na = " X50 X50 X50 X50 "\n", "x.ini:2: a line of 204 characters, at most 197 are allowed"},
    {"[contact]\nk_e = 5\n  b_e = 0x4\n", "x.ini:3: contact.b_e: found \"0x4\""}, /* no continuation */
    {"[device]\na = 1\n  and more\n", "x.ini:3: found \"and more\", [section] or key = value is allowed"},
    {"[contact]\nk_e = 5\001\n", "x.ini:2: a byte 1: this isn't text"},
    {"[contact]\rk_e = 5\r", "x.ini:1: a byte 13: this isn't text"},
    {"[finger]\nradius_max = 0.012\n", "x.ini:2: finger.radius_max: a value is out of its range"},
    {"[ring]\nradius = 0\n", "x.ini:2: ring.radius: found \"0\", 0.0001 to 1 m is allowed"},
    {"[loop]\nperiod = inf\n", "x.ini:2: loop.period: found \"inf\", 1e-05 to 0.1 s is allowed"},
    {"[arm]\n\nmechanism = Serial\n", "x.ini:3: arm.mechanism: found \"Serial\", parallel|serial is allowed"},
    {"[arm]\nlink1 = -1\n", "x.ini:2: arm.link1: found \"-1\", 0.001 to 100 m is allowed"},
    {"[arm]\nmass_x = 0\n", "x.ini:2: arm.mass_x: found \"0\", 1e-09 to 1000000 kg is allowed"},
    {"[limits]\nworkspace = 0 1 0\n", "x.ini:2: limits.workspace: found \"0 1 0\", x_min x_max y_min y_max"},
    {"[limits]\nworkspace = 0 1 0 1 2\n", "x.ini:2: limits.workspace: found"},
    {"[limits]\nworkspace = 0 1 0 nan\n", "x.ini:2: limits.workspace: found"},
    {"[limits]\nworkspace = 1 0 0 1\n", "x.ini:2: limits.workspace: a value is out of its range"},
    {"[limits]\ntorque = -1\n", "x.ini:2: limits.torque: found \"-1\", 0 to inf Nm is allowed"},
    {"[transition]\nswap_time = 2\n", "x.ini:2: transition.swap_time: found \"2\", 0 to 1 s is allowed"},
    {"[transition]\nlaw = smooth\neps_max = 1\n", "x.ini:3: transition.eps_max: not a key of smooth"},
    {"[tracking]\nderivative = 0\n", "x.ini:2: tracking.derivative: found \"0\", velocity|difference is allowed"},
    {"[scene]\nfile = no.scene\n", "x.ini:2: scene.file: /nowhere/no.scene: No such file or directory"},
    {"[scene]\nfiles = no.scene\n", "x.ini:2: scene.files: unknown key; file are allowed"},
    {"[plugins]\nfile = no.so\n", "x.ini:2: plugins.file: /nowhere/no.so: No such file or directory"},
};

TEST(test_bad_texts) {
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    ethd_config *c = (ethd_config *)&i;
    message[0] = 0;
    ethd_status status = ethd_config_parse(bads[i].text, strlen(bads[i].text), "x.ini", "/nowhere", &c, message);
    ck_assert_msg(status < 0, "passed: %s", bads[i].text);
    ck_assert_ptr_null(c);
    ck_assert_msg(strncmp(message, bads[i].says, strlen(bads[i].says)) == 0, "%s\nsays: %s\nnot:  %s", bads[i].text,
                  message, bads[i].says);
  }
}

/* Text of somebody else: a plugin is refused by its name, before anybody looks for the file. */
TEST(test_received_text) {
  const char text[] = "[plugins]\nfile = no.so\n";
  ethd_config *c = (ethd_config *)&c;
  ck_assert_int_eq(ethd_config_parse_received(text, strlen(text), "x.ini", "/nowhere", &c, message), ETHD_E_LOAD);
  ck_assert_ptr_null(c);
  ck_assert_str_eq(message,
                   "x.ini:2: plugins.file: no.so is a program from outside of this folder; --plugins lets it run");
  ck_assert_int_eq(ethd_config_parse_received("[contact]\nk_e = 7\n", 18, NULL, NULL, &c, message), ETHD_OK);
  ck_assert_double_eq(ethd_setup_get(&c->setup, "contact.k_e"), 7);
  ethd_config_free(c);
}

TEST(test_too_many_keys) {
  static char text[64 * 1024];
  char *p = text + sprintf(text, "[device]\n");
  for (int i = 0; i < 513; i++) p += sprintf(p, "k%d = 1\n", i);
  ethd_config *c;
  ck_assert_int_lt(ethd_config_parse(text, (size_t)(p - text), "x.ini", NULL, &c, message), 0);
  ck_assert_str_eq(message, "x.ini:514: over 512 keys");
}
