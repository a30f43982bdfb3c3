// Rows that nobody called repeats: which are taken for them, and what is said.
#include "constraints/methods/repeats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

/// A joint that turns and one that slides through 0.4 m.
class UnnamedRepeats : public testing::Test {
 protected:
  /// Rows far from each other, but for those at `q` below them.
  DataSet rows(const Eigen::MatrixX2d& q, const std::string& method = "position") const {
    Problems problems;
    Node entry = Node::map();
    entry.set("method", Node::of(method));
    DataSet data;
    data.sets = {make_set("tracker", entry, problems), make_set("other", entry, problems)};
    EXPECT_FALSE(problems.any());
    const auto count = static_cast<std::size_t>(q.rows());
    data.rows.q = q;
    data.rows.set.assign(count, 0);
    data.rows.group.assign(count, -1);
    data.rows.check.assign(count, 0);
    return data;
  }

  /// Twelve configurations, each visited again after all others `apart` from where it was.
  static Eigen::MatrixX2d twice(const Eigen::RowVector2d& apart) {
    Eigen::MatrixX2d q(24, 2);
    for (int i = 0; i < 12; ++i) {
      q.row(i) << 0.1 * i, 0.01 * i;
      q.row(12 + i) = q.row(i) + (i % 2 == 0 ? apart : Eigen::RowVector2d(-apart));
    }
    return q;
  }

  /// The number of rows that are called repeats.
  std::ptrdiff_t labelled(DataSet data) const {
    label_repeats(*robot_, data);
    return std::ranges::count_if(data.rows.repeat, [](int each) { return each >= 0; });
  }

  std::unique_ptr<Robot> robot_ = robot_of(
      "{robot: r, kind: serial, frames: [{name: base, joint: fixed}, {name: a, joint: revolute, "
      "alpha: 1.5, limits: [-3, 3]}, {name: b, joint: prismatic, alpha: 1.5, limits: [-0.2, 0.2]}, "
      "{name: tool, joint: fixed, d: 0.1}]}");
};

TEST_F(UnnamedRepeats, AreRowsThatComeBackToAConfiguration) {
  DataSet data = rows(twice({0.9e-3, 0.9e-3 * 0.2}));
  EXPECT_THAT(
      label_repeats(*robot_, data),
      Optional(HasSubstr("12 rows stand within a thousandth of a radian (of half its way, of "
                         "a joint that slides) of an earlier one, first row 13")));
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(data.rows.repeat[i], static_cast<int>(i));
    EXPECT_EQ(data.rows.repeat[12 + i], static_cast<int>(i));
  }
}

TEST_F(UnnamedRepeats, AreNoneFartherAway) {
  EXPECT_EQ(labelled(rows(twice({1.1e-3, 0}))), 0);
  EXPECT_EQ(labelled(rows(twice({0, 1.1e-3 * 0.2}))), 0);
}

TEST_F(UnnamedRepeats, ComeToAConfigurationAsTheFirstDid) {
  DataSet data = rows(twice({1e-4, 0}));
  const auto change = [&](const std::function<void(Observations&)>& done) {
    DataSet other = data;
    done(other.rows);
    return labelled(std::move(other));
  };
  const auto half = [](auto& column, auto value) {
    std::fill(column.begin() + 12, column.end(), value);
  };
  EXPECT_EQ(change([](Observations&) {}), 24);
  EXPECT_EQ(change([&](Observations& o) { half(o.set, 1); }), 0);
  EXPECT_EQ(change([&](Observations& o) { half(o.group, 1); }), 0);
  EXPECT_EQ(change([&](Observations& o) { half(o.check, 1); }), 0);
  const auto with_velocity = [&](double later) {
    return change([&](Observations& o) {
      o.velocity = Eigen::MatrixXd::Constant(24, 2, 0.1);
      o.velocity.bottomRows(12).col(1).setConstant(later);
    });
  };
  EXPECT_EQ(with_velocity(0.3), 24);
  EXPECT_EQ(with_velocity(-0.1), 0);
  EXPECT_EQ(with_velocity(NAN), 0);
  const auto with_force = [&](double later) {
    return change([&](Observations& o) {
      o.wrench = Eigen::MatrixXd::Zero(24, 6);
      o.wrench.col(2).setConstant(50);
      o.wrench.bottomRows(12).col(2).setConstant(later);
    });
  };
  const auto with_warmth = [&](double later) {
    return change([&](Observations& o) {
      o.temperature = Eigen::VectorXd::Constant(24, 20);
      o.temperature.tail(12).setConstant(later);
    });
  };
  EXPECT_EQ(with_warmth(20.3), 24);
  EXPECT_EQ(with_warmth(22), 0);
  EXPECT_EQ(with_force(50.5), 24);
  EXPECT_EQ(with_force(60), 0);
  EXPECT_EQ(with_force(NAN), 0);
}

