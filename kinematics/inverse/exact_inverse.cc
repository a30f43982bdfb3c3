#include "kinematics/inverse/exact_inverse.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "kinematics/inverse/screw_chain.h"
#include "kinematics/inverse/trigonometric_roots.h"
#include "kinematics/robots/linear_delta.h"
#include "kinematics/robots/platform.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kMeets = 1e-8;    // of the robot's size, of axes that meet; rad, of parallel ones
constexpr double kNowhere = 1e-9;  // of the same, of a point on the axis that is to turn it
constexpr double kMostOff = 1e-6;  // of the same; rad, of a solution that is one

using Variables = Eigen::Matrix<double, 6, 1>;

/// The turn about the unit `axis` that brings `from` to `to` as far as one can; nothing where they
/// lie nearer to it than `nowhere`.
std::optional<double> turn_between(const Eigen::Vector3d& axis, const Eigen::Vector3d& from,
                                   const Eigen::Vector3d& to, double nowhere = kNowhere) {
  const Eigen::Vector3d a = from - axis.dot(from) * axis, b = to - axis.dot(to) * axis;
  if (a.norm() < nowhere || b.norm() < nowhere) return std::nullopt;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

/// The point with the least sum of squared distances from the lines of the screws.
Eigen::Vector3d nearest_to(const Screw* begin, const Screw* end) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Screw* each = begin; each != end; ++each) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - each->axis * each->axis.transpose();
    A += across;
    b += across * each->point;
  }
  return A.ldlt().solve(b);
}

double distance_from(const Screw& screw, const Eigen::Vector3d& p) {
  return screw.axis.cross(p - screw.point).norm();
}

bool are_parallel(const Screw& a, const Screw& b) { return a.axis.cross(b.axis).norm() < kMeets; }

/// Six revolute joints of a robot of a size (m). `near` are variables as those of the chain.
class SixTurns {
 public:
  SixTurns(ScrewChain chain, std::vector<Joint> joints, double size)
      : chain_(std::move(chain)), joints_(std::move(joints)), size_(size) {
    const auto& s = chain_.screw;
    if (!are_parallel(s[3], s[4]) && !are_parallel(s[4], s[5])) {
      centre_ = nearest_to(&s[3], &s[3] + 3);
      wrist_meets_ = true;
      for (int j = 3; j < 6; ++j)
        wrist_meets_ = wrist_meets_ && distance_from(s[j], centre_) < kMeets * size_;
    }
    middle_parallel_ = are_parallel(s[1], s[2]) && are_parallel(s[2], s[3]) &&
                       !are_parallel(s[3], s[4]) && !are_parallel(s[4], s[5]);
  }

  bool solvable() const { return wrist_meets_ || middle_parallel_; }

  std::vector<Eigen::VectorXd> solve(const Location& wanted, const Eigen::VectorXd& near) const {
    std::vector<Eigen::VectorXd> list;
    Variables t_near;
    for (int j = 0; j < 6; ++j) t_near[j] = chain_.screw[j].gear * near[j];
    const Location moved = wanted * inverse_of(chain_.zero);
    for (const Variables& t : wrist_meets_ ? by_wrist(moved, t_near) : by_plane(moved, t_near)) {
      const Location is = chain_.at(t.data());
      if ((is.p - wanted.p).norm() > kMostOff * size_ || (is.R - wanted.R).norm() > kMostOff)
        continue;
      Eigen::VectorXd q(6);
      for (int j = 0; j < 6; ++j) q[j] = nearest_turn(j, t[j] / gear(j), near[j]);
      list.push_back(q);
    }
    return list;
  }

 private:
  double gear(int j) const { return chain_.screw[j].gear; }
  const Screw& screw(int j) const { return chain_.screw[j]; }

  /// Of `q` and whole turns of joint `j` from it.
  double nearest_turn(int j, double q, double near) const {
    const double turn = 2 * std::numbers::pi / gear(j);
    const double nearest = near + std::remainder(q - near, turn);
    const Joint& joint = joints_[static_cast<std::size_t>(j)];
    double best = nearest;
    for (const double each : {nearest + turn, nearest - turn})
      if (!joint.allows(best) && joint.allows(each)) best = each;
    return best;
  }

  /// `moved` is T_1 … T_6.
  std::vector<Variables> by_wrist(const Location& moved, const Variables& near) const {
    std::vector<Variables> list;
    const Eigen::Vector3d foot = screw(0).point, up = screw(0).axis, goal = moved * centre_ - foot;
    const auto arm = [&](double third, double second) -> Eigen::Vector3d {
      return moved_by(screw(1), second) * (moved_by(screw(2), third) * centre_) - foot;
    };
    const auto pairs =
        common_roots(coefficients([&](double a, double b) {
                       return arm(a, b).squaredNorm() - goal.squaredNorm();
                     }),
                     coefficients([&](double a, double b) { return up.dot(arm(a, b) - goal); }));
    for (const Eigen::Vector2d& pair : pairs) {
      Variables t = near;
      t[2] = pair[0];
      t[1] = pair[1];
      t[0] = turn_between(up, arm(t[2], t[1]), goal, kNowhere * size_).value_or(near[0]);
      const Eigen::Matrix3d before =
          moved_by(screw(0), t[0]).R * moved_by(screw(1), t[1]).R * moved_by(screw(2), t[2]).R;
      add_wrists(before.transpose() * moved.R, near, t, list);
    }
    return list;
  }

