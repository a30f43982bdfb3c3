// What every kind of robot keeps to, walking robots.def: a kind that is listed is tested at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "kinematics/corrected_robot.h"
#include "kinematics/make_robot.h"
#include "kinematics/rotation.h"
#include "kinematics/statics.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

constexpr double kKindStep = 1e-6;
// What is cut off is step^2 / 6 of the third derivative: of a delta, where a rod l stands 3 across
// 1 high, 900 / l^2 a rod, 2e4 / m^2, ten times that for the three together: 3e-8. Rounding leaves
// 1e-16 m / step, times 3: 3e-10.
constexpr double kKindTolerance = 1e-7;

std::vector<std::string> kinds() {
  const std::vector<std::string_view> all = robot_kinds();
  return {all.begin(), all.end()};
}

class RobotKind : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto found = kind_examples().find(GetParam());
    ASSERT_NE(found, kind_examples().end()) << "give an example of it in kind_examples.h";
    robot_ = robot_of(found->second + kind_masses().at(GetParam()));
    ASSERT_TRUE(robot_);
    block_ = drawn(1);
    xi_ = values(*robot_);
  }

  /// A block of configurations that the robot draws of itself.
  ConfigurationBlock drawn(unsigned seed) const {
    std::mt19937_64 random(seed);
    const auto n = static_cast<Eigen::Index>(robot_->joints().size());
    Eigen::MatrixX2d span(n, 2);
    for (Eigen::Index j = 0; j < n; ++j)
      span.row(j) << robot_->joints()[j].lower, robot_->joints()[j].upper;
    ConfigurationBlock block{Eigen::ArrayXXd(kLanes, n), kLanes};
    const auto uniform = [&] { return std::generate_canonical<double, 53>(random); };
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = robot_->draw(span, uniform).transpose().array();
    return block;
  }

  Locations located(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body) const {
    Locations X;
    EXPECT_TRUE(robot_->locate(block, xi, body, X, nullptr).closes());
    return X;
  }

  std::unique_ptr<Robot> robot_;
  ConfigurationBlock block_;
  Eigen::VectorXd xi_;
};

/// (dx dy dz, rotation vector) per unit from `minus` to `plus`, laid out as a column of Psi.
Eigen::VectorXd kind_difference(const Locations& plus, const Locations& minus) {
  Eigen::VectorXd column(6 * kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Vector3d shift = plus.p(lane) - minus.p(lane);
    const Eigen::Vector3d turn = log_rotation(plus.R(lane) * minus.R(lane).transpose());
    for (int c = 0; c < 3; ++c) {
      column[c * kLanes + lane] = shift[c] / (2 * kKindStep);
      column[(3 + c) * kLanes + lane] = turn[c] / (2 * kKindStep);
    }
  }
  return column;
}

TEST_P(RobotKind, DrawsConfigurationsWithinItsLimitsAtWhichItsLoopsClose) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const ConfigurationBlock block = drawn(seed);
    Locations X;
    EXPECT_TRUE(robot_->locate(block, xi_, Body::endpoint, X, nullptr).closes());
    for (int lane = 0; lane < kLanes; ++lane)
      EXPECT_TRUE(within_limits(*robot_, block.q.row(lane).matrix().transpose()));
  }
}

TEST_P(RobotKind, HasForEveryParameterTheColumnThatDifferencesGive) {
  for (const auto& [name, body] : named_bodies(*robot_)) {
    Locations X;
    PsiBlock psi;
    robot_->locate(block_, xi_, body, X, &psi);
    ASSERT_EQ(psi.rows(), 6 * kLanes);
    ASSERT_EQ(psi.cols(), xi_.size());
    for (Eigen::Index p = 0; p < xi_.size(); ++p) {
      Eigen::VectorXd plus = xi_, minus = xi_;
      plus[p] += kKindStep;
      minus[p] -= kKindStep;
      const Eigen::VectorXd column =
          kind_difference(located(block_, plus, body), located(block_, minus, body));
      EXPECT_LT((psi.col(p) - column).cwiseAbs().maxCoeff(), kKindTolerance)
          << robot_->parameters()[p].name << " of " << name;
    }
  }
}