TEST_F(UnnamedRepeats, AreNotAFewThatLieSideBySide) {
  const Eigen::MatrixX2d q = twice({1e-4, 0});
  EXPECT_EQ(labelled(rows(q.topRows(21))), 0);
  EXPECT_EQ(labelled(rows(q.topRows(22))), 20);
}

TEST_F(UnnamedRepeats, OfAFewHaveTheReadingsOfTheRowBefore) {
  DataSet data = rows(Eigen::MatrixX2d{{0.1, 0.2}, {0.1, 0.2}, {0.1, 0.2}, {0.3, 0}, {0.1, 0.2}});
  EXPECT_THAT(label_repeats(*robot_, data),
              Optional(std::string("2 rows have the readings of the row before, first row 2: taken "
                                   "as its immediate repeats")));
  EXPECT_THAT(data.rows.repeat, ElementsAre(0, 0, 0, -1, -1));

  data = rows(Eigen::MatrixX2d{{0.1, 0.2}, {0.1, 0.2}});
  data.rows.time = Eigen::Vector2d(0, 10);
  data.rows.velocity = Eigen::MatrixXd{{0.1, -0.2}, {0.11, -0.21}};
  data.rows.wrench = Eigen::MatrixXd::Constant(2, 6, NAN);
  EXPECT_EQ(labelled(data), 2);
  const auto changed = [&](const std::function<void(Observations&)>& done) {
    DataSet other = data;
    done(other.rows);
    return labelled(std::move(other));
  };
  EXPECT_EQ(changed([](Observations& o) { o.q(1, 1) = 0.2000001; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.velocity(1, 1) = 0.2; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.wrench(1, 2) = 9.81; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.time[1] = 100; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.group[1] = 1; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.check[1] = 1; }), 0);
  EXPECT_EQ(changed([](Observations& o) { o.set[1] = 1; }), 0);
}

TEST_F(UnnamedRepeats, AreLeftToTheColumnThatNamesThem) {
  DataSet data = rows(twice({1e-4, 0}));
  data.rows.repeat.assign(24, -1);
  EXPECT_EQ(label_repeats(*robot_, data), std::nullopt);
  EXPECT_EQ(labelled(data), 0);
}

TEST_F(UnnamedRepeats, AreNoneOfRowsThatMeasureFromTheOneBefore) {
  EXPECT_EQ(labelled(rows(twice({1e-4, 0}), "distance")), 0);
}

/// A place is found among its neighbours whichever cell of the grid it lies in.
TEST_F(UnnamedRepeats, AreFoundWhereverTheyLie) {
  Eigen::MatrixX2d q(4000, 2);
  for (int i = 0; i < 2000; ++i) {
    q.row(i) << -2.9 + 2.9e-3 * i, 0.17 * std::sin(0.37 * i);
    q.row(2000 + i) = q.row(i);
    q(2000 + i, i % 2) += (i % 3 == 0 ? -0.19e-3 : 0.19e-3);
  }
  EXPECT_EQ(labelled(rows(q)), 4000);
}

}  // namespace
}  // namespace selfcal
