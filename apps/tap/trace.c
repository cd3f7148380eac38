#include "tap/trace.h"

#include <math.h>

#include "text/csv.h"

#define HEADER                                                                                           \
  "t_s,since_wall_s,ring_m,measured_m,finger_m,hand_m,offset_wall_m,v_ring_mps,v_finger_mps,state,beta," \
  "fe_N,fd_N,pad_force_N,tau1_Nm,tau2_Nm"

static double along(ethd_vec n, const double v[2]) { return n.x * v[0] + n.y * v[1]; }

/* Depth of a disc of this radius behind the tangent line of the wall. */
static double depth(const ethd__view *view, const double centre[2], double radius) {
  return along(view->rule.n, centre) + radius - view->wall;
}

static void write_row(ethd_csv_out *csv, const ethd__view *view, double meeting, const ethd_trace *trace,
                      const ethd_truth *truth) {
  ethd_vec n = view->rule.n;
  ethd_csv_number(csv, truth->t);
  ethd_csv_number(csv, truth->t - meeting);
  ethd_csv_number(csv, depth(view, truth->ring, view->ring_radius));
  ethd_csv_number(csv, depth(view, view->rule.side ? truth->motor : truth->ring, view->ring_radius));
  ethd_csv_number(csv, depth(view, truth->finger, view->finger_radius));
  ethd_csv_number(csv, depth(view, truth->hand, view->finger_radius));
  ethd_csv_number(csv, trace->eps != 0 ? trace->eps : NAN);
  ethd_csv_number(csv, along(n, view->rule.side ? truth->motor_v : truth->ring_v));
  ethd_csv_number(csv, along(n, truth->finger_v));
  ethd_csv_integer(csv, trace->state);
  ethd_csv_number(csv, trace->beta);
  ethd_csv_number(csv, along(n, trace->fe));
  ethd_csv_number(csv, along(n, trace->fd));
  ethd_csv_number(csv, truth->pad_force);
  ethd_csv_number(csv, trace->tau[0]);
  ethd_csv_number(csv, trace->tau[1]);
  ethd_csv_row(csv);
}

ethd_status ethd__trace_write(const char *path, const ethd__view *view, const ethd__tap_rows *rows,
                              char message[ETHD_MESSAGE_MAX]) {
  size_t meeting = ethd__metrics_meeting(rows, &view->rule);
  double t = meeting < rows->count ? rows->truth[meeting].t : NAN;
  ethd_csv_out *csv = ethd_csv_create(path, HEADER, message);
  if (!csv) return ETHD_E_FILE;
  for (size_t i = 0; i < rows->count; i++) write_row(csv, view, t, &rows->trace[i], &rows->truth[i]);
  return ethd_csv_close(csv, message);
}