TEST_P(RobotKind, HasForEveryReadingTheColumnThatDifferencesGive) {
  for (const auto& [name, body] : named_bodies(*robot_)) {
    Locations X;
    PsiBlock psi;
    Eigen::MatrixXd J;
    robot_->locate(block_, xi_, body, X, &psi);
    robot_->joint_jacobian(block_, xi_, body, psi, J);
    ASSERT_EQ(J.cols(), block_.q.cols());
    for (Eigen::Index j = 0; j < J.cols(); ++j) {
      ConfigurationBlock plus = block_, minus = block_;
      plus.q.col(j) += kKindStep;
      minus.q.col(j) -= kKindStep;
      const Eigen::VectorXd column =
          kind_difference(located(plus, xi_, body), located(minus, xi_, body));
      EXPECT_LT((J.col(j) - column).cwiseAbs().maxCoeff(), kKindTolerance)
          << robot_->joints()[j].name << " of " << name;
    }
  }
}

TEST_P(RobotKind, SaysHowItsVariablesFollowItsReadings) {
  for (const auto& [name, body] : named_bodies(*robot_)) {
    Locations X;
    PsiBlock psi;
    Eigen::MatrixXd J, by_variable(6 * kLanes, block_.q.cols());
    robot_->locate(block_, xi_, body, X, &psi);
    robot_->joint_jacobian(block_, xi_, body, psi, J);
    for (int j = 0; j < static_cast<int>(J.cols()); ++j)
      by_variable.col(j) = psi * robot_->variable_change(xi_, j);
    EXPECT_LT((by_variable * robot_->variables_per_reading(xi_) - J).cwiseAbs().maxCoeff(), 1e-12)
        << name;
  }
}

TEST_P(RobotKind, FindsEveryBodyByItsName) {
  std::set<std::string> names;
  for (const auto& [name, body] : named_bodies(*robot_)) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(find_body(*robot_, name), body) << name;
    EXPECT_TRUE(has_body(*robot_, body)) << name;
  }
  EXPECT_GE(names.size(), 6u);  // every kind has some beside endpoint, last and first link
  EXPECT_EQ(find_body(*robot_, "nowhere"), std::nullopt);
}

TEST_P(RobotKind, MovesAPointOfABodyWithIt) {
  const Eigen::Vector3d at(0.1, -0.2, 0.3);
  for (const auto& [name, body] : named_bodies(*robot_)) {
    const auto place = [&](const Eigen::VectorXd& xi, PsiBlock* psi) {
      Locations X;
      EXPECT_TRUE(locate_point(*robot_, block_, xi, body, at, X, psi).closes());
      return X;
    };
    PsiBlock psi;
    const Locations origin = located(block_, xi_, body), there = place(xi_, &psi);
    for (int lane = 0; lane < kLanes; ++lane)
      EXPECT_LT((origin.p(lane) + origin.R(lane) * at - there.p(lane)).norm(), 1e-14) << name;
    for (Eigen::Index p = 0; p < xi_.size(); ++p) {
      Eigen::VectorXd plus = xi_, minus = xi_;
      plus[p] += kKindStep;
      minus[p] -= kKindStep;
      const Eigen::VectorXd column = kind_difference(place(plus, nullptr), place(minus, nullptr));
      EXPECT_LT((psi.col(p) - column).cwiseAbs().maxCoeff(), kKindTolerance)
          << robot_->parameters()[p].name << " of " << name;
    }
  }
}

/// Height that what weighs has lost, times its weight (N m), by lane.
Eigen::VectorXd work_done(const Robot& robot, const ConfigurationBlock& block,
                          const Eigen::VectorXd& xi) {
  Eigen::VectorXd work = Eigen::VectorXd::Zero(kLanes);
  for (const PointMass& each : robot.masses()->points) {
    Locations X;
    locate_point(robot, block, xi, each.body, each.at, X, nullptr);
    for (int lane = 0; lane < kLanes; ++lane)
      work[lane] += each.mass * robot.masses()->gravity.dot(X.p(lane));
  }
  return work;
}

