/* Teleoperation: a robot's gripper, far away, follows the operator's ring. What it may touch moves, changes its shape,
   and the operator's finger feels it as a wall. Datagrams about it (doubles, as this machine has them) are
   late, get lost and overtake one another. The strategy is swapped each second while it runs, the energy that a contact
   gives away is bounded, and when nothing has come for LINK_DEAD the ring is braked and let go.
     cc teleop.c $(pkg-config --cflags --libs ethd-drivers) -o teleop
     export ETHD_DATA_DIR=$(pkg-config --variable=datadir ethd-drivers)
     (./teleop ring 4777 6 & ./teleop robot 4777 7 20 10; wait)        PORT SECONDS DELAY_MS LOSS_PERCENT */
#include <arpa/inet.h>
#include <ethd/ethd.h>
#include <ethd/loop.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define LINK_DEAD 0.25 /* s */
#define SMOOTHING 0.02 /* s: time constant with which the wall follows the datagrams */
#define LINE 64        /* datagrams under way */

typedef struct word {
  double number, body[6], shape; /* body: x, y, angle and their speeds */
} word;

static const char *const shapes[] = {"halfplane -1 0 0", "circle -0.05 0 0.05"}; /* each is touched at its origin */
static const ethd_transition_law *const laws[] = {&ethd_transition_offset, &ethd_transition_smooth};

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int fail(const char *what, const char *why) { return fprintf(stderr, "teleop: %s: %s\n", what, why), 1; }

/* The far side. */
static int robot(int fd, double seconds, double delay, double loss) {
  double begin = now(), heard = begin, gripper[2] = {0.3, 0.25}, t, due[LINE];
  word line[LINE];
  int sent = 0;
  for (; (t = now() - begin) < seconds; sent++, usleep(5000)) {
    word w = {sent + 1, {0.238 + 2e-3 * sin(3 * t), 0.25, 0, 6e-3 * cos(3 * t)}, (int)t % 2};
    line[sent % LINE] = w;
    due[sent % LINE] = rand() % 100 < loss ? INFINITY : t + delay * (0.5 + rand() % 100 / 100.);
    for (int i = 0; i < LINE && i <= sent; i++)
      if (due[i] <= t && send(fd, &line[i], sizeof w, 0) > 0) due[i] = INFINITY;
    while (recv(fd, gripper, sizeof gripper, MSG_DONTWAIT) == sizeof gripper) heard = now();
    if (now() - heard > LINK_DEAD) return fail("robot", "no orders: the gripper stays where it is");
  }
  return printf("robot: %d datagrams, the gripper at %.1f mm\n", sent, 1e3 * gripper[0]), 0;
}

/* The operator's side, where the robot is a driver beside the ring's own. */
static ethd_cell *newest; /* from the thread that listens to the control thread, whose the rest is */
static word far;          /* the last datagram */
static double wall[6];    /* the wall's pose and speeds, which follow it */
static int64_t heard, at; /* ns */

static ethd_status open_link(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  return (void)def, (void)message, *out = &far, ETHD_OK;
}
static void close_link(void *device) { (void)device; }

