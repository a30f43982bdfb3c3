#include "tests/bench/kdl_arm.h"

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <memory>

namespace selfcal::bench {
namespace {

KDL::Chain chain_of(const Arm& arm, const Eigen::VectorXd& xi) {
  KDL::Chain chain;
  for (const ArmFrame& each : arm.frames) {
    const KDL::Frame before = KDL::Frame(KDL::Rotation::RotY(xi[each.beta])) *
                              KDL::Frame(KDL::Rotation::RotX(xi[each.alpha])) *
                              KDL::Frame(KDL::Vector(xi[each.d], 0, 0));
    const KDL::Frame after(KDL::Rotation::RotZ(xi[each.theta]), KDL::Vector(0, 0, xi[each.r]));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), before));
    chain.addSegment(
        KDL::Segment(KDL::Joint(each.joint < 0 ? KDL::Joint::None : KDL::Joint::RotZ), after));
  }
  return chain;
}

/// KDL's solvers refer to their chain.
struct KdlArm {
  explicit KdlArm(const KDL::Chain& of) : chain(of) {}
  KdlArm(const KdlArm&) = delete;
  KdlArm& operator=(const KdlArm&) = delete;

  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive forward{chain};
  KDL::ChainJntToJacSolver derivatives{chain};
  KDL::JntArray q;
  KDL::Jacobian J;
};

}  // namespace

std::function<double()> kdl_row(const Task& task) {
  const Eigen::VectorXd q = task.data.rows.q.row(0).transpose();
  const auto made = std::make_shared<KdlArm>(chain_of(Arm(example_robot()), task.xi));
  made->q.data = q;
  made->J.resize(static_cast<unsigned>(q.size()));
  return [made] {
    KDL::Frame X;
    made->forward.JntToCart(made->q, X);
    made->derivatives.JntToJac(made->q, made->J);
    return X.p.x() + made->J.data(0, 0);
  };
}

}  // namespace selfcal::bench
