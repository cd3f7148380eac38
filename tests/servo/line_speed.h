/* The rate of a serial line as the kernel has it, any number. */
#ifndef ETHD_TESTS_SERVO_LINE_SPEED_H
#define ETHD_TESTS_SERVO_LINE_SPEED_H

/* 0: not a line. */
unsigned line_speed(int fd);

#endif
