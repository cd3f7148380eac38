/* Figures of other sensors of the finger than the paper's ring. None has been measured on a device of ours.

   zones   Yoshikawa and Nagura give no figures, only the principle: optical fibres that say on or off. Reach and
           number are chosen so that a centred finger lights no barrier. Switching to 0.1 mm with 10 % of hysteresis is
           what makers of reflective fibre sensors promise. The proximity ring's boards read all barriers at once, so
           the rate is the ring's 300 Hz, and the latency its line's 0.88 ms and 0.3 ms of processing.
   nail    Nakagawara and Fang give no figures either. Assumed is a photo reflector, read with 10 bits over 10 mm, with
           noise of half a step and of 0.02 mm of light, on the same line.
   camera  A motion capture at 90 Hz, whose latency is one frame of exposure, transfer and solving. OptiTrack PrimeX 22
           were measured at 0.02 to 0.07 mm (sd) and +-0.12 mm across the line of sight (Krumpek et al. 2025, arXiv
           2502.21189); with what a marker on skin adds it is 0.15 mm. */
#include "ethd/sim.h"

typedef struct finger_sensor {
  double rate, latency, noise; /* Hz, s, m */
} finger_sensor;

static const finger_sensor sensors[ETHD_READING_COUNT] = {
    [ETHD_READING_ZONES] = {300, 1.2e-3, 0.1e-3},
    [ETHD_READING_NAIL] = {300, 1.2e-3, 0.02e-3},
    [ETHD_READING_CAMERA] = {90, 11.1e-3, 0.15e-3},
};

void ethd_plant_finger(ethd_plant *plant, int32_t reading) {
  plant->reading = reading;
  plant->zones = 12;
  plant->zone_reach = 3.5e-3;
  plant->zone_hysteresis = 0.1;
  plant->nail_angle = 0; /* the tap goes to the left, so the nail faces right */
  plant->nail_step = 10e-3 / 1024;
  if (reading <= ETHD_READING_RAYS || reading >= ETHD_READING_COUNT) return;
  plant->rate = sensors[reading].rate;
  plant->latency = sensors[reading].latency;
  plant->noise = sensors[reading].noise;
}