  /// The last three joints for the turn R = R_4 R_5 R_6; the others are those of `t`.
  void add_wrists(const Eigen::Matrix3d& R, const Variables& near, Variables t,
                  std::vector<Variables>& list) const {
    const Eigen::Vector3d &n4 = screw(3).axis, &n5 = screw(4).axis, &n6 = screw(5).axis;
    const Eigen::Vector3d along = n5.dot(n6) * n5, across = n6 - along;
    const Eigen::Vector3d c(n4.dot(along) - n4.dot(R * n6), n4.dot(across), n4.dot(n5.cross(n6)));
    for (const double fifth : roots_of(c)) {
      t[4] = fifth;
      const Eigen::Matrix3d R5 = moved_by(screw(4), fifth).R;
      t[3] = turn_between(n4, R5 * n6, R * n6).value_or(near[3]);
      const Eigen::Matrix3d last = R5.transpose() * moved_by(screw(3), t[3]).R.transpose() * R;
      t[5] = turn_between(n6, n5, last * n5).value_or(near[5]);
      list.push_back(t);
    }
  }

  std::vector<Variables> by_plane(const Location& moved, const Variables& near) const {
    std::vector<Variables> list;
    const Eigen::Vector3d& h = screw(1).axis;
    // Of axis 6 the point nearest to axis 5.
    const Screw ends[] = {screw(4), screw(5)};
    const Eigen::Vector3d between = nearest_to(ends, ends + 2);
    const Eigen::Vector3d& n6 = screw(5).axis;
    const Eigen::Vector3d p6 = screw(5).point + n6.dot(between - screw(5).point) * n6;
    const auto height = [&](double first, double fifth) {
      return h.dot(inverse_of(moved_by(screw(0), first)) * (moved * p6) -
                   moved_by(screw(4), fifth) * p6);
    };
    const auto lean = [&](double first, double fifth) {
      return h.dot(moved_by(screw(0), first).R.transpose() * (moved.R * n6) -
                   moved_by(screw(4), fifth).R * n6);
    };
    for (const Eigen::Vector2d& pair : common_roots(coefficients(height), coefficients(lean))) {
      Variables t = near;
      t[0] = pair[0];
      t[4] = pair[1];
      const Location T1 = moved_by(screw(0), t[0]), T5 = moved_by(screw(4), t[4]);
      const Eigen::Vector3d seen = moved.R.transpose() * (T1.R * h);
      t[5] = turn_between(n6, seen, T5.R.transpose() * h).value_or(near[5]);
      const Location planar =
          inverse_of(T1) * moved * inverse_of(moved_by(screw(5), t[5])) * inverse_of(T5);
      add_planar(planar, t, list);
    }
    return list;
  }

  /// Joints 2 to 4 for the motion T_2 T_3 T_4 across their axes.
  void add_planar(const Location& planar, Variables t, std::vector<Variables>& list) const {
    const Eigen::Vector3d& h = screw(1).axis;
    const Eigen::Vector3d foot = screw(1).point, c4 = screw(3).point;
    const auto flat = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d { return v - h.dot(v) * h; };
    const Eigen::Vector3d goal = flat(planar * c4 - foot);
    const Eigen::Vector3d knee = flat(screw(2).point - foot), shin = flat(c4 - screw(2).point);
    const Eigen::Vector3d& n3 = screw(2).axis;
    const Eigen::Vector3d c(knee.squaredNorm() + shin.squaredNorm() - goal.squaredNorm(),
                            2 * knee.dot(shin), 2 * knee.dot(n3.cross(shin)));
    Eigen::Vector3d side = flat(screw(1).axis.unitOrthogonal());
    const double turn = turn_between(h, side, planar.R * side).value_or(0);
    for (const double third : roots_of(c)) {
      t[2] = third;
      const Eigen::Vector3d leg = knee + moved_by(screw(2), third).R * shin;
      t[1] = turn_between(h, leg, goal, kNowhere * size_).value_or(0);
      t[3] = h.dot(screw(3).axis) * (turn - t[1] - h.dot(n3) * third);
      list.push_back(t);
    }
  }

  ScrewChain chain_;
  std::vector<Joint> joints_;
  double size_;
  bool wrist_meets_ = false, middle_parallel_ = false;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
};

}  // namespace

ExactInverse exact_inverse(std::shared_ptr<const Robot> robot, const Eigen::VectorXd& xi) {
  if (const auto* platform = dynamic_cast<const platform::Platform*>(robot.get()))
    return [robot, platform, xi](const Location& wanted, const Eigen::VectorXd&) {
      const std::optional<platform::Six> q = platform->readings_at(xi, wanted);
      return q ? std::vector<Eigen::VectorXd>{*q} : std::vector<Eigen::VectorXd>{};
    };
  if (robot->kind() == "linear-delta" && xi.size() == linear_delta::kParameters)
    return [xi](const Location& wanted, const Eigen::VectorXd&) {
      const Eigen::Matrix3d R = exp_rotation(linear_delta::tilt_of(xi, linear_delta::kEffector));
      const auto q =
          linear_delta::readings_at(xi, wanted.p - R * xi.segment<3>(linear_delta::kTool));
      return q ? std::vector<Eigen::VectorXd>{*q} : std::vector<Eigen::VectorXd>{};
    };
  const bool six_turns =
      robot->joints().size() == 6 && std::ranges::all_of(robot->joints(), [](const Joint& each) {
        return each.quantity == Quantity::angle;
      });
  if (!six_turns) return {};
  const std::optional<ScrewChain> chain = screw_chain(*robot, xi);
  if (!chain) return {};
  const SixTurns arm(*chain, robot->joints(), size_of(*robot));
  if (!arm.solvable()) return {};
  return [arm](const Location& wanted, const Eigen::VectorXd& near) {
    return arm.solve(wanted, near);
  };
}

}  // namespace selfcal
