#include "app/service/models/pose_answers.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kUnitWithin = 1e-3;   // of a quaternion's length
constexpr double kHeaviest = 1e5;      // kg
constexpr double kWarmest = 1000;      // C
constexpr double kFarthestPose = 1e3;  // m

bool all_finite(const std::vector<double>& list) {
  return std::ranges::all_of(list, [](double each) { return std::isfinite(each); });
}

/// Why the question cannot be answered; empty where it can.
std::string mistake_in(const PoseRequestMessage& question, std::size_t joints) {
  const auto off = [](double each) { return !(std::abs(each) <= kFarthestPose); };
  if (question.position.size() != 3 || std::ranges::any_of(question.position, off))
    return "position is x y z in metres";
  double length = 0;
  for (const double each : question.orientation) length += each * each;
  if (question.orientation.size() != 4 || !(std::abs(std::sqrt(length) - 1) < kUnitWithin))
    return "orientation is a unit quaternion, w x y z";
  if ((!question.near.empty() && question.near.size() != joints) || !all_finite(question.near))
    return "near is a reading of each of the " + std::to_string(joints) + " joints, or nothing";
  if (!(question.payload >= 0 && question.payload <= kHeaviest)) return "payload is a mass in kg";
  if ((!question.payload_centre.empty() && question.payload_centre.size() != 3) ||
      std::ranges::any_of(question.payload_centre, off))
    return "payload_centre is x y z in metres, or nothing";
  if (!std::isnan(question.temperature) && !(std::abs(question.temperature) <= kWarmest))
    return "temperature is in degrees Celsius, or NaN";
  return {};
}

OperatingPoint point_of(const PoseRequestMessage& question) {
  OperatingPoint at;
  at.mass = question.payload;
  if (!question.payload_centre.empty())
    at.centre = Eigen::Map<const Eigen::Vector3d>(question.payload_centre.data());
  at.temperature = question.temperature;
  return at;
}

bool same_point(const OperatingPoint& a, const OperatingPoint& b) {
  return a.mass == b.mass && a.centre == b.centre &&
         (a.temperature == b.temperature ||
          (std::isnan(a.temperature) && std::isnan(b.temperature)));
}

}  // namespace

PoseReplyMessage PoseAnswers::answer(const PoseRequestMessage& question,
                                     const std::shared_ptr<const Robot>& factory,
                                     const std::shared_ptr<const Robot>& active,
                                     const std::string& name) {
  PoseReplyMessage reply;
  reply.id = question.id;
  reply.model = name;
  reply.status = "refused";
  reply.why = mistake_in(question, active->joints().size());
  if (!reply.why.empty()) return reply;
  const OperatingPoint at = point_of(question);
  if (!compensation_ || active_ != active || !same_point(at_, at)) {
    compensation_.emplace(factory, active, at);
    active_ = active;
    at_ = at;
  }
  const std::vector<double>& o = question.orientation;
  const Location wanted{Eigen::Quaterniond(o[0], o[1], o[2], o[3]).normalized().toRotationMatrix(),
                        Eigen::Map<const Eigen::Vector3d>(question.position.data())};
  std::optional<Eigen::VectorXd> near;
  if (!question.near.empty())
    near = Eigen::Map<const Eigen::VectorXd>(question.near.data(),
                                             static_cast<Eigen::Index>(question.near.size()));
  const Command command = compensation_->command(wanted, near);
  reply.status = to_string(command.status);
  reply.q.assign(command.q.data(), command.q.data() + command.q.size());
  reply.iterations = static_cast<std::uint32_t>(command.iterations);
  reply.error = command.error;
  reply.error_angle = command.error_angle;
  return reply;
}

}  // namespace selfcal