/* A pose that jumps would give energy away, so the wall follows the datagrams smoothly; its speed is that of this. */
static ethd_status read_link(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  double dt = 1e-9 * (double)(now_ns - at), share = fmin(dt / SMOOTHING, 1); /* 1 at the first call */
  if (ethd_cell_take(newest, &far) == ETHD_OK || !at) heard = now_ns;
  for (int i = 0; i < 3; i++) {
    double step = share * (far.body[i] - wall[i]);
    wall[i] += step;
    wall[i + 3] = share < 1 ? step / dt : 0;
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

/* Leads the robot until the time is over, or until a fault has braked the ring and let it go. */
static int lead(int fd, ethd_loop *loop, ethd_control *control, ethd_setup *setup, double seconds) {
  int rules = -1, shown = 0, swaps = -1, touching = 0, late = 0;
  ethd_loop_row row = {.armed = 0};
  word w, last = far;
  ethd_scene *scenes[2];
  ethd_error error;
  for (int i = 0; i < 2; i++)
    if (ethd_scene_parse(shapes[i], strlen(shapes[i]), &scenes[i], &error)) return fail("shape", shapes[i]);
  for (double begin = now(), t; (t = now() - begin) < seconds && (ethd_loop_armed(loop) || t < 1); usleep(1000)) {
    for (; recv(fd, &w, sizeof w, MSG_DONTWAIT) == sizeof w; late += w.number < last.number)
      if (w.number > last.number) last = w, ethd_cell_put(newest, &last); /* else a later one came first */
    while (ethd_loop_take(loop, &row) == ETHD_OK) touching += row.trace.state == ETHD_VO;
    if (send(fd, row.trace.x, sizeof row.trace.x, 0) < 0) continue; /* then answers stop too, which LINK_DEAD sees */
    int law = (int)t % 2, shape = last.shape > 0;
    ethd_setup_transition(setup, laws[law]);
    setup->bodies[0] = scenes[shape];
    if ((law != rules || shape != shown) && ethd_control_post(control, setup, &error) == ETHD_OK)
      rules = law, shown = shape, swaps++; /* else the last post wasn't taken yet: try again in a millisecond */
  }
  ethd_loop_stop(loop);
  if (ethd_loop_join(loop)) return fail("loop", "its clock failed");
  while (ethd_loop_take(loop, &row) == ETHD_OK) continue;
  printf("ring: %d ms in contact, %d swaps, %d datagrams overtaken, at %.1f mm with %g Nm: %s\n", touching, swaps, late,
         1e3 * row.trace.x[0], row.share * row.trace.tau[0], ethd_fault_sentence((ethd_fault)row.trace.fault));
  return row.trace.fault != 0;
}

static int ring(int fd, double seconds) {
  const ethd_setting hand[] = {{"sim.speed", "0.2", 0}, {"sim.meet_x", "0.26", 0}};
  ethd_setup setup = ethd_setup_default();
  const ethd_device_def device = {&setup, hand, 2, ".", NULL, 0};
  ethd_loop_def def = ethd_loop_default();
  struct sockaddr from;
  socklen_t size = sizeof from;
  char text[ETHD_MESSAGE_MAX];
  ethd_loop *loop;
  ethd_error error = {.name = "start"};
  if (ethd_device_open("sim, link", drivers, &device, &def.driver, &def.device, text)) return fail("device", text);
  setup.limits = def.driver->limits(def.device);
  setup.limits.energy = 0.02; /* J: with the surface's own work */
  if (recvfrom(fd, &far, sizeof far, 0, &from, &size) != sizeof far || connect(fd, &from, size))
    return fail("link", "the robot doesn't speak");
  if (ethd_cell_create(sizeof far, &newest, &error) || ethd_control_create(&setup, &def.control, &error) ||
      ethd_loop_create(&def, &loop, &error) || def.driver->start(def.device) || ethd_loop_start(loop, &error))
    return fail("loop", error.name);
  int code = lead(fd, loop, def.control, &setup, seconds);
  ethd_loop_destroy(loop);
  ethd_control_destroy(def.control);
  def.driver->close(def.device);
  return code;
}

int main(int argc, char **argv) {
  struct sockaddr_in here = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int fd = socket(AF_INET, SOCK_DGRAM, 0), far_side = argc == 6 && !strcmp(argv[1], "robot");
  if (!far_side && (argc != 4 || strcmp(argv[1], "ring"))) return fail("ring PORT SECONDS", "see teleop.c"), 2;
  here.sin_port = htons((uint16_t)atoi(argv[2]));
  if ((far_side ? connect : bind)(fd, (struct sockaddr *)&here, sizeof here)) return fail("port", argv[2]);
  return far_side ? robot(fd, atof(argv[3]), 1e-3 * atof(argv[4]), atof(argv[5])) : ring(fd, atof(argv[3]));
}
