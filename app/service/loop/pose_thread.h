// Poses that others ask for, answered by a thread of their own: a pose out of reach takes as long
// as a hundred turns of the loop, and anybody may ask for many.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "app/service/models/models.h"
#include "app/service/models/pose_answers.h"
#include "io/dds/poses.h"

namespace selfcal {

class PoseThread {
 public:
  /// Answers by `models` until others are used. `participant` outlives it.
  static Result<std::unique_ptr<PoseThread>> open(const DdsParticipant& participant,
                                                  const std::string& robot, const Models& models);
  /// Waits for the pose that is being answered; those that wait are not.
  ~PoseThread();
  PoseThread(const PoseThread&) = delete;
  PoseThread& operator=(const PoseThread&) = delete;

  /// Poses that are answered from now on are by these parameters. Never waits for one.
  void use(const Models& models);

 private:
  PoseThread() = default;
  void work();
  PoseReplyMessage answer(const PoseRequestMessage& request);

  Wakeup wakeup_;
  std::unique_ptr<DdsPoses> poses_;
  PoseAnswers answers_;

  std::mutex mutex_;
  std::shared_ptr<const Robot> factory_, active_;
  std::string name_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace selfcal
