// flags: -isystem /usr/include/eigen3 $(pkg-config --cflags eigen3 2>/dev/null)
// Kalman filter on Eigen's matrices of fixed size, as a textbook has it.
#include <Eigen/Core>
#include <cmath>

#include "bench/peers.h"

#define TEXT2(x) #x
#define TEXT(x) TEXT2(x)

namespace {

using Matrix = Eigen::Matrix3d;
using Axes = Eigen::Matrix<double, 3, 2>; // x v a of both axes

struct Filter {
  double period, jerk, memory, noise;
};

Matrix way(const Filter &f, double t) {
  double z = t / f.memory / 2, av = t / (1 + z);
  Matrix m;
  m << 1, t, t * av / 2, 0, 1, av, 0, 0, (1 - z) / (1 + z);
  return m;
}

Matrix spread(const Filter &f, double t) {
  Eigen::Vector3d g(t * t * t / 6, t * t / 2, t);
  return f.jerk * f.jerk * g * g.transpose();
}

struct State {
  Axes x = Axes::Zero();
  Matrix p = Matrix::Zero();
  double age = 0;
  bool started = false;

  void start(const Filter &f, const Eigen::RowVector2d &z) {
    x.setZero();
    x.row(0) = z;
    p = Eigen::Vector3d(f.noise * f.noise, 1, 100).asDiagonal();
    started = true;
  }

  void correct(const Filter &f, const Eigen::RowVector2d &z, double t) {
    const Eigen::RowVector3d h(1, 0, 0);
    Matrix m = way(f, t);
    x = m * x;
    p = m * p * m.transpose() + spread(f, t);
    double s = h * p * h.transpose() + f.noise * f.noise;
    Eigen::Vector3d gain = p * h.transpose() / s;
    x += gain * (z - h * x);
    p = (Matrix::Identity() - gain * h) * p;
  }
};

void *create(double period, double jerk, double memory, double noise) {
  return new Filter{period, jerk, memory, noise};
}

void work(void *self, const double (*in)[3], double (*out)[2], size_t count) {
  const Filter &f = *static_cast<Filter *>(self);
  State s;
  for (size_t i = 0; i < count; i++) {
    s.age += f.period;
    if (!std::isnan(in[i][2])) {
      Eigen::RowVector2d z(in[i][0], in[i][1]);
      if (s.started)
        s.correct(f, z, s.age - in[i][2]);
      else
        s.start(f, z);
      s.age = in[i][2];
    }
    Axes now = way(f, s.age) * s.x;
    out[i][0] = now(0, 0);
    out[i][1] = now(0, 1);
  }
}

void destroy(void *self) { delete static_cast<Filter *>(self); }

} // namespace

extern "C" const ethd__peer_filter peer_filter;
extern "C" const ethd__peer_filter peer_filter = {
    "Eigen " TEXT(EIGEN_WORLD_VERSION) "." TEXT(EIGEN_MAJOR_VERSION) "." TEXT(EIGEN_MINOR_VERSION), create, work,
    destroy};
