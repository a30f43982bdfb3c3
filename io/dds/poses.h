// Poses that others ask the service for, and its answers.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/dds/allowance.h"
#include "io/dds/endpoint.h"

namespace selfcal {

struct PoseRequestMessage {
  std::string id;
  std::vector<double> position, orientation;  ///< m; w x y z
  std::vector<double> near;                   ///< readings (rad or m); empty: none
  double payload = 0;                         ///< kg
  std::vector<double> payload_centre;         ///< m; empty: the tool's origin
  double temperature = 0;                     ///< C; NaN: not known
};

struct PoseReplyMessage {
  std::string id, status, why;
  std::vector<double> q;  ///< rad or m
  std::uint32_t iterations = 0;
  double error = 0, error_angle = 0;  ///< m, rad
  std::string model;
};

class DdsPoses {
 public:
  /// Answered in a second; further ones are refused.
  static constexpr int kMostPoses = 200;

  /// `wakeup` hears of requests and must outlive it.
  static Result<std::unique_ptr<DdsPoses>> open(const DdsParticipant& participant,
                                                const std::string& robot, Wakeup& wakeup);

  /// Answers the oldest of the last 64 that have come; false where there is none.
  bool answer(const std::function<PoseReplyMessage(const PoseRequestMessage&)>& to);

 private:
  DdsPoses() = default;
  DdsReader<dds::PoseRequest> requests_;
  DdsWriter<dds::PoseReply> replies_;
  Allowance allowance_{kMostPoses, kMostPoses};
};

}  // namespace selfcal
