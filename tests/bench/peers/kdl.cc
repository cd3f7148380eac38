// flags: -isystem /usr/include/eigen3 $(pkg-config --cflags --libs orocos-kdl 2>/dev/null || echo -lorocos-kdl)
// Orocos KDL: its recursive solvers for pose and Jacobian; J^T f and the 2x2 inverse on Eigen's blocks.
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/config.h>

#include <Eigen/LU>

#include "bench/peers.h"

namespace {

KDL::Chain make_chain(double link1, double link2) {
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame(KDL::Vector(link1, 0, 0))));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame(KDL::Vector(link2, 0, 0))));
  return chain;
}

struct Arm {
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive pose;
  KDL::ChainJntToJacSolver jacobian;
  KDL::JntArray q{2};
  KDL::Jacobian j{2};
  KDL::Frame frame;
  Arm(double link1, double link2) : chain(make_chain(link1, link2)), pose(chain), jacobian(chain) {}
};

void *create(double link1, double link2) { return new Arm(link1, link2); }

void work(void *self, const double (*in)[6], double (*out)[6], size_t count) {
  Arm &arm = *static_cast<Arm *>(self);
  for (size_t i = 0; i < count; i++) {
    arm.q(0) = in[i][0];
    arm.q(1) = in[i][1];
    arm.pose.JntToCart(arm.q, arm.frame);
    arm.jacobian.JntToJac(arm.q, arm.j);
    Eigen::Matrix2d j = arm.j.data.topLeftCorner<2, 2>();
    Eigen::Map<Eigen::Vector2d>(out[i] + 2) = j.transpose() * Eigen::Map<const Eigen::Vector2d>(in[i] + 2);
    Eigen::Map<Eigen::Vector2d>(out[i] + 4) = j.inverse() * Eigen::Map<const Eigen::Vector2d>(in[i] + 4);
    out[i][0] = arm.frame.p.x();
    out[i][1] = arm.frame.p.y();
  }
}

void destroy(void *self) { delete static_cast<Arm *>(self); }

/* ---- an arm in space ---- */

struct Linkage {
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive pose;
  KDL::ChainJntToJacSolver jacobian;
  KDL::JntArray q{ETHD__PEER_JOINTS};
  KDL::Jacobian j{ETHD__PEER_JOINTS};
  KDL::Frame frame;
  explicit Linkage(const KDL::Chain &of) : chain(of), pose(chain), jacobian(chain) {}
};

void *create_linkage(const double (*rows)[4]) {
  KDL::Chain chain;
  for (int i = 0; i < ETHD__PEER_JOINTS; i++)
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(rows[i][0], rows[i][1], rows[i][2], rows[i][3])));
  return new Linkage(chain);
}

void work_linkage(void *self, const double (*in)[ETHD__PEER_JOINTS], double (*out)[ETHD__PEER_LINKAGE], size_t count) {
  Linkage &arm = *static_cast<Linkage *>(self);
  for (size_t i = 0; i < count; i++) {
    arm.q.data = Eigen::Map<const Eigen::Matrix<double, ETHD__PEER_JOINTS, 1>>(in[i]);
    arm.pose.JntToCart(arm.q, arm.frame);
    arm.jacobian.JntToJac(arm.q, arm.j);
    for (int k = 0; k < 3; k++) out[i][k] = arm.frame.p(k);
    Eigen::Map<Eigen::Matrix<double, 6, ETHD__PEER_JOINTS>>(out[i] + 3) = arm.j.data;
  }
}

void destroy_linkage(void *self) { delete static_cast<Linkage *>(self); }

} // namespace

extern "C" const ethd__peer_linkage peer_linkage;
extern "C" const ethd__peer_linkage peer_linkage = {"KDL " KDL_VERSION_STRING, create_linkage, work_linkage,
                                                    destroy_linkage};
extern "C" const ethd__peer_kinematics peer_kinematics;
extern "C" const ethd__peer_kinematics peer_kinematics = {"KDL " KDL_VERSION_STRING, create, work, destroy};
