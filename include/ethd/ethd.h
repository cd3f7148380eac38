/* libethd: control of encounter-type haptic displays. Everything the library offers. Links from libethd. */
#ifndef ETHD_ETHD_H
#define ETHD_ETHD_H

#define ETHD_VERSION "0.1.0"

#include "ethd/arm.h"
#include "ethd/attributes.h"
#include "ethd/cell.h"
#include "ethd/control.h"
#include "ethd/finger_filter.h"
#include "ethd/finger_fit.h"
#include "ethd/guard.h"
#include "ethd/law.h"
#include "ethd/maths.h"
#include "ethd/param.h"
#include "ethd/plugin.h"
#include "ethd/scene.h"
#include "ethd/sense.h"
#include "ethd/status.h"
#include "ethd/vec.h"
#include "ethd/velocity.h"

#endif
