/* Teleoperation: a remote robot's gripper (robot.c) follows the operator's ring. The surface before it moves and changes its shape; the operator's finger feels it as a wall. Datagrams are late, get lost and overtake one another;
   damaged ones are dropped; a surface that jumps becomes a wall that moves slowly. The strategy is swapped each second, a
   contact's energy is bounded, and LINK_DEAD without a message brakes the ring and removes the torque. Either side may begin:
     cc robot.c -lm -o robot && cc teleop.c $(pkg-config --cflags --libs ethd-drivers) -o teleop
     export ETHD_DATA_DIR=$(pkg-config --variable=datadir ethd-drivers)
     (./teleop 4777 6 & ./robot 4777 7 20 10; wait)        PORT SECONDS, and of the robot DELAY_MS LOSS_PERCENT */
#include <ethd/ethd.h>
#include <ethd/loop.h>
#include <signal.h>

#include "teleop.h"

#define SMOOTHING 0.02 /* s: time constant with which the wall follows the words */
#define WALL_SPEED 0.1 /* m/s along x and along y, and */
#define WALL_TURN 0.5  /* rad/s at most: a wall that follows a jump pushes the ring and doesn't throw it */

static const char *const shapes[] = {"halfplane -1 0 0", "circle -0.05 0 0.05"}; /* each is touched at its origin */
static const ethd_transition_law *const laws[] = {&ethd_transition_offset, &ethd_transition_smooth};
static volatile sig_atomic_t over; /* Ctrl-C */
static void end(int signal) { over = signal; }

/* The robot is a driver beside the ring's own. */
static ethd_cell *newest; /* from the receiving thread to the control thread, which has the rest */
static word far;          /* the last message */
static double wall[6];    /* the wall's pose and speeds, which follow it */
static int64_t heard, at; /* ns */

static ethd_status open_link(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  return (void)def, (void)message, *out = &far, ETHD_OK;
}
static void close_link(void *device) { (void)device; }

/* A jump of the pose would add energy, so the wall follows the messages smoothly; its speed is that of this motion. */
static ethd_status read_link(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  static const double most[] = {WALL_SPEED, WALL_SPEED, WALL_TURN};
  double dt = at ? 1e-9 * (double)(now_ns - at) : 0;
  if (ethd_cell_take(newest, &far) == ETHD_OK || !at) heard = now_ns;
  for (int i = 0; i < 3; i++) {
    wall[i + 3] = fmax(-most[i], fmin((far.pose[i] - wall[i]) / fmax(SMOOTHING, dt), most[i]));
    wall[i] += wall[i + 3] * dt;
  }
  at = now_ns;
  memcpy(out->bodies, wall, sizeof wall);
  out->have |= ETHD_HAVE_BODY;
  if ((double)(now_ns - heard) > 1e9 * LINK_DEAD) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_APPLICATION);
  return (void)device, ETHD_OK;
}

static const ethd_driver link_driver = {.size = sizeof link_driver,
                                        .abi = ETHD_DRIVER_ABI,
                                        .id = "link",
                                        .brief = "a robot far away",
                                        .open = open_link,
                                        .read = read_link,
                                        .close = close_link};
static const ethd_driver *const drivers[] = {&ethd_driver_sim, &link_driver, NULL};

/* Waits for the robot's first message, and receives from this sender alone from then on. */
static int meet(int fd, ear *e) {
  struct sockaddr_in from;
  for (double begin = now(); now() - begin < TELEOP_WAIT && !over; usleep(1000)) {
    socklen_t length = sizeof from;
    ssize_t size = recvfrom(fd, &e->last, sizeof e->last, MSG_DONTWAIT | MSG_TRUNC, (struct sockaddr *)&from, &length);
    if (is_word(&e->last, size)) return connect(fd, (struct sockaddr *)&from, length);
    e->nonsense += size >= 0;
  }
  return over ? 1 : fail("robot", "no packets from it: start it with the same port");
}

typedef struct strategy {
  ethd_scene *scenes[2];          /* one for each shape */
  int lent[2], law, shape, swaps; /* lent: the controller may use this scene */
} strategy;

/* Swaps to a law and a shape. Events are polled all the time, since the controller takes no post when they leave no
   room, and a scene that was replaced is posted again only after an event has handed it back. */
