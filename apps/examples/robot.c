/* The far side of a teleoperation, modelled: a robot whose gripper follows the operator's ring (teleop.c says how to
   start both), and a surface before it that moves and changes its shape. Its messages are late, get lost and overtake one another. Without orders for LINK_DEAD the gripper stays where it is. */
#include "teleop.h"

static word surface(double t, uint32_t number) { /* t: s */
  return (word){VERSION, number, {0.238 + 2e-3 * sin(3 * t), 0.25, 0}, (int)t % 2};
}

/* Sends until an answer comes, then for `seconds`; returns whether the link was lost before. */
static int follow(int fd, ear *orders, double seconds, double delay, double loss) {
  double begin = now(), end = begin + TELEOP_WAIT, heard = 0, due[LINE];
  word line[LINE];
  for (uint32_t sent = 0; now() < end; usleep(5000), sent++) {
    double t = now() - begin;
    line[sent % LINE] = surface(t, sent + 1);
    due[sent % LINE] = rand() % 100 < loss ? INFINITY : t + delay * (0.5 + rand() % 100 / 100.);
    for (uint32_t i = 0; i < LINE && i <= sent; i++)
      if (due[i] <= t && send(fd, &line[i], sizeof *line, 0) > 0) due[i] = INFINITY;
    int met = orders->last.number > 0;
    if (hear(fd, orders)) heard = now();
    if (!met && orders->last.number) end = heard + seconds;
    if (met && now() - heard > LINK_DEAD) return 1;
  }
  return 0;
}

int main(int argc, char **argv) {
  double port, seconds, delay, loss;
  ear orders = {0};
  if (argc != 5 || !number(argv[1], 1, 65535, &port) || !number(argv[2], 0, 1e6, &seconds) ||
      !number(argv[3], 0, 200, &delay) || !number(argv[4], 0, 100, &loss))
    return fail("robot", "PORT SECONDS DELAY_MS LOSS_PERCENT are needed, with a delay of 200 ms at most"), 2;
  int fd = line_open(port, connect);
  if (fd < 0) return fail(argv[1], strerror(errno));
  int dead = follow(fd, &orders, seconds, 1e-3 * delay, loss);
  if (!orders.last.number) return fail("robot", "no orders came: start teleop with the same port");
  printf("robot: the gripper at %.1f mm%s, %d datagrams of nonsense\n", 1e3 * orders.last.pose[0],
         dead ? ", where it stays: no orders come" : "", orders.nonsense);
  return dead;
}
