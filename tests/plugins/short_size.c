/* A law struct that ends before its step. */
#define SIZE ((uint32_t)(ETHD_TRANSITION_LAW_MIN - 1))
#include "broken.h"
