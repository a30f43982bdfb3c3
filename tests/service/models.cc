// Which parameters are active: those of the slot, or the last good ones where the store is damaged.
#include "app/service/models/models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ModelsOfADamagedStore : public testing::Test {
 protected:
  ModelsOfADamagedStore() : factory_(load_robot(example("rx90.robot.yaml")).value()) {
    const auto store = opened(scratch_.folder());
    accept(*store, 0.001);
    accept(*store, 0.002);
  }

  /// A session whose robot has its parameter 3 moved, accepted.
  void accept(Store& store, double moved) {
    const std::int64_t id = store.begin(some_session(), some_plan(2, 6)).value();
    Eigen::VectorXd xi = values(*factory_);
    xi[3] += moved;
    ResultRecord result = some_result(id);
    result.robot_text = robot_text(*factory_, xi);
    const SlotRecord candidate{id, id, model_hash(*factory_), result.robot_text};
    ASSERT_TRUE(store.finish(result, &candidate).has_value());
    ASSERT_TRUE(store.accept(id).has_value());
  }

  void change(const std::string& sql) { with_sqlite(scratch_.folder() / "selfcal.db", sql); }
  void change_active() {
    change(
        "UPDATE text SET body = replace(body, '0.5', '0.9')"
        " WHERE id = (SELECT robot FROM slot WHERE slot = 0)");
  }

  Models load() {
    store_.reset();
    store_ = std::move(Store::open(scratch_.folder()).value().store);
    return Models::load(factory_, *store_).value();
  }
  double moved(const Models& models) const {
    return values(*models.active())[3] - values(*factory_)[3];
  }

  const Scratch scratch_;
  const std::shared_ptr<const Robot> factory_;
  std::unique_ptr<Store> store_;
};

constexpr double kShiftRounding = 1e-12;  // of a length of 1 m, moved and moved back

TEST_F(ModelsOfADamagedStore, AreThoseOfTheActiveSlotWhileItIsSound) {
  const Models models = load();
  EXPECT_EQ(models.name(), "session 2");
  EXPECT_NEAR(moved(models), 0.002, kShiftRounding);
  EXPECT_EQ(models.refused(), "");
}

TEST_F(ModelsOfADamagedStore, AreThePreviousOnesAndSaySo) {
  change_active();
  const Models models = load();
  EXPECT_EQ(models.name(), "session 1");
  EXPECT_NEAR(moved(models), 0.001, kShiftRounding);
  EXPECT_THAT(models.refused(), AllOf(HasSubstr("the active parameters (session 2) were damaged"),
                                      HasSubstr("those before them, of session 1, are used")));
}

TEST_F(ModelsOfADamagedStore, SaySoAtTheNextStartTooUntilOthersAreAccepted) {
  change_active();
  load();
  EXPECT_THAT(load().refused(), HasSubstr("were damaged"));
  accept(*store_, 0.003);
  EXPECT_THAT(load().refused(), HasSubstr("were damaged"))
      << "accepted at a moment before the damage was found";
  with_sqlite(scratch_.folder() / "selfcal.db", "SELECT 1");
  const std::int64_t later = store_->damage()->front().unix_ms + 1;
  const std::int64_t id = store_->begin(some_session(), some_plan(2, 6)).value();
  const SlotRecord candidate{id, later, model_hash(*factory_),
                             robot_text(*factory_, values(*factory_))};
  ASSERT_TRUE(store_->finish(some_result(id), &candidate).has_value());
  ASSERT_TRUE(store_->accept(later).has_value());
  EXPECT_EQ(load().refused(), "");
}

TEST_F(ModelsOfADamagedStore, AreTheFactorysWhereThePreviousOnesAreDamagedToo) {
  change("UPDATE slot SET model_hash = 'another'");
  const Models models = load();
  EXPECT_EQ(models.name(), "factory");
  EXPECT_EQ(moved(models), 0);
  EXPECT_THAT(models.refused(), AllOf(HasSubstr("the active parameters (session 2) were damaged"),
                                      HasSubstr("the factory's are used")));
}

TEST_F(ModelsOfADamagedStore, AreTheFactorysWhereThePreviousOnesAreOfAnotherRobot) {
  {
    const auto store = opened(scratch_.folder());
    const std::int64_t id = store->begin(some_session(), some_plan(2, 6)).value();
    const SlotRecord other{id, id, std::string(64, 'f'), "robot: another"};
    ASSERT_TRUE(store->finish(some_result(id), &other).has_value());
    ASSERT_TRUE(store->accept(id).has_value());
    accept(*store, 0.003);
  }
  change_active();
  const Models models = load();
  EXPECT_EQ(models.name(), "factory");
  EXPECT_THAT(models.refused(), AllOf(HasSubstr("were damaged"), HasSubstr("another robot"),
                                      HasSubstr("the factory's are used")));
}

TEST_F(ModelsOfADamagedStore, SayThatTheStoreWasLost) {
  std::filesystem::resize_file(scratch_.folder() / "selfcal.db", 0);
  const Models models = load();
  EXPECT_EQ(models.name(), "factory");
  EXPECT_THAT(models.refused(),
              AllOf(HasSubstr("the store was emptied"), HasSubstr("the factory's are used")));
}

TEST_F(ModelsOfADamagedStore, KeepTheExportThatSaysOtherwise) {
  const auto path = scratch_.folder() / "active.robot.yaml";
  ASSERT_TRUE(load().write_active(scratch_.folder()).has_value());
  const std::string before = read_file(path, 1 << 20).value();
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".before"));
  change_active();

  for (int start = 0; start < 2; ++start)
    ASSERT_TRUE(load().write_active(scratch_.folder()).has_value());

  EXPECT_NE(read_file(path, 1 << 20).value(), before);
  EXPECT_EQ(read_file(path.string() + ".before", 1 << 20).value(), before);
}

}  // namespace
}  // namespace selfcal