TEST_P(RobotKind, LoadsItsJointsByAllThatItsFileSaysWeighs) {
  ASSERT_TRUE(weighs(*robot_));
  const Eigen::MatrixXd work = work_of_weights(*robot_, block_, xi_);
  for (size_t j = 0; j < robot_->joints().size(); ++j) {
    ConfigurationBlock plus = block_, minus = block_;
    plus.added.setZero(kLanes, block_.q.cols());
    minus.added.setZero(kLanes, block_.q.cols());
    plus.added.col(static_cast<Eigen::Index>(j)) += kKindStep;
    minus.added.col(static_cast<Eigen::Index>(j)) -= kKindStep;
    const Eigen::VectorXd by_difference =
        (work_done(*robot_, plus, xi_) - work_done(*robot_, minus, xi_)) / (2 * kKindStep);
    const Eigen::VectorXd torque = work * robot_->variable_change(xi_, static_cast<int>(j));
    EXPECT_GT(torque.cwiseAbs().maxCoeff(), 0.1) << robot_->joints()[j].name;  // N, N m
    // The tolerance of Psi, times the weight of some 30 kg.
    EXPECT_LT((torque - by_difference).cwiseAbs().maxCoeff(), 300 * kKindTolerance)
        << robot_->joints()[j].name;
    if (!robot_->statics()) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::VectorXd q = block_.q.row(lane).matrix().transpose();
      EXPECT_NEAR(torque[lane],
                  joint_torque(robot_->statics()->mechanics(), robot_->statics()->link_poses(q), {},
                               static_cast<int>(j)),
                  1e-12 * work.cwiseAbs().maxCoeff());
    }
  }
}

TEST_P(RobotKind, ClosesItsLoopsFromAGivenStart) {
  const Locations there = located(block_, xi_, Body::last_link);
  ConfigurationBlock given = block_;
  given.start = there.at(0);
  given.start->p.z() -= 1e-3;
  const Locations again = located(given, xi_, Body::last_link);
  // Newton's steps end at 1e-13 of a chain of a metre, of legs that stand steeply.
  EXPECT_LT((again.position - there.position).abs().maxCoeff(), 1e-11);
}

TEST_P(RobotKind, LeavesItsLoopsOpenFromAStartOfAnotherAssemblyMode) {
  if (!robot_->has_loops()) return;
  ConfigurationBlock given = block_;
  given.start = located(block_, xi_, Body::last_link).at(0);
  // The other side of the carriages, or of the base.
  given.start->p.z() += 2;
  if (given.start->p.z() > 1.5 && robot_->home() && robot_->home()->p.z() > 0)
    given.start->p.z() = -given.start->p.z() + 1;
  Problems problems;
  const std::shared_ptr<const Robot> robot = std::move(robot_);
  const auto corrected = correct(robot,
                                 {parsed("{effect: zero_shift, at: " + robot->joints()[0].name +
                                         ", moment: 1, step: 1.0e-4}")},
                                 {}, problems);
  for (const Robot* each : {robot.get(), static_cast<const Robot*>(corrected.get())}) {
    Locations X;
    const Closure closure = each->locate(given, values(*each), Body::endpoint, X, nullptr);
    EXPECT_EQ(closure.open, ~0U);
    EXPECT_THAT(closure.why.front(), testing::HasSubstr("the start is of another assembly mode"));
  }
}

TEST_P(RobotKind, MovesAJointsVariableAsTheParameterThatIsItsZero) {
  for (size_t j = 0; j < robot_->joints().size(); ++j) {
    constexpr double kMove = 1e-3;
    ConfigurationBlock added = block_;
    added.added.setZero(kLanes, block_.q.cols());
    added.added.col(static_cast<Eigen::Index>(j)) = kMove;
    Eigen::VectorXd xi = xi_;
    xi += kMove * robot_->variable_change(xi_, static_cast<int>(j));
    const Locations a = located(added, xi_, Body::endpoint),
                    b = located(block_, xi, Body::endpoint);
    EXPECT_LT((a.position - b.position).abs().maxCoeff(), 1e-13);  // rounding
    EXPECT_LT((a.rotation - b.rotation).abs().maxCoeff(), 1e-13);
  }
}