static void swap(ethd_control *control, ethd_setup *setup, strategy *s, int law, int shape) {
  ethd_event event;
  ethd_error error;
  while (ethd_control_poll(control, &event) == ETHD_OK)
    for (int i = 0; i < 2; i++) s->lent[i] &= event.scene != s->scenes[i];
  if (shape == s->shape ? law == s->law : s->lent[shape]) return;
  ethd_setup_transition(setup, laws[law]), setup->bodies[0] = s->scenes[shape];
  if (ethd_control_post(control, setup, &error)) return; /* the last one still waits: again in a millisecond */
  s->law = law, s->shape = shape, s->lent[shape] = 1, s->swaps++;
}

/* Leads the robot until the time is over, or until a fault has stopped the ring. */
static int lead(int fd, ear *e, ethd_loop *loop, ethd_control *control, ethd_setup *setup, double seconds) {
  int touching = 0;
  double begin = now(), t, pushed = 0; /* m/s: the wall is at the left, so it pushes a ring that moves right */
  ethd_loop_row row = {.armed = 0};
  word order = {.version = VERSION};
  strategy s = {.law = -1, .swaps = -1};
  for (int i = 0; i < 2; i++)
    if (ethd_scene_parse(shapes[i], strlen(shapes[i]), &s.scenes[i], NULL)) return fail("shape", shapes[i]);
  for (; (t = now() - begin) < seconds && !over && (ethd_loop_armed(loop) || t < 1); usleep(1000)) {
    if (hear(fd, e)) ethd_cell_put(newest, &e->last);
    for (; ethd_loop_take(loop, &row) == ETHD_OK; pushed = fmax(pushed, row.trace.v[0]), order.number++)
      touching += row.trace.state == ETHD_VO;
    memcpy(order.pose, row.trace.x, sizeof row.trace.x);
    if (order.number && send(fd, &order, sizeof order, 0) < 0) continue; /* answers stop too, which LINK_DEAD sees */
    swap(control, setup, &s, (int)t % 2, e->last.shape > 0);
  }
  ethd_loop_stop(loop);
  if (ethd_loop_join(loop)) return fail("loop", "its clock failed");
  while (ethd_loop_take(loop, &row) == ETHD_OK) continue;
  printf("ring: %d ms in contact, %d swaps, pushed at %.3f m/s at most; datagrams dropped: %d overtaken, "
         "%d of nonsense; at %.1f mm with %g Nm: %s\n",
         touching, s.swaps, pushed, e->late, e->nonsense, 1e3 * row.trace.x[0], row.share * row.trace.tau[0],
         ethd_fault_sentence((ethd_fault)row.trace.fault));
  return row.trace.fault != 0;
}

int main(int argc, char **argv) {
  const ethd_setting hand[] = {{"sim.speed", "0.2", 0}, {"sim.meet_x", "0.22", 0}};
  ethd_setup setup = ethd_setup_default();
  const ethd_device_def device = {&setup, hand, 2, ".", NULL, 0, NULL};
  ethd_loop_def def = ethd_loop_default();
  ear e = {0};
  double port, seconds;
  char text[ETHD_MESSAGE_MAX];
  ethd_loop *loop;
  ethd_error error = {.name = "start"};
  if (argc != 3 || !number(argv[1], 1, 65535, &port) || !number(argv[2], 0, 1e6, &seconds))
    return fail("teleop", "PORT SECONDS are needed"), 2;
  int fd = line_open(port, bind);
  if (fd < 0) return fail(argv[1], strerror(errno));
  if (signal(SIGINT, end) == SIG_IGN) signal(SIGINT, SIG_IGN); /* a shell's & has it ignored */
  signal(SIGTERM, end);
  if (ethd_device_open("sim, link", drivers, &device, &def.device, text)) return fail("device", text);
  setup.limits = ethd_device_limits(def.device);
  setup.limits.energy = 0.02; /* J: with the surface's own work */
  if (meet(fd, &e)) return 1;
  far = e.last;
  memcpy(wall, far.pose, sizeof far.pose);
  if (ethd_cell_create(sizeof far, &newest, &error) || ethd_control_create(&setup, &def.control, &error) ||
      ethd_loop_create(&def, &loop, &error))
    return fail("loop", error.name);
  int code = ethd_device_start(def.device) || ethd_loop_start(loop, &error)
                 ? fail("start", error.name)
                 : lead(fd, &e, loop, def.control, &setup, seconds);
  if (ethd_device_stop(def.device) < 0) code = fail("device", "it doesn't stop");
  ethd_loop_destroy(loop);
  ethd_control_destroy(def.control);
  ethd_device_close(def.device);
  return code;
}
