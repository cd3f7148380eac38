#include "finger/camera.h"

#include <jansson.h>
#include <math.h>

#include "ethd/sense.h"
#include "text/error_text.h"

#define SECONDS_MAX 9e9    /* s: 285 years, what 64 bits of ns hold */
#define NOISE_MAX 1.0      /* m, m/s */
#define BACK_NS 1000000000 /* no network delays a datagram for this time: the sender's clock jumped back */
#define AHEAD_NS 50000000  /* no datagram is quicker by this time than all before: the clock jumped ahead */
#define ORDER_MAX 1000     /* exposures that may overtake a datagram; with more the sender has restarted */

/* ---- the datagram ---- */

static bool refuse(char *why, const char *what) {
  (void)ethd__say(why, ETHD_E_SYNTAX, "%s", what);
  return false;
}

/* Reads a list of two or three numbers and returns how many; 0: it isn't one. The third is 0 where there are two. */
static uint32_t read_list(const json_t *list, double most, ethd_vec3 *out) {
  double x[3] = {0, 0, 0};
  const size_t n = json_array_size(list);
  if (n != 2 && n != 3) return 0;
  for (size_t i = 0; i < n; i++) {
    x[i] = json_number_value(json_array_get(list, i));
    if (!json_is_number(json_array_get(list, i)) || !(fabs(x[i]) <= most)) return 0;
  }
  *out = ethd_vec3_of(x);
  return (uint32_t)n;
}

static bool is_between(double x, double least, double most) { return x >= least && x <= most; }

static bool check(json_int_t seq, double t, const json_t *p, const json_t *v, ethd__exposure *e, char *why) {
  if (seq < 0 || seq > UINT32_MAX) return refuse(why, "seq: 0 to 4294967295 is allowed");
  if (!is_between(t, -SECONDS_MAX, SECONDS_MAX)) return refuse(why, "t: seconds up to 9e9 are allowed");
  if (!is_between(e->noise, 0, NOISE_MAX)) return refuse(why, "noise: 0 to 1 m is allowed");
  if (!is_between(e->v_noise, 0, NOISE_MAX)) return refuse(why, "v_noise: 0 to 1 m/s is allowed");
  if (!is_between(e->confidence, 0, 1)) return refuse(why, "confidence: 0 to 1 is allowed");
  if (!v != !(e->v_noise > 0)) return refuse(why, "v and a v_noise over 0 belong together");
  if (p && !(e->axes = read_list(p, ETHD_SENSE_LENGTH_MAX, &e->finger)))
    return refuse(why, "p: two or three numbers within 1e6 m are allowed");
  if (v && read_list(v, ETHD_SENSE_SPEED_MAX, &e->v) != e->axes)
    return refuse(why, "v: as many numbers as in p, within 1e6 m/s, are allowed");
  e->seq = (uint32_t)seq;
  e->t_ns = llround(1e9 * t);
  return true;
}

bool ethd__exposure_decode(const char *bytes, size_t count, ethd__exposure *out, char why[ETHD_MESSAGE_MAX]) {
  json_error_t error = {.text = ""};
  json_int_t seq = 0;
  double t = 0;
  json_t *p = NULL, *v = NULL;
  *out = (ethd__exposure){.confidence = 1};
  if (count > ETHD__EXPOSURE_SIZE) return refuse(why, "a datagram of at most 1024 bytes is allowed");
  const locale_t own = uselocale(ethd__c_locale); /* jansson reads the decimal point from it */
  json_t *root = json_loadb(bytes, count, JSON_REJECT_DUPLICATES, &error);
  const bool is_read = root && !json_unpack_ex(root, &error, JSON_STRICT, "{s:I, s:F, s?o, s?F, s?o, s?F, s?F}", "seq",
                                               &seq, "t", &t, "p", &p, "noise", &out->noise, "v", &v, "v_noise",
                                               &out->v_noise, "confidence", &out->confidence);
  uselocale(own);
  const bool is_good = is_read ? check(seq, t, p, v, out, why) : refuse(why, error.text);
  json_decref(root);
  return is_good;
}

/* ---- clock ---- */

/* Differences wrap round as the clocks do, because the clocks' zeros are arbitrary. */
static int64_t minus(int64_t a, int64_t b) { return (int64_t)((uint64_t)a - (uint64_t)b); }
static int64_t plus(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }

static int64_t lesser(int64_t a, int64_t b) { return minus(a, b) < 0 ? a : b; }

static void begin(ethd__camera_clock *c, int64_t late) {
  c->jumps += c->started;
  c->unsettled = c->started ? ETHD__CAMERA_UNSETTLED : 0;
  c->started = true;
  c->least[0] = c->least[1] = late;
  c->in_block = 0;
}

/* A datagram delayed by the network is older by both its count and its clock. If only one of them is older, the clock
   was set back, or the bridge was restarted and counts from 0. */
static bool jumped(const ethd__camera_clock *c, const ethd__exposure *e, int64_t late) {
  int64_t off = minus(late, lesser(c->least[0], c->least[1]));
  int32_t step = (int32_t)(e->seq - c->seq);
  bool is_newer = minus(e->t_ns, c->t_ns) > 0;
  return off > BACK_NS || off < -AHEAD_NS || step > ORDER_MAX || step < -ORDER_MAX || is_newer != (step > 0);
}

static void settle(ethd__camera_clock *c, int64_t late) {
  if (c->in_block++ == ETHD__CAMERA_BLOCK) {
    c->least[1] = c->least[0];
    c->least[0] = late;
    c->in_block = 1;
  }
  c->least[0] = lesser(c->least[0], late);
}

bool ethd__camera_clock_step(ethd__camera_clock *c, const ethd__exposure *e, int64_t arrival_ns, int64_t *sample_ns) {
  int64_t late = minus(arrival_ns, e->t_ns);
  if (!c->started || jumped(c, e, late)) {
    begin(c, late);
  } else if (minus(e->t_ns, c->t_ns) <= 0) {
    c->lost++;
    return false;
  } else {
    c->lost += e->seq - c->seq - 1;
  }
  settle(c, late);
  c->seq = e->seq;
  c->t_ns = e->t_ns;
  if (c->unsettled && c->unsettled--) return false;
  *sample_ns = minus(plus(e->t_ns, lesser(c->least[0], c->least[1])), c->delay);
  return true;
}
