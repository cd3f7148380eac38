/* A shared object that defines another symbol. */
#define TABLE some_driver
#include "driver_broken.h"
