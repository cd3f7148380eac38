// flags: -Wno-uninitialized
// Boost odeint's adaptive Runge-Kutta methods, started anew at each change.
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/version.hpp>

#include "bench/ode.h"

namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, ETHD__ODE_SIZE>;

template <class Stepper> struct Solver {
  ethd__ode ode;
  odeint::controlled_runge_kutta<Stepper> controlled;
  Stepper plain;
  double h = 1e-4;
  Solver(const ethd__ode &o, double tolerance)
      : ode(o), controlled(typename odeint::controlled_runge_kutta<Stepper>::error_checker_type(tolerance, 0)) {}

  void work(double t, double end, double *out) {
    auto rate = [this](const State &y, State &dydt, double at) { ode.rate(ode.self, at, y.data(), dydt.data()); };
    State y;
    std::copy(out, out + y.size(), y.begin());
    reset(controlled);
    while (t < end) {
      State before = y;
      double begin = t, step = std::min(h, end - t), g[2], g0[2];
      bool whole = step == end - t, cut = step < h;
      auto result = controlled.try_step(rate, y, t, step);
      if (!cut || step < h) h = step;
      if (result == odeint::fail) continue;
      if (whole) t = end;
      ode.watch(ode.self, t, y.data(), g);
      int which = ethd__ode_changed(g);
      if (which < 0) continue;
      ode.watch(ode.self, begin, before.data(), g0);
      struct Trial {
        Solver *s;
        decltype(rate) *f;
        State from, to;
        double t;
        int which;
      } trial{this, &rate, before, before, begin, which};
      auto try_step = [](void *self, double s) {
        Trial &p = *static_cast<Trial *>(self);
        double g_now[2];
        p.to = p.from;
        reset(p.s->plain);
        p.s->plain.do_step(*p.f, p.to, p.t, s);
        p.s->ode.watch(p.s->ode.self, p.t + s, p.to.data(), g_now);
        return g_now[p.which];
      };
      double s = ethd__ode_locate(try_step, &trial, g0[which], t - begin, g[which]);
      try_step(&trial, s);
      y = trial.to;
      t = begin + s;
      ode.change(ode.self, which);
      reset(controlled);
    }
    std::copy(y.begin(), y.end(), out);
  }

  /* What keeps the last step's rates must forget them. */
  template <class T> static auto forget(T &stepper, int) -> decltype(stepper.reset(), void()) { stepper.reset(); }
  template <class T> static void forget(T &, long) {}
  template <class T> static void reset(T &stepper) { forget(stepper, 0); }
};

using Dopri5 = Solver<odeint::runge_kutta_dopri5<State>>;
using Fehlberg78 = Solver<odeint::runge_kutta_fehlberg78<State>>;

template <class S> void *create(const ethd__ode *ode, double tolerance) { return new S(*ode, tolerance); }
template <class S> void work(void *self, double t, double end, double *y) { static_cast<S *>(self)->work(t, end, y); }
template <class S> void destroy(void *self) { delete static_cast<S *>(self); }

} // namespace

#define NAME "odeint " BOOST_LIB_VERSION
extern "C" const ethd__peer_ode peer_ode[];
extern "C" const ethd__peer_ode peer_ode[] = {
    {NAME " dopri5", 1e-4, 1e-12, 10, 0, create<Dopri5>, work<Dopri5>, destroy<Dopri5>},
    {NAME " fehlberg78", 1e-4, 1e-12, 10, 0, create<Fehlberg78>, work<Fehlberg78>, destroy<Fehlberg78>},
    {},
};
