/* Its brief has 201 characters. */
#define TEN "0123456789"
#define HUNDRED TEN TEN TEN TEN TEN TEN TEN TEN TEN TEN
#define BRIEF HUNDRED HUNDRED "1"
#include "broken.h"
