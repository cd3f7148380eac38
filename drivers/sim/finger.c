/* Other sensors of the finger than the paper's ring, with their figures.

   zones   Yoshikawa and Nagura give none but the principle: optical fibres that say on or off. Reach and number are such that
           a centred finger lights no barrier; switching to 0.1 mm with 10 % of hysteresis is what makers of reflective
           fibre sensors promise. Read at once by the proximity ring's boards: its 300 Hz, and its line's 0.88 ms with 0.3 ms
           of processing.
   nail    Nakagawara and Fang give none either: a photo reflector read by 10 bits over 10 mm, noise of half a step and of
           0.02 mm of light; on the same line.
   camera  a motion capture: 90 Hz; its latency is one frame of exposure, transfer and solving; OptiTrack PrimeX 22 were
           measured at 0.02 to 0.07 mm (sd) and +-0.12 mm across the line of sight (Krumpek et al. 2025, arXiv
           2502.21189), to which a marker on skin adds: 0.15 mm.
   None of these has been measured on a device of ours. */
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
  plant->nail_angle = 0; /* the tap goes to the left: the nail looks to the right */
  plant->nail_step = 10e-3 / 1024;
  if (reading <= ETHD_READING_RAYS || reading >= ETHD_READING_COUNT) return;
  plant->rate = sensors[reading].rate;
  plant->latency = sensors[reading].latency;
  plant->noise = sensors[reading].noise;
}
