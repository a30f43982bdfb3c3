// The action's services, as its server encodes them.
#include "io/dds/ros/trajectory_action.h"

#include "io/dds/ros/cyclone_services.h"
#include "io/dds/ros/fast_services.h"

namespace selfcal {

TrajectoryAction::TrajectoryAction(const DdsParticipant& participant, std::string action,
                                   std::vector<std::string> joints, Wakeup& wakeup)
    : participant_(participant),
      action_(std::move(action)),
      joints_(std::move(joints)),
      wakeup_(wakeup) {}

Result<std::unique_ptr<TrajectoryAction>> TrajectoryAction::open(const DdsParticipant& participant,
                                                                 const std::string& action,
                                                                 std::vector<std::string> joints,
                                                                 Wakeup& wakeup) {
  std::unique_ptr<TrajectoryAction> made(
      new TrajectoryAction(participant, action, std::move(joints), wakeup));
  if (auto opened = made->open_services(); !opened) return tl::make_unexpected(opened.error());
  return made;
}

Result<void> TrajectoryAction::open_services() {
  services_.reset();  // what another encoding wrote is read by none of ours
  auto opened =
      (fast_ ? FastServices::open : CycloneServices::open)(participant_, action_, joints_, wakeup_);
  if (!opened) return tl::make_unexpected(opened.error());
  services_ = *std::move(opened);
  return {};
}

Result<void> TrajectoryAction::take(std::vector<GoalNews>& out) {
  if (services_->other_encoding()) {
    fast_ = !fast_;
    if (auto opened = open_services(); !opened) return opened;
  }
  return services_->take(out);
}

}  // namespace selfcal
