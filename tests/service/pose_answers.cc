// What the service answers to a pose, by the active robot's own forward kinematics.
#include "app/service/models/pose_answers.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "app/service/loop/pose_thread.h"
#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/files/robot_file.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

struct Active {
  std::shared_ptr<const Robot> factory, active;
};

/// The example robot, and one off by a millimetre and a milliradian.
Active active_robots() {
  const std::shared_ptr<const Robot> factory =
      must(load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml"));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = values(*factory);
  for (std::size_t i = 0; i < factory->parameters().size(); ++i)
    if (factory->parameters()[i].free) xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
  return {factory, must(robot_of(robot_text(*factory, xi), "active"))};
}

PoseRequestMessage question_at(const Robot& robot, const Eigen::VectorXd& q) {
  const Location X = locate(robot, values(robot), q);
  const Eigen::Quaterniond turn(X.R);
  PoseRequestMessage question;
  question.id = "7";
  question.position = {X.p.x(), X.p.y(), X.p.z()};
  question.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
  question.near = {q.data(), q.data() + q.size()};
  question.temperature = std::nan("");
  return question;
}

const Eigen::VectorXd kAsked = (Eigen::VectorXd(6) << 0.3, -0.6, 0.9, 0.4, 1.2, 0.2).finished();

TEST(PoseAnswers, PutTheActiveRobotWhereItIsWanted) {
  const Active robots = active_robots();
  PoseAnswers answers;
  const PoseRequestMessage question = question_at(*robots.factory, kAsked);
  const PoseReplyMessage reply =
      answers.answer(question, robots.factory, robots.active, "session 3");
  EXPECT_EQ(reply.status, "reached");
  EXPECT_EQ(reply.why, "");
  EXPECT_EQ(reply.id, "7");
  EXPECT_EQ(reply.model, "session 3");
  EXPECT_LT(reply.error, 1e-8);
  ASSERT_EQ(reply.q.size(), 6U);
  const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(reply.q.data(), 6);
  const Location is = locate(*robots.active, values(*robots.active), q);
  EXPECT_LT((is.p - Eigen::Map<const Eigen::Vector3d>(question.position.data())).norm(), 1e-8);
  EXPECT_GT((q - kAsked).norm(), 1e-5) << "the maker's robot would be asked for others";
  // Once other parameters are active, these count.
  const PoseReplyMessage before =
      answers.answer(question, robots.factory, robots.factory, "factory");
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(before.q.data(), 6) - kAsked).norm(), 1e-6);
}

TEST(PoseAnswers, SayWhatIsOutOfReachAndRefuseWhatIsNoPose) {
  const Active robots = active_robots();
  PoseAnswers answers;
  const auto ask = [&](const std::function<void(PoseRequestMessage&)>& change) {
    PoseRequestMessage question = question_at(*robots.factory, kAsked);
    change(question);
    return answers.answer(question, robots.factory, robots.active, "factory");
  };
  const PoseReplyMessage far = ask([](auto& question) { question.position[0] += 5; });
  EXPECT_EQ(far.status, "out-of-reach");
  EXPECT_TRUE(far.q.empty());
  EXPECT_GT(far.error, 1);
  const std::vector<std::pair<const char*, std::function<void(PoseRequestMessage&)>>> slips = {
      {"position", [](auto& question) { question.position.pop_back(); }},
      {"position", [](auto& question) { question.position[1] = std::nan(""); }},
      {"orientation", [](auto& question) { question.orientation[0] += 1; }},
      {"near", [](auto& question) { question.near.pop_back(); }},
      {"near", [](auto& question) { question.near[2] = std::nan(""); }},
      {"payload", [](auto& question) { question.payload = -1; }},
      {"payload_centre",
       [](auto& question) {
         question.payload_centre = {0, 0};
       }},
      {"temperature", [](auto& question) { question.temperature = 1e6; }}};
  for (const auto& [what, slip] : slips) {
    const PoseReplyMessage reply = ask(slip);
    EXPECT_EQ(reply.status, "refused") << what;
    EXPECT_THAT(reply.why, HasSubstr(what));
    EXPECT_TRUE(reply.q.empty());
  }
}

/// Somebody who asks a service for poses over DDS.
class PosesOverDds : public DdsTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(eventually([&] { return asking_.matched() > 0 && replies_.matched() > 0; }));
  }

  void ask(const PoseRequestMessage& question) {
    std::vector<double> place = question.position, turn = question.orientation;
    dds::PoseRequest request{};
    request.id_ = borrowed::text(question.id);
    request.position_ = {3, 3, place.data(), false};
    request.orientation_ = {4, 4, turn.data(), false};
    request.temperature_ = question.temperature;
    must(asking_.write(request));
  }
  /// Status and model of what has been answered since.
  std::vector<std::string> replies() {
    std::vector<std::string> told;
    must(replies_.take([&](const dds::PoseReply& reply) {
      told.push_back(std::string(reply.status_) + " by " + reply.model_);
    }));
    return told;
  }
  std::string reply() {
    std::vector<std::string> told;
    EXPECT_TRUE(eventually([&] { return told = replies(), !told.empty(); }));
    return told.empty() ? "" : told.front();
  }

  const Active robots_ = active_robots();
  const Scratch scratch_;
  const std::unique_ptr<Store> store_ = opened(scratch_.folder());
  std::unique_ptr<PoseThread> poses_ =
      must(PoseThread::open(participant, "r", must(Models::load(robots_.factory, *store_))));
  DdsWriter<dds::PoseRequest> asking_ = must(
      DdsWriter<dds::PoseRequest>::open(participant, robot_topic("r", "pose_request"), kExchange));
  DdsReader<dds::PoseReply> replies_ = must(DdsReader<dds::PoseReply>::open(
      participant, robot_topic("r", "pose_reply"), kReplies, &wakeup));
};

TEST_F(PosesOverDds, AreAnsweredByTheParametersInUse) {
  const PoseRequestMessage question = question_at(*robots_.factory, kAsked);
  ask(question);
  EXPECT_EQ(reply(), "reached by factory");

  const std::int64_t id = store_->begin(some_session(), some_plan(2, 6)).value();
  ResultRecord result = some_result(id);
  result.robot_text = robot_text(*robots_.active, values(*robots_.active));
  const SlotRecord candidate{id, id, model_hash(*robots_.factory), result.robot_text};
  must(store_->finish(result, &candidate));
  must(store_->accept(id));
  poses_->use(must(Models::load(robots_.factory, *store_)));
  ask(question);
  EXPECT_EQ(reply(), "reached by session 1");
}

// Each takes a while, as it is tried from many starts.
TEST_F(PosesOverDds, KeepNeitherThePersonWhoAsksNorTheEndOfTheServiceWaiting) {
  PoseRequestMessage far = question_at(*robots_.factory, kAsked);
  far.position[0] += 5;
  constexpr int kMany = 1000;
  for (int i = 0; i < kMany; ++i) ask(far);
  EXPECT_EQ(reply(), "out-of-reach by factory");

  poses_.reset();
  EXPECT_LT(replies().size(), kPoseReader.depth / 2);
}

}  // namespace
}  // namespace selfcal
