// What the files of all platforms share: the home pose, limits, the passive joints' swing; and
// which coordinates hold a frame.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "kinematics/robots/platform.h"
#include "kinematics/rotation.h"

namespace selfcal::platform {
namespace {

constexpr double kWidestSwing = 1.6;  // rad: a link cannot turn through its joint's carrier

}  // namespace

Location HomePose::pose() const { return {rpy_rotation(rpy), xyz}; }

std::optional<HomePose> read_home(Fields& robot, Problems& problems) {
  const Node* node = robot.node("home");
  if (!node) return std::nullopt;
  Fields fields(*node, "home", problems);
  HomePose home;
  home.xyz = read_centre(fields, "xyz");
  const auto rpy = fields.numbers("rpy", 3);
  home.rpy = rpy ? Eigen::Vector3d(*rpy) : Eigen::Vector3d::Zero();
  if (!(home.rpy.cwiseAbs().maxCoeff() <= kMostTurned)) fields.fail("rpy", "radians (degrees?)");
  fields.refuse_unknown();
  return home;
}

Node write_home(const HomePose& home) {
  Node node = Node::map();
  node.set("xyz", Node::of(Eigen::VectorXd(home.xyz)));
  node.set("rpy", Node::of(Eigen::VectorXd(home.rpy)));
  return node;
}

Swing read_swing(Fields& chain) {
  const auto swing = chain.numbers("swing", 2);
  if (!swing) return {};
  if (!(swing->minCoeff() > 0 && swing->maxCoeff() < kWidestSwing))
    chain.fail("swing", "two angles in radians, of the universal and of the spherical joint");
  return {(*swing)[0], (*swing)[1]};
}

Eigen::Vector3d read_centre(Fields& chain, std::string_view key) {
  const auto centre = chain.numbers(key, 3);
  if (!centre) {
    if (!chain.has(key)) chain.fail(key, "[x, y, z] in metres");
    return Eigen::Vector3d::Zero();
  }
  if (!(centre->cwiseAbs().maxCoeff() <= kLongestPart)) chain.fail(key, "metres (millimetres?)");
  return *centre;
}

std::vector<std::string> remarks(const Platform& robot) {
  const Location& home = robot.mode_.home;
  const auto tenths = [](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return (10 * v).array().round() / 10 + 0.0;  // no zero has a sign
  };
  const Eigen::Vector3d p = tenths(1e3 * home.p),
                        turn = tenths(180 / std::numbers::pi * rpy_of(home.R));
  char text[200];
  std::snprintf(text, sizeof text,
                "with all readings in the middle the platform stands at %.1f %.1f %.1f mm, turned "
                "%.1f %.1f %.1f degrees (roll pitch yaw)",
                p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z());
  std::vector<std::string> lines = {text};
  std::snprintf(text, sizeof text,
                "  it is kept on that side of the singular places (volume of the legs %.2g there)",
                std::abs(robot.mode_.volume));
  lines.emplace_back(text);
  return lines;
}

std::vector<int> frame_coordinates(const Centres& centres) {
  const Eigen::Vector3d middle = centres.rowwise().mean();
  const double size = (centres.colwise() - middle).colwise().norm().mean();
  Eigen::Matrix<double, 3 * kChains, 6> moved;  // by shifts and turns that move as far
  for (int i = 0; i < kChains; ++i)
    moved.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(),
        -skew(centres.col(i) - middle) / size;
  std::vector<int> held;
  for (int k = 0; k < 6; ++k) {
    Eigen::Index most = 0;
    moved.rowwise().norm().maxCoeff(&most);
    held.push_back(static_cast<int>(most));
    const Eigen::Matrix<double, 1, 6> along = moved.row(most).normalized();
    moved = (moved - moved * along.transpose() * along).eval();
  }
  return held;
}

Eigen::MatrixXd point_motions(const Eigen::VectorXd& xi, const std::vector<int>& at) {
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(xi.size(), 6);
  for (const int point : at)
    moves.middleRows<3>(point) << Eigen::Matrix3d::Identity(), -skew(xi.segment<3>(point));
  return moves;
}

}  // namespace selfcal::platform
