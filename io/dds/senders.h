// A robot's joint states and trigger level as topics.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/transport.h"

namespace selfcal {

class DdsJointSender : public JointSender {
 public:
  /// `wakeup` hears of readers that come and go.
  static Result<std::unique_ptr<DdsJointSender>> open(const DdsParticipant& participant,
                                                      const std::string& topic,
                                                      std::vector<std::string> joints,
                                                      Wakeup& wakeup);
  Result<void> send(Nanoseconds stamp, const std::vector<double>& q) override;
  int matched() const { return writer_.matched(); }

 private:
  DdsJointSender(std::vector<std::string> joints, DdsWriter<dds::JointState> writer);

  std::vector<std::string> joints_;
  std::vector<char*> names_;  ///< the same, as the messages take them
  DdsWriter<dds::JointState> writer_;
};

class DdsTriggerSender : public TriggerSender {
 public:
  /// `wakeup` hears of readers that come and go.
  static Result<std::unique_ptr<DdsTriggerSender>> open(const DdsParticipant& participant,
                                                        const std::string& topic, Wakeup& wakeup);
  /// `stamp` is the moment the level changed; repeat both about ten times a second.
  Result<void> send(Nanoseconds stamp, bool closed) override;
  int matched() const { return writer_.matched(); }

 private:
  explicit DdsTriggerSender(DdsWriter<dds::StampedBool> writer) : writer_(std::move(writer)) {}
  DdsWriter<dds::StampedBool> writer_;
};

}  // namespace selfcal