TEST_P(RobotKind, PrefersEveryParameterExactlyOnce) {
  std::vector<int> order = robot_->preference();
  std::sort(order.begin(), order.end());
  std::vector<int> all(robot_->parameters().size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST_P(RobotKind, GivesEveryParameterANameOfItsOwnAndATolerance) {
  for (size_t i = 0; i < robot_->parameters().size(); ++i) {
    const Parameter& p = robot_->parameters()[i];
    EXPECT_EQ(find_parameter(*robot_, p.name), static_cast<int>(i)) << p.name;
    EXPECT_EQ(find_parameter(*robot_, p.frame + "." + p.field), static_cast<int>(i)) << p.name;
    EXPECT_GT(p.tolerance, 0) << p.name;
  }
}

TEST_P(RobotKind, ComesBackFromItsFileAsTheSameMachineWithOtherValues) {
  Eigen::VectorXd xi = xi_;
  for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] += 1e-4 * (1 + static_cast<double>(i % 3));
  const auto back = robot_of(robot_->text().describe(xi));
  ASSERT_TRUE(back);
  EXPECT_TRUE(values(*back) == xi);  // shortest text that reads back as the same number
  EXPECT_TRUE(nominal_values(*back) == nominal_values(*robot_));
  EXPECT_EQ(back->text().identity(), robot_->text().identity());
  EXPECT_EQ(back->kind(), robot_->kind());
  EXPECT_EQ(back->name(), robot_->name());
  for (size_t i = 0; i < robot_->parameters().size(); ++i) {
    EXPECT_EQ(back->parameters()[i].name, robot_->parameters()[i].name);
    EXPECT_EQ(back->parameters()[i].tolerance, robot_->parameters()[i].tolerance);
    EXPECT_EQ(back->parameters()[i].free, robot_->parameters()[i].free);
  }
  for (size_t j = 0; j < robot_->joints().size(); ++j) {
    EXPECT_EQ(back->joints()[j].lower, robot_->joints()[j].lower);
    EXPECT_EQ(back->joints()[j].upper, robot_->joints()[j].upper);
  }
}

TEST_P(RobotKind, IsAnotherMachineWithAnotherMakersFigure) {
  const Node node = robot_->text().describe(xi_);
  for (const char* key : {"frames", "towers", "legs", "chains"}) {
    const Node* list = node.find(key);
    if (!list) continue;
    Node other = node;
    for (size_t k = 0; k < node.keys.size(); ++k)
      if (node.keys[k] == key)
        for (size_t f = 0; f < list->items[1].keys.size(); ++f)
          if (const std::string& name = list->items[1].keys[f];
              name == "r" || name == "rod" || name == "offset" || name == "length")
            other.items[k].items[1].items[f] =
                Node::of(*parse_number(list->items[1].items[f].text) + 1e-3);
    EXPECT_NE(robot_of(other)->text().identity(), robot_->text().identity());
  }
}

TEST_P(RobotKind, HasEveryEffectOrSaysWhyNot) {
  const std::string joint = robot_->joints().front().name;
  for (const char* effect : {"joint_compliance", "link_compliance", "transmission_error"}) {
    Node entry = Node::map();
    entry.set("effect", Node::of(std::string(effect))).set("at", Node::of(joint));
    if (std::string(effect) == "transmission_error")
      entry.set("waves", Node::of(std::vector<double>{1}));
    Problems problems;
    const auto made = make_effect(entry, *robot_, {}, problems);
    const bool asks_for_links = std::string(effect) == "link_compliance";
    EXPECT_EQ(made != nullptr, robot_->statics() || !asks_for_links) << effect;
    Problems of_weightless;
    const auto weightless = robot_of(kind_examples().at(GetParam()));
    EXPECT_EQ(make_effect(entry, *weightless, {}, of_weightless) != nullptr,
              robot_->statics() || std::string(effect) == "transmission_error")
        << effect;
    if (!made) {
      EXPECT_THAT(problems.list.front(), testing::HasSubstr(std::string(kNoStatics)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RobotKind, testing::ValuesIn(kinds()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace selfcal
