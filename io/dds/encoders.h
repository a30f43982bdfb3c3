// Encoders from a topic of joint states, for a robot without a bus of its own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/dds/sole_writer.h"
#include "io/dds/time_mapping.h"
#include "io/ports.h"

namespace selfcal {

struct DdsEncodersConfig {
  std::string topic = "joint_states";  ///< name in ROS
  std::vector<std::string> joints;     ///< names in the messages, by joint; 1 to kMostJoints
};

class DdsEncoders : public EncoderSource {
 public:
  /// One count (rad or m) of what is a floating-point number in the messages.
  static constexpr double kStep = 1e-9;

  /// Takes joint states of reliable and of best-effort publishers. `mapping` is shared with the
  /// trigger of the same machine, whose stamps must be of the same clock.
  static Result<std::unique_ptr<DdsEncoders>> open(const DdsParticipant& participant,
                                                   DdsEncodersConfig config,
                                                   std::shared_ptr<TimeMapping> mapping);

  const std::vector<EncoderScale>& scales() const override { return scales_; }
  /// A message that lacks a joint, or has one that is not finite, is no sample.
  Result<void> take(std::vector<EncoderSample>& out) override;
  /// Lost on the way, pushed out before they were taken, or before a step of the sender's clock.
  std::uint64_t dropped() const override { return reader_.lost() + stepped_; }
  /// `incomplete`: messages that were no sample.
  std::vector<Tally> tallies() const override { return {{"incomplete", incomplete_}}; }
  /// Which joint the last messages lack, if they were no sample.
  std::string trouble() const override;
  /// Publishers heard at the moment.
  int senders() const override { return reader_.matched(); }
  std::uint64_t strange() const override { return writer_.strange(); }

 private:
  /// Why a message is no sample.
  struct Lack {
    std::size_t joint = 0;
    bool named = false;  ///< it is there, but its position is none
  };
  DdsEncoders(std::vector<std::string> joints, std::shared_ptr<TimeMapping> mapping,
              DdsReader<dds::JointState> reader);
  std::optional<Lack> read(const dds::JointState& state, EncoderSample& sample);
  bool find(std::size_t joint, const dds::JointState& state);

  std::vector<std::string> joints_;
  std::vector<std::uint32_t> places_;  ///< where each joint stood in the last message
  std::vector<EncoderScale> scales_;
  std::shared_ptr<TimeMapping> mapping_;
  DdsReader<dds::JointState> reader_;
  SoleWriter writer_;
  std::uint64_t incomplete_ = 0;
  std::uint64_t in_a_row_ = 0;  ///< of these the last ones, after the last sample
  Lack lack_;                   ///< of the last of them
  std::uint64_t stepped_ = 0;   ///< samples dropped because the sender's clock stepped
};

}  // namespace selfcal
