/* A configuration with every key, each with a value of its own, one of each front; and 50 characters. */
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

static const char everything_in_space[] =
    "[space]\ncommand = force\neffector = cap\nperiod = 0.002\nradius = 0.03\nfinger_radius = 0.007\n"
    "finger_radius_max = 0.011\nswap_time = 0.04\nv_hysteresis = 0.002\nspeed = inf\nforce = 12\nforce_rate = 900\n"
    "x_min = -0.5\nx_max = 0.6\nreach = 0.8\nreach_z = 0.33\nfinger_age = 0.06\nstop_time = 0.25\n"
    "[ability]\nspeed = 2\nacceleration = 20\ndelay = 0.008\nmass = 4\nforce = 100\nfriction = 1.5\n"
    "[finger_filter]\nmethod = cv\nreference = tick\n"
    "[tracking]\nlaw = follow\n[contact]\nlaw = spring\nk_e = 2600\n"
    "[transition]\nlaw = smooth\nbeta_min = 0.2\n"
    "[device]\ndriver = other\nwire = 3 x\n";

#define X50 "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"

#endif
