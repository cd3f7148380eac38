/* libethd: control of encounter-type haptic displays. Includes all headers of the library. Links from libethd. */
#ifndef ETHD_ETHD_H
#define ETHD_ETHD_H

/* The version of these headers, as text, in parts, and as one number that grows from version to version, for
   #if ETHD_VERSION_NUMBER >= 200 (0.2.0). include/README.md says what may change between versions. */
#define ETHD_VERSION "0.1.0"
#define ETHD_VERSION_MAJOR 0
#define ETHD_VERSION_MINOR 1
#define ETHD_VERSION_PATCH 0
#define ETHD_VERSION_NUMBER (10000 * ETHD_VERSION_MAJOR + 100 * ETHD_VERSION_MINOR + ETHD_VERSION_PATCH)

#include "ethd/arm.h"
#include "ethd/base.h"
#include "ethd/cap.h"
#include "ethd/cell.h"
#include "ethd/control.h"
#include "ethd/estimate.h"
#include "ethd/guard.h"
#include "ethd/law.h"
#include "ethd/maths.h"
#include "ethd/param.h"
#include "ethd/plugin.h"
#include "ethd/scene.h"
#include "ethd/sense.h"
#include "ethd/solids.h"
#include "ethd/space.h"
#include "ethd/surface.h"

#endif
