/* A configuration with every key, each with a value of its own; and 50 characters. */
#ifndef ETHD_TESTS_CONFIG_TEXT_H
#define ETHD_TESTS_CONFIG_TEXT_H

static const char everything[] =
    "[arm]\nmechanism = serial\nlink1 = 0.31\nlink2 = 0.32\nmass_x = 0.5\nmass_y = 0.6\n"
    "[ring]\nradius = 0.013\n"
    "[finger]\nradius = 0.0071\nradius_max = 0.0091\n"
    "[loop]\nperiod = 0.002\n"
    "[velocity]\nmethod = lsq\nwindow = 9\n"
    "[finger_fit]\nmethod = robust\n"
    "[finger_filter]\nmethod = cv\nreference = tick\n"
    "[tracking]\nlaw = pd\nk_t = 41\nb_t = 2\nderivative = difference\n"
    "[contact]\nlaw = hunt-crossley\nk_e = 2600\n"
    "[transition]\nlaw = offset\nb_d = 110\nv_th = 0.021\nbeta_min = 0.2\neps_max = inf\nt_max = +inf\n"
    "v_hysteresis = 0.001\npreset = product\nswap_time = 0.03\n"
    "[limits]\ntorque = 1.5\ntorque_rate = inf\nspeed = 2\nworkspace = -0.4 0.4 0.1 inf\nstep_time = 5e-4\nstop_time = "
    "0.75\n"
    "[device]\ndriver = other\nwire = 3 x\n";

#define X50 "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"

#endif
