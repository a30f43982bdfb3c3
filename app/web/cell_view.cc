#include "app/web/cell_view.h"

#include "app/report/page/robot_picture.h"
#include "app/service/front_end/reading.h"
#include "io/dds/context.h"
#include "io/files/json_parts.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

nlohmann::ordered_json point_json(const Eigen::Vector3d& p) { return array_of(p, finite); }

nlohmann::ordered_json lines_json(const std::vector<RobotLine>& lines) {
  return array_of(lines, [](const RobotLine& line) { return array_of(line.points, point_json); });
}

}  // namespace

Result<std::unique_ptr<CellView>> CellView::open(const std::string& config,
                                                 const DdsParticipant& participant,
                                                 Wakeup& wakeup) {
  auto loaded = load_config(config);
  if (!loaded) return tl::unexpected(loaded.error());
  std::unique_ptr<CellView> view(new CellView(*std::move(loaded)));
  // A bus would have to be shared with the service; what the robot sends over DDS is for everybody.
  if (view->config_.encoders->stamped_by() == StampedBy::sender) {
    const DdsContext dds{participant};
    auto encoders = view->config_.encoders->open({dds, wakeup});
    if (!encoders) return tl::unexpected(encoders.error());
    view->encoders_ = *std::move(encoders);
  }
  return view;
}

nlohmann::ordered_json CellView::cell() const {
  const nlohmann::ordered_json home = pose(config_.plan.home);
  auto surfaces = nlohmann::ordered_json::array();
  for (const TouchTarget& target : config_.targets)
    if (target.plane)
      surfaces.push_back({{"name", config_.sets[static_cast<std::size_t>(target.set)].name},
                          {"center", point_json(target.within.centre)},
                          {"normal", point_json(target.outward)},
                          {"radius", target.within.radius}});
  return {{"robot", config_.robot->name()},
          {"model_hash", model_hash(*config_.robot)},
          {"live", encoders_ != nullptr},
          {"home", home.is_object() ? home["lines"] : nlohmann::ordered_json::array()},
          {"surfaces", std::move(surfaces)}};
}

nlohmann::ordered_json CellView::pose(const Eigen::VectorXd& q) const {
  const Robot& robot = *config_.robot;
  if (q.size() != static_cast<Eigen::Index>(robot.joints().size())) return nullptr;
  Locations tool;
  if (!robot.locate(block_of(q), values(robot), Body::endpoint, tool, nullptr).closes())
    return nullptr;
  const Eigen::Vector3d at = locate(robot, values(robot), q, Body::endpoint).p;
  auto lines = robot_lines(robot, q);
  if (lines.empty()) lines.push_back({"tool", {at}});
  return {{"lines", lines_json(lines)}, {"tool", point_json(at)}};
}

std::optional<Eigen::VectorXd> CellView::heard() {
  if (!encoders_) return std::nullopt;
  samples_.clear();
  if (!encoders_->take(samples_) || samples_.empty()) return std::nullopt;
  return reading_of(samples_.back(), encoders_->scales());
}

}  // namespace selfcal
